//! What a device says after a reset, and starts that go wrong.

use hil_sim::machine::{Cells, CoreRegister, Firmware, ResetCause};
use system_tests::{Bare, START, image};

fn firmware() -> Firmware {
    Firmware::from_file(image()).expect("an image for this chip")
}

/// Cycles after which a start has looked at the flags of its reset, and has not set up its watchdogs yet.
const EARLY: u64 = 100_000;

fn blank() -> Cells {
    Cells::new(vec![0xff; 3 * 16 * 1024])
}

/// The name of the kept fault. Without sensors a device that has none to report trips by `excitation`.
fn cause(device: &mut Bare) -> String {
    let answer = device.tell("cause");
    let name = answer
        .strip_prefix("ok cause=")
        .and_then(|rest| rest.split(' ').next());
    name.unwrap_or_else(|| panic!("{answer}")).to_owned()
}

const NONE: &str = "excitation";

/// Its program is lost while it reads the flash, before the watchdogs run.
fn lost_at_the_start() -> Bare {
    let mut device = Bare::switched_on(&firmware(), &blank());
    device.run(EARLY);
    device.0.flip_core_bit(CoreRegister::Pc, 20).expect("lost");
    device.run(2 * START);
    device
}

#[test]
fn a_reset_that_nobody_has_asked_for_is_a_fault_and_one_from_outside_is_none() {
    let firmware = firmware();
    // The supply and the pin lead to off; without sensors the next fault follows.
    for (reset, expected) in [
        (ResetCause::Software, "unasked-reset"),
        (ResetCause::Pin, NONE),
        (ResetCause::BrownOut, NONE),
        (ResetCause::PowerOn, NONE),
    ] {
        let mut device = Bare::switched_on(&firmware, &blank());
        // Before the first tick, so that nothing has tripped; twice, so that flags of the first are gone.
        for _ in 0..2 {
            device.run(EARLY);
            match reset {
                ResetCause::Software => device.0.ask_for_reset(),
                ResetCause::Pin => device.0.pull_reset_pin(),
                ResetCause::BrownOut => device.0.brown_out(),
                _ => device.0.power_cycle(3),
            }
            .expect("starts anew");
        }
        device.run(START);
        assert_eq!(cause(&mut device), expected, "{reset:?}");
    }
}

#[test]
fn the_first_cause_outlives_resets_but_not_the_power() {
    let mut device = lost_at_the_start();
    for step in 0..4 {
        let reset = match step {
            0 => device.0.pull_reset_pin(),
            1 => device.0.brown_out(),
            2 => device.0.ask_for_reset(),
            _ => device.0.power_cycle(7),
        };
        reset.expect("starts anew");
        device.run(START);
        let expected = if step == 3 { NONE } else { "hard-fault" };
        assert_eq!(cause(&mut device), expected, "{step}");
    }
}

#[test]
fn a_start_that_ends_before_the_watchdogs_run_is_tried_again() {
    let mut device = lost_at_the_start();
    let causes: Vec<_> = device.0.resets().iter().map(|reset| reset.cause).collect();
    assert_eq!(
        causes,
        [ResetCause::PowerOn, ResetCause::IndependentWatchdog]
    );
    assert_eq!(cause(&mut device), "hard-fault");
}
