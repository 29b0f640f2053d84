//! Current to bridge voltage.

use contact_model::fixed_point::Celsius;
use fixed::types::I1F15;

use crate::drive::{Current, Duty, SafeCurrent};
use thermal_settings::Module;

/// The module's electrical side: `V = R I + a (T_hot - T_cold) + V_dead`, where `V_dead` is what the bridge loses
/// in its dead times.
///
/// It loses all of `V_dead` while the inductor's current stays with the pulses for the whole period, and nothing
/// while its ripple reaches back far enough to flow against them in every dead time. In between, the loss follows a
/// straight line over half of what a dead time changes the inductor's current by:
///
/// ```text
/// lost = V_dead (I - from) / (dead_time_a / 2), from 0 to V_dead      from = ripple_a w (1 - w) - dead_time_a
/// ```
///
/// for pulses of a part `w` of the period, and a current `I` that counts along them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Voltage {
    /// Part of the supply per A with the legs at 27 °C, and by how much that rises per K above, 2^-28.
    per_a: i32,
    rise_per_k: i32,
    /// Part of the supply per K, 2^-32.
    per_k: i32,
    /// Part of the supply lost in dead times.
    dead: i32,
    ripple_a: i32,
    dead_time_a: i32,
    /// Part of the supply that one more ampere loses on the line between nothing and all.
    dead_per_a: i32,
}

/// Binary places of what does not say otherwise: A, and parts of the supply.
const BITS: u32 = Current::FRAC_NBITS;
const ONE: i32 = 1 << BITS;
/// No line reaches farther from its middle, in parts of the supply: one sixteenth.
const FARTHEST: i32 = ONE >> 4;
/// Of a quotient's divisor.
const DIVISOR_BITS: u32 = 10;

/// Temperatures of the module's legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Legs {
    /// At the display.
    pub cold: Celsius,
    /// At the sink.
    pub hot: Celsius,
    /// On average.
    pub mean: Celsius,
}

impl Legs {
    /// As display and sink have them while little current flows.
    #[must_use]
    pub fn between(display: Celsius, sink: Celsius) -> Self {
        Self {
            cold: display,
            hot: sink,
            mean: (display >> 1u32).saturating_add(sink >> 1u32),
        }
    }
}

/// Resistivity of bismuth telluride, 1/K.
const RESISTIVITY_PER_K: f64 = 0.0049;
const SHEET: Celsius = Celsius::lit("27");

impl Voltage {
    /// `f64`, once.
    #[must_use]
    pub fn new(module: &Module) -> Self {
        let fixed = |value: f64, bits: u32| libm::round(libm::ldexp(value, bits as i32)) as i32;
        let ohm = module.legs_ohm + module.leads_ohm;
        let dead = module.dead_time_v / module.supply_v;
        Self {
            per_a: fixed(ohm / module.supply_v, 28),
            rise_per_k: fixed(module.legs_ohm * RESISTIVITY_PER_K / module.supply_v, 28),
            per_k: fixed(module.seebeck_v_k / module.supply_v, 32),
            dead: fixed(dead, BITS),
            ripple_a: fixed(module.ripple_a, BITS),
            dead_time_a: fixed(module.dead_time_a, BITS),
            dead_per_a: fixed(2.0 * dead / module.dead_time_a, BITS),
        }
    }

    /// Mean voltage for a current, as a part of the supply.
    #[must_use]
    pub fn duty(&self, current: SafeCurrent, legs: &Legs) -> Duty {
        let current = current.ampere();
        let across = legs.hot.saturating_sub(legs.cold).to_bits();
        let warmer = legs.mean.saturating_sub(SHEET).to_bits();
        let rise = times(warmer, self.rise_per_k, Celsius::FRAC_NBITS);
        let needed = times(current.to_bits(), self.per_a.saturating_add(rise), 28)
            .saturating_add(times(across, self.per_k, 32 + Celsius::FRAC_NBITS - BITS));
        let voltage = if needed < 0 {
            needed.saturating_sub(
                self.lost(needed.saturating_neg(), current.to_bits().saturating_neg()),
            )
        } else {
            needed.saturating_add(self.lost(needed, current.to_bits()))
        };
        Duty::saturating(I1F15::saturating_from_num(Current::from_bits(voltage)))
    }

    /// What pulses that shall leave `needed` of the supply have to be wider by: where the line meets the width that it
    /// asks for, to first order around half of the loss.
    fn lost(&self, needed: i32, current: i32) -> i32 {
        let half = self.dead >> 1;
        let middle = needed.saturating_add(half).min(ONE);
        let from = times(self.ripple_a, times(middle, ONE - middle, BITS), BITS) - self.dead_time_a;
        let line = times(current.saturating_sub(from), self.dead_per_a, BITS);
        // A wider pulse has more ripple, which takes back a part of the loss.
        let ripple_per_width = times(self.ripple_a, ONE - 2 * middle, BITS);
        let back = times(ripple_per_width, self.dead_per_a, BITS).max(0);
        let off_middle = line.saturating_sub(half).clamp(-FARTHEST, FARTHEST);
        let steepness = ONE.saturating_add(back) >> (BITS - DIVISOR_BITS);
        (half + (off_middle << DIVISOR_BITS) / steepness)
            .min(self.dead)
            .max(0)
    }
}

/// A product, without so many of its binary places. None here overflows with a module of less than half of the supply
/// per ampere and 64 A of ripple: currents are within ±128 A, temperatures within ±512 K, the rest within the supply.
const fn times(a: i32, b: i32, fewer_bits: u32) -> i32 {
    ((a as i64 * b as i64) >> fewer_bits) as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_settings::Settings;

    /// Legs at 27 °C whose Seebeck voltage is this.
    fn legs(seebeck_v: f64) -> Legs {
        let half = Celsius::saturating_from_num(0.5 * seebeck_v / 0.0273);
        Legs {
            cold: SHEET - half,
            hot: SHEET + half,
            mean: SHEET,
        }
    }

    /// Widths, currents at them, and the voltage lost: corners of the straight lines that the bridge's currents follow,
    /// by hand from its inductor, diodes and dead time, and currents far from them.
    #[test]
    fn pulses_make_up_for_what_the_dead_times_take() {
        let voltage = Voltage::new(&Settings::default().module);
        for (width, current_a, lost_v) in [
            (0.1, 0.214, 0.0),
            (0.1, 0.415, 0.397),
            (0.2, 0.690, 0.0),
            (0.2, 0.891, 0.397),
            (0.3, 1.042, 0.0),
            (0.3, 1.243, 0.397),
            (0.06, -0.011, 0.0),
            (0.06, 0.190, 0.397),
            (0.4, 3.0, 0.397),
            (0.6, 6.0, 0.397),
        ] {
            let seebeck_v = 12.0 * width - lost_v - 1.251 * current_a;
            for sign in [1.0, -1.0] {
                let current = Current::saturating_from_num(sign * current_a);
                let duty = voltage.duty(SafeCurrent::saturating(current), &legs(sign * seebeck_v));
                let error_v = 12.0 * (duty.fraction().to_num::<f64>() - sign * width);
                assert!(error_v.abs() < 0.08, "{width}, {current_a} A: {error_v} V");
            }
        }
    }

    /// Legs 10 K warmer have 4.9 % more resistance.
    #[test]
    fn warm_legs_need_more_voltage() {
        let voltage = Voltage::new(&Settings::default().module);
        let warm = Legs {
            mean: SHEET + Celsius::lit("10"),
            ..legs(0.0)
        };
        let part = |legs| {
            voltage
                .duty(SafeCurrent::saturating(Current::lit("4")), legs)
                .fraction()
                .to_num::<f64>()
        };
        let more_v = 12.0 * (part(&warm) - part(&legs(0.0)));
        assert!((more_v - 4.0 * 1.061 * 0.049).abs() < 2e-3, "{more_v}");
    }
}
