//! Thermistor sums to temperature.

use contact_model::fixed_point::{Celsius, product};
use fixed::types::I0F32;

use super::correction::CorrectedSum;
use thermal_settings as settings;

/// Sum of 16 conversions below which a thermistor counts as shorted: 40 counts, above 125 °C of a 10 kΩ thermistor with
/// a beta of 3950 K under 10 kΩ.
const SHORT_BELOW: u16 = 40 * 16;
/// Sum of 16 conversions above which a thermistor counts as open: 4060 of 4095 counts, below -40 °C of a 10 kΩ
/// thermistor with a beta of 3950 K under 10 kΩ.
const OPEN_ABOVE: u16 = 4060 * 16;

/// Whether the 12-bit code of one conversion is that of a shorted or open thermistor.
pub(super) const fn is_code_out_of_range(code: u16) -> bool {
    code < SHORT_BELOW / 16 || code > OPEN_ABOVE / 16
}

/// Checks that the sum of 16 conversions is within the range of a connected thermistor.
///
/// # Errors
/// The thermistor is open or shorted; the station then trips.
pub(super) const fn check_wiring(sum: u16) -> Result<(), SensorFault> {
    match sum {
        ..SHORT_BELOW => Err(SensorFault::Short),
        SHORT_BELOW..=OPEN_ABOVE => Ok(()),
        _ => Err(SensorFault::Open),
    }
}

/// Number of equal intervals of the range of sums, as a power of two; each has a cubic of its own.
const CURVE_INTERVALS_LOG2: u32 = 6;
/// Number of equal intervals of the range of sums: 64.
const CURVE_INTERVALS: usize = 1 << CURVE_INTERVALS_LOG2;

/// Why a thermistor has no temperature; the station trips with a fault that names thermistor and reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorFault {
    /// The wire or the thermistor is broken: no current flows, so the converter reads its upper end.
    Open,
    /// The wires or the thermistor are shorted: no voltage drops, so the converter reads its lower end.
    Short,
}

/// The curve from sum to temperature as one cubic for each of 64 equal intervals: a tick pays three multiplications a
/// sensor, no logarithm and no division, whatever the thermistor's curve. All five thermistors share it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ThermistorTable {
    /// Coefficients in °C, lowest power first, of the position in the interval, which runs from 0 to 1/2.
    cubics: [[Celsius; 4]; CURVE_INTERVALS],
}

impl ThermistorTable {
    /// Fits each cubic through four points of the thermistor's curve, in `f64`, so it is for start-up and not for the
    /// tick.
    #[must_use]
    pub fn new(settings: &settings::ThermistorDivider) -> Self {
        let width = 65536.0 / CURVE_INTERVALS as f64;
        Self {
            cubics: core::array::from_fn(|interval| {
                let at =
                    |third: f64| settings.temperature_c((interval as f64 + third / 3.0) * width);
                cubic_through([at(0.0), at(1.0), at(2.0), at(3.0)])
            }),
        }
    }

    /// Temperature, °C, for the sum of 16 conversions of 12 bits (0 to 65520), which is also given corrected for the
    /// converter's error. The error against the thermistor's curve is below 0.1 mK from -20 to 80 °C (test
    /// `the_table_inverts_the_beta_equation_within_0_1_mk`).
    ///
    /// # Errors
    /// The thermistor is open or shorted, by the uncorrected sum.
    pub fn temperature_of_sum(
        &self,
        sum: u16,
        corrected: CorrectedSum,
    ) -> Result<Celsius, SensorFault> {
        check_wiring(sum)?;
        let position_bits = u16::BITS + CorrectedSum::FRAC_NBITS - CURVE_INTERVALS_LOG2;
        let units = corrected.to_bits();
        let within = units & ((1 << position_bits) - 1);
        // From 0 to 1/2.
        let position = I0F32::from_bits((within << (u32::BITS - 1 - position_bits)) as i32);
        let [constant, others @ ..] =
            self.cubics[(units >> position_bits) as usize % CURVE_INTERVALS];
        let mut change = Celsius::ZERO;
        for &coefficient in others.iter().rev() {
            change = product(change.saturating_add(coefficient), position);
        }
        Ok(constant.saturating_add(change))
    }
}

/// Coefficients in °C, lowest power first, of the cubic through the values, °C, at 0, 1/6, 1/3 and 1/2.
fn cubic_through([a, b, c, d]: [f64; 4]) -> [Celsius; 4] {
    [
        a,
        -11.0 * a + 18.0 * b - 9.0 * c + 2.0 * d,
        2.0 * (18.0 * a - 45.0 * b + 36.0 * c - 9.0 * d),
        4.0 * (-9.0 * a + 27.0 * b - 27.0 * c + 9.0 * d),
    ]
    .map(Celsius::saturating_from_num)
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_settings::{Curve, Settings};

    /// Temperature of a sum from a converter without error.
    fn temperature(table: &ThermistorTable, sum: u16) -> Result<Celsius, SensorFault> {
        table.temperature_of_sum(sum, CorrectedSum::from(sum))
    }

    /// The sum that the divider's ideal converter gives at a temperature, by the beta equation.
    fn sum_at(t_c: f64) -> f64 {
        let r = 10e3 * (3950.0 * (1.0 / (t_c + 273.15) - 1.0 / 298.15)).exp();
        r / (r + 10e3) * 65536.0
    }

    #[test]
    fn the_table_inverts_the_beta_equation_within_0_1_mk() {
        let table = ThermistorTable::new(&Settings::default().thermistor);
        for milli in (-20_000..=80_000).step_by(7) {
            let sum = sum_at(f64::from(milli) * 1e-3).round();
            // The temperature of exactly this sum, by the equation solved for T.
            let r = 10e3 * sum / (65536.0 - sum);
            let exact = 1.0 / (1.0 / 298.15 + (r / 10e3).ln() / 3950.0) - 273.15;
            let error = temperature(&table, sum as u16)
                .expect("in range")
                .to_num::<f64>()
                - exact;
            assert!(error.abs() < 1e-4, "{exact}: {error:e}");
        }
    }

    /// A published set of coefficients of a 10 k thermistor: 25 °C at 10 kohm, 0 °C at 32.65 kohm, 50 °C at 3.603 kohm.
    #[test]
    fn the_table_agrees_with_a_published_steinhart_hart_thermistor() {
        let curve = Curve::SteinhartHart {
            a: 1.129_148e-3,
            b: 2.341_25e-4,
            c: 8.767_41e-8,
        };
        let table = ThermistorTable::new(&settings::ThermistorDivider {
            pull_up_ohm: 10e3,
            curve,
        });
        for (t_c, ohm) in [(0.0, 32_650.0), (25.0, 10_000.0), (50.0, 3_603.0)] {
            let sum = (ohm / (ohm + 10e3) * 65536.0f64).round() as u16;
            let t = temperature(&table, sum).expect("in range").to_num::<f64>();
            assert!((t - t_c).abs() < 0.05, "{t_c}: {t}");
        }
    }

    #[test]
    fn sums_at_the_ends_of_the_range_are_open_and_short_circuits() {
        let table = ThermistorTable::new(&Settings::default().thermistor);
        assert_eq!(temperature(&table, 65520), Err(SensorFault::Open));
        assert_eq!(temperature(&table, 0), Err(SensorFault::Short));
        for t_c in [-40.0, 125.0] {
            assert!(temperature(&table, sum_at(t_c) as u16).is_ok());
        }
        for sum in 0..=65520 {
            let _no_sum_panics = temperature(&table, sum);
        }
    }
}
