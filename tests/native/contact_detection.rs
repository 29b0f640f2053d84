//! Contact detection on the simulated force sensor and converter: delay of detection, estimated time of landing, and false
//! detections by noise and drift.

use documented_figures::assert_figure;
use thermal_display::device::sense::{ContactDetector, SCANS_PER_TICK, SampleConverter, Samples};
use thermal_display::settings::Settings;
use thermal_plant::sensors::{Channel, SensorInputs, SensorParams, Sensors as Plant};

/// Scans of a tick before the plant's step (see `thermal_sim::engine`).
const SCANS_BEFORE: usize = 4;

/// Simulated force sensor and converter, read by the device's contact detection.
struct Bench {
    plant: Plant,
    sensors: SampleConverter,
    touch: ContactDetector,
    sum: u16,
}

impl Bench {
    fn new(params: SensorParams, seed: u64) -> Self {
        let mut bench = Self {
            plant: Plant::new(params, &state(0.0), seed),
            sensors: SampleConverter::new(&Settings::default()),
            touch: ContactDetector::default(),
            sum: 0,
        };
        bench.scan(SCANS_BEFORE);
        bench
    }

    fn scan(&mut self, count: usize) {
        self.sum += (0..count).map(|_| self.plant.convert(Channel::Force)).sum::<u16>();
    }

    /// One tick; `force_n` acts from the plant's step within it.
    fn tick(&mut self, force_n: f64) {
        self.plant.step(1e-3, &state(force_n));
        self.scan(SCANS_PER_TICK - SCANS_BEFORE);
        let samples = Samples { force: self.sum, ..Samples::default() };
        let force = self.sensors.convert_samples(&samples).force.expect("a sound sensor");
        self.touch.update_contact(force);
        self.sensors.track_force_zero_unless_touching(&samples, &self.touch);
        self.sum = 0;
        self.scan(SCANS_BEFORE);
    }

    /// Ticks from the landing to its detection, and the number of ticks that the device then estimates to have passed.
    fn land(&mut self, force_n: f64) -> (u32, u32) {
        for tick in 1..100 {
            self.tick(force_n);
            if self.touch.touching() {
                return (tick, self.touch.detection_delay_ticks());
            }
        }
        panic!("{force_n} N is not detected");
    }
}

fn state(force_n: f64) -> SensorInputs {
    SensorInputs {
        display_c: 30.0,
        sink_c: 25.0,
        skin_before_c: 34.0,
        skin_c: 34.0,
        room_c: 24.0,
        force_n,
        mirror_a: 0.0,
        mirror_ripple: thermal_plant::bridge::InductorRipple::default(),
        supply_counts: 0.0,
    }
}

/// A sensor of the parameter box: zero and gain off by 2 %, the amplifier's lag, noise and non-linearity.
fn sensor(zero: f64, gain: f64, lag_s: f64, noise_counts: f64) -> SensorParams {
    let mut params = SensorParams::NOMINAL;
    params.force.zero_counts *= 1.0 + zero;
    params.force.counts_per_n *= 1.0 + gain;
    params.force.lag_s = lag_s;
    params.converter.noise_counts = noise_counts;
    params.converter.inl_counts = 3.0;
    params
}

/// The corners of the parameter box.
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
fn a_force_of_0_1_n_is_detected_within_3_ms_and_its_landing_dated_to_a_tick() {
    let (mut latest, mut landings, mut off) = (0, 0u32, 0u32);
    for params in corners() {
        for seed in 0..40 {
            let mut bench = Bench::new(params, seed);
            (0..1000).for_each(|_| bench.tick(0.0));
            for force_n in [0.1, 2.0] {
                let (detected, estimated) = bench.land(force_n);
                assert!(
                    detected.abs_diff(estimated) <= 1,
                    "{params:?}, seed {seed}: estimated {estimated}, detected after {detected} ticks"
                );
                latest = latest.max(detected);
                off += detected.abs_diff(estimated);
                landings += 1;
                (0..500).for_each(|_| bench.tick(0.0));
                assert!(!bench.touch.touching(), "{params:?}: lifted");
            }
        }
    }
    assert_eq!(landings, 1920);
    assert_figure("touch.noticed", latest.into());
    assert_figure("touch.landings_off", 100.0 * f64::from(off) / f64::from(landings));
}

/// One hour with a constant zero of the sensor, one with a zero that drifts by 0.07 N.
#[test]
fn noise_and_a_drifting_zero_cause_no_detection_in_two_hours() {
    let mut params = sensor(0.02, 0.02, 0.2e-3, 1.2);
    for drift_n_per_h in [0.0, 0.07] {
        params.force.zero_counts += 1.0;
        let mut bench = Bench::new(params, 7);
        for tick in 0..3_600_000u32 {
            // From -0.0665 N to 0.0035 N.
            bench.tick(drift_n_per_h * (f64::from(tick) / 3.6e6 - 0.95));
            assert!(!bench.touch.touching(), "tick {tick}");
        }
        let (detected, estimated) = bench.land(drift_n_per_h * 0.05 + 0.1);
        assert!(detected <= 2 && estimated == detected, "{detected}, {estimated}");
    }
}
