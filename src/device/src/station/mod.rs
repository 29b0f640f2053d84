//! One finger's device, without its hardware: samples in, bridge command out, once per tick.
//!
//! ```text
//! samples -> sense -> detect -> estimate -> reference -> control -> actuate -> outputs
//!                                                                      |
//!                                                                   report -> telemetry
//! ```
//!
//! Each stage takes values and returns a value. Values of the tick before that are used on purpose are called `previous_…`.
//!
//! The `inline` attributes here and in `estimate` were found by measurement with the recorded compiler: without them a tick costs
//! 3 % more instructions (`cargo hil-sim run scenes/copper.toml --json`, `instructions_per_tick`).

mod execute;
mod object;
mod state;

use thermal_settings::Settings;

pub use state::{ArmedTask, Event, State};

use crate::control::{ControlParameters, Controller, Law, VoltageFeedforward};
use crate::drive::{BoardOutputs, Current, Drive, SafeCurrent};
use crate::estimate::{
    Estimator, FingerEstimator, LegTemperatures, PlateObserver, UncorrectedEstimate,
};
use crate::identification::{AbortReason, NormalEquations};
use crate::reference::{Reference, ReferenceGenerator};
use crate::safety::{
    self, Fault, FaultDetectors, FaultLatch, PreviousActuation, SelfTestStep, ThermalDose,
    TripCause, ValidReadings,
};
use crate::sense::{
    CalibrationTables, ContactDetector, Readings, Samples, Sensors, ThermistorAverages,
};
use crate::{StateName, Telemetry};
use object::PresentedObject;

/// The control of one finger without its hardware: takes the samples of each tick of 1 ms and returns what the bridge
/// must do, and executes the host's commands between ticks. Independent of the stations of other fingers.
#[derive(Clone, Debug)]
pub struct Station {
    sensors: Sensors,
    averages: ThermistorAverages,
    contact: ContactDetector,
    detectors: FaultDetectors,
    latch: FaultLatch,
    estimator: Estimator,
    object: PresentedObject,
    reference: ReferenceGenerator,
    controller: Controller,
    voltage: VoltageFeedforward,
    state: State,
    identified: IdentificationResult,
    /// Number of the last tick, of 1 ms since the start of the program; wraps after 49 days.
    tick: u32,
    /// Ticks of 1 ms from one telemetry to the next; 0 while the host wants none.
    telemetry_ticks: u32,
    last: LastTick,
}

/// Normal equations and outcome of the last identification of the tile. They stay when the station leaves that task,
/// until the host has read them or starts another.
#[derive(Clone, Debug, Default)]
struct IdentificationResult {
    equations: NormalEquations,
    /// Whether the normal equations are complete, or why the identification has ended early; `None` while it runs, and
    /// if none was started since the last `arm` or `hold`.
    outcome: Option<Result<(), AbortReason>>,
}

/// Readings, reference and demanded current of the last tick: for telemetry and `status`, and for the detectors of the
/// next tick, whose readings respond to that current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct LastTick {
    readings: Readings,
    reference: Option<Reference>,
    demanded: Current,
}

/// What a tick demands of the bridge before the current is clamped and converted to a voltage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BridgeDemand {
    /// Both half-bridges high-impedance; `comparator_test` is the level of the line that makes the comparator cut the
    /// supply.
    Off { comparator_test: bool },
    /// Drive `current`, A, positive cools. The voltage for it is computed from the temperatures of the module's legs as
    /// the model predicted them before this tick's reading corrected it.
    Drive {
        current: Current,
        previous_legs: LegTemperatures,
    },
}

impl BridgeDemand {
    const BRIDGE_OFF: Self = Self::Off {
        comparator_test: false,
    };
}

impl Station {
    /// A station in the state off, with these settings, without material, and before its first tick. Converts the
    /// settings from `f64`, so it is for the start only.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let parameters = ControlParameters::new(settings);
        let limit = Current::saturating_from_num(settings.module.current_limit_a);
        Self {
            sensors: Sensors::new(settings),
            averages: ThermistorAverages::default(),
            contact: ContactDetector::default(),
            detectors: FaultDetectors::default(),
            latch: FaultLatch::default(),
            estimator: Estimator {
                plate: PlateObserver::new(&parameters.observer, limit),
                finger: FingerEstimator::default(),
            },
            object: PresentedObject::new(&settings.display),
            reference: ReferenceGenerator::default(),
            controller: Controller::new(&parameters, limit),
            voltage: VoltageFeedforward::new(&settings.module),
            state: State::Off,
            identified: IdentificationResult::default(),
            tick: 0,
            telemetry_ticks: 0,
            last: LastTick {
                readings: Readings::ALL_OPEN,
                reference: None,
                demanded: Current::ZERO,
            },
        }
    }

    /// Takes calibration and tile from `settings`, converted from `f64`; the rest stays as the settings given to `new`
    /// have it. Called at the start, with the finger's stored settings.
    pub(crate) fn apply_settings(&mut self, settings: &Settings) {
        self.sensors.recalibrate(&CalibrationTables::new(settings));
        self.set_control_parameters(&ControlParameters::new(settings));
    }

    fn set_control_parameters(&mut self, parameters: &ControlParameters) {
        self.controller.set_parameters(parameters);
        self.estimator.plate.set_parameters(&parameters.observer);
    }

    /// Runs one control tick, to be called every millisecond: takes the sums of the 16 scans since the last tick, and
    /// returns what bridge and comparator's test line must do until the next one. In a tick that detects a fault the
    /// bridge is off.
    #[inline(never)]
    pub fn step(&mut self, samples: &Samples) -> BoardOutputs {
        self.tick = self.tick.wrapping_add(1);
        let readings = self.sense(samples);
        let valid = self.detect_faults(samples, &readings);
        let (demand, reference) = match valid {
            Ok(valid) => {
                let estimate = self.estimate(samples, &valid);
                let reference = self.generate_reference(&estimate);
                let demand = self.choose_demand(
                    &valid,
                    readings.bridge_fault,
                    &estimate,
                    reference.as_ref(),
                );
                (demand, reference)
            }
            Err(fault) => {
                self.invalidate_estimates();
                (Err(fault), None)
            }
        };
        let demand = self.trip_on_fault(demand, &readings);
        let (outputs, demanded) = self.actuate(demand);
        self.last = LastTick {
            readings,
            reference,
            demanded,
        };
        outputs
    }

    /// Converts the tick's samples to °C, N and A. Also adds those of the thermistors to the half-second means that a
    /// calibration uses, unless an object is presented.
    #[inline(never)]
    fn sense(&mut self, samples: &Samples) -> Readings {
        // An object is never presented during a calibration.
        if !self.state.is_presenting() {
            self.averages.add_tick(&samples.thermistor_sums());
        }
        self.sensors.read_samples(samples)
    }

    /// Shows the tick to every detector, and returns the valid readings.
    ///
    /// # Errors
    /// The first fault in this order: what this tick's readings show alone, bridge fault line, what shows over several
    /// ticks, thermal dose, frozen samples.
    #[inline(never)]
    fn detect_faults(
        &mut self,
        samples: &Samples,
        readings: &Readings,
    ) -> Result<ValidReadings, Fault> {
        // The bridge's command of the tick before, to which this tick's readings respond.
        let previous = PreviousActuation {
            demanded: self.last.demanded,
            setpoint: self.last.reference.map(|reference| reference.setpoint),
            residual_is_large: self.estimator.plate.residual_is_large(),
        };
        let frozen = self.detectors.check_samples(samples);
        let dose = self.detectors.add_to_dose(readings);
        let valid = safety::validate_readings(readings, self.controller.current_limit());
        let over_ticks = match &valid {
            Ok(valid) => {
                let streams = self.telemetry_ticks != 0;
                self.detectors.check_readings(valid, &previous, streams)
            }
            Err(_) => {
                self.detectors.forget_motion();
                Ok(())
            }
        };
        let valid = valid?;
        self.check_bridge_fault_line(readings)
            .and(over_ticks)
            .and(dose)
            .and(frozen)?;
        Ok(valid)
    }

    /// Checks the bridge's fault line. It is ignored in off and tripped, because a comparator that has cut the supply
    /// pulls it until the next self-test, and in the first 40 ticks of the self-test, which makes the comparator pull
    /// it.
    ///
    /// # Errors
    /// [`Fault::Bridge`]: the line is pulled in another state.
    fn check_bridge_fault_line(&self, readings: &Readings) -> Result<(), Fault> {
        let ignored = match &self.state {
            State::Off | State::Tripped(_) => true,
            State::SelfTest(test) => test.expects_bridge_fault(),
            _ => false,
        };
        if readings.bridge_fault && !ignored {
            Err(Fault::Bridge)
        } else {
            Ok(())
        }
    }

    /// Detects whether a finger touches, tracks the force sensor's zero, reports contact to the state, and corrects the
    /// estimates of plate and finger by this tick's readings. Returns the estimates from before the correction.
    fn estimate(&mut self, samples: &Samples, valid: &ValidReadings) -> UncorrectedEstimate {
        let previously_touching = self.contact.touching();
        self.contact.update_contact(valid.force);
        self.sensors.track_zero(samples, &self.contact);
        let touching = self.contact.touching();
        self.change_state(if touching { Event::Land } else { Event::Lift });
        let landed_ticks = if previously_touching {
            0
        } else {
            self.contact.detection_delay_ticks()
        };
        let force = touching.then_some(valid.force);
        let pair = self.object.contact_pair();
        self.estimator
            .update_estimates(valid, force, landed_ticks, pair)
    }

    /// Temperature that the display is to have in this tick; `None`, which leads to the bridge off, in the states off,
    /// self-test (which chooses its own current), ready and tripped, and before skin and room were read.
    fn generate_reference(&mut self, estimate: &UncorrectedEstimate) -> Option<Reference> {
        let finger = &mut self.estimator.finger;
        let setpoint = match &mut self.state {
            State::Off | State::SelfTest(_) | State::Ready | State::Tripped(_) => return None,
            State::Armed(ArmedTask::Neutral) => finger.temperatures_before_contact()?.skin,
            State::Armed(ArmedTask::Hold(hold)) => hold.next_setpoint().celsius(),
            State::Armed(ArmedTask::Identify(tile)) => tile.operating_point().celsius(),
            State::Preset | State::Contact => {
                let scene = self.object.scene()?;
                let surface = estimate.previous_surface;
                let follow_skin = self.controller.law() == Law::Model;
                return self
                    .reference
                    .next_reference(&scene, finger, surface, follow_skin);
            }
        };
        Some(Reference::at(setpoint))
    }

    /// Chooses what the bridge must do in this tick: what the self-test or the identification demands while one runs,
    /// else the current of the control law; off without a reference.
    ///
    /// # Errors
    #[inline(always)]
    fn choose_demand(
        &mut self,
        valid: &ValidReadings,
        bridge_fault: bool,
        estimate: &UncorrectedEstimate,
        reference: Option<&Reference>,
    ) -> Result<BridgeDemand, Fault> {
        let drive = |current| BridgeDemand::Drive {
            current,
            previous_legs: estimate.previous_legs,
        };
        if let State::SelfTest(test) = &mut self.state {
            let touched = self.contact.may_be_landing() || self.contact.touching();
            return Ok(match test.step(valid, bridge_fault, touched)? {
                SelfTestStep::Off { comparator_test } => BridgeDemand::Off { comparator_test },
                SelfTestStep::Drive(current) => {
                    self.controller.track_current(current);
                    drive(current)
                }
                SelfTestStep::Passed => {
                    self.change_state(Event::Pass);
                    BridgeDemand::BRIDGE_OFF
                }
            });
        }
        let Some(reference) = reference else {
            return Ok(BridgeDemand::BRIDGE_OFF);
        };
        let current = match self.identification_current(valid) {
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

    /// Current that the identification of the tile demands in this tick, A; `None` if none runs, or if it ends early in
    /// this tick: then the task becomes neutral, and the control law chooses the current.
    fn identification_current(&mut self, valid: &ValidReadings) -> Option<Current> {
        let State::Armed(ArmedTask::Identify(tile)) = &mut self.state else {
            return None;
        };
        let touching = self.contact.touching();
        let current = tile.choose_current(&mut self.identified.equations, valid, touching);
        self.identified.outcome = tile.outcome();
        if let Some(Err(_)) = self.identified.outcome {
            self.state = State::Armed(ArmedTask::Neutral);
        }
        current
    }

    /// If the tick has found a fault, trips the station with the tick's readings as its cause, and demands the bridge
    /// off; otherwise passes the demand on. In both cases tells the latch which fault is present now.
    fn trip_on_fault(
        &mut self,
        demand: Result<BridgeDemand, Fault>,
        readings: &Readings,
    ) -> BridgeDemand {
        self.latch.set_present_fault(demand.err());
        demand.unwrap_or_else(|fault| {
            let previously_demanded = self.last.demanded;
            self.trip(TripCause::new(
                fault,
                self.tick,
                readings,
                previously_demanded,
            ));
            BridgeDemand::BRIDGE_OFF
        })
    }

    /// Converts the demand to the outputs, and advances the plate's model by one tick under the demanded current. Also
    /// returns the current clamped to -6 to 6 A, zero if the bridge is off. Off interrupts an identification, and lets
    /// the control laws start from zero current.
    #[inline(always)]
    fn actuate(&mut self, demand: BridgeDemand) -> (BoardOutputs, Current) {
        match demand {
            BridgeDemand::Drive {
                current,
                previous_legs,
            } => {
                self.estimator.plate.advance_model(current);
                let current = SafeCurrent::saturating(current);
                let outputs = BoardOutputs {
                    drive: Drive::On(self.voltage.duty_for_current(current, &previous_legs)),
                    comparator_test: false,
                };
                (outputs, current.ampere())
            }
            BridgeDemand::Off { comparator_test } => {
                self.interrupt_identification();
                self.controller.track_current(Current::ZERO);
                self.estimator.plate.advance_model(Current::ZERO);
                let outputs = BoardOutputs {
                    drive: Drive::Off,
                    comparator_test,
                };
                (outputs, Current::ZERO)
            }
        }
    }

    /// Lets the estimates of plate, skin and contact start again with the next valid readings, because this tick's
    /// readings are invalid or a detector has found a fault.
    fn invalidate_estimates(&mut self) {
        self.estimator.invalidate();
        self.reference.invalidate();
    }

    /// Ends an identification that is still running with the outcome "interrupted", and makes the task neutral. The
    /// normal equations of one that is complete stay, and so does its task.
    fn interrupt_identification(&mut self) {
        if let State::Armed(task @ ArmedTask::Identify(_)) = &mut self.state
            && self.identified.outcome.is_none()
        {
            self.identified.outcome = Some(Err(AbortReason::Interrupted));
            *task = ArmedTask::Neutral;
        }
    }

    /// Changes the state by the transition table, and interrupts a running identification if it does; returns whether
    /// the event has changed the state.
    fn change_state(&mut self, event: Event) -> bool {
        let Some(state) = self.state.state_after(event) else {
            return false;
        };
        self.interrupt_identification();
        self.state = state;
        true
    }

    /// Trips the station by a fault that the board has found outside of the tick. If another fault is latched, that one
    /// stays, and `clear` then trips the station by this one.
    pub fn raise_external_fault(&mut self, fault: Fault) {
        self.latch
            .raise_external_fault(fault, self.state.latched_fault());
        self.trip_without_readings(fault);
    }

    fn trip_without_readings(&mut self, fault: Fault) {
        self.trip(TripCause {
            tick: self.tick,
            ..TripCause::without_readings(fault)
        });
    }

    /// Trips the station with this cause, which switches the bridge off in the next tick. Has no effect on a station
    /// that is tripped, so that the first cause stays.
    pub fn trip(&mut self, cause: TripCause) {
        if self.change_state(Event::Trip(cause.fault)) {
            self.latch.latch_cause(cause, self.tick);
        }
    }

    /// Name of the station's present state, with the fault if it is tripped.
    #[must_use]
    pub const fn state(&self) -> StateName {
        self.state.name()
    }

    /// Whether the station is tripped, so that its bridge stays off until `clear`.
    #[must_use]
    pub const fn is_tripped(&self) -> bool {
        self.state.latched_fault().is_some()
    }

    /// The fault latch, from which the device reads cause and tick of the present or the last trip.
    #[must_use]
    pub const fn latch(&self) -> &FaultLatch {
        &self.latch
    }

    /// Thermal dose that the display would have given to skin that always touched it, so far; the board stores it after
    /// every tick.
    #[must_use]
    pub const fn dose(&self) -> &ThermalDose {
        self.detectors.dose()
    }

    /// Continues from the thermal dose that was stored before a reset. Called once, at the start.
    pub const fn restore_dose(&mut self, dose: ThermalDose) {
        self.detectors.restore_dose(dose);
    }

    /// Restarts the 2 s after which a host that has asked for telemetry counts as silent; called for each line from the
    /// host.
    pub const fn note_host_activity(&mut self) {
        self.detectors.note_host_activity();
    }

    /// Telemetry of the last tick; `None` unless the host has asked for telemetry and this tick's number is a multiple
    /// of the interval.
    #[must_use]
    pub fn telemetry(&self) -> Option<Telemetry> {
        if self.telemetry_ticks == 0 || !self.tick.is_multiple_of(self.telemetry_ticks) {
            return None;
        }
        let LastTick {
            readings,
            reference,
            demanded,
        } = &self.last;
        Some(Telemetry {
            tick: self.tick,
            state: self.state.name(),
            setpoint: reference.map(|reference| reference.setpoint.celsius()),
            limited: reference.is_some_and(|reference| reference.limited),
            display: readings.display.ok(),
            sink: readings.sink.ok(),
            skin: readings.skin.ok(),
            room: readings.room.ok(),
            force: readings.force,
            demand: *demanded,
            current: readings.current,
            evaluations: self.reference.erfcx_evaluations(),
        })
    }
}
