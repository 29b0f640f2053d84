//! Flash sectors that survive single-bit errors and interrupted erasures.
//!
//! Each word is stored three times in a row, and each of its bits is read by majority vote. A single bit that flips
//! over the years would otherwise invalidate a record and all that follow it, and an older record would be taken for
//! the newest. A word also takes effect completely or not at all if the power fails between two of its copies.
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

/// Bytes in a word, the unit in which the flash is programmed.
const WORD_BYTES: usize = 4;
/// Number of copies in which each word is stored in the flash; a bit is read as what two of the three copies hold.
const COPIES_PER_WORD: usize = 3;
/// Bytes of flash that one word of data occupies with its three copies.
const FLASH_BYTES_PER_DATA_WORD: usize = COPIES_PER_WORD * WORD_BYTES;
/// The first two words of a valid sector; a sector without this seal reads as erased. It differs in many bits from
/// erased flash (0xff) and from zeros, so that an interrupted erasure is unlikely to form it.
const COMPLETE_ERASURE_SEAL: [u8; 2 * WORD_BYTES] = *b"settings";
/// Programmed over the first word of a sector's seal to make the sector invalid before its erasure; zeros, because
/// programming can only clear bits.
const BROKEN_SEAL_WORD: [u8; WORD_BYTES] = [0; WORD_BYTES];
const ERASED_BYTE: u8 = 0xff;
/// Bytes of flash that are read at a time to check that an erased sector is blank.
const BLANK_CHECK_CHUNK_BYTES: usize = 32;

/// A NOR flash in which single-bit errors do not change the data, and interrupted erasures leave no false data. It is
/// built on the flash `F`, whose sectors all have one size. Each word is stored three times, so each sector holds a
/// third of the data of a sector of `F`, less a seal of two words that marks the sector as valid.
#[derive(Debug)]
pub struct TriplicatedSealedFlash<F>(F);

/// Why redundant sectors could not be read, written or erased.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriplicatedSealedFlashError<E> {
    /// The driver of the flash reported this error when it read, programmed or erased.
    Flash(E),
    /// A sector of the flash is not blank (all bytes 0xff) after it was erased.
    NotErased,
    /// The access to the flash does not begin at a multiple of 4 bytes, crosses from one sector to the next, or lies
    /// outside of all sectors; or data to be written are not whole words of 4 bytes.
    OutOfBounds,
}

impl<E: fmt::Display> fmt::Display for TriplicatedSealedFlashError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flash(error) => error.fmt(f),
            Self::NotErased => f.write_str("a sector is not erased after its erasure"),
            Self::OutOfBounds => f.write_str("an access outside of the sectors"),
        }
    }
}

impl<E: fmt::Debug> NorFlashError for TriplicatedSealedFlashError<E> {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::OutOfBounds => NorFlashErrorKind::OutOfBounds,
            Self::Flash(_) | Self::NotErased => NorFlashErrorKind::Other,
        }
    }
}

impl<F: BlockingNorFlash> TriplicatedSealedFlash<F> {
    /// Bytes of data that one sector holds: a third of the size of the flash's sector, because each word is stored
    /// three times, less the seal of 8 bytes that marks a valid sector.
    pub const DATA_BYTES_PER_SECTOR: usize =
        F::ERASE_SIZE / FLASH_BYTES_PER_DATA_WORD * WORD_BYTES - COMPLETE_ERASURE_SEAL.len();

    /// Makes redundant sectors of all sectors of `flash`. Compiling fails if `flash` is read or written in units of
    /// more than 4 bytes.
    pub const fn new(flash: F) -> Self {
        const { assert!(F::READ_SIZE <= WORD_BYTES && F::WRITE_SIZE <= WORD_BYTES) };
        Self(flash)
    }

    /// Returns two flash addresses for an access to the `bytes` bytes of data at `offset`, which counts data only,
    /// without seals and copies: the start of the sector, and the first copy of the first word.
    ///
    /// # Errors
    /// [`TriplicatedSealedFlashError::OutOfBounds`]: `offset` is not a multiple of 4 bytes from the start of the sector's data, or the
    /// access does not lie within one sector of the flash.
    fn checked_sector_and_word_addresses(
        &self,
        offset: u32,
        bytes: usize,
    ) -> Result<(u32, u32), TriplicatedSealedFlashError<F::Error>> {
        let offset = offset as usize;
        let (sector, within) =
            (offset / Self::DATA_BYTES_PER_SECTOR, offset % Self::DATA_BYTES_PER_SECTOR);
        let start = sector * F::ERASE_SIZE;
        let fits = within.is_multiple_of(WORD_BYTES)
            && within + bytes <= Self::DATA_BYTES_PER_SECTOR
            && start + F::ERASE_SIZE <= self.0.capacity();
        if fits {
            let from_start =
                (COMPLETE_ERASURE_SEAL.len() + within) / WORD_BYTES * FLASH_BYTES_PER_DATA_WORD;
            Ok((start as u32, (start + from_start) as u32))
        } else {
            Err(TriplicatedSealedFlashError::OutOfBounds)
        }
    }

    /// Fills `bytes` with the words whose copies begin at `address` in the flash. Each bit is read as what two of its
    /// three copies hold.
    fn read_words_by_bit_majority(
        &mut self,
        address: u32,
        bytes: &mut [u8],
    ) -> Result<(), TriplicatedSealedFlashError<F::Error>> {
        for (word, at) in
            bytes.chunks_mut(WORD_BYTES).zip((address..).step_by(FLASH_BYTES_PER_DATA_WORD))
        {
            let mut copies = [[0; WORD_BYTES]; COPIES_PER_WORD];
            self.0
                .read(at, copies.as_flattened_mut())
                .map_err(TriplicatedSealedFlashError::Flash)?;
            let [first, second, third] = copies.map(u32::from_ne_bytes);
            let majority = first & second | second & third | third & first;
            word.iter_mut().zip(majority.to_ne_bytes()).for_each(|(byte, voted)| *byte = voted);
        }
        Ok(())
    }

    /// Programs the words of `bytes` in their order from `address` in the flash on, each word three times in a row.
    ///
    /// # Errors
    /// [`TriplicatedSealedFlashError::OutOfBounds`]: `bytes` are not whole words of 4 bytes. [`TriplicatedSealedFlashError::Flash`]: programming
    /// failed.
    fn program_words_in_triplicate(
        &mut self,
        address: u32,
        bytes: &[u8],
    ) -> Result<(), TriplicatedSealedFlashError<F::Error>> {
        let (words, []) = bytes.as_chunks() else {
            return Err(TriplicatedSealedFlashError::OutOfBounds);
        };
        for (word, at) in words.iter().zip((address..).step_by(FLASH_BYTES_PER_DATA_WORD)) {
            let copies: [[u8; WORD_BYTES]; COPIES_PER_WORD] = [*word; COPIES_PER_WORD];
            self.0.write(at, copies.as_flattened()).map_err(TriplicatedSealedFlashError::Flash)?;
        }
        Ok(())
    }

    #[inline(never)]
    fn is_sealed(&mut self, start: u32) -> Result<bool, TriplicatedSealedFlashError<F::Error>> {
        let mut seal = [0; COMPLETE_ERASURE_SEAL.len()];
        self.read_words_by_bit_majority(start, &mut seal)?;
        Ok(seal == COMPLETE_ERASURE_SEAL)
    }

    /// Erases the flash sector at `start`, checks that it is blank, and seals it. Even a sector that reads as blank is
    /// erased: bits that an interrupted erasure left half-erased may read as erased now and not later.
    #[inline(never)]
    fn erase_and_seal(&mut self, start: u32) -> Result<(), TriplicatedSealedFlashError<F::Error>> {
        let end = start + F::ERASE_SIZE as u32;
        self.0.erase(start, end).map_err(TriplicatedSealedFlashError::Flash)?;
        for at in (start..end).step_by(BLANK_CHECK_CHUNK_BYTES) {
            let mut read = [0; BLANK_CHECK_CHUNK_BYTES];
            self.0.read(at, &mut read).map_err(TriplicatedSealedFlashError::Flash)?;
            if read != [ERASED_BYTE; BLANK_CHECK_CHUNK_BYTES] {
                return Err(TriplicatedSealedFlashError::NotErased);
            }
        }
        self.program_words_in_triplicate(start, &COMPLETE_ERASURE_SEAL)
    }
}

impl<F: BlockingNorFlash> ErrorType for TriplicatedSealedFlash<F> {
    type Error = TriplicatedSealedFlashError<F::Error>;
}

impl<F: BlockingNorFlash> ReadNorFlash for TriplicatedSealedFlash<F> {
    const READ_SIZE: usize = WORD_BYTES;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        let (start, address) = self.checked_sector_and_word_addresses(offset, bytes.len())?;
        if self.is_sealed(start)? {
            return self.read_words_by_bit_majority(address, bytes);
        }
        bytes.fill(ERASED_BYTE);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.capacity() / F::ERASE_SIZE * Self::DATA_BYTES_PER_SECTOR
    }
}

impl<F: BlockingNorFlash> NorFlash for TriplicatedSealedFlash<F> {
    const WRITE_SIZE: usize = WORD_BYTES;
    const ERASE_SIZE: usize = Self::DATA_BYTES_PER_SECTOR;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        for offset in (from..to).step_by(Self::DATA_BYTES_PER_SECTOR) {
            let (start, _) = self.checked_sector_and_word_addresses(offset, 0)?;
            if self.is_sealed(start)? {
                self.program_words_in_triplicate(start, &BROKEN_SEAL_WORD)?;
            }
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        let (start, address) = self.checked_sector_and_word_addresses(offset, bytes.len())?;
        if !self.is_sealed(start)? {
            self.erase_and_seal(start)?;
        }
        self.program_words_in_triplicate(address, bytes)
    }
}
