//! Contact detection on the plant's force sensor and converter: when a landing is noticed, when it is said to have
//! been, and what noise alone does.

use documented_figures::assert_figure;
use hil_sim::plant::sensors::{Channel, Sensed, SensorParams, Sensors as Plant};
use thermal_display::sense::{SCANS_PER_TICK, Samples, Sensors, Touch};
use thermal_display::settings::Settings;

/// Scans of a tick before the plant's step (see `hil_sim::engine`).
const SCANS_BEFORE: usize = 4;

/// Force sensor, converter and the device's detection.
struct Bench {
    plant: Plant,
    sensors: Sensors,
    touch: Touch,
    sum: u16,
}

impl Bench {
    fn new(params: SensorParams, seed: u64) -> Self {
        let mut bench = Self {
            plant: Plant::new(params, &state(0.0), seed),
            sensors: Sensors::new(&Settings::default()),
            touch: Touch::default(),
            sum: 0,
        };
        bench.scan(SCANS_BEFORE);
        bench
    }

    fn scan(&mut self, count: usize) {
        self.sum += (0..count)
            .map(|_| self.plant.convert(Channel::Force))
            .sum::<u16>();
    }

    /// One tick, with a force from its step on.
    fn tick(&mut self, force_n: f64) {
        self.plant.step(1e-3, &state(force_n));
        self.scan(SCANS_PER_TICK - SCANS_BEFORE);
        let samples = Samples {
            force: self.sum,
            ..Samples::default()
        };
        let force = self.sensors.read(&samples).force.expect("a sound sensor");
        self.touch.update(force);
        self.sensors.follow_zero(&samples, &self.touch);
        self.sum = 0;
        self.scan(SCANS_BEFORE);
    }

    /// Ticks until a landing is noticed, and how long ago it is then said to have been.
    fn land(&mut self, force_n: f64) -> (u32, u32) {
        for tick in 1..100 {
            self.tick(force_n);
            if self.touch.touching() {
                return (tick, self.touch.landed_ticks());
            }
        }
        panic!("{force_n} N is not noticed");
    }
}

fn state(force_n: f64) -> Sensed {
    Sensed {
        display_c: 30.0,
        sink_c: 25.0,
        skin_before_c: 34.0,
        skin_c: 34.0,
        room_c: 24.0,
        force_n,
        mirror_a: 0.0,
    }
}

/// A sensor within the box: zero and gain off by 2 %, the amplifier's lag, noise and non-linearity.
fn sensor(zero: f64, gain: f64, lag_s: f64, noise_counts: f64) -> SensorParams {
    let mut params = SensorParams::NOMINAL;
    params.force.zero_counts *= 1.0 + zero;
    params.force.counts_per_n *= 1.0 + gain;
    params.force.lag_s = lag_s;
    params.converter.noise_counts = noise_counts;
    params.converter.inl_counts = 3.0;
    params
}

/// The corners of the box.
fn corners() -> impl Iterator<Item = SensorParams> {
    let both = [-0.02, 0.02];
    both.into_iter().flat_map(move |zero| {
        both.into_iter().flat_map(move |gain| {
            [0.2e-3, 1e-3, 5e-3].into_iter().flat_map(move |lag_s| {
                [0.7, 1.2].map(|noise_counts| sensor(zero, gain, lag_s, noise_counts))
            })
        })
    })
}

/// A tick's duty acts 0.27 ms after it, so tick `n` is at `n - 0.27` ms.
#[test]
fn a_tenth_of_a_newton_is_noticed_within_3_ms_and_its_landing_known_to_a_tick() {
    let (mut latest, mut landings, mut off) = (0, 0u32, 0u32);
    for params in corners() {
        for seed in 0..40 {
            let mut bench = Bench::new(params, seed);
            (0..1000).for_each(|_| bench.tick(0.0));
            for force_n in [0.1, 2.0] {
                let (noticed, ago) = bench.land(force_n);
                assert!(
                    noticed.abs_diff(ago) <= 1,
                    "{params:?}, seed {seed}: {ago} of {noticed} ticks"
                );
                latest = latest.max(noticed);
                off += noticed.abs_diff(ago);
                landings += 1;
                (0..500).for_each(|_| bench.tick(0.0));
                assert!(!bench.touch.touching(), "{params:?}: lifted");
            }
        }
    }
    assert_eq!(landings, 1920);
    assert_figure("touch.noticed", latest.into());
    assert_figure(
        "touch.landings_off",
        100.0 * f64::from(off) / f64::from(landings),
    );
}

/// Two hours, of which the zero drifts away by 0.07 N in one.
#[test]
fn noise_and_a_drifting_zero_start_nothing() {
    let mut params = sensor(0.02, 0.02, 0.2e-3, 1.2);
    for drift_n_per_h in [0.0, 0.07] {
        params.force.zero_counts += 1.0;
        let mut bench = Bench::new(params, 7);
        for tick in 0..3_600_000u32 {
            // From below to above: as far as the zero may go.
            bench.tick(drift_n_per_h * (f64::from(tick) / 3.6e6 - 0.95));
            assert!(!bench.touch.touching(), "tick {tick}");
        }
        let (noticed, ago) = bench.land(drift_n_per_h * 0.05 + 0.1);
        assert!(noticed <= 2 && ago == noticed, "{noticed}, {ago}");
    }
}
