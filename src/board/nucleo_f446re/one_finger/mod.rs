//! Wiring for one finger, whose sensors are connected to the inputs of the converter.
//!
//! | pin  | header | signal        | notes                                                   |
//! |------|--------|---------------|---------------------------------------------------------|
//! | PA8  | D7     | bridge IN1    | TIM1 channel 1; external pull-down                      |
//! | PA9  | D8     | bridge IN2    | TIM1 channel 2; external pull-down                      |
//! | PB10 | D6     | bridge enable | high enables; external pull-down                        |
//! | PA6  | D12    | bridge nFAULT | TIM1 break input, low is a fault; external 4.7k pull-up |
//! | PC3  | CN7-37 | comparator test | high connects the input to a level; external pull-down |
//! | PA5  | D13    | LED LD2       | lit while the bridge may drive                          |
//! | PC5  | CN10-6 | heat flux     | ADC2 channel 15                                         |
//!
//! The comparator that monitors the second display thermistor disconnects the supply of the bridge
//! without the processor. It also pulls nFAULT low, so that the break input reports the trip to the
//! processor.

mod flux_converter;
mod power_stage;

use stm32f4xx_hal::pac::{GPIOB, RCC, TIM1};
use thermal_display::device::FingerIndex;

pub use flux_converter::FluxConverter;
pub use power_stage::FingerPowerStage;

/// Number of fingers that this wiring controls, each with its own bridge and sensors.
pub const FINGERS: usize = 1;

/// Code in the registers SMPR1 and SMPR2 of ADC1 for a sampling time of 56 cycles at 22.5 MHz, 2.5
/// us.
///
/// The input of the converter must settle to a quarter of a count, which takes 9.7 time constants:
/// 0.75 us with 7 pF and 6 kOhm inside the converter and 5 kOhm of a 10k/10k divider. The margin is
/// for a cold thermistor of 30 kOhm, whose divider has 7.5 kOhm. With 12 more cycles for each
/// conversion, the eight channels of a scan take 24 us of the 62.5 us between two scans.
pub const SAMPLE_TIME_CODE: u8 = 3;

/// Takes the place of the multiplexers of the five-finger wiring, so that both wirings use the same
/// sampler; one finger needs no multiplexer.
pub struct NoMultiplexer;

pub use NoMultiplexer as Multiplexer;

impl NoMultiplexer {
    /// Number of scans to drop after each switch to another finger: none, because a single finger
    /// is never switched.
    pub const SETTLING_SCANS: usize = 0;

    /// Does nothing, because a single finger needs no multiplexer.
    pub fn select(&mut self, _finger: FingerIndex<FINGERS>) {}

    /// Always true, because a single finger needs no multiplexer.
    pub fn can_have_selected(&self, _finger: FingerIndex<FINGERS>) -> bool {
        true
    }
}

/// Makes the outputs of the bridge high-impedance by direct writes to the registers, in any state
/// of the program, also before the bridge is set up. For the handlers of fatal errors, after which
/// the program must not continue.
pub fn disable_bridges() {
    // SAFETY: the owners of these peripherals do not run again, because interrupts are disabled and
    // no caller of this function returns. The registers may be written at any time.
    let (clocks, timer, pins) = unsafe { (RCC::steal(), TIM1::steal(), GPIOB::steal()) };
    // The start-up may have failed before these clocks were enabled, and without them writes have
    // no effect. The errata sheet demands a delay after enabling, which the barrier provides.
    clocks.apb2enr().modify(|_, w| w.tim1en().enabled());
    clocks.ahb1enr().modify(|_, w| w.gpioben().enabled());
    cortex_m::asm::dsb();
    timer.bdtr().modify(|_, w| w.moe().disabled_idle());
    pins.bsrr().write(|w| w.br10().set_bit());
}
