//! The hand: when fingers land and lift, and with which force they press.
//!
//! The force of a touch rises as `F_target (1 - exp(-t/tau))` with a `tau` that grows with the target (section 6.4 shows that
//! large forces are reached later), plus tremor.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};
use thermal_session::ContactRule;

use crate::random::Stream;

/// Time in which a finger lifts, s.
const LIFT_S: f64 = 0.05;
/// Smallest force of a finger that touches, N: its rise begins with it, so that the contact closes at once.
const LEAST_N: f64 = 0.03;
/// Largest shift of a finger's landings against those of the hand, s.
const SHIFT_MAX_S: f64 = 0.1;

/// How a participant moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HandParams {
    /// Median of the force of a touch, N. Subjects of section 3.2 pressed with 1.5 to 2 N.
    pub force_median_n: f64,
    /// Standard deviation of the logarithm of that force, from touch to touch.
    pub force_sigma_ln: f64,
    /// Constant part of the force's time constant, s.
    pub rise_s: f64,
    /// Part that is proportional to the force, s/N.
    pub rise_s_per_n: f64,
    /// Amplitude of the tremor, N.
    pub tremor_n: f64,
    /// Lowest and highest frequency of the tremor, Hz.
    pub tremor_hz: (f64, f64),
    /// Mean and standard deviation of the time from the tone to the landing, s.
    pub reach_s: (f64, f64),
    /// Standard deviation of a finger's landing against the hand's, s.
    pub finger_apart_s: f64,
    /// Shortest and longest touch of a free exploration, s.
    pub touch_s: (f64, f64),
    /// Shortest and longest time between two touches of it, s.
    pub lift_s: (f64, f64),
    /// Time from a tone or an answer to the lift, s.
    pub reaction_s: f64,
    /// Relative standard deviation of a force that follows a target, after it has settled.
    pub follow_sd: f64,
    /// Relative standard deviation of its first error.
    pub follow_first_sd: f64,
    /// Time constant with which the first error shrinks, s.
    pub follow_settle_s: f64,
}

impl HandParams {
    /// Values that the thesis gives or that are typical of it; it reports the force, that touches are repeated, and that large
    /// forces take longer. All others are assumed.
    pub const TYPICAL: Self = Self {
        force_median_n: 1.75,
        force_sigma_ln: 0.25,
        rise_s: 0.1,
        rise_s_per_n: 0.1,
        tremor_n: 0.01,
        tremor_hz: (8.0, 12.0),
        reach_s: (0.7, 0.15),
        finger_apart_s: 0.02,
        touch_s: (1.0, 2.5),
        lift_s: (0.3, 0.8),
        reaction_s: 0.25,
        follow_sd: 0.02,
        follow_first_sd: 0.2,
        follow_settle_s: 0.5,
    };

    /// The same without differences between fingers and touches: all press equally and land together.
    pub const STEADY: Self = Self {
        force_sigma_ln: 0.0,
        tremor_n: 0.0,
        finger_apart_s: 0.0,
        follow_sd: 0.0,
        follow_first_sd: 0.0,
        ..Self::TYPICAL
    };
}

/// Times of the touches of a hand, s since its first landing.
#[derive(Clone, Debug, PartialEq)]
pub struct Touches(Vec<(f64, f64)>);

impl Touches {
    /// Touches that last until `until_s` at least.
    pub fn new(params: &HandParams, rule: ContactRule, until_s: f64, times: &mut Stream) -> Self {
        if rule != ContactRule::Free {
            return Self(vec![(0.0, f64::INFINITY)]);
        }
        let (mut touches, mut start_s) = (Vec::new(), 0.0);
        while start_s < until_s {
            let end_s = start_s + times.between(params.touch_s);
            touches.push((start_s, end_s));
            start_s = end_s + times.between(params.lift_s);
        }
        Self(touches)
    }

    /// Number of touches that begin before a time, s.
    pub fn count_until(&self, until_s: f64) -> usize {
        self.0.iter().filter(|(start_s, _)| *start_s < until_s).count()
    }
}

/// The force of one finger over the touches of its hand.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceCourse {
    presses: Vec<Press>,
    params: HandParams,
    tremor_hz: f64,
    tremor_phase: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Press {
    start_s: f64,
    end_s: f64,
    target_n: f64,
    /// Lasting and first relative errors of a force that follows a target.
    errors: [f64; 2],
}

impl ForceCourse {
    /// The force of a finger; `target_n` is the force that it follows.
    pub fn new(
        params: &HandParams,
        touches: &Touches,
        target_n: Option<f64>,
        random: &mut Stream,
    ) -> Self {
        let shift_s = random.normal_within(0.0, params.finger_apart_s, (-SHIFT_MAX_S, SHIFT_MAX_S));
        let presses = (touches.0.iter())
            .map(|&(start_s, end_s)| {
                let drawn_n = random.log_normal(params.force_median_n, params.force_sigma_ln);
                let errors =
                    [params.follow_sd, params.follow_first_sd].map(|sd| sd * random.normal());
                Press {
                    start_s: (start_s + shift_s).max(0.0),
                    end_s: end_s + shift_s,
                    target_n: target_n.unwrap_or(drawn_n),
                    errors: target_n.map_or([0.0; 2], |_| errors),
                }
            })
            .collect();
        Self {
            presses,
            params: *params,
            tremor_hz: random.between(params.tremor_hz),
            tremor_phase: random.between((0.0, TAU)),
        }
    }

    /// Force, N, at a time since the hand's first landing, s, of a hand that lifts for good at `lift_s`.
    pub fn force_n(&self, t_s: f64, lift_s: f64) -> f64 {
        let press = self.presses.iter().rev().find(|press| press.start_s <= t_s);
        let Some(press) = press.filter(|press| press.start_s < lift_s) else {
            return 0.0;
        };
        let end_s = press.end_s.min(lift_s);
        if t_s < end_s {
            return self.pressed_n(press, t_s);
        }
        let left = 1.0 - (t_s - end_s) / LIFT_S;
        // Tremor is that of a finger that presses.
        left.max(0.0) * self.pressed_n(press, end_s)
    }

    fn pressed_n(&self, press: &Press, t_s: f64) -> f64 {
        let HandParams { rise_s, rise_s_per_n, tremor_n, follow_settle_s, .. } = self.params;
        let since_s = t_s - press.start_s;
        let rise_s = rise_s + rise_s_per_n * press.target_n;
        let risen = -libm::expm1(-since_s / rise_s);
        let [lasting, first] = press.errors;
        let error = lasting + first * libm::exp(-since_s / follow_settle_s);
        let tremor_n = tremor_n * libm::sin(TAU * self.tremor_hz * t_s + self.tremor_phase);
        (press.target_n * risen * (1.0 + error) + risen * tremor_n).max(LEAST_N)
    }
}

#[cfg(test)]
mod tests;
