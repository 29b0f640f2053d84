//! When the program cannot go on: bridges off, say why, wait for the watchdog.
//!
//! The watchdog rather than a reset at once, so that the log can be read, and a fault that comes back after
//! every start does not flicker.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{ExceptionFrame, exception};

use thermal_display::device::safety::{Cause, Fault};

use super::{record, watchdog, wiring};

/// Every bridge high-impedance, for good; why is kept.
fn end(fault: Fault) {
    cortex_m::interrupt::disable();
    wiring::cut();
    record::keep(&Cause::alone(fault));
}

/// Whether this is the first time that the end is reported: logging may be what failed.
fn first_report() -> bool {
    static REPORTED: AtomicBool = AtomicBool::new(false);
    !REPORTED.swap(true, Ordering::Relaxed)
}

/// 47 ms, or at most 188 when its clock is what failed; a second at most where the start has not come so far. Awake, so that
/// the probe can read the log.
fn wait_for_watchdog() -> ! {
    watchdog::start();
    loop {
        cortex_m::asm::nop();
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    end(Fault::Panic);
    if first_report() {
        defmt::error!("{}", defmt::Display2Format(info));
    }
    wait_for_watchdog()
}

// SAFETY: `unsafe` because memory may be corrupt. It reads the frame that the processor has just stacked.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    end(Fault::HardFault);
    if first_report() {
        defmt::error!(
            "hard fault at pc {=u32:#x}, lr {=u32:#x}",
            frame.pc(),
            frame.lr()
        );
    }
    wait_for_watchdog()
}

// SAFETY: `unsafe` because it interrupts critical sections. It touches nothing that one protects.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    end(Fault::Clock);
    if first_report() {
        defmt::error!("the 8 MHz clock has failed");
    }
    wait_for_watchdog()
}

// SAFETY: `unsafe` because it may interrupt anything. It touches nothing that others use.
#[exception]
unsafe fn DefaultHandler(irqn: i16) -> ! {
    end(Fault::HardFault);
    if first_report() {
        defmt::error!("interrupt {=i16} has no task", irqn);
    }
    wait_for_watchdog()
}
