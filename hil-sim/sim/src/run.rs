//! A scene on an engine, from switch-on to the last row.

use std::time::Instant;

use crate::commissioning::{self, CommissionError};
use crate::engine::{Engine, LineSplitter};
use crate::processor::{Injection, MachineFault, NotInjected};
use crate::scene::Scene;
use crate::scene_recording::SceneRecording;

pub use crate::scene_recording::Outcome;

/// Time after the last row in which its telemetry arrives, ms.
const DRAIN_MS: u64 = 5;
/// Half a millisecond, µs.
const HALF_MS_US: u64 = 500;

/// Why a run ended early.
#[derive(Debug, thiserror::Error)]
pub enum RunError<S: std::error::Error + 'static> {
    /// The engine stopped: the device did something that is not modelled.
    #[error(transparent)]
    Stop(S),
    /// The device cannot be commissioned, so it never comes to the scene.
    #[error(transparent)]
    Commission(CommissionError),
    /// A fault of the processor could not be injected.
    #[error(transparent)]
    NotInjected(#[from] NotInjected),
    /// An injection outside of the run.
    #[error("{fault} at {t_s} s is outside of the run, which goes from {from_s} s to {to_s} s")]
    InjectionTime {
        /// What should have happened.
        fault: MachineFault,
        /// When, s.
        t_s: f64,
        /// Begin of the run: it settles first.
        from_s: f64,
        /// End of the scene.
        to_s: f64,
    },
    /// One finger's scene breaks what all share.
    #[error(
        "{0} is a fault of the processor that five fingers share; such a scene is for one finger"
    )]
    SharedProcessor(MachineFault),
    /// The device refused a line that sets the scene up.
    #[error("the device refused to be set up for the scene: {0}")]
    Refused(String),
}

/// Runs a scene; `progress` is told the part that is done.
///
/// # Errors
/// The engine stopped, or the device refused the scene.
pub fn run<E: Engine>(
    scene: &Scene,
    engine: &mut E,
    progress: impl FnMut(f64),
) -> Result<Outcome, RunError<E::Stop>> {
    run_with(scene, &[], engine, progress)
}

/// Runs a scene in which the processor fails, beside what the scene itself has of that.
///
/// # Errors
/// As [`run`]; or an injection that the engine refuses.
pub fn run_with<E: Engine>(
    scene: &Scene,
    injections: &[Injection],
    engine: &mut E,
    mut progress: impl FnMut(f64),
) -> Result<Outcome, RunError<E::Stop>> {
    let settings = commissioning::settings_for_scene(scene).map_err(RunError::Commission)?;
    let began = Instant::now();
    let recording = SceneRecording::new(scene, &settings, 1);
    let (zero_ms, last_ms) = (recording.zero_ms, recording.end_ms + DRAIN_MS);
    let time_s = |ms: f64| (ms - zero_ms as f64) / 1e3;
    let (from_s, to_s) = (time_s(0.0), time_s(recording.end_ms as f64));
    let injections: Vec<_> = scene.injections.iter().chain(injections).collect();
    for &&Injection { t_s, fault } in &injections {
        if !(from_s..=to_s).contains(&t_s) {
            return Err(RunError::InjectionTime {
                fault,
                t_s,
                from_s,
                to_s,
            });
        }
    }
    let mut session = Session {
        recording,
        injections,
        engine,
        received: LineSplitter::default(),
    };
    for ms in 0..=last_ms {
        if ms == zero_ms {
            session.engine.reset_cost();
        }
        session.recording.change(ms, session.engine.world());
        session.send(2 * ms);
        session.inject(2 * ms, |after_us| after_us == 0)?;
        session.recording.keep(ms, session.engine.world());
        session.step_plant();
        session.inject(2 * ms, |after_us| after_us > 0)?;
        session.engine.run_half_ms().map_err(RunError::Stop)?;
        session.send(2 * ms + 1);
        session.inject(2 * ms + 1, |_| true)?;
        session.engine.run_half_ms().map_err(RunError::Stop)?;
        for line in session.lines() {
            (session.recording.hear(ms, line)).map_err(RunError::Refused)?;
        }
        progress(ms as f64 / last_ms as f64);
    }
    let real_time_factor = last_ms as f64 * 1e-3 / began.elapsed().as_secs_f64();
    let Session {
        recording, engine, ..
    } = session;
    Ok(recording.outcome(E::NAME, &engine.resets(), engine.cost(), real_time_factor))
}

struct Session<'a, E> {
    recording: SceneRecording<'a>,
    injections: Vec<&'a Injection>,
    engine: &'a mut E,
    received: LineSplitter,
}

impl<E: Engine> Session<'_, E> {
    /// What fails of the processor in a half millisecond since the start, at those of its microseconds.
    fn inject(&mut self, half_ms: u64, at: impl Fn(u32) -> bool) -> Result<(), NotInjected> {
        for injection in &self.injections {
            // Not negative: the time has been checked to be in the run.
            let us = (injection.t_s * 1e6 + self.recording.zero_ms as f64 * 1e3).round() as u64;
            let after_us = (us % HALF_MS_US) as u32;
            if us / HALF_MS_US == half_ms && at(after_us) {
                self.engine.inject(&injection.fault, after_us)?;
            }
        }
        Ok(())
    }

    /// What the host sends at a half millisecond since the start.
    fn send(&mut self, half_ms: u64) {
        if let Some(bytes) = self.recording.host.send(half_ms) {
            self.engine.send(bytes);
        }
    }

    /// Advances the plant to the next boundary, under the legs as they are at this one.
    fn step_plant(&mut self) {
        let legs = self.engine.legs();
        self.engine.world().step(legs);
    }

    /// The lines that are complete.
    fn lines(&mut self) -> Vec<String> {
        self.engine.receive(self.received.received());
        self.received.complete()
    }
}
