//! The lines of the display's surface.

use std::string::String;

use super::commissioning::Bench;
use super::device::samples;
use crate::device::FingerIndex;

const NOMINAL: &str = "ok conductivity_w_mk=36.000 roughness_um=1.0000 slope_rad=0.13800";

/// The set-point at which an armed finger 0 waits, C, after these lines.
fn waits_at_c(lines: &[&str]) -> f64 {
    let mut one = Bench::armed();
    // Else the set-point moves slowly.
    let tuned = "set tile 2.957 0.0585 0.104 0.1 0.016";
    for line in [&tuned].into_iter().chain(lines).chain(&["start"]) {
        assert_eq!(one.send(line), "ok", "{line}");
    }
    for tick in 0..10 {
        one.device.step_finger(FingerIndex::FIRST, &samples(tick % 2));
    }
    let state: String = one.send("state");
    let (_, setpoint) = state.split_once("setpoint_c=").expect("a set-point");
    let (setpoint, _) = setpoint.split_once(' ').expect("more words");
    setpoint.parse().expect("a number")
}

/// `R_display / R_object` by Eq. 6-9 to 6-11, for a skin of 0.37 W/(m K), 21.69 um and 0.30 rad; from conductivity, roughness and
/// slope of object and display.
fn ratio(object: [f64; 3], display: [f64; 3]) -> f64 {
    let conductance =
        |[k, rq, slope]: [f64; 3]| k / (0.37 + k) * f64::hypot(0.30, slope) / f64::hypot(21.69, rq);
    conductance(object) / conductance(display)
}

#[test]
fn a_surface_is_set_by_either_line_reported_and_made_nominal() {
    for line in ["surface set 30 1.25 0.11", "set surface 30 1.25 0.11"] {
        let mut one = Bench::<1>::new();
        assert_eq!(one.send("surface"), NOMINAL);
        assert_eq!(one.send("settings 9"), "ok set surface nominal");
        assert_eq!(one.send(line), "ok");
        let expected = "ok conductivity_w_mk=30.000 roughness_um=1.2500 slope_rad=0.11000";
        assert_eq!(one.send("surface"), expected);
        assert_eq!(one.send("settings"), "ok lines=9");
        assert_eq!(one.send("settings 9"), "ok set surface 30.000 1.2500 0.11000");
        assert_eq!(one.send("flux set 0.1192 2048 5 30"), "ok");
        assert_eq!(one.send("settings"), "ok lines=10");
        let sensor = "ok set flux 0.119200 2048.000 5.000 30.000";
        assert_eq!(one.send("settings 9"), sensor);
        assert_eq!(one.send("settings 10"), "ok set surface 30.000 1.2500 0.11000");
        assert_eq!(one.send("surface nominal"), "ok");
        assert_eq!(one.send("surface"), NOMINAL);
        assert_eq!(one.send("settings"), "ok lines=9");
    }
}

#[test]
fn the_display_waits_for_the_ratio_of_its_surface_whether_set_before_or_after_the_material() {
    let granite = [2.79, 0.46, 0.048];
    let rough = [1.2, 4.0, 0.05];
    let surface = "surface set 1.2 4 0.05";
    let contact = ["finger thesis", "skin 34", "object 20", "material granite"];
    let nominal = waits_at_c(&contact);
    let before = waits_at_c(&[&[surface], &contact[..]].concat());
    let after = waits_at_c(&[&contact[..], &[surface]].concat());
    assert_eq!(before, after);
    for (waits, display) in [(nominal, [36.0, 1.0, 0.138]), (before, rough)] {
        // Eq. 6-12 at landing.
        let expected = 34.0 - ratio(granite, display) * (34.0 - 20.0);
        assert!((waits - expected).abs() < 0.01, "{waits} for {expected}");
    }
}

#[test]
fn a_material_without_an_address_is_chosen_for_each_surface() {
    let mut two = Bench::<2>::new();
    assert_eq!(two.send("@1 surface set 0.2 30 0.001"), "@1 ok");
    assert_eq!(two.send("surface"), std::format!("@0 {NOMINAL}"));
    // Too good a conductor for the second surface only: R_display / R_object is 25 there.
    let line = "material custom 4000 8000 400 0.1 1.5";
    assert!(two.send(line).starts_with("@1 err R_display / R_object is "));
    assert_eq!(two.send("@0 material custom 4000 8000 400 0.1 1.5"), "@0 ok");
    assert_eq!(two.send("material granite"), "ok");
}

#[test]
fn a_surface_is_refused_while_an_object_is_presented_and_with_a_material_that_it_does_not_suit() {
    let mut one = Bench::armed();
    assert_eq!(one.send("material custom 4000 8000 400 0.1 1.5"), "ok");
    let refused = one.send("surface set 0.2 30 0.001");
    let expected = "err R_display / R_object is ";
    assert!(refused.starts_with(expected), "{refused}");
    assert_eq!(one.send("start"), "ok");
    let refused = "err not while an object or a course is presented: abort or arm first";
    for line in ["surface set 30 1 0.1", "set surface nominal", "surface nominal"] {
        assert_eq!(one.send(line), refused, "{line}");
    }
    assert_eq!(one.send("surface"), NOMINAL);
}

#[test]
fn a_stored_surface_is_there_after_a_restart() {
    let mut two = Bench::<2>::new();
    assert_eq!(two.send("@1 surface set 30 1.25 0.11"), "@1 ok");
    let mut restarted = two.restarted();
    let line = "@1 ok conductivity_w_mk=30.000 roughness_um=1.2500 slope_rad=0.11000";
    assert_eq!(restarted.send("@1 surface"), line);
    assert_eq!(restarted.send("@0 settings"), "@0 ok lines=8");
}
