//! Conversion of the thermistors' sums to temperatures, and detection of open and shorted thermistors.

use contact_model::fixed_point::{Celsius, product, to_fixed};
use fixed::types::I0F32;

use super::calibration_tables::CorrectedSum;
use thermal_settings as settings;

/// Smallest valid sum of 16 conversions of a thermistor: 40 of 4095 counts a conversion. Below it the thermistor counts
/// as shorted. A 10 kΩ thermistor with a beta of 3950 K and a 10 kΩ pull-up gives 40 counts at 185 °C.
const SHORT_BELOW_SUM: u16 = 40 * 16;
/// Largest valid sum of 16 conversions of a thermistor: 4060 of 4095 counts a conversion. Above it the thermistor
/// counts as open. A 10 kΩ thermistor with a beta of 3950 K and a 10 kΩ pull-up gives 4060 counts at -53 °C.
const OPEN_ABOVE_SUM: u16 = 4060 * 16;

/// Smallest 12-bit code of one conversion of a connected thermistor.
pub(super) const SMALLEST_CONNECTED_CODE: u16 = SHORT_BELOW_SUM / 16;
/// Largest 12-bit code of one conversion of a connected thermistor.
pub(super) const LARGEST_CONNECTED_CODE: u16 = OPEN_ABOVE_SUM / 16;

/// Whether the 12-bit code of one conversion is that of a shorted thermistor (below 40) or of an open one (above 4060).
pub(super) const fn is_open_or_short_code(code: u16) -> bool {
    code.wrapping_sub(SMALLEST_CONNECTED_CODE) > LARGEST_CONNECTED_CODE - SMALLEST_CONNECTED_CODE
}

/// Checks that a thermistor's sum of 16 conversions is that of a connected thermistor: 40 to 4060 counts a conversion.
///
/// # Errors
/// [`ThermistorFault::Short`] if `sum` is below this range, [`ThermistorFault::Open`] if it is above; the station then
/// trips.
pub(super) const fn check_wiring(sum: u16) -> Result<(), ThermistorFault> {
    // One comparison for a thermistor that is connected.
    if sum.wrapping_sub(SHORT_BELOW_SUM) <= OPEN_ABOVE_SUM - SHORT_BELOW_SUM {
        Ok(())
    } else if sum < SHORT_BELOW_SUM {
        Err(ThermistorFault::Short)
    } else {
        Err(ThermistorFault::Open)
    }
}

/// Number of equal intervals into which the range of sums (0 to 65535) is divided, as a power of two: 2^6. In each
/// interval a cubic of its own approximates the thermistors' curve.
const CURVE_INTERVAL_COUNT_LOG2: u32 = 6;
/// Number of equal intervals, 64, into which the range of sums (0 to 65535) is divided. In each interval a cubic of its
/// own approximates the thermistors' curve.
const CURVE_INTERVAL_COUNT: usize = 1 << CURVE_INTERVAL_COUNT_LOG2;

/// Why a thermistor gives no temperature. The station then trips with a fault that names the thermistor and this
/// reason; if all five thermistors are shorted, the fault is [`Excitation`](crate::safety::Fault::Excitation).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThermistorFault {
    /// The thermistor or its wire is broken: no current flows, so the converter reads the upper end of its range, above
    /// 4060 of 4095 counts.
    Open,
    /// The thermistor or its wires are shorted: no voltage drops across the thermistor, so the converter reads the
    /// lower end of its range, below 40 of 4095 counts.
    Short,
}

/// The curve from a thermistor's sum to its temperature: one cubic for each of 64 equal intervals of the sum. A tick
/// needs three multiplications per thermistor, but no logarithm and no division, whatever the thermistors' curve is.
/// All five thermistors share this table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ThermistorTable {
    /// Coefficients of the cubic of each interval, °C, lowest power first. The variable of a cubic is the position in
    /// its interval, from 0 at the lower end to 1/2 at the upper one: the positive range of [`I0F32`].
    cubics: [[Celsius; 4]; CURVE_INTERVAL_COUNT],
}

impl ThermistorTable {
    /// Computes each cubic from four points of the thermistors' curve. Computes in `f64`, so it is for start-up and not
    /// for the control tick.
    pub fn new(settings: &settings::ThermistorDivider) -> Self {
        let width = 65536.0 / CURVE_INTERVAL_COUNT as f64;
        Self {
            cubics: core::array::from_fn(|interval| {
                let at =
                    |third: f64| settings.temperature_c((interval as f64 + third / 3.0) * width);
                cubic_through([at(0.0), at(1.0), at(2.0), at(3.0)])
            }),
        }
    }

    /// Temperature, °C, of a thermistor by its nominal curve, without the thermistor's own correction. `sum` is the sum
    /// of 16 conversions of 12 bits, 0 to 65520; `corrected` is this sum minus the converter's error. The table
    /// deviates from the curve by less than 0.1 mK from -20 to 80 °C (test
    /// `the_table_inverts_the_beta_equation_within_0_1_mk`).
    ///
    /// # Errors
    /// [`ThermistorFault::Short`] if `sum` is below 40 counts a conversion, [`ThermistorFault::Open`] if it is above
    /// 4060 counts a conversion.
    pub fn temperature_of_sum(
        &self,
        sum: u16,
        corrected: CorrectedSum,
    ) -> Result<Celsius, ThermistorFault> {
        check_wiring(sum)?;
        let position_bits = u16::BITS + CorrectedSum::FRAC_NBITS - CURVE_INTERVAL_COUNT_LOG2;
        let units = corrected.to_bits();
        let within = units & ((1 << position_bits) - 1);
        // Position in the interval, from 0 to 1/2.
        let position = I0F32::from_bits((within << (u32::BITS - 1 - position_bits)) as i32);
        let [constant, others @ ..] =
            self.cubics[(units >> position_bits) as usize % CURVE_INTERVAL_COUNT];
        let mut change = Celsius::ZERO;
        for &coefficient in others.iter().rev() {
            change = product(change.saturating_add(coefficient), position);
        }
        Ok(constant.saturating_add(change))
    }
}

/// Coefficients, °C, lowest power first, of the cubic that has the four given values, °C, at the positions 0, 1/6, 1/3
/// and 1/2.
#[inline(never)]
fn cubic_through([a, b, c, d]: [f64; 4]) -> [Celsius; 4] {
    [
        a,
        -11.0 * a + 18.0 * b - 9.0 * c + 2.0 * d,
        2.0 * (18.0 * a - 45.0 * b + 36.0 * c - 9.0 * d),
        4.0 * (-9.0 * a + 27.0 * b - 27.0 * c + 9.0 * d),
    ]
    .map(to_fixed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_settings::{Settings, ThermistorCurve};

    /// Temperature of a sum from a converter without error.
    fn temperature(table: &ThermistorTable, sum: u16) -> Result<Celsius, ThermistorFault> {
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
            let error = temperature(&table, sum as u16).expect("in range").to_num::<f64>() - exact;
            assert!(error.abs() < 1e-4, "{exact}: {error:e}");
        }
    }

    /// A published set of coefficients of a 10 k thermistor: 25 °C at 10 kohm, 0 °C at 32.65 kohm, 50 °C at 3.603 kohm.
    #[test]
    fn the_table_agrees_with_a_published_steinhart_hart_thermistor() {
        let curve =
            ThermistorCurve::SteinhartHart { a: 1.129_148e-3, b: 2.341_25e-4, c: 8.767_41e-8 };
        let table = ThermistorTable::new(&settings::ThermistorDivider { pull_up_ohm: 10e3, curve });
        for (t_c, ohm) in [(0.0, 32_650.0), (25.0, 10_000.0), (50.0, 3_603.0)] {
            let sum = (ohm / (ohm + 10e3) * 65536.0f64).round() as u16;
            let t = temperature(&table, sum).expect("in range").to_num::<f64>();
            assert!((t - t_c).abs() < 0.05, "{t_c}: {t}");
        }
    }

    #[test]
    fn sums_at_the_ends_of_the_range_are_open_and_short_circuits() {
        let table = ThermistorTable::new(&Settings::default().thermistor);
        assert_eq!(temperature(&table, 65520), Err(ThermistorFault::Open));
        assert_eq!(temperature(&table, 0), Err(ThermistorFault::Short));
        for t_c in [-40.0, 125.0] {
            assert!(temperature(&table, sum_at(t_c) as u16).is_ok());
        }
        for sum in 0..=65520 {
            let _no_sum_panics = temperature(&table, sum);
        }
    }
}
