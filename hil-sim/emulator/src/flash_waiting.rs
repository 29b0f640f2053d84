//! Waiting of the core for the flash (RM0390 3.3.3 and 3.4.2): wait states, prefetch, and the two caches of the accelerator, as
//! FLASH_ACR sets them. Lines have 128 bits. Of data accesses only loads of constants beside the code are modelled, at most
//! one line for each block.
//!
//! The line that the core needs next in order is prefetched while it executes the line before. A line that is neither there nor
//! in the instruction cache takes the wait states and goes to the cache; a prefetched line does not.

use super::elf::{FLASH_BASE, FLASH_SIZE, RAM_BASE};
use thermal_sim::processor::FlashTiming;

const LINE_BYTES: u32 = 16;
/// Behind the last line.
const NO_LINE: u32 = FLASH_SIZE / LINE_BYTES;
const LATENCY: u32 = 0xf;
const PRFTEN: u32 = 1 << 8;
const ICEN: u32 = 1 << 9;
const DCEN: u32 = 1 << 10;
const ICRST: u32 = 1 << 11;
const DCRST: u32 = 1 << 12;

/// Lines of a cache, of which the least recently used is replaced.
struct Cache<const LINES: usize> {
    line: [u32; LINES],
    /// Count of uses at the last use.
    used: [u64; LINES],
    uses: u64,
    /// Place of each line of the flash that is in the cache.
    places: Vec<Option<u8>>,
}

impl<const LINES: usize> Cache<LINES> {
    fn new() -> Self {
        Self {
            line: [0; LINES],
            used: [0; LINES],
            uses: 0,
            places: vec![None; (FLASH_SIZE / LINE_BYTES) as usize],
        }
    }

    fn clear(&mut self) {
        self.used.fill(0);
        self.places.fill(None);
    }

    /// Whether a line is there; it is then the most recently used.
    fn use_line(&mut self, line: u32) -> bool {
        let Some(place) = self.places[line as usize] else {
            return false;
        };
        self.uses += 1;
        self.used[usize::from(place)] = self.uses;
        true
    }

    fn insert(&mut self, line: u32) {
        let oldest = self.used.iter().enumerate().min_by_key(|(_, used)| **used);
        let place = oldest.map_or(0, |(place, _)| place);
        if self.used[place] > 0 {
            self.places[self.line[place] as usize] = None;
        }
        self.uses += 1;
        (self.line[place], self.used[place]) = (line, self.uses);
        self.places[line as usize] = Some(place as u8);
    }
}

/// The interface between the flash and the core.
pub(crate) struct FlashWaiting {
    timing: FlashTiming,
    acr: u32,
    instructions: Cache<64>,
    data: Cache<8>,
    /// The line that the core executes, and since when.
    line: u32,
    since: u64,
}

impl FlashWaiting {
    pub fn new(timing: FlashTiming) -> Self {
        Self {
            timing,
            acr: 0,
            instructions: Cache::new(),
            data: Cache::new(),
            line: NO_LINE,
            since: 0,
        }
    }

    /// Follows a store to FLASH_ACR. A cache can be cleared only while it is off (3.8.1).
    pub fn control(&mut self, acr: u32) {
        self.acr = match self.timing {
            FlashTiming::Ideal => 0,
            FlashTiming::Accelerated => acr,
            FlashTiming::Unaccelerated => acr & LATENCY,
        };
        if acr & (ICRST | ICEN) == ICRST {
            self.instructions.clear();
        }
        if acr & (DCRST | DCEN) == DCRST {
            self.data.clear();
        }
    }

    /// Cycles that the core waits in a block of code that begins at `now`, without waiting, and takes `cycles`. `constants` is
    /// the line of its constants.
    #[inline]
    pub fn block(&mut self, now: u64, code: (u32, u16), cycles: u16, constants: u16) -> u64 {
        if self.acr & LATENCY == 0 {
            return 0;
        }
        let (address, bytes) = (code.0, u32::from(code.1));
        let offset = address & !FLASH_BASE;
        let (first, last) = (offset / LINE_BYTES, (offset + bytes - 1) / LINE_BYTES);
        if (first == self.line && last == first && constants == 0) || address >= RAM_BASE {
            return 0;
        }
        self.fetch_lines(now, code, cycles, constants)
    }

    /// As [`Self::block`], for a block that is not all in the line that the core executes.
    fn fetch_lines(&mut self, now: u64, code: (u32, u16), cycles: u16, constants: u16) -> u64 {
        let (address, bytes) = (code.0, u32::from(code.1));
        let offset = address & !FLASH_BASE;
        let (first, last) = (offset / LINE_BYTES, (offset + bytes - 1) / LINE_BYTES);
        let mut waiting = 0;
        for line in first..=last {
            if line != self.line {
                let before = (line * LINE_BYTES).saturating_sub(offset);
                let ran = u64::from(before * u32::from(cycles) / bytes);
                waiting += self.fetch(line, now + waiting + ran);
            }
        }
        if constants > 0 {
            waiting += self.load(constants.into());
        }
        waiting
    }

    fn wait_states(&self) -> u64 {
        u64::from(self.acr & LATENCY)
    }

    /// Goes on in another line at `now`.
    fn fetch(&mut self, line: u32, now: u64) -> u64 {
        let caches = self.acr & ICEN != 0;
        let waiting = if caches && self.instructions.use_line(line) {
            0
        } else if self.acr & PRFTEN != 0 && line == self.line + 1 {
            let all = self.wait_states();
            all.min((all + 1).saturating_sub(now - self.since))
        } else {
            if caches {
                self.instructions.insert(line);
            }
            self.wait_states()
        };
        (self.line, self.since) = (line, now + waiting);
        waiting
    }

    /// Loads data; meanwhile the prefetch waits too.
    fn load(&mut self, line: u32) -> u64 {
        let caches = self.acr & DCEN != 0;
        if caches && self.data.use_line(line) {
            return 0;
        }
        if caches {
            self.data.insert(line);
        }
        self.since += self.wait_states();
        self.wait_states()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIVE_AND_ALL: u32 = 5 | PRFTEN | ICEN | DCEN;

    /// Waiting along blocks of one cycle for each four bytes, the data of the settings excluded.
    fn waiting(timing: FlashTiming, acr: u32, blocks: &[(u32, u16)]) -> u64 {
        let mut flash = FlashWaiting::new(timing);
        flash.control(acr);
        let mut now = 0;
        let mut sum = 0;
        for &(address, bytes) in blocks {
            let waited = flash.block(now, (address, bytes), bytes / 4, 0);
            now += waited + u64::from(bytes / 4);
            sum += waited;
        }
        sum
    }

    #[test]
    fn straight_code_waits_for_what_the_prefetch_leaves_of_a_read() {
        let ten_lines = [(FLASH_BASE, 160)];
        let with = |acr| waiting(FlashTiming::Accelerated, acr, &ten_lines);
        // A read takes six cycles, four instructions take four of them.
        assert_eq!(with(FIVE_AND_ALL), 5 + 9 * 2);
        assert_eq!(with(3 | PRFTEN), 3, "three wait states are hidden (3.4.2)");
        assert_eq!(with(5 | ICEN), 10 * 5);
        assert_eq!(with(FIVE_AND_ALL & !LATENCY), 0);
    }

    #[test]
    fn the_instruction_cache_keeps_the_64_lines_used_last() {
        let far = |lines: u32| (0..lines).map(|i| (FLASH_BASE + 64 * i, 16));
        let rounds = |lines: u32| far(lines).chain(far(lines)).collect::<Vec<_>>();
        let with = |acr, lines| waiting(FlashTiming::Accelerated, acr, &rounds(lines));
        assert_eq!(with(FIVE_AND_ALL, 64), 64 * 5);
        assert_eq!(with(FIVE_AND_ALL, 65), 2 * 65 * 5, "the oldest goes first");
        assert_eq!(with(FIVE_AND_ALL & !ICEN, 64), 2 * 64 * 5);
        let off = waiting(FlashTiming::Unaccelerated, FIVE_AND_ALL, &rounds(64));
        assert_eq!(off, 2 * 64 * 5);
        assert_eq!(waiting(FlashTiming::Ideal, FIVE_AND_ALL, &rounds(64)), 0);
    }

    #[test]
    fn constants_wait_unless_the_data_cache_has_their_line_and_clearing_needs_it_off() {
        let mut flash = FlashWaiting::new(FlashTiming::Accelerated);
        let mut load = |acr: Option<u32>, line| {
            if let Some(acr) = acr {
                flash.control(acr);
            }
            flash.block(0, (FLASH_BASE, 4), 1, line)
        };
        load(Some(FIVE_AND_ALL), 900);
        assert_eq!(load(None, 900), 0);
        assert_eq!((901..908).map(|line| load(None, line)).sum::<u64>(), 7 * 5);
        assert_eq!(load(None, 900), 0, "eight lines");
        assert_eq!(load(None, 908) + load(None, 901), 10, "901 was the oldest");
        assert_eq!(load(Some(FIVE_AND_ALL | DCRST), 900), 0, "not while it is on");
        assert_eq!(load(Some(FIVE_AND_ALL & !DCEN | DCRST), 900), 5);
        assert_eq!(load(Some(FIVE_AND_ALL), 900), 5);
    }
}
