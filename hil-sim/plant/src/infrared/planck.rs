//! Black-body radiance in the camera's band, and its inverse.

use std::ops::RangeInclusive;

/// Band of the camera, m: 7.5 to 13 µm (section 5.2.2). The upper limits of the integrals of
/// Eq. 5-1 and 5-2 are these 13 µm; where a print of them reads 3 µm it is damaged.
pub const BAND_M: [f64; 2] = [7.5e-6, 13e-6];

/// Range of the functions of this module, deg C, to which temperatures are limited.
pub const RANGE_C: RangeInclusive<f64> = -100.0..=200.0;

const ZERO_C_K: f64 = 273.15;
// Exact by definition of the SI (2019).
const PLANCK_JS: f64 = 6.626_070_15e-34;
const BOLTZMANN_J_K: f64 = 1.380_649e-23;
const LIGHT_M_S: f64 = 299_792_458.0;

/// Second radiation constant `h c / k`, m K.
const SECOND_M_K: f64 = PLANCK_JS * LIGHT_M_S / BOLTZMANN_J_K;
/// `2 k⁴ / (h³ c²)`, W/(m² sr K⁴).
const SCALE: f64 = 2.0
    * (BOLTZMANN_J_K / PLANCK_JS)
    * (BOLTZMANN_J_K / PLANCK_JS)
    * (BOLTZMANN_J_K / PLANCK_JS)
    * BOLTZMANN_J_K
    / (LIGHT_M_S * LIGHT_M_S);

/// Radiance of a black body within [`BAND_M`], W/(m² sr), at a temperature, deg C; increasing with temperature.
///
/// Relative error at most 4e-15 over [`RANGE_C`].
pub fn radiance(temperature_c: f64) -> f64 {
    let kelvin = kelvin(temperature_c);
    let [short, long] =
        BAND_M.map(|wavelength_m| planck_integral(SECOND_M_K / (wavelength_m * kelvin)));
    SCALE * kelvin.powi(4) * (long - short)
}

/// Derivative of [`radiance`] by temperature, W/(m² sr K), at a temperature, deg C.
pub fn radiance_per_k(temperature_c: f64) -> f64 {
    let kelvin = kelvin(temperature_c);
    slope(kelvin, radiance(temperature_c))
}

/// Temperature, deg C, of the black body whose [`radiance`] this is, W/(m² sr).
///
/// Within 1e-11 deg C of the exact inverse over [`RANGE_C`]. Radiances outside of the range, also negative ones, give its
/// nearest end.
pub fn temperature_c(radiance_w_m2_sr: f64) -> f64 {
    let (coldest_c, hottest_c) = RANGE_C.into_inner();
    if radiance_w_m2_sr <= radiance(coldest_c) {
        return coldest_c;
    }
    if radiance_w_m2_sr >= radiance(hottest_c) {
        return hottest_c;
    }
    // Newton's method for ln U over 1/T. ln U is convex and decreasing in 1/T (U is a sum of exponentials of it), so each
    // step ends on the hot side of the root and the convergence from there is monotone: no bracket is needed as long as the
    // first step does not leave the range.
    let (hottest, coldest) = ((hottest_c + ZERO_C_K).recip(), (coldest_c + ZERO_C_K).recip());
    let mut inverse = START_K.recip();
    for _ in 0..MAX_ITERATIONS {
        let kelvin = inverse.recip();
        let here = radiance(kelvin - ZERO_C_K);
        let step = (here / radiance_w_m2_sr).ln() * here / (kelvin * kelvin * slope(kelvin, here));
        inverse = (inverse + step).clamp(hottest, coldest);
        if step.abs() < RELATIVE_TOLERANCE * inverse {
            break;
        }
    }
    inverse.recip() - ZERO_C_K
}

const START_K: f64 = 300.0;
/// Relative step after which the next, quadratically smaller, would be below rounding.
const RELATIVE_TOLERANCE: f64 = 1e-9;
/// The ends of the range need seven iterations; NaN ends at this limit.
const MAX_ITERATIONS: u32 = 16;

/// Absolute temperature, K, of a temperature limited to [`RANGE_C`].
fn kelvin(temperature_c: f64) -> f64 {
    temperature_c.clamp(*RANGE_C.start(), *RANGE_C.end()) + ZERO_C_K
}

/// `dU/dT`: `4 U / T` plus the terms of the limits of the band.
fn slope(kelvin: f64, radiance: f64) -> f64 {
    let [short, long] = BAND_M.map(|wavelength_m| {
        let x = SECOND_M_K / (wavelength_m * kelvin);
        x.powi(4) / x.exp_m1()
    });
    (4.0 * radiance + SCALE * kelvin.powi(4) * (long - short)) / kelvin
}

/// `∫ t³ / (e^t - 1) dt` from x to infinity, with `1/(e^t - 1) = Σ e^(-n t)` integrated term by term.
fn planck_integral(x: f64) -> f64 {
    let factor = (-x).exp();
    let (mut power, mut n, mut sum) = (factor, 1.0, 0.0);
    // The neglected terms sum to less than 1e-17 of the first.
    while power > 1e-18 * factor {
        let inverse = 1.0 / n;
        sum += power
            * inverse
            * (x * x * x + inverse * (3.0 * x * x + inverse * (6.0 * x + inverse * 6.0)));
        power *= factor;
        n += 1.0;
    }
    sum
}
