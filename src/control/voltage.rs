//! Current to bridge voltage.

use contact_model::fixed_point::Celsius;
use fixed::types::{I1F15, I16F16};

use crate::drive::{Current, Duty};
use crate::settings::Module;

/// The module's electrical side: `V = R I + a (T_sink - T_display) + V_dead`, where `V_dead` is what the bridge loses
/// in its dead times. It opposes the current, and grows with it until its ripple does not reach zero any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Voltage {
    /// Part of the supply per A.
    per_a: I16F16,
    /// Part of the supply per K.
    per_k: I16F16,
    /// Part of the supply lost in dead times, and that per A while the current is small.
    dead: I16F16,
    dead_per_a: I16F16,
}

impl Voltage {
    /// `f64`, once.
    #[must_use]
    pub fn new(module: &Module) -> Self {
        Self {
            per_a: I16F16::saturating_from_num(module.resistance_ohm / module.supply_v),
            per_k: I16F16::saturating_from_num(module.seebeck_v_k / module.supply_v),
            dead: I16F16::saturating_from_num(module.dead_time_v / module.supply_v),
            dead_per_a: I16F16::saturating_from_num(module.dead_time_v / (module.supply_v * module.ripple_a)),
        }
    }

    /// Mean voltage for a current, as a part of the supply.
    #[must_use]
    pub fn duty(&self, current: Current, sink: Celsius, display: Celsius) -> Duty {
        let across = I16F16::saturating_from_num(sink.saturating_sub(display));
        let current = I16F16::from_num(current);
        let resistive = current.saturating_mul(self.per_a);
        let dead = current
            .saturating_mul(self.dead_per_a)
            .clamp(-self.dead, self.dead);
        let voltage = resistive
            .saturating_add(dead)
            .saturating_add(across.saturating_mul(self.per_k));
        Duty::saturating(I1F15::saturating_from_num(voltage))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    fn at(t_c: f64) -> Celsius {
        Celsius::from_num(t_c)
    }

    #[test]
    fn voltage_is_resistive_plus_seebeck_plus_dead_time() {
        let voltage = Voltage::new(&Settings::default().module);
        // All of the dead time's 0.397 V from 0.5 A on, in proportion below.
        for (current_a, dead_v) in [
            (3.0, 0.397),
            (0.25, 0.1985),
            (0.0, 0.0),
            (-0.1, -0.0794),
            (-6.0, -0.397),
        ] {
            let duty = voltage
                .duty(Current::saturating_from_num(current_a), at(30.0), at(20.0))
                .fraction()
                .to_num::<f64>();
            let expected = (current_a * 1.25 + 0.0273 * 10.0 + dead_v) / 12.0;
            assert!((duty - expected).abs() < 3e-4, "{duty}, expected {expected}");
        }
    }
}
