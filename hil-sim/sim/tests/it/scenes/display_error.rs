//! The display error: display minus the exact set-point of a nominal finger on the object as it is.

use contact_model::material::{SKIN, find};
use thermal_plant::contact::ContactLaw;
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::metrics::{display_errors, figures};
use thermal_sim::run::run;

use super::{at, example, rows, scene};

const GRANITE: &str =
    "duration_s = 4\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"granite\"\n";
const FORCE: &str = "[[force]]\nt_s = 0.5\nforce_n = 2\n";
/// Granite as two layers: the same half-space, but solved as layers.
const LAYERS: &str = "[[object.layer]]\nthickness_m = 0.004\nk_w_mk = 2.79\nrho_kg_m3 = 2630\nc_j_kgk = 775\n\
    [[object.layer]]\nk_w_mk = 2.79\nrho_kg_m3 = 2630\nc_j_kgk = 775\n";

/// The exact set-point at each row that counts, with its time.
fn exact_setpoints(text: &str) -> Vec<(f64, f64)> {
    let scene = scene(text);
    let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
    let outcome = run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
    let rows = outcome.trace.rows().iter();
    rows.zip(display_errors(&scene, &outcome))
        .filter_map(|(row, error)| Some((row.t_s, row.display_c - error?.1)))
        .collect()
}

/// The solver of other fingers and objects meets Eq. 6-12 where both are half-spaces.
#[test]
fn exact_setpoints_of_layers_that_make_a_half_space_are_those_of_eq_6_12() {
    let closed_form = exact_setpoints(&format!("{GRANITE}{FORCE}"));
    let solved = exact_setpoints(&format!("{GRANITE}{LAYERS}{FORCE}"));
    // The row of the landing has no solved one.
    assert_eq!(closed_form.len(), 3501);
    assert_eq!(solved.len(), 3500);
    for ((t_s, exact_c), (solved_s, solved_c)) in closed_form[1..].iter().zip(solved) {
        assert_eq!(*t_s, solved_s);
        let off_k = solved_c - exact_c;
        // Quick at first, and half a step of the plant late.
        let bound_k = if *t_s < 0.52 { 0.05 } else { 2e-3 };
        assert!(off_k.abs() < bound_k, "off by {off_k} K at {t_s} s");
    }
}

/// The layer of a heat-flux sensor is in series with the contact: where `q` flows into the object, the display must be colder by
/// 3e-5 m2 K/W times `q`.
#[test]
fn the_exact_setpoint_has_the_layer_of_a_heat_flux_sensor_in_it() {
    let closed_form = exact_setpoints(&format!("{GRANITE}{FORCE}"));
    let text = format!("{GRANITE}[device]\nflux_sensor = true\n{FORCE}");
    let fitted = exact_setpoints(&text);
    let surface = &find("granite").expect("a material").surface;
    let contact = ContactLaw::NOMINAL.at_force(2.0, &SKIN.surface, surface);
    let resistance_m2k_w = contact.expect("a contact").resistance_m2k_w;
    let rows = rows(&text);
    for ((t_s, exact_c), (fitted_s, fitted_c)) in closed_form[1..].iter().zip(fitted) {
        assert_eq!(*t_s, fitted_s);
        let row = at(&rows, *t_s);
        let flux_w_m2 = (row.skin_real_c - row.object_real_c) / resistance_m2k_w;
        let off_k = fitted_c + 3e-5 * flux_w_m2 - exact_c;
        let bound_k = if *t_s < 0.52 { 0.05 } else { 2e-3 };
        assert!(off_k.abs() < bound_k, "off by {off_k} K at {t_s} s");
    }
    let last = rows.last().expect("rows");
    let colder_k = 3e-5 * (last.skin_real_c - last.object_real_c) / resistance_m2k_w;
    assert!((0.05..0.2).contains(&colder_k), "{colder_k} K");
}

/// With the finger and the object that the device is told, what is left is how well the display follows.
#[test]
fn the_display_error_of_layers_is_bounded() {
    // Where the set-point rises quickly, as on copper on foam, the target is ahead of it: the display is up to 33 mK too warm in
    // the first 0.1 s, to the benefit of the skin. The thesis's copper has 16 and 6 mK.
    for (name, bound_mk) in
        [("copper-on-foam", 40.0), ("layered-finger", 20.0), ("lift-and-replace", 20.0)]
    {
        let scene = scene(&example(name, &[]));
        let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
        let outcome = run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
        let error = figures(&scene, &outcome).display_error_mk.expect("contact");
        let max_mk = error.max_after_50ms.expect("a contact of more than 50 ms");
        assert!(max_mk < bound_mk && error.rms < 8.0, "{name}: {error:?}");
    }
}

/// Draws and values of the plant change the display and the finger on it, and not what would be exact for a nominal one.
#[test]
fn the_exact_setpoint_is_that_of_a_nominal_finger() {
    let finger = "[finger]\ntissue = \"layered\"\n";
    let nominal = exact_setpoints(&format!("{GRANITE}thickness_m = 0.01\n{FORCE}{finger}"));
    let drawn = format!(
        "{GRANITE}thickness_m = 0.01\n{FORCE}{finger}draw = 3\n[plant]\ndraw = 5\ncontact.draw = 7\n"
    );
    for ((t_s, exact_c), (_, drawn_c)) in nominal.iter().zip(exact_setpoints(&drawn)) {
        assert!((exact_c - drawn_c).abs() < 1e-9, "{exact_c} and {drawn_c} at {t_s} s");
    }
}
