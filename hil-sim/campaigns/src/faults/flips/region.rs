//! Regions of the microcontroller whose bits flip.

use std::ops::Range;
use std::sync::LazyLock;

use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};
use thermal_sim::processor::CoreRegister;
use thermal_sim::processor::MachineFault;
use thermal_sim::{RamLayout, SceneRunner, named_enum};

/// What `registers.toml` holds.
#[derive(Deserialize)]
struct Registers {
    registers: Vec<Register>,
}

/// A register of a device.
#[derive(Clone, Copy, Deserialize)]
struct Register {
    address: u32,
    /// Mask of the bits that it has.
    bits: u32,
}

static REGISTERS: LazyLock<Vec<Register>> = LazyLock::new(|| {
    let file: Registers = toml::from_str(include_str!("registers.toml")).expect("registers.toml");
    file.registers
});

named_enum! {
    /// A part of the microcontroller whose bits flip.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum FlipRegion {
        /// Static data, including what survives a reset.
        Statics = "statics",
        /// The part of the stack that is used.
        Stack = "stack",
        /// Any byte of the RAM.
        Ram = "ram",
        /// R0 to R12, stack pointer, link register, program counter, flags.
        Core = "core",
        /// S0 to S31 and FPSCR.
        Float = "float",
        /// Registers of the peripherals in use, the interrupt controller and the system control block.
        Device = "device",
    }
}

/// Percentage of the flips that each region gets.
const SHARES: [(FlipRegion, u32); 6] = [
    (FlipRegion::Statics, 35),
    (FlipRegion::Stack, 15),
    (FlipRegion::Ram, 5),
    (FlipRegion::Core, 20),
    (FlipRegion::Float, 5),
    (FlipRegion::Device, 20),
];

impl FlipRegion {
    /// Draws a region according to the shares.
    pub(super) fn draw(draw: &mut impl Rng) -> Self {
        let mut share = draw.random_range(0..100);
        for (region, its) in SHARES {
            if share < its {
                return region;
            }
            share -= its;
        }
        Self::Device
    }

    /// Draws a bit of the region.
    pub(super) fn bit(self, memory: &FlippableMemory, draw: &mut impl Rng) -> MachineFault {
        let byte = |draw: &mut _, range: &Range<u32>| MachineFault::RamBit {
            address: RngExt::random_range(draw, range.clone()),
            bit: RngExt::random_range(draw, 0..8),
        };
        match self {
            Self::Statics => byte(draw, &memory.statics),
            Self::Stack => byte(draw, &memory.stack),
            Self::Ram => byte(draw, &memory.ram),
            Self::Core => {
                let register = match draw.random_range(0..17) {
                    13 => CoreRegister::Sp,
                    14 => CoreRegister::Lr,
                    15 => CoreRegister::Pc,
                    16 => CoreRegister::Psr,
                    n => CoreRegister::R(n),
                };
                core(register, draw)
            }
            Self::Float => match draw.random_range(0..33) {
                32 => core(CoreRegister::Fpscr, draw),
                n => core(CoreRegister::S(n), draw),
            },
            Self::Device => {
                let Register { address, bits } = REGISTERS[draw.random_range(0..REGISTERS.len())];
                MachineFault::RegisterBit { address, bit: one_of(bits, draw) }
            }
        }
    }
}

fn core(register: CoreRegister, draw: &mut impl Rng) -> MachineFault {
    MachineFault::CoreBit { register, bit: one_of(register.bits(), draw) }
}

/// Draws one of the bits of a mask that is not 0.
fn one_of(bits: u32, draw: &mut impl Rng) -> u8 {
    let which = draw.random_range(0..bits.count_ones());
    let mut set = (0..32).filter(|bit| bits >> bit & 1 != 0);
    set.nth(which as usize).unwrap_or_default()
}

/// Address ranges of the RAM in which bits flip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FlippableMemory {
    /// The whole RAM.
    pub ram: Range<u32>,
    /// Static data.
    pub statics: Range<u32>,
    /// The part of the stack that is used.
    pub stack: Range<u32>,
}

impl FlippableMemory {
    /// The ranges for a device whose image uses `stack_bytes` of its stack.
    ///
    /// # Errors
    /// The device has no RAM, or its image does not name its static data, has none, or uses no stack.
    pub fn new(device: &dyn SceneRunner, stack_bytes: u32) -> anyhow::Result<Self> {
        let RamLayout { ram, statics, stack_top } = device.ram_layout()?;
        let stack = stack_top.saturating_sub(stack_bytes)..stack_top;
        anyhow::ensure!(
            !statics.is_empty() && !stack.is_empty(),
            "the image has {} bytes of static data and uses {} of stack; some of both are needed",
            statics.len(),
            stack.len()
        );
        Ok(Self { ram, statics, stack })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn shares_sum_to_100_percent() {
        assert_eq!(SHARES.iter().map(|(_, share)| share).sum::<u32>(), 100);
    }

    #[test]
    fn every_register_is_its_own_word_and_has_bits() {
        let mut addresses = HashSet::new();
        for Register { address, bits } in REGISTERS.iter() {
            assert!(address.is_multiple_of(4) && *bits != 0, "{address:#x}");
            assert!(addresses.insert(address), "{address:#x}");
        }
    }
}
