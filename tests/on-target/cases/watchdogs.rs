//! Both watchdogs reset the chip in time, and the firmware recognises which one it was.

use core::sync::atomic::Ordering::Relaxed;

use crate::after_reset::{KEPT, Step, continue_with};
use crate::board::nucleo_f446re::reset_cause::ResetCause;
use crate::{cycles, report};

/// Waits for the reset that `step` expects, feeding the other watchdog, and notes the cycles until then.
fn wait_for_reset(step: Step, mut feed_other: impl FnMut()) -> ! {
    continue_with(step);
    let fed = cycles::now();
    loop {
        feed_other();
        KEPT.number.store(cycles::now().wrapping_sub(fed), Relaxed);
    }
}

/// After the reset: the cause is the expected one, and the watchdog was neither early nor late.
pub fn recognise(expected: ResetCause, cause: ResetCause) {
    const CYCLES_PER_US: u32 = 180;
    let waited_us = KEPT.number.load(Relaxed) / CYCLES_PER_US;
    let (key, us) = match expected {
        // 100 counts of an oscillator of 17 to 47 kHz, divided by 32
        ResetCause::Watchdog => ("independent_watchdog", 68_000..=188_300),
        // 64 counts of 4096 * 8 periods of 45 MHz
        _ => ("window_watchdog", 46_500..=46_700),
    };
    report::figure(key, waited_us, "us");
    assert_eq!(cause.name(), expected.name());
    assert!(us.contains(&waited_us), "{waited_us} us, not {us:?}");
}

#[embedded_test::tests]
mod tests {
    use super::wait_for_reset;
    use crate::after_reset::Step;
    use crate::running_board::set_up;

    #[test]
    fn the_independent_watchdog_resets_and_is_recognised() {
        let mut board = set_up();
        board.watchdog.feed();
        wait_for_reset(Step::RecogniseIndependentWatchdog, || {
            board.control_loop.window_watchdog.feed();
        })
    }

    #[test]
    fn the_window_watchdog_resets_and_is_recognised() {
        let mut board = set_up();
        board.control_loop.window_watchdog.feed();
        wait_for_reset(Step::RecogniseWindowWatchdog, || board.watchdog.feed())
    }
}
