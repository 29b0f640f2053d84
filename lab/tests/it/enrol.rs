//! The command `thermal-lab enrol`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::time::Duration;

use thermal_lab::client::Client;
use thermal_lab::enrolment::{EnrolmentError, EnrolmentOptions, enrol as enrol_at};
use thermal_lab::link::SimulatedLink;
use thermal_settings::PersonCode;

use crate::command::{run, scene_file, text};
use crate::simulated_device::device;

fn enrol(words: &[&str]) -> Output {
    run(&[&["enrol", "--force"], words].concat())
}

/// A finger that is no mean one.
fn scene(name: &str, sensor: bool) -> PathBuf {
    scene_file(name, "copper", sensor, "finger.resistance_factor = 1.4")
}

#[test]
fn a_simulated_person_is_enrolled_and_restored() {
    let scene = scene("enrol.toml", true);
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("person-P7.toml");
    let (scene, out) = (scene.to_str().unwrap(), out.to_str().unwrap());
    let simulated = ["P7", "--simulated", "--scene", scene];
    let done = enrol(&[&simulated[..], &["--zero", "--out", out]].concat());
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(text(&done.stdout).starts_with("P7 is enrolled from 2 contacts, in "));
    let shown = text(&done.stderr);
    for said in ["still air", "Touch copper, with 1 to 3 N", "Touch abs", "2.00 N"] {
        assert!(shown.contains(said), "{said}: {shown}");
    }
    let written: toml::Table = fs::read_to_string(out).unwrap().parse().unwrap();
    assert_eq!(written["code"].as_str(), Some("P7"));
    let data = written["data"].as_str().unwrap();
    assert!(data.len() == 40 && data.bytes().all(|byte| byte.is_ascii_hexdigit()), "{data}");
    assert_eq!(written["display_surface"].as_str(), Some("36 1 0.138"));

    let restored = enrol(&[&simulated[..], &["--restore", out]].concat());
    assert!(restored.status.success(), "{}", text(&restored.stderr));
    let other = enrol(&["P8", "--simulated", "--scene", scene, "--restore", out]);
    assert_eq!(other.status.code(), Some(2));
    assert!(text(&other.stderr).contains("it is of \"P7\", not of P8"));
    let unknown = enrol(&[&simulated[..], &["--forget"]].concat());
    assert_eq!(unknown.status.code(), Some(1), "{}", text(&unknown.stderr));
}

#[test]
fn names_single_objects_and_devices_without_a_sensor_are_refused() {
    let scene = scene("enrol-without.toml", false);
    let scene = ["--simulated", "--scene", scene.to_str().unwrap()];
    for (words, status, why) in [
        (&["Anna"][..], 2, "1 to 8 of A to Z and 0 to 9"),
        (&["P7", "--objects", "copper"], 2, "two or more are needed"),
        (&["P7"], 1, "the device has no heat-flux sensor"),
    ] {
        let refused = enrol(&[words, &scene[..]].concat());
        assert_eq!(refused.status.code(), Some(status), "{words:?}");
        assert!(text(&refused.stderr).contains(why), "{}", text(&refused.stderr));
    }
}

#[test]
fn nobody_is_enrolled_with_a_measured_contact_law() {
    let mut engine = device();
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    client.wait(Duration::from_millis(600)).unwrap();
    for line in ["flux set 0.1192 2048 5 30", "contact 0.9 100000 20"] {
        client.command(line).unwrap();
    }
    let options = EnrolmentOptions {
        code: PersonCode::new("P7").unwrap(),
        finger: None,
        takes_zero: false,
        objects: vec!["copper".into(), "abs".into()],
    };
    let refused = enrol_at(&mut client, &options, &mut |_, _| ());
    assert_eq!(refused, Err(EnrolmentError::OtherContactLaw));
}
