//! Contents of the accelerator's data cache (RM0390 3.4.2), as far as they can differ from the flash: lines of the settings. An
//! erase does not change them, so that they are stale until the program clears the cache.

/// Lines of 128 bits.
pub(super) const LINE_BYTES: usize = 16;
const LINES: usize = 8;
const DCEN: u32 = 1 << 10;
const DCRST: u32 = 1 << 12;

type Line = [u8; LINE_BYTES];

#[derive(Default)]
pub(super) struct DataCache {
    on: bool,
    /// Offset into the flash and contents, the least recently used first.
    lines: Vec<(usize, Line)>,
}

impl DataCache {
    /// Follows a store to FLASH_ACR; the cache can be cleared only while it is off (3.8.1).
    pub fn control(&mut self, acr: u32) {
        self.on = acr & DCEN != 0;
        if !self.on && acr & DCRST != 0 {
            self.lines.clear();
        }
    }

    /// The line that a load from `offset` sees.
    pub fn load(&mut self, offset: usize, flash: &[u8]) -> Line {
        let start = offset - offset % LINE_BYTES;
        let of_flash = flash.get(start..).and_then(<[u8]>::first_chunk);
        let of_flash = of_flash.copied().unwrap_or_default();
        if !self.on {
            return of_flash;
        }
        let line = match self.lines.iter().position(|(at, _)| *at == start) {
            Some(place) => self.lines.remove(place),
            None => (start, of_flash),
        };
        if self.lines.len() == LINES {
            self.lines.remove(0);
        }
        self.lines.push(line);
        line.1
    }

    /// Follows programming at `offset`, which also writes to the cache.
    pub fn update(&mut self, offset: usize, programmed: &[u8]) {
        let within = offset % LINE_BYTES;
        if let Some((_, line)) = self.lines.iter_mut().find(|(at, _)| at + within == offset) {
            for (byte, programmed) in line[within..].iter_mut().zip(programmed) {
                *byte = *programmed;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_erased_line_is_stale_until_the_cache_is_cleared_while_off() {
        let mut cache = DataCache::default();
        let [flash, erased] = [[7; 256], [0xff; 256]];
        cache.control(DCEN);
        assert_eq!(cache.load(35, &flash), [7; LINE_BYTES]);
        assert_eq!(cache.load(35, &erased), [7; LINE_BYTES], "stale");
        cache.control(DCEN | DCRST);
        assert_eq!(cache.load(35, &erased), [7; LINE_BYTES], "not while on");
        cache.control(0);
        assert_eq!(cache.load(35, &erased), [0xff; LINE_BYTES]);
        cache.control(DCEN);
        assert_eq!(cache.load(35, &erased), [7; LINE_BYTES], "off is not cleared");
        cache.control(DCRST);
        cache.control(DCEN);
        assert_eq!(cache.load(35, &erased), [0xff; LINE_BYTES]);
        cache.update(40, &[9]);
        let mut programmed = [0xff; LINE_BYTES];
        programmed[8] = 9;
        assert_eq!(cache.load(35, &erased), programmed);
    }

    #[test]
    fn the_line_used_least_recently_goes_first() {
        let mut cache = DataCache::default();
        let [old, new] = [[7; 256], [0xff; 256]];
        cache.control(DCEN);
        for line in 0..LINES {
            cache.load(line * LINE_BYTES, &old);
        }
        cache.load(0, &old);
        cache.load(LINES * LINE_BYTES, &old);
        assert_eq!(cache.load(0, &new), [7; LINE_BYTES]);
        assert_eq!(cache.load(LINE_BYTES, &new), [0xff; LINE_BYTES]);
    }
}
