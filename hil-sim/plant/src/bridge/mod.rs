//! The bridge that drives the tile, behind its LC filter.
//!
//! ```text
//!  supply --+---------+
//!           a         b     legs: two switches each, PWM
//!           |         |
//!           +- L, r --+---- tile (Seebeck voltage, resistance) ---- back to b
//!                     C     across the tile
//! ```
//!
//! Everything here settles within some 0.1 ms, so a step of the plant sees its periodic steady state: the mean
//! current and the mean square of its ripple. Not modelled: slew of the edges, saturation of the inductor, warming
//! of the switches.

mod dead_time;
mod defects;
mod params;
mod ripple;

pub use defects::{BridgeDefects, LegDefect};
pub use params::BridgeParams;

use dead_time::{DeadTime, Pulses};
use ripple::Ripple;

/// One leg of the bridge over one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Leg {
    /// High-impedance.
    #[default]
    Off,
    /// Switches between ground and supply; the fraction of time at the supply, 0 to 1 (taken as the nearer end
    /// outside of it). The other leg's time at the supply begins together with it.
    Duty(f64),
    /// Switches, but its output is shorted to ground.
    Shorted,
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

/// The tile, as the bridge sees it in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Seebeck voltage against a current from leg `a` to leg `b`, V.
    pub seebeck_v: f64,
    /// Resistance, ohm, above 0.
    pub resistance_ohm: f64,
}

/// The current of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Current {
    /// Mean through the tile, A; positive cools the display.
    pub mean_a: f64,
    /// Mean square of the ripple on it, A^2: the tile's resistance turns it into additional Joule heat.
    pub ripple_a2: f64,
    /// What the driver's current mirror sees, A: the mean of what flows out of its high-side switches.
    pub mirror_a: f64,
}

/// The power stage.
///
/// A driver whose current exceeds its trip, or whose output is shorted, turns both legs off, pulls its fault pin for
/// the retry time and then tries again; that it notices within microseconds counts as at once.
#[derive(Clone, Debug)]
pub struct Bridge {
    params: BridgeParams,
    dead_time: DeadTime,
    ripple: Ripple,
    /// About what the tile has, ohm.
    load_ohm: f64,
    /// Time until an overloaded driver tries again, s.
    retry_in_s: f64,
}

/// Rest of a retry time that is rounding, s.
const NO_TIME_S: f64 = 1e-9;

impl Bridge {
    /// A bridge for a tile of about this resistance, ohm: 20 % more or less change the ripple by 1 %.
    #[must_use]
    pub fn new(params: BridgeParams, load_ohm: f64) -> Self {
        Self {
            params,
            dead_time: DeadTime::new(&params),
            ripple: Ripple::new(&params, load_ohm),
            load_ohm,
            retry_in_s: 0.0,
        }
    }

    /// Feeds it from another supply, V, above 0.
    pub fn set_supply(&mut self, supply_v: f64) {
        if supply_v != self.params.supply_v {
            self.params.supply_v = supply_v;
            self.dead_time = DeadTime::new(&self.params);
            self.ripple = Ripple::new(&self.params, self.load_ohm);
        }
    }

    /// The current over a step, s, with the legs and the tile as they are in it.
    ///
    /// With the legs high-impedance there is none: the tile's Seebeck voltage stays far below supply and two diodes.
    /// So it is with both legs low throughout, which the driver takes as off. A period in part of which both legs
    /// are low is taken as if they were grounded then; the device always holds one leg at the supply.
    pub fn current(&mut self, step_s: f64, legs: &Legs, load: &Load) -> Current {
        if self.retry_in_s > 0.0 {
            self.retry_in_s -= step_s;
            if self.retry_in_s > NO_TIME_S {
                return Current::default();
            }
            self.retry_in_s = 0.0;
        }
        let (a, b) = match (legs.enabled, legs.a, legs.b) {
            (true, Leg::Duty(a), Leg::Duty(b)) if a > 0.0 || b > 0.0 => {
                (a.clamp(0.0, 1.0), b.clamp(0.0, 1.0))
            }
            (true, Leg::Shorted, Leg::Duty(_) | Leg::Shorted)
            | (true, Leg::Duty(_), Leg::Shorted) => {
                return self.trip();
            }
            _ => return Current::default(),
        };
        let current = self.driven(a, b, load);
        let peak_a = current.mean_a.abs() + self.dead_time.half_ripple_a((a - b).abs());
        if peak_a > self.params.trip_a {
            return self.trip();
        }
        current
    }

    /// The driver pulls its fault pin.
    #[must_use]
    pub fn fault(&self) -> bool {
        self.retry_in_s > 0.0
    }

    fn trip(&mut self) -> Current {
        self.retry_in_s = self.params.retry_s;
        Current::default()
    }

    fn driven(&self, a: f64, b: f64, load: &Load) -> Current {
        let params = &self.params;
        let ohm = params.on_ohm + params.filter_ohm + load.resistance_ohm;
        let (width, sign) = ((a - b).abs(), (a - b).signum());
        let mean_a = if width > 0.0 && width < 1.0 {
            let seebeck_v = sign * load.seebeck_v;
            sign * self.dead_time.mean_current_a(&Pulses {
                width,
                seebeck_v,
                ohm,
            })
        } else {
            (params.supply_v * (a - b) - load.seebeck_v) / ohm
        };
        // The width that is left of the pulses, by the mean voltage across the legs.
        let applied_v = mean_a * ohm + load.seebeck_v;
        let ripple_v2 = self
            .ripple
            .mean_square_v2((applied_v / params.supply_v).abs());
        Current {
            mean_a,
            ripple_a2: ripple_v2 / (load.resistance_ohm * load.resistance_ohm),
            mirror_a: mean_a.abs() * if mean_a > 0.0 { a } else { b },
        }
    }
}

#[cfg(test)]
mod tests;
