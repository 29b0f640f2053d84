//! Parts of the microcontroller whose bits flip.

use std::ops::Range;

use rand::{Rng, RngExt};
use serde::Serialize;
use thermal_sim::processor::CoreRegister;
use thermal_sim::processor::MachineFault;
use thermal_sim::{RamLayout, SceneRunner};

use super::registers::REGISTERS;

/// A part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FlipRegion {
    /// Static data, what resets keep included.
    Statics,
    /// The part of the stack that is used.
    Stack,
    /// Any byte of the RAM.
    Ram,
    /// R0 to R12, stack pointer, link register, program counter, flags.
    Core,
    /// S0 to S31 and FPSCR.
    Float,
    /// Registers of devices that the image uses, of interrupt controller and system control.
    Device,
}

impl FlipRegion {
    /// All of them, with how many of a hundred flips each gets.
    pub const ALL: [(Self, u32); 6] = [
        (Self::Statics, 35),
        (Self::Stack, 15),
        (Self::Ram, 5),
        (Self::Core, 20),
        (Self::Float, 5),
        (Self::Device, 20),
    ];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Statics => "statics",
            Self::Stack => "stack",
            Self::Ram => "ram",
            Self::Core => "core",
            Self::Float => "float",
            Self::Device => "device",
        }
    }

    /// Draws one by its share.
    pub(super) fn draw(draw: &mut impl Rng) -> Self {
        let mut share = draw.random_range(0..100);
        for (region, its) in Self::ALL {
            if share < its {
                return region;
            }
            share -= its;
        }
        Self::Device
    }

    /// Draws a bit of it.
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
                let (address, bits) = REGISTERS[draw.random_range(0..REGISTERS.len())];
                MachineFault::RegisterBit {
                    address,
                    bit: one_of(bits, draw),
                }
            }
        }
    }
}

fn core(register: CoreRegister, draw: &mut impl Rng) -> MachineFault {
    MachineFault::CoreBit {
        register,
        bit: one_of(register.bits(), draw),
    }
}

/// Draws one of the bits of a mask that is not 0.
fn one_of(bits: u32, draw: &mut impl Rng) -> u8 {
    let which = draw.random_range(0..bits.count_ones());
    let mut set = (0..32).filter(|bit| bits >> bit & 1 != 0);
    set.nth(which as usize).unwrap_or_default()
}

/// Where an image keeps what: addresses of RAM.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FlippableMemory {
    /// All of it.
    pub ram: Range<u32>,
    /// Static data.
    pub statics: Range<u32>,
    /// SessionResult stack.
    pub stack: Range<u32>,
}

impl FlippableMemory {
    /// That of a device whose image uses so much of its stack, bytes.
    ///
    /// # Errors
    /// It has no RAM, its image does not say where its static data are, or there are none, or it uses no stack.
    pub fn of(device: &dyn SceneRunner, stack_bytes: u32) -> anyhow::Result<Self> {
        let RamLayout {
            ram,
            statics,
            stack_top,
        } = device.ram_layout()?;
        let stack = stack_top.saturating_sub(stack_bytes)..stack_top;
        anyhow::ensure!(
            !statics.is_empty() && !stack.is_empty(),
            "the image has {} bytes of static data and uses {} of stack; some of both are needed",
            statics.len(),
            stack.len()
        );
        Ok(Self {
            ram,
            statics,
            stack,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_of_a_hundred() {
        assert_eq!(
            FlipRegion::ALL.iter().map(|(_, share)| share).sum::<u32>(),
            100
        );
    }

    #[test]
    fn every_register_is_its_own_word_and_has_bits() {
        for (i, (address, bits)) in REGISTERS.iter().enumerate() {
            assert!(address.is_multiple_of(4) && *bits != 0, "{address:#x}");
            assert!(
                REGISTERS[..i].iter().all(|(other, _)| other != address),
                "{address:#x}"
            );
        }
    }
}
