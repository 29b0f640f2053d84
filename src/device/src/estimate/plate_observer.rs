//! Disturbance observer of the display plate: an internal model runs in parallel with the plate, whatever chooses the
//! current, and a loop corrects the model by the readings of the display's thermistor.

use contact_model::fixed_point::Celsius;
use fixed::traits::LossyInto;

use super::plate_model::{LegTemperatures, PlateInputs, PlateModel, Watt};
use crate::drive::Current;
use crate::low_pass::{Coefficient, LowPass};
use crate::pi::{Pi, PiCoefficients};

/// Time constant, s, of the low-pass filter for the difference between the thermistor's reading and the modelled
/// reading; the filtered difference is added to the modelled surface temperature.
const DISTURBANCE_FILTER_TIME_CONSTANT_S: f64 = 0.02;
/// Weight of the correcting current in the residual, which is the filtered disturbance, K, plus this weight times the
/// correcting current: 1/2 K/A (2^-1, this power of two). The correcting current drives the disturbance towards zero,
/// so the disturbance alone would be small even with a wrong model. With this weight a module that is too weak is
/// detected even while the current is at its limit; for a sound tile the correcting current adds little, compared with
/// the permitted residual.
const CORRECTION_CURRENT_WEIGHT_IN_RESIDUAL_SHIFT: u32 = 1;
/// Margin by which the current in the model may exceed the controller's limit: 1/4 of the limit (2^-2, this power of
/// two). If the real tile responds more strongly than its model, the correcting current is opposite to the real
/// current. The current in the model, the real current minus the correcting current, is then larger in magnitude than
/// the real current, also at the limit.
const MODEL_CURRENT_MARGIN_SHIFT: u32 = 2;

/// Constants of the plate's observer in fixed point. They are converted from the settings of one tile, at start-up and
/// after a change of the settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverParameters {
    /// Internal model of the plate. Its constants are used; its temperatures are not, because the observer sets them
    /// itself.
    pub plate: PlateModel,
    /// Coefficient per tick of the low-pass filter that models the lag of the display's thermistor; computed from the
    /// lag in the tile's settings, s.
    pub sensor: Coefficient,
    /// Gains of the proportional-integral loop that computes the correcting current, A, from the innovation (reading
    /// minus modelled reading, K). They are those of the law `pi`.
    pub correction: PiCoefficients,
    /// Largest residual of a sound tile, K. The residual is the filtered innovation (reading minus modelled reading)
    /// plus half a kelvin per ampere of the correcting current. If a larger residual lasts for 30 ms while the display
    /// follows a set-point, the station trips with the fault `unlike-model`.
    pub largest_residual: Celsius,
}

/// Disturbance observer of the display plate. An internal model runs in parallel with the real plate. The innovation is
/// the difference between the thermistor's reading and the modelled reading. Filtered with 20 ms, the innovation is
/// added to the modelled surface temperature as a disturbance. From the unfiltered innovation a proportional-integral
/// loop computes the correcting current, which makes the model follow the reading.
#[derive(Clone, Debug)]
pub struct PlateObserver {
    plate: PlateModel,
    /// Modelled reading of the display's thermistor, °C: the modelled surface temperature, low-pass filtered with the
    /// lag of the thermistor.
    sensor: LowPass,
    /// Disturbance, K: the innovation (reading of the display's thermistor minus modelled reading), low-pass filtered
    /// with 20 ms. The disturbance is added to the modelled surface temperature.
    disturbance: LowPass,
    /// Proportional-integral loop from the innovation (reading minus modelled reading), K, to the correcting current,
    /// A.
    correction_loop: Pi,
    /// Correcting current, A (positive cools): the part of the real current that does not act in the model, so that the
    /// modelled reading agrees with the thermistor's.
    correction: Current,
    /// Current in the model, A (positive cools): that of the real module minus the correcting current, limited to 1.25
    /// times the controller's limit.
    model_current: Current,
    /// Heat flows, W, and sink temperature, °C, under which the model advances. Sink and finger's heat flow are those
    /// of this tick; pumped and Joule heat are those of the model's last step.
    inputs: PlateInputs,
    largest_residual: Celsius,
    /// Largest current of the controller, A. The correcting current is limited to this magnitude, the current in the
    /// model to 1.25 times as much.
    limit: Current,
    /// Whether the model has been started from a reading; false after construction and [`Self::invalidate`]. While it
    /// is false, the observer gives no temperatures, and the next reading starts the model.
    valid: bool,
    /// Whether the next reading of the display is the first with a new calibration. The step of that reading is then
    /// not counted as a disturbance.
    recalibrated: bool,
}

impl PlateObserver {
    /// An observer that starts from its first reading. `limit` is the controller's largest current, A: it limits the
    /// correcting current, and 1.25 times as much limits the current in the model.
    pub fn new(parameters: &ObserverParameters, limit: Current) -> Self {
        let disturbance = Coefficient::from_time_constant_s(DISTURBANCE_FILTER_TIME_CONSTANT_S);
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

    /// Replaces the constants of the observer by those of other settings: at the start by those of the settings in
    /// flash, later when the host sets a new tile (commands `tune result`, `set tile`). The estimated temperatures and
    /// the correcting current stay.
    pub fn set_parameters(&mut self, parameters: &ObserverParameters) {
        self.plate.set_parameters(&parameters.plate);
        self.sensor.set_coefficient(parameters.sensor);
        self.correction_loop.set_coefficients(parameters.correction);
        self.largest_residual = parameters.largest_residual;
    }

    /// Restarts the model at the next reading, in its steady state without disturbance and correcting current. Called
    /// in each tick whose readings are invalid or in which a fault detector finds a fault, and by the command `arm` in
    /// the state off. While the bridge is off, heat that the model does not contain adds up in disturbance and
    /// correcting current; after `arm` this must not trip the station with the fault `unlike-model`.
    pub const fn invalidate(&mut self) {
        self.valid = false;
    }

    /// Called when the host has changed the calibration (commands `calibrate`, `set correction` and `set steps`),
    /// before the next reading of the display: the step of that reading then shifts the modelled temperatures, instead
    /// of counting as a disturbance of the plate.
    pub const fn note_recalibration(&mut self) {
        self.recalibrated = true;
    }

    /// Temperature of the display's surface under the finger, °C: the modelled surface temperature plus the
    /// disturbance, which is the filtered difference between the thermistor's reading and the modelled reading. `None`
    /// until a reading has started the model, also after [`Self::invalidate`].
    pub fn surface(&self) -> Option<Celsius> {
        self.valid.then(|| (self.plate.surface()).saturating_add(self.disturbance.output()))
    }

    /// Modelled temperatures of the legs' cold and hot ends and their mean, °C. `None` until a reading has started the
    /// model, also after [`Self::invalidate`].
    pub fn leg_end_and_mean_temperatures(&self) -> Option<LegTemperatures> {
        self.valid.then(|| self.plate.leg_end_and_mean_temperatures())
    }

    /// Whether the residual exceeds [`ObserverParameters::largest_residual`] in magnitude; false until a reading has
    /// started the model, also after [`Self::invalidate`]. The residual is the disturbance, K (the filtered difference
    /// between the thermistor's reading and the modelled reading), plus half a kelvin per ampere of the correcting
    /// current. If the excess lasts for 30 ms while the display follows a set-point, the station trips with the fault
    /// `unlike-model`.
    pub fn residual_is_large(&self) -> bool {
        let correction: Celsius =
            (self.correction >> CORRECTION_CURRENT_WEIGHT_IN_RESIDUAL_SHIFT).lossy_into();
        let residual = self.disturbance.output().saturating_add(correction);
        let largest = self.largest_residual;
        self.valid && (residual > largest || residual < -largest)
    }

    /// Computes the disturbance and the correcting current from this tick's `reading` of the display's thermistor, °C,
    /// minus the modelled reading. Stores the temperature of the sink, °C, and the heat flow from the finger, W, as
    /// inputs of the model. The first reading, also after [`Self::invalidate`], starts the model in its steady state.
    pub fn update_disturbance_and_correction(
        &mut self,
        reading: Celsius,
        sink: Celsius,
        finger: Watt,
    ) {
        if !self.valid {
            self.inputs = self.plate.initialise_steady_state(reading, Current::ZERO, finger, sink);
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
            self.plate.shift_plate_temperature(offset);
            self.sensor.set_output(self.sensor.output().saturating_add(offset));
            innovation = self.disturbance.output();
            self.recalibrated = false;
        }
        self.disturbance.update_by_input(innovation);
        self.correction = self.correction_loop.update_current_by_error(innovation);
    }

    /// Current, A (positive cools), with which the modelled surface of the display reaches `target`, °C, in 12 ms: the
    /// present current in the model, plus the additional current that the model needs, plus the correcting current,
    /// because the real current is larger than that in the model by the correcting current. The sum is not limited
    /// here; the controller limits it.
    pub fn current_to_target(&self, target: Celsius) -> Current {
        self.model_current
            .saturating_add(self.plate.additional_current_to_target(target, &self.inputs))
            .saturating_add(self.correction)
    }

    /// Advances the model by one tick in which `current`, A (positive cools), flows through the real module. Does
    /// nothing until a reading has started the model, also after [`Self::invalidate`].
    #[inline(always)]
    pub fn advance_model(&mut self, current: Current) {
        if !self.valid {
            return;
        }
        let limit = self.limit.saturating_add(self.limit >> MODEL_CURRENT_MARGIN_SHIFT);
        self.model_current = current.saturating_sub(self.correction).min(limit).max(-limit);
        let PlateInputs { finger, sink, .. } = self.inputs;
        self.inputs = self.plate.inputs_of_tick(self.model_current, finger, sink);
        let previous_surface = self.plate.surface();
        self.plate.step(&self.inputs);
        // The modelled thermistor responds to the mean surface temperature over the tick.
        let surface = (previous_surface >> 1u32).saturating_add(self.plate.surface() >> 1u32);
        self.sensor.update_by_input(surface);
    }
}
