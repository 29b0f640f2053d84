//! The five-finger image on five plants.

use std::sync::OnceLock;

use documented_figures::{Compiler, assert_compiled, assert_figure};
use hil_sim::World;
use hil_sim::hand::{FINGERS, Hand, ImageHand, NativeHand, run};
use hil_sim::machine::Firmware;
use hil_sim::run::Outcome;
use hil_sim::scene::Scene;
use system_tests::{forces, host, natively, scene};

/// Cycles of a millisecond: 180 MHz.
const MILLISECOND: f64 = 180_000.0;

/// The five-finger image of the current sources, built once.
fn image() -> &'static Firmware {
    static IMAGE: OnceLock<Firmware> = OnceLock::new();
    IMAGE.get_or_init(|| {
        let path = hil_sim::firmware::build(FINGERS).expect("the image builds");
        Firmware::from_file(&path).expect("an image for this chip")
    })
}

fn worlds(scenes: &[Scene; FINGERS]) -> [World; FINGERS] {
    scenes
        .each_ref()
        .map(|scene| World::new(scene).expect("a plant for the scene"))
}

fn on_image(scenes: &[Scene; FINGERS]) -> ([Outcome; FINGERS], ImageHand) {
    let mut hand = ImageHand::new(image(), worlds(scenes)).expect("the image starts");
    let outcomes = run(scenes, &mut hand, |_| ()).expect("the image runs to the end");
    (outcomes, hand)
}

/// Five materials, five forces, five landings; another noise on each finger.
fn five_contacts() -> [Scene; FINGERS] {
    let mut seed = 0;
    [
        ("copper", 2.0),
        ("granite", 0.5),
        ("abs", 1.0),
        ("foam", 0.25),
        ("stainless-steel", 0.1),
    ]
    .map(|(material, force_n)| {
        seed += 1;
        let landing_s = 0.5 + 0.1 * f64::from(seed as u32);
        let mut scene = scene(
            material,
            3.0,
            "",
            &forces(&[(landing_s, force_n), (2.7, 0.0)]),
        );
        scene.seed = seed;
        scene
    })
}

/// One image does to five plants, bit for bit, what five native devices do that sample as it does; and to the noise of
/// the sensors what five one-finger devices do.
#[test]
fn each_finger_is_as_it_would_be_alone() {
    let scenes = five_contacts();
    let (image, _) = on_image(&scenes);
    let native = run(&scenes, &mut NativeHand::new(worlds(&scenes)), |_| ()).expect("runs");
    let mut farthest_k = 0.0f64;
    for (finger, scene) in scenes.iter().enumerate() {
        let [image, native] = [&image[finger], &native[finger]].map(|outcome| outcome.trace.rows());
        assert_eq!(image.len(), 3001);
        assert!(
            image.iter().filter(|row| row.device.is_some()).count() >= 300,
            "telemetry"
        );
        let differ = image
            .iter()
            .zip(native)
            .position(|(image, native)| image != native);
        assert_eq!(
            differ.map(|row| (&image[row], &native[row])),
            None,
            "finger {finger}"
        );
        let alone = natively(scene);
        let mut largest_k = 0.0f64;
        for (row, alone) in image.iter().zip(alone.trace.rows()) {
            largest_k = largest_k.max((row.skin_c - alone.skin_c).abs());
        }
        println!(
            "finger {finger}, {}: {:.2} mK from a finger alone",
            scene.object.name,
            largest_k * 1e3
        );
        farthest_k = farthest_k.max(largest_k);
    }
    assert_figure("five_fingers.skin_as_alone", 1e3 * farthest_k);
}

/// Five ticks and everything else in a ninth of the CPU; without what the guard looks at it was a tenth.
#[test]
fn five_fingers_fit_a_ninth_of_the_cpu() {
    let (_, hand) = on_image(&five_contacts());
    let cost = hand.cost().expect("figures");
    let path = hil_sim::firmware::build(FINGERS).expect("the image builds");
    let compiler = Compiler::of_elf(&std::fs::read(path).expect("the image"));
    for (key, measured) in [
        ("five_fingers.cpu_load", 100.0 * cost.load),
        ("five_fingers.cycles_mean", cost.cycles_mean),
        ("five_fingers.cycles_max", cost.cycles_max as f64),
    ] {
        assert_compiled(key, measured, &compiler);
    }
    // A tick ends before the next finger's samples come.
    assert!(
        (cost.cycles_max as f64) < MILLISECOND / FINGERS as f64,
        "{cost:?}"
    );
}

/// A driver that trips stops its own finger, and `abort` to a finger that one.
#[test]
fn a_fault_and_an_abort_stop_their_own_finger() {
    let mut scenes = five_contacts();
    let fault = "[[fault]]\nkind = \"bridge-shorted\"\nt_s = 1.5\n";
    scenes[1] = scene("granite", 3.0, "", &(forces(&[(0.7, 2.0)]) + fault));
    scenes[3] = scene(
        "foam",
        3.0,
        "",
        &(forces(&[(0.9, 2.0)]) + &host(&[(2.0, "abort")])),
    );
    let (outcomes, _) = on_image(&scenes);
    let state_at = |finger: usize, t_s: f64| {
        let outcome: &Outcome = &outcomes[finger];
        let devices = outcome.trace.rows().iter().filter(|row| row.t_s >= t_s);
        let device = devices.filter_map(|row| row.device.as_ref()).next();
        device.expect("telemetry").state.clone()
    };
    for finger in 0..FINGERS {
        let (early, late) = match finger {
            1 => ("tripped", "tripped"),
            3 => ("contact", "ready"),
            _ => ("contact", "contact"),
        };
        assert_eq!(state_at(finger, 1.6), early, "finger {finger}");
        assert_eq!(state_at(finger, 2.2), late, "finger {finger}");
    }
    for (finger, from_s) in [(1, 1.51), (3, 2.02)] {
        for row in outcomes[finger]
            .trace
            .rows()
            .iter()
            .filter(|row| row.t_s > from_s)
        {
            assert_eq!(row.current_a, 0.0, "finger {finger} at {} s", row.t_s);
        }
    }
}
