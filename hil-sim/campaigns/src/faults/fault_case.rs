//! One fault, and what is right about it.

use std::fmt;

use thermal_device::safety::Fault;
use thermal_sim::processor::MachineFault;
use thermal_sim::scene::{ActiveFault, FaultKind, Sensor};

use super::{FaultScene, Symptom};

/// What happens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InjectedFault {
    /// Something of plant, converter or host breaks.
    Hardware(ActiveFault),
    /// Something of the processor does.
    Processor(MachineFault),
    /// The host sends a line.
    HostLine(&'static str),
}

impl InjectedFault {
    /// The kind, as a scene has it.
    #[must_use]
    pub fn kind(&self) -> String {
        match self {
            Self::Hardware(active) => active.kind.name().into(),
            Self::Processor(fault) => {
                let text = fault.to_string();
                text.split_once('=')
                    .map_or(text.clone(), |(kind, _)| kind.into())
            }
            Self::HostLine(_) => "host-line".into(),
        }
    }
}

impl fmt::Display for InjectedFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Processor(fault) => fault.fmt(f),
            Self::HostLine(line) => write!(f, "host-line '{line}'"),
            Self::Hardware(active) => {
                f.write_str(active.kind.name())?;
                if active.kind.has_sensor() {
                    write!(f, " {}", active.sensor.name())?;
                }
                if active.kind.needs_second_sensor() {
                    write!(f, " {}", active.with.name())?;
                }
                match active.kind.value() {
                    Some(takes) if takes.unit == "1" => write!(f, " x{}", active.value),
                    Some(takes) if takes.min < 0.0 => {
                        write!(f, " {:+} {}", active.value, takes.unit)
                    }
                    Some(takes) => write!(f, " {} {}", active.value, takes.unit),
                    None => Ok(()),
                }
            }
        }
    }
}

/// What the device may say in the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExpectedReaction {
    /// Once a sign is reached it is tripped by one of these, and never by another. Before, and without symptoms, it may go on.
    Trip(&'static [Fault]),
    /// It is off, as after power-up, and has no fault to report.
    Restart,
}

/// One row of the matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultCase {
    /// What happens.
    pub fault: InjectedFault,
    /// Deviations of the plant that make it detectable; the first that is reached counts.
    pub symptoms: &'static [Symptom],
    /// What the device may then say.
    pub expected: ExpectedReaction,
    /// It does nothing until another fault comes, or until the next self-test.
    pub latent: bool,
    /// Where it is worst; taken before the others.
    pub scenes: &'static [FaultScene],
    /// Where it means nothing.
    pub never_at: &'static [FaultScene],
    /// How long is watched after it, s.
    pub after_s: f64,
}

/// How long is watched after a fault unless its fault case says otherwise, s: long enough for the sink's heat to come back.
const AFTER_S: f64 = 24.0;

impl FaultCase {
    /// It may trip for one of these, too.
    pub(super) const fn or_trips(self, reasons: &'static [Fault]) -> Self {
        Self {
            expected: ExpectedReaction::Trip(reasons),
            ..self
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
    pub(super) const fn at(self, scenes: &'static [FaultScene]) -> Self {
        Self { scenes, ..self }
    }

    /// Where it means nothing.
    pub(super) const fn never_at(self, scenes: &'static [FaultScene]) -> Self {
        Self {
            never_at: scenes,
            ..self
        }
    }

    /// How long is watched after it, s.
    pub(super) const fn watched(self, after_s: f64) -> Self {
        Self { after_s, ..self }
    }
}

/// A fault that is detectable by these symptoms and must be named by one of these reasons.
pub(super) const fn trips(
    fault: InjectedFault,
    symptoms: &'static [Symptom],
    reasons: &'static [Fault],
) -> FaultCase {
    FaultCase {
        fault,
        symptoms,
        expected: ExpectedReaction::Trip(reasons),
        latent: false,
        scenes: &[],
        never_at: &[],
        after_s: AFTER_S,
    }
}

/// A fault that hurts nobody, so that the device must go on, unless there are [reasons](Self::or_trips).
pub(super) const fn harmless(fault: InjectedFault) -> FaultCase {
    trips(fault, &[], &[])
}

/// A fault from which the device starts anew, without anything to report.
pub(super) const fn restarts(fault: InjectedFault) -> FaultCase {
    FaultCase {
        expected: ExpectedReaction::Restart,
        ..trips(fault, &[Symptom::Injection], &[])
    }
}

/// Of the display's thermistor unless another is named.
pub(super) const fn broken(kind: FaultKind) -> InjectedFault {
    thermistor(kind, Sensor::Display, 0.0)
}

/// With a value.
pub(super) const fn valued(kind: FaultKind, value: f64) -> InjectedFault {
    thermistor(kind, Sensor::Display, value)
}

/// Of one thermistor.
pub(super) const fn thermistor(kind: FaultKind, sensor: Sensor, value: f64) -> InjectedFault {
    InjectedFault::Hardware(ActiveFault {
        kind,
        sensor,
        with: sensor,
        value,
    })
}

/// Two thermistors in each other's place.
pub(super) const fn swapped(sensor: Sensor, with: Sensor) -> InjectedFault {
    InjectedFault::Hardware(ActiveFault {
        kind: FaultKind::SensorsSwapped,
        sensor,
        with,
        value: 0.0,
    })
}
