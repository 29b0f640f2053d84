//! Examples of the published crate stm32f4xx-hal 0.23: what each says that it does.
use super::{alternate, assert_near, edges, intervals, machine, run_until_ms};
use stm32_emulator::{Halted, LegState};

const A: u8 = 0;
const C: u8 = 2;
const G: u8 = 6;

/// By a busy loop, the interrupt of TIM2, SysTick, TIM5, the cycle counter, and a task of RTIC on TIM3.
#[test]
fn lights_blink_at_their_rates() {
    let second = Some(1000.0);
    for (name, port, bit, phase_ms, run_ms) in [
        ("blinky", C, 13, None, 50),
        ("blinky-timer-irq", A, 5, second, 2100),
        ("delay-syst-blinky", A, 5, second, 2100),
        ("delay-timer-blinky", C, 13, second, 1100),
        ("dwt-blinky", G, 13, second, 2100),
        ("dwt-blinky", G, 14, second, 2100),
        ("rtic-tick", C, 13, second, 2100),
    ] {
        let mut machine = machine(name);
        run_until_ms(&mut machine, run_ms);
        let edges = edges(&machine, port, bit);
        assert!(edges.len() > 1 && alternate(&edges), "{name}: {edges:?}");
        for interval in intervals(&edges) {
            assert_near(name, interval, phase_ms.unwrap_or(interval));
        }
    }
}

#[test]
fn a_button_toggles_a_light_when_it_is_pressed() {
    let mut machine = machine("rtic-button");
    machine.wiring_mut().button = Some(true);
    let mut lit = Vec::new();
    for level in [true, false, true, true, false] {
        machine.wiring_mut().button = Some(level);
        let ms = 10 * (1 + lit.len() as u64);
        run_until_ms(&mut machine, ms);
        lit.push(machine.gpio_output(C, 13) == Some(true));
    }
    assert_eq!(lit, [false, true, true, true, false]);
}

#[test]
fn pwm_has_half_the_period() {
    let mut machine = machine("pwm");
    run_until_ms(&mut machine, 1);
    let half = LegState::Duty { high: 50, period: 100 };
    assert_eq!(machine.pwm(A, 8), half);
}

/// Half waves of 100 steps on two channels in turn, a step each 100 us.
#[test]
fn pwm_follows_a_sine() {
    let mut machine = machine("pwm-sinus");
    let mut duties = Vec::new();
    for tenth_ms in 0..600 {
        let result = machine.run_until_ps(tenth_ms * 100_000_000);
        result.unwrap_or_else(|stop| panic!("{stop}"));
        duties.push([8, 9].map(|bit| machine.pwm(A, bit).duty().unwrap_or_default()));
    }
    // The first complete wave of the first channel.
    let start = (200..400).find(|k| duties[*k][0] > 0.0 && duties[k - 1][0] == 0.0);
    let start = start.expect("a wave begins");
    for step in 1..200 {
        let angle = std::f64::consts::PI * step as f64 / 100.0;
        let [first, second] = duties[start + step - 1];
        let expected = angle.sin();
        assert!((first - expected.max(0.0)).abs() < 0.02, "step {step}: {first}, {expected}");
        assert!((second - (-expected).max(0.0)).abs() < 0.02, "step {step}: {second}, {expected}");
    }
}

/// Number of the breakpoint, and operations, of semihosting.
const SEMIHOSTING: u8 = 0xab;
const OPEN: u32 = 0x01;
const WRITE: u32 = 0x05;

/// Runs an example under a debugger; what it prints, with the times in ms.
fn prints(name: &str, run_ms: u64) -> Vec<(String, u64)> {
    let mut machine = machine(name);
    machine.restart_under_debugger().expect("it starts");
    let mut printed = Vec::new();
    while let Some(halted) = machine.run_until_halted(run_ms * 1_000_000_000).unwrap() {
        assert_eq!(halted, Halted::Breakpoint(SEMIHOSTING));
        let answer = match machine.call_registers() {
            [OPEN, _] => 1,
            [WRITE, block] => {
                let words = machine.memory(block, 12).unwrap();
                let [_, text, bytes] = [0, 4, 8]
                    .map(|at| u32::from_le_bytes(*words[at..].first_chunk().expect("three words")));
                let text = machine.memory(text, bytes as usize).unwrap();
                let ms = machine.ps_at(machine.now()) / 1_000_000_000;
                printed.push((String::from_utf8(text).unwrap().trim().to_owned(), ms));
                0
            }
            call => panic!("{call:x?}"),
        };
        machine.continue_behind_breakpoint(Some(answer)).unwrap();
    }
    printed.retain(|(text, _)| !text.is_empty());
    printed
}

#[test]
fn timers_expire_when_their_examples_print_so() {
    for (name, period_ms) in [("timer-periph", 1000), ("timer-syst", 42)] {
        let printed = prints(name, 4 * period_ms + 10);
        let expected = [
            ("hello!", 0),
            ("timer expired 1", period_ms),
            ("timer expired 2", 2 * period_ms),
            ("timer expired 3", 3 * period_ms),
            ("ehy, you cannot cancel a timer two times!", 3 * period_ms),
        ];
        assert_eq!(printed, expected.map(|(text, ms)| (text.to_owned(), ms)), "{name}");
    }
    // The pin is a floating input for one of three seconds.
    let printed = prints("dynamic-gpio", 4100);
    assert_eq!(printed, [1000, 4000].map(|ms| ("false".to_owned(), ms)));
}

/// What the chip cannot do, or the machine has no model of, ends the run at the first register concerned.
#[test]
fn other_examples_end_at_the_register_that_is_not_modelled() {
    for (name, expected) in [
        ("i2c_scanner", "I2C1+0x0 at 0x40005400 is not modelled"),
        ("pwm-dead-time", "TIM1_CCER (TIM CCER.CCxNE (complementary outputs)) at 0x40010020"),
        (
            "pwm-input",
            "TIM8_CCMR1 (TIM CCMR.CCxS (capture from another channel's input, or from TRC)) at 0x40010418",
        ),
        ("qei", "TIM2_SMCR (TIM SMCR (slave modes)) at 0x40000008"),
        ("rtc", "RCC_BDCR (oscillator and clock of the RTC) at 0x40023870"),
        ("serial", "USART1_BRR at 0x40011008 is not modelled"),
        ("serial-9bit", "USART2_CR1 (USART_CR1 beyond 8N1"),
        // A mistake of the example: the HAL halves PCLK2, 84 MHz, and the converter allows 36 MHz.
        ("rtic-adc-dma", "ADCCLK = 42000000 Hz is outside"),
    ] {
        let mut machine = machine(name);
        let stop = machine.run_until_ps(1_100_000_000_000).expect_err(name).to_string();
        assert!(stop.contains(expected), "{name}: {stop}");
    }
}
