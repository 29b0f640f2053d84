//! One run of one fault.

use anyhow::Context;
use serde::Serialize;

use super::verdict::Verdict;
use super::{Entry, Injected, Moment};
use crate::engine::{Engine, Image, Injection, Native, NotInjected};
use crate::machine::Firmware;
use crate::metrics::{Figures, figures};
use crate::run::{Outcome, RunError, run};
use crate::scene::{Fault, FaultKind, HostLine, Scene};
use crate::world::World;

/// What is asked at the end, and how long before it, s. Twice: a reset tears a line of telemetry, which the first answer
/// then ends.
const QUESTIONS: [(f64, &str); 2] = [(0.2, "state"), (0.1, "state")];
/// A host that fell silent comes back after so long, s, to ask.
const SILENT_S: f64 = 6.0;

/// What runs a trial.
#[derive(Clone, Copy)]
pub enum Device<'a> {
    /// An image in the emulated microcontroller.
    Image(&'a Firmware),
    /// Its logic, called directly.
    Native,
}

impl Device<'_> {
    /// The engine's name.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Image(_) => Image::NAME,
            Self::Native => Native::NAME,
        }
    }

    /// Runs a scene; none if the engine has no part that could fail so.
    fn run(self, scene: &Scene) -> anyhow::Result<Option<(Outcome, Figures)>> {
        fn on<E: Engine>(scene: &Scene, engine: &mut E) -> anyhow::Result<Option<(Outcome, Figures)>> {
            let outcome = match run(scene, engine, |_| ()) {
                Err(RunError::NotInjected(NotInjected::NotApplicable { .. })) => return Ok(None),
                outcome => outcome?,
            };
            let figures = figures::<E>(scene, &outcome);
            Ok(Some((outcome, figures)))
        }
        let world = World::new(scene).context("plant")?;
        match self {
            Self::Image(firmware) => on(scene, &mut Image::new(firmware, world)?),
            Self::Native => on(scene, &mut Native::new(world)),
        }
    }
}

/// One run of one fault.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// The scene.
    pub place: &'static str,
    /// When the fault came, s.
    pub t_s: f64,
    /// What came of it.
    #[serde(flatten)]
    pub verdict: Verdict,
}

impl Trial {
    /// Runs an entry at a moment; none if the engine has no part that could fail so.
    ///
    /// # Errors
    /// The scene cannot be, or the run ended with something that is not modelled.
    pub fn run(device: Device<'_>, entry: &Entry, moment: Moment, seed: u64) -> anyhow::Result<Option<Self>> {
        let scene = scene(entry, moment, seed)?;
        let verdict = match device.run(&scene) {
            Ok(None) => return Ok(None),
            Ok(Some((outcome, figures))) => Verdict::of(entry, moment, &outcome, &figures),
            // Nobody knows what silicon would do then: that proves nothing, so it counts as a breach.
            Err(error) => Verdict::ended(&error),
        };
        Ok(Some(Self {
            place: moment.place.name(),
            t_s: moment.t_s,
            verdict,
        }))
    }
}

/// The place's scene with the fault in it, and with what the host asks in the end.
fn scene(entry: &Entry, moment: Moment, seed: u64) -> anyhow::Result<Scene> {
    let t_s = moment.t_s;
    let mut scene = moment.place.scene(seed, t_s, entry.after_s)?;
    match entry.fault {
        Injected::Broken(broken) => {
            let until_s = match broken.kind {
                FaultKind::HostSilent => t_s + SILENT_S,
                _ => f64::INFINITY,
            };
            scene.faults.push(Fault { broken, t_s, until_s });
        }
        Injected::Processor(fault) => scene.injections.push(Injection { t_s, fault }),
        Injected::Line(line) => scene.host.push(HostLine {
            t_s,
            line: line.into(),
        }),
    }
    let end_s = scene.duration_s;
    scene.host.extend(QUESTIONS.map(|(before_s, line)| HostLine {
        t_s: end_s - before_s,
        line: line.into(),
    }));
    Ok(scene)
}
