//! Executes each form of `forms.s` on [`INPUTS`] inputs and keeps check sums of all registers, flags and a block of memory.
//! The program uses nothing but CPU and memory, so any Cortex-M4 with flash at 0x08000000 and this RAM can run it.
#![no_std]
#![no_main]

use core::arch::global_asm;
use core::hint::black_box;
use cortex_m_rt::entry;

#[path = "../../sleep_on_panic.rs"]
mod sleep_on_panic;

/// Inputs of a form.
const INPUTS: u32 = 400;
/// Groups of inputs. Each has its own modes of the floating-point unit and its own check sum.
const GROUPS: usize = 4;
/// FPSCR of the groups: AHP (26), DN (25), FZ (24), rounding mode (23:22).
const FPSCR: [[u32; 4]; GROUPS] = [
    [0; 4],
    [0x40_0000, 0x80_0000, 0xc0_0000, 0x40_0000],
    [0x100_0000, 0x140_0000, 0x180_0000, 0x1c0_0000],
    [0x200_0000, 0x300_0000, 0x400_0000, 0x700_0000],
];
/// Number of words of the block of memory, and the word at its middle.
const MEMORY: usize = 64;
const MIDDLE: usize = 24;
/// Room for results.
const FORMS: usize = 800;

/// Registers before a form, in the order in which `run_form` loads them.
#[repr(C)]
#[derive(Clone, Copy)]
struct Before {
    float: [u32; 32],
    fpscr: u32,
    apsr: u32,
    code: u32,
    core: [u32; 13],
    lr: u32,
}

/// Registers after it, in the order in which `run_form` stores them.
#[repr(C)]
#[derive(Clone, Copy)]
struct After {
    float: [u32; 32],
    apsr: u32,
    fpscr: u32,
    core: [u32; 13],
    lr: u32,
}

/// Results of a form: the check sum of each group, and of one input the first changed words: their positions in
/// [`After`] and values; position 255 is none.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Answer {
    sums: [u32; GROUPS],
    positions: [u8; 4],
    values: [u32; 4],
}

/// Results of all forms.
#[unsafe(no_mangle)]
pub static mut ANSWERS: [Answer; FORMS] =
    [Answer { sums: [0x811c_9dc5; GROUPS], positions: [255; 4], values: [0; 4] }; FORMS];

/// Number of forms, once all have run.
#[unsafe(no_mangle)]
pub static mut FORMS_RUN: u32 = 0;

/// The block of memory that the forms access, far below the stack: at this address whatever the compiler places elsewhere,
/// because the check sums contain addresses in it.
const BLOCK: usize = 0x2000_1000;

global_asm!(include_str!("forms.s"), options(raw));
global_asm!(
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

unsafe extern "C" {
    fn run_form(before: *const Before, after: *mut After);
    /// Address of code and name of each form; ends with zeros.
    #[link_name = "FORMS"]
    static TABLE: [u32; 2];
}

/// Marsaglia's xorshift generator.
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    /// Operand of integer instructions: half of them at the ends of a range.
    fn integer(&mut self) -> u32 {
        const EDGES: [u32; 16] = [
            0,
            1,
            2,
            0x7f,
            0x80,
            0xff,
            0x7fff,
            0x8000,
            0xffff,
            0x8000_7fff,
            0x7fff_8000,
            0x7fff_ffff,
            0x8000_0000,
            0x8000_0001,
            0xffff_fffe,
            0xffff_ffff,
        ];
        let word = self.next();
        match word >> 30 {
            0 | 1 => EDGES[(word & 15) as usize],
            2 => self.next() & 0x3f,
            _ => self.next(),
        }
    }

    /// Operand of floating-point instructions: special values, values of similar size, any pattern.
    fn float(&mut self) -> u32 {
        const EDGES: [u32; 16] = [
            0,
            0x0000_0001, // the least subnormal number
            0x007f_ffff, // the largest
            0x0080_0000,
            0x3f7f_ffff,
            0x3f80_0000, // 1
            0x3fc0_0000,
            0x4b00_0000, // 2^23
            0x4eff_ffff,
            0x4f00_0000, // 2^31
            0x4f80_0000, // 2^32
            0x477f_e000, // the largest of half precision
            0x7f7f_ffff,
            0x7f80_0000, // infinity
            0x7f80_0001, // a signalling NaN
            0x7fc0_1234, // a quiet NaN
        ];
        let word = self.next();
        let sign = word << 31;
        match word >> 30 {
            0 | 1 => sign | EDGES[(word >> 1 & 15) as usize],
            2 => sign | (0x3c00_0000 + (self.next() & 0x07ff_ffff)),
            _ => self.next(),
        }
    }
}

/// Input number `input` of every form.
fn input(input: u32) -> Before {
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
fn unchanged(before: &Before) -> After {
    After {
        float: before.float,
        apsr: before.apsr,
        fpscr: before.fpscr,
        core: before.core,
        lr: before.lr,
    }
}

fn words(after: &After) -> &[u32; 48] {
    // SAFETY: 48 words without padding.
    unsafe { &*core::ptr::from_ref(after).cast() }
}

/// Executes a form on input number `number`, and adds the result to its answer.
fn execute(form: usize, number: u32, before: &Before, contents: &[u32; MEMORY]) {
    let (answer, block) = (&raw mut ANSWERS, BLOCK as *mut u32);
    let mut after = unchanged(before);
    // SAFETY: nothing else is at the block's addresses, the number of forms is checked, and a form changes only registers that
    // `run_form` saves, and the block.
    let (answer, memory) = unsafe {
        core::ptr::copy_nonoverlapping(contents.as_ptr(), block, MEMORY);
        run_form(black_box(before), black_box(&mut after));
        (&mut (*answer)[form], core::slice::from_raw_parts(block, MEMORY))
    };
    let sum = &mut answer.sums[(number / (INPUTS / GROUPS as u32)) as usize];
    for word in words(&after).iter().chain(memory) {
        *sum = (*sum ^ word).wrapping_mul(0x0100_0193); // FNV-1a over words
    }
    if number == 0 {
        let was = unchanged(before);
        let changed = words(&was).iter().zip(words(&after)).enumerate();
        let changed = changed.filter(|(_, (old, new))| old != new);
        for (kept, (position, (_, new))) in changed.take(4).enumerate() {
            answer.positions[kept] = position as u8;
            answer.values[kept] = *new;
        }
    }
}

#[entry]
fn main() -> ! {
    let mut run = 0;
    for number in 0..INPUTS {
        let mut before = input(number);
        let mut random = Random(0x6d2b_79f5 ^ number);
        let contents = core::array::from_fn(|_| random.float());
        run = 0;
        loop {
            // SAFETY: the table ends with zeros, which is checked before the next entry is read.
            let [code, _] = unsafe { (&raw const TABLE).add(run).read_volatile() };
            if code == 0 || run == FORMS {
                break;
            }
            before.code = code;
            execute(run, number, &before, &contents);
            run += 1;
        }
    }
    // SAFETY: nothing else accesses it.
    unsafe { (&raw mut FORMS_RUN).write_volatile(run as u32) };
    loop {
        cortex_m::asm::wfi();
    }
}
