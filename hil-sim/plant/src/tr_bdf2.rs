//! TR-BDF2, the time integration that all bodies of the plant share.
//!
//! One trapezoidal stage to `2 - sqrt 2` of the step is followed by a second-order backward difference (BDF2) to its
//! end. The method is of second order and L-stable, and at this fraction both stages share one matrix,
//! `C/(GAMMA h) - J`. For `C dT/dt = p(T)`, linearised over the step, and in increments:
//!
//! ```text
//! (C/(GAMMA h) - J) x1 = 2 p(T)
//! (C/(GAMMA h) - J) x2 = WEIGHT/GAMMA^2 C/h x1 - p(T)
//! T += x1 + x2
//! ```
//!
//! Coefficients are constant within a step. The energy that crosses a link in a step is therefore its conductance times
//! the difference of the [mean temperatures](step_mean) of its ends, and an energy balance computed from these means
//! closes to rounding.

/// Diagonal coefficient of the implicit stages, `1 - 1/sqrt 2`; also the third weight of the equivalent quadrature.
pub const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// First and second weight of the equivalent quadrature, `sqrt 2 / 4`.
const WEIGHT: f64 = std::f64::consts::FRAC_1_SQRT_2 / 2.0;

/// Storage term of the matrix, `C/(GAMMA h)`, in the unit of a conductance.
pub fn storage(capacity: f64, step_s: f64) -> f64 {
    capacity / (GAMMA * step_s)
}

/// Right-hand side of the first stage from the net power at the start of the step.
pub fn first_stage_rhs(power: f64) -> f64 {
    2.0 * power
}

/// Right-hand side of the second stage from the storage term, the first increment and the net power at the start.
pub fn second_stage_rhs(storage: f64, x1: f64, power: f64) -> f64 {
    WEIGHT / GAMMA * storage * x1 - power
}

/// Mean temperature over the step from the temperature at its end and both increments.
pub fn step_mean(end_c: f64, x1: f64, x2: f64) -> f64 {
    end_c - WEIGHT * x1 - (1.0 - GAMMA) * x2
}
