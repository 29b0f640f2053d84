//! Flash sectors that survive single-bit errors and interrupted erasures.
//!
//! Each word is stored three times in a row, and each of its bits is read by majority vote. A single bit that flips over
//! the years would otherwise invalidate a record and all that follow it, and an older record would be taken for the newest.
//! A word also takes effect completely or not at all if the power fails between two of its copies.
//!
//! A power failure during an erasure leaves undefined bits: old records may still be readable and be taken for the
//! newest. So a sector is valid only while it begins with a seal. Before a sector is erased, its seal is broken by
//! programming one word. A sector without a seal reads as erased, and is physically erased when it is next written to.
//!
//! ```text
//! valid:    [seal, 2 words x 3][data, each word x 3]        without a seal: reads as erased
//! erase     -> break the seal
//! write     -> without a seal: erase, verify, seal; then program
//! ```

use core::fmt;

use embedded_storage::nor_flash::NorFlash as BlockingNorFlash;
use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

/// Bytes in a word, the unit of programming.
const WORD_BYTES: usize = 4;
/// Number of copies in which each word is stored; a majority of them decides when it is read.
const COPIES: usize = 3;
/// Bytes of flash that one word occupies.
const WORD_COPIES_BYTES: usize = COPIES * WORD_BYTES;
/// Marks a valid sector. It differs in many bits from erased flash and from zeros.
const SEAL: [u8; 2 * WORD_BYTES] = *b"settings";
/// Invalidates a seal when programmed over its first word: programming can only clear bits.
const BROKEN_SEAL: [u8; WORD_BYTES] = [0; WORD_BYTES];
/// Value of an erased byte.
const ERASED: u8 = 0xff;
/// Bytes that are read at a time when an erasure is verified.
const VERIFY_BYTES: usize = 32;

/// Redundant sectors on a flash with equal sectors; each holds a third of the flash's sector, less the seal.
#[derive(Debug)]
pub struct RedundantSectors<F>(F);

/// Why an access to the sectors failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorError<E> {
    /// The flash reported an error.
    Flash(E),
    /// A sector is not blank after it was erased.
    NotErased,
    /// The access is not word-aligned, crosses the border of a sector or lies outside of the sectors.
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

impl<F: BlockingNorFlash> RedundantSectors<F> {
    /// Bytes of data in one sector: a third of its size, because each word is stored three times, less the seal that marks a
    /// valid sector.
    pub const SECTOR_BYTES: usize = F::ERASE_SIZE / WORD_COPIES_BYTES * WORD_BYTES - SEAL.len();

    /// Redundant sectors on all sectors of this flash.
    pub const fn new(flash: F) -> Self {
        const { assert!(F::READ_SIZE <= WORD_BYTES && F::WRITE_SIZE <= WORD_BYTES) };
        Self(flash)
    }

    /// Flash addresses of the sector that holds an offset, and of the first copy of its word.
    fn locate(&self, offset: u32, bytes: usize) -> Result<(u32, u32), SectorError<F::Error>> {
        let offset = offset as usize;
        let (sector, within) = (offset / Self::SECTOR_BYTES, offset % Self::SECTOR_BYTES);
        let start = sector * F::ERASE_SIZE;
        let fits = within.is_multiple_of(WORD_BYTES)
            && within + bytes <= Self::SECTOR_BYTES
            && start + F::ERASE_SIZE <= self.0.capacity();
        if fits {
            let from_start = (SEAL.len() + within) / WORD_BYTES * WORD_COPIES_BYTES;
            Ok((start as u32, (start + from_start) as u32))
        } else {
            Err(SectorError::OutOfBounds)
        }
    }

    /// Reads words by majority vote over their copies.
    fn read_majority(
        &mut self,
        address: u32,
        bytes: &mut [u8],
    ) -> Result<(), SectorError<F::Error>> {
        for (word, at) in bytes
            .chunks_mut(WORD_BYTES)
            .zip((address..).step_by(WORD_COPIES_BYTES))
        {
            let mut copies = [[0; WORD_BYTES]; COPIES];
            self.0
                .read(at, copies.as_flattened_mut())
                .map_err(SectorError::Flash)?;
            let [first, second, third] = copies.map(u32::from_ne_bytes);
            let majority = first & second | second & third | third & first;
            word.iter_mut()
                .zip(majority.to_ne_bytes())
                .for_each(|(byte, voted)| *byte = voted);
        }
        Ok(())
    }

    /// Programs all copies of words.
    fn program(&mut self, address: u32, bytes: &[u8]) -> Result<(), SectorError<F::Error>> {
        let (words, []) = bytes.as_chunks() else {
            return Err(SectorError::OutOfBounds);
        };
        for (word, at) in words.iter().zip((address..).step_by(WORD_COPIES_BYTES)) {
            let copies: [[u8; WORD_BYTES]; COPIES] = [*word; COPIES];
            self.0
                .write(at, copies.as_flattened())
                .map_err(SectorError::Flash)?;
        }
        Ok(())
    }

    #[inline(never)]
    fn is_sealed(&mut self, start: u32) -> Result<bool, SectorError<F::Error>> {
        let mut seal = [0; SEAL.len()];
        self.read_majority(start, &mut seal)?;
        Ok(seal == SEAL)
    }

    /// Erases, verifies and seals a sector. It erases even a sector that reads as blank: bits that an interrupted erasure
    /// left half-erased may read as erased now and not later.
    #[inline(never)]
    fn erase_and_seal(&mut self, start: u32) -> Result<(), SectorError<F::Error>> {
        let end = start + F::ERASE_SIZE as u32;
        self.0.erase(start, end).map_err(SectorError::Flash)?;
        for at in (start..end).step_by(VERIFY_BYTES) {
            let mut read = [0; VERIFY_BYTES];
            self.0.read(at, &mut read).map_err(SectorError::Flash)?;
            if read != [ERASED; VERIFY_BYTES] {
                return Err(SectorError::NotErased);
            }
        }
        self.program(start, &SEAL)
    }
}

impl<F: BlockingNorFlash> ErrorType for RedundantSectors<F> {
    type Error = SectorError<F::Error>;
}

impl<F: BlockingNorFlash> ReadNorFlash for RedundantSectors<F> {
    const READ_SIZE: usize = WORD_BYTES;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        let (start, address) = self.locate(offset, bytes.len())?;
        if self.is_sealed(start)? {
            return self.read_majority(address, bytes);
        }
        bytes.fill(ERASED);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.capacity() / F::ERASE_SIZE * Self::SECTOR_BYTES
    }
}

impl<F: BlockingNorFlash> NorFlash for RedundantSectors<F> {
    const WRITE_SIZE: usize = WORD_BYTES;
    const ERASE_SIZE: usize = Self::SECTOR_BYTES;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        for offset in (from..to).step_by(Self::SECTOR_BYTES) {
            let (start, _) = self.locate(offset, 0)?;
            if self.is_sealed(start)? {
                self.program(start, &BROKEN_SEAL)?;
            }
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        let (start, address) = self.locate(offset, bytes.len())?;
        if !self.is_sealed(start)? {
            self.erase_and_seal(start)?;
        }
        self.program(address, bytes)
    }
}
