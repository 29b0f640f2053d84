//! Instructions that the CPU emulation executes otherwise than the architecture (ARMv7-M). Hooks stand on the code that holds one of
//! them, and correct behind it what it leaves; other code runs without them.
//!
//! The instruction behind may be one that the condition of an IT block skips, together with its hook. So the hooks reach to the
//! first instruction behind a block of four, and a correction waits for the next instruction that is executed, or the next basic
//! block.
use super::Wiring;
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

fn suspect(first: u32, second: u32) -> Option<Suspect> {
    let register = second >> 8 & 0xf;
    let addend = second >> 12;
    Some(match (first, second) {
        _ if first & 0xfff0 == 0xfb20 && second & 0xe0 == 0 && addend != 15 => {
            Suspect::DualMultiply { n: first & 0xf, m: second & 0xf, addend }
        }
        _ if first & 0xffbe == 0xeeba && second & 0x0fd0 == 0x0ac0 => Suspect::FromFixedPoint {
            register: second >> 11 & 0x1e | first >> 6 & 1,
            unsigned: first & 1 != 0,
            fraction_bits: 32 - (second << 1 & 0x1e | second >> 5 & 1),
        },
        (0xf3ef, _) if second & 0xf0ff == 0x8014 => Suspect::ReadsControl { register },
        (0xf380..0xf390, 0x8814) => Suspect::WritesControl,
        (0xf380..0xf390, 0x8808 | 0x8809) => Suspect::WritesStackPointer,
        _ if may_misalign_stack(first, second) => Suspect::WritesStackPointer,
        _ => return None,
    })
}

/// Whether data processing, a load or a write-back may leave an SP that is not a multiple of 4 as it was before.
fn may_misalign_stack(first: u32, second: u32) -> bool {
    let (base, result) = (first & 0xf, second >> 8 & 0xf);
    match first {
        _ if first & 0xfd87 == 0x4485 => first >> 3 & 0xf != SP, // ADD, MOV of a register
        0xea4f | 0xea5f => result == SP,                         // MOV of a register
        0xeb0d | 0xeb1d | 0xebad | 0xebbd => result == SP,       // ADD, SUB of a register
        0xf10d | 0xf11d | 0xf1ad | 0xf1bd | 0xf50d | 0xf51d | 0xf5ad | 0xf5bd => {
            result == SP && expanded_immediate(first, second) & 3 != 0
        }
        0xf20d | 0xf2ad | 0xf60d | 0xf6ad => result == SP && second & 3 != 0, // ADDW, SUBW
        _ if first & 0xff70 == 0xf850 && second >> 12 == SP => true,          // LDR
        // loads and stores with write-back
        _ if first & 0xfe80 == 0xf800 && base == SP => second & 0x900 == 0x900 && second & 3 != 0,
        _ => false,
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

/// Makes the correction that waits, if any; returns whether there was one.
pub(crate) fn correct<W: Wiring>(cpu: &mut Cpu<'_, W>) -> bool {
    let Some(correction) = cpu.get_data_mut().take_correction() else {
        return false;
    };
    if let Err(error) = correction.make(cpu) {
        debug_assert!(false, "{error:?}");
    }
    true
}

/// Called before each instruction of a range that [`watch`] found.
fn on_instruction<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32) {
    correct(cpu);
    let instruction = half_words(cpu, address).and_then(|(first, second)| suspect(first, second));
    if let Some(correction) = instruction.and_then(|suspect| suspect.correction(cpu)) {
        cpu.get_data_mut().correct_behind(correction);
    }
}

/// First and last offset of each range of code to be watched. Data may look like an instruction; its range is never executed, or
/// finds nothing.
fn watched(code: &[u8]) -> Vec<(u32, u32)> {
    let halves: Vec<_> =
        code.as_chunks().0.iter().map(|half| u32::from(u16::from_le_bytes(*half))).collect();
    let mut ranges: Vec<(u32, u32)> = Vec::new();
    for (n, &first) in halves.iter().enumerate() {
        let second = halves.get(n + 1).copied().unwrap_or_default();
        if suspect(first, second).is_some() {
            let at = 2 * n as u32;
            match ranges.last_mut() {
                Some((_, last)) if *last >= at => *last = at + REACH,
                _ => ranges.push((at, at + REACH)),
            }
        }
    }
    ranges
}

/// Sets the hooks on an image's code, at both of its addresses, and on all of the RAM, whose code is not known before.
pub(crate) fn watch<W: Wiring + 'static>(
    cpu: &mut Cpu<'static, W>,
    flash: &[u8],
) -> Result<(), uc_error> {
    let in_flash = watched(flash)
        .into_iter()
        .flat_map(|(first, last)| [0, FLASH_BASE].map(|base| (base + first, base + last)));
    for (first, last) in in_flash.chain([(RAM_BASE, RAM_BASE + RAM_SIZE - 1)]) {
        cpu.add_code_hook(first.into(), last.into(), |cpu, address, _| {
            on_instruction(cpu, address as u32);
        })?;
    }
    Ok(())
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

    #[test]
    fn watched_ranges_do_not_overlap() {
        let code = |halves: &[u16]| halves.iter().flat_map(|h| h.to_le_bytes()).collect::<Vec<_>>();
        assert_eq!(watched(&code(&[0xbf00; 20])), []);
        let mut halves = [0xbf00; 40];
        (halves[3], halves[11], halves[30]) = (0x468d, 0x468d, 0x468d);
        assert_eq!(watched(&code(&halves)), [(6, 38), (60, 76)]);
    }
}
