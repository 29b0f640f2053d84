//! Runs a scene on an engine, from power-up to the last row.

use std::time::Instant;

use thermal_client::commissioning::CommissionError;

use crate::commissioning;
use crate::engine::{Engine, LineSplitter};
use crate::host::SET_UP_FROM_MS;
use crate::processor::{Injection, MachineFault, NotInjected};
use crate::scene::Scene;
use crate::scene_recording::SceneRecording;
use crate::speed::RunClock;
use crate::trigger_edges::TriggerEdges;

pub use crate::scene_recording::{Exchange, Outcome};

/// Time for the telemetry of the last row to arrive, ms.
const DRAIN_MS: u64 = 5;
const HALF_MS_US: u64 = 500;

/// Why a run ended early.
#[derive(Debug, thiserror::Error)]
pub enum RunError<S: std::error::Error + 'static> {
    /// The engine stopped because the device did something that is not modelled.
    #[error(transparent)]
    Stop(S),
    /// Commissioning of the device failed before the scene.
    #[error(transparent)]
    Commission(CommissionError),
    /// A processor fault could not be injected.
    #[error(transparent)]
    NotInjected(#[from] NotInjected),
    /// An injection time outside of the run.
    #[error("{fault} at {t_s} s is outside of the run, which goes from {from_s} s to {to_s} s")]
    InjectionTime {
        /// The fault.
        fault: MachineFault,
        /// Its time, s.
        t_s: f64,
        /// Start of the run, including settling, s.
        from_s: f64,
        /// End of the scene, s.
        to_s: f64,
    },
    /// The device refused a set-up line of the scene.
    #[error("the device refused to be set up for the scene: {0}")]
    Refused(String),
}

/// Runs a scene; `progress` is called with the fraction done.
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

/// Runs a scene with processor faults in addition to those of the scene.
///
/// # Errors
/// As [`run`], or the engine refuses an injection.
pub fn run_with<E: Engine>(
    scene: &Scene,
    injections: &[Injection],
    engine: &mut E,
    progress: impl FnMut(f64),
) -> Result<Outcome, RunError<E::Stop>> {
    let began = Instant::now();
    let settings = commissioning::settings_for_scene(scene).map_err(RunError::Commission)?;
    let scene = commissioning::with_person(scene).map_err(RunError::Commission)?;
    let mut outcome = run_with_settings(&scene, &settings, injections, engine, progress)?;
    outcome.clock.began = began;
    Ok(outcome)
}

/// Runs a scene on a device with these settings, as lines, whose person is not enrolled.
///
/// # Errors
/// As [`run_with`].
pub(crate) fn run_with_settings<E: Engine>(
    scene: &Scene,
    settings: &[String],
    injections: &[Injection],
    engine: &mut E,
    mut progress: impl FnMut(f64),
) -> Result<Outcome, RunError<E::Stop>> {
    let began = Instant::now();
    let recording = SceneRecording::new(scene, settings, 1, SET_UP_FROM_MS);
    let (zero_ms, last_ms) = (recording.zero_ms, recording.end_ms + DRAIN_MS);
    let time_s = |ms: f64| (ms - zero_ms as f64) / 1e3;
    let (from_s, to_s) = (time_s(0.0), time_s(recording.end_ms as f64));
    let injections: Vec<_> = scene.injections.iter().chain(injections).collect();
    for &&Injection { t_s, fault } in &injections {
        if !(from_s..=to_s).contains(&t_s) {
            return Err(RunError::InjectionTime { fault, t_s, from_s, to_s });
        }
    }
    let mut scene_run = SceneRun {
        recording,
        injections,
        scene,
        trigger_edges: TriggerEdges::new(-1000 * zero_ms as i64),
        engine,
        received: LineSplitter::default(),
    };
    for ms in 0..=last_ms {
        if ms == zero_ms {
            scene_run.engine.reset_cost();
        }
        scene_run.recording.apply_scene(ms, scene_run.engine.world());
        scene_run.send(2 * ms);
        scene_run.inject(2 * ms, |after_us| after_us == 0)?;
        scene_run.recording.record(ms, scene_run.engine.world());
        scene_run.step_plant();
        scene_run.inject(2 * ms, |after_us| after_us > 0)?;
        scene_run.trigger(2 * ms).map_err(RunError::Stop)?;
        scene_run.engine.run_half_ms().map_err(RunError::Stop)?;
        scene_run.send(2 * ms + 1);
        scene_run.inject(2 * ms + 1, |_| true)?;
        scene_run.trigger(2 * ms + 1).map_err(RunError::Stop)?;
        scene_run.engine.run_half_ms().map_err(RunError::Stop)?;
        for line in scene_run.lines() {
            (scene_run.recording.receive(ms, line)).map_err(RunError::Refused)?;
        }
        progress(ms as f64 / last_ms as f64);
    }
    let clock = RunClock::at_last_row(began, began, last_ms);
    let SceneRun { recording, engine, .. } = scene_run;
    Ok(recording.outcome(E::NAME, &engine.resets(), engine.cost(), clock))
}

/// Microseconds from the start of a half millisecond since the start to a time of the scene, s, if the time is in that half
/// millisecond. Time zero of the scene is `zero_ms` after the start.
fn offset_in_half_ms(t_s: f64, zero_ms: u64, half_ms: u64) -> Option<u32> {
    let us = (t_s * 1e6 + zero_ms as f64 * 1e3).round() as u64;
    (us / HALF_MS_US == half_ms).then_some((us % HALF_MS_US) as u32)
}

/// Injects the processor faults of a half millisecond since the start whose offset in it, µs, is accepted by `at`. Time zero
/// of the scene is `zero_ms` after the start, and no fault is before the start.
pub(crate) fn inject_due<'a, E: Engine>(
    engine: &mut E,
    injections: impl Iterator<Item = &'a Injection>,
    zero_ms: u64,
    half_ms: u64,
    at: impl Fn(u32) -> bool,
) -> Result<(), NotInjected> {
    for injection in injections {
        let after_us = offset_in_half_ms(injection.t_s, zero_ms, half_ms);
        if let Some(after_us) = after_us.filter(|after_us| at(*after_us)) {
            engine.inject(&injection.fault, after_us)?;
        }
    }
    Ok(())
}

/// Raises the trigger input at the edges of a scene within a half millisecond, which begins `from_us` after time zero.
pub(crate) fn raise_trigger<E: Engine>(
    engine: &mut E,
    scene: &Scene,
    edges: &mut TriggerEdges,
    from_us: i64,
) -> Result<(), E::Stop> {
    while let Some(us) = edges.next_before(scene, from_us + HALF_MS_US as i64) {
        engine.trigger((us - from_us) as u32)?;
    }
    Ok(())
}

struct SceneRun<'a, E> {
    recording: SceneRecording<'a>,
    injections: Vec<&'a Injection>,
    scene: &'a Scene,
    trigger_edges: TriggerEdges,
    engine: &'a mut E,
    received: LineSplitter,
}

impl<E: Engine> SceneRun<'_, E> {
    fn inject(&mut self, half_ms: u64, at: impl Fn(u32) -> bool) -> Result<(), NotInjected> {
        let (injections, zero_ms) = (self.injections.iter().copied(), self.recording.zero_ms);
        inject_due(self.engine, injections, zero_ms, half_ms, at)
    }

    /// Raises the trigger input at the scene's times within a half millisecond.
    fn trigger(&mut self, half_ms: u64) -> Result<(), E::Stop> {
        let from_us = (HALF_MS_US * half_ms) as i64 - 1000 * self.recording.zero_ms as i64;
        raise_trigger(self.engine, self.scene, &mut self.trigger_edges, from_us)
    }

    /// Sends the bytes of the host at a half millisecond since the start.
    fn send(&mut self, half_ms: u64) {
        if let Some(bytes) = self.recording.send(half_ms) {
            self.engine.send(bytes);
        }
    }

    /// Advances the plant to the next boundary with the bridge legs as they are at this one.
    fn step_plant(&mut self) {
        let legs = self.engine.legs();
        self.engine.world().step(legs);
    }

    /// The complete lines received since the last call.
    fn lines(&mut self) -> Vec<String> {
        self.engine.receive(self.received.received());
        self.received.complete()
    }
}
