//! From a window's signals to one measurement that is linear in the parameters.

use fixed::traits::Fixed;

use crate::parameters::{MEAN_WEIGHTS, Parameters, RELATIVE_COMPONENTS, Scale, clamped};
use crate::sensor::FluxSensor;
use crate::signals::{Bank, BankOutput, Lag, dot};
use crate::window::{LearnerInput, WINDOW_TICKS};

/// All signals that pass the sensor's lag, and the banks that they drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signals {
    skin_above_display: Lag,
    skin_above_display_twice: Lag,
    air: Lag,
    touching: Lag,
    /// Driven by the measured flux beyond that of the air before contact.
    by_flux: Bank,
    /// Driven by the flux of the air before contact.
    by_air: Bank,
}

/// What drives lags and banks in a window: measured flux, skin above display, flux of the air before contact and touching, the
/// second and the third also after the sensor's lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    flux_w_m2: f32,
    above_k: f32,
    lagged_above_k: f32,
    air: f32,
    lagged_air: f32,
    touching: f32,
}

impl Drive {
    /// Fluxes into the banks.
    fn fluxes_w_m2(&self) -> [f32; 2] {
        [self.flux_w_m2 - self.lagged_air, self.lagged_air]
    }
}

/// Signals of one window with contact, after the sensor's lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lagged {
    /// The measured flux.
    pub flux_w_m2: f32,
    /// Skin before contact above the display's surface, K; and with the lag applied twice.
    above_k: f32,
    above_twice_k: f32,
    /// 1 in contact.
    touching: f32,
    by_flux: BankOutput,
    by_air: BankOutput,
}

/// A measurement as a float.
pub fn to_float<T: Fixed<Bits = i32>>(value: T) -> f32 {
    value.to_bits() as f32 / (1u32 << T::FRAC_NBITS) as f32
}

impl Signals {
    /// Before the first window.
    pub const NEW: Self = Self {
        skin_above_display: Lag::ZERO,
        skin_above_display_twice: Lag::ZERO,
        air: Lag::ZERO,
        touching: Lag::ZERO,
        by_flux: Bank::ZERO,
        by_air: Bank::ZERO,
    };

    /// What drives lags and banks in a window.
    #[inline(always)]
    pub fn drive(&self, input: &LearnerInput, sensor: &FluxSensor) -> Drive {
        let (above_k, air, touching) =
            (input.contact.as_ref()).map_or((0.0, 0.0, 0.0), |contact| {
                let share = f32::from(contact.touching_ticks) / WINDOW_TICKS as f32;
                let touching = clamped(share, 0.0, 1.0);
                let air = to_float(contact.air_flux_w_m2) * touching;
                (to_float(contact.skin_above_display_k), air, touching)
            });
        Drive {
            flux_w_m2: input.flux_w_m2.map_or(0.0, to_float),
            above_k,
            lagged_above_k: self.skin_above_display.mean(above_k, sensor),
            air,
            lagged_air: self.air.mean(air, sensor),
            touching,
        }
    }

    /// The signals of the window that is driven so, which [`Self::advance`] has not ended yet.
    #[inline(always)]
    pub fn lagged(&self, drive: &Drive, sensor: &FluxSensor) -> Lagged {
        let above_k = drive.lagged_above_k;
        let [flux_beyond_air, air] = drive.fluxes_w_m2();
        Lagged {
            flux_w_m2: drive.flux_w_m2,
            above_k,
            above_twice_k: self.skin_above_display_twice.mean(above_k, sensor),
            touching: self.touching.mean(drive.touching, sensor),
            by_flux: self.by_flux.output(flux_beyond_air),
            by_air: self.by_air.output(air),
        }
    }

    /// Advances by the window that is driven so.
    #[inline(always)]
    pub fn advance(&mut self, drive: &Drive, sensor: &FluxSensor) {
        (self.skin_above_display).advance(drive.above_k, sensor);
        (self.skin_above_display_twice).advance(drive.lagged_above_k, sensor);
        self.air.advance(drive.air, sensor);
        self.touching.advance(drive.touching, sensor);
        Bank::advance_both([&mut self.by_flux, &mut self.by_air], drive.fluxes_w_m2());
    }
}

/// One measurement: `residual = regressors . parameters + error`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Part of the temperature difference of skin and display that the mean finger does not explain, K.
    pub residual_k: f32,
    /// Change of the residual per prior deviation of each parameter, K.
    pub regressors: Parameters,
    /// Skin as it would be if no heat flowed into the display (its open-circuit temperature), less the display's surface, K.
    pub open_circuit_difference_k: f32,
}

/// Sum of a bank's output with the mean finger's weights times relative ones, K.
fn rise_k(output: &BankOutput, relative: &BankOutput) -> f32 {
    let mut weighted = *relative;
    for (one, mean) in weighted.iter_mut().zip(&MEAN_WEIGHTS) {
        *one *= mean;
    }
    dot(output, &weighted)
}

impl Lagged {
    /// The measurement of this window, for a nominal contact resistance, m² K/W, with the present relative weights of the finger.
    pub fn measurement(
        &self,
        resistance_m2k_w: f32,
        sensor: &FluxSensor,
        scale: &Scale,
        weights: &BankOutput,
    ) -> Measurement {
        let [first, second] = &RELATIVE_COMPONENTS;
        let contact_k = resistance_m2k_w * self.flux_w_m2;
        let residual_k = self.above_k
            - dot(&self.by_flux, &MEAN_WEIGHTS)
            - contact_k
            - sensor.resistance_m2k_w() * self.flux_w_m2;
        let mut regressors = [
            rise_k(&self.by_flux, first),
            rise_k(&self.by_flux, second),
            -rise_k(&self.by_air, weights),
            -self.touching,
            contact_k,
            self.above_k - self.above_twice_k,
        ];
        for (regressor, deviation) in regressors.iter_mut().zip(&scale.deviations) {
            *regressor *= deviation;
        }
        Measurement {
            residual_k,
            regressors,
            open_circuit_difference_k: self.above_k + dot(&self.by_air, &MEAN_WEIGHTS),
        }
    }
}
