//! Identification of a simulated tile that obeys the equations that the identification assumes.

use std::collections::VecDeque;

use contact_model::fixed_point::{Celsius, Force};

use crate::SessionError;
use crate::tile_identification::{IdentificationError, tile_from_normal_equations};
use thermal_device::command::Refused;
use thermal_device::drive::Current;
use thermal_device::identification::{AbortReason, Identification, NormalEquationAccumulator};
use thermal_device::safety::ValidReadings;
use thermal_device::sense::SupplyVoltage;
use thermal_settings::Tile;

/// A simulated tile with its bridge and current mirror.
struct Plant {
    tile: Tile,
    /// Ratio of flowing to demanded current.
    flowing_ratio: f64,
    /// Current that the dead times of the bridge take, A.
    lost_a: f64,
    /// Current that the mirror measures, A, for a flowing current, A.
    mirror: fn(f64) -> f64,
    plate_c: f64,
    reading_c: f64,
    sink_c: f64,
    /// Low-pass filtered current, A: the part that the legs delay.
    legs_a: f64,
    /// Low-pass filtered square of the current, A^2: Joule heat on its way up the legs.
    joule_a2: f64,
    /// Currents within the dead time.
    delayed: VecDeque<f64>,
    /// Disturbance of the reading, K, at a tick.
    disturbance: fn(u32) -> f64,
}

impl Plant {
    fn new(tile: Tile) -> Self {
        Self {
            tile,
            flowing_ratio: 1.0,
            lost_a: 0.0,
            mirror: f64::abs,
            plate_c: 27.0,
            reading_c: 27.0,
            sink_c: 25.0,
            legs_a: 0.0,
            joule_a2: 0.0,
            delayed: std::iter::repeat_n(0.0, (tile.dead_time_s * 1e3).round() as usize - 1)
                .collect(),
            disturbance: |_| 0.0,
        }
    }

    /// Advances by one millisecond, and returns the measured current.
    fn step(&mut self, demanded: Current) -> Current {
        let demanded_a = demanded.to_num::<f64>();
        let lost_a = self.lost_a.min(demanded_a.abs()).copysign(demanded_a);
        let flowing_a = self.flowing_ratio * (demanded_a - lost_a);
        self.delayed.push_back(flowing_a);
        let current_a = self.delayed.pop_front().expect("one was pushed");
        self.legs_a += 1e-3 * (current_a - self.legs_a) / 0.11;
        self.joule_a2 += 1e-3 * (current_a * current_a - self.joule_a2) / 0.149;
        let legs_part = 1933.0 / 32768.0;
        let pumped_a = current_a - legs_part * self.legs_a - self.tile.joule_per_a * self.joule_a2;
        let leak_k_s = self.tile.leak_1_s * (self.plate_c - self.sink_c);
        self.plate_c -= 1e-3 * (self.tile.gain_k_s_a * pumped_a + leak_k_s);
        self.reading_c += 1e-3 * (self.plate_c - self.reading_c) / self.tile.sensor_lag_s;
        Current::saturating_from_num((self.mirror)(flowing_a))
    }

    fn readings(&self, tick: u32, current: Current) -> ValidReadings {
        let c = |t_c: f64| Celsius::saturating_from_num(t_c);
        ValidReadings {
            display: c(self.reading_c + (self.disturbance)(tick)),
            check: c(self.reading_c),
            sink: c(self.sink_c),
            skin: c(33.0),
            room: c(24.0),
            force: Force::ZERO,
            current,
            supply: SupplyVoltage::from_volts(12.0),
        }
    }

    /// Runs the pulses and the identification; a finger touches the display from one tick on.
    fn identify(mut self, touched_from: u32) -> Result<Tile, SessionError> {
        let mut equations = NormalEquationAccumulator::default();
        let mut identification =
            Identification::begin_at_sink_temperature(Celsius::saturating_from_num(self.sink_c));
        let mut measured = Current::ZERO;
        for tick in 0..80_000 {
            match identification.outcome() {
                Some(Ok(())) => {
                    return tile_from_normal_equations(equations.rows_and_statistics())
                        .map_err(SessionError::Identification);
                }
                Some(Err(why)) => return Err(Refused::TuneAborted(why).into()),
                None => {}
            }
            let touching = tick >= touched_from;
            let readings = self.readings(tick, measured);
            let current = identification.step(&mut equations, &readings, touching);
            measured = self.step(current.unwrap_or(Current::ZERO));
        }
        panic!("the identification did not end within 80 s");
    }
}

const TILE: Tile = Tile {
    gain_k_s_a: 2.9,
    joule_per_a: 0.06,
    leak_1_s: 0.1,
    sensor_lag_s: 0.1,
    dead_time_s: 0.016,
};
const UNTOUCHED: u32 = u32::MAX;

/// The parameters cover the tolerances of a module and beyond. The identified gain and Joule term are per demanded
/// current, so they are proportional to the ratio of flowing to demanded current. Leak and Joule term are the least
/// certain: their effect is small within eight seconds of pulses behind a slow sensor.
#[test]
fn parameters_of_a_simulated_tile_are_identified() {
    for lag in [0.02, 0.05, 0.1, 0.3, 0.5] {
        for (gain, joule, leak, flowing_ratio) in [
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
            plant.flowing_ratio = flowing_ratio;
            let found = plant.identify(UNTOUCHED).expect("a tile");
            let near = |found: f64, expected: f64, relative: f64, absolute: f64| {
                (found - expected).abs() < relative * expected + absolute
            };
            assert!(near(found.gain_k_s_a, gain * flowing_ratio, 0.01, 0.0), "{found:?}, {tile:?}");
            assert!(
                near(found.joule_per_a, joule * flowing_ratio, 0.02, 1.5e-3),
                "{found:?}, {tile:?}"
            );
            assert!(near(found.leak_1_s, leak, 0.03, 0.01), "{found:?}, {tile:?}");
            assert!(near(found.sensor_lag_s, lag, 0.015, 1e-3), "{found:?}, {tile:?}");
            assert!(near(found.dead_time_s, 0.016, 0.0, 1.5e-3), "{found:?}, {tile:?}");
        }
    }
}

/// The dead times of this bridge take 0.2 A from any current: much of a small one, little of a large one.
#[test]
fn the_identified_gain_is_that_of_large_currents() {
    let mut plant = Plant::new(TILE);
    plant.lost_a = 0.2;
    let found = plant.identify(UNTOUCHED).expect("a tile");
    let ratio = found.gain_k_s_a / TILE.gain_k_s_a;
    // That of currents between 2.5 and 6 A.
    assert!((1.0 - 0.2 / 2.5..1.0 - 0.2 / 6.0).contains(&ratio), "{ratio}");
}

#[test]
fn a_zero_error_of_the_mirror_does_not_shift_the_gain() {
    let gain_k_s_a = |mirror: fn(f64) -> f64| {
        let mut plant = Plant::new(TILE);
        plant.mirror = mirror;
        plant.identify(UNTOUCHED).expect("a tile").gain_k_s_a
    };
    let sound = gain_k_s_a(f64::abs);
    for off in [gain_k_s_a(|a| (a.abs() - 0.05).max(0.0)), gain_k_s_a(|a| a.abs() + 0.05)] {
        assert!((off / sound - 1.0).abs() < 2.5e-4, "{off}, {sound}");
    }
}

#[test]
fn each_reason_to_abort_is_reported() {
    assert_eq!(
        Plant::new(TILE).identify(0),
        Err(Refused::TuneAborted(AbortReason::Touched).into())
    );
    assert_eq!(
        Plant::new(TILE).identify(9000),
        Err(Refused::TuneAborted(AbortReason::Touched).into())
    );
    let mut hot = Plant::new(TILE);
    hot.sink_c = 42.6;
    assert_eq!(hot.identify(UNTOUCHED), Err(Refused::TuneAborted(AbortReason::SinkHot).into()));
    let mut disturbed = Plant::new(TILE);
    disturbed.disturbance = |tick| if tick / 700 % 2 == 0 { 0.1 } else { -0.1 };
    assert_eq!(
        disturbed.identify(UNTOUCHED),
        Err(Refused::TuneAborted(AbortReason::NotSettled).into())
    );
    // Starts in its steady state, and then moves by eight times the 2.3 K that the pulses are made for.
    let mut sensitive = Plant::new(Tile { gain_k_s_a: 24.0, ..TILE });
    sensitive.reading_c = 25.0;
    sensitive.plate_c = 25.0;
    assert_eq!(
        sensitive.identify(UNTOUCHED),
        Err(Refused::TuneAborted(AbortReason::TooFar).into())
    );
}

#[test]
fn a_thermistor_that_lags_too_much_is_refused() {
    for (lag_s, is_refused) in [(0.5, false), (0.58, false), (0.62, true), (1.0, true), (2.0, true)]
    {
        let found = Plant::new(Tile { sensor_lag_s: lag_s, ..TILE }).identify(UNTOUCHED);
        assert_eq!(found.is_err(), is_refused, "{lag_s} s: {found:?}");
        let Err(error) = found else { continue };
        let SessionError::Identification(IdentificationError::OutOfRange(range, value)) = &error
        else {
            panic!("{lag_s} s: {error:?}")
        };
        assert_eq!((range.name, range.max), ("lag", 0.6), "{lag_s} s");
        assert!((value / lag_s - 1.0).abs() < 0.04, "{lag_s} s: {value} s");
    }
}

/// No measured current overflows a sum.
#[test]
fn defects_are_told_apart_from_a_tile() {
    let with = |change: fn(&mut Plant)| {
        let mut plant = Plant::new(TILE);
        change(&mut plant);
        plant.identify(UNTOUCHED)
    };
    let assert_current_ratio = |found: Result<Tile, SessionError>, low: f64, high: f64| {
        assert!(
            matches!(found, Err(SessionError::Identification(IdentificationError::CurrentRatio(ratio))) if ratio >= low && ratio <= high),
            "{found:?}"
        );
    };
    assert_current_ratio(with(|plant| plant.mirror = |_| 0.0), 0.0, 1e-6);
    assert_current_ratio(with(|plant| plant.mirror = |_| 10.23), 2.27, 2.28);
    assert_current_ratio(with(|plant| plant.mirror = |a| 2.0 * a.abs()), 1.99, 2.01);
    // A mirror stuck at its limit, and a steady state that needs a current.
    let stuck = with(|plant| {
        plant.mirror = |_| 127.9;
        plant.sink_c = 41.0;
    });
    assert_current_ratio(stuck, 4.0, 200.0);
    // The display does not respond to any current: the mirror works, the module does not.
    let unresponsive = with(|plant| {
        plant.tile.gain_k_s_a = 0.0;
        (plant.plate_c, plant.reading_c) = (25.0, 25.0);
    });
    assert!(matches!(unresponsive, Err(SessionError::Identification(_))), "{unresponsive:?}");
    // A finger too light for the force sensor comes and goes from the first pulse on.
    let rubbed = with(|plant| {
        (plant.plate_c, plant.reading_c) = (25.0, 25.0);
        plant.disturbance = |tick| {
            if tick > 3000 && tick / 400 % 2 == 0 { 1.5 } else { 0.0 }
        };
    });
    assert!(
        matches!(&rubbed, Err(SessionError::Identification(IdentificationError::OutOfRange(range, _))) if range.name == "dead time"),
        "{rubbed:?}"
    );
    // A thermistor comes loose during the long pulses.
    let loose = with(|plant| {
        (plant.plate_c, plant.reading_c) = (25.0, 25.0);
        plant.disturbance = |tick| if tick > 7000 && tick < 8500 { 3.0 } else { 0.0 };
    });
    assert!(
        matches!(loose, Err(SessionError::Identification(IdentificationError::ModelMismatch(_)))),
        "{loose:?}"
    );
}
