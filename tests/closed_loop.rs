//! The release image makes a finger feel a material when it lands on the preset display: calibrated and tuned, with the
//! sensors, converter and noise that it has.

use std::path::Path;

use documented_figures::{Compiler, assert_compiled, assert_figure};
use hil_sim::engine::Image;
use hil_sim::metrics::{Figures, figures};
use hil_sim::run::Outcome;
use hil_sim::scene::Scene;
use system_tests::{between, forces, image, on_image, scene};

const LANDED_S: f64 = 1.0;
/// How far the device's set-point may be from Eq. 6-12 of the true skin and object, from a time after landing on, s: while
/// the force comes up through its sensor, and what calibration leaves of the others.
const SETPOINT: [(f64, &str); 2] = [(0.01, "10_ms"), (0.025, "25_ms")];

/// Runs a scene of `scenes/`, 2 N for 10 s, and asserts its documented errors.
fn feels(name: &str) -> (Scene, Outcome, Figures) {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let scene = Scene::read(Path::new(&path)).expect("a good scene");
    let outcome = on_image(&scene);
    let figures = figures::<Image>(&scene, &outcome);
    let [skin, display] =
        [&figures.skin_error_mk, &figures.display_error_mk].map(|errors| errors.expect("contact"));
    let skin_max = skin.max_after_50ms.expect("50 ms of contact");
    assert_figure(&format!("scene.{name}_skin_max"), skin_max);
    assert_figure(&format!("scene.{name}_skin_rms"), skin.rms);
    assert_figure(&format!("scene.{name}_display_rms"), display.rms);
    assert!(figures.faults.is_empty(), "{name}: {:?}", figures.faults);
    (scene, outcome, figures)
}

/// The skin as on the material; the display by as much off Eq. 6-12 as brings the skin there.
fn feels_like(material: &str) -> Figures {
    let (scene, outcome, figures) = feels(material);
    let evaluations = figures.kernel_evaluations.expect("an answer");
    assert_figure(&format!("tick.{material}_evaluations"), evaluations as f64);
    follows_equation_6_12(&scene, &outcome);
    follows_golden_values(material, &outcome);
    figures
}

/// The set-point of every tick, against the equation in `f64`.
fn follows_equation_6_12(scene: &Scene, outcome: &Outcome) {
    for (from_s, since) in SETPOINT {
        let mut worst_k = 0.0f64;
        for row in between(outcome, LANDED_S + from_s, 11.0) {
            let device = row.device.as_ref().expect("telemetry of every tick");
            let exact_c = scene.exact_setpoint_c(row.t_s - LANDED_S, row.force_n);
            let error_k = device.setpoint_c.expect("a set-point in contact") - exact_c;
            assert_eq!(
                (device.state.as_str(), device.remark.as_deref()),
                ("contact", None)
            );
            worst_k = worst_k.max(error_k.abs());
        }
        let material = &scene.object.name;
        assert_figure(&format!("setpoint.{material}_{since}"), 1e3 * worst_k);
    }
}

/// And against its values to 30 digits.
fn follows_golden_values(material: &str, outcome: &Outcome) {
    let mut seen = 0;
    for line in include_str!("../model/tests/data/contact.csv").lines() {
        let fields: Vec<&str> = line.split(',').collect();
        if (fields[0], fields[1], fields[5]) != (material, "val_2N", "24") {
            continue;
        }
        let [since_s, exact_c]: [f64; 2] = [8, 14].map(|i| fields[i].parse().expect("a number"));
        if !(0.1..10.0).contains(&since_s) {
            continue;
        }
        let row = between(outcome, LANDED_S + since_s - 1e-6, 11.0)
            .next()
            .expect("a row");
        let setpoint_c = row.device.as_ref().and_then(|device| device.setpoint_c);
        let error_k = setpoint_c.expect("a set-point in contact") - exact_c;
        assert!(
            error_k.abs() < 0.002,
            "{material} after {since_s} s: {error_k} K"
        );
        seen += 1;
    }
    assert!(seen >= 4, "{material}: {seen} golden values");
}

#[test]
fn copper_is_felt() {
    feels_like("copper");
}

#[test]
fn granite_is_felt() {
    let figures = feels_like("granite");
    let compiler = Compiler::of_elf(&std::fs::read(image()).expect("the image"));
    let (instructions, cycles) = (figures.instructions_per_tick, figures.cycles_per_tick);
    for (key, measured) in [
        ("tick.instructions_mean", instructions.mean),
        (
            "tick.instructions_max",
            instructions.max.map(|max| max as f64),
        ),
        ("tick.cycles_mean", cycles.mean),
        ("tick.cycles_max", cycles.max.map(|max| max as f64)),
    ] {
        assert_compiled(key, measured.expect("emulated"), &compiler);
    }
}

#[test]
fn abs_is_felt() {
    feels_like("abs");
}

#[test]
fn foam_is_felt() {
    feels_like("foam");
}

/// Chapter 4's constant temperature of Eq. 3-1: the display is where it should be, and the skin is not.
#[test]
fn the_first_display_of_the_thesis_is_too_warm() {
    feels("granite-semi-infinite");
    feels("abs-semi-infinite");
}

/// A device that nobody calibrated or tuned knows skin and force to its parts' tolerances only: up to 1.5 counts of
/// non-linearity, 0.04 K, and leads that cool the skin's thermistor by 0.1 K.
#[test]
fn uncommissioned_set_point_is_equation_6_12_of_what_the_device_measures() {
    let tables = "[device]\ncommissioned = false\n".to_owned() + &forces(&[(0.5, 1.0)]);
    let scene = scene("granite", 6.0, "", &tables);
    let outcome = on_image(&scene);
    for row in between(&outcome, 0.52, 6.0) {
        let device = row.device.as_ref().expect("telemetry of every tick");
        let exact_c = scene.exact_setpoint_c(row.t_s - 0.5, row.force_n);
        let error_k = device.setpoint_c.expect("a set-point in contact") - exact_c;
        assert_eq!(device.state, "contact");
        assert!(error_k.abs() < 0.06, "at {} s: {error_k} K", row.t_s);
    }
}
