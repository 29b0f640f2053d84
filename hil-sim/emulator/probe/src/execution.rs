//! Register contents and flags before a piece of code, executing it on them, and what it leaves: for programs that compare cores.
use core::arch::global_asm;
use core::hint::black_box;

/// Inputs of a piece of code.
pub const INPUTS: u32 = 400;
/// Groups of inputs. Each has its own modes of the floating-point unit and its own check sum.
pub const GROUPS: usize = 4;
/// FPSCR of the groups: AHP (26), DN (25), FZ (24), rounding mode (23:22).
const FPSCR: [[u32; 4]; GROUPS] = [
    [0; 4],
    [0x40_0000, 0x80_0000, 0xc0_0000, 0x40_0000],
    [0x100_0000, 0x140_0000, 0x180_0000, 0x1c0_0000],
    [0x200_0000, 0x300_0000, 0x400_0000, 0x700_0000],
];
/// Number of words of the block of memory, and the word at its middle.
pub const MEMORY: usize = 64;
const MIDDLE: usize = 24;

/// The block of memory that the code accesses, far below the stack: at an address that does not depend on what the compiler places elsewhere,
/// because the check sums contain addresses in it.
const BLOCK: usize = 0x2000_1000;

/// Registers before the code, in the order in which `run_form` loads them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Before {
    float: [u32; 32],
    fpscr: u32,
    apsr: u32,
    pub code: u32,
    core: [u32; 13],
    lr: u32,
}

/// Registers after it, in the order in which `run_form` stores them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct After {
    float: [u32; 32],
    apsr: u32,
    fpscr: u32,
    core: [u32; 13],
    lr: u32,
}

global_asm!(
    ".fpu fpv4-sp-d16",
    ".section .text.run_form, \"ax\", %progbits",
    ".global run_form",
    ".thumb_func",
    "run_form:",
    "push {{r4-r11, lr}}",
    "vpush {{s16-s31}}",
    "push {{r1}}",
    "vldmia r0!, {{s0-s31}}",
    "ldmia r0!, {{r1, r2, r3}}",
    "vmsr fpscr, r1",
    "push {{r3}}",
    "msr apsr_nzcvqg, r2",
    "ldm.w r0, {{r0-r12, lr}}",
    "ldr pc, [sp], #4",
    ".global form_done",
    ".thumb_func",
    "form_done:",
    "stmdb sp!, {{r0-r12, lr}}",
    "mrs r0, apsr",
    "vmrs r1, fpscr",
    "ldr r2, [sp, #56]",
    "vstmia r2!, {{s0-s31}}",
    "stmia r2!, {{r0, r1}}",
    "ldmia sp!, {{r3-r9}}",
    "stmia r2!, {{r3-r9}}",
    "ldmia sp!, {{r3-r9}}",
    "stmia r2!, {{r3-r9}}",
    "add sp, #4",
    "movs r0, #0",
    "vmsr fpscr, r0",
    "vpop {{s16-s31}}",
    "pop {{r4-r11, pc}}",
);

/// Executes the code of the first and keeps what it leaves in the second.
pub type Run = unsafe extern "C" fn(*const Before, *mut After);

/// Marsaglia's xorshift generator.
pub struct Random(pub u32);

impl Random {
    pub fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    /// Operand of integer instructions: half of them at the ends of a range.
    pub fn integer(&mut self) -> u32 {
        const EDGES: [u32; 32] = [
            0,
            1,
            2,
            3,
            0x1f,
            0x20,
            0x7f,
            0x80,
            0xff,
            0x100,
            0x7fff,
            0x8000,
            0xffff,
            0x1_0000,
            0x7f_ffff,
            0x80_0000,
            0x8000_7fff,
            0x7fff_8000,
            0x7fff_ffff,
            0x8000_0000,
            0x8000_0001,
            0xc000_0000,
            0x4000_0000,
            0xffff_8000,
            0xffff_0000,
            0xffff_ff80,
            0xffff_fffe,
            0xffff_ffff,
            0x8000_8000,
            0x7fff_7fff,
            0x8080_8080,
            0x7f7f_7f7f,
        ];
        let word = self.next();
        match word >> 30 {
            0 | 1 => EDGES[(word & 31) as usize],
            2 => self.next() & 0x3f,
            _ => self.next(),
        }
    }

    /// Operand of floating-point instructions: special values, values of similar size, any pattern.
    pub fn float(&mut self) -> u32 {
        const EDGES: [u32; 32] = [
            0,
            0x0000_0001, // the least subnormal number
            0x0000_0003,
            0x0040_0000,
            0x007f_ffff, // the largest
            0x0080_0000,
            0x00ff_ffff,
            0x2000_0000, // the product of two of these is subnormal
            0x3300_0000, // 2^-25: with half precision, half of the least subnormal number
            0x387f_e000, // half precision: the largest subnormal number and a half
            0x3880_0000, // 2^-14: half precision's least normal number
            0x3eff_ffff,
            0x3f00_0000,
            0x3f7f_ffff,
            0x3f80_0000, // 1
            0x3f80_0001,
            0x3fc0_0000,
            0x4020_0000, // 2.5
            0x4b00_0000, // 2^23
            0x4b7f_ffff,
            0x4eff_ffff,
            0x4f00_0000, // 2^31
            0x4f7f_ffff,
            0x4f80_0000, // 2^32
            0x477f_e000, // the largest of half precision
            0x477f_f000, // rounds to half precision's infinity
            0x7f7f_ffff,
            0x7f80_0000, // infinity
            0x7f80_0001, // a signalling NaN
            0x7fbf_ffff, // another
            0x7fc0_1234, // a quiet NaN
            0x7fff_ffff, // another
        ];
        let word = self.next();
        let sign = word << 31;
        match word >> 30 {
            0 | 1 => sign | EDGES[(word >> 1 & 31) as usize],
            2 => sign | (0x3c00_0000 + (self.next() & 0x07ff_ffff)),
            _ => self.next(),
        }
    }
}

/// Input number `input`, without the address of the code.
pub fn input(input: u32) -> Before {
    let mut random = Random(0x9e37_79b9 ^ (input + 1).wrapping_mul(0x0100_0193));
    let mut before = Before { float: [0; 32], fpscr: 0, apsr: 0, code: 0, core: [0; 13], lr: 0 };
    for _ in 0..4 {
        random.next();
    }
    for register in &mut before.core {
        *register = random.integer();
    }
    for register in &mut before.float {
        *register = random.float();
    }
    // equal operands, every other time two or four extreme parts of a word
    const PARTS: [u32; 4] = [0x8000_8000, 0x7fff_7fff, 0x8080_8080, 0x7f7f_7f7f];
    match input % 6 {
        1 => before.core[2] = before.core[1],
        4 => before.core[1..3].fill(PARTS[input as usize / 6 % 4]),
        _ => {}
    }
    let (group, turn) = (input as usize / (INPUTS as usize / GROUPS), input as usize % 4);
    before.fpscr = FPSCR[group][turn] | random.next() & 0xf000_009f;
    before.apsr = random.next() & 0xf80f_0000;
    before.lr = random.next();
    let middle = BLOCK as u32 + 4 * MIDDLE as u32;
    before.core[6] = random.next() % 29;
    before.core[7] = middle;
    before.core[10] = middle + input % 4;
    before.core[11] = random.next() % 29;
    before
}

/// `before` in the order of [`After`].
pub fn unchanged(before: &Before) -> After {
    After {
        float: before.float,
        apsr: before.apsr,
        fpscr: before.fpscr,
        core: before.core,
        lr: before.lr,
    }
}

pub fn words(after: &After) -> &[u32; 48] {
    // SAFETY: 48 words without padding.
    unsafe { &*core::ptr::from_ref(after).cast() }
}

/// Words of the block of memory before input number `number`.
pub fn contents(number: u32) -> [u32; MEMORY] {
    let mut random = Random(0x6d2b_79f5 ^ number);
    core::array::from_fn(|_| random.float())
}

/// Executes the code of `before` by `run` with `contents` in the block of memory, and returns what it leaves in registers and there.
///
/// # Safety
/// `run` is `run_form` above, or ends with it. The code ends with a branch to `form_done`, and changes only registers, and the block.
pub unsafe fn execute(
    run: Run,
    before: &Before,
    contents: &[u32; MEMORY],
) -> (After, &'static [u32]) {
    let block = BLOCK as *mut u32;
    let mut after = unchanged(before);
    // SAFETY: nothing else is at the block's addresses, and `run` saves the registers.
    unsafe {
        core::ptr::copy_nonoverlapping(contents.as_ptr(), block, MEMORY);
        run(black_box(before), black_box(&mut after));
        (after, core::slice::from_raw_parts(block, MEMORY))
    }
}

/// FNV-1a over words.
pub fn add_to_sum(sum: &mut u32, word: u32) {
    *sum = (*sum ^ word).wrapping_mul(0x0100_0193);
}
pub const EMPTY_SUM: u32 = 0x811c_9dc5;
