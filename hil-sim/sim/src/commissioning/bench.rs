//! A device on the operator's bench: time goes on, lines go back and forth, and there is a reference thermometer.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal};
use thermal_plant::HostParams;

use super::CommissionError;
use crate::World;
use crate::engine::{Engine, LineSplitter};
use crate::host::leaves_at_half;

/// Longest wait for an answer, ms.
const PATIENCE_MS: u64 = 500;
/// Longest wait for a self-test, and how often its end is looked for, ms.
const SELF_TEST_MS: u64 = 1000;
const POLL_MS: u64 = 50;
/// Resolution of the reference thermometer, K.
const RESOLUTION_K: f64 = 1e-3;

/// A device, and what the operator needs.
pub struct CommissioningBench<'a, E> {
    engine: &'a mut E,
    received: LineSplitter,
    thermometer: HostParams,
    random: Xoshiro256PlusPlus,
}

impl<'a, E: Engine> CommissioningBench<'a, E> {
    /// With a reference thermometer, and the seed of its noise.
    pub fn new(engine: &'a mut E, thermometer: HostParams, seed: u64) -> Self {
        Self {
            engine,
            received: LineSplitter::default(),
            thermometer,
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
        }
    }

    /// Where the device is.
    pub fn world(&mut self) -> &mut World {
        self.engine.world()
    }

    /// Puts the device into another place.
    pub fn move_to(&mut self, world: World) {
        *self.engine.world() = world;
    }

    /// What the reference thermometer shows of a temperature, deg C.
    pub fn reference_c(&mut self, truth: impl Fn(&World) -> f64) -> f64 {
        let normal: f64 = StandardNormal.sample(&mut self.random);
        let shown_c = truth(self.engine.world())
            + self.thermometer.reference_offset_k
            + self.thermometer.reference_noise_k * normal;
        (shown_c / RESOLUTION_K).round() * RESOLUTION_K
    }

    /// Lets milliseconds pass.
    ///
    /// # Errors
    /// The engine stopped.
    pub fn wait(&mut self, ms: u64) -> Result<(), CommissionError> {
        for _ in 0..ms {
            self.millisecond(None)?;
        }
        Ok(())
    }

    /// Sends a line and waits for its answer.
    ///
    /// # Errors
    /// The engine stopped, or there is no answer.
    pub fn ask(&mut self, line: &str) -> Result<String, CommissionError> {
        let bytes = [line.as_bytes(), b"\n"].concat();
        let mut answer = self.millisecond(Some(&bytes))?;
        for _ in 0..PATIENCE_MS {
            if let Some(answer) = answer.into_iter().find(|answer| !answer.starts_with("T ")) {
                return Ok(answer);
            }
            answer = self.millisecond(None)?;
        }
        Err(CommissionError::Silent(line.into()))
    }

    /// Sends a line that must be obeyed; gives what follows "ok".
    ///
    /// # Errors
    /// The engine stopped, there is no answer, or the line is refused.
    pub fn tell(&mut self, line: &str) -> Result<String, CommissionError> {
        let answer = self.ask(line)?;
        match answer.strip_prefix("ok") {
            Some(rest) => Ok(rest.trim().into()),
            None => Err(CommissionError::Refused {
                line: line.into(),
                answer,
            }),
        }
    }

    /// Arms the device, which tests itself first if it has not yet.
    ///
    /// # Errors
    /// The engine stopped, or the device is not armed within a second.
    pub fn arm(&mut self) -> Result<(), CommissionError> {
        self.tell("arm")?;
        let line = "state";
        for _ in 0..SELF_TEST_MS / POLL_MS {
            let answer = self.tell(line)?;
            if answer.starts_with("state=armed ") {
                return Ok(());
            }
            if !answer.starts_with("state=self-test ") {
                let line = line.into();
                return Err(CommissionError::Refused { line, answer });
            }
            self.wait(POLL_MS)?;
        }
        Err(CommissionError::Silent("arm".into()))
    }

    /// The device's settings, line by line.
    ///
    /// # Errors
    /// The engine stopped, or the device does not answer as it should.
    pub fn settings(&mut self) -> Result<Vec<String>, CommissionError> {
        let line = "settings";
        let answer = self.tell(line)?;
        let lines = answer
            .strip_prefix("lines=")
            .and_then(|lines| lines.parse().ok());
        let lines: usize = lines.ok_or_else(|| CommissionError::Refused {
            line: line.into(),
            answer,
        })?;
        (1..=lines)
            .map(|number| self.tell(&format!("{line} {number}")))
            .collect()
    }

    /// One millisecond, in which bytes may leave; lines that have arrived.
    ///
    /// # Errors
    /// The engine stopped.
    pub fn millisecond(&mut self, bytes: Option<&[u8]>) -> Result<Vec<String>, CommissionError> {
        let stop = |stop: E::Stop| CommissionError::Stop(stop.to_string());
        let legs = self.engine.legs();
        for half in 0..2 {
            if let Some(bytes) = bytes.filter(|bytes| leaves_at_half(bytes) == half) {
                self.engine.send(bytes);
            }
            if half == 0 {
                self.engine.world().step(legs);
            }
            self.engine.run_half_ms().map_err(stop)?;
        }
        self.engine.receive(self.received.received());
        Ok(self.received.complete())
    }
}
