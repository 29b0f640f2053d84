//! What a strict machine checks before each instruction, which makes a run two to three times as long.
use super::Wiring;
use super::alignment;
use super::elf::RAM_BASE;
use super::state::Cpu;

/// Called before the instruction at an address.
pub(super) fn check<W: Wiring>(cpu: &mut Cpu<'_, W>, address: u32) {
    let at = (address & 0x07ff_ffff) as usize;
    let mut code = [0; 4];
    match cpu.get_data().flash.get(at..at + 4) {
        Some(bytes) if address < RAM_BASE => code.copy_from_slice(bytes),
        _ => {
            if cpu.mem_read(address.into(), &mut code).is_err() {
                return; // the fetch itself fails
            }
        }
    }
    let half = |n: usize| u32::from(u16::from_le_bytes([code[n], code[n + 1]]));
    let instruction = (half(0), half(2));
    let state = cpu.get_data_mut();
    if state.chip_ref().counts_instructions() {
        state.chip().note_instruction(instruction);
    }
    alignment::check(cpu, address, instruction);
}
