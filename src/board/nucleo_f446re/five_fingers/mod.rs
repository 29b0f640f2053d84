//! Five fingers, whose sensors take turns on the converter's inputs.
//!
//! Each of the seven inputs of the one-finger wiring has an 8:1 analog multiplexer (74HC4051 and its kin) and a
//! voltage follower in front of it. Three lines choose the finger for all seven.
//!
//! | finger | bridge IN1, IN2               | bridge enable | nFAULT | comparator test |
//! |--------|-------------------------------|---------------|--------|-----------------|
//! | 0      | PA8, PA9, TIM1 channel 1, 2   | PB10          | PA6    | PC3             |
//! | 1      | PA10, PA11, TIM1 channel 3, 4 | PB13          | PA7    | PC4             |
//! | 2      | PC6, PC7, TIM8 channel 1, 2   | PB14          | PA12   | PC5             |
//! | 3      | PC8, PC9, TIM8 channel 3, 4   | PB15          | PB5    | PB6             |
//! | 4      | PB8, PB9, TIM10, TIM11        | PB1           | PB12   | PB7             |
//!
//! | pin              | signal                                                                    |
//! |------------------|---------------------------------------------------------------------------|
//! | PC10, PC11, PC12 | finger that the multiplexers show, bits 0 to 2; external pull-downs       |
//! | PA5              | not used; the LED of a finger hangs on its bridge's enable line           |
//!
//! IN1, IN2, enable and test have external pull-downs, so all bridges are high-impedance from reset on; nFAULT has a
//! pull-up of 4.7k, and the comparator of the finger's second display thermistor pulls it low too. All four timers
//! run at 180 MHz, so all bridges have the same period; only one leg of a bridge switches at a time, so that TIM10
//! and TIM11 need not run in step.
//!
//! The fault lines are ordinary inputs: five do not fit two break inputs, and a break would stop the neighbour too.
//! A driver in trouble and a comparator cut their own bridge without the processor, which is told for at
//! least 4 ms (the driver's retry time) and looks every millisecond. A failing clock stops TIM1 and TIM8 by hardware and
//! all five by the non-maskable interrupt.
//!
//! # Time
//! A finger's 16 scans follow each other, so the multiplexers switch five times a millisecond and not eighty:
//!
//! ```text
//! us    0                       200                     400              1000
//! scan  |x x 0 1 2 ... 14 15    |x x 0 1 2 ... 14 15    |x x 0 ...       |
//! shows |finger 0               |finger 1               |finger 2        |finger 0
//! tick                          ^ of finger 0           ^ of finger 1
//! ```
//!
//! The interrupt that brings the scans of one finger switches to the next one first of all. The first scan (`x`) may
//! show the finger before; the second is left out too, so that the program has 11 us to switch and the
//! multiplexers with their followers 11 us to settle. If the program is late, the samples are unknown and all
//! bridges go off.
//!
//! 90 000 scans a second against 96 000 periods of PWM: the phase of the ripple repeats after 15 scans, so that of the
//! ripple's amplitude at most a sixteenth remains in a sum of 16.

mod multiplexer;
mod power;

use stm32f4xx_hal::pac::{GPIOB, RCC, TIM1, TIM8};

pub use multiplexer::Multiplexer;
pub use power::{Lines, PowerStage, Wires};

/// Fingers of this wiring.
pub const FINGERS: usize = 5;

/// Sampling for 15 cycles, 0.67 us: behind a follower, 7 pF times 6 kOhm inside settle to a quarter of a step in 0.41 us.
/// With 12 more cycles to convert, seven channels take 8.4 us of the 11.1 us between two scans, and 630 conversions
/// 756 us of a millisecond.
pub const SAMPLE_TIME: u8 = 1;

/// All bridges high-impedance, whatever the program was doing; for the end of it.
pub fn cut() {
    // SAFETY: their owners do not run again: interrupts are off and no caller of this returns. The writes are to
    // registers that may be written at any time.
    let (clocks, left, right, pins) =
        unsafe { (RCC::steal(), TIM1::steal(), TIM8::steal(), GPIOB::steal()) };
    // As for one finger: without a clock they would take nothing.
    (clocks.apb2enr()).modify(|_, w| w.tim1en().enabled().tim8en().enabled());
    clocks.ahb1enr().modify(|_, w| w.gpioben().enabled());
    cortex_m::asm::dsb();
    pins.bsrr().write(|w| {
        w.br1().set_bit();
        w.br10().set_bit();
        w.br13().set_bit();
        w.br14().set_bit();
        w.br15().set_bit()
    });
    left.bdtr().modify(|_, w| w.moe().disabled_idle());
    right.bdtr().modify(|_, w| w.moe().disabled_idle());
}
