//! The emulated peripherals under the probe image: refusals, clocks, converter, serial port, watchdogs, repeatability.
use stm32_emulator::{LegState, Stop};
use thermal_sim::processor::ResetCause;

use crate::probe;

const SECOND: u64 = 180_000_000;

/// A case ends early, and the reason begins with `expected`.
fn assert_ends(case: u8, expected: &str) {
    let stop = probe::machine(case).run_until(10_000_000);
    let stop = stop.expect_err("the case ends early").to_string();
    assert!(stop.starts_with(expected), "case {case}: {stop}");
}

#[test]
fn an_unmodelled_register_ends_the_run_and_is_named() {
    assert_ends(8, "SPI1+0x0 at 0x40013000 is not modelled: 32-bit read, value 0x0, in probe::");
}

#[test]
fn a_write_to_a_peripheral_without_clock_ends_the_run() {
    assert_ends(
        9,
        "TIM2 used at 0x4000002c while its clock is off (set RCC_APB1ENR bit 0 first): 32-bit write in",
    );
}

#[test]
fn a_read_from_a_peripheral_without_clock_ends_the_run() {
    assert_ends(
        7,
        "USART2 used at 0x40004400 while its clock is off (set RCC_APB1ENR bit 17 first): 32-bit read in",
    );
}

#[test]
fn the_signature_has_the_flash_size_and_external_memory_ends_the_run() {
    let mut machine = probe::machine(15);
    let stop = machine.run_until(100_000).expect_err("stops");
    assert_eq!(probe::log(&machine), [512]);
    assert!(
        matches!(&stop, Stop::NotModelled { register, .. } if register == "QUADSPI+0x0"),
        "{stop}"
    );
    assert_eq!(machine.run_until(200_000), Err(stop), "again");
}

#[test]
fn the_break_input_releases_both_legs() {
    let (mut machine, _) = probe::run(13, SECOND / 100);
    assert_ne!(machine.pwm(0, 8), LegState::Off);
    machine.wiring_mut().break_pin = Some(true);
    machine.run_until(machine.now() + SECOND / 16_000).expect("runs");
    assert_eq!([machine.pwm(0, 8), machine.pwm(0, 9)], [LegState::Off; 2]);
    assert_eq!(machine.wiring().bridge.last().map(|b| b.0), Some([LegState::Off; 2]));
}

#[test]
fn too_few_wait_states_end_the_run() {
    assert_ends(
        10,
        "FLASH_ACR.LATENCY = 4 is too small for HCLK = 180000000 Hz, which needs 5 (in",
    );
}

#[test]
fn an_unmodelled_mode_ends_the_run() {
    for case in [11, 16] {
        assert_ends(
            case,
            "TIM3_SMCR (TIM SMCR (slave modes)) at 0x40000408 is not modelled: 32-bit write, value 0x3, in",
        );
    }
}

#[test]
fn stores_of_bytes_and_half_words_to_a_port_leave_the_rest_of_the_register() {
    let (_, log) = probe::run(60, 10_000);
    assert_eq!(log, [0xab34, 0x5678, 0x8000, 0xd0e]);
}

#[test]
fn a_half_word_store_to_a_register_of_32_bits_ends_the_run() {
    assert_ends(
        61,
        "TIM2_ARR (access width) at 0x4000002c is not modelled: 16-bit write, value 0x63, in",
    );
}

#[test]
fn a_stream_that_is_enabled_while_its_flags_stand_ends_the_run() {
    assert_ends(
        62,
        "DMA1_S6CR at 0x400260a0: EN is set while flags of the stream stand in LISR or HISR; they must be cleared first",
    );
}

#[test]
fn a_trigger_before_the_converter_is_stable_ends_the_run() {
    assert_ends(
        63,
        "ADC1_CR2 at 0x40012008: a conversion starts less than 3 us after ADON was set (DS10693, t_STAB) (in probe::",
    );
}

#[test]
fn a_pin_that_is_high_when_its_rising_edge_is_selected_does_not_pend() {
    let (_, log) = probe::run(64, 10_000);
    assert_eq!(log, [0, 1 << 6, 0xd0e]);
}

#[test]
fn the_watchdog_resets_ten_milliseconds_after_the_last_feed() {
    let (machine, log) = probe::run(12, 1_000_000);
    assert_eq!(
        log,
        [0x2e, 0, 0xd0e],
        "flags after the reset (start-up has cleared the log), flags cleared"
    );
    let reset = probe::only_reset(&machine);
    assert_eq!(reset.cause, ResetCause::IndependentWatchdog);
    let feeds: Vec<u64> =
        machine.wiring().outputs.iter().filter(|o| o.1 == 5).map(|o| o.3).collect();
    let [_low, first, second, third, _gone] = feeds[..] else { panic!("{feeds:?}") };
    assert!(second - first > 30_000 && third - second > 30_000);
    let ten_milliseconds = 160_000;
    assert!(
        (ten_milliseconds..ten_milliseconds + 100).contains(&(reset.at - third)),
        "{reset:?}, fed at {third}"
    );
}

#[test]
fn the_window_watchdog_resets_when_it_is_no_longer_refreshed() {
    let (machine, log) = probe::run(19, 1_600_000);
    assert_eq!(
        log,
        [0x4e, 0x00fe_ed00, 1, 0xd0e],
        "flags; RAM that start-up leaves alone has survived; one early interrupt"
    );
    let reset = probe::only_reset(&machine);
    assert_eq!(reset.cause, ResetCause::WindowWatchdog);
    let refreshes: Vec<u64> = machine
        .wiring()
        .outputs
        .iter()
        .filter(|output| output.2 == Some(true))
        .map(|output| output.3)
        .collect();
    let [_first, third] = refreshes[..] else { panic!("{refreshes:?}") };
    let periods = (reset.at - third) as f64 / 4096.0;
    assert!(
        (63.0..=64.0).contains(&periods),
        "{periods} periods of 4096 cycles after the refresh; the prescaler runs freely"
    );
}

#[test]
fn a_refresh_outside_the_window_resets_at_once() {
    let (machine, log) = probe::run(20, 20_000);
    assert_eq!(log, [0x4e, 0x00fe_ed00, 0, 0xd0e]);
    assert_eq!(machine.resets()[1].cause, ResetCause::WindowWatchdog);
}

#[test]
fn the_load_of_the_product_keeps_its_rates() {
    let (mut machine, log) = probe::run(13, SECOND / 10);
    assert_eq!(log, [1, 0xd0e]);
    let clocks = machine.clocks();
    assert_eq!(
        (clocks.hclk_hz, clocks.pclk1_hz, clocks.pclk2_hz),
        (180_000_000, 45_000_000, 90_000_000)
    );
    assert_eq!(machine.pwm(0, 8), LegState::Duty { high: 450, period: 1800 });
    assert_eq!(machine.pwm(0, 8).duty(), Some(0.25));
    assert_eq!(machine.pwm(0, 9).duty(), Some(0.0));
    let from = machine.now();
    let (conversions, bytes) = (machine.wiring().conversions.len(), machine.wiring().sent.len());
    let ticks = |m: &stm32_emulator::Machine<probe::Bench>| {
        let interrupts = m.stats().interrupts;
        let tick = interrupts.iter().find(|i| i.name == "SysTick");
        tick.map_or(0, |i| i.count)
    };
    let ticks_before = ticks(&machine);
    machine.run_until(from + SECOND).expect("runs");
    let bench = machine.wiring();
    assert!((bench.conversions.len() - conversions).abs_diff(112_000) <= 7);
    assert!((bench.sent.len() - bytes).abs_diff(100_000) <= 1, "10 bits a byte at 1 Mbit/s");
    assert_eq!(bench.baud, 1_000_000);
    assert_eq!((ticks(&machine) - ticks_before).abs_diff(1000), 0);
    let starts: Vec<u64> = bench.conversions.iter().filter(|c| c.0 == 0).map(|c| c.1).collect();
    assert!(
        starts.windows(2).all(|pair| pair[1] - pair[0] == SECOND / 16_000),
        "sampling has no jitter"
    );
    let scan: Vec<_> =
        bench.conversions[..7].iter().map(|c| (c.0, c.1 - bench.conversions[0].1)).collect();
    let conversion = (56 + 12) * 8;
    assert_eq!(scan, (0..7).map(|i| (i, u64::from(i) * conversion)).collect::<Vec<_>>());
    assert!(bench.sent.windows(2).all(|pair| pair[1].1 - pair[0].1 == 1800));
    let samples = probe::words(&machine, "SAMPLES", 7);
    let wanted = [(0, 1), (2, 3), (4, 5), (6, 0), (1, 2), (3, 4), (5, 6)];
    let code = |channel: u32| 100 * channel + 7;
    assert_eq!(samples, wanted.map(|(low, high)| code(low) | code(high) << 16));
}

#[test]
fn received_bytes_arrive_by_interrupt() {
    let (mut machine, _) = probe::run(13, SECOND / 100);
    machine.uart_send(b"ok?");
    let from = machine.now();
    machine.run_until(from + 3 * 1800 - 1).expect("runs");
    assert_eq!(probe::log(&machine)[2..], [0x5a00_0020, b'o'.into(), 0x5a00_0020, b'k'.into()]);
    machine.run_until(from + 4 * 1800).expect("runs");
    assert_eq!(probe::log(&machine)[6..], [0x5a00_0020, b'?'.into()]);
}

#[test]
fn a_host_rate_more_than_3_percent_off_causes_framing_errors() {
    for (baud, framing_error) in [(1_029_000, 0), (972_000, 0), (1_040_000, 2), (500_000, 2)] {
        let (mut machine, _) = probe::run(14, SECOND / 100);
        machine.set_host_baud(baud);
        machine.uart_send(b"U");
        machine.run_until(machine.now() + 10_000).expect("runs");
        assert_eq!(probe::log(&machine)[1], 0x5a00_0020 | framing_error, "host at {baud}");
    }
}

#[test]
fn two_runs_are_identical() {
    let run = |steps: u64| {
        let mut machine = probe::machine(13);
        for step in 1..=steps {
            machine.run_until(step * SECOND / steps / 5).expect("runs");
        }
        (machine.stats(), machine.stack_high_water(), std::mem::take(machine.wiring_mut()))
    };
    let (stats, stack, bench) = run(1);
    let (stats_again, stack_again, bench_again) = run(1);
    assert_eq!((&stats, stack), (&stats_again, stack_again));
    assert_eq!(bench.conversions, bench_again.conversions);
    assert_eq!(bench.sent, bench_again.sent);
    let (_, _, in_steps) = run(777);
    assert_eq!(bench.conversions, in_steps.conversions, "in one run and in 777 parts");
    assert!(stack.is_some_and(|bytes| bytes > 0 && bytes < 4096), "{stack:?}");
}
