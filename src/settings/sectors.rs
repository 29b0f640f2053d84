//! Flash sectors whose erasure is all or nothing.
//!
//! Power that fails while a sector is being erased leaves bits that are anything: old records can still be there and be
//! taken for the newest. So a sector counts only as long as it begins with a seal. The seal is broken, which is the
//! programming of one word, before anything is erased; a sector without it reads as erased, and is erased when it is
//! next written to.
//!
//! ```text
//! sealed:   [seal, 8 bytes][data]        unsealed: reads as erased
//! erase     -> break the seal
//! write     -> if unsealed: erase, look whether it is, seal; then write
//! ```

use core::fmt;

use embedded_storage::nor_flash::NorFlash as Blocking;
use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

/// Begins a sector that counts. Neither nothing, nor zeros, nor few bits away from them.
const SEAL: [u8; 8] = *b"settings";
const SEAL_BYTES: usize = SEAL.len();
/// Makes any seal another one: programming can only clear bits.
const BROKEN: [u8; 4] = [0; 4];
const ERASED: u8 = 0xff;
/// Bytes that are compared at a time.
const LOOK: usize = 32;

/// Equal sectors of a flash, each shorter by its seal.
#[derive(Debug)]
pub struct Sectors<F>(F);

/// Why an access failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorError<E> {
    /// The flash says so.
    Flash(E),
    /// The sector was erased, and is not.
    NotErased,
    /// An address outside of the sectors, or from one into the next.
    OutOfBounds,
}

impl<E: fmt::Display> fmt::Display for SectorError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flash(error) => error.fmt(f),
            Self::NotErased => f.write_str("a sector is not erased after its erasure"),
            Self::OutOfBounds => f.write_str("an access outside of the sectors"),
        }
    }
}

impl<E: fmt::Debug> NorFlashError for SectorError<E> {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::OutOfBounds => NorFlashErrorKind::OutOfBounds,
            Self::Flash(_) | Self::NotErased => NorFlashErrorKind::Other,
        }
    }
}

impl<F: Blocking> Sectors<F> {
    /// Bytes of a sector without its seal.
    pub const BYTES: usize = F::ERASE_SIZE - SEAL_BYTES;

    /// The sectors of this flash.
    pub const fn new(flash: F) -> Self {
        const { assert!(F::READ_SIZE <= 4 && F::WRITE_SIZE <= 4) };
        Self(flash)
    }

    /// Address of a sector, and of what lies there in the flash.
    fn place(&self, offset: u32, bytes: usize) -> Result<(u32, u32), SectorError<F::Error>> {
        let size = Self::BYTES as u32;
        let (sector, within) = (offset / size, offset % size);
        let start = sector * F::ERASE_SIZE as u32;
        if within as usize + bytes > Self::BYTES || start as usize + F::ERASE_SIZE > self.0.capacity() {
            return Err(SectorError::OutOfBounds);
        }
        Ok((start, start + SEAL_BYTES as u32 + within))
    }

    #[inline(never)]
    fn is_sealed(&mut self, start: u32) -> Result<bool, SectorError<F::Error>> {
        let mut seal = [0; SEAL_BYTES];
        self.0.read(start, &mut seal).map_err(SectorError::Flash)?;
        Ok(seal == SEAL)
    }

    /// Erases and seals. Always erases: bits that an erasure left half-way may read as erased today.
    #[inline(never)]
    fn prepare(&mut self, start: u32) -> Result<(), SectorError<F::Error>> {
        let end = start + F::ERASE_SIZE as u32;
        self.0.erase(start, end).map_err(SectorError::Flash)?;
        for at in (start..end).step_by(LOOK) {
            let mut seen = [0; LOOK];
            self.0.read(at, &mut seen).map_err(SectorError::Flash)?;
            if seen != [ERASED; LOOK] {
                return Err(SectorError::NotErased);
            }
        }
        self.0.write(start, &SEAL).map_err(SectorError::Flash)
    }
}

impl<F: Blocking> ErrorType for Sectors<F> {
    type Error = SectorError<F::Error>;
}

impl<F: Blocking> ReadNorFlash for Sectors<F> {
    const READ_SIZE: usize = F::READ_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        let (start, address) = self.place(offset, bytes.len())?;
        if self.is_sealed(start)? {
            return self.0.read(address, bytes).map_err(SectorError::Flash);
        }
        bytes.fill(ERASED);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.capacity() / F::ERASE_SIZE * Self::BYTES
    }
}

impl<F: Blocking> NorFlash for Sectors<F> {
    const WRITE_SIZE: usize = F::WRITE_SIZE;
    const ERASE_SIZE: usize = Self::BYTES;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        for offset in (from..to).step_by(Self::BYTES) {
            let (start, _) = self.place(offset, 0)?;
            if self.is_sealed(start)? {
                self.0.write(start, &BROKEN).map_err(SectorError::Flash)?;
            }
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        let (start, address) = self.place(offset, bytes.len())?;
        if !self.is_sealed(start)? {
            self.prepare(start)?;
        }
        self.0.write(address, bytes).map_err(SectorError::Flash)
    }
}
