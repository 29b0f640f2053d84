//! Courses from files, and those of earlier displays.

use std::fs;

use super::{good, refused, temporary};

fn file(name: &str, text: &str) -> String {
    let path = temporary(name);
    fs::write(&path, text).expect("a file");
    path.to_str().expect("a path").to_owned()
}

#[test]
fn a_wrong_course_is_refused_with_file_line_and_what_is_allowed() {
    let hot = file("hot.csv", "t_s,celsius\n0,30\n1,43\n");
    let message = refused(&["play", &hot, "--engine", "native"]);
    assert!(
        message.contains("hot.csv:3: celsius 43 is out of range; 15 to 42 °C are allowed"),
        "{message}"
    );
    let good_course = file("good.csv", "t_s,celsius\n0,30\n1,29\n");
    let message = refused(&["play", &good_course, "--engine", "native", "--force-n", "11"]);
    assert!(message.contains("--force-n 11; 0.01 to 10 is allowed"), "{message}");
    let message = refused(&["play", "no-such.csv", "--engine", "native"]);
    assert!(message.contains("no-such.csv"), "{message}");
}

#[test]
fn a_course_that_128_points_cannot_follow_is_refused() {
    let mut text = String::from("t_s,celsius\n");
    for i in 0..2000 {
        text += &format!("{},{}\n", f64::from(i) / 100.0, 30.0 + 0.05 * f64::from(i % 2));
    }
    let noisy = file("noisy.csv", &text);
    let message = refused(&["play", &noisy, "--engine", "native"]);
    assert!(message.contains("mK off; up to 5 mK are allowed without --coarse"), "{message}");
}

#[test]
fn a_display_needs_a_scene_of_one_contact() {
    let message = refused(&["display", "--display", "yang-2006"]);
    assert!(message.contains("computed for a scene"), "{message}");
    let two = file(
        "two-contacts.toml",
        "duration_s = 4.0\nskin_c = 34.0\nroom_c = 24.0\n[object]\nmaterial = \"abs\"\n[[force]]\nt_s = 1.0\nforce_n = 1.0\n\
         [[force]]\nt_s = 2.0\nforce_n = 2.0\n",
    );
    let message = refused(&["display", &two, "--display", "yang-2006", "--engine", "native"]);
    assert!(message.contains("is computed for one contact"), "{message}");
}

#[test]
fn all_displays_on_an_ideal_tile_are_one_json_object() {
    let scene = "../scenes/granite.toml";
    let text = good(&["display", scene, "--all", "--ideal-only", "--json"], "");
    let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(report["displays"].as_array().map(Vec::len), Some(9));
    let rows = report["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 9);
    for row in rows {
        assert_eq!(row["material"], "granite");
        let error = &row["ideal_tile_skin_error_mk"];
        assert!(error["max_after_50ms"].is_number() && error["rms"].is_number(), "{row}");
    }
    assert_eq!(rows[0]["display"], "ho-2006-chapter-4");
    assert_eq!(rows[0]["better_than_ours_on_ideal_tile"], false);
}

#[test]
fn a_course_is_played_from_landing_on_and_its_error_is_told() {
    let course = file("ramp.csv", "t_s,celsius\n0,31\n1,31\n4,28\n5,28\n");
    let folder = temporary("played");
    let out = folder.to_str().expect("a path");
    let text = good(
        &["play", &course, "--engine", "native", "--force-n", "1", "--out", out, "--json"],
        "",
    );
    let figures: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let of = |name: &str| figures["course_error_mk"][name].as_f64().expect("a number");
    assert!(of("max_after_50ms") < 50.0 && of("rms") < 20.0, "{text}");
    assert_eq!(figures["points"], 4);
    assert_eq!(figures["refused_lines"].as_array().map(Vec::len), Some(0));
    // What was shown can be played again: the trace's display from landing on.
    let trace = folder.join("trace.csv");
    let again = good(
        &["play", trace.to_str().expect("a path"), "--engine", "native", "--coarse", "--json"],
        "",
    );
    let figures: serde_json::Value = serde_json::from_str(&again).expect("JSON");
    assert!(figures["points"].as_u64() <= Some(128), "{again}");
}
