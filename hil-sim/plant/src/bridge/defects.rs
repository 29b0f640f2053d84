//! Defects of the power stage.

use super::{BridgeOutputs, Leg};

/// Defect of one leg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LegDefect {
    /// No defect.
    #[default]
    None,
    /// Output stuck at the supply.
    High,
    /// Output stuck at ground.
    Low,
    /// High-impedance.
    Open,
    /// Its output is shorted to ground: the driver trips when it drives it high, in the pulses of one direction.
    Shorted,
}

impl LegDefect {
    fn apply(self, leg: Leg) -> Leg {
        match (self, leg) {
            (Self::High, _) => Leg::Duty(1.0),
            (Self::Low, _) => Leg::Duty(0.0),
            (Self::Open, _) => Leg::Off,
            (Self::Shorted, Leg::Duty(duty)) if duty > 0.0 => Leg::Shorted,
            (Self::Shorted | Self::None, leg) => leg,
        }
    }
}

/// What is connected to the output of a bridge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Output {
    /// The tile.
    #[default]
    Tile,
    /// Nothing.
    Open,
    /// A resistor of so many ohm.
    Resistor(f64),
}

/// Defects of a bridge and its wiring; none by default.
///
/// A single stuck leg drives no current while the enable line is low, since the other leg is then high-impedance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BridgeDefects {
    /// Leg a.
    pub a: LegDefect,
    /// Leg b.
    pub b: LegDefect,
    /// The driver ignores the enable line and follows the PWM.
    pub enable_stuck: bool,
    /// The tile's wires are swapped.
    pub swapped: bool,
    /// Supply voltage instead of the nominal one, V.
    pub supply_v: Option<f64>,
    /// What is connected to its output.
    pub output: Output,
    /// nFAULT stays high although driver or comparator pull it low.
    pub fault_pin_dead: bool,
}

impl BridgeDefects {
    /// Legs of the defective bridge for its inputs.
    pub fn apply(&self, legs: &BridgeOutputs) -> BridgeOutputs {
        let (a, b) = if self.a == LegDefect::None && self.b == LegDefect::None {
            (legs.a, legs.b)
        } else {
            let (a, b) = legs.leg_levels();
            match (self.a.apply(a), self.b.apply(b)) {
                // Both legs low drive nothing, as both legs high do. Two duties of 0 would mean inputs that are low, which make
                // the legs high-impedance.
                (Leg::Duty(0.0), Leg::Duty(0.0)) => (Leg::Duty(1.0), Leg::Duty(1.0)),
                legs => legs,
            }
        };
        let (a, b) = if self.swapped { (b, a) } else { (a, b) };
        BridgeOutputs { a, b, enabled: legs.enabled || self.enable_stuck }
    }
}
