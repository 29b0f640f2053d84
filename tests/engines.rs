//! Both engines run the same logic, and the image engine runs the given image.

use hil_sim::machine::Firmware;
use hil_sim::run::Outcome;
use system_tests::{forces, image, natively, on, on_image, scene};

fn csv(outcome: &Outcome, name: &str) -> String {
    let path = std::env::temp_dir().join(format!("thermal-display-{}-{name}.csv", std::process::id()));
    outcome.trace.write(&path).expect("a trace");
    let text = std::fs::read_to_string(&path).expect("a trace");
    std::fs::remove_file(&path).expect("a trace");
    text
}

#[test]
fn native_and_image_write_the_same_trace_over_two_contacts() {
    let two = forces(&[(2.0, 2.0), (20.0, 0.0), (30.0, 0.5), (55.0, 0.0)]);
    let scene = scene("granite", 60.0, "", &two);
    let (native, image) = (csv(&natively(&scene), "native"), csv(&on_image(&scene), "image"));
    assert_eq!(native.lines().count(), 60_002);
    let differ = native
        .lines()
        .zip(image.lines())
        .position(|(native, image)| native != image);
    assert_eq!(differ, None, "first line that differs");
    assert_eq!(native.len(), image.len());
    // Blank cells would be equal too.
    assert!(native.lines().all(|line| !line.contains(",,,")));
}

#[test]
fn a_run_repeats_bit_for_bit_and_its_seed_matters() {
    let with_seed = |seed| {
        let mut scene = scene("abs", 2.0, "", &forces(&[(0.5, 1.0)]));
        scene.seed = seed;
        csv(&on_image(&scene), &format!("seed-{seed}"))
    };
    let first = with_seed(1);
    assert_eq!(first, with_seed(1));
    assert_ne!(first, with_seed(2));
}

/// The name of a material, changed in a copy of the image: the device no longer knows it.
#[test]
fn image_engine_runs_the_given_image() {
    let mut bytes = std::fs::read(image()).expect("the image");
    let name = b"copper";
    let places: Vec<_> = (0..bytes.len() - name.len())
        .filter(|&at| bytes[at..].starts_with(name))
        .collect();
    assert!(!places.is_empty());
    for at in places {
        bytes[at] = b'k';
    }
    let altered = Firmware::from_elf(&bytes).expect("still an image");
    let contact = forces(&[(0.5, 2.0)]);
    let refused = on(&altered, &scene("copper", 2.0, "", &contact))
        .expect_err("copper is gone")
        .to_string();
    assert!(
        refused.contains("err unknown material 'copper'; known: kopper"),
        "{refused}"
    );
    on(&altered, &scene("abs", 1.0, "", &contact)).expect("the rest still works");
}
