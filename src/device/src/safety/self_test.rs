//! Self-test before the bridge may drive: comparator and supply switch, places of the thermistors, polarity, gain and
//! current measurement.
//!
//! ```text
//! ms    0         80                     144          344        544         744
//!       | tests   | baseline of display   | 1 A cools  | none      | 1 A warms |
//!       comparator  two means, so a slope   current      response    current
//! ```
//!
//! The bridge is off for the first 80 ms, so the comparator cuts and releases a supply that nobody uses; see
//! [`comparator_test`](super::comparator_test). These begin up to 63 ms after `arm`, in a tick whose number is a multiple
//! of 64. Then 1 A moves the display by 0.2 to 0.5 K, and both of its thermistors must show that against the line through their baseline. A
//! response with the wrong sign, or none, trips. Nothing but a display responds within 0.2 s: a thermistor on the sink
//! moves by a hundredth of it, with the opposite sign. The mirror is checked for both signs of the current. A finger
//! that lands or lifts restarts the baseline one second later.

use core::mem;
use core::ops::RangeInclusive;

use contact_model::fixed_point::Celsius;
use fixed::types::I42F22;

use super::Fault;
use super::comparator_test::{self, COMPARATOR_TEST_TICKS};
use super::self_test_report::SelfTestReport;
use super::validate_readings::ValidReadings;
use crate::drive::{ComparatorTest, Current};
use crate::sense::Samples;

/// Length of each half of the self-test's baseline, in ticks of 1 ms. In the baseline the bridge is off; the straight
/// line through the mean readings of its two halves predicts the temperature that the display would have without the
/// cooling pulse.
const TICKS_PER_BASELINE_HALF: u16 = 32;
/// Length of the self-test's cooling pulse, of the pause after it and of the warming pulse, each in ticks of 1 ms.
const PULSE_TICKS: u16 = 200;
/// Tick of the self-test in which the baseline is complete and the cooling pulse begins.
const BASELINE_END_TICK: u16 = COMPARATOR_TEST_TICKS + 2 * TICKS_PER_BASELINE_HALF;
/// Tick of the self-test in which the cooling pulse ends, the measured current of the pulse is checked, and the
/// demanded current becomes zero.
const COOLING_PULSE_END_TICK: u16 = BASELINE_END_TICK + PULSE_TICKS;
/// Tick of the self-test in which the display's response to the cooling pulse is checked and the warming pulse begins.
const RESPONSE_CHECK_TICK: u16 = COOLING_PULSE_END_TICK + PULSE_TICKS;
/// Tick of the self-test in which the measured current of the warming pulse is checked; if it is in range, the
/// self-test has passed.
const WARMING_PULSE_END_TICK: u16 = RESPONSE_CHECK_TICK + PULSE_TICKS;
/// Magnitude of the current of the self-test's cooling and warming pulses: 1 A.
const PULSE_CURRENT: Current = Current::ONE;
/// Smallest mean of the measured current over the second half of a self-test pulse of 1 A, A; a smaller mean trips the
/// station by [`Fault::CurrentLow`].
const PULSE_MEAN_CURRENT_MIN: Current = Current::lit("0.4");
/// Largest mean of the measured current over the second half of a self-test pulse of 1 A, A; a larger mean trips the
/// station by [`Fault::CurrentHigh`].
const PULSE_MEAN_CURRENT_MAX: Current = Current::lit("2");
/// Smallest fall of each display thermistor's reading, K, 0.2 s after the end of the self-test's cooling pulse; a
/// smaller one trips the station by [`Fault::NoResponse`]. A typical display falls by 0.54 K; a thermistor with a lag
/// of 0.5 s shows only a third of that by then, and a resting finger reduces the fall by a similar factor.
const DISPLAY_RESPONSE_MIN: Celsius = Celsius::lit("0.05");
/// Largest fall of each display thermistor's reading, K, 0.2 s after the end of the self-test's cooling pulse; a larger
/// one trips by [`Fault::NoResponse`]. A typical display falls by 0.54 K, so more than this is caused by something else
/// than the pulse.
const DISPLAY_RESPONSE_MAX: Celsius = Celsius::lit("1.5");
/// Smallest dip of the skin's reading between the two pulses, K, that trips the station by [`Fault::SkinOnPlate`]. On the plate, with time
/// constants of 0.15 to 0.6 s, it is 0.1 to 0.25 K; on a finger that rests on the display 0.02 K, because it sees at most 0.35 of the contact.
/// Noise makes 6 mK RMS of it.
const SKIN_DIP_MIN: Celsius = Celsius::lit("0.05");
/// Largest dip, K: one that is larger is not the display's. The thermistor was taken off or put on.
const SKIN_DIP_MAX: Celsius = Celsius::lit("0.6");
/// Largest magnitude of a reported response, K: what has two digits.
const REPORTED_RESPONSE_MAX: Celsius = Celsius::lit("99");
/// Ticks of 1 ms that the self-test waits after a finger has landed or lifted before its baseline begins, because the
/// display's temperature then does not follow a straight line.
const WAIT_AFTER_LANDING_OR_LIFTING_TICKS: u16 = 1000;
/// Total of the waits of 1 s after landings and liftings in one self-test, ticks of 1 ms (20 s), at which
/// [`Fault::NoResponse`] trips the station, because no undisturbed baseline was possible.
const SETTLING_WAITS_TOTAL_TRIP_TICKS: u16 = 20 * WAIT_AFTER_LANDING_OR_LIFTING_TICKS;
/// Ticks of 1 ms in a row in which the force sensor detects no finger, after which a finger counts as lifted. A force
/// just above the contact threshold falls below the threshold by noise now and then.
const LIFTED_AFTER_TICKS: u8 = 32;

/// Sums of the readings of the first and the second display thermistor, in units of 2^-22 °C, over one half of the
/// self-test's baseline.
type DisplayReadingSums = [i64; 2];

/// What the self-test demands in one tick. The station turns it into the outputs to bridge and comparator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelfTestStep {
    /// The bridge is off in this tick, and the comparator is tested in this way: during the comparator's tests, the
    /// baseline, or the wait after a finger's landing or lifting.
    Off(ComparatorTest),
    /// The bridge drives this current in this tick: 1 A (cools), -1 A (warms) or 0 A.
    Drive(Current),
    /// All parts of the self-test have passed, so the station becomes armed. The bridge is off in this tick.
    Passed,
}

/// State of a running self-test: position in its sequence, measurements so far, and the waiting for fingers. The
/// command `arm` starts it when the station is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelfTest {
    /// Next tick of the self-test's sequence, 0 to 744. It stays at the end of the comparator's tests, 80, while the
    /// display settles after a landing or lifting, and is set back to 80 when a finger lands or lifts later.
    tick: u16,
    first_half: DisplayReadingSums,
    second_half: DisplayReadingSums,
    /// Sum of the skin thermistor's readings over the baseline, and its reading at the end of the pause between the pulses, in units of
    /// 2^-22 °C.
    skin_before: i64,
    skin_between: i64,
    /// Sum of the measured current, as magnitude, over the second half (100 ticks) of the present pulse so far, in
    /// units of 2^-24 A. At the end of the pulse the mean is checked.
    current_sum: i64,
    /// Whether a finger counts as on the display: true at once when the force shows a finger, or one that may be
    /// landing; false after 32 ticks of 1 ms in a row without. After each change the self-test waits for 1 s before a
    /// new baseline.
    touched: bool,
    /// Ticks of 1 ms since the force last showed a finger, or one that may be landing; stops at 255.
    untouched_ticks: u8,
    /// Ticks of 1 ms that remain to wait before the baseline begins, because a finger has landed or lifted.
    wait_ticks: u16,
    /// Ticks of 1 ms that this self-test has waited in all after landings and liftings, up to [`SETTLING_WAITS_TOTAL_TRIP_TICKS`].
    waited_ticks: u16,
}

impl SelfTest {
    /// Whether the comparator's tests have not ended yet, in which the comparator cuts and releases the bridge's supply.
    /// It then pulls the bridge's fault line, which does not trip the station by [`Fault::Bridge`] while this is true;
    /// nor does the supply by [`Fault::Supply`], except by the tests themselves.
    pub const fn is_testing_comparator(&self) -> bool {
        self.tick < COMPARATOR_TEST_TICKS
    }

    /// Runs one tick of the self-test with `readings`, and returns what the bridge must do in this tick; `report` gets
    /// what it measures. `station_tick` is the number of the station's tick, `samples` has the levels of the comparator's
    /// lines; `touched` is true if the force shows a finger, or one that may be landing.
    ///
    /// # Errors
    /// [`Fault::Comparator`], [`Fault::SupplySwitch`], [`Fault::Supply`]: a test of the comparator has failed.
    /// [`Fault::CurrentLow`], [`Fault::CurrentHigh`]: the mean measured current of a pulse is below 0.4 A or above 2 A.
    /// [`Fault::Polarity`]: the cooling pulse has warmed the display. [`Fault::NoResponse`]: a display reading has not
    /// fallen by 0.05 to 1.5 K after the cooling pulse, or fingers that landed and lifted have delayed the baseline by
    /// 20 s in all. [`Fault::SkinOnPlate`]: the skin's reading has dipped with the display's.
    pub fn step(
        &mut self,
        report: &mut SelfTestReport,
        station_tick: u32,
        readings: &ValidReadings,
        samples: &Samples,
        touched: bool,
    ) -> Result<SelfTestStep, Fault> {
        const BRIDGE_OFF_WITHOUT_COMPARATOR_TEST: SelfTestStep =
            SelfTestStep::Off(ComparatorTest::None);
        self.untouched_ticks = if touched { 0 } else { self.untouched_ticks.saturating_add(1) };
        if touched != self.touched && (touched || self.untouched_ticks >= LIFTED_AFTER_TICKS) {
            self.restart_baseline(touched);
        }
        if self.tick == 0 && !comparator_test::may_begin_in(station_tick) {
            return Ok(BRIDGE_OFF_WITHOUT_COMPARATOR_TEST);
        }
        if self.tick == COMPARATOR_TEST_TICKS && self.wait_ticks > 0 {
            if self.waited_ticks >= SETTLING_WAITS_TOTAL_TRIP_TICKS {
                return Err(Fault::NoResponse);
            }
            self.wait_ticks -= 1;
            self.waited_ticks += 1;
            return Ok(BRIDGE_OFF_WITHOUT_COMPARATOR_TEST);
        }
        let tick = self.tick;
        self.tick += 1;
        let [display @ .., skin] = [readings.display, readings.check, readings.skin]
            .map(|reading| i64::from(reading.to_bits()));
        if tick < COMPARATOR_TEST_TICKS {
            let test = comparator_test::run_tick(report, tick, samples, readings.supply)?;
            return Ok(SelfTestStep::Off(test));
        }
        if tick < BASELINE_END_TICK {
            let is_first = tick < COMPARATOR_TEST_TICKS + TICKS_PER_BASELINE_HALF;
            let half = if is_first { &mut self.first_half } else { &mut self.second_half };
            for (sum, reading) in half.iter_mut().zip(display) {
                *sum += reading;
            }
            self.skin_before += skin;
            return Ok(BRIDGE_OFF_WITHOUT_COMPARATOR_TEST);
        }
        if tick < COOLING_PULSE_END_TICK {
            self.add_current_in_second_pulse_half(tick - BASELINE_END_TICK, readings.current);
            return Ok(SelfTestStep::Drive(PULSE_CURRENT));
        }
        if tick == COOLING_PULSE_END_TICK {
            self.check_pulse_current(&mut report.cooling_current)?;
        }
        if tick < RESPONSE_CHECK_TICK {
            return Ok(SelfTestStep::Drive(Current::ZERO));
        }
        if tick == RESPONSE_CHECK_TICK {
            self.check_display_response(report, display)?;
            self.skin_between = skin;
        }
        if tick < WARMING_PULSE_END_TICK {
            self.add_current_in_second_pulse_half(tick - RESPONSE_CHECK_TICK, readings.current);
            return Ok(SelfTestStep::Drive(PULSE_CURRENT.saturating_neg()));
        }
        self.check_pulse_current(&mut report.warming_current)?;
        self.check_skin_response(skin)?;
        Ok(SelfTestStep::Passed)
    }

    /// Restarts the self-test at the end of the comparator's tests (tests that are still running go on), because a finger has landed (`touched` true) or lifted. The self-test then waits for 1000 ticks of 1 ms before
    /// its baseline, as that needs an undisturbed display.
    fn restart_baseline(&mut self, touched: bool) {
        *self = Self {
            tick: self.tick.min(COMPARATOR_TEST_TICKS),
            touched,
            untouched_ticks: self.untouched_ticks,
            wait_ticks: WAIT_AFTER_LANDING_OR_LIFTING_TICKS,
            waited_ticks: self.waited_ticks,
            ..Self::default()
        };
    }

    fn add_current_in_second_pulse_half(&mut self, pulse_tick: u16, measured: Current) {
        if pulse_tick >= PULSE_TICKS / 2 {
            self.current_sum += i64::from(measured.to_bits());
        }
    }

    /// Checks at the end of a pulse the mean of the measured current over the second half of that pulse, which goes into
    /// `reported`, and resets the sum of the measured current to zero for the next pulse.
    ///
    /// # Errors
    /// [`Fault::CurrentLow`] below 0.4 A, [`Fault::CurrentHigh`] above 2 A.
    fn check_pulse_current(&mut self, reported: &mut Option<Current>) -> Result<(), Fault> {
        let mean = mem::take(&mut self.current_sum) / i64::from(PULSE_TICKS / 2);
        *reported = Some(Current::from_bits(mean as i32));
        if mean < i64::from(PULSE_MEAN_CURRENT_MIN.to_bits()) {
            Err(Fault::CurrentLow)
        } else if mean > i64::from(PULSE_MEAN_CURRENT_MAX.to_bits()) {
            Err(Fault::CurrentHigh)
        } else {
            Ok(())
        }
    }

    /// Checks that the skin's thermistor has not dipped with the display between the pulses; `after` is its reading after the warming
    /// pulse, in units of 2^-22 °C. A dip is the difference from the mean of before and after, so that a slow drift is none.
    fn check_skin_response(&self, after: i64) -> Result<(), Fault> {
        const DIP_ON_PLATE: RangeInclusive<i64> =
            SKIN_DIP_MIN.to_bits() as i64..=SKIN_DIP_MAX.to_bits() as i64;
        let before = self.skin_before / i64::from(2 * TICKS_PER_BASELINE_HALF);
        let dip = (before + after) / 2 - self.skin_between;
        if DIP_ON_PLATE.contains(&dip) { Err(Fault::SkinOnPlate) } else { Ok(()) }
    }

    /// Checks the display's response to the cooling pulse: both thermistors must read 0.05 to 1.5 K below the straight
    /// line through the means of the baseline's two halves. `display` holds the present readings of the first and the
    /// second display thermistor, in units of 2^-22 °C. A reading more than 0.05 K above the line is
    /// [`Fault::Polarity`]; any other failure is [`Fault::NoResponse`].
    fn check_display_response(
        &self,
        report: &mut SelfTestReport,
        display: [i64; 2],
    ) -> Result<(), Fault> {
        const DISPLAY_RESPONSE_MIN_RAW: i64 = DISPLAY_RESPONSE_MIN.to_bits() as i64;
        const DISPLAY_RESPONSE_RAW_MIN_TO_MAX: RangeInclusive<i64> =
            DISPLAY_RESPONSE_MIN_RAW..=DISPLAY_RESPONSE_MAX.to_bits() as i64;
        let half = i64::from(TICKS_PER_BASELINE_HALF);
        let ticks =
            i64::from(RESPONSE_CHECK_TICK - (BASELINE_END_TICK - TICKS_PER_BASELINE_HALF / 2));
        let halves = self.first_half.iter().zip(&self.second_half);
        let reported = report.responses.iter_mut();
        for (((first, second), reading), reported) in halves.zip(display).zip(reported) {
            let expected = second / half + (second - first) * ticks / (half * half);
            let response = expected - reading;
            let response_k = Celsius::saturating_from_num(I42F22::from_bits(response));
            *reported = Some(response_k.clamp(-REPORTED_RESPONSE_MAX, REPORTED_RESPONSE_MAX));
            if response < -DISPLAY_RESPONSE_MIN_RAW {
                return Err(Fault::Polarity);
            }
            if !DISPLAY_RESPONSE_RAW_MIN_TO_MAX.contains(&response) {
                return Err(Fault::NoResponse);
            }
        }
        Ok(())
    }
}
