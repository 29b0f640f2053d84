//! Test bench: a controller on the simulated tile, read through a thermistor that is a first-order lag.

use contact_model::fixed_point::Celsius;
use thermal_display::device::control::{ControlParameters, Controller};
use thermal_display::device::drive;
use thermal_display::device::estimate::{PlateObserver, Watt};
use thermal_display::device::reference::Reference;
use thermal_display::device::safety::Setpoint;
use thermal_display::settings::{self, Settings};
use thermal_plant::STEP_S;
use thermal_plant::bridge::Current;
use thermal_plant::tile::{Tile, TileParams};

/// Initial temperature of room, sink and tile, °C.
pub const ROOM_C: f64 = 24.0;

/// Number of ticks in `seconds`.
pub fn ticks(seconds: f64) -> usize {
    (seconds / STEP_S).round() as usize
}

pub fn celsius(t_c: f64) -> Celsius {
    Celsius::saturating_from_num(t_c)
}

pub fn setpoint(t_c: f64) -> Setpoint {
    let (setpoint, limited) = Setpoint::clamp_celsius_with_flag(celsius(t_c));
    assert!(!limited, "{t_c} C is not allowed");
    setpoint
}

/// What commissioning identifies on the nominal tile with a thermistor lag of 0.1 s (`hil-sim commission`).
pub const IDENTIFIED: settings::Tile = settings::Tile {
    gain_k_s_a: 2.957,
    joule_per_a: 0.0585,
    leak_1_s: 0.103,
    sensor_lag_s: 0.1,
    dead_time_s: 0.016,
};

/// Settings for the nominal tile with this thermistor lag, s.
pub fn settings(sensor_lag_s: f64) -> Settings {
    settings_of(settings::Tile { sensor_lag_s, ..IDENTIFIED })
}

/// Settings with the gains that follow from an identified tile.
pub fn settings_of(tile: settings::Tile) -> Settings {
    let [gains, gains_10hz] = settings::PiGains::for_1khz_and_10hz_laws(&tile);
    Settings { gains, gains_10hz, tile, ..Settings::default() }
}

/// A first-order lag, exact for an input that is linear between ticks.
#[derive(Clone, Debug)]
pub struct Sensor {
    lag_s: f64,
    input_c: f64,
    pub reading_c: f64,
}

impl Sensor {
    pub fn new(lag_s: f64, at_c: f64) -> Self {
        Self { lag_s, input_c: at_c, reading_c: at_c }
    }

    pub fn update(&mut self, input_c: f64) {
        let slope = (input_c - self.input_c) / STEP_S;
        // The steady-state error on a ramp is its slope times the lag.
        let transient_k = self.reading_c - (self.input_c - slope * self.lag_s);
        self.reading_c = input_c - slope * self.lag_s + transient_k * (-STEP_S / self.lag_s).exp();
        self.input_c = input_c;
    }
}

/// The control laws with the observer that they need.
#[derive(Clone, Debug)]
pub struct ControlLoop {
    pub controller: Controller,
    pub observer: PlateObserver,
}

impl ControlLoop {
    pub fn new(settings: &Settings) -> Self {
        let parameters = ControlParameters::new(settings);
        let limit = drive::Current::from_num(settings.module.current_limit_a);
        Self {
            controller: Controller::new(&parameters, limit),
            observer: PlateObserver::new(&parameters.observer, limit),
        }
    }

    pub fn set_parameters(&mut self, settings: &Settings) {
        let parameters = ControlParameters::new(settings);
        self.controller.set_pi_gains(&parameters);
        self.observer.set_parameters(&parameters.observer);
    }

    /// The current, A, for a target, the readings of the display's and the sink's thermistors, and a known load, W.
    pub fn step(&mut self, target_c: f64, (reading_c, sink_c): (f64, f64), load_w: f64) -> f64 {
        let (display, sink) = (celsius(reading_c), celsius(sink_c));
        self.observer.update_disturbance_and_correction(display, sink, Watt::from_num(load_w));
        let reference = Reference::at(setpoint(target_c).celsius());
        let current = (self.controller).choose_current(&reference, display, sink, &self.observer);
        self.observer.advance_model(current);
        current.to_num()
    }
}

/// Control loop, tile and thermistor.
#[derive(Clone, Debug)]
pub struct Bench {
    pub control: ControlLoop,
    pub tile: Tile,
    sensor: Sensor,
    /// Heat flow into the contact patch, W.
    pub load_w: f64,
    /// The part of it that the controller is given as feed-forward, W.
    pub known_load_w: f64,
    pub current_a: f64,
}

/// State after one tick.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    pub display_c: f64,
    pub current_a: f64,
}

impl Bench {
    pub fn new(settings: &Settings, params: TileParams) -> Self {
        Self {
            control: ControlLoop::new(settings),
            tile: Tile::new(params, ROOM_C),
            sensor: Sensor::new(settings.tile.sensor_lag_s, ROOM_C),
            load_w: 0.0,
            known_load_w: 0.0,
            current_a: 0.0,
        }
    }

    /// The nominal tile with a thermistor lag that the controller is set to, after 60 s at a constant target.
    pub fn settled_at(sensor_lag_s: f64, t_c: f64) -> Self {
        let mut bench = Self::new(&settings(sensor_lag_s), TileParams::NOMINAL);
        bench.run(t_c, 60.0);
        bench
    }

    /// The display's surface, °C.
    pub fn display_c(&self) -> f64 {
        self.tile.patch_c() + self.load_w * self.tile.patch_half_k_w()
    }

    /// One tick; its current acts on the plate in the next one.
    pub fn tick(&mut self, target_c: f64) -> Tick {
        advance(&mut self.tile, self.current_a, self.load_w);
        self.sensor.update(self.display_c());
        let sensed_c = (self.sensor.reading_c, self.tile.sink_c());
        self.current_a = (self.control).step(target_c, sensed_c, self.known_load_w);
        Tick { display_c: self.display_c(), current_a: self.current_a }
    }

    pub fn run(&mut self, target_c: f64, seconds: f64) -> Vec<Tick> {
        (0..ticks(seconds)).map(|_| self.tick(target_c)).collect()
    }
}

/// Advances the tile by one step with a current, A, and a heat flow into its patch, W.
pub fn advance(tile: &mut Tile, current_a: f64, load_w: f64) {
    tile.prepare(STEP_S);
    tile.drive(Current { mean_a: current_a, ..Current::default() });
    tile.first_stage(STEP_S, load_w, 0.0, 0.0);
    tile.second_stage(0.0);
}

/// Largest minus smallest value.
pub fn peak_to_peak(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    high - low
}

/// The first tick after which the display stays within a band around a temperature; none if it ends outside.
pub fn settled(ticks: &[Tick], at_c: f64, band_k: f64) -> Option<usize> {
    let outside = |tick: &Tick| (tick.display_c - at_c).abs() > band_k;
    let first = ticks.iter().rposition(outside).map_or(0, |last| last + 1);
    (first < ticks.len()).then_some(first)
}
