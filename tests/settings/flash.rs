//! Three sectors of the emulated flash without a microcontroller.

use std::cell::RefCell;
use std::rc::Rc;

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use hil_sim::machine::Cells;

pub const SECTOR: usize = 16 * 1024;
pub const BYTES: usize = 3 * SECTOR;

/// Shared, so that cells outlive the store.
#[derive(Clone, Debug)]
pub struct Flash(Rc<RefCell<Cells>>);

/// Power is gone.
#[derive(Debug)]
pub struct Dead;

impl NorFlashError for Dead {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl Flash {
    pub fn new(cells: Cells) -> Self {
        Self(Rc::new(RefCell::new(cells)))
    }

    /// As they are now.
    pub fn cells(&self) -> Cells {
        self.0.borrow().clone()
    }

    fn alive(&self) -> Result<(), Dead> {
        self.0.borrow().is_powered().then_some(()).ok_or(Dead)
    }
}

impl ErrorType for Flash {
    type Error = Dead;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Dead> {
        self.alive()?;
        let from = offset as usize;
        bytes.copy_from_slice(&self.0.borrow().bytes()[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        BYTES
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Dead> {
        for sector in (from as usize..to as usize).step_by(SECTOR) {
            self.0.borrow_mut().erase(sector..sector + SECTOR);
            self.alive()?;
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Dead> {
        assert!(
            offset.is_multiple_of(4) && bytes.len().is_multiple_of(4),
            "whole words"
        );
        for (word, at) in bytes.chunks(4).zip((offset as usize..).step_by(4)) {
            self.0.borrow_mut().program(at, word);
            self.alive()?;
        }
        Ok(())
    }
}
