//! Evenly distributed points of a domain, with its corners, and error measures.

use contact_model::fixed_point::Celsius;

pub use crate::verify::UNIT;

/// All corners of the unit cube of `N` dimensions, then `count` points of a low-discrepancy sequence: an additive
/// recurrence whose steps are powers of the inverse of the root of `x^(N+1) = x + 1`.
pub fn points<const N: usize>(count: u32) -> impl Iterator<Item = [f64; N]> {
    let mut root = 1.5f64;
    for _ in 0..40 {
        root = (1.0 + root).powf(1.0 / (N + 1) as f64);
    }
    let corners = (0..1u32 << N).map(|bits| std::array::from_fn(|i| f64::from(bits >> i & 1)));
    let inside = (1..=count)
        .map(move |n| std::array::from_fn(|i| (f64::from(n) * root.powi(-(i as i32) - 1)).fract()));
    corners.chain(inside)
}

/// Logarithmic interpolation from `low` at 0 to `high` at 1.
pub fn log_between(part: f64, low: f64, high: f64) -> f64 {
    (low.ln() + part * (high / low).ln()).exp().clamp(low, high)
}

/// Largest magnitude of the errors; NaN if one is NaN.
pub fn worst(errors: impl Iterator<Item = f64>) -> f64 {
    errors.map(f64::abs).fold(
        0.0,
        |worst, error| {
            if worst.is_nan() || error <= worst { worst } else { error }
        },
    )
}

/// Magnitude of the relative error.
pub fn relative(value: f64, truth: f64) -> f64 {
    if value == truth { 0.0 } else { (value / truth - 1.0).abs() }
}

/// Temperatures of skin and object, within the range of temperatures and at most 60 K apart.
pub fn skin_and_object(skin: f64, step: f64) -> (Celsius, Celsius) {
    let skin_c = 165.0 * skin - 40.0;
    let object_c = (skin_c + 120.0 * step - 60.0).clamp(-40.0, 125.0);
    (Celsius::from_num(skin_c), Celsius::from_num(object_c))
}
