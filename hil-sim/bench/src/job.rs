//! Jobs of the image, selected by the levels of port C's pins.
use crate::kernels::{Call, KERNELS};
use crate::scenes::{SCENES, Scene, only_return_scene};

/// Number of inputs of a kernel on the microcontroller.
pub const ON_TARGET: u32 = 1000;

/// Pin 7: calls functions that only return.
const ONLY_RETURN: u32 = 1 << 7;
/// Pin 6: scenes instead of kernels.
const SCENE: u32 = 1 << 6;

/// A series of calls of one function.
#[derive(Clone, Copy)]
pub enum Job {
    /// The kernel inputs with the numbers 0 to [`ON_TARGET`] - 1.
    Kernel(Call),
    /// The ticks 1 to [`TICKS`](crate::scenes::TICKS).
    Scene(Scene),
}

impl Job {
    /// The job that the pins select; `None` if there is no such kernel or scene.
    pub fn selected(pins: u32) -> Option<Self> {
        let only_return = pins & ONLY_RETURN != 0;
        let index = (pins & (SCENE - 1)) as usize;
        Some(if pins & SCENE == 0 {
            let call = KERNELS.get(index)?.call;
            Self::Kernel(if only_return { call.only_return() } else { call })
        } else {
            let scene = *SCENES.get(index)?;
            let step = if only_return { only_return_scene } else { scene.step };
            Self::Scene(Scene { step, ..scene })
        })
    }

    /// Pins that select a kernel by its index in [`KERNELS`].
    pub fn kernel_pins(index: usize) -> u32 {
        index as u32
    }

    /// Pins that select a scene by its index in [`SCENES`].
    pub fn scene_pins(index: usize) -> u32 {
        index as u32 | SCENE
    }

    /// Pins that select the same number of calls of a function that only returns.
    pub fn only_return(pins: u32) -> u32 {
        pins | ONLY_RETURN
    }
}

/// Checksum of a series of values (FNV-1a, 64 bits at a time).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Checksum(pub u64);

impl Default for Checksum {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Checksum {
    /// Appends the bits of a value.
    pub fn add(&mut self, bits: u64) {
        self.0 = (self.0 ^ bits).wrapping_mul(0x0100_0000_01b3);
    }
}
