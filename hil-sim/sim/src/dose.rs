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

#[cfg(test)]
mod tests {
    use super::*;

    /// Values from the definition; each degree above 43 deg C doubles the dose.
    #[test]
    fn doses_are_those_of_the_definition() {
        for (temperature_c, minutes, expected_min) in [
            (43.0, 10.0, 10.0),
            (44.0, 10.0, 20.0),
            (45.0, 10.0, 40.0),
            (51.0, 1.0, 256.0),
            (42.0, 10.0, 2.5),
            (39.0, 256.0, 1.0),
            (38.99, 1e4, 0.0),
            (10.0, 1e4, 0.0),
        ] {
            let steps = (minutes * 60.0) as usize;
            let dose_min = cem43_min(std::iter::repeat_n(temperature_c, steps), 1.0);
            assert!(
                (dose_min - expected_min).abs() < 1e-9 * (1.0 + expected_min),
                "{minutes} min at {temperature_c} C: {dose_min}"
            );
        }
    }
}
