//! Thermal dose of the skin.
//!
//! Cumulative equivalent minutes at 43 °C, CEM43 (Sapareto and Dewey 1984): each minute at `T` counts as `R^(43 - T)` minutes,
//! with `R` 0.5 above 43 °C and 0.25 below it; below 39 °C none. The warmer of the display's readings stands for the skin,
//! which is never warmer than the display. Contact is not considered, because the force sensor may be what failed.

use contact_model::fixed_point::{Celsius, exp2};

use super::Fault;
use super::limits::{DOSE_MIN, DOSE_REFERENCE};

/// Ticks between two evaluations of the temperature.
const INTERVAL_TICKS: u16 = 256;
/// Dose that trips: half a minute at 43 °C, in ticks. Skin burns after hundreds of minutes, and may hurt after some.
const LIMIT_TICKS: u32 = 30_000;
/// The sum saturates at twice the limit, so that any sum is forgotten within an hour.
const SUM_MAX: u32 = (2 * LIMIT_TICKS) << 8;
/// Below 39 °C an hour takes about a minute from the dose; as a power of two of the time.
const FORGETTING_SHIFT: u32 = 6;

/// Accumulated thermal dose, which decays while the display is cool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermalDose {
    /// In 2^-8 ticks at 43 °C.
    sum: u32,
    /// Ticks since the last evaluation.
    ticks: u16,
}

impl ThermalDose {
    /// The sum, to be kept through a reset.
    #[must_use]
    pub const fn to_word(&self) -> u32 {
        self.sum
    }

    /// The dose of a sum that was kept.
    #[must_use]
    pub const fn from_word(sum: u32) -> Self {
        Self { sum, ticks: 0 }
    }

    /// Takes one tick; `warmest` gives the warmer of the display's readings, if any is valid.
    ///
    /// # Errors
    /// The dose has reached half a minute at 43 °C.
    pub fn check(&mut self, warmest: impl FnOnce() -> Option<Celsius>) -> Result<(), Fault> {
        const FORGOTTEN: u32 = (INTERVAL_TICKS as u32) << 8 >> FORGETTING_SHIFT;
        self.ticks += 1;
        if self.ticks >= INTERVAL_TICKS {
            self.ticks = 0;
            self.sum = match warmest() {
                None => self.sum,
                Some(warmest) if warmest < DOSE_MIN => self.sum.saturating_sub(FORGOTTEN),
                Some(warmest) => {
                    let dose = rate(warmest).saturating_mul(INTERVAL_TICKS.into());
                    self.sum.saturating_add(dose)
                }
            }
            .min(SUM_MAX);
        }
        if self.sum >> 8 >= LIMIT_TICKS {
            Err(Fault::Dose)
        } else {
            Ok(())
        }
    }
}

/// Equivalent minutes at 43 °C per minute, in 2^-8; 256 at most.
fn rate(t: Celsius) -> u32 {
    let above = t.saturating_sub(DOSE_REFERENCE);
    // Exponent of two with 32 binary places: once or twice the difference.
    let exponent = i64::from(above.to_bits()) << (33 - Celsius::FRAC_NBITS - u32::from(above > 0));
    let whole = (exponent >> 32).clamp(-8, 8);
    let mantissa = (1u64 << 32) + u64::from(exp2(exponent as u32));
    (mantissa >> (24 - whole)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_follow_the_definition() {
        for (t_c, worth) in [
            (43.0, 1.0),
            (44.0, 2.0),
            (45.5, 5.656_85),
            (42.0, 0.25),
            (41.5, 0.125),
            (40.0, 0.015_625),
        ] {
            let rate = f64::from(rate(Celsius::from_num(t_c))) / 256.0;
            assert!((rate - worth).abs() < 1.0 / 256.0, "{t_c} C: {rate}");
        }
    }

    /// Half a minute at 43 °C, two at 42, eight at 41; none below 39.
    #[test]
    fn the_dose_trips_after_half_an_equivalent_minute() {
        for (t_c, seconds) in [(43.0, 30.0), (42.0, 120.0), (41.0, 480.0)] {
            let mut dose = ThermalDose::default();
            let display = Celsius::from_num(t_c);
            let ticks = (1..)
                .find(|_| dose.check(|| Some(display)).is_err())
                .expect("a tick");
            assert!(
                (f64::from(ticks) - 1e3 * seconds).abs() < 300.0,
                "{t_c}: {ticks}"
            );
        }
        let mut dose = ThermalDose::default();
        let cool = Celsius::lit("38.9");
        assert!((0..1_000_000).all(|_| dose.check(|| Some(cool)).is_ok()));
    }

    /// The same holds for a sum in which a bit has flipped.
    #[test]
    fn ten_minutes_at_60_c_are_forgotten_within_an_hour() {
        let mut dose = ThermalDose::default();
        let hot = Celsius::lit("60");
        assert!(
            (0..600_000)
                .filter(|_| dose.check(|| Some(hot)).is_err())
                .count()
                > 0
        );
        for mut dose in [dose, ThermalDose::from_word(u32::MAX)] {
            let cool = Celsius::lit("38.9");
            let forgotten = (0..3_600_000).position(|_| dose.check(|| Some(cool)).is_ok());
            assert!(forgotten.is_some());
        }
    }
}
