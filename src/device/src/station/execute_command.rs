//! Execution of the host's commands by one station.

use super::{ArmedTask, DueWork, Event, State, Station};
use crate::TICK_HZ;
use crate::command::{Command, Refused, Reply, Status};
use crate::identification::Identification;
use crate::safety::{SelfTestReport, SelfTestResult};
use crate::sense::ThermistorAverages;
use crate::stimulus::Stimulus;

impl Station {
    /// Executes a command of the host between two ticks, in bounded and short time; its effect begins in the next tick.
    ///
    /// # Errors
    /// Why the station's state does not permit the command; nothing has changed then. One exception: if the board has
    /// raised a second fault while a first one was latched, `clear` clears the first, trips the station by the second,
    /// and returns the second as [`Refused::StillFaulty`].
    pub fn execute(&mut self, command: &Command<'_>) -> Result<Reply, Refused> {
        match *command {
            Command::Status => return Ok(Reply::Status(self.status())),
            Command::Cause => return Ok(Reply::Cause(self.latch.last_trip_cause().copied())),
            Command::SelfTest => return Ok(Reply::SelfTest(self.self_test_report)),
            Command::Raw => return Ok(Reply::Raw(self.last.samples)),
            Command::Law(None) => return Ok(Reply::Law(self.controller.selected_law())),
            Command::Average(thermistor) => return self.thermistor_average(thermistor),
            Command::NormalEquation(row) => return self.normal_equation_row(row),
            Command::Law(Some(law)) => self.controller.select_law(law),
            Command::ReportEvents(on) => self.events.switch_reports(on),
            Command::TriggerOutput(kinds) => self.events.marked = kinds,
            Command::TriggerPulse(None) => return Ok(Reply::TriggerPulse(self.events.pulse)),
            Command::TriggerPulse(Some(pulse)) => self.events.pulse = pulse,
            Command::Stream { interval_ms, fields } => {
                self.telemetry_fields = fields;
                self.telemetry_ticks = interval_ms * (TICK_HZ / 1000);
            }
            Command::MaterialProperties => {
                let material = self.object.material.as_ref();
                return Ok(Reply::Material(material.map(|material| material.properties)));
            }
            Command::Finger(None) => return Ok(Reply::Finger(self.object.assumed_finger())),
            Command::Finger(Some(finger)) => {
                let before = self.object.assumed_finger();
                if finger != before {
                    // The tissue that was learnt is not that of another finger.
                    if finger.is_layered() != before.is_layered() || self.learning.is_some() {
                        self.estimator.finger.forget_tissue_history();
                    }
                    self.object.choose_finger(finger);
                    self.reference.forget_resistances();
                    self.forget_learnt_finger(finger);
                    if let Some(learning) = &mut self.learning {
                        learning.note_assumed_finger();
                    }
                    self.due.add(DueWork::CONTACT_RESTART);
                }
            }
            Command::Flux => return Ok(Reply::Flux(self.flux_state())),
            Command::FluxZero => {
                self.require_no_object_presented()?;
                return Ok(Reply::FluxZero(self.flux_zero()?));
            }
            Command::FluxSensor(ref sensor) => {
                self.require_no_object_presented()?;
                self.replace_flux_sensor(sensor.as_ref());
            }
            Command::DisplaySurface(ref pair) => {
                self.require_no_object_presented()?;
                self.object.replace_contact_pair(pair);
                self.reference.forget_resistances();
                self.forget_learnt_finger(self.object.assumed_finger());
                self.due.add(DueWork::CONTACT_RESTART);
            }
            Command::ContactLaw(None) => return Ok(Reply::ContactLaw(self.object.contact_law)),
            Command::ContactLaw(Some(ref law)) => {
                // Eq. 6-12, which the thesis's finger has on half-spaces, holds for Eq. 6-8 only.
                if !self.object.assumed_finger().is_layered() {
                    return Err(Refused::NeedsLayeredFinger("contact"));
                }
                self.object.choose_contact_law(law);
                self.reference.forget_resistances();
                self.forget_learnt_finger(self.object.assumed_finger());
                self.due.add(DueWork::CONTACT_RESTART);
            }
            Command::Person => return Ok(Reply::Person(self.person_state()?)),
            Command::LearntPerson => {
                self.require_nominal_contact_law()?;
                return Ok(Reply::Person(self.person_state()?));
            }
            Command::ChoosePerson(person) => {
                if person.is_some() {
                    self.require_nominal_contact_law()?;
                }
                self.choose_person(person)?;
                self.due.add(DueWork::CONTACT_RESTART);
            }
            Command::Material(ref material) => {
                self.object.choose_material(material);
                self.due.add(DueWork::CONTACT_RESTART);
            }
            Command::Body(ref body) => {
                self.object.choose_body(body);
                self.due.add(DueWork::CONTACT_RESTART);
            }
            Command::Object(temperature) => {
                self.object.temperature = temperature;
                self.due.add(DueWork::CONTACT_RESTART);
            }
            Command::Mode(mode) => {
                if mode != self.object.mode {
                    self.due.add(DueWork::CONTACT_RESTART);
                }
                self.object.mode = mode;
            }
            Command::Arm => self.execute_arm_by_self_test_if_off()?,
            Command::Hold { target, rate_k_s } => self.execute_hold(target, rate_k_s)?,
            Command::LoadCourse(part) => self.execute_load_course(part)?,
            Command::Play(ref order) => self.execute_play(order)?,
            Command::AssumeSkin(skin) => {
                self.estimator.finger.assume_skin(skin);
                self.due.add(DueWork::CONTACT_RESTART);
            }
            Command::Start => self.execute_start_presentation()?,
            // Never refused: the bridge is off afterwards.
            Command::Abort => {
                if matches!(self.state, State::SelfTest(_)) {
                    self.self_test_report.result = SelfTestResult::None;
                }
                self.apply_event(Event::Abort);
            }
            Command::Clear => self.execute_clear()?,
            Command::Tune => self.execute_tune_identification()?,
            Command::Calibrate(ref tables) => {
                self.require_no_object_and_no_self_test()?;
                // The reading changes with the calibration, which neither the identification nor the detectors may take
                // for a movement of the display.
                self.interrupt_identification();
                self.sensors.replace_calibration_tables(tables);
                self.estimator.plate.note_recalibration();
                self.detectors.restart_motion_detectors();
            }
            Command::Retune(ref parameters) => {
                self.require_no_object_presented()?;
                self.set_control_parameters(parameters);
                self.interrupt_identification();
                // The result has been used, so the display is neutral again.
                if let State::Armed(task @ ArmedTask::Identify(_)) = &mut self.state {
                    *task = ArmedTask::Neutral;
                }
            }
        }
        Ok(Reply::Done)
    }

    fn status(&self) -> Status {
        let reference = self.last.reference;
        Status {
            state: self.state.state_name(),
            material: self.object.material.map(|material| material.name),
            object: self.object.temperature,
            mode: self.object.mode,
            setpoint: reference.map(|reference| reference.setpoint.celsius()),
            limited: reference.is_some_and(|reference| reference.limited),
            is_tuned: !self.reference_limits.are_of_untuned_tile(),
            body: self.object.body_name,
        }
    }

    /// Returns [`Refused::Presenting`] while an object or a course is presented. For the commands that change parameters or
    /// calibration, because the finger would feel the change, and for the query of a thermistor's average, which the
    /// finger would disturb.
    fn require_no_object_presented(&self) -> Result<(), Refused> {
        if self.state.is_presenting_object() || self.state.is_presenting_course() {
            Err(Refused::Presenting)
        } else {
            Ok(())
        }
    }

    /// Refuses a calibration, or a request for the average that a calibration needs, while an object is presented and
    /// in the self-test. The self-test would mistake the step of the calibrated readings for the display's response to
    /// the test current.
    fn require_no_object_and_no_self_test(&self) -> Result<(), Refused> {
        self.require_no_object_presented()?;
        if matches!(self.state, State::SelfTest(_)) { Err(Refused::Testing) } else { Ok(()) }
    }

    fn thermistor_average(&self, thermistor: usize) -> Result<Reply, Refused> {
        self.require_no_object_and_no_self_test()?;
        let average = self.averages.of(thermistor).ok_or(Refused::TooEarly)?;
        Ok(Reply::Average(average))
    }

    fn normal_equation_row(&self, row: usize) -> Result<Reply, Refused> {
        if let State::Tripped(fault) = self.state {
            return Err(Refused::Tripped(fault));
        }
        match (&self.state, self.identified.outcome) {
            (State::Armed(ArmedTask::Identify(_)), None) => Err(Refused::Tuning),
            (_, None) => Err(Refused::NotTuned),
            (_, Some(Err(reason))) => Err(Refused::TuneAborted(reason)),
            (_, Some(Ok(()))) => {
                let row = self.identified.equations.rows_and_statistics().get(row);
                row.map(|row| Reply::NormalEquation(*row)).ok_or(Refused::NotTuned)
            }
        }
    }

    fn execute_arm_by_self_test_if_off(&mut self) -> Result<(), Refused> {
        match self.state {
            State::Tripped(fault) => return Err(Refused::Tripped(fault)),
            State::SelfTest(_) => return Ok(()),
            // In off the observer runs, but nobody acts on its residual: what no current explains (heat that no sensor
            // measures, thermistors that disagree, the cleared fault) adds up in its disturbance and correction. That
            // must not count against the tile that is armed now, so the model starts from the next reading with both at
            // zero; the self-test gives it 0.7 s before a set-point is followed and the residual can trip.
            State::Off => {
                self.estimator.plate.invalidate();
                self.self_test_report =
                    SelfTestReport { result: SelfTestResult::Running, ..SelfTestReport::default() };
            }
            _ => {}
        }
        self.apply_event(Event::Arm);
        self.identified.outcome = None;
        Ok(())
    }

    fn execute_start_presentation(&mut self) -> Result<(), Refused> {
        match (&self.state, self.object.material) {
            (State::Tripped(fault), _) => return Err(Refused::Tripped(*fault)),
            (State::Off | State::Ready, _) => return Err(Refused::NotArmed),
            (State::SelfTest(_), _) => return Err(Refused::Testing),
            (_, None) => return Err(Refused::NoMaterial),
            (State::Preset | State::Contact, Some(_)) => return Err(Refused::AlreadyStarted),
            (State::Armed(_) | State::Stimulus(_), Some(_)) => {}
        }
        self.due.add(DueWork::CONTACT_RESTART);
        self.averages = ThermistorAverages::default();
        self.apply_event(Event::Start);
        Ok(())
    }

    fn execute_clear(&mut self) -> Result<(), Refused> {
        if !self.is_tripped() {
            return Err(Refused::NothingToClear);
        }
        if let Some(fault) = self.latch.present_fault() {
            return Err(Refused::StillFaulty(fault));
        }
        self.apply_event(Event::Clear);
        match self.latch.take_deferred_board_fault() {
            None => Ok(()),
            Some(fault) => {
                self.trip_without_readings(fault);
                Err(Refused::StillFaulty(fault))
            }
        }
    }

    fn execute_tune_identification(&mut self) -> Result<(), Refused> {
        match self.state {
            State::Tripped(fault) => return Err(Refused::Tripped(fault)),
            State::Armed(_) | State::Stimulus(Stimulus::Hold(_)) => {}
            _ => return Err(Refused::TuneNeedsArmed),
        }
        if self.contact.touching() {
            return Err(Refused::Touched("tune"));
        }
        let sink = self.last.readings.sink.map_err(|_| Refused::TuneNeedsArmed)?;
        self.identified.outcome = None;
        self.state =
            State::Armed(ArmedTask::Identify(Identification::begin_at_sink_temperature(sink)));
        Ok(())
    }
}
