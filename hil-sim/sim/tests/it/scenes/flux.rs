//! The heat-flux sensor that a scene's device has, or believes to have.

use thermal_sim::World;
use thermal_sim::commissioning::settings_for_scene;
use thermal_sim::engine::NativeEngine;
use thermal_sim::run::{Outcome, run};
use thermal_sim::trace::TraceRow;

use super::scene;

/// A layered finger on granite, to which the device is told something before the object appears.
fn outcome(device: &str, told: &str) -> Outcome {
    let text = format!(
        "duration_s = 4\nskin_c = 34\nroom_c = 24\n[device]\n{device}\n[finger]\ntissue = \"layered\"\n\
         [object]\nmaterial = \"granite\"\nappears_t_s = 0.2\n[[force]]\nt_s = 0.7\nforce_n = 2\n\
         [[host]]\nt_s = 0.01\nline = \"{told}\"\n[[host]]\nt_s = 0.15\nline = \"events on\"\n\
         [[host]]\nt_s = 3.9\nline = \"flux\"\n"
    );
    let scene = scene(&text);
    let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
    run(&scene, &mut engine, |_| ()).expect("the device takes the scene")
}

/// The last word of the answer to the last `flux`.
pub(super) fn word(outcome: &Outcome) -> &str {
    let (_, answer) = outcome.answers.last().expect("answers");
    answer.rsplit_once(' ').map_or("", |(_, word)| word)
}

/// Reported events of the learnt finger.
fn flux_events(outcome: &Outcome) -> usize {
    let events = outcome.events.iter();
    events.filter(|(_, line)| line.ends_with(" flux")).count()
}

pub(super) fn setpoints(outcome: &Outcome) -> Vec<f64> {
    let row = |row: &TraceRow| row.device.as_ref().and_then(|one| one.setpoint_c);
    outcome.trace.rows().iter().filter_map(row).collect()
}

#[test]
fn the_operator_tells_the_device_of_the_sensor_that_it_has() {
    let with = outcome("flux_sensor = true", "state");
    assert_eq!(word(&with), "finger=trusted");
    assert_eq!(flux_events(&with), 1);
    let without = outcome("", "state");
    assert_eq!(word(&without), "flux=none");
    assert_eq!(flux_events(&without), 0);
}

/// The first person that was answered.
fn person(outcome: &Outcome) -> &str {
    let answers = outcome.answers.iter();
    let mut answers = answers.filter_map(|(_, line)| line.strip_prefix("ok person="));
    let answer = answers.next().unwrap_or_default();
    answer.split(' ').next().unwrap_or_default()
}

/// A finger with 1.6 times the mean contact resistance, of which the device knows before it lands, or not.
#[test]
fn an_enrolled_finger_is_known_and_trusted_in_its_first_contact() {
    const PLANT: &str = "\n[plant]\nfinger.resistance_factor = 1.6\n";
    let unknown = outcome(&format!("flux_sensor = true{PLANT}"), "person");
    let known = outcome(&format!("flux_sensor = true\nenrolled = true{PLANT}"), "person");
    assert_eq!(person(&known), "P01");
    assert_eq!(person(&unknown), "none");
    assert_eq!(word(&known), "finger=trusted");
    // From the word `learning` on, without a distrust.
    assert_eq!(flux_events(&known), 1);
    // The display waits for another finger, 10 ms before the landing.
    let before_landing = |outcome: &Outcome| {
        let row = outcome.trace.rows().iter().find(|row| row.t_s >= 0.69);
        let setpoint_c = row.and_then(|row| row.device.as_ref()?.setpoint_c);
        setpoint_c.expect("a set-point")
    };
    let off_k = before_landing(&known) - before_landing(&unknown);
    assert!(off_k > 0.05, "{off_k} K");
}

/// Its skin and what the thermistor shows of it have not recovered when the finger lands on the second object of the enrolment.
#[test]
fn a_finger_is_enrolled_whose_thermistor_sees_much_of_the_contact() {
    let device = "flux_sensor = true\nenrolled = true\n[plant]\nsensors.skin_sees_contact = 0.32\n";
    assert_eq!(person(&outcome(device, "person")), "P01");
}

/// Told of a sensor that its board has not, a device renders the finger that it assumes; told of none, it takes no notice of one.
#[test]
fn a_device_that_is_told_wrongly_of_a_sensor_says_so_and_keeps_the_assumed_finger() {
    let without = outcome("", "state");
    let believing = outcome("", "flux set 0.1192 2048 5 0");
    assert_eq!(word(&believing), "finger=sensor-range");
    assert_eq!(flux_events(&believing), 0, "it was so from the first window on");
    let off_k = setpoints(&believing).into_iter().zip(setpoints(&without));
    assert!(off_k.map(|(one, other)| (one - other).abs()).all(|off_k| off_k < 1e-3));
    assert!(setpoints(&without).len() > 3000);

    let unaware = outcome("flux_sensor = true", "flux none");
    assert_eq!(word(&unaware), "flux=none");
    let layerless = "flux_sensor = true\n[plant]\nflux.resistance_m2k_w = 0";
    let unaware = outcome(layerless, "flux none");
    // The operator's line has delayed the others by 3 ms.
    let off_k = setpoints(&unaware).into_iter().zip(setpoints(&without));
    assert!(off_k.map(|(with, without)| (with - without).abs()).all(|off_k| off_k < 1e-3));
}

/// The operator's measurement has an error of 5 %, cut at two standard deviations: of 200 devices, 4.4 % rms, at most 10 %, and none on average.
#[test]
fn a_measured_surface_is_the_plants_with_the_error_of_its_measurement() {
    let mut errors = Vec::new();
    for seed in 0..200 {
        let text = format!(
            "duration_s = 1\nskin_c = 34\nroom_c = 24\nseed = {seed}\n[device]\ncommissioned = false\nmeasured_surface = true\n\
             [object]\nmaterial = \"granite\"\n[plant]\ndisplay.slope_rad = 0.12\n"
        );
        let scene = scene(&text);
        let lines = settings_for_scene(&scene).expect("settings");
        let [line] = lines.as_slice() else {
            panic!("{lines:?}");
        };
        let told = line.strip_prefix("surface set ").expect("a surface");
        let told: Vec<f64> =
            (told.split(' ')).map(|value| value.parse().expect("a number")).collect();
        let display = &scene.params.display;
        let exact = [display.conductivity_w_mk, display.roughness_um, 0.12];
        errors.extend(told.iter().zip(exact).map(|(told, exact)| told / exact - 1.0));
    }
    assert_eq!(errors.len(), 600);
    let mean = errors.iter().sum::<f64>() / 600.0;
    let rms = (errors.iter().map(|error| error * error).sum::<f64>() / 600.0).sqrt();
    assert!(mean.abs() < 0.006 && (rms - 0.044).abs() < 0.004, "{mean}, {rms}");
    assert!(errors.iter().all(|error| error.abs() < 0.1001));
}

#[test]
fn the_device_is_told_of_a_measured_surface_and_assumes_the_nominal_one_otherwise() {
    let answer = |device: &str| {
        let answers = outcome(device, "surface").answers;
        let found = answers.into_iter().find(|(_, line)| line.contains("slope_rad="));
        found.expect("an answer").1
    };
    let nominal = "ok conductivity_w_mk=36.000 roughness_um=1.0000 slope_rad=0.13800";
    assert_eq!(answer(""), nominal);
    assert_ne!(answer("measured_surface = true"), nominal);
}

/// On the whole plant: what could fool the learner ends in the assumed finger and a word about it. The sensor has no layer, so that a
/// device without it assumes the same.
#[test]
fn a_contact_that_fits_no_finger_is_rendered_for_the_assumed_one_and_has_its_word() {
    const TOLD: &str = "flux set 0.1192 2048 5 0";
    let no_layer = "flux_sensor = true\n[plant]\nflux.resistance_m2k_w = 0\n";
    // A lag of 10 s shows nothing of a contact of 3 s.
    let dead = "flux.lag_s = 10\n";
    for (name, keys, words) in [
        ("nothing wrong", "", &["trusted"][..]),
        ("dead sensor", dead, &["sensor"]),
        ("half of the gain", "flux.gain_error = -0.5\n", &["between", "unexplained"]),
        ("paper", "finger.resistance_factor = 4\n", &["between"]),
        ("glove", "finger.resistance_factor = 25\n", &["between", "sensor"]),
        ("wet", "finger.resistance_factor = 0.2\n", &["wet"]),
    ] {
        let device = format!("{no_layer}{keys}");
        let learns = outcome(&device, TOLD);
        let found = word(&learns).trim_start_matches("finger=").to_owned();
        assert!(words.contains(&found.as_str()), "{name}: {found}");
        let assumes = setpoints(&outcome(&device, "flux none"));
        let off_k = (setpoints(&learns).into_iter().zip(assumes))
            .skip(2700)
            .fold(0.0, |off_k: f64, (one, other)| off_k.max((one - other).abs()));
        println!("{name}: {found}, {:.1} mK", 1e3 * off_k);
        if found != "trusted" {
            // What the sensor measures goes on to count for the plate, whose surface is estimated otherwise than without it.
            assert!(off_k < 0.06, "{name}: {off_k} K");
        }
    }
}

#[test]
fn a_finger_that_lifts_and_lands_again_stays_trusted() {
    let text = "duration_s = 4\nskin_c = 34\nroom_c = 24\n[device]\nflux_sensor = true\n[finger]\ntissue = \"layered\"\n\
                [object]\nmaterial = \"granite\"\n[[force]]\nt_s = 0.5\nforce_n = 2\n[[force]]\nt_s = 1.5\nforce_n = 0\n\
                [[force]]\nt_s = 2.5\nforce_n = 2\n[[host]]\nt_s = 2\nline = \"flux\"\n[[host]]\nt_s = 3.9\nline = \"flux\"\n";
    let scene = scene(text);
    let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
    let outcome = run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
    let words: Vec<_> = (outcome.answers.iter())
        .filter_map(|(_, answer)| answer.split_once(" finger="))
        .map(|(_, word)| word)
        .collect();
    assert_eq!(words, ["trusted", "trusted"]);
}

/// A display with the sensor waits 3/64 of the difference to the skin, times the object's weight, below its set-point; one without waits
/// 1/128 of it. The weight of granite against the skin is 2388 / (2388 + 1170), from effusivities in J/(m² s^½ K).
#[test]
fn a_display_with_the_sensor_waits_further_from_the_skin() {
    let weight = 2388.0 / (2388.0 + 1170.0);
    for (device, part) in [("flux_sensor = true", 3.0 / 64.0 * weight), ("", 1.0 / 128.0)] {
        let text = format!(
            "duration_s = 0.5\nskin_c = 34\nroom_c = 24\n[device]\n{device}\n[finger]\ntissue = \"layered\"\n\
             [object]\nmaterial = \"granite\"\n"
        );
        let scene = scene(&text);
        let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
        let outcome = run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
        let row = outcome.trace.rows().last().expect("rows");
        let setpoint_c = row.device.as_ref().and_then(|one| one.setpoint_c);
        let setpoint_c = setpoint_c.expect("a set-point");
        let expected_k = part * (34.0 - setpoint_c);
        let found_k = setpoint_c - row.display_c;
        assert!((found_k - expected_k).abs() < 0.02, "{device}: {found_k} for {expected_k}");
    }
}
