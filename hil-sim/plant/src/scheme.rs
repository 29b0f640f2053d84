//! The integration in time that every body of the plant shares: TR-BDF2.
//!
//! The trapezoidal rule goes to `2 - sqrt 2` of the step, second-order backward differences to its end. It is of
//! second order, L-stable, and with that fraction both stages share one matrix, `C/(IMPLICIT h) - J`. For
//! `C dT/dt = p(T)`, linear over the step, and in increments:
//!
//! ```text
//! (C/(IMPLICIT h) - J) x1 = 2 p(T)
//! (C/(IMPLICIT h) - J) x2 = WEIGHT/IMPLICIT^2 C/h x1 - p(T)
//! T += x1 + x2
//! ```
//!
//! Coefficients are held over a step, so every flow over the step is that of the [mean](mean) temperatures: books
//! kept with them close to rounding.

/// Share of a step that is implicit in each stage, `1 - 1/sqrt 2`; also the last weight of the quadrature.
pub const IMPLICIT: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// First and second weight of the quadrature that a step amounts to, `sqrt 2 / 4`.
const WEIGHT: f64 = std::f64::consts::FRAC_1_SQRT_2 / 2.0;

/// `C/(IMPLICIT h)` of a heat capacity.
#[must_use]
pub fn inertia(capacity: f64, step_s: f64) -> f64 {
    capacity / (IMPLICIT * step_s)
}

/// Right-hand side of the first stage, of the power at the start.
#[must_use]
pub fn first(power: f64) -> f64 {
    2.0 * power
}

/// Right-hand side of the second stage, of the inertia, the first increment and the power at the start.
#[must_use]
pub fn second(inertia: f64, x1: f64, power: f64) -> f64 {
    WEIGHT / IMPLICIT * inertia * x1 - power
}

/// Mean over the step, of the temperature at its end and both increments.
#[must_use]
pub fn mean(end_c: f64, x1: f64, x2: f64) -> f64 {
    end_c - WEIGHT * x1 - (1.0 - IMPLICIT) * x2
}
