//! Lines to the surroundings of an emulated board that is brought up: what hands and instruments at a bench do.

use std::fmt;
use std::str::FromStr;

use thermal_device::safety::ThermistorId;
use thermal_settings::{Vocabulary, vocabulary};

/// Largest resistor in place of a thermistor, ohm; range of the load, ohm; largest weight, N.
const RESISTOR_MAX_OHM: f64 = 1e6;
const LOAD_OHM: std::ops::RangeInclusive<f64> = 0.5..=100.0;
const WEIGHT_MAX_N: f64 = 10.0;

/// What hands or instruments do at an emulated board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BenchRequest {
    /// `meter POINT`: what a meter or an oscilloscope shows there; the answer has the value and its unit.
    Meter(MeterPoint),
    /// `fit PART`: connects a part.
    Fit(Part),
    /// `remove PART`: disconnects it.
    Remove(Removal),
    /// `press BUTTON`.
    Press(Button),
    /// `release BUTTON`.
    Release(Button),
}

/// A part that can be connected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// `usb`: the host, and with it the probe's clock.
    Usb,
    /// `supply`: 12 V.
    Supply,
    /// `load-cell`.
    LoadCell,
    /// `resistor SENSOR OHM`: in place of a thermistor.
    Resistor(ThermistorId, f64),
    /// `thermistors`: all five, at the place of use.
    Thermistors,
    /// `load OHM`: a resistor in place of the tile.
    Load(f64),
    /// `tile`.
    Tile,
    /// `weight NEWTON`: on the plate.
    Weight(f64),
}

/// A part that can be disconnected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Removal {
    /// `resistor SENSOR`.
    Resistor(ThermistorId),
    /// `load`: whatever is at the tile's terminals.
    Load,
    /// `weight`.
    Weight,
}

vocabulary! {
    /// A button.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Button: "button" {
        /// The emergency stop, which stays pressed.
        Stop = "stop",
        /// The microcontroller's reset button, which a person holds.
        Reset = "reset",
    }
}

vocabulary! {
    /// Where a meter or an oscilloscope is connected. Resistances are measured without power, and against ground unless it
    /// says otherwise.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum MeterPoint: "point of a meter" {
        /// The touched plate.
        OhmPlate = "ohm plate",
        /// 12 V terminals.
        OhmSupply = "ohm supply",
        /// Bridge supply behind the high-side switch.
        OhmBridgeSupply = "ohm bridge-supply",
        /// Between the tile's terminals.
        OhmTile = "ohm tile",
        /// Bridge IN1.
        OhmIn1 = "ohm in1",
        /// Bridge IN2.
        OhmIn2 = "ohm in2",
        /// Bridge enable.
        OhmEnable = "ohm enable",
        /// BOOT0 of the microcontroller.
        OhmBoot0 = "ohm boot0",
        /// Test line of the comparator.
        OhmTest = "ohm test",
        /// Line that selects the side of the test.
        OhmSide = "ohm side",
        /// nFAULT, against 3.3 V.
        OhmNfault = "ohm nfault",
        /// Across the fuse.
        OhmFuse = "ohm fuse",
        /// Across the emergency stop's contact in the 12 V line.
        OhmStop = "ohm stop",
        /// 12 V behind the fuse.
        VoltSupply = "volt supply",
        /// 5 V.
        Volt5 = "volt 5v",
        /// 3.3 V.
        Volt3 = "volt 3v3",
        /// Threshold of the comparator's cold side.
        VoltCold = "volt cold",
        /// Threshold of its hot side.
        VoltHot = "volt hot",
        /// Bridge supply.
        VoltBridgeSupply = "volt bridge-supply",
        /// Bridge IN1.
        VoltIn1 = "volt in1",
        /// Bridge IN2.
        VoltIn2 = "volt in2",
        /// Bridge enable.
        VoltEnable = "volt enable",
        /// Test line of the comparator.
        VoltTest = "volt test",
        /// BOOT0.
        VoltBoot0 = "volt boot0",
        /// Current out of the 12 V supply.
        AmpereSupply = "ampere supply",
        /// Voltage across the load in its last pulse, without its sign.
        ScopeLoadVolt = "scope load-volt",
        /// RMS ripple of the voltage across the load in its last pulse.
        ScopeLoadRipple = "scope load-ripple",
        /// Ripple at the current input in that pulse, RMS.
        ScopeMirrorRipple = "scope mirror-ripple",
    }
}

impl MeterPoint {
    /// Unit of what is shown.
    pub fn unit(self) -> &'static str {
        match self.name().split(' ').next() {
            Some("ohm") => "ohm",
            Some("ampere") => "A",
            _ => "V",
        }
    }
}

impl fmt::Display for BenchRequest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Meter(point) => write!(f, "meter {}", point.name()),
            Self::Fit(part) => match part {
                Part::Usb => f.write_str("fit usb"),
                Part::Supply => f.write_str("fit supply"),
                Part::LoadCell => f.write_str("fit load-cell"),
                Part::Resistor(sensor, ohm) => {
                    write!(f, "fit resistor {} {ohm}", sensor.name())
                }
                Part::Thermistors => f.write_str("fit thermistors"),
                Part::Load(ohm) => write!(f, "fit load {ohm}"),
                Part::Tile => f.write_str("fit tile"),
                Part::Weight(newton) => write!(f, "fit weight {newton}"),
            },
            Self::Remove(removal) => match removal {
                Removal::Resistor(sensor) => {
                    write!(f, "remove resistor {}", sensor.name())
                }
                Removal::Load => f.write_str("remove load"),
                Removal::Weight => f.write_str("remove weight"),
            },
            Self::Press(button) => write!(f, "press {}", button.name()),
            Self::Release(button) => write!(f, "release {}", button.name()),
        }
    }
}

/// The value of this word.
fn one_of<T: Vocabulary>(word: &str) -> Result<T, String> {
    T::of_word(word).ok_or_else(|| format!("'{word}'; known: {}", T::WORDS.words.join(", ")))
}

impl FromStr for BenchRequest {
    type Err = String;

    /// Reads a line; the error says what is wrong and what is allowed.
    fn from_str(line: &str) -> Result<Self, String> {
        let sensor = |word: &str| {
            ThermistorId::of_word(word).ok_or_else(|| {
                format!("unknown sensor '{word}'; known: display check sink skin room")
            })
        };
        let number = |word: &str, allowed: std::ops::RangeInclusive<f64>, unit: &str| {
            let number = word.parse().ok().filter(|number| allowed.contains(number));
            number.ok_or_else(|| {
                let (least, most) = (allowed.start(), allowed.end());
                format!("'{word}' {unit}; allowed is {least} to {most}")
            })
        };
        let words: Vec<_> = line.split_ascii_whitespace().collect();
        Ok(match *words.as_slice() {
            ["meter", quantity, place] => Self::Meter(one_of(&format!("{quantity} {place}"))?),
            ["fit", "usb"] => Self::Fit(Part::Usb),
            ["fit", "supply"] => Self::Fit(Part::Supply),
            ["fit", "load-cell"] => Self::Fit(Part::LoadCell),
            ["fit", "resistor", word, ohm] => Self::Fit(Part::Resistor(
                sensor(word)?,
                number(ohm, 0.0..=RESISTOR_MAX_OHM, "ohm")?,
            )),
            ["fit", "thermistors"] => Self::Fit(Part::Thermistors),
            ["fit", "load", ohm] => Self::Fit(Part::Load(number(ohm, LOAD_OHM, "ohm")?)),
            ["fit", "tile"] => Self::Fit(Part::Tile),
            ["fit", "weight", newton] => {
                Self::Fit(Part::Weight(number(newton, 0.0..=WEIGHT_MAX_N, "N")?))
            }
            ["remove", "resistor", word] => Self::Remove(Removal::Resistor(sensor(word)?)),
            ["remove", "load"] => Self::Remove(Removal::Load),
            ["remove", "weight"] => Self::Remove(Removal::Weight),
            ["press", word] => Self::Press(one_of(word)?),
            ["release", word] => Self::Release(one_of(word)?),
            _ => {
                return Err(format!(
                    "'{line}'; known: meter POINT, fit PART, remove PART, press BUTTON, release BUTTON"
                ));
            }
        })
    }
}
