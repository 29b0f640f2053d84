//! Programming and erasing of the flash (RM0390 chapter 3) in sectors 1 to 3, which hold settings and no code. ACR, on which the
//! clocks depend, is in `rcc`.

mod data_cache;

use data_cache::{DataCache, LINE_BYTES};
use thermal_sim::FlashCells;
use thermal_sim::processor::ChipState;

use super::elf::FLASH_BASE;
use super::stop::{Answer, Refusal, only};
use std::ops::Range;

/// Addresses of sectors 1 to 3 (RM0390 table 4): 16 KiB each.
pub(super) const SETTINGS: Range<u32> = FLASH_BASE + 0x4000..FLASH_BASE + 0x1_0000;
const SECTOR_BYTES: usize = 16 * 1024;

const KEYS: [u32; 2] = [0x4567_0123, 0xcdef_89ab];
const LOCK: u32 = 1 << 31;
const STRT: u32 = 1 << 16;
const MER: u32 = 1 << 2;
const SER: u32 = 1 << 1;
const PG: u32 = 1;
const BSY: u32 = 1 << 16;
const PGSERR: u32 = 1 << 7;
const PGPERR: u32 = 1 << 6;
const PGAERR: u32 = 1 << 5;
const ERRORS: u32 = 0x1f2;
/// OPTCR with the option bytes as delivered: BOR_LEV (bits 3 and 2) is 11, brown-out reset off (3.8.6).
const OPTCR_OF_THE_FACTORY: u32 = 0x0fff_aaed;

/// Times in microseconds (DS10693, flash memory programming).
struct Times {
    /// A unit of 8, 16 or 32 bits.
    program_us: u64,
    /// A sector of 16 KiB, by the same parallelism.
    erase_us: [u64; 3],
}

const TYPICAL: Times = Times { program_us: 16, erase_us: [400_000, 300_000, 250_000] };
const LONGEST: Times = Times { program_us: 100, erase_us: [800_000, 600_000, 500_000] };

/// State of the unlock sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lock {
    Locked,
    HalfWay,
    Open,
    /// A wrong key locks until reset.
    Refused,
}

pub(crate) struct Flash {
    pub cells: FlashCells,
    data_cache: DataCache,
    lock: Lock,
    control: u32,
    status: u32,
    busy_until: u64,
    times: &'static Times,
    /// BOR_LEV of the option bytes.
    brown_out_code: u8,
}

impl Flash {
    /// A flash with these contents and the option bytes of the factory, but for BOR_LEV.
    pub fn new(contents: Vec<u8>, chip: &ChipState) -> Self {
        Self {
            cells: FlashCells::new(contents),
            data_cache: DataCache::default(),
            lock: Lock::Locked,
            control: 0,
            status: 0,
            busy_until: 0,
            times: if chip.slow_flash { &LONGEST } else { &TYPICAL },
            brown_out_code: chip.brown_out_code & 3,
        }
    }

    /// Resets the registers; the contents stay.
    pub fn reset(&mut self) {
        (self.lock, self.control, self.status, self.busy_until) = (Lock::Locked, 0, 0, 0);
        self.data_cache = DataCache::default();
    }

    /// Whether the image leaves the settings' sectors blank, so that they can be modelled as writable flash.
    pub fn has_settings(flash: &[u8]) -> bool {
        let from = (SETTINGS.start - FLASH_BASE) as usize;
        let to = (SETTINGS.end - FLASH_BASE) as usize;
        flash.get(from..to).is_some_and(|gap| gap.iter().all(|byte| *byte == 0xff))
    }

    /// Cycle until which the busy flash stalls the code in it.
    pub fn busy_until(&self) -> u64 {
        self.busy_until
    }

    /// KEYR, SR, CR and OPTCR (3.8); option bytes can be read, not programmed.
    pub fn read(&self, offset: u32, now: u64) -> Answer<u32> {
        match offset {
            0x0c => Ok(self.status | if now < self.busy_until { BSY } else { 0 }),
            0x10 => Ok(self.control | if self.lock == Lock::Open { 0 } else { LOCK }),
            0x14 => Ok(OPTCR_OF_THE_FACTORY & !(3 << 2) | u32::from(self.brown_out_code) << 2),
            _ => Err(Refusal::Offset),
        }
    }

    pub fn write(&mut self, offset: u32, value: u32, now: u64, hclk_hz: u32) -> Answer<()> {
        match offset {
            0x04 => {
                self.lock = match self.lock {
                    Lock::Locked if value == KEYS[0] => Lock::HalfWay,
                    Lock::HalfWay if value == KEYS[1] => Lock::Open,
                    _ => Lock::Refused,
                };
                Ok(())
            }
            0x0c => {
                only(value, ERRORS | 1, "FLASH_SR beyond its flags")?;
                self.status &= !value;
                Ok(())
            }
            0x10 if self.lock != Lock::Open => {
                Err(Refusal::NotModelled("FLASH_CR while it is locked"))
            }
            0x10 => {
                if value & LOCK != 0 {
                    (self.lock, self.control) = (Lock::Locked, value & !(LOCK | STRT));
                    return Ok(());
                }
                only(value, STRT | 0x37b, "FLASH_CR beyond PG, SER, SNB, PSIZE, STRT and LOCK")?;
                self.control = value & !STRT;
                if value & STRT != 0 {
                    self.start(now, hclk_hz)?;
                }
                Ok(())
            }
            _ => Err(Refusal::Offset),
        }
    }

    /// Erases a sector.
    fn start(&mut self, now: u64, hclk_hz: u32) -> Answer<()> {
        if self.control & (SER | MER | PG) != SER {
            return Err(Refusal::NotModelled("FLASH_CR.STRT without SER alone"));
        }
        let sector = (self.control >> 3 & 0xf) as usize;
        let time = self.times.erase_us.get(self.parallelism());
        let (1..=3, Some(time)) = (sector, time) else {
            return Err(Refusal::NotModelled(
                "erasing other sectors than 1 to 3, or 64 bits at a time",
            ));
        };
        self.cells.erase(sector * SECTOR_BYTES..(sector + 1) * SECTOR_BYTES);
        self.extend_busy(now, *time, hclk_hz);
        Ok(())
    }

    /// Binary logarithm of the bytes programmed at a time.
    fn parallelism(&self) -> usize {
        (self.control >> 8 & 3) as usize
    }

    /// Stores to the settings' sectors.
    pub fn store(
        &mut self,
        address: u32,
        bytes: u8,
        value: u32,
        now: u64,
        hclk_hz: u32,
    ) -> Answer<()> {
        let value = &value.to_le_bytes()[..usize::from(bytes.min(4))];
        let error = if self.lock != Lock::Open || self.control & (PG | SER) != PG {
            PGSERR
        } else if value.len() != 1 << self.parallelism() {
            PGPERR
        } else if address % 16 + u32::from(bytes) > 16 {
            PGAERR
        } else {
            let at = (address - FLASH_BASE) as usize;
            self.cells.program(at, value);
            let programmed = self.cells.bytes().get(at..at + value.len());
            self.data_cache.update(at, programmed.unwrap_or_default());
            self.extend_busy(now, self.times.program_us, hclk_hz);
            return Ok(());
        };
        self.status |= error;
        Ok(())
    }

    /// Follows a store to FLASH_ACR.
    pub fn control_data_cache(&mut self, acr: u32) {
        self.data_cache.control(acr);
    }

    /// Loads from the settings' sectors, through the data cache.
    pub fn load(&mut self, address: u32, bytes: u8) -> u32 {
        let from = (address - FLASH_BASE) as usize;
        let line = self.data_cache.load(from, self.cells.bytes());
        let within = from % LINE_BYTES;
        let read = line.get(within..within + usize::from(bytes));
        read.unwrap_or_default().iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
    }

    /// Extends the busy time by an operation, which begins after the one before.
    fn extend_busy(&mut self, now: u64, us: u64, hclk_hz: u32) {
        self.busy_until = self.busy_until.max(now) + (us * u64::from(hclk_hz)).div_ceil(1_000_000);
    }
}

#[cfg(test)]
mod tests;
