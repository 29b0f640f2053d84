//! Tests that provoke a reset and go on after it: their next step waits in RAM that a reset does not clear.
//!
//! The runner says once which test to run, so a test that goes on must do so before the program asks again.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use cortex_m::peripheral::Peripherals;

use crate::board::nucleo_f446re::reset_cause::ResetCause;
use crate::board::pac;
use crate::{report, settings, watchdogs};

/// Marks a step that waits. After power-up the RAM is unlikely to hold it by chance.
const WAITS_MAGIC: u32 = 0x7e57_0000;
/// DEMCR.VC_CORERESET: a probe halts the core at each reset.
const CATCH_RESETS: u32 = 1;

/// What a test does after the reset that it has provoked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Step {
    RecogniseIndependentWatchdog,
    RecogniseWindowWatchdog,
    FindSavedSettings,
    InterruptSave,
    RecoverSettings,
}

const STEPS: [Step; 5] = [
    Step::RecogniseIndependentWatchdog,
    Step::RecogniseWindowWatchdog,
    Step::FindSavedSettings,
    Step::InterruptSave,
    Step::RecoverSettings,
];

/// Words that a reset does not clear.
pub struct Kept {
    step: AtomicU32,
    /// For the test that waits.
    pub number: AtomicU32,
}

// SAFETY: the start-up code does not initialise the section, which holds nothing else; all bit patterns are valid.
#[unsafe(link_section = ".uninit.after_reset")]
pub static KEPT: Kept = Kept { step: AtomicU32::new(0), number: AtomicU32::new(0) };

/// The next reset continues with `step`, and the probe does not halt at it.
pub fn continue_with(step: Step) {
    KEPT.step.store(WAITS_MAGIC | step as u32, Relaxed);
    // SAFETY: nothing else uses the register.
    unsafe { Peripherals::steal().DCB.demcr.modify(|bits| bits & !CATCH_RESETS) };
}

/// Goes on with the step that waits for this reset, if one does, and ends the test.
pub fn continue_if_expected() {
    let waiting = KEPT.step.swap(0, Relaxed);
    let Some(step) = STEPS.into_iter().find(|step| WAITS_MAGIC | *step as u32 == waiting) else {
        return;
    };
    // SAFETY: loads without side effects.
    let cause = ResetCause::read(&unsafe { pac::RCC::steal() });
    match step {
        Step::RecogniseIndependentWatchdog => watchdogs::recognise(ResetCause::Watchdog, cause),
        Step::RecogniseWindowWatchdog => watchdogs::recognise(ResetCause::WindowWatchdog, cause),
        Step::FindSavedSettings => settings::find_saved(),
        Step::InterruptSave => settings::interrupt_save(),
        Step::RecoverSettings => settings::recover(cause),
    }
    report::succeed()
}
