//! Handlers of errors after which the program cannot continue: they turn the bridges off, log the
//! error, and wait until a watchdog resets the device.
//!
//! The handlers do not reset the device at once, so that a debug probe has time to read the log,
//! and so that a fault which recurs at every start does not cause a rapid series of resets.

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{ExceptionFrame, exception};

use thermal_display::device::safety::{Fault, TripCause};

use super::{independent_watchdog, late_clock, trip_cause_recorder, wiring};

/// Disables interrupts, turns all bridges off, and stores `fault` in RAM, unless an earlier cause
/// is stored there, as the cause by which the next start trips all fingers.
fn disable_bridges_and_store_first_fault(fault: Fault) {
    cortex_m::interrupt::disable();
    wiring::disable_bridges();
    trip_cause_recorder::store_trip_cause_if_none(&TripCause::without_readings(fault));
}

/// Returns `true` at its first call only. The handlers of fatal errors log only the first error,
/// because writing to the log may itself have raised the next one.
fn is_first_error_to_log() -> bool {
    static FATAL_ERROR_LOGGED: AtomicBool = AtomicBool::new(false);
    !FATAL_ERROR_LOGGED.swap(true, Ordering::Relaxed)
}

/// Waits until a watchdog resets the device: the window watchdog within 47 ms. If that does not
/// run, the independent watchdog does so within 188 ms, or within a second if the start-up has not
/// set its period yet. The processor stays awake, so that the debug probe can read the log.
fn start_watchdog_and_wait_for_reset() -> ! {
    independent_watchdog::start_counter();
    loop {
        cortex_m::asm::nop();
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    disable_bridges_and_store_first_fault(Fault::Panic);
    if is_first_error_to_log() {
        defmt::error!("{}", defmt::Display2Format(info));
    }
    start_watchdog_and_wait_for_reset()
}

// SAFETY: `unsafe` because memory may be corrupt. The handler reads the frame that the processor
// has just stacked.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    disable_bridges_and_store_first_fault(Fault::HardFault);
    if is_first_error_to_log() {
        defmt::error!("hard fault at pc {=u32:#x}, lr {=u32:#x}", frame.pc(), frame.lr());
    }
    start_watchdog_and_wait_for_reset()
}

// SAFETY: `unsafe` because it interrupts critical sections. It accesses no data that they protect.
#[exception]
unsafe fn NonMaskableInt() {
    if late_clock::acknowledge_failure_while_waiting() {
        // As at the end of the tasks' handlers (main.rs).
        cortex_m::asm::dsb();
        return;
    }
    disable_bridges_and_store_first_fault(Fault::Clock);
    if is_first_error_to_log() {
        defmt::error!("the 8 MHz clock has failed");
    }
    start_watchdog_and_wait_for_reset()
}

// SAFETY: `unsafe` because it may interrupt any code. It accesses no data that other code uses.
#[exception]
unsafe fn DefaultHandler(irqn: i16) -> ! {
    disable_bridges_and_store_first_fault(Fault::HardFault);
    if is_first_error_to_log() {
        defmt::error!("interrupt {=i16} has no task", irqn);
    }
    start_watchdog_and_wait_for_reset()
}
