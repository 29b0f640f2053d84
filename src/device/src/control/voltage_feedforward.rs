//! Feed-forward: the bridge voltage that drives a given current through the module.

use contact_model::fixed_point::{Celsius, product, to_fixed};
use fixed::types::{I0F32, I1F15, I4F28, I8F24};
use thermal_settings::PeltierModule;

use crate::bismuth_telluride::{DATA_SHEET_TEMPERATURE, RESISTIVITY_RISE_PER_K};
use crate::drive::{Current, Duty, SafeCurrent};
use crate::estimate::LegTemperatures;

/// Voltage as a fraction of the bridge's supply voltage; 1 is the whole supply.
type VoltagePerSupply = I8F24;

/// Limit, in either direction, of the difference between the dead-time loss and half of the largest dead-time loss, as
/// a fraction of the supply voltage. It only keeps a division in the computation of the loss within 32 bits; the loss
/// itself is limited afterwards, to between zero and the largest loss.
const OFFSET_FROM_HALF_DEAD_TIME_LOSS_MAX_MAGNITUDE: VoltagePerSupply =
    VoltagePerSupply::lit("0.0625");
/// Fractional bits of the divisor in the computation of the dead-time loss, by which the dividend is also shifted; so
/// few that a 32-bit division is enough.
const DEAD_TIME_LOSS_DIVISOR_FRACTION_BITS: u32 = 10;

/// Computes the bridge's output voltage that drives a current through the module: `V = R I + S (T_hot - T_cold) +
/// lost`, with the resistance `R`, the Seebeck coefficient `S` of the module, the temperatures of the legs' ends, and
/// the voltage `lost` in the dead times of the bridge, in which both switches of a half-bridge are off. A positive
/// current `I` cools.
///
/// All of `V_dead`, the largest loss, is lost while the current in the filter's inductor keeps the direction of the
/// pulses for the whole PWM period, and nothing while the ripple of the inductor's current reverses that current in
/// every dead time. In between, the loss rises linearly with `I`:
///
/// ```text
/// lost = V_dead (I - from) / (dead_time_a / 2), from 0 to V_dead      from = ripple_a w (1 - w) - dead_time_a
/// ```
///
/// A current that the Seebeck voltage drives against the bridge's voltage, as of a display that is warmer than its sink and
/// cools slowly, is opposite to the pulses. The dead times then lengthen the pulses, and even the shortest pulse applies
/// the voltage
///
/// ```text
/// shortest = -min(V_dead, |S (T_hot - T_cold)| k / (R + k))      k = V_dead / (dead_time_a / 2)
/// ```
///
/// because the inductor's current rests at zero for a part of the dead time while `I` is small. No duty cycle gives a
/// voltage between that and zero. Ticks without pulses and ticks with short pulses then take turns, so that their mean is
/// the needed voltage.
///
/// Here `w` is the fraction of the PWM period that a pulse takes, `I` is positive in the direction of the pulses,
/// `dead_time_a` is the change of the inductor's current during one dead time, A, and `ripple_a w (1 - w)` is half of
/// the peak-to-peak ripple of the inductor's current, A.
///
/// No product overflows if 1 A needs less than half of the supply voltage and `ripple_a` is at most 64 A: currents are
/// within ±128 A, temperatures within ±512 °C, and all voltages within the supply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VoltageFeedforward {
    /// Resistance of the legs at 27 °C, the leads and the bridge, divided by the supply voltage, 1/A: voltage per
    /// ampere as a fraction of the supply.
    per_ampere: I4F28,
    /// Rise of the legs' resistance per kelvin of their mean temperature, divided by the supply voltage, 1/(A K).
    rise_per_k: I4F28,
    /// Seebeck voltage per kelvin between the legs' hot and cold ends, as a fraction of the supply voltage, 1/K.
    per_k: I0F32,
    /// Largest voltage that the bridge loses in its dead times, `V_dead`, as a fraction of the supply voltage.
    dead_time: VoltagePerSupply,
    /// Amplitude factor of the inductor's ripple current, A: half of the peak-to-peak ripple is `ripple_a w (1 - w)`
    /// for pulses of a fraction `w` of the PWM period.
    ripple_a: Current,
    /// Change of the current in the inductor of the bridge's output filter during one dead time, A.
    dead_time_a: Current,
    /// Rise of the dead-time loss per ampere of the module's current, in the range of currents in which the loss rises
    /// from zero to its largest value, as a fraction of the supply voltage, 1/A.
    dead_time_per_a: VoltagePerSupply,
    /// Part of the Seebeck voltage that short pulses apply against the current that it drives, `k / (R + k)`, from 0 to 1.
    counter_voltage_ratio: VoltagePerSupply,
    /// Sum of needed minus applied voltage (first-order sigma-delta), per supply voltage; zero while pulses suffice.
    voltage_deficit: VoltagePerSupply,
}

impl VoltageFeedforward {
    /// Converts the electrical settings of the module to fixed point. Computed in floating point, so it is for
    /// start-up, not for the control tick.
    pub fn new(module: &PeltierModule) -> Self {
        let resistance = |ohm: f64| to_fixed(ohm / module.supply_v);
        let dead_time = module.dead_time_v / module.supply_v;
        let dead_time_ohm = 2.0 * module.dead_time_v / module.dead_time_a;
        let path_ohm = module.legs_ohm + module.leads_ohm;
        Self {
            per_ampere: resistance(module.legs_ohm + module.leads_ohm),
            rise_per_k: resistance(module.legs_ohm * RESISTIVITY_RISE_PER_K),
            per_k: to_fixed(module.seebeck_v_k / module.supply_v),
            dead_time: to_fixed(dead_time),
            ripple_a: to_fixed(module.ripple_a),
            dead_time_a: to_fixed(module.dead_time_a),
            dead_time_per_a: to_fixed(2.0 * dead_time / module.dead_time_a),
            counter_voltage_ratio: to_fixed(dead_time_ohm / (dead_time_ohm + path_ohm)),
            voltage_deficit: VoltagePerSupply::ZERO,
        }
    }

    /// Duty cycle of the bridge, positive for cooling, that drives `current` through the module while its legs have the
    /// temperatures `legs`. Sum of resistive voltage, Seebeck voltage and dead-time loss, divided by the supply voltage
    /// and limited to ±0.9. To be called once in each tick that drives the bridge, because ticks with and without pulses
    /// may have to take turns.
    #[must_use]
    pub fn duty_for_current(&mut self, current: SafeCurrent, legs: &LegTemperatures) -> Duty {
        let current = current.ampere();
        let difference: Celsius = legs.hot.saturating_sub(legs.cold);
        let above_data_sheet = legs.mean.saturating_sub(DATA_SHEET_TEMPERATURE);
        let rise = product(above_data_sheet, self.rise_per_k);
        let resistive: VoltagePerSupply = product(current, self.per_ampere.saturating_add(rise));
        let seebeck: VoltagePerSupply = product(difference, self.per_k);
        let needed = resistive.saturating_add(seebeck);
        let opposed = if (needed < 0) == (current < 0) {
            None
        } else {
            self.opposed_voltage(needed, seebeck)
        };
        if opposed.is_none() {
            self.voltage_deficit = VoltagePerSupply::ZERO;
        }
        let voltage = if let Some(opposed) = opposed {
            opposed
        } else if needed < 0 {
            needed.saturating_sub(
                self.dead_time_loss(needed.saturating_neg(), current.saturating_neg()),
            )
        } else {
            needed.saturating_add(self.dead_time_loss(needed, current))
        };
        // By whole words, which takes half the instructions of a conversion that saturates.
        let fraction = voltage
            .max(-VoltagePerSupply::ONE)
            .min(VoltagePerSupply::ONE - VoltagePerSupply::DELTA);
        Duty::saturating(I1F15::from_bits(
            (fraction.to_bits() >> (VoltagePerSupply::FRAC_NBITS - I1F15::FRAC_NBITS)) as i16,
        ))
    }

    /// Voltage to command in this tick, as a fraction of the supply voltage, if `needed` opposes the current and is weaker
    /// than the voltage of the shortest pulses; else `None`. `seebeck` is the Seebeck voltage, which drives the current.
    #[inline(never)]
    fn opposed_voltage(
        &mut self,
        needed: VoltagePerSupply,
        seebeck: VoltagePerSupply,
    ) -> Option<VoltagePerSupply> {
        let magnitude = |voltage: VoltagePerSupply| voltage.max(voltage.saturating_neg());
        let part: VoltagePerSupply = product(magnitude(seebeck), self.counter_voltage_ratio);
        let shortest = part.min(self.dead_time);
        let wanted = magnitude(needed);
        if wanted >= shortest {
            return None;
        }
        self.voltage_deficit = self.voltage_deficit.saturating_add(wanted);
        if self.voltage_deficit <= shortest >> 1u32 {
            return Some(VoltagePerSupply::ZERO);
        }
        self.voltage_deficit = self.voltage_deficit.saturating_sub(shortest);
        // A pulse of half a dead time, which the dead time lengthens to the same voltage as any other pulse so short.
        let pulse = self.dead_time >> 1u32;
        Some(if needed < 0 { -pulse } else { pulse })
    }

    /// Voltage that the bridge loses in its dead times, as a fraction of the supply voltage, from zero to the largest
    /// loss, `V_dead`. The fraction `needed` (0 or more) must remain for the module after the loss. `current`, A, is
    /// positive in the direction of the pulses. The loss makes wider pulses necessary, and wider pulses change the
    /// ripple and thereby the loss; the solution is of first order around half of `V_dead`.
    fn dead_time_loss(&self, needed: VoltagePerSupply, current: Current) -> VoltagePerSupply {
        const FIXED_POINT_ONE: VoltagePerSupply = VoltagePerSupply::ONE;
        let times = product::<VoltagePerSupply, _>;
        let half = self.dead_time >> 1u32;
        let middle = needed.saturating_add(half).min(FIXED_POINT_ONE);
        let from = times(self.ripple_a, times(middle, FIXED_POINT_ONE - middle)) - self.dead_time_a;
        let line = times(current.saturating_sub(from), self.dead_time_per_a);
        // A wider pulse (below half of the period) has more ripple, which reduces the loss.
        let ripple_per_width = times(self.ripple_a, FIXED_POINT_ONE - 2 * middle);
        let feedback = times(ripple_per_width, self.dead_time_per_a).max(VoltagePerSupply::ZERO);
        let offset = line.saturating_sub(half).clamp(
            -OFFSET_FROM_HALF_DEAD_TIME_LOSS_MAX_MAGNITUDE,
            OFFSET_FROM_HALF_DEAD_TIME_LOSS_MAX_MAGNITUDE,
        );
        let divisor = FIXED_POINT_ONE.saturating_add(feedback)
            >> (VoltagePerSupply::FRAC_NBITS - DEAD_TIME_LOSS_DIVISOR_FRACTION_BITS);
        let quotient =
            (offset.to_bits() << DEAD_TIME_LOSS_DIVISOR_FRACTION_BITS) / divisor.to_bits();
        (half + VoltagePerSupply::from_bits(quotient))
            .min(self.dead_time)
            .max(VoltagePerSupply::ZERO)
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

    /// Pulse widths, currents, and the voltage that is lost at them, computed by hand from inductor, diodes and dead
    /// time: corners of the straight lines, and currents far from them.
    #[test]
    fn the_duty_compensates_the_loss_of_the_dead_times() {
        let mut voltage = VoltageFeedforward::new(&Settings::default().module);
        for (width, current_a, lost_v) in [
            (0.1, 0.401, 0.0),
            (0.1, 0.516, 0.212),
            (0.2, 0.888, 0.0),
            (0.2, 1.004, 0.212),
            (0.3, 1.243, 0.0),
            (0.3, 1.358, 0.212),
            (0.06, 0.169, 0.0),
            (0.06, 0.284, 0.212),
            (0.4, 3.0, 0.212),
            (0.6, 6.0, 0.212),
        ] {
            let seebeck_v = 12.0 * width - lost_v - 1.111 * current_a;
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
        let mut voltage = VoltageFeedforward::new(&Settings::default().module);
        let warm =
            LegTemperatures { mean: DATA_SHEET_TEMPERATURE + Celsius::lit("10"), ..legs(0.0) };
        let mut part = |legs| {
            voltage
                .duty_for_current(SafeCurrent::saturating(Current::lit("4")), legs)
                .fraction()
                .to_num::<f64>()
        };
        let more_v = 12.0 * (part(&warm) - part(&legs(0.0)));
        assert!((more_v - 4.0 * 1.061 * 0.049).abs() < 2e-3, "{more_v}");
    }
}
