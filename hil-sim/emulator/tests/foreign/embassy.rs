//! Programs of ours on embassy-stm32 0.6 and its executors.
use super::{alternate, assert_near, edges, intervals, machine, run_until_ms};
use stm32_emulator::LegState;

const A: u8 = 0;
const B: u8 = 1;
const C: u8 = 2;

/// Phases in ms during which a pin is at `level`: begin and length.
fn phases(edges: &[(bool, f64)], level: bool) -> Vec<(f64, f64)> {
    let pairs = edges.windows(2).filter(|pair| pair[0].0 == level);
    pairs.map(|pair| (pair[0].1, pair[1].1 - pair[0].1)).collect()
}

/// Tasks keep their times to 0.1 ms while those of lower priority are busy.
#[test]
fn executors_of_higher_priority_preempt_those_of_lower() {
    let mut machine = machine("preemption");
    run_until_ms(&mut machine, 300);
    let [thread, middle, high] =
        [(A, 5), (B, 0), (C, 1)].map(|(port, bit)| edges(&machine, port, bit));
    for edges in [&thread, &middle, &high] {
        assert!(alternate(edges));
    }
    assert!(high.len() >= 299, "{}", high.len());
    for interval in intervals(&high) {
        assert_near("each ms", interval, 1.0);
    }
    let busy_2_ms = phases(&middle, true);
    assert_eq!(busy_2_ms.len(), 59, "{middle:?}");
    for (begin, length) in &busy_2_ms {
        let nearest = (begin / 5.0).round() * 5.0;
        assert_near("each 5 ms", *begin, nearest + busy_2_ms[0].0 - 5.0);
        assert_near("busy", *length, 2.1);
    }
    let busy_20_ms = phases(&thread, true);
    assert_eq!(busy_20_ms.len(), 10, "{thread:?}");
    for (begin, length) in busy_20_ms {
        // An executor of higher priority may hold the end back for as long as it is busy.
        assert!((19.9..22.3).contains(&length), "{length} ms at {begin} ms");
    }
}

#[test]
fn drivers_do_at_the_pins_what_the_program_asks() {
    let mut machine = machine("drivers");
    machine.set_host_baud(115_200);
    run_until_ms(&mut machine, 10);
    assert_eq!(machine.clocks().hclk_hz, 180_000_000);
    // 20 kHz of a timer clock of 180 MHz, a quarter high.
    assert_eq!(machine.pwm(A, 8), LegState::Duty { high: 2250, period: 9000 });
    let sent = |from: usize, machine: &stm32_emulator::Machine<_>| {
        let wiring: &crate::support::Bench = machine.wiring();
        wiring.sent[from..].iter().map(|(byte, _)| *byte).collect::<Vec<u8>>()
    };
    // Codes of PA1 and PA4, which the bench makes of their channels.
    assert_eq!(sent(0, &machine), [107u16, 407].map(u16::to_be_bytes).concat());

    for (ms, level) in [(20, true), (30, true), (40, false)] {
        machine.wiring_mut().case = u8::from(level);
        run_until_ms(&mut machine, ms);
        assert_eq!(machine.gpio_output(A, 5), Some(level), "at {ms} ms");
    }

    machine.uart_send(b"one");
    run_until_ms(&mut machine, 50);
    machine.uart_send(b"a longer message");
    run_until_ms(&mut machine, 60);
    assert_eq!(String::from_utf8_lossy(&sent(4, &machine)), "enoegassem regnol a");
}
