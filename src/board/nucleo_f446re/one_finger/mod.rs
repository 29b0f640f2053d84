//! One finger, its sensors on the converter's inputs.
//!
//! | pin  | header | signal        | notes                                                   |
//! |------|--------|---------------|---------------------------------------------------------|
//! | PA8  | D7     | bridge IN1    | TIM1 channel 1; external pull-down                      |
//! | PA9  | D8     | bridge IN2    | TIM1 channel 2; external pull-down                      |
//! | PB10 | D6     | bridge enable | high enables; external pull-down                        |
//! | PA6  | D12    | bridge nFAULT | TIM1 break input, low is a fault; external 4.7k pull-up |
//! | PC3  | CN7-37 | comparator test | high: the comparator cuts; external pull-down        |
//! | PA5  | D13    | LED LD2       | lit while the bridge may drive                          |
//!
//! The comparator that watches the second display thermistor pulls nFAULT low too. Its cut of the bridge
//! supply needs no processor; the break input makes the processor know.

mod power;

use stm32f4xx_hal::pac::{GPIOB, RCC, TIM1};
use thermal_display::device::Finger;

pub use power::PowerStage;

/// Fingers of this wiring.
pub const FINGERS: usize = 1;

/// Sampling for 56 cycles, 2.5 us: settling to a quarter of a step takes 9.7 time constants of 7 pF times 6 kOhm
/// inside and 5 kOhm of a 10k/10k divider, 0.75 us; that leaves room for a cold thermistor (30 kOhm, with its
/// partner 7.5 kOhm). With 12 more cycles to convert, seven channels take 21 us of the 62.5 us between two scans.
pub const SAMPLE_TIME: u8 = 3;

/// There is nothing to choose.
pub struct Multiplexer;

impl Multiplexer {
    /// Scans after a switch that may still show the finger before.
    pub const SETTLING_SCANS: usize = 0;

    /// Nothing to do.
    pub fn select(&mut self, _finger: Finger<FINGERS>) {}
}

/// The bridge high-impedance, whatever the program was doing; for the end of it.
pub fn cut() {
    // SAFETY: their owners do not run again: interrupts are off and no caller of this returns. All
    // writes are to registers that may be written at any time.
    let (clocks, timer, pins) = unsafe { (RCC::steal(), TIM1::steal(), GPIOB::steal()) };
    // Without a clock they would take nothing. The start may have ended before they had one; the dsb is the delay that
    // the errata sheet wants after it.
    clocks.apb2enr().modify(|_, w| w.tim1en().enabled());
    clocks.ahb1enr().modify(|_, w| w.gpioben().enabled());
    cortex_m::asm::dsb();
    timer.bdtr().modify(|_, w| w.moe().disabled_idle());
    pins.bsrr().write(|w| w.br10().set_bit());
}
