//! Settings of the devices of the scenes in `scenes/`. Commissioning a device takes several times as long as running a scene on
//! it, and every program that runs one would repeat it.

use std::path::Path;

use super::CommissioningSetup;
use crate::scene::Scene;

/// A scene of `scenes/`, and what `cargo hil-sim commission scenes/NAME.toml` prints of its device. One scene stands for all of
/// the same device. A test commissions each device again and compares.
macro_rules! shipped {
    ($($name:literal)*) => {
        [$((
            concat!("scenes/", $name, ".toml"),
            include_str!(concat!("../../../../scenes/", $name, ".toml")),
            include_str!(concat!("shipped/", $name, ".txt")),
        )),*]
    };
}

/// The devices of `scenes/`, each with its settings as lines.
pub fn shipped_devices() -> impl Iterator<Item = (CommissioningSetup, Vec<String>)> {
    let shipped =
        shipped!("copper-on-foam" "granite" "layered-finger" "lift-and-replace" "worst-case-box");
    shipped.into_iter().filter_map(|(path, scene, lines)| {
        let scene = Scene::parse(scene, Path::new(path)).ok()?;
        let setup = CommissioningSetup::new(&scene.params, scene.room_c, scene.seed);
        Some((setup, lines.lines().map(Into::into).collect()))
    })
}
