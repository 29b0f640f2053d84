//! Wiring for five fingers, whose sensors are connected to the converter in turn.
//!
//! Each of the eight inputs of the one-finger wiring has an 8:1 analog multiplexer, such as an
//! SN74LV4051A, and voltage followers on both sides of it. Three lines select the finger for all
//! eight multiplexers.
//!
//! | finger | bridge IN1, IN2               | bridge enable | nFAULT | comparator test |
//! |--------|-------------------------------|---------------|--------|-----------------|
//! | 0      | PA8, PA9, TIM1 channel 1, 2   | PB10          | PA6    | PC3             |
//! | 1      | PA10, PA11, TIM1 channel 3, 4 | PB13          | PA7    | PA15            |
//! | 2      | PC6, PC7, TIM8 channel 1, 2   | PB14          | PA12   | PD2             |
//! | 3      | PC8, PC9, TIM8 channel 3, 4   | PB15          | PB5    | PB6             |
//! | 4      | PB8, PB9, TIM10, TIM11        | PB1           | PB12   | PB7             |
//!
//! | pin              | signal                                                                    |
//! |------------------|---------------------------------------------------------------------------|
//! | PC10, PC11, PC12 | selected finger, bits 0 to 2; external pull-downs                         |
//! | PB2              | side of the comparators' tests: low hot, high cold; external pull-down    |
//! | PA5              | parity of the select lines at the multiplexers, high if odd; see below    |
//!
//! IN1, IN2, enable and test have external pull-downs, so all bridges are high-impedance from the
//! reset on; PA15, which has a weak pull-up from the reset on, needs 4.7k. nFAULT has a 4.7k pull-up; the bridge and the comparator of the second display
//! thermistor pull it low. All four timers run at 180 MHz, so all bridges have the same PWM period.
//! TIM10 and TIM11 need not be synchronised, because only one input of a bridge switches at a time.
//!
//! The fault lines are ordinary inputs, because the two break inputs do not suffice for five
//! fingers and a break would also stop the finger that shares the timer. A bridge with a fault and
//! a comparator that trips turn off their own finger without the processor. They hold the fault
//! line low for at least 3 ms, the retry time of the bridge, and the processor reads the line every
//! millisecond. If the clock fails, hardware stops TIM1 and TIM8, and the non-maskable interrupt
//! turns all five bridges off.
//!
//! A select line that is broken or shorted would give a finger the sensors of another one. A gate at
//! the far end of the lines returns the parity of their levels (74LVC1G386 class), which each tick
//! compares with that of the finger whose samples it takes; if it differs, all fingers trip. Two
//! fingers whose indices differ in one line have different parities. Each finger's LED is on the
//! enable line of its bridge.
//!
//! # Time
//! The 16 scans of a finger are consecutive, so the multiplexers switch only five times a
//! millisecond and not eighty times:
//!
//! ```text
//! us    0                       200                     400              1000
//! scan  |x x 0 1 2 ... 14 15    |x x 0 1 2 ... 14 15    |x x 0 ...       |
//! input |finger 0               |finger 1               |finger 2        |finger 0
//! tick                          ^ of finger 0           ^ of finger 1
//! ```
//!
//! The tick of one finger first switches the multiplexers to the next finger. Two scans (`x`) are
//! dropped: during the first the program has 11 us to switch, during the second the multiplexers
//! and voltage followers have 11 us to settle. If the program switches too late, the samples may
//! belong to the wrong finger, and all bridges are turned off.
//!
//! Scans are 2000 steps of the PWM timers apart and PWM periods 1882, so that the 16 scans of a sum
//! see the ripple at 16 evenly spread phases.

mod multiplexer;
mod power_stage;

use stm32f4xx_hal::pac::{GPIOB, RCC, TIM1, TIM8};

pub use multiplexer::Multiplexer;
pub use power_stage::{BridgeAndComparatorPins, BridgePeripherals, FingerPowerStage};

/// Number of fingers that this wiring controls, each with its own bridge and sensors.
pub const FINGERS: usize = 5;

/// Code in the registers SMPR1 and SMPR2 of ADC1 for a sampling time of 15 cycles at 22.5 MHz, 0.67
/// us.
///
/// Behind a voltage follower, the input of the converter (7 pF and 6 kOhm) settles to a quarter of
/// a count in 0.41 us. With 12 more cycles for each conversion, the eight channels of a scan take
/// 9.6 us of the 11.1 us between two scans, and the 720 conversions of all fingers take 864 us of
/// each millisecond.
pub const SAMPLE_TIME_CODE: u8 = 1;

/// Takes the place of the converter of the one-finger wiring's heat-flux sensor: five fingers have none. It would need a
/// multiplexer of its own, and conversions that start by the timer of the scans.
pub struct NoFluxConverter;

pub use NoFluxConverter as FluxConverter;

impl NoFluxConverter {
    /// Always `None`.
    pub fn take_code_and_start_next(&mut self) -> Option<u16> {
        None
    }
}

/// Makes the outputs of all bridges high-impedance by direct writes to the registers, in any state
/// of the program, also before the bridges are set up. For the handlers of fatal errors, after
/// which the program must not continue.
pub fn disable_bridges() {
    // SAFETY: the owners of these peripherals do not run again, because interrupts are disabled and
    // no caller of this function returns. The registers may be written at any time.
    let (clocks, tim1, tim8, pins) =
        unsafe { (RCC::steal(), TIM1::steal(), TIM8::steal(), GPIOB::steal()) };
    // As for one finger, these clocks may not be enabled yet.
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
    tim1.bdtr().modify(|_, w| w.moe().disabled_idle());
    tim8.bdtr().modify(|_, w| w.moe().disabled_idle());
}
