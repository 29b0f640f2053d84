//! Commands of the host.

use super::{Event, State, Station, Task};
use crate::TICK_HZ;
use crate::command::{Command, Refused, Reply, Status};
use crate::hold::Hold;
use crate::identification::Identification;
use crate::sense::ThermistorAverages;

impl Station {
    /// Executes a command of the host, in bounded and short time.
    ///
    /// # Errors
    /// The command does not fit the state; nothing has changed.
    pub fn execute(&mut self, command: Command) -> Result<Reply, Refused> {
        match command {
            Command::Status => return Ok(Reply::Status(self.status())),
            Command::Cause => return Ok(Reply::Cause(self.latch.cause().copied())),
            Command::Law(None) => return Ok(Reply::Law(self.controller.law())),
            Command::Average(thermistor) => return self.average(thermistor),
            Command::NormalEquation(row) => return self.normal_equation(row),
            Command::Law(Some(law)) => self.controller.select_law(law),
            Command::Stream { interval_ms } => {
                self.telemetry_ticks = interval_ms * (TICK_HZ / 1000);
            }
            Command::Material { name, pair } => {
                self.object.material = Some((name, pair));
                self.restart_contact();
            }
            Command::Object(temperature) => {
                self.object.temperature = temperature;
                self.restart_contact();
            }
            Command::Mode(mode) => {
                if mode != self.object.mode {
                    self.restart_contact();
                }
                self.object.mode = mode;
            }
            Command::Arm => self.arm()?,
            Command::Hold(setpoint) => {
                self.needs_armed("hold")?;
                self.identified.outcome = None;
                self.state = State::Armed(match self.last.readings.display {
                    Ok(reading) => Task::Hold(Hold::new(setpoint, reading)),
                    Err(_) => Task::Neutral,
                });
            }
            Command::Start => self.start()?,
            // Never refused: the bridge is off afterwards.
            Command::Abort => {
                self.change_state(Event::Abort);
            }
            Command::Clear => self.clear()?,
            Command::Tune => self.tune()?,
            Command::Calibrate(tables) => {
                self.may_calibrate()?;
                // The reading changes with the calibration, which neither the identification nor the detectors may take
                // for a movement of the display.
                self.interrupt_identification();
                self.sensors.recalibrate(&tables);
                self.estimator.plate.note_recalibration();
                self.detectors.forget_motion();
            }
            Command::Retune(parameters) => {
                self.may_change_parameters()?;
                self.set_parameters(&parameters);
                self.interrupt_identification();
                // The result has been used, so the display is neutral again.
                if let State::Armed(task @ Task::Identify(_)) = &mut self.state {
                    *task = Task::Neutral;
                }
            }
        }
        Ok(Reply::Done)
    }

    fn status(&self) -> Status {
        let reference = self.last.reference;
        Status {
            state: self.state.name(),
            material: self.object.material.map(|(name, _)| name),
            object: self.object.temperature,
            mode: self.object.mode,
            setpoint: reference.map(|reference| reference.setpoint.celsius()),
            limited: reference.is_some_and(|reference| reference.limited),
        }
    }

    /// Another object, under whatever finger rests there, begins a new contact.
    fn restart_contact(&mut self) {
        self.reference.restart_contact(&mut self.estimator.finger);
    }

    /// What the finger feels must not change by a new calibration or tile.
    fn may_change_parameters(&self) -> Result<(), Refused> {
        if self.state.presents() {
            Err(Refused::Presenting)
        } else {
            Ok(())
        }
    }

    /// A calibration changes the reading, which the self-test would take for the display's response.
    fn may_calibrate(&self) -> Result<(), Refused> {
        self.may_change_parameters()?;
        if matches!(self.state, State::SelfTest(_)) {
            Err(Refused::Testing)
        } else {
            Ok(())
        }
    }

    fn average(&self, thermistor: usize) -> Result<Reply, Refused> {
        self.may_calibrate()?;
        let average = self.averages.of(thermistor).ok_or(Refused::TooEarly)?;
        Ok(Reply::Average(average))
    }

    fn normal_equation(&self, row: usize) -> Result<Reply, Refused> {
        if let State::Tripped(fault) = self.state {
            return Err(Refused::Tripped(fault));
        }
        match (&self.state, self.identified.outcome) {
            (State::Armed(Task::Identify(_)), None) => Err(Refused::Tuning),
            (_, None) => Err(Refused::NotTuned),
            (_, Some(Err(reason))) => Err(Refused::TuneAborted(reason)),
            (_, Some(Ok(()))) => {
                let row = self.identified.equations.rows().get(row);
                row.map(|row| Reply::NormalEquation(*row))
                    .ok_or(Refused::NotTuned)
            }
        }
    }

    fn arm(&mut self) -> Result<(), Refused> {
        match self.state {
            State::Tripped(fault) => return Err(Refused::Tripped(fault)),
            State::SelfTest(_) => return Ok(()),
            // The display may have changed since the plate was last observed.
            State::Off => self.estimator.plate.invalidate(),
            _ => {}
        }
        self.change_state(Event::Arm);
        self.identified.outcome = None;
        Ok(())
    }

    fn start(&mut self) -> Result<(), Refused> {
        match (&self.state, self.object.material) {
            (State::Tripped(fault), _) => return Err(Refused::Tripped(*fault)),
            (State::Off | State::Ready, _) => return Err(Refused::NotArmed),
            (State::SelfTest(_), _) => return Err(Refused::Testing),
            (_, None) => return Err(Refused::NoMaterial),
            (State::Preset | State::Contact, Some(_)) => return Err(Refused::AlreadyStarted),
            (State::Armed(_), Some(_)) => {}
        }
        self.restart_contact();
        self.averages = ThermistorAverages::default();
        self.change_state(Event::Start);
        Ok(())
    }

    fn clear(&mut self) -> Result<(), Refused> {
        if !self.is_tripped() {
            return Err(Refused::NothingToClear);
        }
        if let Some(fault) = self.latch.present() {
            return Err(Refused::StillFaulty(fault));
        }
        self.change_state(Event::Clear);
        match self.latch.take_pending() {
            None => Ok(()),
            Some(fault) => {
                self.trip_without_readings(fault);
                Err(Refused::StillFaulty(fault))
            }
        }
    }

    fn needs_armed(&self, command: &'static str) -> Result<(), Refused> {
        match self.state {
            State::Tripped(fault) => Err(Refused::Tripped(fault)),
            State::Armed(_) => Ok(()),
            _ => Err(Refused::NeedsArmed(command)),
        }
    }

    fn tune(&mut self) -> Result<(), Refused> {
        self.needs_armed("tune")?;
        if self.contact.touching() {
            return Err(Refused::Touched);
        }
        let sink = self
            .last
            .readings
            .sink
            .map_err(|_| Refused::NeedsArmed("tune"))?;
        self.identified = super::IdentificationResult::default();
        self.state = State::Armed(Task::Identify(Identification::new(sink)));
        Ok(())
    }
}
