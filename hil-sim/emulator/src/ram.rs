//! Memory accesses of the DMA controllers.
use super::elf::{FLASH_BASE, FLASH_SIZE, RAM_BASE, RAM_SIZE};
use unicorn_engine::Unicorn;

/// A bus error: no memory behind the address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NoMemory;

/// Memory that a DMA controller accesses. `bytes` is 1, 2 or 4; addresses are aligned to it.
pub(crate) trait Memory {
    fn load(&mut self, address: u32, bytes: u8) -> Result<u32, NoMemory>;
    fn store(&mut self, address: u32, bytes: u8, value: u32) -> Result<(), NoMemory>;
}

const LINE: usize = 64;

/// The emulated memories while the CPU is halted. Single accesses are slow, so a load reads a whole line and stores to
/// ascending addresses are buffered until [`flush`](Self::flush), which must be called at the end.
pub(crate) struct Ram<'a, 'u, D> {
    cpu: &'a mut Unicorn<'u, D>,
    line_at: Option<u32>,
    line: [u8; LINE],
    run_at: u32,
    run_bytes: usize,
    run: [u8; 4 * LINE],
}

impl<'a, 'u, D> Ram<'a, 'u, D> {
    pub fn new(cpu: &'a mut Unicorn<'u, D>) -> Self {
        Self { cpu, line_at: None, line: [0; LINE], run_at: 0, run_bytes: 0, run: [0; 4 * LINE] }
    }

    /// Writes the buffered stores.
    pub fn flush(&mut self) {
        let buffered = &self.run[..self.run_bytes];
        if !buffered.is_empty() {
            let written = self.cpu.mem_write(u64::from(self.run_at), buffered);
            debug_assert!(written.is_ok(), "only stores to RAM are buffered");
            self.run_bytes = 0;
        }
    }
}

impl<D> Memory for Ram<'_, '_, D> {
    fn load(&mut self, address: u32, bytes: u8) -> Result<u32, NoMemory> {
        let memories = [RAM_BASE..RAM_BASE + RAM_SIZE, FLASH_BASE..FLASH_BASE + FLASH_SIZE];
        if !memories.iter().any(|m| m.contains(&address)) {
            return Err(NoMemory);
        }
        let at = address & !(LINE as u32 - 1);
        if self.line_at != Some(at) {
            self.flush();
            self.cpu.mem_read(u64::from(at), &mut self.line).map_err(|_| NoMemory)?;
            self.line_at = Some(at);
        }
        let from = (address - at) as usize;
        let item = self.line.get(from..from + usize::from(bytes)).ok_or(NoMemory)?;
        Ok(item.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte)))
    }

    fn store(&mut self, address: u32, bytes: u8, value: u32) -> Result<(), NoMemory> {
        if !(RAM_BASE..RAM_BASE + RAM_SIZE).contains(&address) {
            return Err(NoMemory);
        }
        let n = usize::from(bytes);
        if address != self.run_at + self.run_bytes as u32 || self.run_bytes + n > self.run.len() {
            self.flush();
            self.run_at = address;
        }
        let word = value.to_le_bytes();
        self.run[self.run_bytes..self.run_bytes + n]
            .copy_from_slice(word.get(..n).ok_or(NoMemory)?);
        self.run_bytes += n;
        if self.line_at == Some(address & !(LINE as u32 - 1)) {
            self.line_at = None;
        }
        Ok(())
    }
}
