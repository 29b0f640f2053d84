//! Thermal dose of the skin.
//!
//! Cumulative equivalent minutes at 43 °C, CEM43 (Sapareto and Dewey 1984): each minute at `T` counts as `R^(43 - T)`
//! minutes, with `R` 0.5 above 43 °C and 0.25 below it; below 39 °C none. The warmer of the display's readings stands
//! for the skin, which is never warmer than the display. Contact is not considered, because the force sensor may be
//! what failed.

use contact_model::fixed_point::{Celsius, exp2};

use super::Fault;
use super::limits::{DOSE_COUNTED_FROM, DOSE_REFERENCE_TEMPERATURE};

/// Ticks of 1 ms from one evaluation of the display's temperature to the next; the dose of the whole interval is
/// computed from the temperature at its end.
const DOSE_EVALUATION_INTERVAL_TICKS: u16 = 256;
/// Thermal dose at which the station trips by [`Fault::Dose`], in ticks of 1 ms at 43 °C: 30 s. This is far below the
/// dose that burns skin, hundreds of minutes at 43 °C, and below the few minutes that may hurt.
const DOSE_LIMIT_TICKS: u32 = 30_000;
/// Upper limit of the stored dose, in units of 2^-8 ticks of 1 ms at 43 °C: twice the trip limit. Thus after a long
/// time above the limit, or after a bit error in the stored dose, 32 minutes below 39 °C are enough to bring it back to
/// the trip limit.
const ACCUMULATED_DOSE_CLAMP: u32 = (2 * DOSE_LIMIT_TICKS) << 8;
/// Decay of the dose below 39 °C, as a right shift of the elapsed time: 6 subtracts 1/64 of it, about one minute per
/// hour.
const DOSE_DECAY_ELAPSED_TIME_SHIFT: u32 = 6;

/// Thermal dose (CEM43) that skin would have received if it had always touched the display: the time at 39 °C and
/// above, weighted by temperature, with slow decay below 39 °C. The station trips by [`Fault::Dose`] when the dose
/// reaches the equivalent of 30 s at 43 °C.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThermalDose {
    /// The dose, in units of 2^-8 ticks of 1 ms at 43 °C; at most [`ACCUMULATED_DOSE_CLAMP`] after each evaluation.
    sum: u32,
    /// Ticks of 1 ms since the display's temperature was last evaluated, 0 to 255. At [`DOSE_EVALUATION_INTERVAL_TICKS`] (256) the
    /// temperature is evaluated again, and this count restarts at 0.
    ticks: u16,
}

/// Thermal dose that something would give, in the units of [`ThermalDose`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PredictedDose(u32);

impl PredictedDose {
    /// Smallest dose that trips, ms at 43 °C.
    pub const LIMIT_MS: u32 = DOSE_LIMIT_TICKS;

    /// A dose in units of 2^-8 ms at 43 °C.
    pub const fn from_sum(sum: u32) -> Self {
        Self(sum)
    }

    /// This dose several times, on top of one that was taken before.
    pub const fn repeated_on_top_of(self, times: u16, before: &ThermalDose) -> Self {
        Self(self.0.saturating_mul(times as u32).saturating_add(before.sum))
    }

    /// Whether the station would trip by [`Fault::Dose`].
    pub const fn reaches_limit(self) -> bool {
        self.milliseconds_at_43() >= DOSE_LIMIT_TICKS
    }

    /// The dose, ms at 43 °C.
    pub const fn milliseconds_at_43(self) -> u32 {
        self.0 >> 8
    }
}

impl ThermalDose {
    /// Time below 39 °C in which a dose decays, over the time at 43 °C to which it is equivalent.
    pub const DECAY_TIME_RATIO: u32 = 1 << DOSE_DECAY_ELAPSED_TIME_SHIFT;

    /// The dose in units of 2^-8 ms at 43 °C, as one 32-bit word, in which the board keeps it in RAM through a reset.
    pub const fn to_retained_word(&self) -> u32 {
        self.sum
    }

    /// The dose from the word that [`to_retained_word`](Self::to_retained_word) returned before a reset; any word is accepted, because
    /// the next evaluation limits the dose.
    pub const fn from_any_retained_word(sum: u32) -> Self {
        Self { sum, ticks: 0 }
    }

    /// Counts one tick of 1 ms. Every 256th tick, `warmest` is called for the higher reading of the two display
    /// thermistors, °C, and the dose of the interval is added at that temperature (below 39 °C the dose decays
    /// instead). If `warmest` returns `None`, because no reading is valid, the dose stays.
    ///
    /// # Errors
    /// [`Fault::Dose`]: the dose has reached 30 s at 43 °C; returned in every tick while that holds.
    pub fn count_tick_and_evaluate_if_due(
        &mut self,
        warmest: impl FnOnce() -> Option<Celsius>,
    ) -> Result<(), Fault> {
        const DECAY_PER_INTERVAL: u32 =
            (DOSE_EVALUATION_INTERVAL_TICKS as u32) << 8 >> DOSE_DECAY_ELAPSED_TIME_SHIFT;
        self.ticks += 1;
        if self.ticks >= DOSE_EVALUATION_INTERVAL_TICKS {
            self.ticks = 0;
            self.sum = match warmest() {
                None => self.sum,
                Some(warmest) if warmest < DOSE_COUNTED_FROM => {
                    self.sum.saturating_sub(DECAY_PER_INTERVAL)
                }
                Some(warmest) => {
                    let dose =
                        cem43_weight(warmest).saturating_mul(DOSE_EVALUATION_INTERVAL_TICKS.into());
                    self.sum.saturating_add(dose)
                }
            }
            .min(ACCUMULATED_DOSE_CLAMP);
        }
        if self.sum >> 8 >= DOSE_LIMIT_TICKS { Err(Fault::Dose) } else { Ok(()) }
    }
}

/// Weight of one minute at the temperature `t`, °C, in the thermal dose (equivalent minutes at 43 °C), in units of
/// 2^-8: 1 at 39 °C, 256 at 43 °C, doubled by each kelvin above 43 °C and quartered by each kelvin below it, always
/// below 2^17. Called for 39 °C and above.
fn cem43_weight(t: Celsius) -> u32 {
    let above = t.saturating_sub(DOSE_REFERENCE_TEMPERATURE);
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
            let rate = f64::from(cem43_weight(Celsius::from_num(t_c))) / 256.0;
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
                .find(|_| dose.count_tick_and_evaluate_if_due(|| Some(display)).is_err())
                .expect("a tick");
            assert!((f64::from(ticks) - 1e3 * seconds).abs() < 300.0, "{t_c}: {ticks}");
        }
        let mut dose = ThermalDose::default();
        let cool = Celsius::lit("38.9");
        assert!((0..1_000_000).all(|_| dose.count_tick_and_evaluate_if_due(|| Some(cool)).is_ok()));
    }

    /// The same holds for a sum in which a bit has flipped.
    #[test]
    fn ten_minutes_at_60_c_are_forgotten_within_an_hour() {
        let mut dose = ThermalDose::default();
        let hot = Celsius::lit("60");
        assert!(
            (0..600_000)
                .filter(|_| dose.count_tick_and_evaluate_if_due(|| Some(hot)).is_err())
                .count()
                > 0
        );
        for mut dose in [dose, ThermalDose::from_any_retained_word(u32::MAX)] {
            let cool = Celsius::lit("38.9");
            let forgotten = (0..3_600_000)
                .position(|_| dose.count_tick_and_evaluate_if_due(|| Some(cool)).is_ok());
            assert!(forgotten.is_some());
        }
    }
}
