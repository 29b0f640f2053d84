//! Runs on a strict emulator, with a chip at the ends of its tolerances.

use thermal_plant::parameters::stream_seed;
use thermal_sim::five_fingers::{FINGERS, FiveFingerRunner};
use thermal_sim::metrics::Figures;
use thermal_sim::processor::{ChipState, FlashTiming};
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;
use thermal_sim::{RamLayout, SceneRunner};

/// Late start of the external clock, us: within the 20 ms for which the program waits at least.
const LATE_CLOCK_US: u32 = 19_000;

/// A device on a strict chip: the emulator checks what it otherwise leaves out, and programming and erasing take their longest
/// times. Each of these is drawn by scene, half of the scenes each: the internal low-speed oscillator has its lowest or its
/// highest rate; the core waits for the flash with its accelerator or without it; the external clock starts at once or late.
pub struct Strict<D: ?Sized>(pub Box<D>);

/// The scene on its strict chip.
fn on_strict_chip(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let name = format!("{:?} {:?} {:?}", scene.faults, scene.injections, scene.host);
    let drawn = stream_seed(scene.seed, &name);
    let half = |bit: u32| drawn >> bit & 1 == 0;
    let chip = &mut scene.chip;
    chip.strict = true;
    chip.slow_flash = true;
    chip.lsi_hz = if half(0) { *ChipState::LSI_HZ.start() } else { *ChipState::LSI_HZ.end() };
    chip.flash = if half(1) { FlashTiming::Accelerated } else { FlashTiming::Unaccelerated };
    if half(2) {
        chip.external_clock_start_us = LATE_CLOCK_US;
    }
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
