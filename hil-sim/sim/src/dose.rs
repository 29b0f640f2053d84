//! Thermal dose of the skin.

/// Reference temperature of CEM43, at which the dose of one minute is one minute, deg C.
const REFERENCE_C: f64 = 43.0;
/// Temperature below which the dose is zero, deg C.
const THRESHOLD_C: f64 = 39.0;

/// Dose rate at a temperature, equivalent minutes at 43 deg C per minute: `R^(43 - T)` with `R` = 0.5 above 43 deg C and
/// 0.25 below, zero below 39 deg C (Sapareto and Dewey, 1984: CEM43).
pub fn cem43_rate(temperature_c: f64) -> f64 {
    let colder_k = REFERENCE_C - temperature_c;
    if temperature_c > REFERENCE_C {
        0.5f64.powf(colder_k)
    } else if temperature_c >= THRESHOLD_C {
        0.25f64.powf(colder_k)
    } else {
        0.0
    }
}

/// Dose of temperatures, deg C, that last `step_s` each; equivalent minutes at 43 deg C.
pub fn cem43_min(temperatures_c: impl Iterator<Item = f64>, step_s: f64) -> f64 {
    temperatures_c.map(cem43_rate).sum::<f64>() * step_s / 60.0
}
