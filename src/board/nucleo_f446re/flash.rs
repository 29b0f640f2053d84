//! Driver of the flash sectors that hold the settings: 1 to 3, of 16 KiB each (RM0390, chapter 3).
//!
//! The driver of `stm32f4xx-hal` is not used: it waits without a time limit, programs single bytes,
//! and does not clear error flags, which block all later programming.
//!
//! The processor stalls while the flash is busy, because its code is in the same flash. The driver
//! must be used at 16 MHz, before the caches are switched on.

use core::fmt;
use core::ptr;

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use stm32f4xx_hal::pac::FLASH;

/// Address of sector 1, the first of the three sectors that hold the settings.
const BASE: usize = 0x0800_4000;
/// Bytes of the three sectors together, of one sector, and of one word.
const BYTES: usize = 3 * SECTOR;
const SECTOR: usize = 16 * 1024;
const WORD: usize = 4;
/// Sequence that unlocks the control register (RM0390, 3.5.1).
const KEYS: [u32; 2] = [0x4567_0123, 0xcdef_89ab];
/// Error flags of FLASH_SR, cleared by writing 1: operation, protection, alignment, parallelism,
/// sequence, read-out.
const ERRORS: u32 = 0x1f2;
/// The error flag of write protection, WRPERR.
const PROTECTION: u32 = 1 << 4;
/// Reads of the busy flag until an operation is given up. Each read takes more than four cycles of
/// 16 MHz, all of them more than 500 ms, the longest operation: erasing a sector of 16 KiB with 32
/// bits of parallelism (datasheet).
const BUSY_READS: u32 = 2_000_000;

/// Why the flash was not programmed or erased.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// The control register has stayed locked.
    Locked,
    /// An operation has not ended in time.
    Busy,
    /// An option byte protects the sector from being written.
    Protected,
    /// Other error flags of FLASH_SR.
    Flags(u32),
    /// The access reaches beyond the sectors or is not aligned to words or sectors.
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

/// The three sectors, addressed from 0.
pub struct SettingsFlash<'a>(&'a FLASH);

impl<'a> SettingsFlash<'a> {
    /// A driver on the registers of the flash interface.
    pub const fn new(registers: &'a FLASH) -> Self {
        Self(registers)
    }

    /// Unlocks the control register, does `work`, and locks the register again.
    fn unlocked(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<(), FlashError>,
    ) -> Result<(), FlashError> {
        self.wait_until_idle()?;
        if self.0.cr().read().lock().bit_is_set() {
            for key in KEYS {
                // SAFETY: any value may be written; a wrong one locks the register until the next
                // reset.
                self.0.keyr().write(|w| unsafe { w.key().bits(key) });
            }
        }
        if self.0.cr().read().lock().bit_is_set() {
            return Err(FlashError::Locked);
        }
        // Flags of earlier errors, such as a stray store, would block programming (RM0390, 3.8.4).
        // SAFETY: flags are cleared by writing 1.
        self.0.sr().write(|w| unsafe { w.bits(ERRORS) });
        let done = work(self);
        self.0.cr().write(|w| w.lock().set_bit());
        done
    }

    /// Waits until no operation is in progress and returns the error flags.
    fn wait_until_idle(&self) -> Result<u32, FlashError> {
        for _ in 0..BUSY_READS {
            let status = self.0.sr().read();
            if status.bsy().bit_is_clear() {
                return Ok(status.bits() & ERRORS);
            }
        }
        Err(FlashError::Busy)
    }

    /// Waits for the end of an operation.
    ///
    /// # Errors
    /// The operation has failed or has not ended in time.
    fn wait(&self) -> Result<(), FlashError> {
        match self.wait_until_idle()? {
            0 => Ok(()),
            flags if flags & PROTECTION != 0 => Err(FlashError::Protected),
            flags => Err(FlashError::Flags(flags)),
        }
    }
}

/// Checks that a range lies within the sectors and consists of whole, aligned units of `unit`
/// bytes.
fn check(from: usize, bytes: usize, unit: usize) -> Result<(), FlashError> {
    let within = from.checked_add(bytes).is_some_and(|end| end <= BYTES);
    if within && from.is_multiple_of(unit) && bytes.is_multiple_of(unit) {
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
            // SAFETY: the address is within the sectors, which hold no part of the program. The
            // read is volatile because the content of the flash changes.
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
                    // `write` starts from the reset value of the register, in which the lock is
                    // set.
                    w.lock().clear_bit().psize().psize32().ser().set_bit();
                    // SAFETY: the number is that of one of the sectors 1 to 3.
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
            // `write` starts from the reset value, as in `erase`.
            (flash.0.cr()).write(|w| w.lock().clear_bit().psize().psize32().pg().set_bit());
            for (word, address) in words.iter().zip((BASE + offset as usize..).step_by(WORD)) {
                // SAFETY: the address is that of an aligned word within the sectors, which hold no
                // part of the program; PG is set.
                unsafe { ptr::write_volatile(address as *mut u32, u32::from_le_bytes(*word)) };
                cortex_m::asm::dsb();
                flash.wait()?;
            }
            Ok(())
        })
    }
}
