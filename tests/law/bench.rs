//! A law on a tile, with a sensor that only lags.

use contact_model::fixed_point::Celsius;
use hil_sim::plant::STEP_S;
use hil_sim::plant::bridge::Current;
use hil_sim::plant::tile::{Tile, TileParams};
use thermal_display::control::{Control, Watt};
use thermal_display::guard::Setpoint;
use thermal_display::settings::{self, Settings};

/// Room, sink and tile before anything happens, °C.
pub const ROOM_C: f64 = 24.0;

/// Ticks of some seconds.
pub fn ticks(seconds: f64) -> usize {
    (seconds / STEP_S).round() as usize
}

pub fn celsius(t_c: f64) -> Celsius {
    Celsius::saturating_from_num(t_c)
}

pub fn setpoint(t_c: f64) -> Setpoint {
    let (setpoint, limited) = Setpoint::limited(celsius(t_c));
    assert!(!limited, "{t_c} C is not allowed");
    setpoint
}

/// What tuning finds of the class tile under a sensor of 0.1 s (`hil-sim commission`).
pub const FOUND: settings::Tile = settings::Tile {
    gain_k_s_a: 2.91,
    joule_per_a: 0.0585,
    leak_1_s: 0.103,
    sensor_lag_s: 0.1,
    dead_time_s: 0.016,
};

/// Settings for the class tile under a sensor of this lag, s.
pub fn settings(sensor_lag_s: f64) -> Settings {
    settings_of(settings::Tile {
        sensor_lag_s,
        ..FOUND
    })
}

/// Settings for a tile.
pub fn settings_of(tile: settings::Tile) -> Settings {
    let [gains, gains_10hz] = settings::Gains::of_tile(&tile);
    Settings {
        gains,
        gains_10hz,
        tile,
        ..Settings::default()
    }
}

/// A first-order lag, exact for an input that moves in a straight line between ticks.
#[derive(Clone, Debug)]
pub struct Sensor {
    lag_s: f64,
    input_c: f64,
    pub reading_c: f64,
}

impl Sensor {
    pub fn new(lag_s: f64, at_c: f64) -> Self {
        Self {
            lag_s,
            input_c: at_c,
            reading_c: at_c,
        }
    }

    pub fn follow(&mut self, input_c: f64) {
        let slope = (input_c - self.input_c) / STEP_S;
        // Behind a ramp a lag stays by slope times lag.
        let behind = self.reading_c - (self.input_c - slope * self.lag_s);
        self.reading_c = input_c - slope * self.lag_s + behind * (-STEP_S / self.lag_s).exp();
        self.input_c = input_c;
    }
}

/// The law, the tile and the sensor.
#[derive(Clone, Debug)]
pub struct Bench {
    pub control: Control,
    pub tile: Tile,
    sensor: Sensor,
    /// Heat into the patch, and what the law is told of it, W.
    pub load_w: f64,
    pub told_w: f64,
    pub current_a: f64,
}

/// What one tick has led to.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    pub display_c: f64,
    pub current_a: f64,
}

impl Bench {
    pub fn new(settings: &Settings, params: TileParams) -> Self {
        Self {
            control: Control::new(settings),
            tile: Tile::new(params, ROOM_C),
            sensor: Sensor::new(settings.tile.sensor_lag_s, ROOM_C),
            load_w: 0.0,
            told_w: 0.0,
            current_a: 0.0,
        }
    }

    /// The class tile under a sensor that the law knows, held at a temperature until nothing moves.
    pub fn at_rest(sensor_lag_s: f64, t_c: f64) -> Self {
        let mut bench = Self::new(&settings(sensor_lag_s), TileParams::CLASS);
        bench.run(t_c, 60.0);
        bench
    }

    /// The display's surface, °C.
    pub fn display_c(&self) -> f64 {
        self.tile.patch_c() + self.load_w * self.tile.patch_half_k_w()
    }

    /// A tick's current acts on the plate in the next step.
    pub fn tick(&mut self, target_c: f64) -> Tick {
        push(&mut self.tile, self.current_a, self.load_w);
        self.sensor.follow(self.display_c());
        let sensed_c = (self.sensor.reading_c, self.tile.sink_c());
        self.current_a = step(&mut self.control, target_c, sensed_c, self.told_w);
        Tick {
            display_c: self.display_c(),
            current_a: self.current_a,
        }
    }

    pub fn run(&mut self, target_c: f64, seconds: f64) -> Vec<Tick> {
        (0..ticks(seconds)).map(|_| self.tick(target_c)).collect()
    }
}

/// Current of a law that wants a display there, A, by what its and the sink's thermistor read and a load, W.
pub fn step(
    control: &mut Control,
    target_c: f64,
    (reading_c, sink_c): (f64, f64),
    load_w: f64,
) -> f64 {
    control.observe(celsius(reading_c), celsius(sink_c), Watt::from_num(load_w));
    control
        .update(setpoint(target_c), setpoint(target_c))
        .to_num()
}

/// One step of a tile under a current, A, and a load on its patch, W.
pub fn push(tile: &mut Tile, current_a: f64, load_w: f64) {
    tile.prepare(STEP_S);
    tile.drive(Current {
        mean_a: current_a,
        ..Current::default()
    });
    tile.first(STEP_S, load_w, 0.0, 0.0);
    tile.second(0.0);
}

/// Largest minus smallest.
pub fn swing(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    high - low
}

/// The first tick from which on the display stays within a band around a temperature; none if it ends outside.
pub fn settled(ticks: &[Tick], at_c: f64, band_k: f64) -> Option<usize> {
    let outside = |tick: &Tick| (tick.display_c - at_c).abs() > band_k;
    let first = ticks.iter().rposition(outside).map_or(0, |last| last + 1);
    (first < ticks.len()).then_some(first)
}
