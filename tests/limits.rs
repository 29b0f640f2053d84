//! The release image at the ends of its range: warm objects, cool and warm skin, and what is too warm to be shown.

use hil_sim::fidelity::Scenario;
use hil_sim::run::Outcome;
use hil_sim::scene::Scene;
use hil_sim::trace::Row;
use system_tests::{between, forces, host, natively, on_image, scene, worst_k};
use thermal_display::control::Law;

/// A case of the scenario of things unseen.
fn unseen(name: &str) -> (Scene, Outcome) {
    let mut cases = Scenario::Unseen.cases().into_iter();
    let case = cases.find(|case| case.name == name).expect(name);
    let scene = case.scene(Law::default(), 1, &[]).expect("a good scene");
    let outcome = on_image(&scene);
    (scene, outcome)
}

fn feels(name: &str) {
    let (scene, outcome) = unseen(name);
    let skin_k = worst_k(&scene, &outcome, 0.05);
    println!("{name}: skin {:.1} mK after 50 ms", 1e3 * skin_k);
    assert!(skin_k <= 0.02, "{name}: {skin_k} K");
    for row in between(&outcome, 1.01, 11.0) {
        let device = row.device.as_ref().expect("telemetry of every tick");
        let said = (device.state.as_str(), device.remark.as_deref());
        assert_eq!(said, ("contact", None), "{name} at {} s", row.t_s);
    }
}

#[test]
fn copper_of_41_c_is_felt() {
    feels("copper of 41 C");
}

#[test]
fn a_skin_of_28_c_feels_copper() {
    feels("copper, skin 28 C");
}

#[test]
fn a_skin_of_36_c_feels_granite() {
    feels("granite, skin 36 C");
}

/// A bar that would burn: the display stops at 42 °C, says so, and the contact goes on.
#[test]
fn a_bar_of_44_c_is_limited_and_says_so() {
    const LIMIT_C: f64 = 42.0;
    let tables = forces(&[(1.0, 2.0)]) + &host(&[(5.0, "state")]);
    let mut scene = scene("copper", 11.0, "", &tables);
    // The device is told the truth.
    scene.object.start_c = Some(44.0);
    let outcome = on_image(&scene);
    let mut warmest_c = f64::NEG_INFINITY;
    for row in outcome.trace.rows() {
        let device = row.device.as_ref().expect("telemetry of every tick");
        let state = if row.t_s < 1.0 { "preset" } else { "contact" };
        if !(1.0..1.01).contains(&row.t_s) {
            let said = (device.state.as_str(), device.remark.as_deref());
            assert_eq!(said, (state, Some("limited")), "at {} s", row.t_s);
            assert_eq!(device.setpoint_c, Some(LIMIT_C), "at {} s", row.t_s);
        }
        assert!(
            row.skin_c < LIMIT_C,
            "skin {} C at {} s",
            row.skin_c,
            row.t_s
        );
        warmest_c = warmest_c.max(row.display_c);
    }
    println!("display {warmest_c:.3} C at most");
    assert!(warmest_c < LIMIT_C + 0.03, "display {warmest_c} C");
    let said = outcome.answers.last().map(|(_, line)| line.as_str());
    let state = "ok state=contact fault=- material=copper object_c=44.00 mode=contact setpoint_c=42.00 limited";
    assert_eq!(said, Some(state));
}

/// Plain loops on the slowest sensors of the class, from skin temperature to the ends of what may be asked for.
#[test]
fn a_display_that_is_held_at_an_end_does_not_go_beyond_and_trip() {
    let slow = "[plant]\nsensors.display.lag_s = 0.5\nsensors.check.lag_s = 0.5\n";
    for law in ["pi", "pi-10hz"] {
        for (held_c, beyond_k) in [(42.0, 1.0), (15.0, -1.0)] {
            let tables = host(&[(0.1, &format!("hold {held_c}"))]) + slow;
            let mut scene = scene("copper", 50.0, &format!("law = \"{law}\""), &tables);
            scene.object.appears_t_s = scene.duration_s;
            let outcome = natively(&scene);
            let beyond = |row: &Row| (row.display_c - held_c) * beyond_k;
            let farthest_k =
                (outcome.trace.rows().iter().map(beyond)).fold(f64::NEG_INFINITY, f64::max);
            println!("{law}, {held_c} C: {farthest_k:.2} K beyond");
            assert!(farthest_k < 0.8, "{law}, {held_c} C: {farthest_k} K beyond");
            let last = outcome.trace.rows().last().expect("a row");
            assert!(
                beyond(last).abs() < 0.05,
                "{law}: {} C, {held_c}",
                last.display_c
            );
        }
    }
}

/// At 16 K/s the plate is ahead of its thermistor by 1.6 to 6 K.
#[test]
fn a_line_that_comes_while_the_display_is_on_its_way_trips_nothing() {
    for (lag_s, law, line) in [
        (0.1, "model", "set correction display 0 0 0"),
        (0.4, "model", "set correction display 0 0 0"),
        (0.1, "pi", "law model"),
        (0.4, "pi-10hz", "law model"),
    ] {
        let slow =
            format!("[plant]\nsensors.display.lag_s = {lag_s}\nsensors.check.lag_s = {lag_s}\n");
        let tables = host(&[(3.0, "arm"), (3.5, line), (6.5, "state")]) + &slow;
        let mut scene = scene("copper", 7.0, &format!("law = \"{law}\""), &tables);
        scene.object.start_c = Some(15.0);
        let outcome = natively(&scene);
        let (_, state) = outcome.answers.last().expect("an answer");
        assert!(
            state.starts_with("ok state=armed fault=-"),
            "{law}, {lag_s} s: {state}"
        );
        // It was on its way.
        let at_c = |t_s: f64| {
            between(&outcome, t_s, t_s + 0.002)
                .next()
                .expect("a row")
                .display_c
        };
        assert!(at_c(3.6) - at_c(3.4) > 1.0, "{law}, {lag_s} s");
    }
}

/// The most that a line may make of a reading, on quick sensors, whose loop is strong.
#[test]
fn a_correction_that_is_set_while_the_display_is_held_trips_nothing() {
    let quick = "[plant]\nsensors.display.lag_s = 0.024\nsensors.check.lag_s = 0.024\n";
    for line in [
        "set correction display 1.2 0.03 0",
        "set correction display -1.2 0.03 0",
    ] {
        let tables = host(&[(0.1, "hold 20"), (0.3, line), (1.5, "state")]) + quick;
        let mut scene = scene("copper", 2.0, "", &tables);
        scene.object.appears_t_s = scene.duration_s;
        let outcome = natively(&scene);
        let said = outcome.answers.iter().map(|(_, said)| said.as_str());
        let [state] = said.filter(|said| *said != "ok").collect::<Vec<_>>()[..] else {
            panic!("{line}: {:?}", outcome.answers);
        };
        assert!(
            state.starts_with("ok state=armed fault=-"),
            "{line}: {state}"
        );
    }
}

/// Modules at the ends of their tolerances on a warm sink, an object as cold as can be shown, and a warm finger that lands hard:
/// the display goes back from where the current had brought it, and nothing is broken.
#[test]
fn a_finger_that_warms_a_display_at_its_limit_trips_nothing() {
    let weak = "tile.imax_a = 5.4\ntile.vmax_v = 7.38\ntile.dtmax_k = 60.3\ntile.ceramic_j_m3k = 3355000.0\n";
    let strong = "tile.imax_a = 6.6\ntile.vmax_v = 9.02\ntile.dtmax_k = 73.7\ntile.ceramic_j_m3k = 2745000.0\n";
    for (law, lag_s, module) in [
        ("model", 0.1, weak),
        ("pi", 0.5, strong),
        ("pi-10hz", 0.5, strong),
    ] {
        let plant = format!(
            "[device]\ncommissioned = true\n[plant]\n{module}tile.coolant_k = 16.0\n\
             sensors.display.lag_s = {lag_s}\nsensors.check.lag_s = {lag_s}\n"
        );
        let tables = forces(&[(1.0, 5.0)]) + &host(&[(3.5, "state")]) + &plant;
        let mut scene = scene("copper", 4.0, &format!("law = \"{law}\""), &tables);
        (scene.skin_c, scene.object.start_c) = (36.0, Some(15.0));
        let outcome = natively(&scene);
        let (_, state) = outcome.answers.last().expect("an answer");
        assert!(
            state.starts_with("ok state=contact fault=-"),
            "{law}: {state}"
        );
        let reading_c = |row: &Row| row.device.as_ref().and_then(|device| device.sensor_c);
        let mut coldest_c = f64::INFINITY;
        let mut back_k = 0.0f64;
        for reading_c in between(&outcome, 1.0, 2.5).filter_map(reading_c) {
            coldest_c = coldest_c.min(reading_c);
            back_k = back_k.max(reading_c - coldest_c);
        }
        println!("{law}: {back_k:.2} K back");
        assert!(back_k > 1.2, "{law}: {back_k} K");
    }
}
