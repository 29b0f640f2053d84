//! The operator's stop, which the worker sees wherever it waits.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the operator has stopped. It is no queue: nothing can be in front of it.
#[derive(Clone, Debug, Default)]
pub struct StopFlag {
    pressed: Arc<AtomicBool>,
    closing: Arc<AtomicBool>,
    interrupts_link: Arc<AtomicBool>,
}

impl StopFlag {
    /// Stops: the bridge is switched off as soon as the worker sees it.
    pub fn press(&self) {
        self.pressed.store(true, Ordering::SeqCst);
        self.interrupts_link.store(true, Ordering::SeqCst);
    }

    /// Stops, and closes the window when the worker has ended; for signals that end the program, too.
    pub fn press_and_close(&self) {
        self.closing.store(true, Ordering::SeqCst);
        self.press();
    }

    /// Whether it is pressed.
    pub fn is_pressed(&self) -> bool {
        self.pressed.load(Ordering::SeqCst)
    }

    /// Whether the window is to close.
    pub fn is_closing(&self) -> bool {
        self.closing.load(Ordering::SeqCst)
    }

    /// Whether it was pressed; it is not afterwards.
    pub fn take(&self) -> bool {
        self.pressed.swap(false, Ordering::SeqCst)
    }

    /// The flag with which [`Interruptible`](thermal_client::link::Interruptible) ends a wait for the device at once.
    pub fn interrupts_link(&self) -> Arc<AtomicBool> {
        self.interrupts_link.clone()
    }
}
