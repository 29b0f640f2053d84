//! The bridge that drives the tile, behind its LC filter.

/// One leg of the bridge over one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Leg {
    /// High-impedance.
    #[default]
    Off,
    /// Switches between ground and supply; the fraction of time at the supply, 0 to 1 (taken as the nearer end
    /// outside of it).
    Duty(f64),
}

/// The legs of one bridge; a current from leg `a` to leg `b` cools the display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Legs {
    /// The tile's positive terminal.
    pub a: Leg,
    /// The tile's negative terminal.
    pub b: Leg,
    /// The driver's enable pin; low makes both legs high-impedance.
    pub enabled: bool,
}

/// The tile as the bridge sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Voltage that opposes a cooling current, V.
    pub seebeck_v: f64,
    /// Resistance, ohm.
    pub resistance_ohm: f64,
}

/// Current through the tile; positive cools the display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Current {
    /// Mean, A.
    pub mean_a: f64,
    /// Mean square of the ripple around it, A2.
    pub ripple_a2: f64,
}

/// The power stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bridge {
    /// Supply, V.
    pub supply_v: f64,
}

impl Bridge {
    /// The reference design's.
    pub const NOMINAL: Self = Self { supply_v: 12.0 };

    /// Current through the load.
    pub fn current(&mut self, legs: &Legs, load: &Load) -> Current {
        Current {
            mean_a: self
                .mean_v(legs)
                .map_or(0.0, |v| (v - load.seebeck_v) / load.resistance_ohm),
            ripple_a2: 0.0,
        }
    }

    /// Mean voltage at the tile, V. With a leg high-impedance no current has a way round (`None`): the tile's
    /// Seebeck voltage stays far below what would open the driver's diodes.
    #[must_use]
    pub fn mean_v(&self, legs: &Legs) -> Option<f64> {
        match (legs.enabled, legs.a, legs.b) {
            (true, Leg::Duty(a), Leg::Duty(b)) => {
                Some(self.supply_v * (a.clamp(0.0, 1.0) - b.clamp(0.0, 1.0)))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_v(a: Leg, b: Leg, enabled: bool) -> Option<f64> {
        Bridge { supply_v: 12.0 }.mean_v(&Legs { a, b, enabled })
    }

    #[test]
    fn voltage_is_the_difference_of_the_duties() {
        assert_eq!(mean_v(Leg::Duty(0.75), Leg::Duty(0.25), true), Some(6.0));
        assert_eq!(mean_v(Leg::Duty(0.0), Leg::Duty(0.5), true), Some(-6.0));
        assert_eq!(mean_v(Leg::Duty(7.0), Leg::Duty(-1.0), true), Some(12.0));
    }

    #[test]
    fn no_current_without_two_driven_legs() {
        assert_eq!(mean_v(Leg::Off, Leg::Off, true), None);
        assert_eq!(mean_v(Leg::Duty(1.0), Leg::Off, true), None);
        assert_eq!(mean_v(Leg::Duty(1.0), Leg::Duty(0.0), false), None);
        assert_eq!(Bridge::NOMINAL.mean_v(&Legs::default()), None);
    }
}
