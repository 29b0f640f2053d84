//! Contact detection on the simulated force sensor and converter: delay of detection, estimated time of landing, and false
//! detections by noise and drift.

use std::f64::consts::TAU;

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
    /// Number of the last tick.
    number: u32,
}

impl Bench {
    fn new(params: SensorParams, seed: u64) -> Self {
        let mut bench = Self {
            plant: Plant::new(params, &state(0.0), seed),
            sensors: SampleConverter::new(&Settings::default()),
            touch: ContactDetector::default(),
            sum: 0,
            number: 0,
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
        self.number += 1;
        let samples = Samples { force: self.sum, ..Samples::default() };
        let force = self.sensors.convert_samples(&samples).force.expect("a sound sensor");
        let below_zero = self.sensors.is_force_below_zero();
        let zero_has_moved = self.touch.update_contact(self.number, force, below_zero);
        self.sensors.track_force_zero_unless_touching(&samples, force, &self.touch, zero_has_moved);
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

/// A sensor whose stack of 0.5 kg resonates at this frequency, Hz, on its cell.
fn soft_sensor(resonance_hz: f64) -> SensorParams {
    let mut params = sensor(0.0, 0.0, 1e-3, 1.2);
    let rad_s = TAU * resonance_hz;
    params.force.cell.compliance_m_n = 1.0 / (params.force.cell.mass_kg * rad_s * rad_s);
    params
}

/// Ticks of the landings and lifts, by the detector, while a force acts that is given by the tick.
fn touch_changes(bench: &mut Bench, ticks: u32, force_n: impl Fn(u32) -> f64) -> Vec<u32> {
    let changed = |tick: &u32| {
        let before = bench.touch.touching();
        bench.tick(force_n(*tick));
        bench.touch.touching() != before
    };
    (0..ticks).filter(changed).collect()
}

/// A finger that lands within 20 ms and lifts within 10 to 40 ms, on cells that resonate at 41 to 1000 Hz with a damping of 0.03, and
/// one of 0.1 N that lands 0.6 s after the lift.
#[test]
fn a_ringing_cell_shows_one_landing_and_one_lift() {
    println!(
        "| resonance, Hz | force, N | lift within, ms | lift found after, ms | 0.1 N found after, ms |"
    );
    let (mut latest_lift, mut latest_landing) = (0, 0);
    for resonance_hz in [41.0, 58.0, 80.0, 120.0, 200.0, 400.0, 1000.0] {
        for (force_n, lift_ms) in
            [0.5, 2.0, 5.0].into_iter().flat_map(|force| [1, 10, 15, 20, 40].map(|ms| (force, ms)))
        {
            let mut bench = Bench::new(soft_sensor(resonance_hz), 5);
            (0..1000).for_each(|_| bench.tick(0.0));
            let ramp = |tick: u32, ms: u32| (f64::from(tick) / f64::from(ms)).min(1.0);
            let changes = touch_changes(&mut bench, 3000, |tick| match tick {
                0..1500 => force_n * ramp(tick, 20),
                tick => force_n * (1.0 - ramp(tick - 1500, lift_ms)),
            });
            let of = format!("{resonance_hz} Hz, {force_n} N, {lift_ms} ms: {changes:?}");
            let [_, lift] = changes[..] else { panic!("{of}") };
            let lift = lift - 1500;
            let mut bench = Bench::new(soft_sensor(resonance_hz), 6);
            (0..1000).for_each(|_| bench.tick(0.0));
            let changes = touch_changes(&mut bench, 3000, |tick| match tick {
                0..1500 => force_n * ramp(tick, 20),
                1500..2100 => force_n * (1.0 - ramp(tick - 1500, lift_ms)),
                _ => 0.1,
            });
            let [_, _, landing] = changes[..] else { panic!("{of}, then {changes:?}") };
            let landing = landing - 2100;
            println!("| {resonance_hz} | {force_n} | {lift_ms} | {lift} | {landing} |");
            (latest_lift, latest_landing) = (latest_lift.max(lift), latest_landing.max(landing));
        }
    }
    assert_figure("touch.soft_lift", latest_lift.into());
    assert_figure("touch.soft_landing", latest_landing.into());
}

/// A vibration of 15 and 50 mN at 30 to 200 Hz, alone and with a finger of 0.1 N.
#[test]
fn a_vibration_of_the_fan_begins_no_contact_and_delays_one_by_less_than_100_ms() {
    println!("| vibration, mN | frequency, Hz | resonance, Hz | 0.1 N found after, ms |");
    let mut latest = 0;
    for (vibration_n, vibration_hz) in
        [0.015, 0.05].into_iter().flat_map(|n| [30.0, 47.0, 90.0, 200.0].map(|hz| (n, hz)))
    {
        for resonance_hz in [41.0, 200.0, 1000.0] {
            let mut params = soft_sensor(resonance_hz);
            params.force.cell.vibration_n = vibration_n;
            params.force.cell.vibration_hz = vibration_hz;
            let mut bench = Bench::new(params, 7);
            let changes = touch_changes(&mut bench, 30_000, |tick| match tick {
                10_000..20_000 => 0.1,
                _ => 0.0,
            });
            let of = format!("{vibration_n} N, {vibration_hz} Hz on {resonance_hz} Hz");
            let [landing, lift] = changes[..] else { panic!("{of}: {changes:?}") };
            let (landing, lift) = (landing - 10_000, lift - 20_000);
            println!(
                "| {:.0} | {vibration_hz} | {resonance_hz} | {landing} |",
                1000.0 * vibration_n
            );
            assert!(lift < 600, "{of}: lift after {lift} ms");
            latest = latest.max(landing);
        }
    }
    assert_figure("touch.vibrating_landing", latest.into());
}

/// Else the self-test, which waits for a finger to go, would never end.
#[test]
fn a_vibration_never_looks_like_a_finger_that_presses() {
    for vibration_n in [0.002, 0.004, 0.006, 0.0075, 0.0085, 0.0095, 0.012, 0.02, 0.05] {
        for vibration_hz in [30.0, 31.2, 47.0, 200.0] {
            for resonance_hz in [41.0, 1000.0] {
                let mut params = soft_sensor(resonance_hz);
                params.force.cell.vibration_n = vibration_n;
                params.force.cell.vibration_hz = vibration_hz;
                let mut bench = Bench::new(params, 11);
                (0..2000).for_each(|_| bench.tick(0.0));
                for tick in 0..20_000 {
                    bench.tick(0.0);
                    let of = format!("{vibration_n} N, {vibration_hz} Hz on {resonance_hz} Hz");
                    assert!(!bench.touch.presses_steadily(), "{of}, tick {tick}");
                }
            }
        }
    }
}

/// A zero that moves by 2 mN/s to 150 mN either way: at rest, and hidden by a finger of 1 N that stays for 100 s.
#[test]
fn a_drift_of_the_zero_ends_every_contact_that_a_finger_has_ended() {
    for drift_n_s in [-2e-3, 2e-3] {
        let mut params = sensor(0.0, 0.0, 1e-3, 1.2);
        params.force.cell.drift_n_s = drift_n_s;
        let mut bench = Bench::new(params, 8);
        let resting = touch_changes(&mut bench, 120_000, |_| 0.0);
        assert_eq!(resting, [0; 0], "{drift_n_s} N/s");
        assert_eq!(bench.land(0.1).0, 2, "{drift_n_s} N/s");
        let mut bench = Bench::new(params, 9);
        let changes = touch_changes(&mut bench, 160_000, |tick| match tick {
            2_000..102_000 => 1.0,
            _ => 0.0,
        });
        let [_, lift] = changes[..] else { panic!("{drift_n_s} N/s: {changes:?}") };
        println!("{drift_n_s} N/s: lift found after {} ms", lift - 102_000);
        assert!(lift - 102_000 < 1000, "{drift_n_s} N/s: {lift}");
        assert_eq!(bench.land(0.1).0, 2, "{drift_n_s} N/s");
    }
}
