//! Thermistor counts to temperature.

use contact_model::fixed_point::{Celsius, log2};

use crate::settings;

/// Sums of counts at which a thermistor counts as open or shorted. The range between them is wider than
/// -40 to 125 °C of a 10 k thermistor of beta 3950 K under 10 k.
const SHORT_BELOW: u16 = 40 * 16;
const OPEN_ABOVE: u16 = 4060 * 16;

/// Fraction bits of `1/T`.
const INVERSE_BITS: i32 = 38;
/// 0 °C in kelvin.
const ZERO_CELSIUS_K: Celsius = Celsius::lit("273.15");

/// Why a thermistor has no temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorFault {
    /// No current flows: wire or thermistor broken.
    Open,
    /// No voltage drops: wires or thermistor shorted.
    Short,
}

/// `1/T` as a cubic in `x = log2(R / R_pull-up)`: the Steinhart-Hart equation, expanded about the pull-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Thermistor {
    /// Coefficients of `x^0` to `x^3`, in 2^-38 1/K.
    cubic: [i32; 4],
}

impl Thermistor {
    /// Expands the curve; `f64`, once.
    #[must_use]
    pub fn new(settings: &settings::Thermistor) -> Self {
        let (a, b, c) = settings.curve.steinhart_hart();
        let (l, s) = (libm::log(settings.pull_up_ohm), core::f64::consts::LN_2);
        // a + b (l + s x) + c (l + s x)^3
        let cubic = [
            a + b * l + c * l * l * l,
            s * (b + 3.0 * c * l * l),
            3.0 * c * l * s * s,
            c * s * s * s,
        ];
        Self {
            cubic: cubic.map(|k| libm::round(libm::ldexp(k, INVERSE_BITS)) as i32),
        }
    }

    /// Temperature for the sum of 16 12-bit conversions (0..=65520), within -200 to 230 °C.
    ///
    /// Rounding error below 0.1 mK from 0 to 60 °C (`cargo test thermistor`).
    ///
    /// # Errors
    /// Open or shorted.
    pub fn temperature(&self, sum: u16) -> Result<Celsius, SensorFault> {
        if sum < SHORT_BELOW {
            return Err(SensorFault::Short);
        }
        if sum > OPEN_ABOVE {
            return Err(SensorFault::Open);
        }
        // The converter's codes are centred on whole multiples of 1/4096 of its reference.
        let low = u32::from(sum);
        let x = i64::from((log2(low) - log2((1 << 16) - low)).to_bits());
        let inverse = self
            .cubic
            .iter()
            .rev()
            .fold(0i64, |sum, &k| ((sum * x) >> 24) + i64::from(k));
        // 1/500 K to 1/70 K keeps the quotient in range, whatever the settings.
        let inverse = inverse.clamp((1 << INVERSE_BITS) / 500, (1 << INVERSE_BITS) / 70);
        let kelvin = ((1u64 << (INVERSE_BITS + 22)) / inverse.unsigned_abs()) as i32;
        Ok(Celsius::from_bits(kelvin).saturating_sub(ZERO_CELSIUS_K))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Curve, Settings};

    /// The sum that the divider's ideal converter gives at a temperature, by the beta equation.
    fn sum_at(t_c: f64) -> f64 {
        let r = 10e3 * (3950.0 * (1.0 / (t_c + 273.15) - 1.0 / 298.15)).exp();
        r / (r + 10e3) * 65536.0
    }

    #[test]
    fn thermistor_inverts_the_beta_equation() {
        let thermistor = Thermistor::new(&Settings::default().thermistor);
        for milli in (-20_000..=100_000).step_by(7) {
            let sum = sum_at(f64::from(milli) * 1e-3).round();
            // The temperature of exactly this sum, by the equation solved for T.
            let r = 10e3 * sum / (65536.0 - sum);
            let exact = 1.0 / (1.0 / 298.15 + (r / 10e3).ln() / 3950.0) - 273.15;
            let error = thermistor
                .temperature(sum as u16)
                .expect("in range")
                .to_num::<f64>()
                - exact;
            assert!(error.abs() < 1e-4, "{exact}: {error:e}");
        }
    }

    /// A published set of a 10 k thermistor: 25 °C at 10 kohm, 0 °C at 32.65 kohm, 50 °C at 3.603 kohm.
    #[test]
    fn thermistor_follows_steinhart_and_hart() {
        let curve = Curve::SteinhartHart {
            a: 1.129_148e-3,
            b: 2.341_25e-4,
            c: 8.767_41e-8,
        };
        let thermistor = Thermistor::new(&settings::Thermistor {
            pull_up_ohm: 10e3,
            curve,
        });
        for (t_c, ohm) in [(0.0, 32_650.0), (25.0, 10_000.0), (50.0, 3_603.0)] {
            let sum = (ohm / (ohm + 10e3) * 65536.0f64).round() as u16;
            let t = thermistor.temperature(sum).expect("in range").to_num::<f64>();
            assert!((t - t_c).abs() < 0.05, "{t_c}: {t}");
        }
    }

    #[test]
    fn thermistor_range_ends_in_open_and_short() {
        let thermistor = Thermistor::new(&Settings::default().thermistor);
        assert_eq!(thermistor.temperature(65520), Err(SensorFault::Open));
        assert_eq!(thermistor.temperature(0), Err(SensorFault::Short));
        for t_c in [-40.0, 125.0] {
            assert!(thermistor.temperature(sum_at(t_c) as u16).is_ok());
        }
        for sum in 0..=65520 {
            let _any_count_has_an_answer = thermistor.temperature(sum);
        }
    }
}
