//! Self-test before the bridge may drive: comparator, places of the thermistors, polarity, gain and current mirror.
//!
//! ```text
//! ms    0         20        40                      104          304        504       704
//!       | test on | test off | baseline of display   | 1 A cools  | none      | 1 A warms |
//!       comparator comparator  two means, so a slope   mirror       response    mirror
//!       cuts       releases
//! ```
//!
//! The bridge is off for the first 40 ms, so the comparator cuts and releases a supply that nobody uses. Then 1 A moves the
//! display by 0.2 to 0.5 K, and both of its thermistors must show that against the line through their baseline. A response
//! with the wrong sign, or none, trips. Nothing but a display responds within 0.2 s: a thermistor on the sink moves by a
//! hundredth of it, with the opposite sign. The mirror is checked for both signs of the current. A finger that lands or
//! lifts restarts the baseline one second later.

use core::mem;
use core::ops::RangeInclusive;

use contact_model::fixed_point::Celsius;

use super::Fault;
use super::validity::ValidReadings;
use crate::drive::Current;

/// Length of one half of the baseline, each of which gives a mean, ticks.
const HALF_BASELINE_TICKS: u16 = 32;
/// Length of a pulse, ticks.
const PULSE_TICKS: u16 = 200;
/// Ticks at which the phases end.
const COMPARATOR_CUT_END: u16 = 20;
const COMPARATOR_RELEASE_END: u16 = 40;
const BASELINE_END: u16 = COMPARATOR_RELEASE_END + 2 * HALF_BASELINE_TICKS;
const COOLING_END: u16 = BASELINE_END + PULSE_TICKS;
const RESPONSE_END: u16 = COOLING_END + PULSE_TICKS;
const WARMING_END: u16 = RESPONSE_END + PULSE_TICKS;
/// Ticks within which the comparator must have cut, or released.
const COMPARATOR_TICKS: u16 = 10;
/// Current of the cooling and the warming pulse, A.
const AMPLITUDE: Current = Current::ONE;
/// Measured current in the second half of a pulse, on average.
const CURRENT_MIN: Current = Current::lit("0.4");
const CURRENT_MAX: Current = Current::lit("2");
/// Response of the display to the cooling pulse. The class responds by 0.54 K; a thermistor of 0.5 s lag sees a third of that
/// in time, and a finger that rests on the display takes as much.
const RESPONSE_MIN: Celsius = Celsius::lit("0.05");
const RESPONSE_MAX: Celsius = Celsius::lit("1.5");
/// Ticks without a landing or lifting before the baseline, because a finger bends its line.
const UNDISTURBED_TICKS: u16 = 1000;
/// Ticks after which a display that is disturbed again and again trips.
const LONGEST_WAIT_TICKS: u16 = 20 * UNDISTURBED_TICKS;
/// Ticks without force after which a finger has lifted. A force just above its threshold falls below it by noise now and then.
const LIFTED_TICKS: u8 = 32;

/// Sums of both display readings over half of the baseline.
type Sums = [i64; 2];

/// What the bridge does in one tick of the self-test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelfTestStep {
    /// The bridge stays off in this tick.
    Off {
        /// Level of the line that tests the comparator.
        comparator_test: bool,
    },
    /// The bridge drives this current, A; positive cools.
    Drive(Current),
    /// The self-test has passed; the bridge is off in this tick.
    Passed,
}

/// Progress of the self-test, and the sums that it has measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelfTest {
    tick: u16,
    first_half: Sums,
    second_half: Sums,
    /// Sum of the measured current over the second half of a pulse.
    current: i64,
    touched: bool,
    /// Ticks since a finger was felt.
    untouched_ticks: u8,
    /// Ticks to wait until the baseline.
    wait_ticks: u16,
    /// Ticks that the self-test has waited for fingers in all.
    waited_ticks: u16,
}

impl SelfTest {
    /// Whether the comparator is expected to pull the bridge's fault line, which is then no fault.
    #[must_use]
    pub const fn expects_bridge_fault(&self) -> bool {
        self.tick < COMPARATOR_RELEASE_END
    }

    /// Takes one tick. `bridge_fault` is the level of the fault line, `touched` whether a finger is felt.
    ///
    /// # Errors
    /// The part that does not work.
    pub fn step(
        &mut self,
        readings: &ValidReadings,
        bridge_fault: bool,
        touched: bool,
    ) -> Result<SelfTestStep, Fault> {
        const OFF: SelfTestStep = SelfTestStep::Off {
            comparator_test: false,
        };
        self.untouched_ticks = if touched {
            0
        } else {
            self.untouched_ticks.saturating_add(1)
        };
        if touched != self.touched && (touched || self.untouched_ticks >= LIFTED_TICKS) {
            self.restart_baseline(touched);
        }
        if self.tick == COMPARATOR_RELEASE_END && self.wait_ticks > 0 {
            if self.waited_ticks >= LONGEST_WAIT_TICKS {
                return Err(Fault::NoResponse);
            }
            self.wait_ticks -= 1;
            self.waited_ticks += 1;
            return Ok(OFF);
        }
        let tick = self.tick;
        self.tick += 1;
        let display = [readings.display, readings.check].map(|reading| reading.to_bits().into());
        if tick < COMPARATOR_RELEASE_END {
            return test_comparator(tick, bridge_fault);
        }
        if tick < BASELINE_END {
            let is_first = tick < COMPARATOR_RELEASE_END + HALF_BASELINE_TICKS;
            let half = if is_first {
                &mut self.first_half
            } else {
                &mut self.second_half
            };
            for (sum, reading) in half.iter_mut().zip(display) {
                *sum += reading;
            }
            return Ok(OFF);
        }
        if tick < COOLING_END {
            self.add_current(tick - BASELINE_END, readings.current);
            return Ok(SelfTestStep::Drive(AMPLITUDE));
        }
        if tick == COOLING_END {
            self.check_current()?;
        }
        if tick < RESPONSE_END {
            return Ok(SelfTestStep::Drive(Current::ZERO));
        }
        if tick == RESPONSE_END {
            self.check_response(display)?;
        }
        if tick < WARMING_END {
            self.add_current(tick - RESPONSE_END, readings.current);
            return Ok(SelfTestStep::Drive(AMPLITUDE.saturating_neg()));
        }
        self.check_current()?;
        Ok(SelfTestStep::Passed)
    }

    /// Discards everything after the comparator's test, because a finger has landed or lifted.
    fn restart_baseline(&mut self, touched: bool) {
        *self = Self {
            tick: self.tick.min(COMPARATOR_RELEASE_END),
            touched,
            untouched_ticks: self.untouched_ticks,
            wait_ticks: UNDISTURBED_TICKS,
            waited_ticks: self.waited_ticks,
            ..Self::default()
        };
    }

    fn add_current(&mut self, pulse_tick: u16, measured: Current) {
        if pulse_tick >= PULSE_TICKS / 2 {
            self.current += i64::from(measured.to_bits());
        }
    }

    /// Checks the mean current of the pulse that has ended, and clears its sum.
    fn check_current(&mut self) -> Result<(), Fault> {
        let mean = mem::take(&mut self.current) / i64::from(PULSE_TICKS / 2);
        if mean < i64::from(CURRENT_MIN.to_bits()) {
            Err(Fault::CurrentLow)
        } else if mean > i64::from(CURRENT_MAX.to_bits()) {
            Err(Fault::CurrentHigh)
        } else {
            Ok(())
        }
    }

    /// Checks how far both readings are below the line through the means of both halves of the baseline.
    fn check_response(&self, display: [i64; 2]) -> Result<(), Fault> {
        const MIN: i64 = RESPONSE_MIN.to_bits() as i64;
        const RANGE: RangeInclusive<i64> = MIN..=RESPONSE_MAX.to_bits() as i64;
        let half = i64::from(HALF_BASELINE_TICKS);
        let ticks = i64::from(RESPONSE_END - (BASELINE_END - HALF_BASELINE_TICKS / 2));
        let halves = self.first_half.iter().zip(&self.second_half);
        for ((first, second), reading) in halves.zip(display) {
            let expected = second / half + (second - first) * ticks / (half * half);
            let response = expected - reading;
            if response < -MIN {
                return Err(Fault::Polarity);
            }
            if !RANGE.contains(&response) {
                return Err(Fault::NoResponse);
            }
        }
        Ok(())
    }
}

/// Checks in the first ticks that the comparator cuts the supply when told to, and releases it.
fn test_comparator(tick: u16, bridge_fault: bool) -> Result<SelfTestStep, Fault> {
    let comparator_test = tick < COMPARATOR_CUT_END;
    let elapsed = if comparator_test {
        tick
    } else {
        tick - COMPARATOR_CUT_END
    };
    // Before its time is over, either level is allowed.
    if elapsed >= COMPARATOR_TICKS && bridge_fault != comparator_test {
        return Err(Fault::Comparator);
    }
    Ok(SelfTestStep::Off { comparator_test })
}
