#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod calibration;
mod checksum;
mod display_surface;
mod flux_sensor;
mod persons;
mod range;
mod settings_record;
mod settings_store;
mod tile;
mod triplicated_sealed_flash;
mod vocabulary;

pub use calibration::{
    CALIBRATED_ADC_BORDER_COUNT, CODES_PER_ADC_SEGMENT, CORRECTION_POLYNOMIAL_CENTER_C,
    CORRECTION_POLYNOMIAL_CLAMP_K, Calibration, Correction, FIRST_CALIBRATED_ADC_BORDER_INDEX,
    round_to_decimals,
};
pub use checksum::{CRC_32, Crc32Digest};
pub use display_surface::DisplaySurface;
pub use flux_sensor::FluxSensor;
pub use persons::{Person, PersonCode, Persons};
pub use range::{
    ADC_ERROR_STEP_RANGE, CORRECTION_RANGES, DISPLAY_SURFACE_RANGES, FLUX_SENSOR_RANGES, Range,
    TILE_RANGES,
};
pub use settings_record::{
    RECORD_MAX_BYTES, RecordError, SettingsRecord, StoredDevice, StoredSettings,
    decode_settings_record, encode_settings_record,
};
pub use settings_store::{SettingsStore, StoreError};
pub use tile::Tile;
pub use triplicated_sealed_flash::{TriplicatedSealedFlash, TriplicatedSealedFlashError};
pub use vocabulary::{Vocabulary, WordList};

/// Control ticks per second of each finger: a tick is 1 ms.
pub const TICK_HZ: u32 = 1000;
/// Length of a control tick, s.
pub const TICK_S: f64 = 1.0 / TICK_HZ as f64;

/// Number of thermistors of one finger. Arrays with one element for each thermistor have this order: display, second
/// display, sink, skin, room.
pub const THERMISTOR_COUNT: usize = 5;

/// Settings of one finger, in physical units. The fixed-point constants of the control tick are computed from these
/// settings at start-up and after each change of them, so that the tick itself needs no floating point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Voltage divider of a thermistor, with the nominal values of its parts, which are the same for all five
    /// thermistors of the finger.
    pub thermistor: ThermistorDivider,
    /// Self-heating of each thermistor, K: how much warmer the current of its divider makes it than what it measures,
    /// which is a surface or, for the room, the air. It is subtracted from the reading. Order: display, second display,
    /// sink, skin, room.
    pub self_heating_k: [f64; 5],
    /// Nominal output without force, and sensitivity, of the force sensor under the display. The sensor measures the
    /// force of the finger on the display.
    pub force: ForceSensor,
    /// Sensitivity of the H-bridge's current mirror, which measures the magnitude of the module's current: counts of
    /// the converter (of 4096) per ampere.
    pub current_counts_per_a: f64,
    /// Electrical parameters of the Peltier module and its H-bridge, from which the duty cycle for a demanded current
    /// is computed.
    pub module: PeltierModule,
    /// Gains of the control law `pi`, which updates the module's current at every tick of 1 ms, and of the observer of
    /// the plate's temperature; [`Self::set_tile`] computes them.
    pub gains: PiGains,
    /// Gains of the control law `pi-10hz`, which updates the module's current ten times a second; [`Self::set_tile`]
    /// computes them.
    pub gains_10hz: PiGains,
    /// Surface of the display, from whose conductivity, roughness and slope the thermal contact resistance between display and
    /// skin is computed.
    pub display: DisplaySurface,
    /// Steps of the converter's error and corrections of the five thermistors, found by calibration with a reference
    /// thermometer; all zero before the first calibration.
    pub calibration: Calibration,
    /// The sensor of the heat flux between skin and display; `None` if it is not fitted.
    pub flux_sensor: Option<FluxSensor>,
    /// Thermal parameters of the tile, nominal until the command `tune` has identified them. [`Self::set_tile`]
    /// replaces them, because the gains follow from them.
    pub tile: Tile,
}

impl Settings {
    /// Replaces the parameters of the tile, and computes from them the gains of the control laws `pi` and `pi-10hz`.
    #[inline(never)]
    pub fn set_tile(&mut self, tile: Tile) {
        self.tile = tile;
        [self.gains, self.gains_10hz] = PiGains::for_1khz_and_10hz_laws(&tile);
    }
}

/// Voltage divider of a thermistor: a pull-up resistor from the reference voltage of the converter to the converter's
/// input, and the thermistor from there to ground. The converter's reading does not depend on the value of the
/// reference voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermistorDivider {
    /// Nominal resistance of the pull-up resistor between the reference voltage and the thermistor, ohm.
    pub pull_up_ohm: f64,
    /// Nominal temperature of the thermistor as a function of its resistance.
    pub curve: ThermistorCurve,
}

impl ThermistorDivider {
    /// Temperature of the thermistor, °C, limited to -100 to 300 °C. `voltage` is the voltage across the thermistor,
    /// from 0 to below 65536, in 65536ths of the reference voltage: the unit of a sum of 16 conversions of 12 bits.
    pub fn temperature_c(&self, voltage: f64) -> f64 {
        let ohm = self.pull_up_ohm * voltage / (65536.0 - voltage);
        let (a, b, c) = self.curve.steinhart_hart_coefficients();
        let log = libm::log(ohm.clamp(1e-3, 1e12));
        let inverse = (a + b * log + c * log * log * log).clamp(1.0 / 573.0, 1.0 / 173.0);
        1.0 / inverse - 273.15
    }
}

/// Characteristic of a thermistor: its temperature `T`, K, as a function of its resistance `R`, ohm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThermistorCurve {
    /// Beta equation of a thermistor: `1/T = 1/298.15 + ln(R / r25_ohm) / beta_k`, with its temperature `T`, K, and its
    /// resistance `R`, ohm; 298.15 K is 25 °C.
    Beta {
        /// Resistance of the thermistor at 25 °C, ohm.
        r25_ohm: f64,
        /// Beta constant of the thermistor, K: the rise of `ln R` per rise of `1/T`, with resistance `R` and
        /// temperature `T`.
        beta_k: f64,
    },
    /// Steinhart-Hart equation of a thermistor: `1/T = a + b ln R + c (ln R)^3`, with its temperature `T`, K, and its
    /// resistance `R`, ohm.
    SteinhartHart {
        /// Constant term `a` in `1/T = a + b ln R + c (ln R)^3`, 1/K, with temperature `T` in K and resistance `R` in
        /// ohm.
        a: f64,
        /// Coefficient `b` of `ln R` in `1/T = a + b ln R + c (ln R)^3`, 1/K, with temperature `T` in K and resistance
        /// `R` in ohm.
        b: f64,
        /// Coefficient `c` of `(ln R)^3` in `1/T = a + b ln R + c (ln R)^3`, 1/K, with temperature `T` in K and
        /// resistance `R` in ohm.
        c: f64,
    },
}

impl ThermistorCurve {
    /// Coefficients `a`, `b`, `c`, 1/K, of the Steinhart-Hart equation `1/T = a + b ln R + c (ln R)^3` of this
    /// thermistor, with `T` in K and `R` in ohm. The beta equation is a Steinhart-Hart equation with `c = 0`.
    pub fn steinhart_hart_coefficients(&self) -> (f64, f64, f64) {
        match *self {
            Self::Beta { r25_ohm, beta_k } => {
                (1.0 / 298.15 - libm::log(r25_ohm) / beta_k, 1.0 / beta_k, 0.0)
            }
            Self::SteinhartHart { a, b, c } => (a, b, c),
        }
    }
}

/// Linear force sensor under the display, with a live zero: its output without force is well above 0, so that an output
/// below half of [`Self::zero_counts`] means a broken wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSensor {
    /// Nominal output of the force sensor without force, counts of the converter (of 4096).
    pub zero_counts: f64,
    /// Sensitivity of the force sensor: rise of its output, counts of the converter (of 4096), per newton.
    pub counts_per_n: f64,
}

/// Electrical parameters of a Peltier module, its H-bridge and its supply, from which the duty cycle for a demanded
/// current is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeltierModule {
    /// Resistance of all semiconductor legs of the module in series, ohm, at 27 °C, the temperature of its data sheet.
    pub legs_ohm: f64,
    /// Resistance in series with the module's legs, ohm: switches of the H-bridge, output filter and leads.
    pub leads_ohm: f64,
    /// Seebeck coefficient of the whole module, V/K: open-circuit voltage per kelvin between the hot and the cold ends
    /// of its legs.
    pub seebeck_v_k: f64,
    /// Largest voltage, V, 0 or more, that the H-bridge loses because of its dead times, in which neither switch of a
    /// half-bridge conducts. All of this voltage is lost while the current in the output filter's inductor keeps its
    /// direction for the whole PWM period.
    pub dead_time_v: f64,
    /// Ripple of the current in the output filter's inductor, A: at a duty cycle `w` from 0 to 1, half of the
    /// peak-to-peak ripple is `ripple_a w (1 - w)`. If the ripple reverses the inductor's current within a PWM period,
    /// as it does with a small current, less voltage is lost in the dead times.
    pub ripple_a: f64,
    /// Change, A, above 0, of the current in the output filter's inductor during one dead time of the H-bridge. No
    /// voltage is lost in the dead times if the ripple carries the inductor's current beyond zero by at least this
    /// much.
    pub dead_time_a: f64,
    /// Nominal supply voltage of the H-bridge, V: what it applies at a duty cycle of 1.
    pub supply_v: f64,
    /// Largest magnitude, A, of the current that the controller demands, for cooling and for heating.
    pub current_limit_a: f64,
}

/// Gains of a proportional-integral controller: its input is the display's reading minus the set-point, K, its output
/// the module's current, A; positive cools.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PiGains {
    /// Proportional gain, A/K: cooling current per kelvin by which the display's reading is above the set-point.
    pub proportional_a_k: f64,
    /// Integral time, s: in this time, a constant error adds as much current through the integral part as the
    /// proportional part gives.
    pub integral_s: f64,
}

impl Default for Settings {
    /// Factory defaults, for the nominal components of `docs/hardware.md`: 10 kΩ thermistors with a beta of 3950 K and
    /// 10 kΩ pull-up resistors, a Peltier module of 30 mm and 6 A on 12 V, and its nominal tile. No calibration.
    // Not inlined, because each caller would have constants of its own.
    #[inline(never)]
    fn default() -> Self {
        let [gains, gains_10hz] = PiGains::for_1khz_and_10hz_laws(&Tile::FACTORY_DEFAULT);
        Self {
            thermistor: ThermistorDivider {
                pull_up_ohm: 10e3,
                curve: ThermistorCurve::Beta { r25_ohm: 10e3, beta_k: 3950.0 },
            },
            // The divider heats each thermistor by 0.27 mW, which 8 mW/K carry away from a bonded one, 3 mW/K from the
            // one on the skin, 1 mW/K from the one in still air.
            self_heating_k: [0.034, 0.034, 0.034, 0.09, 0.27],
            force: ForceSensor { zero_counts: 410.0, counts_per_n: 300.0 },
            current_counts_per_a: 400.0,
            module: PeltierModule {
                legs_ohm: 1.061,
                leads_ohm: 0.05,
                seebeck_v_k: 0.0273,
                dead_time_v: 0.21,
                ripple_a: 7.05,
                dead_time_a: 0.24,
                supply_v: 12.0,
                current_limit_a: 6.0,
            },
            gains,
            gains_10hz,
            display: DisplaySurface::NOMINAL,
            calibration: Calibration::default(),
            flux_sensor: None,
            tile: Tile::FACTORY_DEFAULT,
        }
    }
}
