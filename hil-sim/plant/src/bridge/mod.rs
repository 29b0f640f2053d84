//! H-bridge with LC filter that drives the tile.
//!
//! ```text
//!  supply --+---------+
//!           a         b     legs: two MOSFETs each, PWM
//!           |         |
//!           +- L, r --+---- tile (Seebeck voltage, resistance) ---- back to b
//!                     C     across the tile
//! ```
//!
//! The circuit settles within about 0.1 ms, so each 1 ms step of the plant uses its periodic steady state: the mean
//! current and the mean square of its ripple. Not modelled: switching transients (10 A at enable, 12 A at a reversal by
//! the benches of `hardware/`, below every trip level here), finite slew rate, saturation of the inductors. Nor is the
//! warming of the MOSFETs: 6 A make 0.25 W in each pair, so their 7 milliohm rise by less than 1 milliohm, a thousandth
//! of the path's resistance, where the leads alone are uncertain by 10.

mod dead_time;
mod defects;
mod params;
mod ripple;

pub use defects::{BridgeDefects, LegDefect, Output};
pub use params::BridgeParams;

use dead_time::{DeadTime, Pulses};
use ripple::Ripple;

/// State of one leg (half-bridge) during one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Leg {
    /// High-impedance.
    #[default]
    Off,
    /// PWM with this duty cycle, the fraction of time at the supply, limited to 0 to 1. The pulses of both legs begin
    /// at the same time.
    Duty(f64),
    /// PWM into an output that is shorted to ground.
    Shorted,
}

/// Drive of one bridge: its logic inputs IN1 and IN2 or, behind the [defects](BridgeDefects::apply), its legs. Only the
/// difference of `a` and `b` drives a current, and a positive one cools the display; so inputs that are both high, with
/// which both legs are low, need no conversion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BridgeOutputs {
    /// IN1, and the leg at the positive terminal of the tile.
    pub a: Leg,
    /// IN2, and the leg at the negative terminal of the tile.
    pub b: Leg,
    /// Level of the enable line; low makes both legs high-impedance.
    pub enabled: bool,
}

impl BridgeOutputs {
    /// Fraction of time for which each leg is at the supply, by the driver's truth table for its inputs: 10 and 01 drive
    /// one leg high and the other low, with 11 both are low, and with 00 throughout both are high-impedance.
    fn leg_levels(&self) -> (Leg, Leg) {
        match (self.a, self.b) {
            (Leg::Duty(in1), Leg::Duty(in2)) if in1 > 0.0 || in2 > 0.0 => {
                (Leg::Duty((in1 - in2).max(0.0)), Leg::Duty((in2 - in1).max(0.0)))
            }
            _ => (Leg::Off, Leg::Off),
        }
    }
}

/// Electrical load that the tile presents to the bridge in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Seebeck voltage, V; positive opposes a current from leg `a` to leg `b`.
    pub seebeck_v: f64,
    /// Resistance, ohm, above 0.
    pub resistance_ohm: f64,
}

/// Tile current of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Current {
    /// Mean through the tile, A; positive cools the display.
    pub mean_a: f64,
    /// Mean square of the ripple, A^2; it adds Joule heat in the tile.
    pub ripple_a2: f64,
    /// Mean current out of the supply, A; negative if the tile feeds it.
    pub supply_a: f64,
    /// Ripple of the inductors' current, which the sense resistors see.
    pub inductor: InductorRipple,
}

/// Triangular ripple of the inductors' current.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InductorRipple {
    /// Half of its peak-to-peak value, A.
    pub half_a: f64,
    /// Part of the PWM period in which the current rises.
    pub width: f64,
}

impl InductorRipple {
    /// Its value at a phase of the PWM period, 0 to 1 from the begin of the pulses, A.
    pub fn at_phase(&self, phase: f64) -> f64 {
        let Self { half_a, width } = *self;
        let part = if phase < width {
            -1.0 + 2.0 * phase / width
        } else if width < 1.0 {
            1.0 - 2.0 * (phase - width) / (1.0 - width)
        } else {
            0.0
        };
        half_a * part
    }
}

/// The power stage.
///
/// On overcurrent or a shorted output the driver turns both legs off, pulls its fault pin low for the retry time and
/// then tries again. It reacts within microseconds, which is modelled as immediate.
#[derive(Clone, Debug)]
pub struct Bridge {
    params: BridgeParams,
    dead_time: DeadTime,
    ripple: Ripple,
    /// Time until the tripped driver retries, s.
    retry_in_s: f64,
}

/// A remaining retry time below this is rounding, s.
const TIME_TOLERANCE_S: f64 = 1e-9;

impl Bridge {
    /// A bridge for a tile of about this resistance, ohm: a deviation of 20 % changes the ripple by 1 %.
    pub fn new(params: BridgeParams, load_ohm: f64) -> Self {
        Self {
            params,
            dead_time: DeadTime::new(&params),
            ripple: Ripple::new(&params, load_ohm),
            retry_in_s: 0.0,
        }
    }

    /// Changes the supply voltage, V, 0 or more.
    pub fn set_supply(&mut self, supply_v: f64) {
        if supply_v != self.params.supply_v {
            self.params.supply_v = supply_v;
            self.dead_time = DeadTime::new(&self.params);
        }
    }

    /// Tile current during a step, s.
    ///
    /// There is no current while the legs are high-impedance, since the Seebeck voltage of the tile stays far below the
    /// supply plus two diode drops, nor with both inputs low throughout, which the driver takes as off. If both legs are
    /// low for part of a period they are treated as grounded; the device always holds one leg at the supply.
    pub fn current(&mut self, step_s: f64, legs: &BridgeOutputs, load: &Load) -> Current {
        if self.retry_in_s > 0.0 {
            self.retry_in_s -= step_s;
            if self.retry_in_s > TIME_TOLERANCE_S {
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

    /// Whether the driver pulls its fault pin low.
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
            sign * self.dead_time.mean_current_a(&Pulses { width, seebeck_v, ohm })
        } else {
            (params.supply_v * (a - b) - load.seebeck_v) / ohm
        };
        // The ripple follows the effective duty cycle, given by the mean voltage across the legs.
        let applied_v = mean_a * ohm + load.seebeck_v;
        let ripple_v2 = params.supply_v
            * params.supply_v
            * self.ripple.mean_square((applied_v / params.supply_v).abs());
        Current {
            mean_a,
            ripple_a2: ripple_v2 / (load.resistance_ohm * load.resistance_ohm),
            supply_a: mean_a * (a - b),
            inductor: InductorRipple { half_a: self.dead_time.half_ripple_a(width), width },
        }
    }
}

#[cfg(test)]
mod tests;
