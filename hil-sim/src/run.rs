//! A scene on an engine, from switch-on to the last row.

use std::time::Instant;

use crate::commission::{self, CommissionError};
use crate::engine::{Cost, Engine, Lines};
use crate::host::Host;
use crate::scene::{Broken, Scene};
use crate::telemetry::Telemetry;
use crate::trace::{Row, Trace};

/// Time after the last row in which its telemetry arrives, ms.
const DRAIN_MS: u64 = 5;

/// What a run has given.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// One row a millisecond.
    pub trace: Trace,
    /// Every line of the device that is not telemetry, with the time at which it was complete, s.
    pub answers: Vec<(f64, String)>,
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
    mut progress: impl FnMut(f64),
) -> Result<Outcome, RunError<E::Stop>> {
    let settings = commission::of_scene(scene).map_err(RunError::Commission)?;
    let began = Instant::now();
    let zero_ms = scene.settle_ms();
    let end_ms = zero_ms + (scene.duration_s * 1e3).round() as u64;
    let mut session = Session {
        scene,
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
        if (zero_ms..=end_ms).contains(&ms) {
            let t_s = session.t_s(ms);
            let world = session.engine.world();
            let camera = world.look(ms - zero_ms);
            let row = Row::now(t_s, world.plant(), camera);
            after_j = world.plant().energy().electrical_j;
            trace.push(ms, row);
        }
        session.step_plant();
        session.engine.run_half_ms().map_err(RunError::Stop)?;
        session.send(2 * ms + 1);
        session.engine.run_half_ms().map_err(RunError::Stop)?;
        for line in session.lines() {
            match Telemetry::parse(&line) {
                Some(telemetry) => trace.join(telemetry),
                // Before time zero only set-up is sent.
                None if ms < zero_ms && line.starts_with("err") => return Err(RunError::Refused(line)),
                None => answers.push((session.t_s(ms + 1), line)),
            }
        }
        progress(ms as f64 / (end_ms + DRAIN_MS) as f64);
    }
    let simulated_s = (end_ms + DRAIN_MS) as f64 * 1e-3;
    let real_time_factor = simulated_s / began.elapsed().as_secs_f64();
    Ok(Outcome {
        trace,
        answers,
        electrical_j: after_j - before_j,
        cost: session.engine.cost(),
        real_time_factor,
    })
}

/// What is broken at a time.
pub(crate) fn broken(scene: &Scene, t_s: f64) -> impl Iterator<Item = Broken> {
    scene.faults.iter().filter_map(move |fault| fault.at(t_s))
}

struct Session<'a, E> {
    scene: &'a Scene,
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
