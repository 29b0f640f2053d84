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

/// Length of each half of the baseline, ticks of 1 ms. The means of both halves give the line that the display's
/// temperature would follow without current.
const HALF_BASELINE_TICKS: u16 = 32;
/// Length of the cooling pulse, of the pause after it and of the warming pulse, ticks of 1 ms each.
const PULSE_TICKS: u16 = 200;
/// Tick of the self-test, from 0, from which on the comparator must release the bridge's supply; before, it is told to
/// cut it.
const COMPARATOR_CUT_END_TICK: u16 = 20;
/// Tick of the self-test in which the comparator's test is over, and the baseline begins unless a finger has disturbed
/// it.
const COMPARATOR_RELEASE_END_TICK: u16 = 40;
/// Tick of the self-test in which the baseline is complete, and the cooling pulse begins.
const BASELINE_END_TICK: u16 = COMPARATOR_RELEASE_END_TICK + 2 * HALF_BASELINE_TICKS;
/// Tick of the self-test in which the cooling pulse ends, its measured current is checked, and zero current is driven.
const COOLING_PULSE_END_TICK: u16 = BASELINE_END_TICK + PULSE_TICKS;
/// Tick of the self-test in which the display's response to the cooling pulse is checked, and the warming pulse begins.
const RESPONSE_END_TICK: u16 = COOLING_PULSE_END_TICK + PULSE_TICKS;
/// Tick of the self-test in which the warming pulse's measured current is checked, and the self-test has passed.
const WARMING_PULSE_END_TICK: u16 = RESPONSE_END_TICK + PULSE_TICKS;
/// Ticks of 1 ms after which the comparator must have obeyed its test line: have cut the supply, or have released it.
/// Otherwise [`Fault::Comparator`] trips the station.
const COMPARATOR_DELAY_MAX_TICKS: u16 = 10;
/// Magnitude of the current of the cooling and of the warming pulse, A.
const PULSE_CURRENT: Current = Current::ONE;
/// Smallest mean of the measured current over the second half of a pulse of 1 A, A; less trips by
/// [`Fault::CurrentLow`].
const MEASURED_CURRENT_MIN: Current = Current::lit("0.4");
/// Largest mean of the measured current over the second half of a pulse of 1 A, A; more trips by
/// [`Fault::CurrentHigh`].
const MEASURED_CURRENT_MAX: Current = Current::lit("2");
/// Smallest fall of each display reading by the cooling pulse, 0.2 s after its end, K; less trips by
/// [`Fault::NoResponse`]. A typical display responds by 0.54 K; a thermistor of 0.5 s lag sees a third of that in time,
/// and a finger that rests on the display takes as much.
const RESPONSE_MIN: Celsius = Celsius::lit("0.05");
/// Largest fall of each display reading 0.2 s after the end of the cooling pulse, K. A typical display falls by 0.54 K; more
/// than this is no response to the pulse but another disturbance, and trips by [`Fault::NoResponse`], too.
const RESPONSE_MAX: Celsius = Celsius::lit("1.5");
/// Ticks of 1 ms to wait after a finger has landed or lifted before the baseline begins, because the display's
/// temperature then follows no straight line.
const UNDISTURBED_TICKS: u16 = 1000;
/// Ticks of 1 ms that a self-test may wait in all for fingers that land and lift; then [`Fault::NoResponse`] trips the
/// station.
const TOTAL_WAIT_MAX_TICKS: u16 = 20 * UNDISTURBED_TICKS;
/// Ticks of 1 ms without a felt finger after which it counts as lifted. A force just above the threshold falls below it
/// by noise now and then.
const LIFTED_AFTER_TICKS: u8 = 32;

/// Sums of the readings of the first and the second display thermistor over one half of the baseline, in units of 2^-22
/// °C.
type DisplayReadingSums = [i64; 2];

/// What the self-test demands of the bridge in one tick; `step` of the station turns it into outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelfTestStep {
    /// The bridge is off in this tick, for the comparator's test, the baseline, or while a finger disturbs.
    Off {
        /// Level of the comparator's test line: true makes the comparator cut the bridge's supply.
        comparator_test: bool,
    },
    /// The bridge drives this current in this tick, A: 1 A of either sign, or zero; positive cools.
    Drive(Current),
    /// All parts of the self-test have passed: the station becomes armed. The bridge is off in this tick.
    Passed,
}

/// A self-test that is running: how far it is, and what it has measured so far. Created by `arm` from off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelfTest {
    /// Ticks of the self-test so far, without the waiting for fingers.
    tick: u16,
    first_half: DisplayReadingSums,
    second_half: DisplayReadingSums,
    /// Sum of the measured current over the second half of the present pulse, in units of 2^-24 A.
    current_sum: i64,
    /// Whether a finger counts as being on the display, after the debouncing of its lifting.
    touched: bool,
    /// Ticks since a finger was felt last; stops at 255.
    untouched_ticks: u8,
    /// Ticks still to wait before the baseline may begin, because a finger has landed or lifted.
    wait_ticks: u16,
    /// Ticks that this self-test has waited for fingers so far, up to [`TOTAL_WAIT_MAX_TICKS`].
    waited_ticks: u16,
}

impl SelfTest {
    /// Whether the comparator's test is still running, in the first 40 ticks. The comparator then pulls the bridge's
    /// fault line, which must not trip the station by [`Fault::Bridge`].
    #[must_use]
    pub const fn expects_bridge_fault(&self) -> bool {
        self.tick < COMPARATOR_RELEASE_END_TICK
    }

    /// Runs one tick of the self-test with its readings, and returns what the bridge must do. `bridge_fault` is true if
    /// the bridge's fault line is pulled, `touched` if the force shows a finger.
    ///
    /// # Errors
    /// The fault of the part that has failed: comparator, measured current too low or too high, polarity, or no
    /// response, also if fingers have disturbed the baseline for 20 s.
    pub fn step(
        &mut self,
        readings: &ValidReadings,
        bridge_fault: bool,
        touched: bool,
    ) -> Result<SelfTestStep, Fault> {
        const BRIDGE_OFF_STEP: SelfTestStep = SelfTestStep::Off {
            comparator_test: false,
        };
        self.untouched_ticks = if touched {
            0
        } else {
            self.untouched_ticks.saturating_add(1)
        };
        if touched != self.touched && (touched || self.untouched_ticks >= LIFTED_AFTER_TICKS) {
            self.restart_baseline(touched);
        }
        if self.tick == COMPARATOR_RELEASE_END_TICK && self.wait_ticks > 0 {
            if self.waited_ticks >= TOTAL_WAIT_MAX_TICKS {
                return Err(Fault::NoResponse);
            }
            self.wait_ticks -= 1;
            self.waited_ticks += 1;
            return Ok(BRIDGE_OFF_STEP);
        }
        let tick = self.tick;
        self.tick += 1;
        let display = [readings.display, readings.check].map(|reading| reading.to_bits().into());
        if tick < COMPARATOR_RELEASE_END_TICK {
            return test_comparator(tick, bridge_fault);
        }
        if tick < BASELINE_END_TICK {
            let is_first = tick < COMPARATOR_RELEASE_END_TICK + HALF_BASELINE_TICKS;
            let half = if is_first {
                &mut self.first_half
            } else {
                &mut self.second_half
            };
            for (sum, reading) in half.iter_mut().zip(display) {
                *sum += reading;
            }
            return Ok(BRIDGE_OFF_STEP);
        }
        if tick < COOLING_PULSE_END_TICK {
            self.add_measured_current(tick - BASELINE_END_TICK, readings.current);
            return Ok(SelfTestStep::Drive(PULSE_CURRENT));
        }
        if tick == COOLING_PULSE_END_TICK {
            self.check_pulse_current()?;
        }
        if tick < RESPONSE_END_TICK {
            return Ok(SelfTestStep::Drive(Current::ZERO));
        }
        if tick == RESPONSE_END_TICK {
            self.check_display_response(display)?;
        }
        if tick < WARMING_PULSE_END_TICK {
            self.add_measured_current(tick - RESPONSE_END_TICK, readings.current);
            return Ok(SelfTestStep::Drive(PULSE_CURRENT.saturating_neg()));
        }
        self.check_pulse_current()?;
        Ok(SelfTestStep::Passed)
    }

    /// Goes back to the end of the comparator's test, unless that is still running, and lets the baseline begin 1 s
    /// later, because a finger has landed (`touched`) or lifted.
    fn restart_baseline(&mut self, touched: bool) {
        *self = Self {
            tick: self.tick.min(COMPARATOR_RELEASE_END_TICK),
            touched,
            untouched_ticks: self.untouched_ticks,
            wait_ticks: UNDISTURBED_TICKS,
            waited_ticks: self.waited_ticks,
            ..Self::default()
        };
    }

    fn add_measured_current(&mut self, pulse_tick: u16, measured: Current) {
        if pulse_tick >= PULSE_TICKS / 2 {
            self.current_sum += i64::from(measured.to_bits());
        }
    }

    /// Checks that the measured current of the pulse that has ended was 0.4 to 2 A on average over its second half, and
    /// clears its sum for the next pulse.
    fn check_pulse_current(&mut self) -> Result<(), Fault> {
        let mean = mem::take(&mut self.current_sum) / i64::from(PULSE_TICKS / 2);
        if mean < i64::from(MEASURED_CURRENT_MIN.to_bits()) {
            Err(Fault::CurrentLow)
        } else if mean > i64::from(MEASURED_CURRENT_MAX.to_bits()) {
            Err(Fault::CurrentHigh)
        } else {
            Ok(())
        }
    }

    /// Checks that both readings in `display`, in units of 2^-22 °C, are 0.05 to 1.5 K below the line through the means
    /// of both halves of the baseline.
    fn check_display_response(&self, display: [i64; 2]) -> Result<(), Fault> {
        const RESPONSE_MIN_BITS: i64 = RESPONSE_MIN.to_bits() as i64;
        const RESPONSE_RANGE_BITS: RangeInclusive<i64> =
            RESPONSE_MIN_BITS..=RESPONSE_MAX.to_bits() as i64;
        let half = i64::from(HALF_BASELINE_TICKS);
        let ticks = i64::from(RESPONSE_END_TICK - (BASELINE_END_TICK - HALF_BASELINE_TICKS / 2));
        let halves = self.first_half.iter().zip(&self.second_half);
        for ((first, second), reading) in halves.zip(display) {
            let expected = second / half + (second - first) * ticks / (half * half);
            let response = expected - reading;
            if response < -RESPONSE_MIN_BITS {
                return Err(Fault::Polarity);
            }
            if !RESPONSE_RANGE_BITS.contains(&response) {
                return Err(Fault::NoResponse);
            }
        }
        Ok(())
    }
}

/// Tests the comparator in tick 0 to 39 of the self-test, with the bridge off: sets its test line for 20 ticks, then
/// clears it for 20, and checks from the tenth tick of each part on that the fault line is pulled, or released.
fn test_comparator(tick: u16, bridge_fault: bool) -> Result<SelfTestStep, Fault> {
    let comparator_test = tick < COMPARATOR_CUT_END_TICK;
    let elapsed = if comparator_test {
        tick
    } else {
        tick - COMPARATOR_CUT_END_TICK
    };
    // Before its time is over, either level is allowed.
    if elapsed >= COMPARATOR_DELAY_MAX_TICKS && bridge_fault != comparator_test {
        return Err(Fault::Comparator);
    }
    Ok(SelfTestStep::Off { comparator_test })
}
