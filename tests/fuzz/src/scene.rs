//! The parser of scenes.

use std::path::Path;

use thermal_plant::Plant;
use thermal_plant::bridge::BridgeOutputs;
use thermal_sim::scene::Scene;

const FILE: &str = "scene.toml";

/// Parses a scene. An error begins with the file and one of its lines; an accepted scene can be run.
pub fn run(input: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(input) else {
        return false;
    };
    match Scene::parse(text, Path::new(FILE)) {
        Ok(scene) => check_scene(&scene),
        Err(error) => check_error(&error.to_string(), text),
    }
    true
}

/// The scene's text.
pub fn show(input: &[u8]) -> String {
    String::from_utf8_lossy(input).into_owned()
}

fn check_error(error: &str, text: &str) {
    let place = error.strip_prefix(FILE).and_then(|rest| rest.strip_prefix(':')?.split_once(": "));
    let Some((line, problem)) = place else {
        panic!("no file and line: {error:?}");
    };
    let line: usize = line.parse().unwrap_or_default();
    let lines = 1 + text.matches('\n').count();
    assert!((1..=lines).contains(&line), "line {line} of {lines}: {error:?}");
    assert!(!problem.trim().is_empty(), "no problem: {error:?}");
}

fn check_scene(scene: &Scene) {
    assert!(scene.duration_s > 0.0 && scene.duration_s <= 86_400.0);
    assert!(scene.settle_s.is_finite() && scene.settle_s >= 0.0);
    let preset_c = scene.exact_setpoint_c(0.0, 1.0);
    assert!((15.0..=42.0).contains(&preset_c), "set-point {preset_c} C");
    for force in &scene.forces {
        for t_s in [force.t_s, force.t_s + 0.5 * force.ramp_s, force.t_s + force.ramp_s] {
            let force_n = scene.force_n(t_s);
            assert!((0.0..=10.0).contains(&force_n), "{force_n} N at {t_s} s");
        }
    }
    let during_scene = |t_s: f64| (0.0..=scene.duration_s).contains(&t_s);
    assert!(scene.host.iter().all(|line| during_scene(line.t_s)));
    for fault in &scene.faults {
        let levels = [-1.0, 0.0, 0.5 * scene.duration_s, scene.duration_s].map(|t_s| fault.at(t_s));
        assert_eq!(levels[0], None, "{fault:?} before it begins");
    }
    if let Some(Err(error)) = scene.infrared.map(|infrared| infrared.camera(scene.seed)) {
        panic!("accepted, but no camera: {error}");
    }
    match Plant::new(&scene.plant_config()) {
        Ok(plant) => check_plant(plant),
        Err(error) => panic!("accepted, but no plant: {error}"),
    }
}

/// The temperatures of the first ticks under a finger are plausible.
fn check_plant(mut plant: Plant) {
    plant.set_force(2.0);
    for _ in 0..3 {
        plant.step(&BridgeOutputs::default());
    }
    for celsius in
        [plant.display_c(), plant.skin_c(), plant.skin_real_c(), plant.object_c(), plant.sink_c()]
    {
        assert!((-60.0..=150.0).contains(&celsius), "{celsius} C");
    }
}
