//! Limits of the reference, so that the true surface of the display stays within its limits although thermistors lag behind it.
//!
//! The law `model` knows the lag of a tile that was identified, and passes a set-point by less than 0.1 K. Only a finger that presses
//! less all at once takes the surface further, by 1.5 K with slow thermistors, so with these the range of its set-point is drawn in
//! by a part of that. The laws `pi` and `pi-10hz` see the reading only, and their loop is as slow as its effective dead time: lag, dead time,
//! and half the time between two updates. Therefore their reference approaches the limits of the surface exponentially, with a
//! time constant of several such times; and because a finger that lands or lifts moves the surface before a slow thermistor shows
//! it, the ends of their range are drawn in.
//!
//! A tile that was never identified has an unknown lag, so its reference is limited under every law: it moves slowly, in a range so
//! narrow that what the slowest thermistors hide does not matter.

use contact_model::fixed_point::{Celsius, Fraction, saturating_product, to_fixed};
use thermal_settings::Tile;

use super::Reference;
use crate::TICK_HZ;
use crate::control::Law;
use crate::safety::limits::{
    SETPOINT_MAX_C, SETPOINT_MIN_C, SURFACE_MAX_WITHOUT_FAULT, SURFACE_MIN_WITHOUT_FAULT,
    UNTUNED_RATE_MAX_K_S, UNTUNED_SETPOINT_MAX, UNTUNED_SETPOINT_MIN,
};

/// Time constant with which the reference approaches the warm limit of the surface, in effective dead times. With
/// 6 a step from 24 °C to an end of the range went up to 1.1 K beyond it, with 9 it took half as long again (lags of 0.1 to 0.5 s).
const APPROACH_PER_DEAD_TIME: f64 = 7.0;
/// How much slower the reference falls than it rises, as a power of two: near its limit more current cools less, so the loop is
/// slower there. With equal rates 8 of 400 drawn runs ended below 14 °C, with half the rate none.
const COOLING_SLOWER_LOG2: u32 = 1;
/// Rate, K/s, of the display at its current limit. A reference that moves at least as fast limits nothing: it only winds up the
/// integral of a loop that lags behind it anyway.
const FASTEST_DISPLAY_K_S: f64 = 5.0;
/// Half an update of the law `pi-10hz`, s; the limits are the same for both laws.
const HALF_UPDATE_S: f64 = 0.05;
/// By how much both ends of the range are drawn in under the plain laws, K for each second of effective dead time beyond this one, s.
const DRAWN_IN_K_S: f64 = 4.0;
const DRAWN_IN_FROM_S: f64 = 0.2;
/// The same under the law `model`, at the cold and at the warm end. With 1 K/s at both, 2 of 10 000 drawn runs ended up to 0.22 K below
/// 14 °C, and the warmest at 42.4 °C.
const MODEL_DRAWN_IN_K_S: [f64; 2] = [3.0, 1.0];
/// By how much more the ends are drawn in under the plain laws, K. A finger is warmer than a cold display by twice as much as it is colder than a warm
/// one, and more current cools less, so its landing and its lift disturb more at the cold end.
const COLD_END_K: f64 = 2.0;
const WARM_END_K: f64 = 1.0;

/// Limits of the reference, by the tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceLimits {
    largest_step: LargestStep,
    /// Of an untuned tile under every law, of a tuned one under the plain laws.
    range: SetpointRange,
    /// Under the law `model` of a tuned tile; `None` if it is that of every set-point.
    model_range: Option<SetpointRange>,
}

/// Range of the set-point, °C.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SetpointRange {
    min: Celsius,
    max: Celsius,
}

impl SetpointRange {
    fn nearest(&self, celsius: Celsius) -> Celsius {
        celsius.max(self.min).min(self.max)
    }
}

/// How far the reference moves in a tick at most.
#[derive(Clone, Copy, Debug, PartialEq)]
enum LargestStep {
    /// By so much, K, under every law, because the tile was never identified.
    Untuned(Celsius),
    /// Under the plain laws, by this part of its distance from the limit of the surface; not limited in the range in which that
    /// would be faster than the display.
    Plain { part: Fraction, unlimited: SetpointRange },
}

impl ReferenceLimits {
    const UNTUNED: Self = Self {
        largest_step: LargestStep::Untuned(Celsius::from_bits(
            // Rounded up, so that the fastest ramp that `hold` allows is not limited.
            UNTUNED_RATE_MAX_K_S.to_bits() / TICK_HZ as i32 + 1,
        )),
        range: SetpointRange { min: UNTUNED_SETPOINT_MIN, max: UNTUNED_SETPOINT_MAX },
        model_range: None,
    };

    /// Limits for a tile, in floating point, so not for the tick.
    pub fn new(tile: &Tile) -> Self {
        if !tile.is_identified() {
            return Self::UNTUNED;
        }
        let dead_time_s = tile.sensor_lag_s + tile.dead_time_s + HALF_UPDATE_S;
        let slow_s = (dead_time_s - DRAWN_IN_FROM_S).max(0.0);
        let range = |[cold_k, warm_k]: [f64; 2]| SetpointRange {
            min: to_fixed(SETPOINT_MIN_C + cold_k),
            max: to_fixed(SETPOINT_MAX_C - warm_k),
        };
        let plain_k = [COLD_END_K, WARM_END_K].map(|end_k| end_k + DRAWN_IN_K_S * slow_s);
        let model_k = MODEL_DRAWN_IN_K_S.map(|k_s| k_s * slow_s);
        let approach_s = APPROACH_PER_DEAD_TIME * dead_time_s;
        let warm_k = FASTEST_DISPLAY_K_S * approach_s;
        let cold_k = warm_k * f64::from(1 << COOLING_SLOWER_LOG2);
        Self {
            largest_step: LargestStep::Plain {
                part: to_fixed(1.0 / (approach_s * f64::from(TICK_HZ))),
                unlimited: SetpointRange {
                    min: SURFACE_MIN_WITHOUT_FAULT.saturating_add(to_fixed(cold_k)),
                    max: SURFACE_MAX_WITHOUT_FAULT.saturating_sub(to_fixed(warm_k)),
                },
            },
            range: range(plain_k),
            model_range: (slow_s > 0.0).then(|| range(model_k)),
        }
    }

    /// Whether they are those of a tile that was never identified, which apply to every law.
    pub const fn are_of_untuned_tile(&self) -> bool {
        matches!(self.largest_step, LargestStep::Untuned(_))
    }

    /// Whether the reference of this law is limited.
    pub fn apply_to(&self, law: Law) -> bool {
        law != Law::Model || self.model_range.is_some() || self.are_of_untuned_tile()
    }

    /// The reference that the display follows under a law instead of `wanted`. Under the law `model` of a tuned tile only its range is
    /// limited. Else it lies at most one step from `last`, the reference of the
    /// previous tick. If that tick had none, it starts from the reading of the display's thermistor, °C.
    pub fn limit(
        &self,
        law: Law,
        wanted: Reference,
        last: Option<Reference>,
        reading: Celsius,
    ) -> Reference {
        let wanted_c = wanted.setpoint.celsius();
        if law == Law::Model
            && let Some(range) = self.model_range
        {
            let allowed_c = range.nearest(wanted_c);
            let target_c = range.nearest(wanted.target.celsius());
            return Reference {
                limited: wanted.limited || allowed_c != wanted_c,
                ..Reference::limited_to_safe_range(allowed_c, target_c)
            };
        }
        let last_c = last.map_or(reading, |last| last.setpoint.celsius());
        let allowed_c = self.range.nearest(wanted_c);
        let (next_c, is_limited) = match self.largest_step {
            LargestStep::Untuned(step) => {
                let next_c =
                    allowed_c.max(last_c.saturating_sub(step)).min(last_c.saturating_add(step));
                (next_c, next_c != wanted_c)
            }
            LargestStep::Plain { part, unlimited } => {
                let step = |distance: Celsius| -> Celsius {
                    saturating_product(distance.max(Celsius::ZERO), part)
                };
                let up = step(SURFACE_MAX_WITHOUT_FAULT.saturating_sub(last_c));
                let down =
                    step(last_c.saturating_sub(SURFACE_MIN_WITHOUT_FAULT)) >> COOLING_SLOWER_LOG2;
                let lowest_c = last_c.saturating_sub(down).min(unlimited.min);
                let highest_c = last_c.saturating_add(up).max(unlimited.max);
                // A plain law lags behind its set-point anyway, so only the range is reported.
                (allowed_c.max(lowest_c).min(highest_c), allowed_c != wanted_c)
            }
        };
        Reference { limited: wanted.limited || is_limited, ..Reference::at(next_c) }
    }
}

#[cfg(test)]
mod tests;
