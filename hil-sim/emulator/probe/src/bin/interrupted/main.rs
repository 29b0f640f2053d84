//! Interrupts the code of `blocks.s` once at every instruction, and compares what it leaves with what it leaves uninterrupted.
//! SysTick interrupts it, with a period that grows by one cycle from run to run. The program uses nothing but CPU, SysTick and
//! memory, so any Cortex-M4 with flash at 0x08000000 and this RAM can run it.
#![no_std]
#![no_main]

use core::arch::global_asm;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m_rt::entry;
use execution::{After, Before, EMPTY_SUM, Run, add_to_sum, contents, execute, input, words};

#[path = "../../execution.rs"]
mod execution;
#[path = "../../sleep_on_panic.rs"]
mod sleep_on_panic;

const BLOCKS: usize = 3;
/// Inputs, one of each group.
const NUMBERS: [u32; 4] = [3, 105, 210, 316];
/// Longest period of SysTick: longer than a block.
const PERIODS: u32 = 700;

/// What a block leaves, with interrupts by one handler and on one stack.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Outcome {
    /// Check sum of what it leaves uninterrupted.
    sum: u32,
    /// Number of interrupted runs that leave something else.
    different: u32,
    /// Number of places at which no run was interrupted.
    missed: u32,
}

/// By block, handler (without floating point, with it), and stack (main, process).
#[unsafe(no_mangle)]
pub static mut OUTCOMES: [[[Outcome; 2]; 2]; BLOCKS] =
    [[[Outcome { sum: EMPTY_SUM, different: 0, missed: 0 }; 2]; 2]; BLOCKS];
/// 1 at the end.
#[unsafe(no_mangle)]
pub static FINISHED: AtomicU32 = AtomicU32::new(0);

/// SYST_CSR while the code runs: SysTick is on, or off.
#[unsafe(no_mangle)]
static SYSTICK_CONTROL: AtomicU32 = AtomicU32::new(0);
/// Address at which the code was interrupted.
#[unsafe(no_mangle)]
static INTERRUPTED_AT: AtomicU32 = AtomicU32::new(0);

#[unsafe(no_mangle)]
static PROCESS_STACK: [AtomicU32; 256] = [const { AtomicU32::new(0) }; 256];

/// The vector table; the microcontroller's own is of 113 vectors, for which VTOR has 512 bytes of alignment.
#[repr(C, align(512))]
struct Vectors([AtomicU32; 16]);
static VECTORS: Vectors = Vectors([const { AtomicU32::new(0) }; 16]);
const SYSTICK: usize = 15;

const SYST_CSR: usize = 0xe000_e010;
const SYST_RVR: usize = 0xe000_e014;
const SYST_CVR: usize = 0xe000_e018;
const VTOR: usize = 0xe000_ed08;
const CPACR: usize = 0xe000_ed88;

// The handlers stop SysTick, note the return address and leave everything that a frame keeps in disorder.
global_asm!(
    include_str!("blocks.s"),
    ".section .text.handlers, \"ax\", %progbits",
    ".macro note_and_disorder",
    "  tst lr, #4",
    "  ite eq",
    "  mrseq r0, msp",
    "  mrsne r0, psp",
    "  ldr r0, [r0, #24]",
    "  ldr r1, =INTERRUPTED_AT",
    "  str r0, [r1]",
    "  ldr r0, =0xe000e010",
    "  movs r1, #0",
    "  str r1, [r0]",
    "  ldr r2, =0xf80f5a5a",
    "  msr apsr_nzcvqg, r2",
    "  mov r3, r2",
    "  mov r12, r2",
    ".endm",
    ".global without_float",
    ".thumb_func",
    "without_float:",
    "  note_and_disorder",
    "  bx lr",
    ".global with_float",
    ".thumb_func",
    "with_float:",
    "  note_and_disorder",
    "  ldr r0, =0x0740009f",
    "  vmsr fpscr, r0",
    "  vmov s0, r2",
    "  vmov.f32 s1, s0",
    "  vdiv.f32 s2, s0, s1",
    "  vmov d2, r2, r3",
    "  vmov d3, r2, r3",
    "  vmov d4, r2, r3",
    "  vmov d5, r2, r3",
    "  vmov d6, r2, r3",
    "  vmov d7, r2, r3",
    "  bx lr",
    // Starts SysTick, unless it is to stay off, and `run_form`.
    ".macro start_systick",
    "  ldr r2, =SYSTICK_CONTROL",
    "  ldr r2, [r2]",
    "  ldr r3, =0xe000e010",
    "  str r2, [r3]",
    ".endm",
    ".global run_on_main_stack",
    ".thumb_func",
    "run_on_main_stack:",
    "  start_systick",
    "  b.w run_form",
    // The same on the process stack.
    ".global run_on_process_stack",
    ".thumb_func",
    "run_on_process_stack:",
    "  push {r4, lr}",
    "  ldr r2, =PROCESS_STACK + 1024",
    "  msr psp, r2",
    "  mrs r4, control",
    "  orr r4, #2",
    "  msr control, r4",
    "  isb",
    "  start_systick",
    "  bl run_form",
    "  mrs r4, control",
    "  bic r4, #2",
    "  msr control, r4",
    "  isb",
    "  pop {r4, pc}",
    ".ltorg",
    options(raw)
);

/// The code of a block, and its first place.
#[repr(C)]
#[derive(Clone, Copy)]
struct Block {
    code: u32,
    places: *const u32,
}

unsafe extern "C" {
    /// Ends with the code 0, whose first place is the end of all.
    #[link_name = "BLOCKS"]
    static TABLE: [Block; BLOCKS + 1];
    fn without_float();
    fn with_float();
    fn run_on_main_stack(before: *const Before, after: *mut After);
    fn run_on_process_stack(before: *const Before, after: *mut After);
}

fn write(address: usize, value: u32) {
    // SAFETY: the address is that of a register of the core.
    unsafe { (address as *mut u32).write_volatile(value) }
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
}

/// Check sum of what a block leaves of an input. SysTick interrupts it after `period` cycles, or not, with 0.
fn sum_of(code: u32, number: u32, run: Run, period: u32) -> u32 {
    let mut before = input(number);
    before.code = code;
    let contents = contents(number);
    write(SYST_RVR, period);
    write(SYST_CVR, 0);
    SYSTICK_CONTROL.store(if period == 0 { 0 } else { 7 }, Relaxed);
    // SAFETY: the blocks are code as `execution` wants it.
    let (after, memory) = unsafe { execute(run, &before, &contents) };
    write(SYST_CSR, 0);
    let mut sum = EMPTY_SUM;
    for word in words(&after).iter().chain(memory) {
        add_to_sum(&mut sum, *word);
    }
    sum
}

fn outcome(block: usize, run: Run) -> Outcome {
    const PLACES: usize = 64;
    // SAFETY: the table has an entry more than there are blocks, and the places of a block end where those of the next begin.
    let (code, places) = unsafe {
        let [block, next] = [TABLE[block], TABLE[block + 1]];
        let count = next.places.offset_from(block.places) as usize;
        (block.code, core::slice::from_raw_parts(block.places, count))
    };
    let mut interrupted = [false; PLACES];
    let mut outcome = Outcome { sum: EMPTY_SUM, different: 0, missed: 0 };
    for number in NUMBERS {
        let sum = sum_of(code, number, run, 0);
        add_to_sum(&mut outcome.sum, sum);
        for period in 1..=PERIODS {
            outcome.different += u32::from(sum_of(code, number, run, period) != sum);
            let at = INTERRUPTED_AT.load(Relaxed);
            if let Some(place) = places.iter().position(|place| *place == at) {
                interrupted[place] = true;
            }
        }
    }
    outcome.missed = interrupted[..places.len()].iter().filter(|hit| !**hit).count() as u32;
    outcome
}

#[entry]
fn main() -> ! {
    write(VTOR, VECTORS.0.as_ptr() as u32);
    write(CPACR, 0xf0_0000);
    let outcomes = core::array::from_fn(|block| {
        [without_float as *const (), with_float as *const ()].map(|handler| {
            VECTORS.0[SYSTICK].store(handler as u32, Relaxed);
            [run_on_main_stack as Run, run_on_process_stack].map(|run| outcome(block, run))
        })
    });
    // SAFETY: nothing else accesses it.
    unsafe { (&raw mut OUTCOMES).write_volatile(outcomes) };
    FINISHED.store(1, Relaxed);
    loop {
        cortex_m::asm::wfi();
    }
}
