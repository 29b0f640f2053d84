//! The board set up as the firmware does it, for tests that poll what its interrupts would do.

use core::mem::MaybeUninit;
use core::sync::atomic::AtomicBool;

use cortex_m::peripheral::NVIC;
use thermal_display::device::Station;

use crate::board::nucleo_f446re::{reset_cause::ResetCause, stack_guard, trip_cause_recorder};
use crate::board::pac::{self, Interrupt};
use crate::board::{Board, FINGERS, SampleError, StaticMemory};
use crate::{cycles, report};

/// Brings what the last test has left in RAM and reset flags to what the firmware finds after a reset by the pin.
pub fn forget_the_last_test() {
    // SAFETY: a test has not begun, and nothing else runs.
    ResetCause::clear_flags(&unsafe { pac::RCC::steal() });
    trip_cause_recorder::erase_stored_trip_cause();
    stack_guard::init_guard();
}

/// Sets the board up and starts the cycle counter. Both watchdogs run from here on, but not while a probe has halted the core.
pub fn set_up() -> Board {
    let core = cortex_m::Peripherals::take().expect("once in a test");
    let peripherals = pac::Peripherals::take().expect("once in a test");
    let memory = cortex_m::singleton!(: StaticMemory = StaticMemory::new());
    let stations = cortex_m::singleton!(: MaybeUninit<[Station; FINGERS]> = MaybeUninit::uninit());
    let (memory, stations) = memory.zip(stations).expect("once in a test");
    let board = Board::set_up(core.SYST, peripherals, memory, stations);
    cycles::start();
    // The end of the test halts the core, too.
    report::hold_watchdogs_while_halted();
    board
}

/// Restarts the periods of both watchdogs.
pub fn feed(board: &mut Board) {
    board.control_loop.window_watchdog.feed();
    board.watchdog.feed();
}

/// A pending interrupt, which is not enabled here, so that no handler runs; the request is withdrawn.
pub fn take_request(interrupt: Interrupt) -> bool {
    let pending = NVIC::is_pending(interrupt);
    if pending {
        NVIC::unpend(interrupt);
    }
    pending
}

/// Waits for the samples of a tick and runs it; the time at which it began and its cost, cycles.
pub fn run_tick(board: &mut Board) -> Result<(u32, u32), SampleError> {
    let host_is_active = AtomicBool::new(true);
    while !NVIC::is_pending(Interrupt::DMA2_STREAM0) {}
    let begun = cycles::now();
    let control_loop = &mut board.control_loop;
    // A new device has no heat-flux sensor, and its learner no input.
    let (result, cost) =
        cycles::measure(|| control_loop.run_finger_tick(&mut board.device, &host_is_active, || ()));
    NVIC::unpend(Interrupt::DMA2_STREAM0);
    board.watchdog.feed();
    result.map(|_| (begun, cost))
}
