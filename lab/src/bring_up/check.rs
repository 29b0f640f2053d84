//! What the procedure is made of: stages, steps and checks. All of it is data.

use std::collections::BTreeMap;
use std::fmt;

use thermal_client::client::{BoardReport, RawReadings, SelfTestReport};

use super::unit::Unit;

/// A stage, in the order of power: what an earlier one has found unsafe keeps a later one from being started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StageId {
    /// Everything unpowered and unplugged.
    BareBoard,
    /// 12 V with a small current limit, emergency stop pressed; 5 V, 3.3 V and what is made of them.
    Rails,
    /// Option bytes, clock, watchdogs.
    Chip,
    /// Losses of the serial line.
    Line,
    /// Pins of the bridge while the microcontroller is held in reset.
    Reset,
    /// Known resistors in place of the thermistors; load cell.
    Sensors,
    /// Emergency stop and its sense; the bridge supply stays off.
    Supply,
    /// Latch, switch and sensed supply, by the self-test, with nothing at the bridge.
    Latch,
    /// Thresholds of the comparator.
    Edges,
    /// First current, through a resistor.
    Load,
    /// Tile, sink and thermistors.
    Tile,
    /// Calibration and identification.
    Commissioning,
    /// Warm and cold, without a finger; emergency stop while driving.
    Run,
}

/// A stage of the procedure.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    /// Its place in the order.
    pub id: StageId,
    /// Name on the command line.
    pub name: &'static str,
    /// Headline.
    pub title: &'static str,
    /// What is connected at its beginning: said, and done on an emulated board, if a bring-up goes on here.
    pub needs: ManualStep,
    /// Steps in their order.
    pub steps: &'static [Step],
}

/// One step of a stage.
#[derive(Clone, Copy, Debug)]
pub enum Step {
    /// Something to do by hand.
    Manual(ManualStep),
    /// A value to measure and to compare.
    Check(Check),
    /// Something that the program does with the device, and that leaves values behind.
    Routine(Routine),
}

/// Something to do by hand.
#[derive(Clone, Copy, Debug)]
pub struct ManualStep {
    /// What the person is told.
    pub say: &'static str,
    /// The same in the words of the line to the surroundings of an emulated board.
    pub lines: &'static [&'static str],
}

/// A value to measure and to compare.
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// Name, unique in the procedure.
    pub name: &'static str,
    /// What is measured.
    pub what: &'static str,
    /// How it is measured.
    pub reading: Reading,
    /// What is expected.
    pub expected: Expected,
    /// Where the limits come from.
    pub basis: &'static str,
    /// What is broken if the value is too low, is another word, or is missing.
    pub low: &'static str,
    /// What is broken if it is too high.
    pub high: &'static str,
    /// The first stage that is unsafe or pointless if the check fails; `None` if all others can still be done.
    pub blocks: Option<StageId>,
}

/// Where a value comes from.
#[derive(Clone, Copy, Debug)]
pub enum Reading {
    /// A meter or an oscilloscope.
    Meter {
        /// Name of the point on the line to the surroundings.
        point: &'static str,
        /// What the person does with the instrument.
        how: &'static str,
    },
    /// The device's answer to `raw`.
    Raw(fn(&RawReadings) -> Value),
    /// The last self-test.
    SelfTest(fn(&SelfTestReport) -> Option<Value>),
    /// The device's answer to `board`.
    Board(fn(&BoardReport) -> Value),
    /// The value that a routine has left under the check's name.
    Kept,
    /// A value worked out from those that checks and routines have left.
    Derived(fn(&Kept) -> Option<f64>),
}

/// What is expected of a value.
#[derive(Clone, Copy, Debug)]
pub enum Expected {
    /// A number from the first to the second, in this unit.
    Range(f64, f64, Unit),
    /// One of these words.
    Words(&'static [&'static str]),
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number in the unit of what is expected.
    Number(f64),
    /// A word.
    Word(String),
}

/// Something that the program does with the device.
#[derive(Clone, Copy, Debug)]
pub enum Routine {
    /// Lets the device run for this time, ms.
    Wait(u64),
    /// Identifies the device.
    Identify,
    /// `clear` and `arm`; keeps what the self-test reports, and switches the bridge off again.
    SelfTest,
    /// Clears the latch, then turns a resistor in place of the second display thermistor from the first value, ohm, to the
    /// second until nFAULT falls, and keeps the value there.
    Edge {
        /// Name under which the value is kept.
        keep: &'static str,
        /// Begin and end, ohm.
        ohm: (f64, f64),
    },
    /// Compares the counts of the five known resistors with what they must be.
    KnownResistors,
    /// Streams telemetry with checksums for this time, ms, and keeps how many lines were lost and damaged.
    SerialLine(u64),
    /// Compares thermistors with the reference thermometer.
    Thermistors,
    /// Holds the display at a temperature, °C; keeps readings, reference and current.
    Hold {
        /// Prefix of the names under which they are kept.
        keep: &'static str,
        /// Temperature, °C.
        celsius: f64,
    },
    /// Commissions the device.
    Commission,
    /// With the emergency stop pressed while the display is driven: keeps the time until the device has tripped by it, and
    /// the current and the bridge supply after that.
    StopWhileDriving,
}

/// Measured values, each by the name of its check or by the name that a routine gives it.
pub type Kept = BTreeMap<String, f64>;

impl Expected {
    /// Whether a value is as expected; otherwise whether it is too low.
    pub fn judge(&self, value: &Value) -> Judgement {
        match (self, value) {
            (Self::Range(least, most, _), Value::Number(number)) => {
                if number < least || number.is_nan() {
                    Judgement::Low
                } else if number > most {
                    Judgement::High
                } else {
                    Judgement::Good
                }
            }
            (Self::Words(expected), Value::Word(word)) if expected.contains(&word.as_str()) => {
                Judgement::Good
            }
            _ => Judgement::Low,
        }
    }

    /// A value as text, with the unit that is expected.
    pub fn text_of(&self, value: &Value) -> String {
        match (self, value) {
            (Self::Range(_, _, unit), Value::Number(number)) => unit.text(*number),
            (_, Value::Number(number)) => number.to_string(),
            (_, Value::Word(word)) => word.clone(),
        }
    }
}

/// Result of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// As expected.
    Good,
    /// Too low, or another word.
    Low,
    /// Too high.
    High,
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Words(words) => f.write_str(&words.join(" or ")),
            Self::Range(least, most, unit) if most.is_infinite() => {
                write!(f, "at least {}", unit.text(*least))
            }
            Self::Range(least, most, unit) if *least == 0.0 || least.is_infinite() => {
                write!(f, "at most {}", unit.text(*most))
            }
            Self::Range(least, most, unit) => {
                write!(f, "{} to {}", unit.text(*least), unit.text(*most))
            }
        }
    }
}
