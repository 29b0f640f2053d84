//! One fault, and what is right about it.

use std::fmt;

use thermal_display::guard::Fault;
use thermal_sim::processor::MachineFault;
use thermal_sim::scene::{Broken, FaultKind, Sensor};

use super::{Place, Sign};

/// What happens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Injected {
    /// Something of plant, converter or host breaks.
    Broken(Broken),
    /// Something of the processor does.
    Processor(MachineFault),
    /// The host sends a line.
    Line(&'static str),
}

impl Injected {
    /// The kind, as a scene has it.
    #[must_use]
    pub fn kind(&self) -> String {
        match self {
            Self::Broken(broken) => broken.kind.name().into(),
            Self::Processor(fault) => {
                let text = fault.to_string();
                text.split_once('=')
                    .map_or(text.clone(), |(kind, _)| kind.into())
            }
            Self::Line(_) => "host-line".into(),
        }
    }
}

/// Its name in a scene.
pub(super) const fn sensor(sensor: Sensor) -> &'static str {
    match sensor {
        Sensor::Display => "display",
        Sensor::Check => "check",
        Sensor::Sink => "sink",
        Sensor::Skin => "skin",
        Sensor::Room => "room",
    }
}

impl fmt::Display for Injected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Processor(fault) => fault.fmt(f),
            Self::Line(line) => write!(f, "host-line '{line}'"),
            Self::Broken(broken) => {
                f.write_str(broken.kind.name())?;
                if broken.kind.has_sensor() {
                    write!(f, " {}", sensor(broken.sensor))?;
                }
                if broken.kind.has_other() {
                    write!(f, " {}", sensor(broken.with))?;
                }
                match broken.kind.value() {
                    Some(takes) if takes.unit == "1" => write!(f, " x{}", broken.value),
                    Some(takes) if takes.least < 0.0 => {
                        write!(f, " {:+} {}", broken.value, takes.unit)
                    }
                    Some(takes) => write!(f, " {} {}", broken.value, takes.unit),
                    None => Ok(()),
                }
            }
        }
    }
}

/// What the device may say in the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Right {
    /// Once a sign is reached it is tripped by one of these, and never by another. Before, and without signs, it may go on.
    Trip(&'static [Fault]),
    /// It is off, as after power-up, and has no fault to report.
    Restart,
}

/// One row of the matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// What happens.
    pub fault: Injected,
    /// Deviations of the plant that make it detectable; the first that is reached counts.
    pub signs: &'static [Sign],
    /// What the device may then say.
    pub right: Right,
    /// It does nothing until another fault comes, or until the next self-test.
    pub latent: bool,
    /// Where it is worst; taken before the others.
    pub places: &'static [Place],
    /// Where it means nothing.
    pub never_at: &'static [Place],
    /// How long is watched after it, s.
    pub after_s: f64,
}

/// How long is watched after a fault unless its entry says otherwise, s: long enough for the sink's heat to come back.
const AFTER_S: f64 = 24.0;

impl Entry {
    /// A fault that is detectable by these signs and must be named by one of these reasons.
    pub(super) const fn trips(
        fault: Injected,
        signs: &'static [Sign],
        reasons: &'static [Fault],
    ) -> Self {
        Self {
            fault,
            signs,
            right: Right::Trip(reasons),
            latent: false,
            places: &[],
            never_at: &[],
            after_s: AFTER_S,
        }
    }

    /// A fault that hurts nobody, so that the device must go on, unless there are [reasons](Self::or_trips).
    pub(super) const fn harmless(fault: Injected) -> Self {
        Self::trips(fault, &[], &[])
    }

    /// It may trip for one of these, too.
    pub(super) const fn or_trips(self, reasons: &'static [Fault]) -> Self {
        Self {
            right: Right::Trip(reasons),
            ..self
        }
    }

    /// A fault from which the device starts anew, without anything to report.
    pub(super) const fn restarts(fault: Injected) -> Self {
        Self {
            right: Right::Restart,
            ..Self::trips(fault, &[Sign::Injection], &[])
        }
    }

    /// It shows at the next self-test only.
    pub(super) const fn latent(self) -> Self {
        Self {
            latent: true,
            ..self
        }
    }

    /// Where it is worst.
    pub(super) const fn at(self, places: &'static [Place]) -> Self {
        Self { places, ..self }
    }

    /// Where it means nothing.
    pub(super) const fn never_at(self, places: &'static [Place]) -> Self {
        Self {
            never_at: places,
            ..self
        }
    }

    /// How long is watched after it, s.
    pub(super) const fn watched(self, after_s: f64) -> Self {
        Self { after_s, ..self }
    }
}

/// Of the display's thermistor unless another is named.
pub(super) const fn broken(kind: FaultKind) -> Injected {
    thermistor(kind, Sensor::Display, 0.0)
}

/// With a value.
pub(super) const fn valued(kind: FaultKind, value: f64) -> Injected {
    thermistor(kind, Sensor::Display, value)
}

/// Of one thermistor.
pub(super) const fn thermistor(kind: FaultKind, sensor: Sensor, value: f64) -> Injected {
    Injected::Broken(Broken {
        kind,
        sensor,
        with: sensor,
        value,
    })
}

/// Two thermistors in each other's place.
pub(super) const fn swapped(sensor: Sensor, with: Sensor) -> Injected {
    Injected::Broken(Broken {
        kind: FaultKind::SensorsSwapped,
        sensor,
        with,
        value: 0.0,
    })
}
