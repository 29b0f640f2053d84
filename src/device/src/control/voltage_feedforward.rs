//! Feed-forward from current to bridge voltage.

use contact_model::fixed_point::{Celsius, product};
use fixed::types::{I0F32, I1F15, I4F28, I8F24};
use thermal_settings::Module;

use crate::bismuth_telluride::{DATA_SHEET_TEMPERATURE, RESISTIVITY_RISE_PER_K};
use crate::drive::{Current, Duty, SafeCurrent};
use crate::estimate::LegTemperatures;

/// A voltage as a part of the bridge's supply voltage; 1 is all of it.
type SupplyPart = I8F24;

/// Limit of the dead-time loss's distance from half of its largest value, as a part of the supply, on the line between
/// no loss and all of it; keeps the quotient in range.
const LARGEST_OFFSET_FROM_HALF_LOSS: SupplyPart = SupplyPart::lit("0.0625");
/// Binary places to which the divisor is cut, so that a 32-bit division is enough.
const DIVISOR_BINARY_PLACES: u32 = 10;

/// The module's electrical side: `V = R I + a (T_hot - T_cold) + V_dead`, where `V_dead` is what the bridge loses
/// in its dead times.
///
/// It loses all of `V_dead` while the inductor's current keeps the direction of the pulses for the whole period, and nothing
/// while its ripple reverses the current in every dead time. In between, the loss follows a straight line over half of the
/// current change of one dead time:
///
/// ```text
/// lost = V_dead (I - from) / (dead_time_a / 2), from 0 to V_dead      from = ripple_a w (1 - w) - dead_time_a
/// ```
///
/// for pulses of a part `w` of the period, and a current `I` that is positive in their direction.
///
/// No product overflows for a module of less than half of the supply per ampere, and 64 A of ripple: currents are within
/// ±128 A, temperatures within ±512 K, all else within the supply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VoltageFeedforward {
    /// Resistance of legs at 27 °C, leads and bridge, divided by the supply voltage, 1/A.
    per_ampere: I4F28,
    /// Rise of the resistance of the legs with their mean temperature, divided by the supply voltage, 1/(A K).
    rise_per_k: I4F28,
    /// Seebeck voltage per kelvin between the legs' hot and cold ends, as a part of the supply, 1/K.
    per_k: I0F32,
    /// Largest voltage that the bridge loses in its dead times, `V_dead`, as a part of the supply.
    dead_time: SupplyPart,
    /// Half of the inductor's ripple current, A, divided by `w (1 - w)` for pulses of a part `w` of the period.
    ripple_a: Current,
    /// Change of the inductor's current during one dead time, A.
    dead_time_a: Current,
    /// Slope of the loss between none and all of it, as a part of the supply per ampere, 1/A.
    dead_time_per_a: SupplyPart,
}

impl VoltageFeedforward {
    /// Converts the module's electrical settings. Computed in `f64`, so it is for start-up and not for the tick.
    #[must_use]
    pub fn new(module: &Module) -> Self {
        let bits = |value: f64, places: u32| libm::round(libm::ldexp(value, places as i32)) as i32;
        let part = |value: f64| SupplyPart::from_bits(bits(value, SupplyPart::FRAC_NBITS));
        let resistance =
            |ohm: f64| I4F28::from_bits(bits(ohm / module.supply_v, I4F28::FRAC_NBITS));
        let dead_time = module.dead_time_v / module.supply_v;
        Self {
            per_ampere: resistance(module.legs_ohm + module.leads_ohm),
            rise_per_k: resistance(module.legs_ohm * RESISTIVITY_RISE_PER_K),
            per_k: I0F32::from_bits(bits(
                module.seebeck_v_k / module.supply_v,
                I0F32::FRAC_NBITS,
            )),
            dead_time: part(dead_time),
            ripple_a: part(module.ripple_a),
            dead_time_a: part(module.dead_time_a),
            dead_time_per_a: part(2.0 * dead_time / module.dead_time_a),
        }
    }

    /// Duty cycle of the bridge that drives `current` through the module, whose `legs` have these temperatures:
    /// resistive and Seebeck voltage plus what the dead times lose, limited to ±0.9. Positive cools.
    #[must_use]
    pub fn duty_for_current(&self, current: SafeCurrent, legs: &LegTemperatures) -> Duty {
        let current = current.ampere();
        let difference: Celsius = legs.hot.saturating_sub(legs.cold);
        let above_data_sheet = legs.mean.saturating_sub(DATA_SHEET_TEMPERATURE);
        let rise = product(above_data_sheet, self.rise_per_k);
        let resistive: SupplyPart = product(current, self.per_ampere.saturating_add(rise));
        let needed = resistive.saturating_add(product(difference, self.per_k));
        let voltage = if needed < 0 {
            needed.saturating_sub(
                self.dead_time_loss(needed.saturating_neg(), current.saturating_neg()),
            )
        } else {
            needed.saturating_add(self.dead_time_loss(needed, current))
        };
        Duty::saturating(I1F15::saturating_from_num(voltage))
    }

    /// Voltage that the bridge loses in its dead times, as a part of the supply, while its pulses must leave `needed`
    /// (0 or more) after the loss, at `current`, A, along the pulses. The loss widens the pulses, which changes ripple
    /// and loss in turn: solved to first order around half of the largest loss.
    fn dead_time_loss(&self, needed: SupplyPart, current: Current) -> SupplyPart {
        const ONE: SupplyPart = SupplyPart::ONE;
        let times = product::<SupplyPart, _>;
        let half = self.dead_time >> 1u32;
        let middle = needed.saturating_add(half).min(ONE);
        let from = times(self.ripple_a, times(middle, ONE - middle)) - self.dead_time_a;
        let line = times(current.saturating_sub(from), self.dead_time_per_a);
        // A wider pulse has more ripple, which takes back a part of the loss.
        let ripple_per_width = times(self.ripple_a, ONE - 2 * middle);
        let feedback = times(ripple_per_width, self.dead_time_per_a).max(SupplyPart::ZERO);
        let offset = line.saturating_sub(half).clamp(
            -LARGEST_OFFSET_FROM_HALF_LOSS,
            LARGEST_OFFSET_FROM_HALF_LOSS,
        );
        let divisor =
            ONE.saturating_add(feedback) >> (SupplyPart::FRAC_NBITS - DIVISOR_BINARY_PLACES);
        let quotient = (offset.to_bits() << DIVISOR_BINARY_PLACES) / divisor.to_bits();
        (half + SupplyPart::from_bits(quotient))
            .min(self.dead_time)
            .max(SupplyPart::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_settings::Settings;

    /// Legs at 27 °C whose Seebeck voltage is this.
    fn legs(seebeck_v: f64) -> LegTemperatures {
        let half = Celsius::saturating_from_num(0.5 * seebeck_v / 0.0273);
        LegTemperatures {
            cold: DATA_SHEET_TEMPERATURE - half,
            hot: DATA_SHEET_TEMPERATURE + half,
            mean: DATA_SHEET_TEMPERATURE,
        }
    }

    /// Pulse widths, currents, and the voltage that is lost at them, computed by hand from inductor, diodes and dead time:
    /// corners of the straight lines, and currents far from them.
    #[test]
    fn the_duty_compensates_the_loss_of_the_dead_times() {
        let voltage = VoltageFeedforward::new(&Settings::default().module);
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
                let duty = voltage
                    .duty_for_current(SafeCurrent::saturating(current), &legs(sign * seebeck_v));
                let error_v = 12.0 * (duty.fraction().to_num::<f64>() - sign * width);
                assert!(error_v.abs() < 0.08, "{width}, {current_a} A: {error_v} V");
            }
        }
    }

    /// Legs 10 K warmer have 4.9 % more resistance.
    #[test]
    fn warm_legs_need_more_voltage() {
        let voltage = VoltageFeedforward::new(&Settings::default().module);
        let warm = LegTemperatures {
            mean: DATA_SHEET_TEMPERATURE + Celsius::lit("10"),
            ..legs(0.0)
        };
        let part = |legs| {
            voltage
                .duty_for_current(SafeCurrent::saturating(Current::lit("4")), legs)
                .fraction()
                .to_num::<f64>()
        };
        let more_v = 12.0 * (part(&warm) - part(&legs(0.0)));
        assert!((more_v - 4.0 * 1.061 * 0.049).abs() < 2e-3, "{more_v}");
    }
}
