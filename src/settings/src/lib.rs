#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod calibration;
mod range;
mod record;
mod redundant_sectors;
mod store;
mod tile;

pub use calibration::{
    BORDER_COUNT, CORRECTION_CENTER_C, CORRECTION_HALF_SPAN_K, Calibration, Correction,
    FIRST_BORDER, SEGMENT_CODES, round_to_decimals,
};
pub use range::{CORRECTION_RANGES, Range, STEP_RANGE, TILE_RANGES};
pub use record::{RECORD_MAX_BYTES, RecordError, SettingsRecord, StoredSettings, decode, encode};
pub use redundant_sectors::{RedundantSectors, SectorError};
pub use store::{SettingsStore, StoreError};
pub use tile::Tile;

use contact_model::material::{REFERENCE_DISPLAY, Surface};

/// Control ticks per second of one finger.
pub const TICK_HZ: u32 = 1000;

/// Number of thermistors of one finger, in this order: display, second display, sink, skin, room.
pub const THERMISTORS: usize = 5;

/// Settings of one finger in physical units. The fixed-point constants of the control tick are computed from them once,
/// at start-up and after each change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Divider that each of the five thermistors is read by.
    pub thermistor: ThermistorDivider,
    /// Self-heating of each thermistor above the surface that it is mounted on, K: display, second display, sink, skin,
    /// room.
    pub self_heating_k: [f64; 5],
    /// Force sensor under the display.
    pub force: ForceSensor,
    /// Sensitivity of the bridge's current mirror: counts (of 4096) per ampere.
    pub current_counts_per_a: f64,
    /// Electrical parameters of the Peltier module and its bridge.
    pub module: Module,
    /// Gains of the temperature loop that is closed at every tick.
    pub gains: Gains,
    /// Gains of the temperature loop that is closed ten times a second.
    pub gains_10hz: Gains,
    /// Thermal conductivity, roughness and slope of the display surface, which determine its contact resistance to the skin.
    pub display: Surface,
    /// Corrections of the converter and of the thermistors, found by calibration; zero before it.
    pub calibration: Calibration,
    /// Parameters of the tile, from which [`Self::set_tile`] derives the gains.
    pub tile: Tile,
}

impl Settings {
    /// Replaces the parameters of the tile, and the gains that follow from them.
    #[inline(never)]
    pub fn set_tile(&mut self, tile: Tile) {
        self.tile = tile;
        [self.gains, self.gains_10hz] = Gains::for_both_loop_rates(&tile);
    }
}

/// A voltage divider of a thermistor to ground under a pull-up resistor, read ratiometrically.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermistorDivider {
    /// Pull-up resistor, ohm.
    pub pull_up_ohm: f64,
    /// Temperature as a function of the resistance.
    pub curve: Curve,
}

impl ThermistorDivider {
    /// Temperature in °C for a voltage in 65536ths of the reference voltage; the result is limited to
    /// -100 to 300 °C.
    #[must_use]
    pub fn temperature_c(&self, voltage: f64) -> f64 {
        let ohm = self.pull_up_ohm * voltage / (65536.0 - voltage);
        let (a, b, c) = self.curve.steinhart_hart();
        let log = libm::log(ohm.clamp(1e-3, 1e12));
        let inverse = (a + b * log + c * log * log * log).clamp(1.0 / 573.0, 1.0 / 173.0);
        1.0 / inverse - 273.15
    }
}

/// Characteristic of a thermistor: temperature `T` in kelvin as a function of resistance `R` in ohm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// Beta equation: `1/T = 1/298.15 + ln(R / r25_ohm) / beta_k`.
    Beta {
        /// Resistance at 25 °C, ohm.
        r25_ohm: f64,
        /// Beta constant of the thermistor, K.
        beta_k: f64,
    },
    /// Steinhart-Hart equation: `1/T = a + b ln R + c (ln R)^3`.
    SteinhartHart {
        /// Coefficient `a`, 1/K.
        a: f64,
        /// Coefficient `b` of `ln R`, 1/K.
        b: f64,
        /// Coefficient `c` of `(ln R)^3`, 1/K.
        c: f64,
    },
}

impl Curve {
    /// The coefficients `a`, `b`, `c` of the Steinhart-Hart equation.
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

/// A linear force sensor with a live zero: its output without force is well above 0, so that a broken wire is detected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSensor {
    /// Output without force, counts (of 4096).
    pub zero_counts: f64,
    /// Sensitivity of the force sensor, counts (of 4096) per newton.
    pub counts_per_n: f64,
}

/// Electrical parameters of a Peltier module, its bridge and its supply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Module {
    /// Resistance of the semiconductor legs at 27 °C, ohm.
    pub legs_ohm: f64,
    /// Resistance of the bridge's switches, its filter and the leads, ohm.
    pub leads_ohm: f64,
    /// Seebeck coefficient of the whole module, V/K: open-circuit voltage per temperature difference of its faces.
    pub seebeck_v_k: f64,
    /// Voltage that the bridge loses in its dead times, V, 0 or more.
    pub dead_time_v: f64,
    /// Half of the ripple current in the filter's inductor, divided by `w (1 - w)` for a duty cycle `w`, A.
    pub ripple_a: f64,
    /// Change of the inductor's current during one dead time, A, above 0.
    pub dead_time_a: f64,
    /// Supply voltage of the bridge, V.
    pub supply_v: f64,
    /// Largest current in either direction, A.
    pub current_limit_a: f64,
}

/// Gains of a proportional-integral controller from temperature error to current.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// Proportional gain: cooling current per kelvin above the set-point, A/K.
    pub proportional_a_k: f64,
    /// Integral time of the controller, s.
    pub integral_s: f64,
}

impl Default for Settings {
    /// Factory defaults, the nominal values of the components in the wiring table: 10 kΩ thermistors with a beta of
    /// 3950 K under 10 kΩ, a 30 mm, 6 A module on 12 V, and its nominal tile.
    fn default() -> Self {
        let [gains, gains_10hz] = Gains::for_both_loop_rates(&Tile::CLASS);
        Self {
            thermistor: ThermistorDivider {
                pull_up_ohm: 10e3,
                curve: Curve::Beta {
                    r25_ohm: 10e3,
                    beta_k: 3950.0,
                },
            },
            // 0.27 mW of the divider, dissipated by 8 mW/K when bonded, 3 mW/K on the skin, 1 mW/K in still air.
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
