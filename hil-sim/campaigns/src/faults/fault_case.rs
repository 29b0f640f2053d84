//! Fault cases: an injected fault, its symptoms and the expected reaction.

use std::fmt;

use thermal_device::safety::Fault;
use thermal_sim::processor::MachineFault;
use thermal_sim::scene::{ActiveFault, FaultKind, Sensor};

use super::{FaultScene, Symptom};

/// A fault to inject.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InjectedFault {
    /// A fault of plant, converter or host.
    Hardware(ActiveFault),
    /// A fault of the processor.
    Processor(MachineFault),
    /// The host sends a line.
    HostLine(&'static str),
}

impl InjectedFault {
    /// Name of the kind in a scene.
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

/// Expected state of the device at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExpectedReaction {
    /// After a symptom the device is tripped by one of these causes and by no other. Without a symptom it may continue.
    Trip(&'static [Fault]),
    /// The device is off, as after power-up, and reports no fault.
    Restart,
}

/// One row of the matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultCase {
    /// A fault to inject.
    pub fault: InjectedFault,
    /// Deviations of the plant that make the fault detectable; the first to occur counts.
    pub symptoms: &'static [Symptom],
    /// Expected reaction of the device.
    pub expected: ExpectedReaction,
    /// Whether it has no effect until another fault or the next self-test.
    pub latent: bool,
    /// Scenes in which it is worst; they are run before the others.
    pub scenes: &'static [FaultScene],
    /// Scenes in which it is meaningless.
    pub never_at: &'static [FaultScene],
    /// Duration of the scene after the fault, s.
    pub after_s: f64,
}

/// Default duration of the scene after a fault, s: long enough for the heat of the sink to return.
const AFTER_S: f64 = 24.0;

impl FaultCase {
    /// Allows these trip causes, too.
    pub(super) const fn or_trips(self, reasons: &'static [Fault]) -> Self {
        Self {
            expected: ExpectedReaction::Trip(reasons),
            ..self
        }
    }

    /// Marks it as latent.
    pub(super) const fn latent(self) -> Self {
        Self {
            latent: true,
            ..self
        }
    }

    /// Sets the scenes in which it is worst.
    pub(super) const fn at(self, scenes: &'static [FaultScene]) -> Self {
        Self { scenes, ..self }
    }

    /// Sets the scenes in which it is meaningless.
    pub(super) const fn never_at(self, scenes: &'static [FaultScene]) -> Self {
        Self {
            never_at: scenes,
            ..self
        }
    }

    /// Sets the duration of the scene after the fault, s.
    pub(super) const fn watched(self, after_s: f64) -> Self {
        Self { after_s, ..self }
    }
}

/// A fault with these symptoms, after which the device must trip with one of these causes.
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

/// A harmless fault, after which the device must continue unless [causes](FaultCase::or_trips) are allowed.
pub(super) const fn harmless(fault: InjectedFault) -> FaultCase {
    trips(fault, &[], &[])
}

/// A fault after which the device restarts without a fault.
pub(super) const fn restarts(fault: InjectedFault) -> FaultCase {
    FaultCase {
        expected: ExpectedReaction::Restart,
        ..trips(fault, &[Symptom::Injection], &[])
    }
}

/// A fault without a value.
pub(super) const fn broken(kind: FaultKind) -> InjectedFault {
    thermistor(kind, Sensor::Display, 0.0)
}

/// A fault with a value.
pub(super) const fn valued(kind: FaultKind, value: f64) -> InjectedFault {
    thermistor(kind, Sensor::Display, value)
}

/// A fault of one thermistor.
pub(super) const fn thermistor(kind: FaultKind, sensor: Sensor, value: f64) -> InjectedFault {
    InjectedFault::Hardware(ActiveFault {
        kind,
        sensor,
        with: sensor,
        value,
    })
}

/// Two exchanged thermistors.
pub(super) const fn swapped(sensor: Sensor, with: Sensor) -> InjectedFault {
    InjectedFault::Hardware(ActiveFault {
        kind: FaultKind::SensorsSwapped,
        sensor,
        with,
        value: 0.0,
    })
}
