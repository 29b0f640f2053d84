//! The plant's electrical parameters against the circuits of `hardware/`: values of their netlists, and what the benches
//! simulate with ngspice.

use std::path::Path;

use hardware_benches::benches;
use hardware_benches::netlist::Netlists;
use hardware_benches::ngspice;
use hardware_benches::quantity::Quantity;
use thermal_display::device::{
    PWM_PERIOD_STEPS_OF_FIVE_FINGERS, PWM_PERIOD_STEPS_OF_ONE_FINGER, PWM_STEPS_PER_SECOND,
};
use thermal_plant::Params;
use thermal_plant::bridge::{Bridge, BridgeOutputs, Leg, Load};
use thermal_plant::parameters;
use thermal_sim::scene::Scene;

fn netlists() -> Netlists {
    Netlists::load().expect("the netlists of the repository")
}

/// The nominal value of a parameter of the plant, and the limits within which it is drawn.
fn plant(key: &str) -> (f64, f64, f64) {
    let all = parameters::all(&Params::nominal());
    let found = all.into_iter().find(|parameter| parameter.key == key);
    let parameter = found.unwrap_or_else(|| panic!("the plant has no {key}"));
    (parameter.value, parameter.low, parameter.high)
}

#[track_caller]
fn assert_near(key: &str, circuit: f64, share: f64) {
    let (nominal, low, high) = plant(key);
    assert!(
        (circuit / nominal - 1.0).abs() <= share,
        "{key} = {nominal}, the circuit has {circuit}"
    );
    assert!(
        (low..=high).contains(&circuit) || low == high,
        "{key}: {circuit} is not within {low} to {high}"
    );
}

#[test]
fn parts_are_those_of_the_netlists() {
    let netlists = netlists();
    let part =
        |name: &str| (netlists.param(name)).unwrap_or_else(|error| panic!("{name}: {error:#}"));
    assert_near("bridge.filter_h", 2.0 * part("l_leg"), 1e-6);
    assert_near("bridge.filter_ohm", 2.0 * part("r_leg"), 1e-6);
    assert_near("bridge.filter_f", part("c_output"), 1e-6);
    assert_near("bridge.filter_esr_ohm", part("esr_output"), 1e-6);
    assert_near("supply.bleeder_ohm", part("r_bleed"), 1e-6);
    assert_near("supply.node_f", part("c_bridge") + part("c_ceramic"), 1e-6);
    let sense = part("r_vbr_bottom") / (part("r_vbr_top") + part("r_vbr_bottom"));
    assert_near("supply.sense_counts_per_v", 4096.0 / 3.3 * sense, 1e-6);
    // The filter of a divider sees pull-up and thermistor in parallel; the two of the current measurement are in series.
    let divider_s = (0.5 * part("r_pull") + part("r_filter")) * part("c_filter");
    assert_near("sensors.divider_lag_s", divider_s, 0.01);
    let mirror_s =
        2.0 * part("r_shunt_filter") * part("c_shunt_filter") + 0.5 * part("r_sum") * part("c_sum");
    assert_near("sensors.mirror.lag_s", mirror_s, 0.02);
}

/// Steps of the PWM timers from scan to scan of the sensors with one finger: 180 MHz by 16 kHz.
const SCAN_STEPS: f64 = 11_250.0;

#[test]
fn plant_and_benches_have_the_pwm_period_of_the_firmware() {
    let period_s = |steps: u16| f64::from(steps) / f64::from(PWM_STEPS_PER_SECOND);
    let one_s = period_s(PWM_PERIOD_STEPS_OF_ONE_FINGER);
    let five_s = period_s(PWM_PERIOD_STEPS_OF_FIVE_FINGERS);
    assert_near("bridge.pwm_hz", one_s.recip(), 1e-12);
    let phase_step = SCAN_STEPS / f64::from(PWM_PERIOD_STEPS_OF_ONE_FINGER) % 1.0;
    assert_near("sensors.mirror.phase_step", phase_step, 1e-3);
    assert_eq!([benches::PERIOD_S, benches::PERIOD_OF_FIVE_FINGERS_S], [one_s, five_s]);

    let scene = |tables: &str| {
        let text = format!(
            "duration_s = 1.0\nskin_c = 34.0\nroom_c = 24.0\nseed = 1\n[object]\nmaterial = \"copper\"\n{tables}"
        );
        Scene::parse(&text, Path::new("a scene")).expect("a scene")
    };
    let on_five_hz = |tables: &str| scene(tables).on_five_fingers().params.bridge.pwm_hz;
    assert!((on_five_hz("") * five_s - 1.0).abs() < 1e-12);
    assert_eq!(on_five_hz("[plant]\nbridge.pwm_hz = 50e3\n"), 50e3);
}

/// The quantities that a bench has simulated.
pub struct Simulated(&'static str, Vec<Quantity>);

impl Simulated {
    pub fn by_bench(name: &'static str, netlists: &Netlists) -> Self {
        let bench = benches::ALL.iter().find(|bench| bench.name == name);
        let bench = bench.unwrap_or_else(|| panic!("no bench is called {name}"));
        let quantities = bench.run(netlists);
        Self(name, quantities.unwrap_or_else(|error| panic!("{name}: {error:#}")))
    }

    /// All of them.
    pub fn quantities(&self) -> &[Quantity] {
        &self.1
    }

    /// The value of the first quantity whose name begins so.
    pub fn of(&self, begin: &str) -> f64 {
        let mut named = self.1.iter().filter(|of| of.name.starts_with(begin));
        let value = named.next().map(|quantity| quantity.value);
        value.unwrap_or_else(|| panic!("{} simulates no {begin}", self.0))
    }
}

#[test]
fn parameters_are_what_the_benches_simulate() {
    if !ngspice::is_installed() {
        println!("skipped: ngspice is not installed, which `cargo xtask hardware` provides");
        return;
    }
    let netlists = netlists();
    let bench = |name: &'static str| Simulated::by_bench(name, &netlists);
    let thresholds = bench("thresholds");
    assert_near("comparator.cold_c", thresholds.of("cold threshold, nominal"), 0.015);
    assert_near("comparator.hot_c", thresholds.of("hot threshold, nominal"), 0.003);
    for (key, quantity) in [
        ("comparator.cold_c", "cold, lowest, circuit"),
        ("comparator.cold_c", "cold, highest, circuit"),
        ("comparator.hot_c", "hot, lowest, circuit"),
        ("comparator.hot_c", "hot, highest, circuit"),
    ] {
        let (_, low, high) = plant(key);
        let simulated_c = thresholds.of(quantity);
        assert!((low..=high).contains(&simulated_c), "{quantity}: {simulated_c}");
    }

    let test = bench("self-test");
    let release = "comparator.release_s";
    assert_near(release, 1e-3 * test.of("hot: test line to nFAULT high"), 0.05);
    let (_, low_s, high_s) = plant(release);
    for which in ["slowest", "fastest"] {
        let simulated_s = 1e-3 * test.of(&format!("test line to nFAULT high, {which}"));
        assert!((low_s..=high_s).contains(&simulated_s), "{which}: {simulated_s}");
    }
    // 120 uF through 150 ohm for 19.4 of 20 ms; the bench has no driver.
    let (node_f, ..) = plant("supply.node_f");
    let (bleeder_ohm, ..) = plant("supply.bleeder_ohm");
    let cut_v = 12.0 * (-19.4e-3 / (bleeder_ohm * node_f)).exp();
    assert!((test.of("hot: bridge supply at the end") - cut_v).abs() < 0.1, "{cut_v}");

    let transients = bench("transients");
    assert_near("bridge.trip_a", transients.of("over-current trip"), 0.02);
    let (_, lowest_a, _) = plant("bridge.trip_a");
    assert!((transients.of("the same, hot MOSFETs") / lowest_a - 1.0).abs() < 0.03);

    let edges = bench("edges");
    let dead_time = "bridge.dead_time_s";
    assert_near(dead_time, 1e-6 * edges.of("effective dead time at +6 A;"), 0.05);
    let (_, _, longest_s) = plant(dead_time);
    assert!(1e-6 * edges.of("effective dead time at +6 A, 50 %") < longest_s);
    // Bridge and filter lose at most what the plant's path does, which includes the leads, at least what its lowest does.
    let (on_ohm, least_on_ohm, _) = plant("bridge.on_ohm");
    let (filter_ohm, least_filter_ohm, _) = plant("bridge.filter_ohm");
    let (loss_w, tile_a) = (edges.of("loss of bridge"), edges.of("tile current"));
    let path_ohm = loss_w / (tile_a * tile_a);
    assert!(
        (least_on_ohm + least_filter_ohm..=on_ohm + filter_ohm).contains(&path_ohm),
        "{path_ohm}"
    );
    // The tile's ripple is nearly a sine.
    let mut bridge = Bridge::new(Params::nominal().bridge, 1.06);
    let half = BridgeOutputs { a: Leg::Duty(1.0), b: Leg::Duty(0.5), enabled: true };
    let load = Load { seebeck_v: 0.0, resistance_ohm: 1.06 };
    let ripple_a = 8f64.sqrt() * bridge.current(1e-3, &half, &load).ripple_a2.sqrt();
    let simulated_a = edges.of("ripple of the tile current");
    assert!((ripple_a / simulated_a - 1.0).abs() < 0.15, "{ripple_a}, {simulated_a}");

    // 2 % of the reading is the error that the plant draws.
    let (_, _, most) = plant("sensors.mirror.gain_error");
    let current = bench("current");
    for (quantity, amperes) in [("reading of 3 A", 3.0), ("reading of 6 A", 6.0)] {
        let error = current.of(quantity) / amperes - 1.0;
        assert!(error.abs() <= most, "{quantity}: {error}");
    }
}
