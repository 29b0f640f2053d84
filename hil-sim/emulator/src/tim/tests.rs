//! Timers against RM0390.
use super::*;

/// A timer after these writes at cycle 0: offset and value.
fn timer(kind: Kind, divider: u64, writes: &[(u32, u32)]) -> Tim {
    let mut tim = Tim::new(kind, divider);
    for (offset, value) in writes {
        tim.write(*offset, *value, 0).unwrap();
    }
    tim
}

/// TIM1 as the bridge's PWM: 180 MHz / 1800 = 100 kHz, preload, CH1 in PWM mode 1.
fn pwm(bdtr: u32) -> Tim {
    let output = [(0x2c, 1799), (0x34, 450), (0x18, 0x6868), (0x20, 0x11)];
    let start = [(0x14, 1), (0x44, bdtr), (0x00, 0x81)];
    timer(ADVANCED, 1, &[output.as_slice(), &start].concat())
}

/// High for so many of the 1800 ticks of a period.
fn high(high: u32) -> Output {
    Output::High { high, period: 1800 }
}

#[test]
fn update_rate_is_clock_over_prescaler_and_reload() {
    let writes = [(0x28, 8), (0x2c, 624), (0x14, 1), (0x10, 0), (0x0c, 1)];
    let mut tim = timer(WIDE, 2, &writes);
    tim.write(0x00, 1, 100).unwrap();
    assert_eq!(tim.due, 100 + 2 * 9 * 625);
    assert_eq!(tim.read(0x24, 100 + 2 * 9 * 10).unwrap(), 10);
    tim.sync(tim.due);
    assert_eq!(tim.requests(), [false, true, false, false]);
    assert_eq!(tim.read(0x24, 100 + 2 * 9 * 625).unwrap(), 0);
}

#[test]
fn preloaded_compare_values_wait_for_the_update() {
    let mut tim = pwm(MOE);
    assert_eq!(tim.output(0), high(450));
    tim.write(0x34, 900, 1000).unwrap();
    assert_eq!(tim.output(0), high(450));
    assert_eq!(tim.due, 1800);
    tim.sync(1800);
    assert_eq!(tim.output(0), high(900));
    assert_eq!(tim.due, u64::MAX, "no event is due at the next update");
    tim.write(0x34, 5000, 1900).unwrap();
    tim.sync(3600);
    assert_eq!(tim.output(0), high(1800), "above ARR: always high");
}

#[test]
fn outputs_follow_the_output_control_bits() {
    assert_eq!(pwm(0).output(0), Output::Released, "MOE = 0, OSSI = 0");
    assert_eq!(pwm(OSSI).output(0), Output::High { high: 0, period: 1 }, "idle level");
    assert_eq!(pwm(MOE).output(2), Output::Released, "CC3E = 0, OSSR = 0");
    assert_eq!(pwm(MOE | OSSR).output(2), Output::High { high: 0, period: 1 }, "inactive level");
}

#[test]
fn break_switches_the_outputs_off_and_holds_them() {
    let mut tim = pwm(MOE | BKE);
    assert!(!tim.set_break(true), "active low");
    assert!(tim.set_break(false));
    assert_eq!(tim.output(0), Output::Released);
    tim.write(0x44, MOE | BKE, 100).unwrap();
    assert!(tim.set_break(false), "MOE does not hold while the input is active");
    assert_eq!(tim.output(0), Output::Released);
    tim.write(0x10, 0, 200).unwrap();
    tim.write(0x44, MOE | BKE, 200).unwrap();
    assert!(!tim.set_break(true));
    assert_eq!(tim.output(0), high(450));
}

#[test]
fn lock_level_1_keeps_the_break_configuration() {
    let mut tim = pwm(MOE | BKE | 1 << 8);
    tim.write(0x44, MOE | OSSR, 0).unwrap();
    assert_eq!(tim.read(0x44, 0).unwrap(), MOE | OSSR | BKE | 1 << 8);
}

/// 17.4.18: the first write of BDTR after a reset freezes LOCK, also if it has written 0 to it.
#[test]
fn lock_is_frozen_by_the_first_write() {
    let mut late = pwm(AOE);
    late.write(0x44, BKE | 3 << 8, 0).unwrap();
    assert_eq!(late.read(0x44, 0).unwrap(), BKE, "too late");
    late.write(0x44, 0, 0).unwrap();
    assert_eq!(late.read(0x44, 0).unwrap(), 0, "nothing is protected");

    let mut first = pwm(BKE | OSSI | 3 << 8);
    first.write(0x44, AOE | MOE, 0).unwrap();
    assert_eq!(first.read(0x44, 0).unwrap(), BKE | OSSI | 3 << 8 | MOE);
    first.reset();
    first.write(0x44, AOE, 0).unwrap();
    assert_eq!(first.read(0x44, 0).unwrap(), AOE, "a reset ends the lock");
}

#[test]
fn a_halted_timer_keeps_its_count_and_an_advanced_one_disables_its_outputs() {
    let mut tim = pwm(MOE | OSSI);
    tim.set_halted(true, 400);
    assert_eq!(tim.read(0x24, 1_000_000).unwrap(), 400);
    assert_eq!(tim.output(0), Output::High { high: 0, period: 1 });
    tim.set_halted(false, 1_000_000);
    assert_eq!(tim.read(0x24, 1_000_100).unwrap(), 500);
    assert_eq!(tim.output(0), high(450));

    let output = [(0x2c, 1799), (0x34, 450), (0x18, 0x68), (0x20, 0x1)];
    let start = [(0x14, 1), (0x00, 0x81)];
    let mut single = timer(SINGLE, 1, &[output.as_slice(), &start].concat());
    single.set_halted(true, 400);
    assert!(single.is_high(0, 1_000_000), "the level of the count 400");
}

#[test]
fn compare_flags_rise_at_the_match() {
    let mut tim = pwm(MOE);
    assert_eq!(tim.read(0x10, 449).unwrap() & 2, 0);
    assert_eq!(tim.read(0x10, 450).unwrap() & 2, 2);
    tim.write(0x10, 0, 500).unwrap();
    assert_eq!(tim.read(0x10, 1800 * 100 + 300).unwrap() & 3, 3, "a hundred periods later");
}

#[test]
fn one_pulse_mode_stops_at_the_update() {
    let mut tim = timer(BASIC, 2, &[(0x2c, 99), (0x00, 9)]);
    assert_eq!(tim.read(0x00, 199).unwrap() & 1, 1);
    assert_eq!((tim.read(0x00, 200).unwrap() & 1, tim.read(0x10, 200).unwrap()), (0, 1));
}

#[test]
fn unmodelled_modes_are_refused() {
    let mut tim = Tim::new(GENERAL, 2);
    assert!(tim.write(0x08, 3, 0).is_err(), "encoder");
    assert!(tim.write(0x18, 2, 0).is_err(), "capture from another input");
    assert!(tim.write(0x08, 0x06, 0).is_err(), "started by TIM1");
    assert!(tim.write(0x00, 0x20, 0).is_err(), "centre-aligned");
}

/// Register maps of 16.4.21, 17.4.21 and 18.5.12.
#[test]
fn each_kind_of_timer_has_only_its_own_registers() {
    for (kind, present, absent) in [
        (ADVANCED, &[0x04, 0x08, 0x1c, 0x30, 0x40, 0x44][..], &[0x50][..]),
        (GENERAL, &[0x04, 0x08, 0x1c, 0x40], &[0x30, 0x44]),
        (SINGLE, &[0x0c, 0x18, 0x20, 0x34], &[0x04, 0x08, 0x1c, 0x30, 0x38, 0x3c, 0x40, 0x44]),
        (BASIC, &[0x04, 0x0c, 0x2c], &[0x08, 0x18, 0x1c, 0x20, 0x34, 0x40, 0x44]),
    ] {
        let mut tim = Tim::new(kind, 1);
        for offset in present {
            assert!(
                tim.read(*offset, 0).is_ok() && tim.write(*offset, 0, 0).is_ok(),
                "{kind:?} {offset:#x}"
            );
        }
        for offset in absent {
            assert!(
                tim.read(*offset, 0).is_err() && tim.write(*offset, 0, 0).is_err(),
                "{kind:?} {offset:#x}"
            );
        }
    }
}

#[test]
fn a_single_channel_timer_needs_no_main_output_enable() {
    let output = [(0x2c, 1874), (0x34, 625), (0x18, 0x68), (0x20, 0x1)];
    let start = [(0x14, 1), (0x00, 0x81)];
    let tim = timer(SINGLE, 1, &[output.as_slice(), &start].concat());
    let third = Output::High { high: 625, period: 1875 };
    assert_eq!(tim.output(0), third);
}

/// 17.3.2: without preload, an auto-reload value below the present count matches only after the counter has wrapped.
#[test]
fn a_count_beyond_a_new_reload_value_runs_to_the_counters_maximum() {
    let writes = [(0x2c, 5624), (0x14, 1), (0x10, 0), (0x0c, 1), (0x00, 1)];
    let mut tim = timer(GENERAL, 1, &writes);
    tim.write(0x2c, 1528, 1528).unwrap();
    assert_eq!(tim.due, 1529, "not beyond yet");
    tim.write(0x2c, 5624, 1528).unwrap();
    tim.write(0x2c, 1528, 2000).unwrap();
    assert_eq!(tim.due, 0x1_0000);
    assert_eq!(tim.read(0x24, 60_000).unwrap(), 60_000);
    assert_eq!(tim.read(0x24, 0x1_0000 + 7).unwrap(), 7);
    assert_eq!(tim.requests(), [false, true, false, false]);
    assert_eq!(tim.read(0x24, 0x1_0000 + 1529).unwrap(), 0);
}

/// A counter of microseconds at 90 MHz, which wraps after a millisecond, with channel 1 as input of rising edges.
fn microseconds_with_input() -> Tim {
    let input = [(0x28, 89), (0x2c, 999), (0x18, 0x1), (0x20, 0x1)];
    let start = [(0x14, 1), (0x10, 0), (0x00, 1)];
    timer(GENERAL, 2, &[input.as_slice(), &start].concat())
}

/// 17.3.5: the selected edge stores the count and sets CC1IF; reading the count clears it.
#[test]
fn a_rising_edge_stores_the_count_and_reading_it_clears_the_flag() {
    let mut tim = microseconds_with_input();
    assert!(!tim.set_input(0, false, 180 * 10), "no change is no edge");
    assert!(tim.set_input(0, true, 180 * 1234 + 90));
    assert_eq!(tim.read(0x10, 180 * 1300).unwrap() & 2, 2);
    assert_eq!(tim.read(0x34, 180 * 1300).unwrap(), 234);
    assert_eq!(tim.read(0x10, 180 * 1300).unwrap() & 2, 0);
    assert!(!tim.set_input(0, false, 180 * 1400), "a falling edge is not selected");
    assert_eq!(tim.read(0x34, 180 * 1500).unwrap(), 234);
}

/// 17.3.5: a second capture before the first was read replaces it and sets the overcapture flag.
#[test]
fn a_capture_that_was_not_read_is_replaced_and_flagged() {
    let mut tim = microseconds_with_input();
    for us in [100, 200] {
        tim.set_input(0, true, 180 * us);
        tim.set_input(0, false, 180 * (us + 1));
    }
    assert_eq!(tim.read(0x10, 180 * 300).unwrap() & 0x202, 0x202);
    assert_eq!(tim.read(0x34, 180 * 300).unwrap(), 200);
    tim.write(0x10, !0x202, 180 * 300).unwrap();
    assert_eq!(tim.read(0x10, 180 * 300).unwrap() & 0x202, 0);
}

/// The compare value of an input is no output and sets no flag when the count passes it.
#[test]
fn an_input_matches_no_count() {
    let mut tim = microseconds_with_input();
    tim.set_input(0, true, 180 * 500);
    tim.read(0x34, 180 * 501).unwrap();
    assert_eq!(tim.read(0x10, 180 * 5_000).unwrap() & 2, 0);
    assert_eq!(tim.output(0), Output::Released);
    assert!(tim.write(0x18, 0x11, 0).is_err(), "filters are not modelled");
    assert!(tim.write(0x14, 2, 0).is_err(), "capture by software is not modelled");
}
