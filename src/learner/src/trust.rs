//! Whether the measured flux fits any finger on the display.

use crate::parameters::{FIRST_COMPONENT, Parameters, RESISTANCE, SKIN, Scale};
use crate::regressors::Measurement;

/// Why a contact is not learnt from: the most likely cause, since the learner sees the flux only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distrust {
    /// Flux is missing or has the wrong sign: the sensor.
    Sensor,
    /// The flux is less than fingers give, or the contact resistance stays at its upper limit: something lies between finger
    /// and display.
    Between,
    /// The flux is more than fingers give, or the contact resistance stays at its lower limit: water, or a gain that is far too large.
    Wet,
    /// The flux fitted a finger, then no longer: the finger has rolled off, or the sensor has failed.
    Contact,
    /// The flux fits no finger.
    Unexplained,
    /// A result is not a number.
    Arithmetic,
}

/// What the output is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trust {
    /// Learnt from less than half a second of a contact. Before the first contact the chosen person's finger, or without one the mean of
    /// the simulated fingers.
    Learning,
    /// Learnt from half a second of contact or more.
    Trusted,
    /// On the way to the mean finger, or there, until the next landing.
    Mean(Distrust),
}

/// Ticks of contact after which a finger is trusted, and a smaller innovation is tolerated.
const TRUSTED_TICKS: u32 = 500;
/// Time constant, in updates, of the filter of squared innovations over their variance.
const INNOVATION_UPDATES: f32 = 8.0;
/// Largest filtered innovation. The variance includes the error of the model, so that for most fingers it is far
/// below 1.
const INNOVATION_MAX: f32 = 4.0;
/// The same under a light force, where the contact resistance hides the finger.
const INNOVATION_MAX_LIGHT: f32 = 20.0;
/// Nominal contact resistance, m² K/W, above which the force is light: that of 0.48 N on the reference display.
pub const LIGHT_RESISTANCE_M2K_W: f32 = 2.4e-3;
/// Updates in a row that distrust needs.
const STRANGE_IN_A_ROW: u8 = 3;
/// Updates in a row with a parameter at a limit that distrust needs.
const AT_LIMIT_IN_A_ROW: u8 = 30;
/// Least ratio of the square of a parameter's regressor to the variance of the measurement's error in a quiet contact. Below it the
/// measurement hardly depends on the parameter, so that its limit does not count; nor does it under a light force.
const SENSITIVITY_MIN: f32 = 4.0;
/// Error of the skin's thermistor, in prior deviations, above which the limit of the first component counts at any sensitivity: a small
/// flux that is missing or reversed late in a contact looks like both.
const SKIN_ERROR_MAX_DEVIATIONS: f32 = 2.0;
/// Least temperature difference, K, of which the part that the measured flux explains is computed.
const DIFFERENCE_MIN_K: f32 = 1.0;
/// Least part of the temperature difference that the measured flux explains in the mean finger; below it the flux is missing.
const EXPLAINED_PART_MIN: f32 = 0.05;
/// The part above which a flux that fits no finger is taken for one through water. With a fifth of the contact resistance it is 1.9
/// or more in the tests.
const EXPLAINED_PART_MAX: f32 = 1.5;

/// Counts of what does not fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judge {
    trust: Trust,
    filtered_innovation: f32,
    strange_innovations: u8,
    at_limit: u8,
}

impl Judge {
    /// Before the first contact.
    pub const NEW: Self = Self {
        trust: Trust::Learning,
        filtered_innovation: 0.0,
        strange_innovations: 0,
        at_limit: 0,
    };

    /// What the parameters are worth.
    pub const fn trust(&self) -> Trust {
        self.trust
    }

    /// A new contact. Returns whether the finger is the one that was learnt before.
    pub const fn land(&mut self) -> bool {
        let is_known = !matches!(self.trust, Trust::Mean(_));
        *self = Self { trust: if is_known { self.trust } else { Trust::Learning }, ..Self::NEW };
        is_known
    }

    /// Distrusts from now on until the next landing.
    pub const fn distrust(&mut self, why: Distrust) {
        self.trust = Trust::Mean(why);
    }

    /// Judges an update: the squared innovation over its variance, at a nominal contact resistance, m² K/W, and so many ticks
    /// after landing, and the variance of the measurement's error in a quiet contact, K²; and the parameters.
    pub fn judge(
        &mut self,
        innovation: Option<f32>,
        measurement: &Measurement,
        (resistance_m2k_w, ticks, error_k2): (f32, u32, f32),
        parameters: &Parameters,
        scale: &Scale,
    ) {
        let Some(innovation) = innovation else {
            return self.distrust(Distrust::Arithmetic);
        };
        self.filtered_innovation += (innovation - self.filtered_innovation) / INNOVATION_UPDATES;
        let is_light = resistance_m2k_w > LIGHT_RESISTANCE_M2K_W;
        let largest = if is_light { INNOVATION_MAX_LIGHT } else { INNOVATION_MAX };
        let is_strange = self.filtered_innovation > largest;
        let sensitive_k2 = SENSITIVITY_MIN * error_k2;
        let limit = |index: usize, least_k2: f32| {
            let regressor_k = measurement.regressors[index];
            if is_light || regressor_k * regressor_k < least_k2 {
                None
            } else if parameters[index] == scale.low[index] {
                Some(Limit::Low)
            } else if parameters[index] == scale.high[index] {
                Some(Limit::High)
            } else {
                None
            }
        };
        let resistance = limit(RESISTANCE, sensitive_k2);
        let is_skin_strange =
            !(-SKIN_ERROR_MAX_DEVIATIONS..=SKIN_ERROR_MAX_DEVIATIONS).contains(&parameters[SKIN]);
        let component_k2 = if is_skin_strange { 0.0 } else { sensitive_k2 };
        // The second component may be at its limit: it is small, and takes up whatever else differs in a finger.
        let is_at_limit = resistance.is_some() || limit(FIRST_COMPONENT, component_k2).is_some();
        if counted(&mut self.strange_innovations, is_strange) >= STRANGE_IN_A_ROW {
            self.distrust(self.cause(explained(measurement), ticks, resistance));
        } else if counted(&mut self.at_limit, is_at_limit) >= AT_LIMIT_IN_A_ROW {
            self.distrust(match resistance {
                Some(Limit::Low) => Distrust::Wet,
                Some(Limit::High) => Distrust::Between,
                None => Distrust::Unexplained,
            });
        } else if ticks >= TRUSTED_TICKS && self.trust == Trust::Learning {
            self.trust = Trust::Trusted;
        }
    }

    /// The most likely cause of a flux that does not fit, with the limit at which the contact resistance is.
    fn cause(&self, explained: Option<f32>, ticks: u32, resistance: Option<Limit>) -> Distrust {
        let was_trusted = self.trust == Trust::Trusted && ticks >= TRUSTED_TICKS;
        match (explained, resistance) {
            (Some(part), _) if part < EXPLAINED_PART_MIN => Distrust::Sensor,
            _ if was_trusted => Distrust::Contact,
            (Some(part), Some(Limit::High)) if part < 1.0 => Distrust::Between,
            (Some(part), _) if part > EXPLAINED_PART_MAX => Distrust::Wet,
            _ => Distrust::Unexplained,
        }
    }
}

/// The limit at which a parameter is.
#[derive(Clone, Copy)]
enum Limit {
    Low,
    High,
}

/// Temperature difference that the measured flux makes in the mean finger and its contact, over the present one; `None` if
/// that is small.
fn explained(measurement: &Measurement) -> Option<f32> {
    let open_circuit_difference_k = measurement.open_circuit_difference_k;
    (!(-DIFFERENCE_MIN_K..=DIFFERENCE_MIN_K).contains(&open_circuit_difference_k))
        .then(|| (open_circuit_difference_k - measurement.residual_k) / open_circuit_difference_k)
}

/// Counts in a row.
fn counted(count: &mut u8, is_so: bool) -> u8 {
    *count = if is_so { count.saturating_add(1) } else { 0 };
    *count
}
