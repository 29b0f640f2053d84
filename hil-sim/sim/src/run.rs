//! A scene on an engine, from switch-on to the last row.

use std::time::Instant;

use crate::commission::{self, CommissionError};
use crate::engine::{Cost, DeviceReset, Engine, Lines};
use crate::host::Host;
use crate::processor::{Injection, MachineFault, NotInjected};
use crate::scene::{Broken, Scene};
use crate::telemetry::Telemetry;
use crate::trace::{Row, Trace};

/// Time after the last row in which its telemetry arrives, ms.
const DRAIN_MS: u64 = 5;
/// Half a millisecond, µs.
const HALF_MS_US: u64 = 500;

/// What a run has given.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the engine that has run it.
    pub engine: &'static str,
    /// One row a millisecond.
    pub trace: Trace,
    /// Every line of the device that is not telemetry, with the time at which it was complete, s.
    pub answers: Vec<(f64, String)>,
    /// Resets of the device after its power-up, at times of the scene: negative while it settles.
    pub resets: Vec<DeviceReset>,
    /// Electrical work that the module has taken up in the scene, J.
    pub electrical_j: f64,
    /// Cost of the scene, without set-up and settling.
    pub cost: Option<Cost>,
    /// Simulated seconds per second of this machine, settling included.
    pub real_time_factor: f64,
}

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
    Shared(MachineFault),
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
    let settings = commission::of_scene(scene).map_err(RunError::Commission)?;
    let began = Instant::now();
    let zero_ms = scene.settle_ms();
    let end_ms = zero_ms + (scene.duration_s * 1e3).round() as u64;
    let time_s = |ms: f64| (ms - zero_ms as f64) / 1e3;
    let (from_s, to_s) = (time_s(0.0), time_s(end_ms as f64));
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
        scene,
        injections,
        engine,
        host: Host::new(scene, &settings, 1),
        zero_ms,
        received: Lines::default(),
    };
    let (mut trace, mut answers) = (Trace::default(), Vec::new());
    let (mut before_j, mut after_j) = (0.0, 0.0);
    for ms in 0..=end_ms + DRAIN_MS {
        if ms == zero_ms {
            session.engine.reset_cost();
            before_j = session.engine.world().plant().energy().electrical_j;
        }
        session.boundary(ms);
        session.inject(2 * ms, |after_us| after_us == 0)?;
        if (zero_ms..=end_ms).contains(&ms) {
            let t_s = session.t_s(ms);
            let world = session.engine.world();
            let camera = world.look(ms - zero_ms);
            let row = Row::now(t_s, world.plant(), camera);
            after_j = world.plant().energy().electrical_j;
            trace.push(ms, row);
        }
        session.step_plant();
        session.inject(2 * ms, |after_us| after_us > 0)?;
        session.engine.run_half_ms().map_err(RunError::Stop)?;
        session.send(2 * ms + 1);
        session.inject(2 * ms + 1, |_| true)?;
        session.engine.run_half_ms().map_err(RunError::Stop)?;
        for line in session.lines() {
            match Telemetry::parse(&line) {
                Some(telemetry) => trace.join(telemetry),
                // Before time zero only set-up is sent.
                None if ms < zero_ms && line.starts_with("err") => {
                    return Err(RunError::Refused(line));
                }
                None => answers.push((session.t_s(ms + 1), line)),
            }
        }
        progress(ms as f64 / (end_ms + DRAIN_MS) as f64);
    }
    let simulated_s = (end_ms + DRAIN_MS) as f64 * 1e-3;
    let real_time_factor = simulated_s / began.elapsed().as_secs_f64();
    Ok(Outcome {
        engine: E::NAME,
        trace,
        answers,
        resets: in_scene(&session.engine.resets(), zero_ms),
        electrical_j: after_j - before_j,
        cost: session.engine.cost(),
        real_time_factor,
    })
}

/// Resets at times of the scene, which begins so many milliseconds after the first boundary.
pub(crate) fn in_scene(resets: &[DeviceReset], zero_ms: u64) -> Vec<DeviceReset> {
    let shift = |reset: &DeviceReset| DeviceReset {
        t_s: reset.t_s - zero_ms as f64 / 1e3,
        ..*reset
    };
    resets.iter().map(shift).collect()
}

/// What is broken at a time.
pub(crate) fn broken(scene: &Scene, t_s: f64) -> impl Iterator<Item = Broken> {
    scene.faults.iter().filter_map(move |fault| fault.at(t_s))
}

struct Session<'a, E> {
    scene: &'a Scene,
    injections: Vec<&'a Injection>,
    engine: &'a mut E,
    host: Host,
    zero_ms: u64,
    received: Lines,
}

impl<E: Engine> Session<'_, E> {
    /// Time of a millisecond since the start.
    fn t_s(&self, ms: u64) -> f64 {
        (ms as f64 - self.zero_ms as f64) / 1e3
    }

    /// What the scene changes at the boundary.
    fn boundary(&mut self, ms: u64) {
        let t_s = self.t_s(ms);
        self.engine
            .world()
            .set(self.scene.force_n(t_s), broken(self.scene, t_s));
        self.send(2 * ms);
    }

    /// What fails of the processor in a half millisecond since the start, at those of its microseconds.
    fn inject(&mut self, half_ms: u64, at: impl Fn(u32) -> bool) -> Result<(), NotInjected> {
        for injection in &self.injections {
            // Not negative: the time has been checked to be in the run.
            let us = (injection.t_s * 1e6 + self.zero_ms as f64 * 1e3).round() as u64;
            let after_us = (us % HALF_MS_US) as u32;
            if us / HALF_MS_US == half_ms && at(after_us) {
                self.engine.inject(&injection.fault, after_us)?;
            }
        }
        Ok(())
    }

    /// What the host sends at a half millisecond since the start.
    fn send(&mut self, half_ms: u64) {
        if let Some(bytes) = self.host.send(half_ms) {
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
