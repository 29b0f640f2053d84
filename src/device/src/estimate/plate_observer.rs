//! Disturbance observer of the display plate: the internal model runs beside the plate, whatever chooses the current, and a
//! loop corrects it by what the thermistor reads.

use contact_model::fixed_point::Celsius;
use fixed::traits::LossyInto;

use super::plate_model::{LegTemperatures, PlateInputs, PlateModel, Watt};
use crate::drive::Current;
use crate::low_pass::{Coefficient, LowPass};
use crate::pi::{Pi, PiCoefficients};

/// Time constant, s, with which the difference between the thermistor's reading and the model is filtered before it is
/// added to the modelled surface.
const DISTURBANCE_TIME_CONSTANT_S: f64 = 0.02;
/// The residual counts an ampere of the correcting current as half a kelvin (this power of two): enough to detect a
/// weak module while the current is at its limit, and little beside what a sound tile needs.
const RESIDUAL_PER_AMPERE_SHIFT: u32 = 1;
/// The current in the model may exceed the controller's limit by a quarter (this power of two). A tile that responds
/// more than its model has a negative correction, so at the limit its model needs more current than flows.
const MODEL_CURRENT_MARGIN_SHIFT: u32 = 2;

/// Constants of the plate's observer in fixed point, converted from the settings of one tile at start-up and after a
/// change of the settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverParameters {
    /// Internal model of the plate; only its constants are taken from here after the start.
    pub plate: PlateModel,
    /// Low-pass filter, per tick, that stands for the lag of the display's thermistor.
    pub sensor: Coefficient,
    /// Gains of the loop that turns the innovation (reading minus modelled reading, K) into a correcting current, A.
    pub correction: PiCoefficients,
    /// Largest residual of a sound tile, K. A larger one that lasts trips the station with the fault `unlike-model`.
    pub largest_residual: Celsius,
}

/// Disturbance observer of the display plate. An internal model runs beside the real plate; what the thermistor reads
/// beyond the model is added to the modelled surface as a disturbance, and a proportional-integral loop turns it into a
/// current that corrects the model.
#[derive(Clone, Debug)]
pub struct PlateObserver {
    plate: PlateModel,
    /// Modelled reading of the display's thermistor, °C: the modelled surface behind the thermistor's lag.
    sensor: LowPass,
    /// Filtered innovation (thermistor's reading minus modelled reading), K, which is added to the modelled surface.
    disturbance: LowPass,
    /// Loop from the innovation, K, to the correcting current, A.
    correction_loop: Pi,
    /// Correcting current, A: the part of the real current that the model does not get, so that both surfaces agree.
    correction: Current,
    /// Current that flows in the model, A: that of the real module, less the correction.
    model_current: Current,
    /// Heat flows, W, and sink temperature, °C, by which the model advances in this tick.
    inputs: PlateInputs,
    /// Largest residual of a sound tile, K; see [`ObserverParameters::largest_residual`].
    largest_residual: Celsius,
    /// The controller's largest current, A: limits the correction, and with a quarter more the current in the model.
    limit: Current,
    /// Whether the model has started from a reading; false after construction and [`Self::invalidate`].
    valid: bool,
    /// The next reading of the display is by a new calibration, so its step is no movement of the plate.
    recalibrated: bool,
}

impl PlateObserver {
    /// An observer that starts from its first reading. `limit` is the controller's largest current, A: the correction
    /// is limited to it, and the current in the model to a quarter more.
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

    /// Takes the constants of another tile, after the host has stored a new identification; the estimated temperatures
    /// and the correcting current stay.
    pub fn set_parameters(&mut self, parameters: &ObserverParameters) {
        self.plate.set_parameters(&parameters.plate);
        self.sensor.set_coefficient(parameters.sensor);
        self.correction_loop.set_coefficients(parameters.correction);
        self.largest_residual = parameters.largest_residual;
    }

    /// Lets the next reading restart the model in its steady state, with no disturbance and no correcting current.
    /// Called in a tick whose readings are invalid, and by the command `arm` in the state off, so that no correction
    /// from the time without current enters the first currents.
    pub const fn invalidate(&mut self) {
        self.valid = false;
    }

    /// Announces that the next reading of the display uses a new calibration: its step moves the modelled temperatures,
    /// too, and is not taken for a movement of the plate.
    pub const fn note_recalibration(&mut self) {
        self.recalibrated = true;
    }

    /// Temperature of the display's surface under the finger, °C: that of the model plus the disturbance. `None` before
    /// the first reading.
    #[must_use]
    pub fn surface(&self) -> Option<Celsius> {
        self.valid
            .then(|| (self.plate.surface()).saturating_add(self.disturbance.output()))
    }

    /// Temperatures of the legs' cold and hot ends and their mean by the model, °C; `None` before the first reading.
    #[must_use]
    pub fn leg_temperatures(&self) -> Option<LegTemperatures> {
        self.valid.then(|| self.plate.leg_temperatures())
    }

    /// Whether the disturbance, K, plus half a kelvin per ampere of the correcting current exceeds
    /// [`ObserverParameters::largest_residual`] in magnitude; false before the first reading. If that lasts, the
    /// station trips with `unlike-model`.
    #[must_use]
    pub fn residual_is_large(&self) -> bool {
        let correction: Celsius = (self.correction >> RESIDUAL_PER_AMPERE_SHIFT).lossy_into();
        let residual = self.disturbance.output().saturating_add(correction);
        self.valid && residual.saturating_abs() > self.largest_residual
    }

    /// Corrects the observer by this tick's reading of the display's thermistor, °C, and takes the sink's temperature,
    /// °C, and the heat flow from the finger, W, as the model's inputs. The first reading starts the model in its
    /// steady state.
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

    /// Current, A (positive cools), that brings the display's surface to `target`, °C, in 12 ticks: that in the model,
    /// what the model needs in addition, and the correction. Not limited; the law `model` limits it.
    #[must_use]
    pub fn current_to_target(&self, target: Celsius) -> Current {
        self.model_current
            .saturating_add(
                self.plate
                    .additional_current_to_target(target, &self.inputs),
            )
            .saturating_add(self.correction)
    }

    /// Advances the model by one tick in which `current`, A (positive cools), flows through the real module. Does
    /// nothing before the first reading.
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
