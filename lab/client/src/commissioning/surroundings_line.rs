//! The line to the surroundings of a simulated device that another program serves: what moves the device from bath to bath,
//! reads the reference thermometer, and lets time pass.

use std::fmt;
use std::str::FromStr;

use thermal_device::safety::ThermistorId;
use thermal_settings::Vocabulary as _;

use super::{BenchRequest, PhantomPlace};

/// Largest force on the display, N.
const FORCE_MAX_N: f64 = 40.0;
/// Longest time of one `wait`, ms.
const WAIT_MAX_MS: u64 = 60_000;

/// A line to the surroundings. Its answer is `ok`, with what follows here, or `err` and a reason.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurroundingsRequest {
    /// `reference SENSOR`: what the reference thermometer shows at a thermistor; the answer has it in °C.
    Reference(ThermistorId),
    /// `bath SENSOR CELSIUS`: puts the thermistor of skin or room into a bath, or the sink on a coolant.
    Bath(ThermistorId, f64),
    /// `phantom PLACE`: moves the phantom of the heat-flux sensor, `beside` the display, `on` it, or `away`.
    Phantom(PhantomPlace),
    /// `force NEWTON`: presses a finger on the display, or lifts it for 0.
    Force(f64),
    /// `wait MS SENT`: lets time pass, after the bytes that the host has sent to the device since it connected have arrived,
    /// as many as SENT. The answer has the time since power-up, ms, and the number of bytes that the device has sent to this
    /// host.
    Wait {
        /// Time, ms.
        ms: u64,
        /// Bytes sent.
        sent: u64,
    },
    /// What hands and instruments do at a board that is brought up.
    Bench(BenchRequest),
}

impl fmt::Display for SurroundingsRequest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reference(sensor) => write!(f, "reference {}", sensor.name()),
            Self::Bath(sensor, celsius) => {
                write!(f, "bath {} {celsius}", sensor.name())
            }
            Self::Phantom(place) => {
                let word = PhantomPlace::WORDS.iter().find(|(_, one)| one == place);
                write!(f, "phantom {}", word.map_or("", |(word, _)| word))
            }
            Self::Force(force_n) => write!(f, "force {force_n}"),
            Self::Wait { ms, sent } => write!(f, "wait {ms} {sent}"),
            Self::Bench(request) => request.fmt(f),
        }
    }
}

impl FromStr for SurroundingsRequest {
    type Err = String;

    /// Reads a line; the error says what is wrong and what is allowed.
    fn from_str(line: &str) -> Result<Self, String> {
        let words: Vec<_> = line.split_ascii_whitespace().collect();
        let sensor = |word: &str| {
            ThermistorId::of_word(word).ok_or_else(|| {
                format!("unknown sensor '{word}'; known: display check sink skin room")
            })
        };
        match *words.as_slice() {
            ["reference", word] => Ok(Self::Reference(sensor(word)?)),
            ["bath", word, celsius] => {
                let sensor = sensor(word)?;
                if matches!(sensor, ThermistorId::Display | ThermistorId::Check) {
                    return Err(format!("no bath for '{word}'; known: sink skin room"));
                }
                let bath_c = celsius.parse().ok().filter(|c| (0.0..=60.0).contains(c));
                let bath_c = bath_c.ok_or_else(|| format!("bath of '{celsius}'; 0 to 60 C"))?;
                Ok(Self::Bath(sensor, bath_c))
            }
            ["phantom", word] => {
                let place = PhantomPlace::WORDS.iter().find(|(one, _)| *one == word);
                let place = place.map(|(_, place)| Self::Phantom(*place));
                place.ok_or_else(|| format!("unknown place '{word}'; known: beside on away"))
            }
            ["force", newton] => {
                let force_n = newton.parse().ok();
                let force_n = force_n.filter(|n| (0.0..=FORCE_MAX_N).contains(n));
                let force_n =
                    force_n.ok_or_else(|| format!("force of '{newton}'; 0 to {FORCE_MAX_N} N"))?;
                Ok(Self::Force(force_n))
            }
            ["wait", ms, sent] => {
                let ms = ms.parse().ok().filter(|ms| (1..=WAIT_MAX_MS).contains(ms));
                let ms = ms.ok_or_else(|| format!("time in '{line}'; 1 to {WAIT_MAX_MS} ms"))?;
                let sent = sent.parse();
                let sent = sent.map_err(|_| format!("'{line}'; wait MS SENT, whole numbers"))?;
                Ok(Self::Wait { ms, sent })
            }
            ["meter" | "fit" | "remove" | "press" | "release", ..] => line.parse().map(Self::Bench),
            _ => Err(format!(
                "'{line}'; known: reference SENSOR, bath SENSOR CELSIUS, phantom PLACE, force NEWTON, wait MS SENT, \
                 meter POINT, fit PART, remove PART, press BUTTON, release BUTTON"
            )),
        }
    }
}
