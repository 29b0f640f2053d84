//! Instructions that the CPU emulation executes otherwise than the architecture (ARMv7-M). When a basic block with one of them is
//! about to run for the first time, hooks are set on it, which correct behind the instruction what it leaves. Other code runs
//! without hooks, but for code in the RAM, which may change.
//!
//! The instruction behind may be one that the condition of an IT block skips, together with its hook. So the hooks reach to the
//! first instruction behind a block of four, and a correction waits for the next instruction that is executed, or the next basic
//! block.
use super::Wiring;
use super::cost;
use super::elf::{FLASH_BASE, RAM_BASE, RAM_SIZE};
use super::state::{Cpu, Masks, core_register, get, half_words, masks};
use unicorn_engine::{RegisterARM as Reg, uc_error};

/// From an instruction to the last that may be the next executed: four wide instructions.
const REACH: u32 = 16;
const CONTROL_NPRIV: u32 = 1;
const CONTROL_FPCA: u32 = 1 << 2;
/// Bit of ARMv8-M without which the emulation begins a new floating-point context in spite of FPCA.
pub(crate) const CONTROL_SFPA: u32 = 1 << 3;
const CONTROL_BITS: u32 = 7;
const IPSR: u32 = 0x1ff;
const APSR_NZCVQ: u32 = 0xf800_0000;
const APSR_Q: u32 = 1 << 27;
const FPSCR_ROUNDING: u32 = 3 << 22;
const SP: u32 = 13;

/// An instruction that may leave something wrong; the numbers are those of registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Suspect {
    /// SMLAD, SMLADX: Q is set if the sum of the two products is 2^31, which the addend may bring back into range.
    DualMultiply { n: u32, m: u32, addend: u32 },
    /// VCVT from 32-bit fixed point: rounds as FPSCR says, not to nearest.
    FromFixedPoint { register: u32, unsigned: bool, fraction_bits: u32 },
    /// Any value to SP, MSP or PSP: bits 1:0 are kept.
    WritesStackPointer,
    /// MRS of CONTROL: shows SFPA.
    ReadsControl { register: u32 },
    /// MSR to CONTROL: FPCA without SFPA; without privilege, the masks can no longer be read.
    WritesControl,
}

/// What is to be made good behind an instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Correction {
    ClearSaturation,
    Float { register: u32, value: u32 },
    AlignStackPointers,
    HideSfpa { register: u32 },
    Control { masks: Masks },
}

/// The instruction that begins with two half-words, if it is one of those.
fn suspect(first: u32, second: u32) -> Option<Suspect> {
    let (low, result, target) = (first & 0xf, second >> 8 & 0xf, second >> 12);
    // What leaves an SP that is not a multiple of 4 as it was before: data processing, a load, a write-back.
    let stack = |misaligns: bool| misaligns.then_some(Suspect::WritesStackPointer);
    match first >> 4 {
        0xfb2 if second & 0xe0 == 0 && target != 15 => {
            Some(Suspect::DualMultiply { n: low, m: second & 0xf, addend: target })
        }
        0xeeb | 0xeef if low & 0xe == 0xa && second & 0xfd0 == 0xac0 => {
            Some(Suspect::FromFixedPoint {
                register: second >> 11 & 0x1e | first >> 6 & 1,
                unsigned: low & 1 != 0,
                fraction_bits: 32 - (second << 1 & 0x1e | second >> 5 & 1),
            })
        }
        0xf3e if low == 15 && second & 0xf0ff == 0x8014 => {
            Some(Suspect::ReadsControl { register: result })
        }
        0xf38 if second == 0x8814 => Some(Suspect::WritesControl),
        0xf38 => stack(matches!(second, 0x8808 | 0x8809)), // MSR to MSP, PSP
        // ADD, MOV of a register
        0x448..=0x44f | 0x468..=0x46f => stack(first & 0x87 == 0x85 && first >> 3 & 0xf != SP),
        0xea4 | 0xea5 => stack(low == 15 && result == SP),
        0xeb0 | 0xeb1 | 0xeba | 0xebb => stack(low == SP && result == SP),
        // ADD, SUB of a constant
        0xf10 | 0xf11 | 0xf1a | 0xf1b | 0xf50 | 0xf51 | 0xf5a | 0xf5b => {
            stack(low == SP && result == SP && expanded_immediate(first, second) & 3 != 0)
        }
        0xf20 | 0xf2a | 0xf60 | 0xf6a => stack(low == SP && result == SP && second & 3 != 0),
        0xf85 | 0xf8d if target == SP => stack(true), // LDR
        // loads and stores with write-back
        0xf80..=0xf87 | 0xf90..=0xf97 => {
            stack(low == SP && second & 0x900 == 0x900 && second & 3 != 0)
        }
        _ => None,
    }
}

/// ThumbExpandImm (ARMv7-M A5.3.2).
fn expanded_immediate(first: u32, second: u32) -> u32 {
    let (kind, byte) = (first >> 7 & 8 | second >> 12 & 7, second & 0xff);
    match kind {
        0 => byte,
        1 => byte * 0x0001_0001,
        2 => byte * 0x0100_0100,
        3 => byte * 0x0101_0101,
        _ => (byte | 0x80).rotate_right(kind << 1 | byte >> 7),
    }
}

impl Suspect {
    /// What will be wrong behind it, by the state of the CPU before it.
    fn correction<W: Wiring>(self, cpu: &Cpu<'_, W>) -> Option<Correction> {
        /// Two half-words of -32768.
        const LEAST: u32 = 0x8000_8000;
        let read = |n| cpu.reg_read(core_register(n)).map_or(0, |value| value as u32);
        match self {
            Self::DualMultiply { n, m, addend } => {
                let wrong = read(n) == LEAST
                    && read(m) == LEAST
                    && (read(addend) as i32) < 0
                    && get(cpu, Reg::XPSR) & APSR_Q == 0;
                wrong.then_some(Correction::ClearSaturation)
            }
            Self::FromFixedPoint { register, unsigned, fraction_bits } => {
                let context = get(cpu, Reg::CONTROL) & CONTROL_FPCA != 0;
                if !context || get(cpu, Reg::FPSCR) & FPSCR_ROUNDING == 0 {
                    return None;
                }
                let fixed = cpu.reg_read(Reg::S0 as i32 + register as i32).ok()? as u32;
                let nearest = if unsigned { fixed as f32 } else { fixed as i32 as f32 };
                let unit = f32::from_bits((127 - fraction_bits) << 23);
                Some(Correction::Float { register, value: (nearest * unit).to_bits() })
            }
            Self::WritesStackPointer => Some(Correction::AlignStackPointers),
            Self::ReadsControl { register } => Some(Correction::HideSfpa { register }),
            Self::WritesControl => Some(Correction::Control { masks: masks(cpu) }),
        }
    }
}

impl Correction {
    #[cold]
    fn make<W: Wiring>(self, cpu: &mut Cpu<'_, W>) -> Result<(), uc_error> {
        match self {
            Self::ClearSaturation => {
                let flags = get(cpu, Reg::XPSR) & APSR_NZCVQ & !APSR_Q;
                cpu.reg_write(Reg::APSR_NZCVQ, flags.into())
            }
            Self::Float { register, value } => {
                cpu.reg_write(Reg::S0 as i32 + register as i32, value.into())
            }
            Self::AlignStackPointers => {
                for register in [Reg::SP, Reg::MSP, Reg::PSP] {
                    let value = get(cpu, register);
                    if value & 3 != 0 {
                        cpu.reg_write(register, u64::from(value & !3))?;
                    }
                }
                Ok(())
            }
            Self::HideSfpa { register } => {
                let shown = cpu.reg_read(core_register(register))?;
                cpu.reg_write(core_register(register), shown & u64::from(CONTROL_BITS))
            }
            Self::Control { masks } => {
                let control = get(cpu, Reg::CONTROL);
                if control & CONTROL_NPRIV != 0 && get(cpu, Reg::XPSR) & IPSR == 0 {
                    cpu.get_data_mut().unprivileged_masks = Some(masks);
                }
                cpu.reg_write(Reg::CONTROL, u64::from(control | CONTROL_SFPA))
            }
        }
    }
}

/// Whether the instruction that begins with two half-words may need a correction.
pub(crate) fn is_suspect(first: u32, second: u32) -> bool {
    suspect(first, second).is_some()
}

/// Makes the correction that waits, if any.
pub(crate) fn correct<W: Wiring>(cpu: &mut Cpu<'_, W>) {
    if let Some((_, correction)) = cpu.get_data_mut().correction.take()
        && let Err(error) = correction.make(cpu)
    {
        debug_assert!(false, "{error:?}");
    }
}

/// Called before each instruction that is watched, once by each hook that reaches to it.
fn on_instruction<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32) {
    if cpu.get_data().correction.is_some_and(|(at, _)| at == address) {
        return;
    }
    correct(cpu);
    let instruction = half_words(cpu, address).and_then(|(first, second)| suspect(first, second));
    if let Some(correction) = instruction.and_then(|suspect| suspect.correction(cpu)) {
        cpu.get_data_mut().correct_behind(address, correction);
    }
}

fn add_hook<W: Wiring + 'static>(
    cpu: &mut Cpu<'static, W>,
    first: u32,
    last: u32,
) -> Result<(), uc_error> {
    let hook = |cpu: &mut Cpu<'_, W>, address: u64, _: u32| on_instruction(cpu, address as u32);
    cpu.add_code_hook(first.into(), last.into(), hook).map(drop)
}

/// Watches all of the RAM.
pub(crate) fn watch_ram<W: Wiring + 'static>(cpu: &mut Cpu<'static, W>) -> Result<(), uc_error> {
    add_hook(cpu, RAM_BASE, RAM_BASE + RAM_SIZE - 1)
}

/// Watches the instructions of a block that may need a correction, at both addresses of the flash.
pub(crate) fn watch_block<W: Wiring + 'static>(
    cpu: &mut Cpu<'static, W>,
    block: (u32, u32),
) -> Result<(), uc_error> {
    let (offset, bytes) = block;
    let flash = cpu.get_data().flash.clone();
    let code = &flash[offset as usize..(offset + bytes) as usize];
    for (at, _) in cost::instructions(code) {
        let at = offset + at;
        if half_words(cpu, at).is_some_and(|(first, second)| is_suspect(first, second)) {
            for base in [0, FLASH_BASE] {
                add_hook(cpu, base + at, base + at + REACH)?;
            }
        }
    }
    cpu.get_data_mut().watched.insert(block);
    // hooks are part of the translation
    cpu.ctl_flush_tb()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_to_be_corrected_are_recognised() {
        let stack = Some(Suspect::WritesStackPointer);
        let fixed = |register, unsigned, fraction_bits| {
            Some(Suspect::FromFixedPoint { register, unsigned, fraction_bits })
        };
        for (first, second, found) in [
            // smlad r0, r1, r2, r3; smladx r9, r8, r2, r3; smuad r0, r1, r2; smlsd r0, r1, r2, r3
            (0xfb21, 0x3002, Some(Suspect::DualMultiply { n: 1, m: 2, addend: 3 })),
            (0xfb28, 0x3912, Some(Suspect::DualMultiply { n: 8, m: 2, addend: 3 })),
            (0xfb21, 0xf002, None),
            (0xfb41, 0x3002, None),
            // vcvt.f32.s32 s0, s0, #1; vcvt.f32.u32 s1, s1, #17; vcvt.f32.s16 s0, s0, #9; vcvt.s32.f32 s0, s0, #1
            (0xeeba, 0x0aef, fixed(0, false, 1)),
            (0xeefb, 0x0ae7, fixed(1, true, 17)),
            (0xeeba, 0x0a63, None),
            (0xeebe, 0x0aef, None),
            // mrs r5, control; msr control, r5; msr psp, r1; msr basepri, r1
            (0xf3ef, 0x8514, Some(Suspect::ReadsControl { register: 5 })),
            (0xf385, 0x8814, Some(Suspect::WritesControl)),
            (0xf381, 0x8809, stack),
            (0xf381, 0x8811, None),
            // mov sp, r1; add sp, r1; mov r1, sp; add sp, sp; mov.w sp, r4; add.w sp, sp, r1, lsl #1
            (0x468d, 0, stack),
            (0x448d, 0, stack),
            (0x4669, 0, None),
            (0x44ed, 0, None),
            (0xea4f, 0x0d04, stack),
            (0xeb0d, 0x0d41, stack),
            // sub.w sp, sp, #3; sub.w sp, sp, #0x530; addw sp, sp, #0x402; add.w r0, sp, #3
            (0xf1ad, 0x0d03, stack),
            (0xf5ad, 0x6da6, None),
            (0xf20d, 0x4d02, stack),
            (0xf10d, 0x0003, None),
            // ldr.w sp, [r1, #4]; ldr r3, [sp], #4; strb r3, [sp, #-1]!; ldrsh r3, [sp], #2; strb r3, [sp, #1]
            (0xf8d1, 0xd004, stack),
            (0xf85d, 0x3b04, None),
            (0xf80d, 0x3d01, stack),
            (0xf93d, 0x3b02, stack),
            (0xf88d, 0x3001, None),
        ] {
            assert_eq!(suspect(first, second), found, "{first:04x} {second:04x}");
        }
    }
}
