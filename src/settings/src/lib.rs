//! What differs between two built devices, in physical units, and how it outlives the power.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod calibration;
mod range;
mod sectors;
mod store;
mod stored;
mod tile;

pub use calibration::{
    BORDERS, Calibration, Correction, FIRST_BORDER, MIDDLE_C, REACH_K, SEGMENT_CODES, rounded,
};
pub use range::{CORRECTION_RANGES, Range, STEP_RANGE, TILE_RANGES};
pub use sectors::{SectorError, Sectors};
pub use store::{Store, StoreError};
pub use stored::{Kept, LONGEST, StoredBytes, StoredError, decode, encode};
pub use tile::Tile;

use contact_model::material::{REFERENCE_DISPLAY, Surface};

/// Control ticks per second of one finger.
pub const TICK_HZ: u32 = 1000;

/// Thermistors of one finger, in this order: display, second display, sink, skin, room.
pub const THERMISTORS: usize = 5;

/// Everything that is derived from these is derived once, at start-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// All five thermistors.
    pub thermistor: Thermistor,
    /// How much each thermistor warms itself above what it sits on, K: display, second display, sink, skin, room.
    pub self_heating_k: [f64; 5],
    /// Force sensor.
    pub force: ForceSensor,
    /// Current mirror of the bridge: counts (of 4096) per ampere.
    pub current_counts_per_a: f64,
    /// Thermoelectric module, as the bridge sees it.
    pub module: Module,
    /// Temperature loop.
    pub gains: Gains,
    /// Temperature loop of the law that looks ten times a second.
    pub gains_10hz: Gains,
    /// Finish of the display's surface.
    pub display: Surface,
    /// What calibration has found.
    pub calibration: Calibration,
    /// What tuning has found; the gains follow from it.
    pub tile: Tile,
}

impl Settings {
    /// Controls another tile.
    #[inline(never)]
    pub fn retune(&mut self, tile: Tile) {
        self.tile = tile;
        [self.gains, self.gains_10hz] = Gains::of_tile(&tile);
    }
}

/// A thermistor to ground under a pull-up resistor, read ratiometrically.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermistor {
    /// Pull-up resistor, ohm.
    pub pull_up_ohm: f64,
    /// Resistance to temperature.
    pub curve: Curve,
}

impl Thermistor {
    /// Temperature in °C for a voltage in 65536ths of the reference, which codes are centred on; within
    /// -100 to 300 °C.
    #[must_use]
    pub fn temperature_c(&self, part: f64) -> f64 {
        let ohm = self.pull_up_ohm * part / (65536.0 - part);
        let (a, b, c) = self.curve.steinhart_hart();
        let log = libm::log(ohm.clamp(1e-3, 1e12));
        let inverse = (a + b * log + c * log * log * log).clamp(1.0 / 573.0, 1.0 / 173.0);
        1.0 / inverse - 273.15
    }
}

/// Resistance to temperature, `R` in ohm and `T` in kelvin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// `1/T = 1/298.15 + ln(R / r25_ohm) / beta_k`.
    Beta {
        /// Resistance at 25 °C, ohm.
        r25_ohm: f64,
        /// Beta, K.
        beta_k: f64,
    },
    /// `1/T = a + b ln R + c (ln R)^3`.
    SteinhartHart {
        /// 1/K.
        a: f64,
        /// 1/K.
        b: f64,
        /// 1/K.
        c: f64,
    },
}

impl Curve {
    /// The coefficients `a`, `b`, `c` of the Steinhart-Hart form.
    #[must_use]
    pub fn steinhart_hart(&self) -> (f64, f64, f64) {
        match *self {
            Self::Beta { r25_ohm, beta_k } => (
                1.0 / 298.15 - libm::log(r25_ohm) / beta_k,
                1.0 / beta_k,
                0.0,
            ),
            Self::SteinhartHart { a, b, c } => (a, b, c),
        }
    }
}

/// A force sensor with a live zero, so that a broken wire reads below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSensor {
    /// Counts (of 4096) without force.
    pub zero_counts: f64,
    /// Counts per newton.
    pub counts_per_n: f64,
}

/// A thermoelectric module on its supply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Module {
    /// Resistance of the legs at 27 °C, ohm.
    pub legs_ohm: f64,
    /// Resistance of the bridge's switches, its filter and the leads, ohm.
    pub leads_ohm: f64,
    /// Seebeck coefficient, V/K.
    pub seebeck_v_k: f64,
    /// Voltage that the bridge loses in its dead times, V, 0 or more.
    pub dead_time_v: f64,
    /// Half of the ripple in its filter's inductor, A, over `w (1 - w)` for pulses of a part `w` of the period.
    pub ripple_a: f64,
    /// What one dead time changes the inductor's current by, A, above 0.
    pub dead_time_a: f64,
    /// Supply of the bridge, V.
    pub supply_v: f64,
    /// Largest current either way, A.
    pub current_limit_a: f64,
}

/// A proportional-integral law from temperature error to current.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// A/K.
    pub proportional_a_k: f64,
    /// Integral time, s.
    pub integral_s: f64,
}

impl Default for Settings {
    /// The class values that the wiring table names: 10 k thermistors of beta 3950 K under 10 k, a 30 mm,
    /// 6 A module on 12 V, and the tile of that class.
    fn default() -> Self {
        let [gains, gains_10hz] = Gains::of_tile(&Tile::CLASS);
        Self {
            thermistor: Thermistor {
                pull_up_ohm: 10e3,
                curve: Curve::Beta {
                    r25_ohm: 10e3,
                    beta_k: 3950.0,
                },
            },
            // 0.27 mW of the divider into 8 mW/K when bonded, 3 on the skin, 1 in still air.
            self_heating_k: [0.034, 0.034, 0.034, 0.09, 0.27],
            force: ForceSensor {
                zero_counts: 410.0,
                counts_per_n: 300.0,
            },
            current_counts_per_a: 400.0,
            module: Module {
                legs_ohm: 1.061,
                leads_ohm: 0.19,
                seebeck_v_k: 0.0273,
                dead_time_v: 0.397,
                ripple_a: 6.75,
                dead_time_a: 0.386,
                supply_v: 12.0,
                current_limit_a: 6.0,
            },
            gains,
            gains_10hz,
            display: REFERENCE_DISPLAY,
            calibration: Calibration::default(),
            tile: Tile::CLASS,
        }
    }
}
