//! Settings of the devices of the scenes in `scenes/`. Commissioning a device takes several times as long as running a scene on
//! it, and every program that runs one would repeat it.

use std::collections::HashMap;
use std::path::Path;
use std::sync::LazyLock;

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

static SETTINGS: LazyLock<HashMap<String, Vec<String>>> = LazyLock::new(|| {
    let shipped =
        shipped!("copper-on-foam" "granite" "layered-finger" "lift-and-replace" "worst-case-box");
    let settings = |(path, scene, lines): (&str, &str, &str)| {
        let scene = Scene::parse(scene, Path::new(path)).ok()?;
        let setup = CommissioningSetup::new(&scene.params, scene.room_c, scene.seed);
        Some((setup.key(), lines.lines().map(Into::into).collect()))
    };
    shipped.into_iter().filter_map(settings).collect()
});

/// The settings of a device as lines, if a scene of `scenes/` has that device.
pub fn shipped_settings(setup: &CommissioningSetup) -> Option<&'static [String]> {
    SETTINGS.get(&setup.key()).map(Vec::as_slice)
}
