//! Runs on a strict emulator, with a chip at the ends of its tolerances.

use thermal_plant::parameters::stream_seed;
use thermal_sim::five_fingers::{FINGERS, FiveFingerRunner};
use thermal_sim::metrics::Figures;
use thermal_sim::processor::ChipState;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;
use thermal_sim::{RamLayout, SceneRunner};

/// A device on a strict chip: the emulator checks what it otherwise leaves out, the flash takes its longest times, and the
/// internal low-speed oscillator has its lowest or its highest rate, half of the scenes each.
pub struct Strict<D: ?Sized>(pub Box<D>);

/// The scene on its strict chip.
fn on_strict_chip(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let name = format!("{:?} {:?} {:?}", scene.faults, scene.injections, scene.host);
    let slow = stream_seed(scene.seed, &name) & 1 == 0;
    scene.chip.strict = true;
    scene.chip.slow_flash = true;
    scene.chip.lsi_hz = if slow {
        *ChipState::LSI_HZ.start()
    } else {
        *ChipState::LSI_HZ.end()
    };
    scene
}

impl SceneRunner for Strict<dyn SceneRunner> {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn run(&self, scene: &Scene) -> anyhow::Result<(Outcome, Figures)> {
        self.0.run(&on_strict_chip(scene))
    }

    fn has_processor(&self) -> bool {
        self.0.has_processor()
    }

    fn ram_layout(&self) -> anyhow::Result<RamLayout> {
        self.0.ram_layout()
    }
}

/// The fingers share the chip, which is that of the first finger's scene.
impl FiveFingerRunner for Strict<dyn FiveFingerRunner> {
    fn run_five(&self, scenes: &[Scene; FINGERS]) -> anyhow::Result<Vec<(Outcome, Figures)>> {
        self.0.run_five(&scenes.each_ref().map(on_strict_chip))
    }
}
