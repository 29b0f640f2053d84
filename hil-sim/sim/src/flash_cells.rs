//! Flash memory cells under programming, erasing and power failures.
use std::ops::Range;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

/// Bits of a flash memory. Programming clears bits, erasing sets all bits of a range.
///
/// If power fails during an operation, a random part of it is done. Of a programmed word, some of the bits to be cleared
/// are cleared. Erasing programs all bits to 0 first: a range is left with some bits cleared, or with some of all zeros set,
/// or with some of what it had. Cells that read differently from time to time are not modelled.
#[derive(Debug, Clone)]
pub struct FlashCells {
    bytes: Vec<u8>,
    operations: u64,
    /// Number of the operation that fails, and the seed of the bits that it leaves.
    cut: Option<(u64, u64)>,
    powered: bool,
}

/// The bit that an interrupted erasure leaves, in the three ways that it can be interrupted.
const ERASURES: [fn(old: bool, drawn: bool) -> bool; 3] =
    [|old, drawn| old && drawn, |_, drawn| drawn, |old, drawn| old || drawn];

impl FlashCells {
    /// Powered cells with these contents.
    pub fn new(bytes: Vec<u8>) -> Self {
        Self { bytes, operations: 0, cut: None, powered: true }
    }

    /// Contents of the cells.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Overwrites the contents from an offset on; returns false if there are not that many cells.
    pub fn load(&mut self, offset: usize, contents: &[u8]) -> bool {
        let place =
            offset.checked_add(contents.len()).and_then(|end| self.bytes.get_mut(offset..end));
        place.map(|place| place.copy_from_slice(contents)).is_some()
    }

    /// Number of operations started: words programmed and ranges erased.
    pub fn operations(&self) -> u64 {
        self.operations
    }

    /// Makes power fail in the `nth` operation from now on (1 is the next); `seed` draws the bits that it leaves.
    pub fn cut_power_at(&mut self, nth: u64, seed: u64) {
        self.cut = Some((self.operations + nth, seed));
    }

    /// Whether the cells have power.
    pub fn is_powered(&self) -> bool {
        self.powered
    }

    /// Restores power.
    pub fn power_up(&mut self) {
        self.powered = true;
        self.cut = None;
    }

    /// Clears the bits at `offset` that are 0 in `value`; without power nothing happens.
    pub fn program(&mut self, offset: usize, value: &[u8]) {
        let completion = self.start_operation();
        let cells = self.bytes.iter_mut().skip(offset);
        match completion {
            Some(Completion::Full) => cells.zip(value).for_each(|(cell, value)| *cell &= value),
            Some(Completion::Partial(mut draw, _)) => {
                cells.zip(value).for_each(|(cell, value)| *cell &= value | draw.byte())
            }
            None => {}
        }
    }

    /// Sets all bits of a range; without power nothing happens.
    pub fn erase(&mut self, range: Range<usize>) {
        let completion = self.start_operation();
        let cells = self.bytes.iter_mut().take(range.end).skip(range.start);
        match completion {
            Some(Completion::Full) => cells.for_each(|cell| *cell = 0xff),
            Some(Completion::Partial(mut draw, way)) => cells.for_each(|cell| {
                let (old, drawn) = (*cell, draw.byte());
                *cell = (0..8).fold(0, |byte, bit| {
                    let set = way(old >> bit & 1 != 0, drawn >> bit & 1 != 0);
                    byte | u8::from(set) << bit
                });
            }),
            None => {}
        }
    }

    /// Starts an operation: how much of it is done, `None` without power.
    fn start_operation(&mut self) -> Option<Completion> {
        if !self.powered {
            return None;
        }
        self.operations += 1;
        let Some((_, seed)) = self.cut.filter(|(at, _)| *at == self.operations) else {
            return Some(Completion::Full);
        };
        self.powered = false;
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let way = ERASURES[random.random_range(0..ERASURES.len())];
        let share = random.random::<f64>();
        Some(Completion::Partial(RandomBits { random, share }, way))
    }
}

/// Part of an operation that is done.
enum Completion {
    Full,
    Partial(RandomBits, fn(bool, bool) -> bool),
}

/// Random bits, each 1 with the probability `share`.
struct RandomBits {
    random: Xoshiro256PlusPlus,
    share: f64,
}

impl RandomBits {
    fn byte(&mut self) -> u8 {
        (0..8).fold(0, |byte, bit| byte | u8::from(self.random.random_bool(self.share)) << bit)
    }
}
