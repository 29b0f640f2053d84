//! Effects of Armv7E-M instructions on control flow, stack pointer and floating-point registers.
//!
//! Encodings are those of the Armv7-M Architecture Reference Manual (DDI 0403E), chapter A5 and section A7.7. An
//! instruction without such an effect is [`Effect::Next`]; one that changes the stack pointer by an amount that it does
//! not contain is [`Effect::StackUnknown`].

/// An instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// Length, bytes: 2 or 4.
    pub length: u32,
    /// Effect.
    pub effect: Effect,
    /// Whether it is floating-point arithmetic; loads, stores and moves are not.
    pub float: bool,
    /// Whether it is an exclusive store, which fails if an exception has come since its load.
    pub exclusive: bool,
}

/// Effect of an instruction on control flow and stack pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// None.
    Next,
    /// The stack grows by this number of bytes; it shrinks if negative.
    Stack(i32),
    /// The stack pointer takes an unknown value.
    StackUnknown,
    /// Jump.
    Jump(u32),
    /// Conditional jump.
    Branch(u32),
    /// Call.
    Call(u32),
    /// Call through a register.
    CallRegister,
    /// Jump through a register, other than a return.
    JumpRegister,
    /// Jump by a table of offsets behind the instruction.
    Table {
        /// Bytes of an entry, 1 or 2.
        entry: u32,
    },
    /// Return, which takes this number of bytes off the stack.
    Return(i32),
    /// The next instructions depend on conditions: for each, in order, whether it runs if the first does.
    IfThen {
        /// One bit for each instruction, the first in bit 0.
        same: u8,
        /// Number of instructions, 1 to 4.
        count: u8,
    },
    /// Permanently undefined: causes a fault.
    Undefined,
}

const SP: u32 = 13;
const LR: u32 = 14;
const PC: u32 = 15;

/// Decodes the instruction at `address`; `second` is the halfword after the first.
pub fn decode(address: u32, first: u16, second: u16) -> Instruction {
    let (first, second) = (u32::from(first), u32::from(second));
    let wide = first >> 11 >= 0b11101;
    let effect =
        if wide { wide_effect(address, first, second) } else { narrow_effect(address, first) };
    Instruction {
        length: if wide { 4 } else { 2 },
        effect,
        float: wide && calculates(first, second),
        // STREX, STREXB, STREXH.
        exclusive: first & 0xfff0 == 0xe840
            || first & 0xfff0 == 0xe8c0 && matches!(second & 0xff0, 0xf40 | 0xf50),
    }
}

/// The low `bits` of `value` as a signed number.
fn signed(value: u32, bits: u32) -> i32 {
    ((value << (32 - bits)) as i32) >> (32 - bits)
}

fn to(address: u32, offset: i32) -> u32 {
    address.wrapping_add(4).wrapping_add_signed(offset)
}

/// Bytes of the registers in a list.
fn bytes(list: u32) -> i32 {
    4 * list.count_ones() as i32
}

fn narrow_effect(address: u32, first: u32) -> Effect {
    let low = first & 0xff;
    match first >> 8 {
        0x44 | 0x46 => match (first >> 4 & 8) | (first & 7) {
            SP => Effect::StackUnknown,
            PC => Effect::JumpRegister,
            _ => Effect::Next,
        },
        0x47 if first & 0x80 != 0 => Effect::CallRegister,
        0x47 if first >> 3 & 0xf == LR => Effect::Return(0),
        0x47 => Effect::JumpRegister,
        0xb0 if first & 0x80 == 0 => Effect::Stack(-(4 * (first & 0x7f) as i32)),
        0xb0 => Effect::Stack(4 * (first & 0x7f) as i32),
        0xb1 | 0xb3 | 0xb9 | 0xbb => {
            let offset = (first >> 3 & 0x40) | (first >> 2 & 0x3e);
            Effect::Branch(to(address, offset as i32))
        }
        0xb4 | 0xb5 => Effect::Stack(bytes(first & 0x1ff)),
        0xbc => Effect::Stack(-bytes(low)),
        0xbd => Effect::Return(bytes(first & 0x1ff)),
        0xbf if low & 0xf != 0 => if_then(low),
        0xde => Effect::Undefined,
        0xd0..=0xdd => Effect::Branch(to(address, signed(low << 1, 9))),
        0xe0..=0xe7 => Effect::Jump(to(address, signed((first & 0x7ff) << 1, 12))),
        _ => Effect::Next,
    }
}

/// The lowest set bit of the mask ends the block; above it, a bit like the condition's lowest is "then".
fn if_then(low: u32) -> Effect {
    let (condition, mask) = (low >> 4 & 1, low & 0xf);
    let count = 4 - mask.trailing_zeros();
    let mut same = 1;
    for place in 1..count {
        if mask >> (4 - place) & 1 == condition {
            same |= 1 << place;
        }
    }
    Effect::IfThen { same, count: count as u8 }
}

fn wide_effect(address: u32, first: u32, second: u32) -> Effect {
    let (base, target) = (first & 0xf, second >> 8 & 0xf);
    match first >> 8 {
        0xf0..=0xf7 if second & 0x8000 != 0 => branch(address, first, second),
        // Data processing with an immediate.
        0xf0..=0xf7 if target == SP => match (first & 0x0be0, base) {
            (0x0100, SP) => Effect::Stack(-expanded(first, second)),
            (0x01a0, SP) => Effect::Stack(expanded(first, second)),
            (0x0200, SP) => Effect::Stack(-plain(first, second)),
            (0x02a0, SP) => Effect::Stack(plain(first, second)),
            _ => Effect::StackUnknown,
        },
        0xea | 0xeb if target == SP => Effect::StackUnknown,
        0xe8 | 0xe9 if first & 0x40 != 0 => double_or_table(first, second),
        0xe8 | 0xe9 => multiple(first, second),
        0xf8 | 0xf9 => single(first, second),
        // Several floating-point registers: imm8 words, addressed by the stack pointer with write-back.
        0xec | 0xed if base == SP && first & 0x20 != 0 => match first & 0x1b0 {
            0x120 => Effect::Stack(4 * (second & 0xff) as i32),
            0x0b0 => Effect::Stack(-(4 * (second & 0xff) as i32)),
            _ => Effect::StackUnknown,
        },
        _ => Effect::Next,
    }
}

fn branch(address: u32, first: u32, second: u32) -> Effect {
    let (s, j1, j2) = (first >> 10 & 1, second >> 13 & 1, second >> 11 & 1);
    let low = (second & 0x7ff) << 1;
    let far = || {
        let (i1, i2) = (1 ^ j1 ^ s, 1 ^ j2 ^ s);
        let offset = s << 24 | i1 << 23 | i2 << 22 | (first & 0x3ff) << 12 | low;
        to(address, signed(offset, 25))
    };
    match second & 0x5000 {
        0x5000 => Effect::Call(far()),
        0x1000 => Effect::Jump(far()),
        0x4000 => Effect::Undefined,
        // The encodings of the condition "always" are barriers, hints and special registers.
        _ if first & 0x380 == 0x380 => match (first & 0x7f0, second & 0x7000) {
            (0x7f0, 0x2000) => Effect::Undefined,
            _ => Effect::Next,
        },
        _ => {
            let offset = s << 20 | j2 << 19 | j1 << 18 | (first & 0x3f) << 12 | low;
            Effect::Branch(to(address, signed(offset, 21)))
        }
    }
}

/// Section A5.3.2: a byte, repeated or rotated.
fn expanded(first: u32, second: u32) -> i32 {
    let bits = (first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xff;
    let byte = bits & 0xff;
    let value = match bits >> 8 {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte * 0x0101_0101,
        _ => (0x80 | bits & 0x7f).rotate_right(bits >> 7),
    };
    value as i32
}

fn plain(first: u32, second: u32) -> i32 {
    ((first >> 10 & 1) << 11 | (second >> 12 & 7) << 8 | second & 0xff) as i32
}

/// Two registers at once, exclusive access, or a jump by a table.
fn double_or_table(first: u32, second: u32) -> Effect {
    let (before, up, write) = (first & 0x100 != 0, first & 0x80 != 0, first & 0x20 != 0);
    if first & 0xff0 == 0x8d0 && second & 0xffe0 == 0xf000 {
        return Effect::Table { entry: 1 + (second >> 4 & 1) };
    }
    let offset = 4 * (second & 0xff) as i32;
    match first & 0xf {
        SP if write && (before || up) => Effect::Stack(if up { -offset } else { offset }),
        SP if write => Effect::Stack(offset),
        _ => Effect::Next,
    }
}

/// Several registers at once.
fn multiple(first: u32, second: u32) -> Effect {
    let (load, write, base) = (first & 0x10 != 0, first & 0x20 != 0, first & 0xf);
    match (first & 0xff0, base) {
        (0x920, SP) => Effect::Stack(bytes(second)),
        (0x8b0, SP) if second & 0x8000 != 0 => Effect::Return(bytes(second)),
        (0x8b0, SP) => Effect::Stack(-bytes(second)),
        (_, SP) if write => Effect::StackUnknown,
        _ if load && second & 0x8000 != 0 => Effect::JumpRegister,
        _ => Effect::Next,
    }
}

/// One register, a byte, halfword or word.
fn single(first: u32, second: u32) -> Effect {
    let (base, register) = (first & 0xf, second >> 12);
    // Bit 7 of the first halfword: a 12-bit offset; bits 11 and 8 of the second: an 8-bit one, and write-back.
    let writes_back = first & 0x80 == 0 && base != PC && second & 0x900 == 0x900;
    let offset = (second & 0xff) as i32;
    let grown = if second & 0x200 != 0 { -offset } else { offset };
    let loads_word = first & 0x170 == 0x050;
    match (base, register) {
        (SP, PC) if loads_word && writes_back => Effect::Return(-grown),
        (_, PC) if loads_word => Effect::JumpRegister,
        (_, SP) if loads_word => Effect::StackUnknown,
        (SP, _) if writes_back => Effect::Stack(grown),
        _ => Effect::Next,
    }
}

/// Section A6.4: data processing of coprocessors 10 and 11, except moves between their registers and of constants.
fn calculates(first: u32, second: u32) -> bool {
    if first & 0xef00 != 0xee00 || second & 0x0e00 != 0x0a00 || second & 0x10 != 0 {
        return false;
    }
    let other = first & 0xb0 == 0xb0;
    let constant = other && second & 0x40 == 0;
    let between_registers = other && first & 0xf == 0 && second & 0xc0 == 0x40;
    first & 0x1000 != 0 || !(constant || between_registers)
}

#[cfg(test)]
mod tests;
