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

pub use state::{Event, State, Task};

use crate::control::{ControlParameters, Controller, Law, VoltageFeedforward};
use crate::drive::{Current, Drive, Outputs, SafeCurrent};
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

/// The control of one finger: state, estimates and controllers, without the hardware.
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
    /// Ticks since reset; wraps after 49 days.
    tick: u32,
    /// Ticks from one telemetry to the next; 0 for none.
    telemetry_ticks: u32,
    last: LastTick,
}

/// The sums of the last identification of the tile, which outlive its state.
#[derive(Clone, Debug, Default)]
struct IdentificationResult {
    equations: NormalEquations,
    /// `None` while it runs, and before the first one since `arm`.
    outcome: Option<Result<(), AbortReason>>,
}

/// What the last tick has read, and what the bridge was told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct LastTick {
    readings: Readings,
    reference: Option<Reference>,
    demanded: Current,
}

/// What a tick demands of the bridge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Demand {
    /// The bridge is off; the line that tests the comparator has this level.
    Off { comparator_test: bool },
    /// A current through legs that had these temperatures in the tick before.
    Drive {
        current: Current,
        previous_legs: LegTemperatures,
    },
}

impl Demand {
    const OFF: Self = Self::Off {
        comparator_test: false,
    };
}

impl Station {
    /// A station that is off.
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

    /// Uses the calibration and the tile of other settings of the same class.
    pub(crate) fn apply(&mut self, settings: &Settings) {
        self.sensors.recalibrate(&CalibrationTables::new(settings));
        self.set_parameters(&ControlParameters::new(settings));
    }

    fn set_parameters(&mut self, parameters: &ControlParameters) {
        self.controller.set_parameters(parameters);
        self.estimator.plate.set_parameters(&parameters.observer);
    }

    /// Runs one control tick: takes the tick's samples, and returns what the bridge must do until the next one.
    #[inline(never)]
    pub fn step(&mut self, samples: &Samples) -> Outputs {
        self.tick = self.tick.wrapping_add(1);
        let readings = self.sense(samples);
        let valid = self.detect(samples, &readings);
        let (demand, reference) = match valid {
            Ok(valid) => {
                let estimate = self.estimate(samples, &valid);
                let reference = self.reference(&estimate);
                let demand =
                    self.control(&valid, readings.bridge_fault, &estimate, reference.as_ref());
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

    /// Converts the tick's samples to °C, N and A, and averages them for a calibration.
    #[inline(never)]
    fn sense(&mut self, samples: &Samples) -> Readings {
        // An object is never presented during a calibration.
        if !self.state.presents() {
            self.averages.add_tick(&samples.thermistor_sums());
        }
        self.sensors.read_samples(samples)
    }

    /// Lets every detector see the tick; faults that one tick shows are named first.
    #[inline(never)]
    fn detect(&mut self, samples: &Samples, readings: &Readings) -> Result<ValidReadings, Fault> {
        // The bridge's command of the tick before, to which this tick's readings respond.
        let previous = PreviousActuation {
            demanded: self.last.demanded,
            setpoint: self.last.reference.map(|reference| reference.setpoint),
            residual_is_large: self.estimator.plate.residual_is_large(),
        };
        let frozen = self.detectors.check_samples(samples);
        let dose = self.detectors.check_dose(readings);
        let valid = safety::check(readings, self.controller.current_limit());
        let over_ticks = match &valid {
            Ok(valid) => {
                let streams = self.telemetry_ticks != 0;
                self.detectors.check(valid, &previous, streams)
            }
            Err(_) => {
                self.detectors.forget_motion();
                Ok(())
            }
        };
        let valid = valid?;
        self.check_bridge(readings)
            .and(over_ticks)
            .and(dose)
            .and(frozen)?;
        Ok(valid)
    }

    /// Checks the bridge's fault line. A comparator that has cut the supply pulls it until the next self-test, and is expected
    /// to pull it at that test's beginning.
    fn check_bridge(&self, readings: &Readings) -> Result<(), Fault> {
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

    /// Detects contact, and corrects the estimates of plate and finger.
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
        let pair = self.object.pair_under_finger();
        self.estimator
            .update_estimates(valid, force, landed_ticks, pair)
    }

    /// Where the display should be; `None` while nothing is to be followed.
    fn reference(&mut self, estimate: &UncorrectedEstimate) -> Option<Reference> {
        let finger = &mut self.estimator.finger;
        let setpoint = match &mut self.state {
            State::Off | State::SelfTest(_) | State::Ready | State::Tripped(_) => return None,
            State::Armed(Task::Neutral) => finger.temperatures_before_contact()?.skin,
            State::Armed(Task::Hold(hold)) => hold.step().celsius(),
            State::Armed(Task::Identify(tile)) => tile.operating_point().celsius(),
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

    /// Chooses the current of this tick.
    ///
    /// # Errors
    /// A fault that the self-test has found.
    #[inline(always)]
    fn control(
        &mut self,
        valid: &ValidReadings,
        bridge_fault: bool,
        estimate: &UncorrectedEstimate,
        reference: Option<&Reference>,
    ) -> Result<Demand, Fault> {
        let drive = |current| Demand::Drive {
            current,
            previous_legs: estimate.previous_legs,
        };
        if let State::SelfTest(test) = &mut self.state {
            let touched = self.contact.may_be_landing() || self.contact.touching();
            return Ok(match test.step(valid, bridge_fault, touched)? {
                SelfTestStep::Off { comparator_test } => Demand::Off { comparator_test },
                SelfTestStep::Drive(current) => {
                    self.controller.track_current(current);
                    drive(current)
                }
                SelfTestStep::Passed => {
                    self.change_state(Event::Pass);
                    Demand::OFF
                }
            });
        }
        let Some(reference) = reference else {
            return Ok(Demand::OFF);
        };
        let current = match self.identify(valid) {
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

    /// Current of the identification, if one runs.
    fn identify(&mut self, valid: &ValidReadings) -> Option<Current> {
        let State::Armed(Task::Identify(tile)) = &mut self.state else {
            return None;
        };
        let touching = self.contact.touching();
        let current = tile.choose_current(&mut self.identified.equations, valid, touching);
        self.identified.outcome = tile.outcome();
        if let Some(Err(_)) = self.identified.outcome {
            self.state = State::Armed(Task::Neutral);
        }
        current
    }

    /// Latches the fault of a tick, which switches the bridge off.
    fn trip_on_fault(&mut self, demand: Result<Demand, Fault>, readings: &Readings) -> Demand {
        self.latch.end_tick(demand.err());
        demand.unwrap_or_else(|fault| {
            let previously_demanded = self.last.demanded;
            self.trip(TripCause::new(
                fault,
                self.tick,
                readings,
                previously_demanded,
            ));
            Demand::OFF
        })
    }

    /// Turns the demand into the bridge's command, and advances the plate's model under the current.
    #[inline(always)]
    fn actuate(&mut self, demand: Demand) -> (Outputs, Current) {
        match demand {
            Demand::Drive {
                current,
                previous_legs,
            } => {
                self.estimator.plate.advance_model(current);
                let current = SafeCurrent::saturating(current);
                let outputs = Outputs {
                    drive: Drive::On(self.voltage.duty_for_current(current, &previous_legs)),
                    comparator_test: false,
                };
                (outputs, current.ampere())
            }
            Demand::Off { comparator_test } => {
                self.interrupt_identification();
                self.controller.track_current(Current::ZERO);
                self.estimator.plate.advance_model(Current::ZERO);
                let outputs = Outputs {
                    drive: Drive::Off,
                    comparator_test,
                };
                (outputs, Current::ZERO)
            }
        }
    }

    /// Starts the estimates again with the next valid readings.
    fn invalidate_estimates(&mut self) {
        self.estimator.invalidate();
        self.reference.invalidate();
    }

    /// Ends a running identification; the sums of one that is complete stay.
    fn interrupt_identification(&mut self) {
        if let State::Armed(task @ Task::Identify(_)) = &mut self.state
            && self.identified.outcome.is_none()
        {
            self.identified.outcome = Some(Err(AbortReason::Interrupted));
            *task = Task::Neutral;
        }
    }

    /// Changes the state by the transition table; returns whether it has one for this event.
    fn change_state(&mut self, event: Event) -> bool {
        let Some(state) = self.state.after(event) else {
            return false;
        };
        self.interrupt_identification();
        self.state = state;
        true
    }

    /// Trips for a fault that samples do not show. If the station has tripped before, `clear` reports the fault.
    pub fn raise(&mut self, fault: Fault) {
        self.latch.raise(fault, self.state.fault());
        self.trip_without_readings(fault);
    }

    fn trip_without_readings(&mut self, fault: Fault) {
        self.trip(TripCause {
            tick: self.tick,
            ..TripCause::alone(fault)
        });
    }

    /// Trips; the cause of an earlier trip stays.
    pub fn trip(&mut self, cause: TripCause) {
        if self.change_state(Event::Trip(cause.fault)) {
            self.latch.latch(cause, self.tick);
        }
    }

    /// What the station is doing.
    #[must_use]
    pub const fn state(&self) -> StateName {
        self.state.name()
    }

    /// Whether a fault is latched.
    #[must_use]
    pub const fn is_tripped(&self) -> bool {
        self.state.fault().is_some()
    }

    /// The fault latch, with the cause of the present or the last trip.
    #[must_use]
    pub const fn latch(&self) -> &FaultLatch {
        &self.latch
    }

    /// Thermal dose that the display may have given to this finger so far.
    #[must_use]
    pub const fn dose(&self) -> &ThermalDose {
        self.detectors.dose()
    }

    /// Continues from the thermal dose before a reset.
    pub const fn restore_dose(&mut self, dose: ThermalDose) {
        self.detectors.restore_dose(dose);
    }

    /// Notes that the host has sent something.
    pub const fn note_host_activity(&mut self) {
        self.detectors.note_host_activity();
    }

    /// Telemetry of the last tick, if it is due.
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
