//! The image for five fingers on five simulated plants.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use documented_figures::{assert_compiled, assert_figure};
use image_proof::compiler::of_elf;
use stm32_emulator::Firmware;
use stm32_emulator::FiveFingerBoard;
use system_tests::{forces, host, natively, scene};
use thermal_sim::World;
use thermal_sim::five_fingers::{FINGERS, FiveFingerEngine, NativeFiveFingers, run};
use thermal_sim::metrics::figures;
use thermal_sim::run::Outcome;
use thermal_sim::scene::{HostLine, Scene};

/// Cycles in a millisecond at 180 MHz.
const MILLISECOND: f64 = 180_000.0;

/// The ELF file of the image of the current sources for five fingers, built once.
pub fn elf() -> &'static Path {
    static ELF: OnceLock<PathBuf> = OnceLock::new();
    ELF.get_or_init(|| stm32_emulator::build(FINGERS).expect("the image builds"))
}

pub fn worlds(scenes: &[Scene; FINGERS]) -> [World; FINGERS] {
    scenes.each_ref().map(|scene| World::of_five_fingers(scene).expect("a plant for the scene"))
}

fn on_image(scenes: &[Scene; FINGERS]) -> ([Outcome; FINGERS], FiveFingerBoard) {
    let image = Firmware::from_file(elf()).expect("an image for this chip");
    let mut hand = FiveFingerBoard::new(&image, worlds(scenes)).expect("the image starts");
    let outcomes = run(scenes, &mut hand, |_| ()).expect("the image runs to the end");
    (outcomes, hand)
}

/// Scenes with different materials, forces, times of landing and noise.
fn five_contacts() -> [Scene; FINGERS] {
    let mut seed = 0;
    [("copper", 2.0), ("granite", 0.5), ("abs", 1.0), ("foam", 0.25), ("stainless-steel", 0.1)].map(
        |(material, force_n)| {
            seed += 1;
            let landing_s = 0.5 + 0.1 * f64::from(seed as u32);
            let mut scene = scene(material, 3.0, "", &forces(&[(landing_s, force_n), (2.7, 0.0)]));
            scene.seed = seed;
            scene
        },
    )
}

/// Objects of layers, which are uploaded, and one half-space between them; fingers of layers and the thesis's.
pub fn five_layered_contacts() -> [Scene; FINGERS] {
    const LAYERED: &str = "[finger]\ntissue = \"layered\"\n";
    const ON_FOAM: &str = "[[object.layer]]\nthickness_m = 0.001\nk_w_mk = 398\nrho_kg_m3 = 8954\nc_j_kgk = 384\n\
                           [[object.layer]]\nk_w_mk = 0.029\nrho_kg_m3 = 24\nc_j_kgk = 1210\n";
    const SLAB: &str = "thickness_m = 0.002\nback = \"held\"\n";
    let mut seed = 0;
    [
        ("copper", ON_FOAM, LAYERED),
        ("granite", SLAB, ""),
        ("abs", "", LAYERED),
        ("foam", SLAB, LAYERED),
        ("copper", ON_FOAM, ""),
    ]
    .map(|(material, object, finger)| {
        seed += 1;
        let landing_s = 0.3 + 0.1 * f64::from(seed as u32);
        let tables = format!("{object}{}{finger}", forces(&[(landing_s, 2.0)]));
        let mut scene = scene(material, 1.5, "", &tables);
        scene.seed = seed;
        scene
    })
}

/// Runs five scenes on the image and on five native devices that sample at the same times, and asserts that their traces are
/// equal, bit for bit. Returns those of the image.
fn equal_on_both_engines(scenes: &[Scene; FINGERS]) -> [Outcome; FINGERS] {
    let (image, _) = on_image(scenes);
    let mut native = NativeFiveFingers::new(worlds(scenes));
    let native = run(scenes, &mut native, |_| ()).expect("runs");
    for (finger, scene) in scenes.iter().enumerate() {
        let [image, native] = [&image[finger], &native[finger]].map(|outcome| outcome.trace.rows());
        assert_eq!(image.len(), (1e3 * scene.duration_s) as usize + 1);
        assert!(
            image.iter().filter(|row| row.device.is_some()).count() >= image.len() / 10,
            "telemetry"
        );
        let differ = image.iter().zip(native).position(|(image, native)| image != native);
        assert_eq!(differ.map(|row| (&image[row], &native[row])), None, "finger {finger}");
    }
    image
}

/// Each finger has its own object, though the device keeps one upload and the fingers' hosts begin at the same time.
#[test]
fn five_uploaded_objects_reach_their_fingers() {
    let scenes = five_layered_contacts();
    let image = equal_on_both_engines(&scenes);
    for (finger, (scene, outcome)) in scenes.iter().zip(&image).enumerate() {
        let [skin_mk, alone_mk] = [figures(scene, outcome), figures(scene, &natively(scene))]
            .map(|figures| figures.skin_max_mk().expect("a contact of more than 50 ms"));
        // The noise of the sensors is another one for a finger alone.
        assert!(
            (skin_mk - alone_mk).abs() < 1.0,
            "finger {finger}: {skin_mk} mK, alone {alone_mk} mK"
        );
    }
}

/// All fingers share the trigger input; one of them waits for it, all report it.
#[test]
fn an_edge_of_the_trigger_reaches_all_fingers_with_the_same_time_on_both_engines() {
    let mut scenes = five_contacts().map(|mut scene| {
        let lines = [(0.3, "events on"), (0.4, "pulse 33 30 5 0.2 5"), (1.2, "play trigger")];
        let lines = lines.map(|(t_s, line)| HostLine { t_s, line: line.into() });
        scene.host.extend(lines);
        scene
    });
    scenes[1].triggers_s = vec![1.5, 1.6, 2.1];
    let image = equal_on_both_engines(&scenes);
    let mut native = NativeFiveFingers::new(worlds(&scenes));
    let native = run(&scenes, &mut native, |_| ()).expect("runs");
    for (image, native) in image.iter().zip(&native) {
        let told = |outcome: &Outcome| -> Vec<String> {
            outcome.events.iter().map(|(_, line)| line.clone()).collect()
        };
        assert_eq!(told(image), told(native));
        let edges = told(image);
        let edges: Vec<_> = edges.iter().filter(|line| line.ends_with("trigger")).collect();
        assert_eq!(edges.len(), 3, "{edges:?}");
    }
}

/// The image writes the same traces as five native devices; up to the noise of the sensors, it also equals five devices for
/// one finger whose bridges switch at the same frequency: the losses at each edge grow with it. The largest difference is that
/// of the noise, hence the mean of several draws.
#[test]
fn each_of_five_fingers_behaves_like_a_finger_alone() {
    const DRAWS: u64 = 8;
    let scenes = five_contacts();
    equal_on_both_engines(&scenes);
    let farthest_k = |draw: u64| {
        let mut scenes = scenes.clone();
        for scene in &mut scenes {
            scene.seed += draw * FINGERS as u64;
        }
        let mut together = NativeFiveFingers::new(worlds(&scenes));
        let together = run(&scenes, &mut together, |_| ()).expect("runs");
        let mut farthest_k = 0.0f64;
        for (scene, together) in scenes.iter().zip(&together) {
            let alone = natively(&scene.on_five_fingers());
            for (row, alone) in together.trace.rows().iter().zip(alone.trace.rows()) {
                farthest_k = farthest_k.max((row.skin_c - alone.skin_c).abs());
            }
        }
        println!("draw {draw}: {:.2} mK from a finger alone", 1e3 * farthest_k);
        farthest_k
    };
    let mean_k = (0..DRAWS).map(farthest_k).sum::<f64>() / DRAWS as f64;
    assert_figure("five_fingers.skin_as_alone", 1e3 * mean_k);
}

#[test]
fn five_fingers_take_a_ninth_of_the_cpu() {
    let (_, hand) = on_image(&five_contacts());
    let cost = hand.cost().expect("figures");
    let elf = std::fs::read(elf()).expect("the image");
    let compiler = of_elf(&elf).expect("a compiler");
    for (key, measured) in [
        ("five_fingers.cpu_load", 100.0 * cost.load),
        ("five_fingers.cycles_mean", cost.cycles_mean),
        ("five_fingers.cycles_max", cost.cycles_max as f64),
    ] {
        assert_compiled(key, measured, &compiler);
    }
    // A tick ends before the next finger's samples come.
    assert!((cost.cycles_max as f64) < MILLISECOND / FINGERS as f64, "{cost:?}");
}

/// A tripped bridge driver and an `abort` each stop one finger; the others go on.
#[test]
fn a_fault_and_an_abort_stop_only_their_own_finger() {
    let mut scenes = five_contacts();
    let fault = "[[fault]]\nkind = \"bridge-shorted\"\nt_s = 1.5\n";
    scenes[1] = scene("granite", 3.0, "", &(forces(&[(0.7, 2.0)]) + fault));
    scenes[3] = scene("foam", 3.0, "", &(forces(&[(0.9, 2.0)]) + &host(&[(2.0, "abort")])));
    let (outcomes, _) = on_image(&scenes);
    let state_at = |finger: usize, t_s: f64| {
        let outcome: &Outcome = &outcomes[finger];
        let devices = outcome.trace.rows().iter().filter(|row| row.t_s >= t_s);
        let device = devices.filter_map(|row| row.device.as_ref()).next();
        device.expect("telemetry").state.name()
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
        for row in outcomes[finger].trace.rows().iter().filter(|row| row.t_s > from_s) {
            assert_eq!(row.current_a, 0.0, "finger {finger} at {} s", row.t_s);
        }
    }
}
