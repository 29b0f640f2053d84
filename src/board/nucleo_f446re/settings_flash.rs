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
const SETTINGS_ADDRESS: usize = 0x0800_4000;
const CAPACITY_BYTES: usize = 3 * SECTOR_BYTES;
const SECTOR_BYTES: usize = 16 * 1024;
const WORD_BYTES: usize = 4;
/// The two words that unlock the control register FLASH_CR when they are written to FLASH_KEYR in
/// this order (RM0390, 3.5.1).
const UNLOCK_KEYS: [u32; 2] = [0x4567_0123, 0xcdef_89ab];
/// All error flags of FLASH_SR, which are cleared by writing 1: operation error, write protection,
/// alignment, parallelism, sequence, read protection.
const ERROR_FLAGS: u32 = 0x1f2;
/// The flag WRPERR of FLASH_SR: an operation was refused because the sector is write-protected.
const WRITE_PROTECTION_FLAG: u32 = 1 << 4;
/// Number of reads of the busy flag after which an operation counts as failed. Each read takes more
/// than four cycles at 16 MHz, so all reads take more than 500 ms. That is the duration of the
/// longest operation, erasing a sector of 16 KiB with 32 bits of parallelism (datasheet).
const BUSY_READS_MAX: u32 = 2_000_000;

/// Why an access to the flash sectors of the settings has failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// The control register FLASH_CR has stayed locked after the unlock keys were written.
    Locked,
    /// The flash was still busy after more than 500 ms, the longest time that an operation may
    /// take.
    Busy,
    /// The flash has refused to write or erase a sector, because an option byte protects the
    /// sector.
    Protected,
    /// An operation has failed with these error flags of FLASH_SR, which do not include write
    /// protection.
    Flags(u32),
    /// The access reaches beyond the three sectors, or is not aligned to words (writing) or sectors
    /// (erasing).
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

/// Driver of the three flash sectors that hold the settings, 1 to 3, of 16 KiB each. Offsets count
/// bytes from the start of sector 1.
pub struct SettingsFlash<'a>(&'a FLASH);

impl<'a> SettingsFlash<'a> {
    /// Creates the driver of the three sectors that hold the settings. `registers` are those of the
    /// flash interface.
    pub const fn new(registers: &'a FLASH) -> Self {
        Self(registers)
    }

    /// Unlocks the control register FLASH_CR, clears old error flags, calls `work`, which writes or
    /// erases, and locks the register again, also if `work` has failed.
    ///
    /// # Errors
    /// [`FlashError::Busy`] if the flash stays busy, [`FlashError::Locked`] if the register stays
    /// locked, or the error of `work`.
    fn with_flash_unlocked(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<(), FlashError>,
    ) -> Result<(), FlashError> {
        self.wait_until_idle_and_read_errors()?;
        if self.0.cr().read().lock().bit_is_set() {
            for key in UNLOCK_KEYS {
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
        self.0.sr().write(|w| unsafe { w.bits(ERROR_FLAGS) });
        let done = work(self);
        self.0.cr().write(|w| w.lock().set_bit());
        done
    }

    /// Waits until the flash has no operation in progress, and returns the error flags of FLASH_SR,
    /// zero if none is set.
    ///
    /// # Errors
    /// [`FlashError::Busy`] if the flash is still busy after [`BUSY_READS_MAX`] reads of the busy
    /// flag, more than 500 ms.
    fn wait_until_idle_and_read_errors(&self) -> Result<u32, FlashError> {
        for _ in 0..BUSY_READS_MAX {
            let status = self.0.sr().read();
            if status.bsy().bit_is_clear() {
                return Ok(status.bits() & ERROR_FLAGS);
            }
        }
        Err(FlashError::Busy)
    }

    /// Waits for the end of a write or erase operation, and checks the error flags of FLASH_SR.
    ///
    /// # Errors
    /// [`FlashError::Busy`] if the operation has not ended after more than 500 ms,
    /// [`FlashError::Protected`] if the sector is write-protected, [`FlashError::Flags`] if only
    /// other error flags are set.
    fn wait_and_check(&self) -> Result<(), FlashError> {
        match self.wait_until_idle_and_read_errors()? {
            0 => Ok(()),
            flags if flags & WRITE_PROTECTION_FLAG != 0 => Err(FlashError::Protected),
            flags => Err(FlashError::Flags(flags)),
        }
    }
}

/// Checks that the `bytes` bytes from the offset `from`, which counts from the start of sector 1,
/// lie within the three sectors, and that `from` and `bytes` are multiples of `unit` bytes. Returns
/// [`FlashError::OutOfBounds`] if not.
fn check_bounds_and_alignment(from: usize, bytes: usize, unit: usize) -> Result<(), FlashError> {
    let within = from.checked_add(bytes).is_some_and(|end| end <= CAPACITY_BYTES);
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
        check_bounds_and_alignment(offset as usize, bytes.len(), 1)?;
        for (byte, address) in bytes.iter_mut().zip(SETTINGS_ADDRESS + offset as usize..) {
            // SAFETY: the address is within the sectors, which hold no part of the program. The
            // read is volatile because the content of the flash changes.
            *byte = unsafe { ptr::read_volatile(address as *const u8) };
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        CAPACITY_BYTES
    }
}

impl NorFlash for SettingsFlash<'_> {
    const WRITE_SIZE: usize = WORD_BYTES;
    const ERASE_SIZE: usize = SECTOR_BYTES;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let (from, to) = (from as usize, to as usize);
        check_bounds_and_alignment(from, to.saturating_sub(from), SECTOR_BYTES)?;
        self.with_flash_unlocked(|flash| {
            for number in 1 + from / SECTOR_BYTES..1 + to / SECTOR_BYTES {
                flash.0.cr().write(|w| {
                    // `write` starts from the reset value of the register, in which the lock is
                    // set.
                    w.lock().clear_bit().psize().psize32().ser().set_bit();
                    // SAFETY: the number is that of one of the sectors 1 to 3.
                    unsafe { w.snb().bits(number as u8) };
                    w.strt().set_bit()
                });
                flash.wait_and_check()?;
            }
            Ok(())
        })
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        check_bounds_and_alignment(offset as usize, bytes.len(), WORD_BYTES)?;
        let (words, _) = bytes.as_chunks::<WORD_BYTES>();
        self.with_flash_unlocked(|flash| {
            // `write` starts from the reset value, as in `erase`.
            (flash.0.cr()).write(|w| w.lock().clear_bit().psize().psize32().pg().set_bit());
            for (word, address) in
                words.iter().zip((SETTINGS_ADDRESS + offset as usize..).step_by(WORD_BYTES))
            {
                // SAFETY: the address is that of an aligned word within the sectors, which hold no
                // part of the program; PG is set.
                unsafe { ptr::write_volatile(address as *mut u32, u32::from_le_bytes(*word)) };
                cortex_m::asm::dsb();
                flash.wait_and_check()?;
            }
            Ok(())
        })
    }
}
