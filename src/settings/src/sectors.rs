//! Flash sectors whose erasure is all or nothing, and in which any one bit of a word may turn.
//!
//! A word is stored three times in a row, and each of its bits reads as most of its copies do: a bit that turns over the
//! years would else end the records before its own, and an older one would count. So a word is also there as a whole or
//! not at all, whenever power fails.
//!
//! Power that fails while a sector is being erased leaves bits that are anything: old records can still be there and be
//! taken for the newest. So a sector counts only as long as it begins with a seal. The seal is broken, which is the
//! programming of one word, before anything is erased; a sector without it reads as erased, and is erased when it is
//! next written to.
//!
//! ```text
//! sealed:   [seal, 2 x 3 words][data, 3 words each]        unsealed: reads as erased
//! erase     -> break the seal
//! write     -> if unsealed: erase, look whether it is, seal; then write
//! ```

use core::fmt;

use embedded_storage::nor_flash::NorFlash as Blocking;
use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

/// Bytes that are programmed at a time.
const WORD: usize = 4;
/// How often each is stored.
const COPIES: usize = 3;
/// Bytes that a word takes.
const CELL: usize = COPIES * WORD;
/// Begins a sector that counts. Neither nothing, nor zeros, nor few bits away from them.
const SEAL: [u8; 2 * WORD] = *b"settings";
/// Makes any seal another one: programming can only clear bits.
const BROKEN: [u8; WORD] = [0; WORD];
const ERASED: u8 = 0xff;
/// Bytes that are compared at a time.
const LOOK: usize = 32;

/// Equal sectors of a flash, each a third as long, less its seal.
#[derive(Debug)]
pub struct Sectors<F>(F);

/// Why an access failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorError<E> {
    /// The flash says so.
    Flash(E),
    /// The sector was erased, and is not.
    NotErased,
    /// An address outside of the sectors, or from one into the next, or no whole words.
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
    /// Bytes that a sector holds.
    pub const BYTES: usize = F::ERASE_SIZE / CELL * WORD - SEAL.len();

    /// The sectors of this flash.
    pub const fn new(flash: F) -> Self {
        const { assert!(F::READ_SIZE <= WORD && F::WRITE_SIZE <= WORD) };
        Self(flash)
    }

    /// Address of a sector, and of what lies there in the flash.
    fn place(&self, offset: u32, bytes: usize) -> Result<(u32, u32), SectorError<F::Error>> {
        let (sector, within) = (offset as usize / Self::BYTES, offset as usize % Self::BYTES);
        let start = sector * F::ERASE_SIZE;
        let fits = within.is_multiple_of(WORD)
            && within + bytes <= Self::BYTES
            && start + F::ERASE_SIZE <= self.0.capacity();
        if fits {
            let before = (SEAL.len() + within) / WORD * CELL;
            Ok((start as u32, (start + before) as u32))
        } else {
            Err(SectorError::OutOfBounds)
        }
    }

    /// What most copies say.
    fn vote(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), SectorError<F::Error>> {
        for (word, at) in bytes.chunks_mut(WORD).zip((address..).step_by(CELL)) {
            let mut copies = [[0; WORD]; COPIES];
            self.0
                .read(at, copies.as_flattened_mut())
                .map_err(SectorError::Flash)?;
            let [first, second, third] = copies.map(u32::from_ne_bytes);
            let most = first & second | second & third | third & first;
            word.iter_mut()
                .zip(most.to_ne_bytes())
                .for_each(|(byte, voted)| *byte = voted);
        }
        Ok(())
    }

    fn program(&mut self, address: u32, bytes: &[u8]) -> Result<(), SectorError<F::Error>> {
        let (words, []) = bytes.as_chunks() else {
            return Err(SectorError::OutOfBounds);
        };
        for (word, at) in words.iter().zip((address..).step_by(CELL)) {
            let copies: [[u8; WORD]; COPIES] = [*word; COPIES];
            self.0
                .write(at, copies.as_flattened())
                .map_err(SectorError::Flash)?;
        }
        Ok(())
    }

    #[inline(never)]
    fn is_sealed(&mut self, start: u32) -> Result<bool, SectorError<F::Error>> {
        let mut seal = [0; SEAL.len()];
        self.vote(start, &mut seal)?;
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
        self.program(start, &SEAL)
    }
}

impl<F: Blocking> ErrorType for Sectors<F> {
    type Error = SectorError<F::Error>;
}

impl<F: Blocking> ReadNorFlash for Sectors<F> {
    const READ_SIZE: usize = WORD;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        let (start, address) = self.place(offset, bytes.len())?;
        if self.is_sealed(start)? {
            return self.vote(address, bytes);
        }
        bytes.fill(ERASED);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.capacity() / F::ERASE_SIZE * Self::BYTES
    }
}

impl<F: Blocking> NorFlash for Sectors<F> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = Self::BYTES;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        for offset in (from..to).step_by(Self::BYTES) {
            let (start, _) = self.place(offset, 0)?;
            if self.is_sealed(start)? {
                self.program(start, &BROKEN)?;
            }
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        let (start, address) = self.place(offset, bytes.len())?;
        if !self.is_sealed(start)? {
            self.prepare(start)?;
        }
        self.program(address, bytes)
    }
}
