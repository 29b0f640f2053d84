//! What a strict machine checks before each instruction, which makes a run two to three times as long.
use super::Wiring;
use super::alignment;
use super::state::{Cpu, half_words};

/// Called before the instruction at an address.
pub(super) fn check<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32) {
    let Some(instruction) = half_words(cpu, address) else {
        return; // the fetch itself fails
    };
    let state = cpu.get_data_mut();
    if state.chip_ref().counts_instructions() {
        state.chip().note_instruction(instruction);
    }
    alignment::check(cpu, address, instruction);
}
