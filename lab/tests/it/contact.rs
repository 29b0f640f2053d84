//! The command `thermal-lab contact`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use crate::command::{run, scene_file, text};

fn contact(words: &[&str]) -> Output {
    run(&[&["contact", "--force"], words].concat())
}

/// A finger with a contact law of its own.
fn scene(name: &str, sensor: bool) -> PathBuf {
    let law = "contact.exponent = 0.9\ncontact.gap_w_m2k = 200.0";
    scene_file(name, "granite", sensor, law)
}

#[test]
fn a_simulated_person_is_measured_and_files_are_written() {
    let scene = scene("contact.toml", true);
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("contact-P7");
    let (scene, out) = (scene.to_str().unwrap(), out.to_str().unwrap());
    let done = contact(&["P7", "--simulated", "--scene", scene, "--out", out, "--tell", "--zero"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let printed = text(&done.stdout);
    let line = printed.lines().last().unwrap();
    let words: Vec<f64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
    let &[exponent, _, gap_w_m2k] = words.as_slice() else {
        panic!("{line}");
    };
    assert!((exponent - 0.9).abs() < 0.05, "{line}");
    assert!((gap_w_m2k - 200.0).abs() < 30.0, "{line}");
    let shown = text(&done.stderr);
    for said in ["Take the finger off", "land lightly", "0.45 N asked,  0.45 N", "Lift"] {
        assert!(shown.contains(said), "{said}: {shown}");
    }
    let recording = fs::read_to_string(format!("{out}.csv")).unwrap();
    assert_eq!(recording.lines().count(), 2101);
    let written: toml::Table = fs::read_to_string(format!("{out}.toml")).unwrap().parse().unwrap();
    assert_eq!(written["line"].as_str(), Some(line));
    assert_eq!(written["resistance"].as_array().unwrap().len(), 3);
    let picture = fs::read_to_string(format!("{out}.svg")).unwrap();
    assert!(picture.starts_with("<svg") && picture.contains("Eq. 6-8"));
}

#[test]
fn names_and_devices_without_a_sensor_are_refused() {
    let refused = contact(&["Anna", "--simulated"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("1 to 8 of A to Z and 0 to 9"));
    let scene = scene("contact-without.toml", false);
    let refused = contact(&["P7", "--simulated", "--scene", scene.to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(1));
    let why = text(&refused.stderr);
    assert!(why.contains("the device has no heat-flux sensor"), "{why}");
}
