//! What an instruction of the Cortex-M4 takes by itself, and how it waits for the one before it (Technical Reference Manual r0p1,
//! tables 3-1 and 7-1, and the notes on load and store timings in section 3.3.2).

/// Refill of the pipeline after a taken branch whose target is known early, and after a load of the program counter (TRM: 1 to
/// 3; at least 5 cycles for such a load, 6 for a table branch).
const REFILL: u8 = 2;
const REFILL_AFTER_LOAD: u8 = 3;
/// A division, 2 to 12 cycles by its operands.
const DIVISION: u16 = 7;
/// VDIV and VSQRT take this beside their own cycle, during which integer instructions go on.
const FLOAT_DIVISION: u16 = 13;

const SP: u32 = 13;
const PC: u32 = 15;

/// Access to memory, as far as the next access depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Memory {
    #[default]
    None,
    /// A single load; the next load or store goes through the pipeline behind it.
    Load,
    /// A single store with an immediate offset: one cycle, then the write buffer.
    Store,
    /// A single store with a register offset: two cycles, unless behind a load.
    StoreByRegister,
}

/// Use of the floating-point unit; the numbers are those of single registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Float {
    #[default]
    None,
    /// Moves, loads and stores; reads these registers, as a mask.
    Move(u32),
    /// Arithmetic: result, and the registers that it reads, as a mask.
    Arithmetic(u8, u32),
    /// VDIV, VSQRT.
    Division(u8, u32),
}

/// An instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Instruction {
    pub bytes: usize,
    /// First half-word.
    pub code: u32,
    /// Cycles by itself, without the refill after a branch.
    pub cycles: u16,
    pub refill: u8,
    pub memory: Memory,
    /// Core registers from which the address of the access is made, as a mask.
    pub address: u16,
    /// Core registers that a single load or data processing writes, as a mask.
    pub result: u16,
    pub float: Float,
    /// Distance of a constant beside the code, which it loads, from its address rounded down to a word.
    pub constant: Option<i32>,
}

/// Mask of the register in the lowest four bits.
fn bit(register: u32) -> u16 {
    1 << (register & 15)
}

impl Instruction {
    /// The first instruction of some code.
    pub fn decode(code: &[u8]) -> Option<Self> {
        let half = |at: usize| {
            let bytes = code.get(at..at + 2).map(<[u8; 2]>::try_from)?.ok()?;
            Some(u32::from(u16::from_le_bytes(bytes)))
        };
        let first = half(0)?;
        let wide = first >> 11 >= 0b11101;
        let plain =
            Self { bytes: if wide { 4 } else { 2 }, code: first, cycles: 1, ..Self::default() };
        Some(match wide {
            false => plain.narrow(first),
            true if first & 0xec00 == 0xec00 => plain.float(first, half(2)?),
            true => plain.wide(first, half(2)?),
        })
    }

    fn taking(self, cycles: u16) -> Self {
        Self { cycles, ..self }
    }

    fn branch(self) -> Self {
        Self { refill: REFILL, ..self }
    }

    fn single(self, load: bool, by_register: bool, register: u32, address: u16) -> Self {
        let memory = match (load, by_register) {
            (true, _) => Memory::Load,
            (false, false) => Memory::Store,
            (false, true) => Memory::StoreByRegister,
        };
        Self {
            cycles: if memory == Memory::Store { 1 } else { 2 },
            memory,
            address,
            result: if load { bit(register) } else { 0 },
            ..self
        }
    }

    /// Data processing.
    fn writing(self, register: u32) -> Self {
        Self { result: bit(register), ..self }
    }

    /// Several words from or to the address in a register.
    fn multiple(self, base: u32, words: u16) -> Self {
        Self { cycles: 1 + words, address: bit(base), ..self }
    }

    /// A load relative to the program counter, which is four bytes ahead.
    fn of_constant(self, distance: u32, ahead: bool) -> Self {
        let distance = if ahead { distance as i32 } else { -(distance as i32) };
        Self { constant: Some(4 + distance), ..self }
    }

    /// Load of the program counter, alone or among others.
    fn load_of_pc(self, base: u32, cycles: u16) -> Self {
        Self { cycles, address: bit(base), refill: REFILL_AFTER_LOAD, ..self }
    }

    fn narrow(self, op: u32) -> Self {
        let registers = (op & 0xff).count_ones() as u16;
        let (low, base) = (op & 7, bit(op >> 3 & 7));
        match op >> 12 {
            0x0 | 0x1 => self.writing(low),             // shifts, ADD, SUB
            0x2 | 0x3 if op & 0x1800 == 0x0800 => self, // CMP
            0x2 | 0x3 => self.writing(op >> 8 & 7),
            0x4 if op & 0xff00 == 0x4700 => self.branch(), // BX, BLX
            0x4 if op & 0xfc87 == 0x4487 => self.branch(), // ADD or MOV to PC
            0x4 if op & 0xfd00 == 0x4400 => self.writing(low | op >> 4 & 8), // ADD, MOV
            0x4 if op & 0xfc00 == 0x4000 && !matches!(op >> 6 & 0xf, 8 | 10 | 11) => {
                self.writing(low)
            }
            0x4 if op & 0xf800 == 0x4800 => {
                let load = self.single(true, false, op >> 8 & 7, 0);
                load.of_constant(4 * (op & 0xff), true)
            }
            0x4 => self, // TST, CMP, CMN
            0x5 => self.single(op & 0x0e00 >= 0x0600, true, low, base | bit(op >> 6 & 7)),
            0x6..=0x8 => self.single(op & 0x0800 != 0, false, low, base),
            0x9 => self.single(op & 0x0800 != 0, false, op >> 8 & 7, bit(SP)),
            0xa => self.writing(op >> 8 & 7),
            0xb if op & 0xff00 == 0xb000 => self.writing(SP),
            0xb if op & 0xfe00 == 0xb400 => self.multiple(SP, registers + (op >> 8 & 1) as u16),
            0xb if op & 0xff00 == 0xbd00 => self.load_of_pc(SP, 2 + registers),
            0xb if op & 0xff00 == 0xbc00 => self.multiple(SP, registers),
            0xb if op & 0xf500 == 0xb100 => self.branch(), // CBZ, CBNZ
            0xb if matches!(op >> 8, 0xb2 | 0xba) => self.writing(low),
            0xc => self.multiple(op >> 8 & 7, registers), // LDM, STM
            0xd | 0xe => self.branch(),
            _ => self,
        }
    }

    fn wide(self, first: u32, second: u32) -> Self {
        let registers = second.count_ones() as u16;
        let load = first & 0x10 != 0;
        let (base, target) = (bit(first), second >> 12);
        match first >> 11 & 3 {
            1 if first & 0x0640 == 0 && load && second >> 15 == 1 => {
                self.load_of_pc(first, 1 + registers)
            }
            1 if first & 0x0640 == 0 => self.multiple(first, registers), // LDM, STM
            1 if first & 0x0600 == 0 => self.dual_or_exclusive(first, second),
            1 => self.writing(second >> 8), // data processing, shifted register
            2 if second & 0x8000 == 0 => self.writing(second >> 8), // data processing, immediate
            2 if second & 0x5000 == 0 && first & 0x0380 == 0x0380 => self, // MSR, MRS, hints
            2 => self.branch(),
            3 if first & 0x0600 == 0 => {
                let by_register = first & 0x80 == 0 && second & 0x0fc0 == 0 && first & 0xf != PC;
                let offset = if by_register { bit(second) } else { 0 };
                let base = if first & 0xf == PC { 0 } else { base };
                let mut access = self.single(load, by_register, target, base | offset);
                if load && first & 0xf == PC {
                    access = access.of_constant(second & 0xfff, first & 0x80 != 0);
                }
                if load && target == PC && first & 0x60 == 0x40 {
                    self.load_of_pc(first, 2)
                } else {
                    access
                }
            }
            3 if first & 0xffd0 == 0xfb90 => self.writing(second >> 8).taking(DIVISION),
            3 if first & 0xff80 == 0xfb80 => Self {
                result: bit(second >> 8) | bit(target), // long multiplication
                ..self
            },
            _ => self.writing(second >> 8), // data processing in registers, multiplication
        }
    }

    /// LDRD, STRD, table branches, and exclusive accesses, which go through the pipeline as loads do.
    fn dual_or_exclusive(self, first: u32, second: u32) -> Self {
        let table = first & 0xfff0 == 0xe8d0 && second & 0xffe0 == 0xf000;
        let word = first & 0xffe0 == 0xe840;
        let part = first & 0xffe0 == 0xe8c0 && matches!(second >> 4 & 0xf, 4 | 5);
        if table {
            self.load_of_pc(first, 3)
        } else if word || part {
            let result = if first & 0x10 != 0 { second >> 12 } else { second };
            self.single(true, false, result, bit(first))
        } else {
            self.multiple(first, 2)
        }
    }

    /// The floating-point unit has coprocessor numbers 10 and 11.
    fn float(self, first: u32, second: u32) -> Self {
        let d = (second >> 11 & 0x1e | first >> 6 & 1) as u8;
        let n = 1 << (first << 1 & 0x1e | second >> 7 & 1);
        let m = 1 << (second << 1 & 0x1e | second >> 5 & 1);
        let as_move = |reads: u32| Self { float: Float::Move(reads), ..self };
        if first & 0x0fe0 == 0x0c40 {
            return as_move(m | m << 1).taking(2); // VMOV of two registers
        }
        if first & 0x0e00 == 0x0c00 {
            let load = first & 0x10 != 0;
            let words = (second & 0xff) as u16;
            let double = second & 0x100 != 0;
            return if first & 0x0120 == 0x0100 && !double {
                // VLDR, VSTR of one word
                let base = if first & 0xf == PC { 0 } else { bit(first) };
                let access = as_move(if load { 0 } else { 1 << d });
                let access = Self {
                    cycles: 2,
                    memory: if load { Memory::Load } else { Memory::None },
                    address: base,
                    ..access
                };
                if base == 0 {
                    access.of_constant(4 * (second & 0xff), first & 0x80 != 0)
                } else {
                    access
                }
            } else if first & 0x0120 == 0x0100 {
                as_move(0).multiple(first, 2)
            } else {
                as_move(0).multiple(first, words) // VLDM, VSTM, VPUSH, VPOP
            };
        }
        if second & 0x10 != 0 {
            return as_move(n);
        }
        let arithmetic = |cycles: u16, float: Float| Self { cycles, float, ..self };
        match first >> 4 & 0xb {
            0x8 => arithmetic(1, Float::Division(d, n | m)),
            0xb if second & 0xc0 == 0xc0 && first & 0xf == 1 => {
                arithmetic(1, Float::Division(d, m))
            }
            // VMLA, VFMA and the like take their addend a cycle later
            0x0 | 0x1 | 0x9 | 0xa => arithmetic(3, Float::Arithmetic(d, n | m)),
            0xb if second & 0x40 != 0 => arithmetic(1, Float::Arithmetic(d, m)),
            0xb => arithmetic(1, Float::Arithmetic(d, 0)), // VMOV of a constant
            _ => arithmetic(1, Float::Arithmetic(d, n | m)),
        }
    }
}

/// What the instructions before leave for the next.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pipeline {
    before: Instruction,
    /// Cycles that a division of the floating-point unit still takes.
    pub division: u16,
}

impl Pipeline {
    /// Cycles of the next instruction.
    pub fn cycles(&mut self, next: &Instruction) -> u16 {
        let before = std::mem::replace(&mut self.before, *next);
        let depends = before.result & next.address != 0;
        let overlapped = before.memory == Memory::Load
            && !depends
            && matches!(next.memory, Memory::Load | Memory::StoreByRegister);
        // the result of data processing is in the registers a cycle too late for the next address
        let late = before.memory == Memory::None && depends;
        let mut cycles = next.cycles + u16::from(late) - u16::from(overlapped);
        let reads = match next.float {
            Float::None => {
                self.division = self.division.saturating_sub(cycles);
                return cycles;
            }
            Float::Move(reads) | Float::Arithmetic(_, reads) | Float::Division(_, reads) => reads,
        };
        cycles += std::mem::take(&mut self.division);
        if let Float::Arithmetic(result, _) = before.float
            && reads >> result & 1 != 0
        {
            cycles += 1;
        }
        if let Float::Division(..) = next.float {
            self.division = FLOAT_DIVISION;
        }
        cycles
    }
}
