//! The identifier that the factory gives each microcontroller.

/// Address of its three words (RM0390, 34.1).
const ADDRESS: *const [u32; 3] = 0x1fff_7a10 as *const _;

/// The 96 bits, which no other chip has, in words from the lowest address on.
pub fn unique_id() -> [u32; 3] {
    // SAFETY: the words are in the chip's system memory, which is always readable and never changes.
    unsafe { ADDRESS.read_volatile() }
}
