//! The flash that the settings are in: sectors 1 to 3, 16 KiB each (RM0390, chapter 3).
//!
//! Not the library's driver: it waits without end, programs byte by byte, and leaves error flags standing, after which
//! nothing can be programmed any more.
//!
//! Code in the same flash stands still while it is busy. To be used at 16 MHz, before caches are switched on.

use core::fmt;
use core::ptr;

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use stm32f4xx_hal::pac::FLASH;

/// First address of sector 1, and bytes of sectors 1 to 3.
const BASE: usize = 0x0800_4000;
const BYTES: usize = 3 * SECTOR;
const SECTOR: usize = 16 * 1024;
const WORD: usize = 4;
const KEYS: [u32; 2] = [0x4567_0123, 0xcdef_89ab];
/// Error flags of FLASH_SR, cleared by writing 1: operation, protection, alignment, parallelism, sequence, read-out.
const ERRORS: u32 = 0x1f2;
const PROTECTION: u32 = 1 << 4;
/// Looks at the busy flag that last longer than any operation: 500 ms (datasheet, sector of 16 KiB, 32 bits at a time), a
/// look takes more than four cycles of 16 MHz.
const PATIENCE: u32 = 2_000_000;

/// Why the flash was not programmed or erased.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// The control register stays locked.
    Locked,
    /// It is busy for longer than it may be.
    Busy,
    /// The sector is protected by an option byte.
    Protected,
    /// Flags of FLASH_SR that should not come up.
    Flags(u32),
    /// An address outside of the sectors, or no whole words or sectors.
    OutOfBounds,
}

impl fmt::Display for FlashError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Locked => f.write_str("the flash stays locked"),
            Self::Busy => f.write_str("the flash stays busy"),
            Self::Protected => f.write_str("the flash is write-protected"),
            Self::Flags(flags) => write!(f, "the flash reports an error (FLASH_SR 0x{flags:x})"),
            Self::OutOfBounds => f.write_str("an access outside of the settings' flash"),
        }
    }
}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::OutOfBounds => NorFlashErrorKind::OutOfBounds,
            _ => NorFlashErrorKind::Other,
        }
    }
}

/// The three sectors.
pub struct SettingsFlash<'a>(&'a FLASH);

impl<'a> SettingsFlash<'a> {
    /// By these registers.
    pub const fn new(registers: &'a FLASH) -> Self {
        Self(registers)
    }

    /// Opens the control register for some work, and locks it afterwards.
    fn unlocked(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<(), FlashError>,
    ) -> Result<(), FlashError> {
        self.wait_until_idle()?;
        if self.0.cr().read().lock().bit_is_set() {
            for key in KEYS {
                // SAFETY: the sequence of RM0390, 3.5.1.
                self.0.keyr().write(|w| unsafe { w.key().bits(key) });
            }
        }
        if self.0.cr().read().lock().bit_is_set() {
            return Err(FlashError::Locked);
        }
        // What was before, a stray store for one, is no error of this work, and would keep it from being done (RM0390, 3.8.4).
        // SAFETY: flags are cleared by writing 1.
        self.0.sr().write(|w| unsafe { w.bits(ERRORS) });
        let done = work(self);
        self.0.cr().write(|w| w.lock().set_bit());
        done
    }

    /// Until no operation is under way; what the flags say then.
    fn wait_until_idle(&self) -> Result<u32, FlashError> {
        for _ in 0..PATIENCE {
            let status = self.0.sr().read();
            if status.bsy().bit_is_clear() {
                return Ok(status.bits() & ERRORS);
            }
        }
        Err(FlashError::Busy)
    }

    /// Until the operation is done, well.
    fn wait(&self) -> Result<(), FlashError> {
        match self.wait_until_idle()? {
            0 => Ok(()),
            flags if flags & PROTECTION != 0 => Err(FlashError::Protected),
            flags => Err(FlashError::Flags(flags)),
        }
    }
}

/// Whether a range lies within the sectors, in whole parts of that many bytes.
fn check(from: usize, bytes: usize, part: usize) -> Result<(), FlashError> {
    let within = from.checked_add(bytes).is_some_and(|end| end <= BYTES);
    if within && from.is_multiple_of(part) && bytes.is_multiple_of(part) {
        Ok(())
    } else {
        Err(FlashError::OutOfBounds)
    }
}

impl ErrorType for SettingsFlash<'_> {
    type Error = FlashError;
}

impl ReadNorFlash for SettingsFlash<'_> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        check(offset as usize, bytes.len(), 1)?;
        for (byte, address) in bytes.iter_mut().zip(BASE + offset as usize..) {
            // SAFETY: within the sectors, where nothing of the program lies. Volatile, as the flash changes.
            *byte = unsafe { ptr::read_volatile(address as *const u8) };
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        BYTES
    }
}

impl NorFlash for SettingsFlash<'_> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let (from, to) = (from as usize, to as usize);
        check(from, to.saturating_sub(from), SECTOR)?;
        self.unlocked(|flash| {
            for number in 1 + from / SECTOR..1 + to / SECTOR {
                flash.0.cr().write(|w| {
                    // The reset value that a write starts from is locked.
                    w.lock().clear_bit().psize().psize32().ser().set_bit();
                    // SAFETY: one of the sectors 1 to 3.
                    unsafe { w.snb().bits(number as u8) };
                    w.strt().set_bit()
                });
                flash.wait()?;
            }
            Ok(())
        })
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        check(offset as usize, bytes.len(), WORD)?;
        let (words, _) = bytes.as_chunks::<WORD>();
        self.unlocked(|flash| {
            // As above.
            (flash.0.cr()).write(|w| w.lock().clear_bit().psize().psize32().pg().set_bit());
            for (word, address) in words.iter().zip((BASE + offset as usize..).step_by(WORD)) {
                // SAFETY: an aligned word within the sectors, where nothing of the program lies; PG is set.
                unsafe { ptr::write_volatile(address as *mut u32, u32::from_le_bytes(*word)) };
                cortex_m::asm::dsb();
                flash.wait()?;
            }
            Ok(())
        })
    }
}
