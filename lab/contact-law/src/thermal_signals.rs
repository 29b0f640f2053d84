//! Temperature of the skin's surface under the measured flux, by the tissue of the mean finger and its two components.

use contact_model::finger::{COMPONENTS, MEAN};
use contact_model::impedance::Relaxation;

use crate::recording::{Recording, STEP_S, Sample};

/// One or several samples as an equation: temperature difference across the contact, K, for the mean finger, and its change per
/// unit of each property of the finger.
#[derive(Clone, Copy, Debug)]
pub struct Equation {
    /// Difference under the mean finger, K.
    pub difference_k: f64,
    /// Of the two components, of the relative change of the flux that the air took before contact, and of the skin's
    /// temperature before contact, K per unit.
    pub per_property: [f64; PROPERTIES],
    /// Flux, W/m².
    pub flux_w_m2: f64,
    /// Logarithm of the force in N.
    pub log_force: f64,
    /// Time since landing, s.
    pub since_s: f64,
}

/// Number of properties of the finger.
pub const PROPERTIES: usize = 4;
/// Samples whose mean is one equation, 0.1 s. Single samples would bias the fit: the noise of the flux is multiplied by the
/// resistance, so that a smaller resistance leaves smaller errors.
const SAMPLES_PER_EQUATION: usize = 10;
/// Time of one equation, s.
pub const EQUATION_S: f64 = SAMPLES_PER_EQUATION as f64 * STEP_S;

impl Equation {
    /// The mean of equations that follow each other.
    fn mean_of(equations: &[Self]) -> Self {
        let mean = |of: &dyn Fn(&Self) -> f64| {
            equations.iter().map(of).sum::<f64>() / equations.len() as f64
        };
        Self {
            difference_k: mean(&|one| one.difference_k),
            per_property: std::array::from_fn(|of| mean(&|one| one.per_property[of])),
            flux_w_m2: mean(&|one| one.flux_w_m2),
            log_force: mean(&|one| one.log_force),
            since_s: mean(&|one| one.since_s),
        }
    }
}

/// The relaxations of the mean finger, driven by a flux that is linear between samples.
struct Bank {
    states: Vec<f64>,
    flux_w_m2: f64,
}

impl Bank {
    fn new() -> Self {
        Self { states: vec![0.0; MEAN.impedance.relaxations.len()], flux_w_m2: 0.0 }
    }

    fn step(&mut self, flux_w_m2: f64) {
        let rise = flux_w_m2 - self.flux_w_m2;
        for (state, one) in self.states.iter_mut().zip(MEAN.impedance.relaxations) {
            let rate = one.rate_1_s;
            let x = rate * STEP_S;
            // Responses to a constant flux and to one that rises from zero to 1 W/m² in the step.
            let (constant, ramp) = if x > 0.0 {
                let constant = -(-x).exp_m1() / rate;
                (constant, (1.0 - constant / STEP_S) / rate)
            } else {
                (STEP_S, 0.5 * STEP_S)
            };
            *state = *state * (-x).exp() + constant * self.flux_w_m2 + ramp * rise;
        }
        self.flux_w_m2 = flux_w_m2;
    }

    /// Rise of the surface with weights changed by these fractions, K.
    fn rise_k(&self, weight: impl Fn(usize) -> f64) -> f64 {
        let gain = |(index, one): (usize, &Relaxation)| weight(index) * one.gain_m2k_j;
        let relaxed = MEAN.impedance.relaxations.iter().enumerate().map(gain);
        let relaxed: f64 = relaxed.zip(&self.states).map(|(gain, state)| gain * state).sum();
        let direct = weight(self.states.len()) * MEAN.impedance.direct_m2k_w;
        relaxed + direct * self.flux_w_m2
    }
}

/// Weight of a relaxation in a component; the integrator, which comes first, is in none.
fn component(of: usize) -> impl Fn(usize) -> f64 {
    move |index| index.checked_sub(1).map_or(0.0, |index| COMPONENTS[of][index])
}

/// The equations of all samples.
pub fn equations(recording: &Recording) -> Vec<Equation> {
    let air_w_m2 = MEAN.air_w_m2k * (recording.skin_c - recording.room_c);
    let (mut beyond_air, mut air) = (Bank::new(), Bank::new());
    let of_sample = |sample: &Sample| {
        beyond_air.step(sample.flux_w_m2 - air_w_m2);
        air.step(air_w_m2);
        let layer_k = recording.layer_m2k_w * sample.flux_w_m2;
        Equation {
            difference_k: recording.skin_c
                - beyond_air.rise_k(|_| 1.0)
                - sample.surface_c
                - layer_k,
            per_property: [
                -beyond_air.rise_k(component(0)),
                -beyond_air.rise_k(component(1)),
                air.rise_k(|_| 1.0),
                1.0,
            ],
            flux_w_m2: sample.flux_w_m2,
            log_force: sample.force_n.ln(),
            since_s: sample.since_s,
        }
    };
    let all: Vec<_> = recording.samples.iter().map(of_sample).collect();
    let means = all.chunks_exact(SAMPLES_PER_EQUATION);
    means.map(Equation::mean_of).collect()
}
