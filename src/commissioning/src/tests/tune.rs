//! Tuning of a tile that is computed here, by the equations that the experiment is said to fit.

use std::collections::VecDeque;

use contact_model::fixed_point::{Celsius, Force};

use crate::Error;
use crate::identify::{NoTile, identify};
use thermal_device::command::Refused;
use thermal_device::drive::Current;
use thermal_device::identification::{Aborted, Experiment};
use thermal_device::safety::Sound;
use thermal_settings::Tile;

/// A tile that answers current.
struct Plant {
    tile: Tile,
    /// Current that flows for one that is asked for.
    flows: f64,
    /// What its dead times take from it, A.
    lost_a: f64,
    /// What the mirror shows of a current.
    mirror: fn(f64) -> f64,
    plate_c: f64,
    reading_c: f64,
    sink_c: f64,
    late: f64,
    heat: f64,
    /// Currents on their way.
    dead: VecDeque<f64>,
    /// Added to the reading, K, at a tick.
    disturbance: fn(u32) -> f64,
}

impl Plant {
    fn new(tile: Tile) -> Self {
        Self {
            tile,
            flows: 1.0,
            lost_a: 0.0,
            mirror: f64::abs,
            plate_c: 27.0,
            reading_c: 27.0,
            sink_c: 25.0,
            late: 0.0,
            heat: 0.0,
            dead: std::iter::repeat_n(0.0, (tile.dead_time_s * 1e3).round() as usize - 1).collect(),
            disturbance: |_| 0.0,
        }
    }

    /// One millisecond; what the mirror shows.
    fn step(&mut self, asked: Current) -> Current {
        let asked_a = asked.to_num::<f64>();
        let lost_a = self.lost_a.min(asked_a.abs()).copysign(asked_a);
        let flowing_a = self.flows * (asked_a - lost_a);
        self.dead.push_back(flowing_a);
        let current_a = self.dead.pop_front().expect("one was pushed");
        self.late += 1e-3 * (current_a - self.late) / 0.11;
        self.heat += 1e-3 * (current_a * current_a - self.heat) / 0.149;
        let part = 1933.0 / 32768.0;
        let pumped = current_a - part * self.late - self.tile.joule_per_a * self.heat;
        let leaving = self.tile.leak_1_s * (self.plate_c - self.sink_c);
        self.plate_c -= 1e-3 * (self.tile.gain_k_s_a * pumped + leaving);
        self.reading_c += 1e-3 * (self.plate_c - self.reading_c) / self.tile.sensor_lag_s;
        Current::saturating_from_num((self.mirror)(flowing_a))
    }

    fn sound(&self, tick: u32) -> Sound {
        let c = |t_c: f64| Celsius::saturating_from_num(t_c);
        Sound {
            display: c(self.reading_c + (self.disturbance)(tick)),
            check: c(self.reading_c),
            sink: c(self.sink_c),
            skin: c(33.0),
            room: c(24.0),
            force: Force::ZERO,
        }
    }

    /// Lets it be tuned; a finger lands at some tick.
    fn tune(mut self, touched_at: u32) -> Result<Tile, Error> {
        let mut experiment = Experiment::new(Celsius::saturating_from_num(self.sink_c));
        let mut measured = Current::ZERO;
        for tick in 0..80_000 {
            match experiment.outcome() {
                Some(Ok(rows)) => return identify(rows).map_err(Error::NoTile),
                Some(Err(why)) => return Err(Refused::TuneAborted(why).into()),
                None => {}
            }
            let current = experiment.update(&self.sound(tick), measured, tick >= touched_at);
            measured = self.step(current.unwrap_or(Current::ZERO));
        }
        panic!("80 s are over");
    }
}

const TILE: Tile = Tile {
    gain_k_s_a: 2.9,
    joule_per_a: 0.06,
    leak_1_s: 0.1,
    sensor_lag_s: 0.1,
    dead_time_s: 0.016,
};
const NEVER: u32 = u32::MAX;

/// Leak and Joule's heat are small in eight seconds of pulses behind a slow sensor, so they are known least.
///
/// Whatever the values within and around a module's tolerances: nearly those that the tile was computed with. With what
/// flows of the current asked for, the gain per ampere asked for is so much less and Joule's term too.
#[test]
fn tile_that_is_the_model_is_found() {
    for lag in [0.02, 0.05, 0.1, 0.3, 0.5] {
        for (gain, joule, leak, flows) in [
            (2.9, 0.06, 0.1, 1.0),
            (2.0, 0.04, 0.05, 0.9),
            (4.0, 0.08, 0.2, 1.1),
            (1.0, 0.002, 0.02, 1.0),
        ] {
            let tile = Tile {
                gain_k_s_a: gain,
                joule_per_a: joule,
                leak_1_s: leak,
                sensor_lag_s: lag,
                ..TILE
            };
            let mut plant = Plant::new(tile);
            plant.flows = flows;
            let found = plant.tune(NEVER).expect("a tile");
            let near = |found: f64, expected: f64, relative: f64, absolute: f64| {
                (found - expected).abs() < relative * expected + absolute
            };
            assert!(
                near(found.gain_k_s_a, gain * flows, 0.01, 0.0),
                "{found:?}, {tile:?}"
            );
            assert!(
                near(found.joule_per_a, joule * flows, 0.02, 1.5e-3),
                "{found:?}, {tile:?}"
            );
            assert!(
                near(found.leak_1_s, leak, 0.03, 0.01),
                "{found:?}, {tile:?}"
            );
            assert!(
                near(found.sensor_lag_s, lag, 0.015, 1e-3),
                "{found:?}, {tile:?}"
            );
            assert!(
                near(found.dead_time_s, 0.016, 0.0, 1.5e-3),
                "{found:?}, {tile:?}"
            );
        }
    }
}

/// Twice the dead time takes 0.2 A of any current: much of those of the pulses, little of those that move the display far.
#[test]
fn gain_is_that_of_large_currents_where_a_bridge_loses_some() {
    let mut plant = Plant::new(TILE);
    plant.lost_a = 0.2;
    let found = plant.tune(NEVER).expect("a tile");
    let part = found.gain_k_s_a / TILE.gain_k_s_a;
    // Of 2.5 to 6 A.
    assert!((1.0 - 0.2 / 2.5..1.0 - 0.2 / 6.0).contains(&part), "{part}");
}

#[test]
fn each_reason_to_end_is_told() {
    assert_eq!(
        Plant::new(TILE).tune(0),
        Err(Refused::TuneAborted(Aborted::Finger).into())
    );
    assert_eq!(
        Plant::new(TILE).tune(9000),
        Err(Refused::TuneAborted(Aborted::Finger).into())
    );
    let mut hot = Plant::new(TILE);
    hot.sink_c = 42.6;
    assert_eq!(
        hot.tune(NEVER),
        Err(Refused::TuneAborted(Aborted::Sink).into())
    );
    let mut restless = Plant::new(TILE);
    restless.disturbance = |tick| if tick / 700 % 2 == 0 { 0.1 } else { -0.1 };
    assert_eq!(
        restless.tune(NEVER),
        Err(Refused::TuneAborted(Aborted::Restless).into())
    );
    // It is at rest, so it begins; what the pulses would move by 2.3 K moves by eight times that.
    let mut wild = Plant::new(Tile {
        gain_k_s_a: 24.0,
        ..TILE
    });
    wild.reading_c = 25.0;
    wild.plate_c = 25.0;
    assert_eq!(
        wild.tune(NEVER),
        Err(Refused::TuneAborted(Aborted::Display).into())
    );
}

/// What is broken is told apart from what is a tile, whatever the mirror shows, and no sum overflows.
#[test]
fn what_is_no_tile_is_named() {
    let with = |change: fn(&mut Plant)| {
        let mut plant = Plant::new(TILE);
        change(&mut plant);
        plant.tune(NEVER)
    };
    let current = |found: Result<Tile, Error>, low: f64, high: f64| {
        assert!(
            matches!(found, Err(Error::NoTile(NoTile::Current(part))) if part >= low && part <= high),
            "{found:?}"
        );
    };
    current(with(|plant| plant.mirror = |_| 0.0), 0.0, 1e-6);
    current(with(|plant| plant.mirror = |_| 10.23), 2.27, 2.28);
    current(with(|plant| plant.mirror = |a| 2.0 * a.abs()), 1.99, 2.01);
    // Stuck, and in the middle of a rest that needs a current.
    let stuck = with(|plant| {
        plant.mirror = |_| 127.9;
        plant.sink_c = 41.0;
    });
    current(stuck, 4.0, 200.0);
    // The display at rest whatever flows: an unplugged module under a mirror that works.
    let dead = with(|plant| {
        plant.tile.gain_k_s_a = 0.0;
        (plant.plate_c, plant.reading_c) = (25.0, 25.0);
    });
    assert!(matches!(dead, Err(Error::NoTile(_))), "{dead:?}");
    // A finger that is too light to be felt comes and goes, from the first pulse on.
    let rubbed = with(|plant| {
        (plant.plate_c, plant.reading_c) = (25.0, 25.0);
        plant.disturbance = |tick| {
            if tick > 3000 && tick / 400 % 2 == 0 {
                1.5
            } else {
                0.0
            }
        };
    });
    assert!(
        matches!(&rubbed, Err(Error::NoTile(NoTile::Beyond(what, _))) if what.name == "dead time"),
        "{rubbed:?}"
    );
    // A thermistor that comes loose in the long pulses.
    let loose = with(|plant| {
        (plant.plate_c, plant.reading_c) = (25.0, 25.0);
        plant.disturbance = |tick| if tick > 7000 && tick < 8500 { 3.0 } else { 0.0 };
    });
    assert!(
        matches!(loose, Err(Error::NoTile(NoTile::Unlike(_)))),
        "{loose:?}"
    );
}
