//! The display held at an end of its range, or moved there by a host line, a correction or a finger: nothing trips.

use documented_figures::assert_figure;
use system_tests::{between, forces, host, natively, scene};
use thermal_sim::trace::TraceRow;

/// PI controllers with the slowest thermistors of the parameter box, from skin temperature to either end of the range, which is
/// drawn in for them.
#[test]
fn a_display_that_is_held_at_an_end_of_the_range_overshoots_by_less_than_0_8_k() {
    for law in ["pi", "pi-10hz"] {
        for (wanted_c, held_c, beyond_k) in [(42.0, 39.53, 1.0), (15.0, 18.47, -1.0)] {
            let tables = host(&[(0.1, &format!("hold {wanted_c}"))]) + &slow(0.5);
            let mut scene = scene("copper", 50.0, &format!("law = \"{law}\""), &tables);
            scene.object.appears_t_s = scene.duration_s;
            let outcome = natively(&scene);
            let beyond = |row: &TraceRow| (row.display_c - held_c) * beyond_k;
            let farthest_k =
                (outcome.trace.rows().iter().map(beyond)).fold(f64::NEG_INFINITY, f64::max);
            println!("{law}, {held_c} C: {farthest_k:.2} K beyond");
            assert!(farthest_k < 0.8, "{law}, {held_c} C: {farthest_k} K beyond");
            let last = outcome.trace.rows().last().expect("a row");
            assert!(beyond(last).abs() < 0.05, "{law}: {} C, {held_c}", last.display_c);
        }
    }
}

/// The fastest steps to both ends of the range, a finger that lands and lifts there, and a change of the law on the way: the true
/// surface stays within 14 and 43 deg C, from the quickest to the slowest thermistors of the parameter box.
#[test]
fn the_plain_laws_keep_the_surface_within_its_limits_whatever_the_lag() {
    let lines = [
        (0.3, "hold 42 100"),
        (6.0, "hold 15 100"),
        (26.0, "law model"),
        (26.1, "hold 42 100"),
        (26.6, "law pi"),
    ];
    let touches = [(3.0, 10.0), (4.5, 0.0), (10.0, 10.0), (12.0, 0.0), (22.0, 10.0), (24.0, 0.0)];
    for law in ["pi", "pi-10hz"] {
        for (lag_s, skin_c) in lags_and_skins() {
            let tables = forces(&touches) + &host(&lines) + &slow(lag_s);
            let mut scene = scene("copper", 32.0, &format!("law = \"{law}\""), &tables);
            (scene.skin_c, scene.object.appears_t_s) = (skin_c, scene.duration_s);
            let outcome = natively(&scene);
            let (coldest_c, warmest_c) =
                range(outcome.trace.rows().iter().map(|row| row.display_c));
            let found = format!("{law}, {lag_s} s, {skin_c} C: {coldest_c:.2} to {warmest_c:.2} C");
            println!("{found}");
            assert!(coldest_c > 14.0 && warmest_c < 43.0, "{found}");
            // It does come near both ends.
            assert!(coldest_c < 18.6 && warmest_c > 39.5, "{found}");
        }
    }
}

/// A reference that is as slow as the display winds up the integral: the surface then goes 0.6 K below a copper object of 24 deg C
/// that appears under a finger, and the skin is more than 50 mK too cold for 10 s.
#[test]
fn the_plain_laws_take_the_set_point_of_a_room_at_once() {
    for law in ["pi", "pi-10hz"] {
        let tables = forces(&[(0.5, 0.5)]);
        let mut scene = scene("copper", 8.0, &format!("law = \"{law}\""), &tables);
        (scene.skin_c, scene.object.appears_t_s) = (34.0, 2.0);
        let outcome = natively(&scene);
        let (coldest_c, _) = range(outcome.trace.rows().iter().map(|row| row.display_c));
        println!("{law}: {coldest_c:.2} C");
        assert!((23.7..24.0).contains(&coldest_c), "{law}: {coldest_c} C");
    }
}

/// A law that is chosen so that it would take over while the law `model` answers a landing with 5 A: it waits until the current is
/// steady, and the surface does not follow that current to 11.5 deg C.
#[test]
fn a_plain_law_that_is_chosen_before_a_landing_takes_over_after_it() {
    for chosen_s in [2.73, 2.74, 2.75, 2.76, 2.8] {
        let lines = [(0.1, "hold 16.5 20"), (chosen_s, "law pi-10hz")];
        let tables = forces(&[(3.0, 4.0), (3.6, 0.15)]) + &host(&lines) + &slow(0.35);
        let coldest_c = coldest_without_object_c(&tables, f64::NEG_INFINITY, 5.0);
        assert!(coldest_c > 15.5, "chosen at {chosen_s} s: {coldest_c:.2} C");
    }
}

/// A law that is chosen while the surface falls through a reading that lags: for a quarter of a second the reading stays near the
/// set-point and the current at its limit, but the display is on its way, and would go on to 10.6 deg C.
#[test]
fn a_plain_law_that_is_chosen_while_the_surface_passes_the_reading_waits() {
    for (after_s, from, again) in [
        (0.2, "hold 32 60", "hold 42 2"),
        (0.3, "hold 25.4 60", "hold 42 2"),
        (0.5, "hold 25.4 60", "hold 42 2"),
        (0.3, "hold 32 60", "hold 42 4"),
        (0.4, "hold 32 60", "hold 42 6"),
    ] {
        let again_s = 5.0 + after_s;
        let lines =
            [(0.1, "hold 17 60"), (5.0, from), (again_s - 0.05, "law pi"), (again_s, again)];
        let coldest_c = coldest_without_object_c(&(host(&lines) + &slow(0.5)), again_s, 9.0);
        assert!(coldest_c > 16.0, "{from}, after {after_s} s {again}: {coldest_c:.2} C");
    }
}

/// Coldest surface, deg C, from a time to the end of a scene, s, in which no object is presented.
fn coldest_without_object_c(tables: &str, from_s: f64, end_s: f64) -> f64 {
    let mut scene = scene("copper", end_s, "", tables);
    scene.object.appears_t_s = end_s;
    let outcome = natively(&scene);
    let rows = outcome.trace.rows().iter().filter(|row| row.t_s >= from_s);
    range(rows.map(|row| row.display_c)).0
}

/// From the quickest to the slowest thermistors of the parameter box.
fn lags_and_skins() -> impl Iterator<Item = (f64, f64)> {
    [0.05, 0.1, 0.3, 0.5].into_iter().flat_map(|lag_s| [(lag_s, 28.0), (lag_s, 40.0)])
}

fn slow(lag_s: f64) -> String {
    format!("[plant]\nsensors.display.lag_s = {lag_s}\nsensors.check.lag_s = {lag_s}\n")
}

/// Smallest and largest temperature, deg C.
fn range(temperatures_c: impl Iterator<Item = f64>) -> (f64, f64) {
    temperatures_c.fold((f64::MAX, f64::MIN), |(least, most), c| (least.min(c), most.max(c)))
}

/// The hottest and the coldest object, and a change of the law on the way, on a tile that was never tuned: surface and skin stay
/// within 18 and 40.5 deg C, and what is beyond the limits of such a tile is refused.
#[test]
fn an_untuned_tile_stays_far_within_the_limits_whatever_the_lag() {
    let lines = [
        (0.2, "hold 42"),
        (0.3, "hold 30 100"),
        (0.4, "pulse 38 39 1 1 1"),
        (0.5, "pulse 30 32 3 1 1"),
        (0.6, "hold 38 1"),
        (17.0, "hold 20 1"),
        (20.0, "law model"),
        (40.0, "object 60"),
        (60.0, "object -20"),
        (75.0, "law pi"),
    ];
    let touches = [
        (3.0, 10.0),
        (13.0, 0.0),
        (16.0, 10.0),
        (19.0, 0.0),
        (37.0, 10.0),
        (58.0, 0.0),
        (59.0, 10.0),
        (90.0, 0.0),
    ];
    for law in ["model", "pi", "pi-10hz"] {
        for (lag_s, skin_c) in lags_and_skins().filter(|(lag_s, _)| [0.1, 0.5].contains(lag_s)) {
            let tables = "[device]\ncommissioned = false\n".to_owned()
                + &forces(&touches)
                + &host(&lines)
                + &slow(lag_s);
            let mut scene = scene("copper", 92.0, &format!("law = \"{law}\""), &tables);
            (scene.skin_c, scene.object.appears_t_s) = (skin_c, 40.1);
            let outcome = natively(&scene);
            let rows = || outcome.trace.rows().iter();
            let (coldest_c, warmest_c) = range(rows().map(|row| row.display_c));
            let (coldest_skin_c, warmest_skin_c) = range(rows().map(|row| row.skin_c));
            let found = format!(
                "{law}, {lag_s} s, {skin_c} C: {coldest_c:.2} to {warmest_c:.2} C, skin {coldest_skin_c:.2} to {warmest_skin_c:.2} C"
            );
            println!("{found}");
            assert!(coldest_c > 18.0 && warmest_c < 40.5, "{found}");
            assert!(coldest_skin_c > 18.0 && warmest_skin_c < 40.5, "{found}");
            assert!(coldest_c < 20.5 && warmest_c > 37.5, "{found}");
            let refused: Vec<&str> = (outcome.answers.iter())
                .filter_map(|(_, answer)| answer.strip_prefix("err "))
                .collect();
            assert_eq!(
                refused,
                [
                    "42.00 C needs tune first; until then 20.00 to 38.00 C are allowed",
                    "100.00 K/s needs tune first; until then 1.00 K/s are allowed",
                    "39.00 C needs tune first; until then 20.00 to 38.00 C are allowed",
                    "3.00 K/s needs tune first; until then 1.00 K/s are allowed",
                ]
            );
        }
    }
}

/// What the limits of a tile that was never tuned cost: a finger that lands once the display has reached its preset.
#[test]
fn an_untuned_tile_is_documented_with_the_error_of_the_skin() {
    for material in ["copper", "granite", "abs", "foam"] {
        let tables = "[device]\ncommissioned = false\n".to_owned() + &forces(&[(12.0, 2.0)]);
        let outcome = natively(&scene(material, 22.0, "", &tables));
        let error_k = |row: &TraceRow| (row.skin_c - row.skin_real_c).abs();
        let most_k = between(&outcome, 12.05, 22.0).map(error_k).fold(0.0, f64::max);
        assert_figure(&format!("untuned.{material}"), 1e3 * most_k);
    }
}

/// At 16 K/s the plate leads its thermistor by 1.6 to 6 K.
#[test]
fn a_host_line_during_a_ramp_trips_nothing() {
    for (lag_s, law, line) in [
        (0.1, "model", "set correction display 0 0 0"),
        (0.4, "model", "set correction display 0 0 0"),
        (0.1, "pi", "law model"),
        (0.4, "pi-10hz", "law model"),
    ] {
        let tables = host(&[(3.0, "arm"), (3.5, line), (6.5, "state")]) + &slow(lag_s);
        let mut scene = scene("copper", 7.0, &format!("law = \"{law}\""), &tables);
        scene.object.start_c = Some(15.0);
        let outcome = natively(&scene);
        let (_, state) = outcome.answers.last().expect("an answer");
        assert!(state.starts_with("ok state=armed fault=-"), "{law}, {lag_s} s: {state}");
        // The display was moving when the line came.
        let at_c = |t_s: f64| between(&outcome, t_s, t_s + 0.002).next().expect("a row").display_c;
        assert!(at_c(3.6) - at_c(3.4) > 1.0, "{law}, {lag_s} s");
    }
}

/// The largest corrections that a host may set, with fast thermistors, for which the controller's gain is high.
#[test]
fn a_correction_that_is_set_while_the_display_is_held_trips_nothing() {
    let quick = "[plant]\nsensors.display.lag_s = 0.024\nsensors.check.lag_s = 0.024\n";
    for line in ["set correction display 1.2 0.03 0", "set correction display -1.2 0.03 0"] {
        let tables = host(&[(0.1, "hold 20"), (0.3, line), (1.5, "state")]) + quick;
        let mut scene = scene("copper", 2.0, "", &tables);
        scene.object.appears_t_s = scene.duration_s;
        let outcome = natively(&scene);
        let said = outcome.answers.iter().map(|(_, said)| said.as_str());
        let [state] = said.filter(|said| *said != "ok").collect::<Vec<_>>()[..] else {
            panic!("{line}: {:?}", outcome.answers);
        };
        assert!(state.starts_with("ok state=stimulus fault=-"), "{line}: {state}");
    }
}

/// Modules at the ends of their tolerances on a warm sink, the coldest object that can be displayed, and a warm finger that
/// presses hard: it warms the display against the full cooling current, which is not a fault.
#[test]
fn a_finger_that_warms_a_display_at_its_current_limit_trips_nothing() {
    let weak = "tile.imax_a = 5.4\ntile.vmax_v = 7.38\ntile.dtmax_k = 60.3\ntile.ceramic_j_m3k = 3355000.0\n";
    let strong = "tile.imax_a = 6.6\ntile.vmax_v = 9.02\ntile.dtmax_k = 73.7\ntile.ceramic_j_m3k = 2745000.0\n";
    // The range of the plain laws is drawn in, so it takes a warmer finger, more force and a quicker thermistor to warm the reading
    // as much.
    for (law, lag_s, module, (skin_c, force_n)) in [
        ("model", 0.1, weak, (36.0, 5.0)),
        ("pi", 0.1, strong, (40.0, 10.0)),
        ("pi-10hz", 0.1, strong, (40.0, 10.0)),
    ] {
        let plant = format!(
            "[device]\ncommissioned = true\n[plant]\n{module}tile.coolant_k = 16.0\n\
             sensors.display.lag_s = {lag_s}\nsensors.check.lag_s = {lag_s}\n"
        );
        let tables = forces(&[(1.0, force_n)]) + &host(&[(3.5, "state")]) + &plant;
        let mut scene = scene("copper", 4.0, &format!("law = \"{law}\""), &tables);
        (scene.skin_c, scene.object.start_c) = (skin_c, Some(15.0));
        let outcome = natively(&scene);
        let (_, state) = outcome.answers.last().expect("an answer");
        assert!(state.starts_with("ok state=contact fault=-"), "{law}: {state}");
        let reading_c = |row: &TraceRow| row.device.as_ref().and_then(|device| device.display_c);
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
