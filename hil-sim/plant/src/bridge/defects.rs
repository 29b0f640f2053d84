//! What can be broken in the power stage.

use super::{Leg, Legs};

/// What is broken in one leg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LegDefect {
    /// Nothing.
    #[default]
    Sound,
    /// Stays at the supply.
    High,
    /// Stays at ground.
    Low,
    /// High-impedance.
    Open,
    /// Its output is shorted to ground: the driver trips when it drives it high.
    Shorted,
}

impl LegDefect {
    fn of(self, leg: Leg) -> Leg {
        match (self, leg) {
            (Self::High, _) => Leg::Duty(1.0),
            (Self::Low, _) => Leg::Duty(0.0),
            (Self::Open, _) => Leg::Off,
            (Self::Shorted, Leg::Duty(duty)) if duty > 0.0 => Leg::Shorted,
            (Self::Shorted | Self::Sound, leg) => leg,
        }
    }
}

/// What is broken in a bridge and its wiring; by default nothing.
///
/// A leg that is stuck needs the other one to drive a current, and that is high-impedance while the driver is not
/// enabled: enable low ends the current whatever the legs do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BridgeDefects {
    /// Leg a.
    pub a: LegDefect,
    /// Leg b.
    pub b: LegDefect,
    /// The driver is enabled whatever the enable line says; then legs drive as their PWM has them.
    pub enable_stuck: bool,
    /// The tile's wires are swapped.
    pub swapped: bool,
    /// Supply, V, instead of the one it should have.
    pub supply_v: Option<f64>,
    /// nFAULT never goes low, whoever pulls it.
    pub fault_pin_dead: bool,
}

impl BridgeDefects {
    /// What becomes of the legs.
    #[must_use]
    pub fn legs(&self, legs: &Legs) -> Legs {
        let (a, b) = (self.a.of(legs.a), self.b.of(legs.b));
        let (a, b) = if self.swapped { (b, a) } else { (a, b) };
        Legs {
            a,
            b,
            enabled: legs.enabled || self.enable_stuck,
        }
    }
}
