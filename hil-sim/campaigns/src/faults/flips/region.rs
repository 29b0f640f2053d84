//! Parts of the microcontroller whose bits flip.

use std::ops::Range;

use rand::{Rng, RngExt};
use serde::Serialize;

use super::registers::REGISTERS;
use thermal_sim::processor::MachineFault;
use thermal_sim::processor::CoreRegister;

/// A part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Region {
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

impl Region {
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
    pub(super) fn bit(self, memory: &Memory, draw: &mut impl Rng) -> MachineFault {
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

/// Where an image keeps what: addresses of RAM, none of them empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Memory {
    pub(super) ram: Range<u32>,
    pub(super) statics: Range<u32>,
    pub(super) stack: Range<u32>,
}

impl Memory {
    /// The addresses of the RAM, those of an image's static data, and those of the part of the stack that it uses.
    ///
    /// # Errors
    /// There is no static data, or nothing of the stack is used.
    pub fn new(ram: Range<u32>, statics: Range<u32>, stack: Range<u32>) -> anyhow::Result<Self> {
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
        assert_eq!(Region::ALL.iter().map(|(_, share)| share).sum::<u32>(), 100);
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
