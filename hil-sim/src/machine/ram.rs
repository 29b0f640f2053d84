//! What a DMA controller sees of the memories.

/// A bus error: no memory behind the address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NoMemory;

/// Memory as seen by a DMA controller. `bytes` is 1, 2 or 4; addresses are aligned to it.
pub(crate) trait Memory {
    fn load(&mut self, address: u32, bytes: u8) -> Result<u32, NoMemory>;
    fn store(&mut self, address: u32, bytes: u8, value: u32) -> Result<(), NoMemory>;
}
