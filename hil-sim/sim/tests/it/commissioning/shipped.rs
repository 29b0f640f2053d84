//! Settings that are kept of the devices of `scenes/`.

use std::collections::HashMap;
use std::path::Path;

use thermal_sim::commissioning::{CommissioningSetup, commission, shipped_devices};
use thermal_sim::engine::NativeEngine;
use thermal_sim::scene::Scene;

#[test]
fn the_kept_settings_of_every_shipped_scene_are_those_of_commissioning() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = std::fs::read_dir(&folder).expect("scenes/").map(|file| file.unwrap().path());
    let scenes = files.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let kept: HashMap<_, _> =
        shipped_devices().map(|(setup, lines)| (format!("{setup:?}"), lines)).collect();
    let mut found = HashMap::new();
    for path in scenes {
        let scene = Scene::read(&path).expect("a shipped scene");
        if !scene.commissioned {
            continue;
        }
        let setup = CommissioningSetup::new(&scene.params, scene.room_c, scene.seed);
        let device = format!("{setup:?}");
        let found = found.entry(device.clone()).or_insert_with(|| {
            let mut engine = NativeEngine::new(setup.in_use().expect("a plant"));
            commission(&setup, &mut engine, &mut |_| ()).expect("commissioned").settings
        });
        let name = path.file_stem().unwrap().display();
        assert_eq!(
            kept.get(&device),
            Some(&*found),
            "keep them by `cargo hil-sim commission scenes/{name}.toml > hil-sim/sim/src/commissioning/shipped/{name}.txt`, \
             and the name in shipped.rs"
        );
    }
    assert!(!found.is_empty(), "no scene in {}", folder.display());
}
