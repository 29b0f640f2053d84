//! Executes each form of `forms.s` on [`INPUTS`](execution::INPUTS) inputs and keeps check sums of all registers, flags and a block of memory.
//! The program uses nothing but CPU and memory, so any Cortex-M4 with flash at 0x08000000 and this RAM can run it.
#![no_std]
#![no_main]

use core::arch::global_asm;
use cortex_m_rt::entry;
use execution::{EMPTY_SUM, GROUPS, INPUTS, MEMORY, add_to_sum, contents, input, unchanged, words};

#[path = "../../execution.rs"]
mod execution;
#[path = "../../sleep_on_panic.rs"]
mod sleep_on_panic;

/// Room for results.
const FORMS: usize = 900;

/// Results of a form: the check sum of each group, and of one input the first changed words: their positions in
/// [`After`](execution::After) and values; position 255 is none.
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
    [Answer { sums: [EMPTY_SUM; GROUPS], positions: [255; 4], values: [0; 4] }; FORMS];

/// Number of forms, once all have run.
#[unsafe(no_mangle)]
pub static mut FORMS_RUN: u32 = 0;

global_asm!(include_str!("forms.s"), options(raw));

unsafe extern "C" {
    fn run_form(before: *const execution::Before, after: *mut execution::After);
    /// Address of code and name of each form; ends with zeros.
    #[link_name = "FORMS"]
    static TABLE: [u32; 2];
}

/// Executes a form on input number `number`, and adds the result to its answer.
fn execute(form: usize, number: u32, before: &execution::Before, contents: &[u32; MEMORY]) {
    let answer = &raw mut ANSWERS;
    // SAFETY: the number of forms is checked, and a form is code as `execution` wants it.
    let (answer, (after, memory)) =
        unsafe { (&mut (*answer)[form], execution::execute(run_form, before, contents)) };
    let sum = &mut answer.sums[(number / (INPUTS / GROUPS as u32)) as usize];
    for word in words(&after).iter().chain(memory) {
        add_to_sum(sum, *word);
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
        let contents = contents(number);
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
