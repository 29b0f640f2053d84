//! The native engine and the release image write identical traces, and the image engine runs the image that it is given.

use std::path::Path;

use image_tests::{image, on, on_image};
use stm32_emulator::{Firmware, OneFingerBoard};
use system_tests::{between, forces, host, natively, scene};
use thermal_campaigns::fidelity::{Population, Way};
use thermal_sim::processor::FlashTiming;
use thermal_sim::run::{Outcome, run};
use thermal_sim::scene::Scene;
use thermal_sim::{NativeRunner, World};

fn csv(outcome: &Outcome, name: &str) -> String {
    let path =
        std::env::temp_dir().join(format!("thermal-display-{}-{name}.csv", std::process::id()));
    outcome.trace.write(&path).expect("a trace");
    let text = std::fs::read_to_string(&path).expect("a trace");
    std::fs::remove_file(&path).expect("a trace");
    text
}

/// Times of the edges at the trigger input by the device's events, µs since its start.
fn reported_edges_us(outcome: &Outcome) -> Vec<i64> {
    let lines = outcome.events.iter().map(|(_, line)| line);
    lines
        .filter(|line| line.ends_with("trigger"))
        .map(|line| {
            let mut words = line.split(' ').skip(1).map(|word| word.parse::<i64>());
            let (Some(Ok(tick)), Some(Ok(us))) = (words.next(), words.next()) else {
                panic!("{line}");
            };
            1000 * tick + us
        })
        .collect()
}

#[test]
fn native_and_image_write_the_same_trace_over_two_contacts() {
    let two = forces(&[(2.0, 2.0), (20.0, 0.0), (30.0, 0.5), (55.0, 0.0)]);
    let scene = scene("granite", 60.0, "", &two);
    let (native, image) = (csv(&natively(&scene), "native"), csv(&on_image(&scene), "image"));
    assert_eq!(native.lines().count(), 60_002);
    let differ = native.lines().zip(image.lines()).position(|(native, image)| native != image);
    assert_eq!(differ, None, "first line that differs");
    assert_eq!(native.len(), image.len());
    // Two traces of blank cells would be equal, too.
    assert!(native.lines().all(|line| !line.contains(",,,")));
}

/// The watchdog's oscillator at both ends of its range, the longest times of the flash, its accelerator off, an external clock
/// that starts late; an access to several words that is not aligned would be a fault.
#[test]
fn a_strict_chip_writes_the_same_trace() {
    let touched = scene("copper", 4.0, "", &forces(&[(1.0, 2.0), (3.0, 0.0)]));
    let usual = csv(&on_image(&touched), "usual");
    for lsi_hz in [17_000, 47_000] {
        let mut strict = touched.clone();
        strict.chip.strict = true;
        strict.chip.slow_flash = true;
        strict.chip.lsi_hz = lsi_hz;
        strict.chip.flash = FlashTiming::Unaccelerated;
        strict.chip.external_clock_start_us = 19_000;
        assert_eq!(csv(&on_image(&strict), "strict"), usual, "{lsi_hz} Hz");
    }
}

/// The shorted driver reports by its fault pin, which trips the device in the same tick of both engines; armed again, it trips
/// again.
#[test]
fn a_shorted_bridge_trips_both_engines_in_the_same_tick() {
    let fault = forces(&[(0.5, 2.0)]) + "[[fault]]\nkind = \"bridge-shorted\"\nt_s = 1.0\n";
    let again = host(&[(1.5, "clear"), (1.6, "arm")]);
    let scene = scene("copper", 3.0, "", &(fault + &again));
    let (native, image) = (natively(&scene), on_image(&scene));
    assert_eq!(csv(&native, "native-short"), csv(&image, "image-short"));
    for row in between(&image, 1.001, 3.0) {
        assert_eq!(row.current_a, 0.0, "at {} s", row.t_s);
    }
    for row in between(&image, 1.003, 1.5) {
        let device = row.device.as_ref().expect("telemetry of every tick");
        let reported = (device.state.name(), device.remark());
        assert_eq!(reported, ("tripped", Some("bridge")), "at {} s", row.t_s);
    }
    // Armed again, the self-test runs, which takes a second longer under a finger; then the bridge drives and trips again.
    let state_at = |from_s: f64| {
        let row = between(&image, from_s, 3.0).next().expect("a row");
        row.device.as_ref().map(|device| device.state.name())
    };
    assert_eq!(state_at(1.55), Some("off"));
    assert_eq!(state_at(1.65), Some("self-test"));
    assert_eq!(state_at(2.65), Some("self-test"));
    // At most 63 ms until it begins, 80 ms for the comparator, 64 ms for the slope.
    assert_eq!(state_at(2.85), Some("tripped"));
}

/// An object with most relaxations, which is uploaded, and a drawn finger on a drawn device.
#[test]
fn both_engines_write_the_same_trace_of_a_layered_object_and_of_a_drawn_finger() {
    let objects = Population::Objects.cases(1, 0).expect("cases");
    let layers = objects.iter().find(|case| case.name == "5 x copper, foam");
    let drawn = Population::DrawnFingers.cases(1, 1).expect("cases");
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    for case in [layers, drawn.get(4)] {
        let case = case.expect("a case");
        let same = case.check_same(&NativeRunner, &firmware, Way::AsItIs);
        same.unwrap_or_else(|error| panic!("{}: {error:#}", case.name));
    }
}

/// A drawn finger, learnt from the designed heat-flux sensor in two contacts.
#[test]
fn both_engines_write_the_same_trace_of_a_finger_that_is_learnt() {
    let finger = "[device]\nflux_sensor = true\n[finger]\ntissue = \"layered\"\ndraw = 3\n";
    let touched = forces(&[(1.0, 2.0), (4.0, 0.0), (7.0, 0.5), (8.0, 0.0)]);
    let tables = [finger, &touched, &host(&[(0.2, "events on")])].concat();
    for material in ["granite", "copper"] {
        let scene = scene(material, 9.0, "", &tables);
        let (native, image) = (natively(&scene), on_image(&scene));
        assert_eq!(native.events, image.events, "{material}");
        // What is known of the finger changes: it is trusted.
        let is_learnt = |(_, line): &(f64, String)| line.ends_with("flux");
        assert!(image.events.iter().any(is_learnt), "{:?}", image.events);
        let [native, image] = [(&native, "native"), (&image, "image")]
            .map(|(outcome, engine)| csv(outcome, &format!("{engine}-learnt-{material}")));
        assert!(native == image, "{material}");
    }
}

/// A layered finger, repeated contacts, a plant of the parameter box, and random draws by an infrared camera.
#[test]
fn both_engines_write_the_same_trace_of_the_example_scenes() {
    for name in ["layered-finger", "lift-and-replace", "worst-case-box"] {
        let path = format!("{}/../../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let scene = Scene::read(Path::new(&path)).expect("a good scene");
        let (native, image) = (natively(&scene), on_image(&scene));
        let [native, image] = [(&native, "native"), (&image, "image")]
            .map(|(outcome, engine)| csv(outcome, &format!("{engine}-{name}")));
        assert!(native == image, "{name}");
    }
}

/// A pulse that waits for the trigger and is started by its first edge; edges all over the millisecond, also while the tick
/// runs. The times of the edges in the events are those of the scene.
#[test]
fn both_engines_play_a_course_from_the_same_trigger_and_report_the_same_events() {
    let lines = host(&[
        (0.2, "events on"),
        (0.3, "hold 33 5"),
        (1.0, "pulse 33 30 5 0.2 5"),
        (1.1, "trigger-out start,end"),
        (2.6, "play trigger"),
    ]);
    let edges_s: Vec<_> = (0..100).map(|n| 3.0 + 0.021_037 * f64::from(n)).collect();
    let triggers: String =
        (edges_s.iter()).map(|t_s| format!("[[trigger]]\nt_s = {t_s:.6}\n")).collect();
    let touched = forces(&[(0.5, 2.0)]) + &triggers + &lines;
    let scene = scene("copper", 5.5, "", &touched);
    let (native, image) = (natively(&scene), on_image(&scene));
    let told = |outcome: &Outcome| -> Vec<String> {
        outcome.events.iter().map(|(_, line)| line.clone()).collect()
    };
    assert_eq!(told(&native), told(&image));
    assert!(csv(&native, "native-course") == csv(&image, "image-course"));
    let events = told(&image);
    let of = |kind: &str| events.iter().filter(|line| line.ends_with(kind)).count();
    assert_eq!((of("start"), of("end")), (2, 2), "{events:?}");
    // From edge to edge the events tell what the scene says, to a microsecond.
    let reported_us = reported_edges_us(&image);
    assert_eq!(reported_us.len(), edges_s.len(), "{events:?}");
    for (reported, scene) in reported_us.windows(2).zip(edges_s.windows(2)) {
        let interval_us = 1e6 * (scene[1] - scene[0]);
        assert!(((reported[1] - reported[0]) as f64 - interval_us).abs() < 0.5);
    }
}

/// Edges in each microsecond of a tick, and many about the one in which the tick reads the timer, while the host's lines delay
/// ticks by a little.
#[test]
fn the_image_reports_an_edge_at_any_time_of_a_tick_to_a_microsecond() {
    const FIRST_US: i64 = 500_000;
    // The tick reads the timer some 963 us after its first scan, which starts 233 us before a millisecond of the scene.
    const AROUND_READING_US: i64 = 700;
    let all = (0..1000).map(|n| FIRST_US + 2001 * n);
    let around_reading =
        (0..1000).map(|n| FIRST_US + 2_100_000 + 3000 * n + AROUND_READING_US + n % 40);
    let edges_us: Vec<i64> = all.chain(around_reading).collect();
    let triggers: String = (edges_us.iter())
        .map(|us| format!("[[trigger]]\nt_s = {:.6}\n", 1e-6 * *us as f64))
        .collect();
    let queries = (0..1000).map(|n| (0.5 + 5.3e-3 * f64::from(n), "law"));
    let lines: Vec<_> = [(0.2, "events on")].into_iter().chain(queries).collect();
    let scene = scene("copper", 6.0, "", &(triggers + &host(&lines)));
    let reported_us = reported_edges_us(&on_image(&scene));
    assert_eq!(reported_us.len(), edges_us.len());
    let zero_us = reported_us[0] - edges_us[0];
    let wrong: Vec<_> = (reported_us.iter().zip(&edges_us))
        .map(|(reported_us, edge_us)| (reported_us % 1000, reported_us - zero_us - edge_us))
        // The emulated chip sees an edge between two blocks of instructions, so a microsecond late at most.
        .filter(|(_, error_us)| !(0..=1).contains(error_us))
        .collect();
    assert!(wrong.is_empty(), "us of a tick, error in us: {wrong:?}");
}

/// The pulse at the output begins in the tick that starts or ends a course, or finds a lift; a landing is marked once it is
/// found, and its event tells the tick in which it began.
#[test]
fn the_trigger_output_marks_events_in_the_tick_that_finds_them() {
    const EDGE_S: f64 = 2.5;
    let lines = host(&[
        (0.2, "events on"),
        (0.3, "trigger-out land,lift,start,end"),
        (0.8, "pulse 33 30 5 0.2 5"),
    ]);
    let edge = format!("[[trigger]]\nt_s = {EDGE_S}\n");
    let touched = forces(&[(0.5, 2.0), (2.7, 0.0)]) + &edge + &lines;
    let scene = scene("copper", 3.0, "", &touched);
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    let world = World::new(&scene).expect("a plant for the scene");
    let mut board = OneFingerBoard::new(&firmware, world).expect("the image starts");
    let outcome = run(&scene, &mut board, |_| ()).expect("the image runs to the end");
    let times: Vec<(f64, &str)> = (outcome.events.iter())
        .map(|(_, line)| {
            let words: Vec<_> = line.split(' ').collect();
            let [_, tick, us, kind] = words[..] else {
                panic!("{line}");
            };
            let number = |word: &str| word.parse::<f64>().expect("a number");
            (number(tick) * 1e-3 + number(us) * 1e-6, kind)
        })
        .collect();
    let reported_edge_s = times.iter().find(|(_, kind)| *kind == "trigger").expect("an edge").0;
    let zero_s = scene.settle_s;
    let rises_s: Vec<_> = (board.trigger_output_rises_s().iter())
        .map(|rise_s| rise_s - zero_s - EDGE_S + reported_edge_s)
        .collect();
    let marked: Vec<_> = times.iter().filter(|(_, kind)| *kind != "trigger").collect();
    assert_eq!(rises_s.len(), marked.len(), "{times:?} {rises_s:?}");
    let mut latest_us = 0.0_f64;
    for ((tick_s, kind), rise_s) in marked.into_iter().zip(rises_s) {
        // The scans of a tick take 950 us.
        let late_us = 1e6 * (rise_s - tick_s) - 950.0;
        println!("{kind}: {late_us:.0} us after the end of its tick's scans");
        match *kind {
            "land" => assert!((1000.0..3100.0).contains(&late_us), "{late_us} us"),
            _ => latest_us = latest_us.max(late_us),
        }
    }
    assert!((0.0..100.0).contains(&latest_us), "{latest_us} us");
}

#[test]
fn a_run_repeats_bit_for_bit_and_another_seed_changes_it() {
    let with_seed = |seed| {
        let mut scene = scene("abs", 2.0, "", &forces(&[(0.5, 1.0)]));
        scene.seed = seed;
        csv(&on_image(&scene), &format!("seed-{seed}"))
    };
    let first = with_seed(1);
    assert_eq!(first, with_seed(1));
    assert_ne!(first, with_seed(2));
}

/// In a copy of the image a material has another name: the device refuses the old one.
#[test]
fn the_image_engine_runs_the_image_that_it_is_given() {
    let mut bytes = std::fs::read(image()).expect("the image");
    let name = b"copper";
    let places: Vec<_> =
        (0..bytes.len() - name.len()).filter(|&at| bytes[at..].starts_with(name)).collect();
    assert!(!places.is_empty());
    for at in places {
        bytes[at] = b'k';
    }
    let altered = Firmware::from_elf(&bytes).expect("still an image");
    let contact = forces(&[(0.5, 2.0)]);
    let refused =
        on(&altered, &scene("copper", 2.0, "", &contact)).expect_err("copper is gone").to_string();
    assert!(refused.contains("err unknown material 'copper'; known: kopper"), "{refused}");
    on(&altered, &scene("abs", 1.0, "", &contact)).expect("the rest still works");
}
