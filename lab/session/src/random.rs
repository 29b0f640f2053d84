//! Random numbers of a plan. A plan must not change with the version of a library, so only the generator, whose numbers its
//! definition fixes, is a library's.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};

/// A stream of random numbers for one purpose: drawing more for one purpose changes no other.
pub(crate) struct Stream(Xoshiro256PlusPlus);

impl Stream {
    /// The stream of a seed and a purpose. The generator's seed is the FNV-1a hash of both, which the generator expands with
    /// SplitMix64.
    pub fn new(seed: u64, purpose: &str) -> Self {
        let bytes = seed.to_le_bytes();
        let hash = (bytes.iter().chain(purpose.as_bytes()))
            .fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
                (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
            });
        Self(Xoshiro256PlusPlus::seed_from_u64(hash))
    }

    /// A number below `count`, each equally likely (Lemire's multiplication with rejection); 0 if `count` is 0.
    pub fn below(&mut self, count: usize) -> usize {
        let Some(rejected) = (count as u64).wrapping_neg().checked_rem(count as u64) else {
            return 0;
        };
        loop {
            let product = u128::from(self.0.next_u64()) * count as u128;
            if product as u64 >= rejected {
                return (product >> 64) as usize;
            }
        }
    }

    /// Brings them into a random order (Fisher-Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}
