//! Instructions whose address must be aligned, whatever CCR.UNALIGN_TRP (ARMv7-M A3.2.1). The CPU emulation checks those of
//! exclusive accesses only; the others are checked before each instruction of a machine that is asked to.
use super::Wiring;
use super::faults::UNALIGNED;
use super::state::{Cpu, Exit, core_register, refund};

/// The base register, and the bits of it that must be 0; offsets and write-back keep them. `None` where the address is
/// aligned by itself: relative to SP or PC.
fn aligned_base(first: u32, second: u32) -> Option<(u32, u32)> {
    let wide_base = first & 0xf;
    let (base, mask) = match first >> 9 {
        0x60..0x68 => return Some((first >> 8 & 7, 3)), // LDM, STM
        0x74 if first & 0x40 == 0 => (wide_base, 3),    // LDM, STM
        0x74 => match first >> 5 & 0xd {
            0 => (wide_base, 3),                           // LDREX, STREX
            4 if second >> 4 & 0xf == 5 => (wide_base, 1), // LDREXH, STREXH
            4 => return None,                              // table branches, bytes
            _ => (wide_base, 3),                           // LDRD, STRD
        },
        0x76 if first & 0x1e0 != 0x40 && second >> 9 & 7 == 5 => (wide_base, 3), // VLDM, VSTM, VLDR, VSTR
        _ => return None,
    };
    (!matches!(base, 13 | 15)).then_some((base, mask))
}

/// Called before each instruction, which is given in half-words: an access that is not aligned takes the fault before it happens.
/// Inside an IT block, where the CPU emulation does not stop, it takes it after the block.
pub(super) fn check<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32, instruction: (u32, u32)) {
    let Some((base, mask)) = aligned_base(instruction.0, instruction.1) else {
        return;
    };
    if cpu.reg_read(core_register(base)).is_ok_and(|value| value as u32 & mask != 0) {
        let state = cpu.get_data_mut();
        refund(state, address);
        state.raise(UNALIGNED);
        state.exit = Exit::Requested;
        if let Err(error) = cpu.emu_stop() {
            debug_assert!(false, "{error:?}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::aligned_base;

    #[test]
    fn instructions_with_more_than_one_word_have_an_aligned_base() {
        for (first, second, base) in [
            (0xc803, 0, Some((0, 3))),      // ldm r0!, {r0, r1}
            (0xc702, 0, Some((7, 3))),      // stm r7!, {r1}
            (0xe893, 0x0112, Some((3, 3))), // ldm.w r3, {r1, r4, r8}
            (0xe92d, 0x4100, None),         // push.w {r8, lr}
            (0xe9d4, 0x0102, Some((4, 3))), // ldrd r0, r1, [r4, #8]
            (0xe8f4, 0x0102, Some((4, 3))), // ldrd r0, r1, [r4], #8
            (0xe9dd, 0x0102, None),         // ldrd r0, r1, [sp, #8]
            (0xe854, 0x0f01, Some((4, 3))), // ldrex r0, [r4, #4]
            (0xe8d4, 0x0f5f, Some((4, 1))), // ldrexh r0, [r4]
            (0xe8d4, 0x0f4f, None),         // ldrexb r0, [r4]
            (0xe8df, 0xf001, None),         // tbb [pc, r1]
            (0xedd4, 0x0a02, Some((4, 3))), // vldr s1, [r4, #8]
            (0xed9f, 0x0a02, None),         // vldr s0, [pc, #8]
            (0xecb4, 0x0a02, Some((4, 3))), // vldmia r4!, {s0, s1}
            (0xec44, 0x5b13, None),         // vmov d3, r5, r4
            (0xf8d4, 0x0002, None),         // ldr.w r0, [r4, #2]
            (0x6820, 0, None),              // ldr r0, [r4]
        ] {
            assert_eq!(aligned_base(first, second), base, "{first:04x} {second:04x}");
        }
    }
}
