//! Fault cases: an injected fault, its symptoms and the expected reaction.

use std::fmt;

use thermal_device::learning::FingerKnowledge;
use thermal_device::safety::Fault;
use thermal_learner::Trust;
use thermal_sim::processor::MachineFault;
use thermal_sim::scene::{ActiveFault, FaultKind, Sensor};

use super::{FaultScene, Symptom, Touch};

/// A fault to inject.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InjectedFault {
    /// A fault of plant, converter or host.
    Hardware(ActiveFault),
    /// A fault of the processor.
    Processor(MachineFault),
    /// The host sends a line, or several with `; ` between them.
    HostLine(&'static str),
}

impl InjectedFault {
    /// Name of the kind in a scene.
    pub fn kind(&self) -> String {
        match self {
            Self::Hardware(active) => active.kind.name().into(),
            Self::Processor(fault) => {
                let text = fault.to_string();
                text.split_once('=').map_or(text.clone(), |(kind, _)| kind.into())
            }
            Self::HostLine(_) => "host-line".into(),
        }
    }

    /// The fault that is printed as this text.
    pub(super) fn from_text(text: &'static str) -> Option<Self> {
        let fault = if let Some(line) = text.strip_prefix("host-line '") {
            Self::HostLine(line.strip_suffix('\'')?)
        } else if let Ok(fault) = text.parse() {
            Self::Processor(fault)
        } else {
            let mut words = text.split(' ');
            let sensor = |word| Sensor::ALL.into_iter().find(|sensor| sensor.name() == word);
            let kind = words.next()?;
            let kind = FaultKind::ALL.into_iter().find(|known| known.name() == kind)?;
            let mut fault = ActiveFault::from(kind);
            if kind.has_sensor() {
                fault.sensor = sensor(words.next()?)?;
                fault.with = fault.sensor;
            }
            if kind.needs_second_sensor() {
                fault.with = sensor(words.next()?)?;
            }
            if kind.value().is_some() {
                fault.value = words.next()?.trim_start_matches('x').parse().ok()?;
            }
            Self::Hardware(fault)
        };
        (fault.to_string() == text).then_some(fault)
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

/// What a fault must do to the learning of the finger from the heat flux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearningExpected {
    /// What the device may say of the finger at the end.
    pub knowledge: &'static [FingerKnowledge],
    /// Scenes in which it may also say that the finger is trusted, because the fault changes the flux too little.
    pub unnoticed_at: &'static [FaultScene],
    /// Whether the skin is compared with that on a display that assumes the finger, or that has learnt it without the fault. Not the
    /// set-point: it runs ahead of a display that is at the limit of its current.
    pub assumes: bool,
    /// Largest difference of the skin, from 0.2 s after the fault on, K.
    pub skin_max_k: f64,
}

impl LearningExpected {
    /// Whether the device may say this word of the finger at the end of this scene.
    pub(super) fn allows(&self, word: Option<&str>, scene: FaultScene) -> bool {
        let trusted = FingerKnowledge::Learnt(Trust::Trusted);
        let unnoticed = self.unnoticed_at.contains(&scene).then_some(&trusted);
        let mut allowed = self.knowledge.iter().chain(unnoticed);
        allowed.any(|one| word == Some(one.name()))
    }
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
    /// Whether the set-point must remain what it is in the same scene without the fault.
    pub unchanged: bool,
    /// Without it, the device has no heat-flux sensor.
    pub learning: Option<LearningExpected>,
    /// Scenes in which it is worst; they are run before the others.
    pub scenes: &'static [FaultScene],
    /// Scenes in which it is meaningless.
    pub never_at: &'static [FaultScene],
    /// Duration of the scene after the fault, s.
    pub after_s: f64,
}

impl FaultCase {
    /// The finger of its scenes, drawn by a seed if the device learns it, and the object.
    pub(super) fn touch(&self, seed: u64) -> Touch {
        match self.learning {
            Some(_) => Touch::learnt(seed),
            None => Touch::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::faults::fault_cases;

    use super::*;

    #[test]
    fn a_missing_flux_may_be_unnoticed_on_foam_only() {
        let short = fault_cases().into_iter().find(|one| one.fault.kind() == "flux-short");
        let learning = short.and_then(|short| short.learning).expect("a row with a sensor");
        for (word, scene, is_allowed) in [
            (Some("contact"), FaultScene::Foam, true),
            (Some("trusted"), FaultScene::Foam, true),
            (Some("late"), FaultScene::Foam, false),
            (None, FaultScene::Foam, false),
            (Some("contact"), FaultScene::Copper, true),
            (Some("trusted"), FaultScene::Copper, false),
        ] {
            let found = learning.allows(word, scene);
            assert_eq!(found, is_allowed, "{word:?}, {scene:?}");
        }
    }
}
