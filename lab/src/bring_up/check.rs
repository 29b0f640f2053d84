//! What the procedure is made of: stages, steps and checks. All of it is data, read from the files of `stages/`.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value as Json;

use super::unit::Unit;

/// A stage, in the order of power: what an earlier one has found unsafe keeps a later one from being started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "kebab-case")]
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
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManualStep {
    /// What the person is told.
    #[serde(rename = "do", deserialize_with = "text")]
    pub say: &'static str,
    /// The same in the words of the line to the surroundings of an emulated board.
    #[serde(rename = "bench", default, deserialize_with = "texts")]
    pub lines: &'static [&'static str],
    /// How long the device runs after that before the next step, ms.
    #[serde(default)]
    pub wait_ms: u64,
}

/// A value to measure and to compare.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// Name, unique in the procedure.
    #[serde(rename = "check", deserialize_with = "text")]
    pub name: &'static str,
    /// What is measured.
    #[serde(deserialize_with = "text")]
    pub what: &'static str,
    /// How it is measured.
    #[serde(rename = "reads")]
    pub reading: Reading,
    /// Words for a field that is true or false.
    pub shown_as: Option<FlagWords>,
    /// What is expected.
    pub expected: Expected,
    /// Where the limits come from.
    #[serde(deserialize_with = "text")]
    pub basis: &'static str,
    /// What is broken if the value is too low, is another word, or is missing.
    #[serde(default, deserialize_with = "text")]
    pub low: &'static str,
    /// What is broken if it is too high.
    #[serde(default, deserialize_with = "text")]
    pub high: &'static str,
    /// The first stage that is unsafe or pointless if the check fails; `None` if all others can still be done.
    pub blocks: Option<StageId>,
}

/// Where a value comes from. Of an answer of the device it is the field with this name, or the sum of fields with ` + ` between.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Reading {
    /// A meter or an oscilloscope.
    Meter {
        /// Name of the point on the line to the surroundings.
        #[serde(deserialize_with = "text")]
        point: &'static str,
        /// What the person does with the instrument.
        #[serde(deserialize_with = "text")]
        how: &'static str,
    },
    /// The device's answer to `raw`.
    Raw(#[serde(deserialize_with = "text")] &'static str),
    /// The last self-test.
    SelfTest(#[serde(deserialize_with = "text")] &'static str),
    /// The device's answer to `board`.
    Board(#[serde(deserialize_with = "text")] &'static str),
    /// The value that a routine has left under the check's name.
    Kept,
    /// A value worked out from those that checks and routines have left.
    Derived(Formula),
}

/// A value worked out from others, by their names: `(value - less) / over * times / per`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Formula {
    #[serde(deserialize_with = "text")]
    value: &'static str,
    #[serde(default, deserialize_with = "some_text")]
    less: Option<&'static str>,
    #[serde(default, deserialize_with = "some_text")]
    over: Option<&'static str>,
    times: Option<f64>,
    per: Option<f64>,
}

/// Words for a field that is true or false.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlagWords {
    #[serde(rename = "true", deserialize_with = "text")]
    set: &'static str,
    #[serde(rename = "false", deserialize_with = "text")]
    clear: &'static str,
}

/// What is expected of a value.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Expected {
    /// A number from the first to the second, in this unit.
    Range(f64, f64, Unit),
    /// One of these words.
    Words(#[serde(deserialize_with = "texts")] &'static [&'static str]),
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
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Routine {
    /// Identifies the device.
    Identify,
    /// `clear` and `arm`; keeps what the self-test reports, and switches the bridge off again.
    SelfTest,
    /// Clears the latch, then turns a resistor in place of the second display thermistor from the first value, ohm, to the
    /// second until nFAULT falls, and keeps the value there.
    Edge {
        /// Name under which the value is kept.
        #[serde(deserialize_with = "text")]
        keep: &'static str,
        /// Begin and end, ohm.
        ohm: (f64, f64),
    },
    /// Compares the counts of the five known resistors, ohm, in the order of the converter's channels, with what they must be.
    #[serde(rename = "known_resistors_ohm")]
    KnownResistors([f64; 5]),
    /// Streams telemetry with checksums for this time, ms, and keeps how many lines were lost and damaged.
    #[serde(rename = "serial_line_ms")]
    SerialLine(u64),
    /// Compares thermistors with the reference thermometer.
    Thermistors,
    /// Holds the display at a temperature, °C; keeps readings, reference and current.
    Hold {
        /// Prefix of the names under which they are kept.
        #[serde(deserialize_with = "text")]
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

/// Text of a step: it is read once, and lives as long as the program.
fn text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<&'static str, D::Error> {
    String::deserialize(deserializer).map(|text| &*text.leak())
}

fn some_text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<&'static str>, D::Error> {
    text(deserializer).map(Some)
}

fn texts<'de, D>(deserializer: D) -> Result<&'static [&'static str], D::Error>
where
    D: Deserializer<'de>,
{
    let texts = Vec::<String>::deserialize(deserializer)?.into_iter();
    Ok(texts.map(|text| &*text.leak()).collect::<Vec<_>>().leak())
}

impl Formula {
    /// The value; `None` if one of the others is missing.
    pub(super) fn value(&self, kept: &Kept) -> Option<f64> {
        let or = |name: Option<&str>, otherwise| match name {
            Some(name) => kept.get(name).copied(),
            None => Some(otherwise),
        };
        let value = (kept.get(self.value)? - or(self.less, 0.0)?) / or(self.over, 1.0)?;
        Some(value * self.times.unwrap_or(1.0) / self.per.unwrap_or(1.0))
    }
}

impl Check {
    /// The value in an answer of the device; `None` if the device has none, or the answer no such field.
    pub(super) fn value_in(&self, answer: &impl Serialize, fields: &str) -> Option<Value> {
        let answer = serde_json::to_value(answer).ok()?;
        if let Expected::Range(..) = self.expected {
            let numbers = fields.split(" + ").map(|field| answer.get(field)?.as_f64());
            return numbers.sum::<Option<f64>>().map(Value::Number);
        }
        let word = match answer.get(fields)? {
            Json::String(word) => word.clone(),
            Json::Number(number) => number.to_string(),
            Json::Bool(true) => self.shown_as?.set.into(),
            Json::Bool(false) => self.shown_as?.clear.into(),
            _ => return None,
        };
        Some(Value::Word(word))
    }
}

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
