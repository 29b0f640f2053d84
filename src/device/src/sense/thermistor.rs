//! Thermistor counts to temperature.

use contact_model::fixed_point::Celsius;

use super::correction::FINE_BITS;
use thermal_settings as settings;

/// Sums of counts at which a thermistor counts as open or shorted. The range between them is wider than
/// -40 to 125 °C of a 10 k thermistor of beta 3950 K under 10 k.
const SHORT_BELOW: u16 = 40 * 16;
const OPEN_ABOVE: u16 = 4060 * 16;

/// Whether one code is beyond the range of temperatures.
pub(super) const fn is_at_an_end(code: u16) -> bool {
    code < SHORT_BELOW / 16 || code > OPEN_ABOVE / 16
}

/// Whether a sum is that of a thermistor.
///
/// # Errors
/// Open or shorted.
pub(super) const fn connected(sum: u16) -> Result<(), SensorFault> {
    match sum {
        ..SHORT_BELOW => Err(SensorFault::Short),
        SHORT_BELOW..=OPEN_ABOVE => Ok(()),
        _ => Err(SensorFault::Open),
    }
}

/// Equal parts of the range of sums, as a power of two.
const PARTS_SHIFT: u32 = 6;
const PARTS: usize = 1 << PARTS_SHIFT;

/// Why a thermistor has no temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorFault {
    /// No current flows: wire or thermistor broken.
    Open,
    /// No voltage drops: wires or thermistor shorted.
    Short,
}

/// Sum to temperature as a cubic on each of 64 equal parts of the range, whatever the curve: a tick pays three
/// multiplications a sensor, no logarithm and no division.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Thermistor {
    /// Coefficients in 2^-22 °C, lowest power first, of the position in the part from 0 to 1/2.
    parts: [[i32; 4]; PARTS],
}

impl Thermistor {
    /// Fits the cubics through four points of each part; `f64`, once.
    #[must_use]
    pub fn new(settings: &settings::Thermistor) -> Self {
        let width = 65536.0 / PARTS as f64;
        Self {
            parts: core::array::from_fn(|part| {
                let at = |third: f64| settings.temperature_c((part as f64 + third / 3.0) * width);
                cubic([at(0.0), at(1.0), at(2.0), at(3.0)])
            }),
        }
    }

    /// Temperature for the sum of 16 12-bit conversions (0..=65520) whose `fine` value, in sixteenths, is free of
    /// the converter's steps.
    ///
    /// Error against the curve below 0.1 mK from -20 to 80 °C (`cargo test --lib thermistor`).
    ///
    /// # Errors
    /// Open or shorted, by the sum itself.
    pub fn temperature(&self, sum: u16, fine: u32) -> Result<Celsius, SensorFault> {
        connected(sum)?;
        let position_bits = u16::BITS + FINE_BITS - PARTS_SHIFT;
        // From 0 to 1/2, in 2^-32.
        let position =
            i64::from(fine & ((1 << position_bits) - 1)) << (u32::BITS - 1 - position_bits);
        // Steps are small beside what lies between the ends of the range and those of its last parts.
        let [constant, rest @ ..] = self.parts[(fine >> position_bits) as usize % PARTS];
        let change = rest.iter().rev().fold(0i32, |sum, &c| {
            ((i64::from(sum.saturating_add(c)) * position) >> 32) as i32
        });
        Ok(Celsius::from_bits(constant.saturating_add(change)))
    }
}

/// The cubic through values in °C at 0, 1/6, 1/3 and 1/2.
fn cubic([a, b, c, d]: [f64; 4]) -> [i32; 4] {
    let powers = [
        a,
        -11.0 * a + 18.0 * b - 9.0 * c + 2.0 * d,
        2.0 * (18.0 * a - 45.0 * b + 36.0 * c - 9.0 * d),
        4.0 * (-9.0 * a + 27.0 * b - 27.0 * c + 9.0 * d),
    ];
    powers.map(|power| Celsius::saturating_from_num(power).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_settings::{Curve, Settings};

    /// Of a sum from a converter without steps.
    fn temperature(thermistor: &Thermistor, sum: u16) -> Result<Celsius, SensorFault> {
        thermistor.temperature(sum, u32::from(sum) << FINE_BITS)
    }

    /// The sum that the divider's ideal converter gives at a temperature, by the beta equation.
    fn sum_at(t_c: f64) -> f64 {
        let r = 10e3 * (3950.0 * (1.0 / (t_c + 273.15) - 1.0 / 298.15)).exp();
        r / (r + 10e3) * 65536.0
    }

    #[test]
    fn thermistor_inverts_the_beta_equation() {
        let thermistor = Thermistor::new(&Settings::default().thermistor);
        for milli in (-20_000..=80_000).step_by(7) {
            let sum = sum_at(f64::from(milli) * 1e-3).round();
            // The temperature of exactly this sum, by the equation solved for T.
            let r = 10e3 * sum / (65536.0 - sum);
            let exact = 1.0 / (1.0 / 298.15 + (r / 10e3).ln() / 3950.0) - 273.15;
            let error = temperature(&thermistor, sum as u16)
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
            let t = temperature(&thermistor, sum)
                .expect("in range")
                .to_num::<f64>();
            assert!((t - t_c).abs() < 0.05, "{t_c}: {t}");
        }
    }

    #[test]
    fn thermistor_range_ends_in_open_and_short() {
        let thermistor = Thermistor::new(&Settings::default().thermistor);
        assert_eq!(temperature(&thermistor, 65520), Err(SensorFault::Open));
        assert_eq!(temperature(&thermistor, 0), Err(SensorFault::Short));
        for t_c in [-40.0, 125.0] {
            assert!(temperature(&thermistor, sum_at(t_c) as u16).is_ok());
        }
        for sum in 0..=65520 {
            let _any_count_has_an_answer = temperature(&thermistor, sum);
        }
    }
}
