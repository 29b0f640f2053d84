//! Disturbance observer of the display plate: the internal model runs beside the plate, whatever chooses the current, and a
//! loop corrects it by what the thermistor reads.

use contact_model::fixed_point::Celsius;
use fixed::traits::LossyInto;

use super::plate_model::{LegTemperatures, PlateInputs, PlateModel, Watt};
use crate::drive::Current;
use crate::low_pass::{Coefficient, LowPass};
use crate::pi::{Pi, PiCoefficients};

/// Time constant over which the innovation is taken for a disturbance of the plate, s.
const DISTURBANCE_TIME_CONSTANT_S: f64 = 0.02;
/// The residual counts an ampere of the correcting current as half a kelvin: enough to detect a weak module while the
/// current is at its limit, and little beside what a sound tile needs. As a power of two.
const RESIDUAL_PER_AMPERE_SHIFT: u32 = 1;
/// The model's current may exceed the limit by a quarter, as a power of two: a tile that responds more than its model, whose
/// correction is negative, is still followed at the limit.
const MODEL_CURRENT_MARGIN_SHIFT: u32 = 2;

/// The observer's constants, converted from the settings of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverParameters {
    /// Internal model of the plate.
    pub plate: PlateModel,
    /// Lag of the display's thermistor.
    pub sensor: Coefficient,
    /// Loop that turns the innovation into a correcting current.
    pub correction: PiCoefficients,
    /// Largest residual of a sound tile, K.
    pub largest_residual: Celsius,
}

/// The observer: internal model, filters, and the loop that corrects the model.
#[derive(Clone, Debug)]
pub struct PlateObserver {
    plate: PlateModel,
    /// What the thermistor would read by the model.
    sensor: LowPass,
    /// Filtered innovation: reading minus prediction, K.
    disturbance: LowPass,
    correction_loop: Pi,
    /// Current that the loop adds to the model's, A.
    correction: Current,
    /// Current in the model: the plate's, less the correction, A.
    model_current: Current,
    /// Inputs of the model in the last tick.
    inputs: PlateInputs,
    largest_residual: Celsius,
    limit: Current,
    /// The model has started from a reading.
    valid: bool,
    /// The next reading is by another calibration of the same temperature.
    recalibrated: bool,
}

impl PlateObserver {
    /// An observer before its first reading; `limit` is the controller's largest current.
    #[must_use]
    pub fn new(parameters: &ObserverParameters, limit: Current) -> Self {
        let disturbance = Coefficient::from_time_constant_s(DISTURBANCE_TIME_CONSTANT_S);
        Self {
            plate: parameters.plate,
            sensor: LowPass::new(parameters.sensor),
            disturbance: LowPass::new(disturbance),
            correction_loop: Pi::new(parameters.correction, limit),
            correction: Current::ZERO,
            model_current: Current::ZERO,
            inputs: PlateInputs::default(),
            largest_residual: parameters.largest_residual,
            limit,
            valid: false,
            recalibrated: false,
        }
    }

    /// Takes the parameters of another tile; the temperatures stay.
    pub fn set_parameters(&mut self, parameters: &ObserverParameters) {
        self.plate.set_parameters(&parameters.plate);
        self.sensor.set_coefficient(parameters.sensor);
        self.correction_loop.set_coefficients(parameters.correction);
        self.largest_residual = parameters.largest_residual;
    }

    /// Starts again from the next reading, because the plate was not observed.
    pub const fn invalidate(&mut self) {
        self.valid = false;
    }

    /// Takes the difference of the next reading for the new calibration's, not for a movement of the plate.
    pub const fn note_recalibration(&mut self) {
        self.recalibrated = true;
    }

    /// Surface of the display: model plus disturbance; `None` before the first reading.
    #[must_use]
    pub fn surface(&self) -> Option<Celsius> {
        self.valid
            .then(|| (self.plate.surface()).saturating_add(self.disturbance.output()))
    }

    /// Temperatures of the legs by the model; `None` before the first reading.
    #[must_use]
    pub fn leg_temperatures(&self) -> Option<LegTemperatures> {
        self.valid.then(|| self.plate.leg_temperatures())
    }

    /// Whether the residual exceeds that of a sound tile; false before the first reading.
    #[must_use]
    pub fn residual_is_large(&self) -> bool {
        let correction: Celsius = (self.correction >> RESIDUAL_PER_AMPERE_SHIFT).lossy_into();
        let residual = self.disturbance.output().saturating_add(correction);
        self.valid && residual.saturating_abs() > self.largest_residual
    }

    /// Corrects the model by a tick's reading, and takes the sink and the heat from the finger.
    pub fn correct_by_reading(&mut self, reading: Celsius, sink: Celsius, finger: Watt) {
        if !self.valid {
            self.inputs = self
                .plate
                .initialise_steady_state(reading, Current::ZERO, finger, sink);
            self.model_current = Current::ZERO;
            self.sensor.set_output(reading);
            self.disturbance.set_output(Celsius::ZERO);
            self.correction_loop.track_current(Current::ZERO);
            (self.valid, self.recalibrated) = (true, false);
        }
        (self.inputs.sink, self.inputs.finger) = (sink, finger);
        let mut innovation = reading.saturating_sub(self.sensor.output());
        if self.recalibrated {
            let offset = innovation.saturating_sub(self.disturbance.output());
            self.plate.offset_temperatures(offset);
            self.sensor
                .set_output(self.sensor.output().saturating_add(offset));
            innovation = self.disturbance.output();
            self.recalibrated = false;
        }
        self.disturbance.filter(innovation);
        self.correction = self.correction_loop.current_for_error(innovation);
    }

    /// Current that brings the surface to a target, correction included, A; positive cools.
    #[must_use]
    pub fn current_to_target(&self, target: Celsius) -> Current {
        self.model_current
            .saturating_add(
                self.plate
                    .additional_current_to_target(target, &self.inputs),
            )
            .saturating_add(self.correction)
    }

    /// Advances the model by one tick under the current that is driven.
    pub fn advance_model(&mut self, current: Current) {
        if !self.valid {
            return;
        }
        let limit = self
            .limit
            .saturating_add(self.limit >> MODEL_CURRENT_MARGIN_SHIFT);
        self.model_current = current
            .saturating_sub(self.correction)
            .min(limit)
            .max(-limit);
        let PlateInputs { finger, sink, .. } = self.inputs;
        self.inputs = self.plate.inputs_of_tick(self.model_current, finger, sink);
        let previous_surface = self.plate.surface();
        self.plate.step(&self.inputs);
        // The thermistor sees the mean of the surface over the tick.
        let surface = (previous_surface >> 1u32).saturating_add(self.plate.surface() >> 1u32);
        self.sensor.filter(surface);
    }
}
