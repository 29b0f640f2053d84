//! What must work before the bridge may drive: the comparator, the thermistors' places, polarity, gain and mirror.
//!
//! ```text
//! ms    0         20      40                 104          304        504       704
//!       | test on  | off   | display at rest   | 1 A cools  | none      | 1 A warms |
//!       comparator   gives   its slope           mirror       answer      mirror
//!       cuts         back
//! ```
//!
//! The bridge is off for the first 40 ms, so the comparator cuts and gives back a supply that nobody uses. Then the
//! display is told to do a little, 0.2 to 0.5 K, and both of its thermistors must show it, against the slope that they
//! had before; a display that answers the wrong way round, or not at all, trips. Nothing else than a display answers in
//! 0.2 s: a thermistor on the sink moves by a hundredth of it, the other way. What flows is looked at both ways round. A
//! finger that rests there, lands or lifts lets the rest begin a second later.

use core::mem;

use contact_model::fixed_point::Celsius;

use super::Fault;
use super::limits::Sound;
use crate::drive::Current;

/// Ticks at which the phases end.
const TESTED: u16 = 20;
const GIVEN_BACK: u16 = 40;
const RESTED: u16 = GIVEN_BACK + 2 * HALF;
const COOLED: u16 = RESTED + PULSE;
const ANSWERED: u16 = COOLED + PULSE;
const DONE: u16 = ANSWERED + PULSE;
/// Half of the rest, over each of which the reading is averaged, and how long the pulses last.
const HALF: u16 = 32;
const PULSE: u16 = 200;
/// Within this the comparator has cut, and has given back.
const COMPARATOR_TICKS: u16 = 10;
/// What is driven.
const AMPLITUDE: Current = Current::ONE;
/// What must flow while it is, in the second half of the pulse on average.
const LEAST_A: Current = Current::lit("0.4");
const MOST_A: Current = Current::lit("2");
/// How far the display must and may answer: the class does 0.54 K with its pulse, a thermistor of 0.5 s lag sees a third
/// of it meanwhile, and a finger that rests there takes as much.
const LEAST: Celsius = Celsius::lit("0.05");
const MOST: Celsius = Celsius::lit("1.5");

/// For how long nothing must have landed or lifted before the rest, ticks: what a finger does to the display is no line.
const UNTOUCHED: u16 = 1000;
/// For how long in all.
const PATIENCE: u16 = 20 * UNTOUCHED;
/// Who has lifted has left the force at its zero for so many ticks: one that is hardly above it shows by the noise now and then.
const LIFTED: u8 = 32;

/// Sums of both readings over half of the rest.
type Sums = [i64; 2];

/// How it goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The bridge stays off; whether the comparator is to be tested.
    Off {
        /// Level of the test line.
        comparator_test: bool,
    },
    /// This current.
    Drive(Current),
    /// Everything works.
    Passed,
}

/// The self-test, from tick to tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelfTest {
    tick: u16,
    first: Sums,
    second: Sums,
    /// Sum of the measured current over the second half of a pulse.
    current: i64,
    touched: bool,
    /// Ticks since nothing was felt.
    untouched: u8,
    /// Ticks to wait before the rest, and how many have been waited in all.
    wait: u16,
    waited: u16,
}

impl SelfTest {
    /// The comparator is expected to pull the fault line, so that it does is no fault.
    #[must_use]
    pub const fn expects_cut(&self) -> bool {
        self.tick < GIVEN_BACK
    }

    /// Takes one tick; `cut` is whether the fault line is pulled, `felt` whether anything is felt on the display.
    ///
    /// # Errors
    /// What does not work.
    pub fn step(
        &mut self,
        sound: &Sound,
        measured: Current,
        cut: bool,
        felt: bool,
    ) -> Result<Progress, Fault> {
        self.untouched = if felt {
            0
        } else {
            self.untouched.saturating_add(1)
        };
        if felt != self.touched && (felt || self.untouched >= LIFTED) {
            self.begin_anew(felt);
        }
        if self.tick == GIVEN_BACK && self.wait > 0 {
            if self.waited >= PATIENCE {
                return Err(Fault::NoResponse);
            }
            self.wait -= 1;
            self.waited += 1;
            return Ok(Progress::Off {
                comparator_test: false,
            });
        }
        let tick = self.tick;
        self.tick += 1;
        let readings = [sound.display, sound.check].map(|reading| i64::from(reading.to_bits()));
        let add = |sums: &mut Sums| {
            for (sum, reading) in sums.iter_mut().zip(readings) {
                *sum += reading;
            }
        };
        if tick < GIVEN_BACK {
            let testing = tick < TESTED;
            let since = if testing { tick } else { tick - TESTED };
            // Within the time that it has, either will do.
            if since >= COMPARATOR_TICKS && cut != testing {
                return Err(Fault::Comparator);
            }
            return Ok(Progress::Off {
                comparator_test: testing,
            });
        }
        if tick < RESTED {
            add(if tick < GIVEN_BACK + HALF {
                &mut self.first
            } else {
                &mut self.second
            });
            return Ok(Progress::Off {
                comparator_test: false,
            });
        }
        if tick < COOLED {
            self.add_current(tick, RESTED, measured);
            return Ok(Progress::Drive(AMPLITUDE));
        }
        if tick == COOLED {
            self.judge_current()?;
        }
        if tick < ANSWERED {
            return Ok(Progress::Drive(Current::ZERO));
        }
        if tick == ANSWERED {
            self.judge_answer(readings)?;
        }
        if tick < DONE {
            self.add_current(tick, ANSWERED, measured);
            return Ok(Progress::Drive(AMPLITUDE.saturating_neg()));
        }
        self.judge_current()?;
        Ok(Progress::Passed)
    }

    /// A finger has landed or lifted: what was seen since the comparator's test does not count.
    fn begin_anew(&mut self, touched: bool) {
        *self = Self {
            tick: self.tick.min(GIVEN_BACK),
            touched,
            untouched: self.untouched,
            wait: UNTOUCHED,
            waited: self.waited,
            ..Self::default()
        };
    }

    /// In a pulse that began in a tick.
    fn add_current(&mut self, tick: u16, begun: u16, measured: Current) {
        if tick >= begun + PULSE / 2 {
            self.current += i64::from(measured.to_bits());
        }
    }

    /// Of the pulse that is over; the next one begins with none.
    fn judge_current(&mut self) -> Result<(), Fault> {
        let mean = mem::take(&mut self.current) / i64::from(PULSE / 2);
        if mean < i64::from(LEAST_A.to_bits()) {
            Err(Fault::CurrentLow)
        } else if mean > i64::from(MOST_A.to_bits()) {
            Err(Fault::CurrentHigh)
        } else {
            Ok(())
        }
    }

    /// Against the line through the means of both halves of the rest.
    fn judge_answer(&self, readings: [i64; 2]) -> Result<(), Fault> {
        let half = i64::from(HALF);
        let since = i64::from(ANSWERED - (RESTED - HALF / 2));
        for (i, reading) in readings.into_iter().enumerate() {
            let (first, second) = (self.first[i], self.second[i]);
            let expected = second / half + (second - first) * since / (half * half);
            let fell = expected - reading;
            if fell < -i64::from(LEAST.to_bits()) {
                return Err(Fault::Polarity);
            }
            if !(i64::from(LEAST.to_bits())..=i64::from(MOST.to_bits())).contains(&fell) {
                return Err(Fault::NoResponse);
            }
        }
        Ok(())
    }
}
