//! What the release image does when the microcontroller or its board is not as it should be: option bytes, clock, debugger,
//! PWM settings, internal oscillator, serial line.

use crc::{CRC_32_MPEG_2, Crc};
use image_tests::{Bare, START, image};
use stm32_emulator::{FLASH_BASE, Firmware};
use system_tests::flash::erased;
use thermal_sim::processor::{ChipState, ResetCause};

/// Cycles of a millisecond.
const MS: u64 = 180_000;
/// DBGMCU_APB1_FZ and APB2_FZ, and BDTR of TIM1.
const APB1_FREEZE: u32 = 0xe004_2008;
const APB2_FREEZE: u32 = 0xe004_200c;
const TIM1_BDTR: u32 = 0x4001_0044;
/// The fault of a device without anything at its pins.
const NO_SENSORS: &str = "excitation";

fn started(chip: &ChipState) -> Bare {
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    let mut device = Bare::with_chip(&firmware, &erased(), chip);
    device.run(START);
    device
}

fn fault(device: &mut Bare) -> String {
    value_of(&device.answer("state"), "fault")
}

/// The value of a key in an answer.
fn value_of(answer: &str, key: &str) -> String {
    let mut words = answer.split(' ');
    let value = words.find_map(|word| word.strip_prefix(key)?.strip_prefix('='));
    value.unwrap_or_else(|| panic!("no {key} in {answer}")).to_owned()
}

fn board(device: &mut Bare, key: &str) -> String {
    value_of(&device.answer("board"), key)
}

fn reset_causes(device: &Bare) -> Vec<ResetCause> {
    device.0.resets().iter().map(|reset| reset.cause).collect()
}

/// CRC-32/MPEG-2 of the program's words, each from its most significant byte on.
fn program_digest(firmware: &Firmware) -> u32 {
    let place = |name| (firmware.symbol(name).expect("in memory.x") - FLASH_BASE) as usize;
    let (words, _) = firmware.flash()[place("_stext")..place("_program_end")].as_chunks::<4>();
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.iter().rev().copied()).collect();
    Crc::<u32>::new(&CRC_32_MPEG_2).checksum(&bytes)
}

#[test]
fn a_prepared_board_reports_that_it_is() {
    let mut device = started(&ChipState::default());
    let program = program_digest(&Firmware::from_file(image()).unwrap());
    assert_eq!(
        device.answer("board"),
        format!(
            "ok bor=3 watchdogs=running clock=hse pwm_lock=3 reset=power-on rx_overruns=0 rx_framing=0 rx_noise=0 \
         tx_dropped=0 uid=53494D550046001400460018 program={program:08x}"
        )
    );
}

#[test]
fn a_brown_out_level_other_than_the_highest_trips_until_it_is_set() {
    for (brown_out_code, level) in [(3, "0"), (2, "1"), (1, "2")] {
        let mut device = started(&ChipState { brown_out_code, ..ChipState::default() });
        assert_eq!(fault(&mut device), "brown-out-level");
        assert_eq!(board(&mut device, "bor"), level);
        assert!(device.answer("clear").starts_with("err fault "));
        assert_eq!(fault(&mut device), "brown-out-level");
    }
    assert_eq!(fault(&mut started(&ChipState::default())), NO_SENSORS);
}

#[test]
fn a_clock_that_comes_late_restarts_the_device_without_a_fault() {
    // Strict, because only here the handler of a failed clock returns.
    let late = ChipState { external_clock: false, strict: true, ..ChipState::default() };
    let mut device = started(&late);
    assert_eq!(fault(&mut device), "clock");
    assert_eq!(board(&mut device, "clock"), "hsi");
    assert!(device.answer("clear").starts_with("err fault "));
    assert_eq!(fault(&mut device), "clock");

    // It comes and goes: each time for less than a second.
    for _ in 0..3 {
        device.0.start_hse();
        device.run(900 * MS);
        device.0.stop_hse().expect("the device does not depend on it");
        device.run(200 * MS);
    }
    assert_eq!(reset_causes(&device), [ResetCause::PowerOn]);
    assert_eq!(board(&mut device, "clock"), "hsi");

    device.0.start_hse();
    device.run(990 * MS);
    assert_eq!(reset_causes(&device), [ResetCause::PowerOn]);
    device.run(20 * MS + START);
    assert_eq!(reset_causes(&device), [ResetCause::PowerOn, ResetCause::Software]);
    assert_eq!(board(&mut device, "clock"), "hse");
    assert_eq!(board(&mut device, "reset"), "software");
    assert_eq!(fault(&mut device), NO_SENSORS, "neither clock nor reset");

    // The order holds for one reset.
    device.0.request_reset().expect("starts anew");
    device.run(START);
    assert_eq!(fault(&mut device), NO_SENSORS, "the earlier cause is kept");
}

#[test]
fn a_clock_that_fails_in_use_is_a_fault_that_outlasts_its_return() {
    let mut device = started(&ChipState::default());
    device.answer("cause");
    device.0.power_cycle(3).expect("starts anew");
    device.run(100_000);
    device.run_until(MS, |machine| machine.clocks().hclk_hz == 180_000_000);
    device.0.stop_hse().expect("injected");
    device.run(2 * START);
    assert_eq!(fault(&mut device), "clock");
    device.0.start_hse();
    device.run(1100 * MS + START);
    assert_eq!(board(&mut device, "clock"), "hse");
    assert_eq!(fault(&mut device), "clock", "stored through the restart");
}

#[test]
fn debug_freeze_bits_trip_and_a_start_clears_them() {
    for (register, bit) in [
        (APB1_FREEZE, 11),
        (APB1_FREEZE, 12),
        (APB2_FREEZE, 0),
        (APB2_FREEZE, 1),
        (APB2_FREEZE, 17),
        (APB2_FREEZE, 18),
    ] {
        let firmware = Firmware::from_file(image()).expect("an image for this chip");
        let mut device = Bare::switched_on(&firmware, &erased());
        device.run_until(100, |machine| machine.wiring().converted_at > 0);
        device.0.flip_register_bit(register, bit).expect("injected");
        device.run(5 * MS);
        assert_eq!(board(&mut device, "watchdogs"), "frozen");
        assert_eq!(fault(&mut device), "watchdogs-frozen", "{register:#x} {bit}");
        device.0.pull_reset_pin().expect("starts anew");
        device.run(START);
        assert_eq!(board(&mut device, "watchdogs"), "running");
        assert_eq!(fault(&mut device), "watchdogs-frozen", "the cause is kept");
    }
}

#[test]
fn a_debugger_that_halts_the_core_ends_in_a_reset_unless_it_freezes_the_watchdogs() {
    let mut device = started(&ChipState::default());
    device.0.halt_by_debugger();
    device.run(50 * MS);
    assert_eq!(reset_causes(&device), [ResetCause::PowerOn, ResetCause::WindowWatchdog]);

    let mut device = started(&ChipState::default());
    for bit in [11, 12] {
        device.0.flip_register_bit(APB1_FREEZE, bit).expect("injected");
    }
    device.0.halt_by_debugger();
    device.run(1000 * MS);
    assert_eq!(reset_causes(&device), [ResetCause::PowerOn], "frozen");
    device.0.continue_by_debugger();
    assert_eq!(board(&mut device, "watchdogs"), "frozen");
}

#[test]
fn pwm_settings_that_change_in_spite_of_their_lock_trip() {
    for bit in [8, 9, 10, 12, 13, 14] {
        let firmware = Firmware::from_file(image()).expect("an image for this chip");
        let mut device = Bare::switched_on(&firmware, &erased());
        device.run_until(100, |machine| machine.wiring().converted_at > 0);
        device.0.flip_register_bit(TIM1_BDTR, bit).expect("injected");
        device.run(5 * MS);
        assert_eq!(fault(&mut device), "pwm-settings", "bit {bit}");
    }
}

/// DS10693: the oscillator of the independent watchdog has 17 to 47 kHz.
#[test]
fn the_image_runs_at_both_ends_of_the_internal_oscillator() {
    for lsi_hz in [17_000, 32_000, 47_000] {
        for external_clock in [true, false] {
            let mut device = started(&ChipState { lsi_hz, external_clock, ..ChipState::default() });
            // A second of lines, sent as fast as the line carries them.
            for _ in 0..40 {
                let lines = "settings 1\nstate\ncause\n".repeat(4);
                device.ask(&lines, 25 * MS);
            }
            assert_eq!(reset_causes(&device), [ResetCause::PowerOn], "{lsi_hz} Hz");
        }
    }
}

#[test]
fn bytes_that_the_line_damages_are_counted() {
    let mut device = started(&ChipState::default());
    device.0.set_host_baud(900_000);
    device.ask("state", 5 * MS);
    device.0.set_host_baud(1_000_000);
    device.ask("", 5 * MS);
    assert_ne!(board(&mut device, "rx_framing"), "0");
    assert_eq!(board(&mut device, "rx_overruns"), "0");
}
