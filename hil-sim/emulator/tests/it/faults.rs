//! Faults injected into the emulated machine, under the probe image.
use stm32_emulator::{InjectError, LegState, Machine, Stop};
use thermal_sim::processor::{CoreRegister, ResetCause};

use crate::probe;

const MS: u64 = 180_000;
const OFF: [LegState; 2] = [LegState::Off; 2];

type Bench = Machine<probe::Bench>;
type Injection = fn(&mut Bench) -> Result<(), Stop>;

fn legs(machine: &mut Bench) -> [LegState; 2] {
    [machine.pwm(0, 8), machine.pwm(0, 9)]
}

fn run(machine: &mut Bench, cycles: u64) {
    machine.run_until(machine.now() + cycles).expect("runs");
}

#[test]
fn a_hung_core_is_reset_by_the_window_watchdog_and_the_legs_are_off_at_once() {
    let (mut machine, log) = probe::run(22, 100 * MS);
    assert_eq!(
        (log[0], machine.resets().len()),
        (0x0e, 1),
        "no reset while the tick refreshes the watchdog"
    );
    assert_ne!(legs(&mut machine), OFF);
    let conversions = machine.wiring().conversions.len();
    machine.hang_core();
    let hung_at = machine.now();
    run(&mut machine, 44 * MS);
    assert_ne!(legs(&mut machine), OFF, "the timer drives on without its core");
    let more = machine.wiring().conversions.len() - conversions;
    assert!(more.abs_diff(44 * 16 * 7) <= 7, "and samples: {more}");
    run(&mut machine, 5 * MS);
    let reset = probe::only_reset(&machine);
    assert_eq!(reset.cause, ResetCause::WindowWatchdog);
    // 64 periods of 4096 * 2^3 / 45 MHz, less the prescaler's state, from a refresh at most a tick before
    let longest = 64 * 4096 * 8 * 4;
    let shortest = longest - 4096 * 8 * 4 - MS;
    let took = reset.at - hung_at;
    assert!((shortest..=longest).contains(&took), "{took} cycles");
    assert_eq!(machine.wiring().bridge.last(), Some(&(OFF, reset.at)), "in the cycle of the reset");
    assert_eq!(legs(&mut machine), OFF);
    assert_eq!(probe::log(&machine)[0], 0x4e, "the image runs again");
}

#[test]
fn every_reset_releases_the_legs_in_the_same_cycle() {
    let resets: [(Injection, ResetCause); 3] = [
        (Machine::brown_out, ResetCause::BrownOut),
        (Machine::pull_reset_pin, ResetCause::Pin),
        (|machine| machine.power_cycle(7), ResetCause::PowerOn),
    ];
    for (inject, wanted) in resets {
        let (mut machine, _) = probe::run(13, 10 * MS);
        let at = machine.now();
        inject(&mut machine).expect("resets");
        let reset = machine.resets()[1];
        assert_eq!((reset.cause, reset.at), (wanted, at));
        assert_eq!(machine.wiring().bridge.last(), Some(&(OFF, at)));
        assert_eq!(machine.clocks().hclk_hz, 16_000_000);
    }
}

#[test]
fn time_continues_through_a_reset_at_the_changed_clock() {
    let (mut machine, _) = probe::run(13, 10 * MS);
    let at_ps = machine.ps_at(machine.now());
    machine.pull_reset_pin().expect("resets");
    assert_eq!(machine.ps_at(machine.now()) - at_ps, 20_000_000, "the chip is held for 20 us");
    machine.run_until_ps(at_ps + 2_000_000_000).expect("runs");
    assert!(
        machine.ps_at(machine.now()).abs_diff(at_ps + 2_000_000_000) < 1_000_000,
        "within a basic block"
    );
    assert_eq!(machine.clocks().hclk_hz, 180_000_000, "the image has set its clock");
    let conversions = machine.wiring().conversions.len();
    machine.run_until_ps(at_ps + 12_000_000_000).expect("runs");
    let more = machine.wiring().conversions.len() - conversions;
    assert!(more.abs_diff(10 * 16 * 7) <= 7, "{more} conversions in 10 ms");
}

#[test]
fn only_a_power_cycle_changes_the_ram() {
    let (mut machine, _) = probe::run(19, 1_600_000);
    machine.brown_out().expect("resets");
    assert_eq!(probe::words(&machine, "KEPT", 2), [0x00fe_ed00, 1]);
    machine.pull_reset_pin().expect("resets");
    assert_eq!(probe::words(&machine, "KEPT", 2), [0x00fe_ed00, 1]);
    machine.power_cycle(1).expect("resets");
    assert_ne!(probe::words(&machine, "KEPT", 2), [0x00fe_ed00, 1]);
    let noise = machine.memory(0x2001_0000, 4096).expect("RAM");
    let ones: u32 = noise.iter().map(|byte| byte.count_ones()).sum();
    // a fair coin thrown 32768 times: six standard deviations are 543
    assert!(ones.abs_diff(16_384) < 543, "{ones} of 32768 bits are ones");
    run(&mut machine, 20_000);
    assert!(machine.stack_high_water().is_some_and(|bytes| bytes < 4096));
}

#[test]
fn reset_flags_accumulate_until_the_supply_is_lost() {
    let mut machine = probe::machine(19);
    let mut flags_after = |inject: Injection| {
        inject(&mut machine).expect("resets");
        run(&mut machine, 20_000);
        probe::log(&machine)[0]
    };
    assert_eq!(
        flags_after(Machine::pull_reset_pin),
        0x0e,
        "POR, BOR and pin of the power-up, pin again"
    );
    assert_eq!(flags_after(Machine::brown_out), 0x06, "BOR and pin");
    assert_eq!(flags_after(|machine| machine.power_cycle(1)), 0x0e);
}

#[test]
fn flipped_bits_of_core_registers_reach_the_program() {
    let mut machine = probe::machine(26);
    run(&mut machine, 20_000);
    assert_eq!(probe::log(&machine), [1]);
    for (register, bit, wanted) in [
        (CoreRegister::R(4), 7, vec![1]),
        (CoreRegister::S(20), 31, vec![1, 1 << 7, 1 << 31]),
        (CoreRegister::Psr, 30, vec![1, 1 << 7, 1 << 31, 3]),
        (CoreRegister::Pc, 4, vec![1, 1 << 7, 1 << 31, 3, 4, 0xd0e]),
    ] {
        machine.flip_core_bit(register, bit).expect("flips");
        run(&mut machine, 2_000);
        assert_eq!(probe::log(&machine), wanted, "{register} bit {bit}");
    }
}

#[test]
fn a_flipped_bit_of_ram_does_not_count_as_use_of_the_stack() {
    let (mut machine, _) = probe::run(13, 10 * MS);
    let at = probe::firmware().symbol("KEPT").expect("a symbol");
    let old = probe::words(&machine, "KEPT", 1)[0];
    let stack = machine.stack_high_water();
    machine.flip_ram_bit(at + 2, 3).expect("flips");
    assert_eq!(probe::words(&machine, "KEPT", 1), [old ^ 1 << 19]);
    machine.flip_ram_bit(0x2001_0000, 0).expect("flips");
    assert_eq!(machine.stack_high_water(), stack);
}

#[test]
fn flipped_bits_of_peripherals_take_effect() {
    const TIM1_CCR1: u32 = 0x4001_0034;
    const TIM1_BDTR: u32 = 0x4001_0044;
    const ISER1: u32 = 0xe000_e104;
    const ICER1: u32 = 0xe000_e184;
    let (mut machine, _) = probe::run(13, 10 * MS);
    machine.flip_register_bit(TIM1_CCR1, 10).expect("flips");
    run(&mut machine, 3_600);
    let wanted = LegState::Duty { high: 450 + 1024, period: 1800 };
    assert_eq!(machine.pwm(0, 8), wanted);
    machine.flip_register_bit(TIM1_BDTR, 15).expect("flips");
    let at = machine.now();
    assert_eq!(machine.wiring().bridge.last(), Some(&(OFF, at)), "main output off");
    machine.uart_send(b"a");
    run(&mut machine, 3_600);
    let heard = probe::log(&machine).len();
    machine.flip_register_bit(ISER1, 6).expect("flips");
    machine.uart_send(b"b");
    run(&mut machine, 3_600);
    assert_eq!(probe::log(&machine).len(), heard, "USART2's interrupt is disabled");
    machine.flip_register_bit(ICER1, 6).expect("flips");
    run(&mut machine, 3_600);
    assert_eq!(probe::log(&machine).len(), heard + 2, "and enabled again");
}

#[test]
fn faults_in_absent_or_unmodelled_places_are_refused() {
    let (mut machine, _) = probe::run(13, 10 * MS);
    assert_eq!(machine.flip_ram_bit(0x2002_0000, 0), Err(InjectError::NotRam(0x2002_0000)));
    for (register, bit) in [
        (CoreRegister::R(13), 0),
        (CoreRegister::Sp, 1),
        (CoreRegister::Psr, 24),
        (CoreRegister::S(3), 32),
    ] {
        let error = machine.flip_core_bit(register, bit).expect_err("refused");
        assert!(matches!(error, InjectError::NoBit { .. }), "{error}");
    }
    // SPI1 has no model; TIM3's clock is off; GPIOA's clock would stop
    for (address, bit) in [(0x4001_3000, 0), (0x4000_0400, 0), (0x4002_3830, 0)] {
        let error = machine.flip_register_bit(address, bit).expect_err("refused");
        assert!(matches!(error, InjectError::Refused(_)), "{error}");
    }
    assert!(matches!(machine.stop_dma(2, 8), Err(InjectError::NoStream { .. })));
    assert!(matches!(machine.stop_dma(2, 7), Err(InjectError::StreamOff { .. })));
    run(&mut machine, MS);
}

#[test]
fn the_window_watchdog_stops_with_its_clock() {
    const RCC_APB1ENR: u32 = 0x4002_3840;
    let (mut machine, _) = probe::run(22, 10 * MS);
    machine.hang_core();
    machine.flip_register_bit(RCC_APB1ENR, 11).expect("flips");
    run(&mut machine, 100 * MS);
    assert_eq!(machine.resets().len(), 1);
    machine.flip_register_bit(RCC_APB1ENR, 11).expect("flips");
    run(&mut machine, 50 * MS);
    assert_eq!(machine.resets().len(), 2);
}

#[test]
fn a_stopped_stream_delivers_nothing_and_overruns_the_converter() {
    let (mut machine, _) = probe::run(13, 10 * MS);
    machine.stop_dma(2, 0).expect("it runs");
    run(&mut machine, MS);
    let samples = probe::words(&machine, "SAMPLES", 112);
    let conversions = machine.wiring().conversions.len();
    run(&mut machine, 10 * MS);
    assert_eq!(probe::words(&machine, "SAMPLES", 112), samples);
    assert_eq!(machine.wiring().conversions.len(), conversions);
}

#[test]
fn a_stopped_converter_converts_again_after_a_reset() {
    let (mut machine, _) = probe::run(13, 10 * MS);
    let conversions = machine.wiring().conversions.len();
    machine.stop_adc();
    run(&mut machine, 10 * MS);
    assert_eq!(machine.wiring().conversions.len(), conversions);
    machine.pull_reset_pin().expect("resets");
    run(&mut machine, 10 * MS);
    assert!(machine.wiring().conversions.len() > conversions);
}

#[test]
fn clock_security_releases_the_bridge_and_raises_the_nmi() {
    let (mut machine, _) = probe::run(23, 10 * MS);
    assert_ne!(legs(&mut machine), OFF);
    let at = machine.now();
    machine.stop_hse().expect("stops");
    assert_eq!(
        machine.wiring().bridge.last(),
        Some(&(OFF, at)),
        "the clock failure is a break of TIM1"
    );
    run(&mut machine, 1_000);
    assert_eq!(machine.clocks().hclk_hz, 16_000_000);
    assert_eq!(
        probe::log(&machine),
        [0xd0e, 0x4002, 0x80, 0],
        "one NMI, CSSF, running from the internal oscillator"
    );
}

#[test]
fn without_clock_security_the_pins_keep_their_level_until_the_independent_watchdog_resets() {
    let (mut machine, _) = probe::run(24, 5 * MS);
    let executed = machine.stats().instructions;
    machine.stop_hse().expect("stops");
    for _ in 0..3 {
        run(&mut machine, MS / 2);
        for leg in legs(&mut machine) {
            assert!(matches!(leg, LegState::Duty { period: 1, .. }), "a constant level: {leg:?}");
        }
    }
    assert_eq!(machine.stats().instructions, executed);
    machine.run_until_ps(11_000_000_000).expect("runs");
    let reset = machine.resets()[1];
    assert_eq!(reset.cause, ResetCause::IndependentWatchdog);
    assert!(
        (10_000_000_000..10_300_000_000).contains(&reset.at_ps),
        "10 ms after its start, soon after power-up: {reset:?}"
    );
    assert_eq!(machine.wiring().bridge.last(), Some(&(OFF, reset.at)));
    assert_eq!(probe::log(&machine)[0], 0x2e);
}

#[test]
fn an_nmi_is_taken_in_lockup_and_returns_to_it() {
    let (mut machine, log) = probe::run(25, MS);
    assert_eq!(log.len(), 5, "flags, and what the fault handler logged before it locked up");
    machine.stop_hse().expect("stops");
    machine.run_until_ps(5_000_000_000).expect("runs");
    assert_eq!(probe::log(&machine)[5..], [0x4002, 0x80, 0]);
    machine.run_until_ps(12_000_000_000).expect("runs");
    assert_eq!(machine.resets()[1].cause, ResetCause::IndependentWatchdog);
}
