//! The control of one finger, without its hardware: samples in, bridge command out, once per tick of 1 ms.
//!
//! ```text
//! samples -> sense -> detect -> estimate -> reference -> control -> actuate -> outputs
//!                                                                      |
//!                                                                   report -> telemetry
//! ```
//!
//! Each stage takes values and returns a value. A name that begins with `previous_` stands for a value of the tick
//! before.
//!
//! The `inline` attributes here and in `estimate` were found by measurement with the recorded compiler: without them a
//! tick costs 3 % more instructions (`cargo hil-sim run scenes/copper.toml --json`, `instructions_per_tick`).

mod chosen_object;
mod execute_command;
mod follow_stimulus;
mod learn;
mod state;

use contact_model::fixed_point::{Celsius, to_fixed};
use fixed::types::U16F16;
use thermal_learner::PlaceBeforeContact;
use thermal_settings::Settings;

pub use state::{ArmedTask, Event, State};

use crate::control::{ControlParameters, Controller, Law, VoltageFeedforward};
use crate::drive::{BoardOutputs, ComparatorTest, Current, Drive, SafeCurrent};
use crate::estimate::{
    Estimator, FingerEstimator, LegTemperatures, PlateEstimateBeforeReading, PlateObserver,
};
use crate::events::{DeviceEvent, EventReporter};
use crate::identification::{AbortReason, NormalEquationAccumulator};
use crate::learning::{FingerLearning, FluxParameters};
use crate::reference::{Reference, ReferenceGenerator, ReferenceLimits};
use crate::safety::{
    self, Fault, FaultDetectors, FaultLatch, PreviousDemandAndResidual, SelfTestReport,
    SelfTestResult, SelfTestStep, ThermalDose, TripCause, ValidReadings,
};
use crate::sense::{
    CalibrationTables, ContactDetector, Readings, SampleConverter, Samples, ThermistorAverages,
};
use crate::stimulus::CourseMemory;
use crate::{StateName, Telemetry, TelemetryFields};
use chosen_object::ChosenObject;

/// The control of one finger without its hardware. Takes the samples of each tick of 1 ms and returns what the bridge
/// must do, and executes the host's commands between ticks. Independent of the stations of other fingers.
#[derive(Clone, Debug)]
// In this order, because a load reaches 4 KB from the start of the struct: the courses come last. A tick takes 40 instructions less.
#[repr(C)]
pub struct Station {
    /// What the next tick does first.
    due: DueWork,
    /// Whether the last reference is one of the present state stimulus, if that is the state.
    stimulus_has_reference: bool,
    /// Number of the last tick: ticks of 1 ms since the start of the program; wraps after 49 days.
    tick: u32,
    /// Ticks of 1 ms from one line of telemetry to the next; 0 while telemetry is off.
    telemetry_ticks: u32,
    telemetry_fields: TelemetryFields,
    latch: FaultLatch,
    contact: ContactDetector,
    last: LastTickValues,
    controller: Controller,
    voltage: VoltageFeedforward,
    state: State,
    reference: ReferenceGenerator,
    reference_limits: ReferenceLimits,
    estimator: Estimator,
    averages: ThermistorAverages,
    detectors: FaultDetectors,
    sensors: SampleConverter,
    events: EventReporter,
    object: ChosenObject,
    /// Learning of the finger that touches; `None` without a sensor of the heat flux.
    learning: Option<FingerLearning>,
    identified: IdentificationResult,
    /// What the last self-test has measured.
    self_test_report: SelfTestReport,
    courses: CourseMemory,
}

/// Work that a tick does first, because it must not change between two ticks or takes too long for a command: a new contact takes
/// 7 us, for which a command would lock out the next finger's tick (`cargo test -p image-tests five_finger_locks`). One byte, so that
/// a tick without such work asks once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct DueWork(u8);

impl DueWork {
    /// A new contact for a finger that already touches, because the host has chosen another object, finger or contact model, or
    /// `start` has presented the object.
    const CONTACT_RESTART: u8 = 1;
    /// The last tick was the last of the learner's window.
    const FLUX_WINDOW: u8 = 2;
    /// Back to the assumed finger, because what was learnt of the one that touches is void.
    const ASSUMED_FINGER: u8 = 4;

    const fn add(&mut self, work: u8) {
        self.0 |= work;
    }

    const fn contains(self, work: u8) -> bool {
        self.0 & work != 0
    }
}

/// Normal equations and outcome of the last identification of the tile. The host can request them, unless the station
/// is tripped, also after the station has left that task, until the host sends `arm`, `hold` or `tune`.
#[derive(Clone, Debug, Default)]
struct IdentificationResult {
    equations: NormalEquationAccumulator,
    /// `Ok` once the normal equations are complete, or why the identification has ended early. `None` while an
    /// identification runs, and if none was started since the last `arm` or `hold`.
    outcome: Option<Result<(), AbortReason>>,
}

/// Samples, readings, reference (set-point and target; `None` if none was followed) and demanded current, A, of the last
/// tick. Telemetry reports readings, set-point and current, the command `raw` the samples, status reports the set-point, `hold` and `tune` start from the
/// readings, and the fault detectors check the readings of the next tick against set-point and current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct LastTickValues {
    samples: Samples,
    readings: Readings,
    reference: Option<Reference>,
    demanded: Current,
}

/// What one control tick demands of the bridge: off, or a current that is not yet clamped to -6 to 6 A and not yet
/// converted to a voltage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BridgeDemand {
    /// Both half-bridges are high-impedance, and the comparator is tested in this way, which only the self-test demands.
    Off(ComparatorTest),
    /// Drive `current`, A; positive cools. The bridge voltage for it is computed from `previous_legs`, the temperatures
    /// of the module's legs by the plate's model before this tick's reading has corrected the model.
    Drive { current: Current, previous_legs: LegTemperatures },
}

impl BridgeDemand {
    const OFF_WITHOUT_COMPARATOR_TEST: Self = Self::Off(ComparatorTest::None);
}

impl Station {
    /// A station with these settings in the state off, before its first tick, with no material chosen. Converts the
    /// settings from `f64`, which takes about a millisecond, so it is for the start only.
    pub fn new(settings: &Settings) -> Self {
        let parameters = ControlParameters::new(settings);
        let limit = to_fixed(settings.module.current_limit_a);
        let flux_sensor = settings.flux_sensor.as_ref().map(FluxParameters::new);
        let flux_sensor = flux_sensor.as_ref();
        // Built at once, because the start has no stack for a second station.
        Self {
            sensors: SampleConverter::new(settings),
            averages: ThermistorAverages::default(),
            contact: ContactDetector::default(),
            detectors: FaultDetectors::default(),
            latch: FaultLatch::default(),
            estimator: Estimator {
                plate: PlateObserver::new(&parameters.observer, limit),
                finger: FingerEstimator::default(),
            },
            object: ChosenObject::new(
                settings.display.surface(),
                flux_sensor.map_or(U16F16::ZERO, |sensor| sensor.display_layer),
            ),
            learning: flux_sensor
                .map(|sensor| FingerLearning::new(sensor, PlaceBeforeContact::Air)),
            reference: ReferenceGenerator::default(),
            reference_limits: parameters.reference_limits,
            due: DueWork::default(),
            controller: Controller::new(&parameters, limit),
            voltage: VoltageFeedforward::new(&settings.module),
            state: State::Off,
            self_test_report: SelfTestReport::default(),
            identified: IdentificationResult::default(),
            courses: CourseMemory::default(),
            stimulus_has_reference: false,
            tick: 0,
            telemetry_ticks: 0,
            telemetry_fields: TelemetryFields::NONE,
            events: EventReporter::default(),
            last: LastTickValues {
                samples: Samples::default(),
                readings: Readings::ALL_OPEN,
                reference: None,
                demanded: Current::ZERO,
            },
        }
    }

    /// A station as [`Station::new`] makes it, tripped by `cause` if there is one.
    pub fn new_optionally_tripped(cause: Option<TripCause>, settings: &Settings) -> Self {
        let mut station = Self::new(settings);
        if let Some(cause) = cause {
            station.trip(cause);
        }
        station
    }

    /// Replaces the thermistor calibration, the gains, the tile's model, heat-flux sensor and display by those of `settings`,
    /// converted from `f64`; everything else stays as [`Station::new`] has made it. Called at the start, with the finger's stored
    /// settings.
    pub(crate) fn apply_settings(&mut self, settings: &Settings) {
        self.sensors.replace_calibration_tables(&CalibrationTables::new(settings));
        self.set_control_parameters(&ControlParameters::new(settings));
        self.object.set_display_surface(settings.display.surface());
        let flux_sensor = settings.flux_sensor.as_ref().map(FluxParameters::new);
        self.replace_flux_sensor(flux_sensor.as_ref());
    }

    fn set_control_parameters(&mut self, parameters: &ControlParameters) {
        self.controller.set_pi_gains(parameters);
        self.reference_limits = parameters.reference_limits;
        self.estimator.plate.set_parameters(&parameters.observer);
    }

    /// Whether [`Samples::scattering_thermistors`] is needed in the next tick.
    pub const fn needs_scatter(&self) -> bool {
        self.detectors.needs_scatter()
    }

    /// Runs one control tick; to be called every millisecond, with the sums of the 16 scans since the last tick.
    /// Returns what the board must set at bridge and comparator until the next tick. In a tick that detects a fault the
    /// bridge is off.
    #[inline(never)]
    pub fn step(&mut self, samples: &Samples) -> BoardOutputs {
        self.tick = self.tick.wrapping_add(1);
        if self.due != DueWork::default() {
            self.do_due_work();
        }
        self.convert_samples_and_add_calibration_means(samples);
        let valid = self.valid_readings_or_fault(samples);
        let (demand, reference) = match valid {
            Ok(valid) => {
                let estimate = self.detect_touch_and_update_estimates(samples, &valid);
                let mut reference = self.reference_for_present_state(&estimate);
                if self.reference_limits.apply_to(self.controller.law()) {
                    self.limit_reference(&mut reference, valid.display);
                }
                let demand =
                    self.choose_bridge_demand(&valid, samples, &estimate, reference.as_ref());
                (demand, reference)
            }
            Err(fault) => {
                self.invalidate_estimates();
                (Err(fault), None)
            }
        };
        let demand = self.trip_on_fault(demand);
        let (outputs, demanded) = self.apply_demand(demand);
        // Field by field, which saves 150 cycles of copying the whole.
        self.last.samples = *samples;
        self.last.reference = reference;
        self.last.demanded = demanded;
        outputs
    }

    /// Ends the learner's window. Begins a new contact for a finger that already touches, with the object, finger and contact
    /// model of the host's last command.
    #[cold]
    #[inline(never)]
    fn do_due_work(&mut self) {
        let due = core::mem::take(&mut self.due);
        if due.contains(DueWork::ASSUMED_FINGER) {
            self.restore_assumed_finger();
        }
        if due.contains(DueWork::FLUX_WINDOW) {
            self.end_flux_window();
        }
        if due.contains(DueWork::CONTACT_RESTART) {
            let bodies = self.object.bodies();
            (self.reference).restart_contact(&mut self.estimator.finger, bodies);
        }
    }

    /// Converts the tick's samples to °C, N and A, as the last readings. Unless an object is presented, also adds the thermistors' samples to
    /// the half-second means from which calibrations are computed.
    #[inline(never)]
    fn convert_samples_and_add_calibration_means(&mut self, samples: &Samples) {
        // Calibrations are refused while an object is presented.
        if !self.state.is_presenting_object() {
            self.averages.add_tick(&samples.thermistor_sums());
        }
        self.last.readings = self.sensors.convert_samples(samples);
    }

    /// Checks the tick by all fault detectors, and returns its readings as valid if none has found a fault.
    ///
    /// # Errors
    /// The first fault in this order: sensor faults and limits that a single tick shows, bridge fault line, detectors
    /// that count over several ticks, thermal dose, frozen samples.
    #[inline(never)]
    fn valid_readings_or_fault(&mut self, samples: &Samples) -> Result<ValidReadings, Fault> {
        let readings = &self.last.readings;
        // What the tick before demanded of the bridge; this tick's readings respond to it.
        let previous = PreviousDemandAndResidual {
            demanded: self.last.demanded,
            setpoint: self.last.reference.map(|reference| reference.setpoint),
            residual_is_large: self.estimator.plate.residual_is_large(),
            supply_should_be_on: !self.comparator_may_keep_the_supply_off(),
        };
        let frozen =
            self.detectors.check_frozen_samples(samples, self.last.demanded != Current::ZERO);
        let dose = self.detectors.update_and_check_dose(readings);
        let valid = safety::validate_readings(readings, self.controller.current_limit());
        let over_ticks = match &valid {
            Ok(valid) => {
                let streams = self.telemetry_ticks != 0;
                self.detectors.run_detectors_of_valid_readings(valid, &previous, streams)
            }
            Err(_) => {
                self.detectors.note_invalid_readings();
                Ok(())
            }
        };
        let valid = valid?;
        self.bridge_line_fault_unless_expected(&self.last.readings)?;
        over_ticks?;
        dose?;
        frozen?;
        Ok(valid)
    }

    /// Whether a comparator that works may have cut the bridge's supply, and then pulls the bridge's fault line: in off
    /// and tripped, because a comparator that has cut the supply, or the power-on, keeps it off until the next self-test;
    /// and until the self-test has tested the comparator.
    fn comparator_may_keep_the_supply_off(&self) -> bool {
        match &self.state {
            State::Off | State::Tripped(_) => true,
            State::SelfTest(test) => test.is_testing_comparator(),
            _ => false,
        }
    }

    /// Checks the bridge's fault line, which the bridge driver or the comparator pulls.
    ///
    /// # Errors
    /// [`Fault::Bridge`]: the line is pulled although the comparator should not have cut the supply.
    fn bridge_line_fault_unless_expected(&self, readings: &Readings) -> Result<(), Fault> {
        if readings.bridge_fault && !self.comparator_may_keep_the_supply_off() {
            Err(Fault::Bridge)
        } else {
            Ok(())
        }
    }

    /// Detects whether a finger touches, and changes from preset to contact or back accordingly; tracks the force
    /// sensor's zero while no finger touches; corrects the estimates of plate and finger by this tick's readings.
    /// Returns the plate's temperatures as they were estimated before this correction.
    fn detect_touch_and_update_estimates(
        &mut self,
        samples: &Samples,
        valid: &ValidReadings,
    ) -> PlateEstimateBeforeReading {
        let previously_touching = self.contact.touching();
        let is_below_zero = self.sensors.is_force_below_zero();
        let zero_has_moved = self.contact.update_contact(self.tick, valid.force, is_below_zero);
        self.sensors.track_force_zero_unless_touching(
            samples,
            valid.force,
            &self.contact,
            zero_has_moved,
        );
        let touching = self.contact.touching();
        // The table is asked only in the states in which a touch changes something, which saves 30 instructions a tick.
        match (&self.state, touching) {
            (State::Preset, true) => {
                self.apply_known_event(Event::Land);
            }
            (State::Contact, false) => {
                self.apply_known_event(Event::Lift);
            }
            _ => {}
        }
        let landed_ticks =
            if previously_touching { 0 } else { self.contact.detection_delay_ticks() };
        if touching != previously_touching {
            self.note_touch_change(touching, landed_ticks);
        }
        let force = touching.then_some(valid.force);
        let pair = self.object.contact_pair();
        let bodies = self.object.bodies();
        self.estimator.update_estimates(valid, force, landed_ticks, pair, bodies)
    }

    /// Limits the reference, if the control law chooses the current.
    #[cold]
    #[inline(never)]
    fn limit_reference(&self, reference: &mut Option<Reference>, reading: Celsius) {
        // An identification chooses its own current.
        if let Some(wanted) = reference
            && !matches!(self.state, State::Armed(ArmedTask::Identify(_)))
        {
            let (law, last) = (self.controller.law(), self.last.reference);
            *wanted = self.reference_limits.limit(law, *wanted, last, reading);
        }
    }

    /// Set-point and target temperature that the display must follow in this tick. `None` in off, ready and tripped,
    /// where the bridge is off, and in the self-test, which chooses its own current.
    fn reference_for_present_state(
        &mut self,
        estimate: &PlateEstimateBeforeReading,
    ) -> Option<Reference> {
        let finger = &mut self.estimator.finger;
        let setpoint = match &mut self.state {
            State::Off | State::SelfTest(_) | State::Ready | State::Tripped(_) => return None,
            State::Armed(ArmedTask::Neutral) => finger.temperatures_before_contact()?.skin,
            State::Armed(ArmedTask::Identify(tile)) => tile.operating_point().celsius(),
            State::Stimulus(_) => return self.reference_of_stimulus(estimate),
            State::Preset | State::Contact => {
                let scene = self.object.presented_object_if_chosen()?;
                let surface = estimate.previous_surface;
                let follow_skin = self.controller.law() == Law::Model;
                return self.reference.next_reference(&scene, finger, surface, follow_skin);
            }
        };
        Some(Reference::at(setpoint))
    }

    /// Chooses what the bridge must do in this tick. In the self-test: what the self-test demands, and off in the tick
    /// in which the self-test passes. Else off if `reference` is `None`, as in off, ready and tripped. Else the current
    /// of an identification of the tile or, if none demands a current, that of the control law.
    ///
    /// # Errors
    /// The fault that the self-test has found in this tick.
    #[inline(always)]
    fn choose_bridge_demand(
        &mut self,
        valid: &ValidReadings,
        samples: &Samples,
        estimate: &PlateEstimateBeforeReading,
        reference: Option<&Reference>,
    ) -> Result<BridgeDemand, Fault> {
        let drive =
            |current| BridgeDemand::Drive { current, previous_legs: estimate.previous_legs };
        if let State::SelfTest(test) = &mut self.state {
            let touched = self.contact.presses_steadily();
            let report = &mut self.self_test_report;
            return Ok(match test.step(report, self.tick, valid, samples, touched)? {
                SelfTestStep::Off(comparator_test) => BridgeDemand::Off(comparator_test),
                SelfTestStep::Drive(current) => {
                    self.controller.track_current(current);
                    drive(current)
                }
                SelfTestStep::Passed => {
                    report.result = SelfTestResult::Passed;
                    let above_room = valid.display.saturating_sub(valid.room);
                    let learning = self.learning.as_ref();
                    report.flux_sensor = learning.map(|learning| learning.test_sensor(above_room));
                    self.apply_event(Event::Pass);
                    BridgeDemand::OFF_WITHOUT_COMPARATOR_TEST
                }
            });
        }
        let Some(reference) = reference else {
            return Ok(BridgeDemand::OFF_WITHOUT_COMPARATOR_TEST);
        };
        let current = match self.step_identification(valid) {
            Some(current) => {
                self.controller.track_current(current);
                current
            }
            None => {
                let plate = &self.estimator.plate;
                (self.controller).choose_current(reference, valid.display, valid.sink, plate)
            }
        };
        Ok(drive(current))
    }

    /// Runs one tick of an identification of the tile, and returns the current that it demands, A (positive cools); a
    /// complete identification demands the current that holds its operating point. `None` in every other state or task,
    /// and in the tick of an early end (except for [`AbortReason::NotSettled`]): then the control law chooses the
    /// current. An early end changes the armed task to neutral.
    fn step_identification(&mut self, valid: &ValidReadings) -> Option<Current> {
        let State::Armed(ArmedTask::Identify(tile)) = &mut self.state else {
            return None;
        };
        let touching = self.contact.touching();
        let current = tile.step(&mut self.identified.equations, valid, touching);
        self.identified.outcome = tile.outcome();
        if let Some(Err(_)) = self.identified.outcome {
            self.state = State::Armed(ArmedTask::Neutral);
        }
        current
    }

    /// Returns the tick's demand. If the tick has found a fault instead, returns the demand for a bridge that is off
    /// and, unless the station is already tripped, trips it, with the tick's readings in the trip's cause. In both
    /// cases the fault latch stores which fault is present now, if any, because `clear` is refused while a fault is
    /// present.
    fn trip_on_fault(&mut self, demand: Result<BridgeDemand, Fault>) -> BridgeDemand {
        self.latch.set_present_to_detected_else_external(demand.err());
        demand.unwrap_or_else(|fault| {
            let previously_demanded = self.last.demanded;
            self.trip(TripCause::new(fault, self.tick, &self.last.readings, previously_demanded));
            BridgeDemand::OFF_WITHOUT_COMPARATOR_TEST
        })
    }

    /// Converts the demand to the board's outputs, and advances the plate's model by one tick under the demanded
    /// current. Returns the outputs, and the demanded current, A, clamped to -6 to 6 A; zero if the bridge is off. A
    /// bridge that is off also interrupts an identification of the tile, and makes the laws `pi` and `pi-10hz` start
    /// from zero current; the law `model` continues from the plate's observer.
    #[inline(always)]
    fn apply_demand(&mut self, demand: BridgeDemand) -> (BoardOutputs, Current) {
        match demand {
            BridgeDemand::Drive { current, previous_legs } => {
                self.estimator.plate.advance_model(current);
                let current = SafeCurrent::saturating(current);
                let outputs = BoardOutputs {
                    drive: Drive::On(self.voltage.duty_for_current(current, &previous_legs)),
                    comparator_test: ComparatorTest::None,
                    trigger_output: self.events.next_trigger_output(),
                };
                (outputs, current.ampere())
            }
            BridgeDemand::Off(comparator_test) => {
                self.interrupt_identification();
                self.controller.track_current(Current::ZERO);
                self.estimator.plate.advance_model(Current::ZERO);
                let outputs = BoardOutputs {
                    drive: Drive::Off,
                    comparator_test,
                    trigger_output: self.events.next_trigger_output(),
                };
                (outputs, Current::ZERO)
            }
        }
    }

    /// Discards the estimates of plate, skin and contact, so that they start again from the next valid readings. Called
    /// in a tick whose readings are invalid or in which a detector has found a fault.
    fn invalidate_estimates(&mut self) {
        self.estimator.invalidate();
        self.reference.discard_contact_and_skin_simulation();
    }

    /// Ends an identification of the tile that is still running, with the outcome [`AbortReason::Interrupted`], and
    /// changes the armed task to neutral. A complete identification keeps its normal equations and its task.
    fn interrupt_identification(&mut self) {
        if let State::Armed(task @ ArmedTask::Identify(_)) = &mut self.state
            && self.identified.outcome.is_none()
        {
            self.identified.outcome = Some(Err(AbortReason::Interrupted));
            *task = ArmedTask::Neutral;
        }
    }

    /// Moves the station to the state that [`State::state_after`] gives for `event`, and ends an identification of the
    /// tile that is still running. Returns false, and does nothing, if the event has no effect in the present state.
    #[inline(never)]
    fn apply_event(&mut self, event: Event<'_>) -> bool {
        self.apply_known_event(event)
    }

    /// [`Self::apply_event`] for an event that the compiler knows: it then moves only the contents that the new state has, which
    /// saves 200 cycles in the tick of a landing.
    #[inline(always)]
    fn apply_known_event(&mut self, event: Event<'_>) -> bool {
        let Some(state) = self.state.state_after(event) else {
            return false;
        };
        self.interrupt_identification();
        self.state = state;
        true
    }

    /// Trips the station by a fault that no reading shows and that the board has found outside of the control tick,
    /// such as an overrun stack. If a different fault has already tripped the station, that fault stays latched; this
    /// one is stored, unless one is stored already, and trips the station when `clear` has cleared the latched one.
    pub fn trip_or_store_external_fault(&mut self, fault: Fault) {
        self.latch.raise_external_fault(fault, self.state.latched_fault());
        self.trip_without_readings(fault);
    }

    fn trip_without_readings(&mut self, fault: Fault) {
        self.trip(TripCause { tick: self.tick, ..TripCause::without_readings(fault) });
    }

    /// Trips the station with this cause. The bridge is off from the tick on that has detected the fault or, if the
    /// fault was found between two ticks, from the next tick on. Has no effect on a station that is tripped already, so
    /// that the first cause stays.
    pub fn trip(&mut self, cause: TripCause) {
        let was_testing = matches!(self.state, State::SelfTest(_));
        if self.apply_event(Event::Trip(cause.fault)) {
            if was_testing {
                self.self_test_report.result = SelfTestResult::Failed(cause.fault);
            }
            self.latch.store_trip_cause_and_tick(cause, self.tick);
        }
    }

    /// The station's present state, without its internal data; with the fault if the station is tripped.
    pub const fn state(&self) -> StateName {
        self.state.state_name()
    }

    /// Whether the station is tripped, so that its bridge stays off until the host sends `clear`.
    pub const fn is_tripped(&self) -> bool {
        self.state.latched_fault().is_some()
    }

    /// The station's fault latch, which stores the cause and the tick of the last trip. The device compares the latches
    /// of all fingers to find the cause of the earliest trip.
    pub const fn fault_latch(&self) -> &FaultLatch {
        &self.latch
    }

    /// Thermal dose (CEM43, equivalent time at 43 °C) that skin would have received if it had always touched this
    /// finger's display. The board stores the dose after every tick, so that a reset does not erase it. At half a
    /// minute the station trips by [`Fault::Dose`].
    pub const fn thermal_dose(&self) -> &ThermalDose {
        self.detectors.dose()
    }

    /// Sets the thermal dose to that which the board stored before the last reset. To be called once, at the start.
    pub const fn restore_thermal_dose(&mut self, dose: ThermalDose) {
        self.detectors.restore_dose(dose);
    }

    /// Restarts the 2 s of silence of the host after which the station trips if telemetry is on and the display follows
    /// a set-point. To be called for each line from the host.
    pub const fn note_host_activity(&mut self) {
        self.detectors.note_host_activity();
    }

    /// Telemetry of the last tick. `None` if the host has not switched telemetry on, or if the tick's number is not a
    /// multiple of the interval that the host has chosen.
    pub fn telemetry_if_due(&self) -> Option<Telemetry> {
        if self.telemetry_ticks == 0 || !self.tick.is_multiple_of(self.telemetry_ticks) {
            return None;
        }
        let LastTickValues { samples: _, readings, reference, demanded } = &self.last;
        Some(Telemetry {
            tick: self.tick,
            state: self.state.state_name(),
            setpoint: reference.map(|reference| reference.setpoint.celsius()),
            limited: reference.is_some_and(|reference| reference.limited),
            is_tuned: !self.reference_limits.are_of_untuned_tile(),
            display: readings.display.ok(),
            check: readings.display_check.ok(),
            sink: readings.sink.ok(),
            skin: readings.skin.ok(),
            room: readings.room.ok(),
            force: readings.force,
            demand: *demanded,
            current: readings.current,
            evaluations: self.reference.erfcx_evaluations(),
            fields: self.telemetry_fields,
        })
    }

    /// Whether an event was not fetched yet.
    pub fn has_event(&self) -> bool {
        self.events.has_event()
    }

    /// The oldest event that was not fetched yet. `None` while events are not reported.
    pub fn take_event(&mut self) -> Option<DeviceEvent> {
        self.events.take()
    }
}
