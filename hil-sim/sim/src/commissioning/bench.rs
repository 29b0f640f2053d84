//! A device on the operator's bench, with its serial line and a reference thermometer.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal};
use thermal_plant::HostParams;

use super::CommissionError;
use crate::World;
use crate::engine::{Engine, LineSplitter};
use crate::host::sending_half;

/// Timeout of an answer, ms.
const ANSWER_TIMEOUT_MS: u64 = 2000;
/// Timeout of a self-test, and the interval at which its end is polled, ms.
const SELF_TEST_MS: u64 = 1000;
const POLL_MS: u64 = 50;
/// Resolution of the reference thermometer, K.
const RESOLUTION_K: f64 = 1e-3;

/// A device with its serial line and the operator's reference thermometer.
pub struct CommissioningBench<'a, E> {
    engine: &'a mut E,
    received: LineSplitter,
    thermometer: HostParams,
    random: Xoshiro256PlusPlus,
}

impl<'a, E: Engine> CommissioningBench<'a, E> {
    /// Puts a device on the bench; `seed` draws the noise of the reference thermometer.
    pub fn new(engine: &'a mut E, thermometer: HostParams, seed: u64) -> Self {
        Self {
            engine,
            received: LineSplitter::default(),
            thermometer,
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
        }
    }

    /// The world around the device.
    pub fn world(&mut self) -> &mut World {
        self.engine.world()
    }

    /// Moves the device to another world.
    pub fn move_to(&mut self, world: World) {
        *self.engine.world() = world;
    }

    /// Reading of the reference thermometer at a true temperature, deg C.
    pub fn reference_c(&mut self, truth: impl Fn(&World) -> f64) -> f64 {
        let normal: f64 = StandardNormal.sample(&mut self.random);
        let shown_c = truth(self.engine.world())
            + self.thermometer.reference_offset_k
            + self.thermometer.reference_noise_k * normal;
        (shown_c / RESOLUTION_K).round() * RESOLUTION_K
    }

    /// Runs the device for some milliseconds.
    ///
    /// # Errors
    /// The engine stopped.
    pub fn wait(&mut self, ms: u64) -> Result<(), CommissionError> {
        for _ in 0..ms {
            self.run_1_ms(None)?;
        }
        Ok(())
    }

    /// Sends a line and waits for its answer.
    ///
    /// # Errors
    /// The engine stopped, or there is no answer.
    pub fn query(&mut self, line: &str) -> Result<String, CommissionError> {
        let bytes = [line.as_bytes(), b"\n"].concat();
        let mut answer = self.run_1_ms(Some(&bytes))?;
        for _ in 0..ANSWER_TIMEOUT_MS {
            if let Some(answer) = answer.into_iter().find(|answer| !answer.starts_with("T ")) {
                return Ok(answer);
            }
            answer = self.run_1_ms(None)?;
        }
        Err(CommissionError::Silent(line.into()))
    }

    /// Sends a line that must be accepted; returns the answer after "ok".
    ///
    /// # Errors
    /// The engine stopped, there is no answer, or the line is refused.
    pub fn command(&mut self, line: &str) -> Result<String, CommissionError> {
        let answer = self.query(line)?;
        match answer.strip_prefix("ok") {
            Some(rest) => Ok(rest.trim().into()),
            None => Err(CommissionError::Refused {
                line: line.into(),
                answer,
            }),
        }
    }

    /// Arms the device, which runs its self-test first if it has not yet.
    ///
    /// # Errors
    /// The engine stopped, or the device is not armed within a second.
    pub fn arm(&mut self) -> Result<(), CommissionError> {
        self.command("arm")?;
        let line = "state";
        for _ in 0..SELF_TEST_MS / POLL_MS {
            let answer = self.command(line)?;
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

    /// The device's settings as lines.
    ///
    /// # Errors
    /// The engine stopped, or the device's answer is not a list of settings.
    pub fn settings(&mut self) -> Result<Vec<String>, CommissionError> {
        let line = "settings";
        let answer = self.command(line)?;
        let lines = answer
            .strip_prefix("lines=")
            .and_then(|lines| lines.parse().ok());
        let lines: usize = lines.ok_or_else(|| CommissionError::Refused {
            line: line.into(),
            answer,
        })?;
        (1..=lines)
            .map(|number| self.command(&format!("{line} {number}")))
            .collect()
    }

    /// Runs one millisecond, in which `bytes` are sent; returns the lines that have arrived.
    ///
    /// # Errors
    /// The engine stopped.
    pub fn run_1_ms(&mut self, bytes: Option<&[u8]>) -> Result<Vec<String>, CommissionError> {
        let stop = |stop: E::Stop| CommissionError::Stop(stop.to_string());
        let legs = self.engine.legs();
        for half in 0..2 {
            if let Some(bytes) = bytes.filter(|bytes| sending_half(bytes) == half) {
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
