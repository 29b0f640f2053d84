//! Time since landing, in control ticks.

use core::num::NonZeroU32;

/// Control ticks since landing, 1 to 2^31 - 1. Zero is excluded because `E` is 1 there without evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ticks(NonZeroU32);

impl Ticks {
    /// One tick.
    pub const ONE: Self = Self(NonZeroU32::MIN);
    /// The largest number of ticks: 24 days at 1 kHz.
    pub const MAX: Self = match Self::new(u32::MAX >> 1) {
        Some(ticks) => ticks,
        None => Self::ONE,
    };

    /// `None` for 0 and from 2^31 on.
    pub const fn new(ticks: u32) -> Option<Self> {
        match NonZeroU32::new(ticks) {
            Some(count) if ticks <= u32::MAX >> 1 => Some(Self(count)),
            _ => None,
        }
    }

    /// The number of ticks.
    pub const fn get(self) -> u32 {
        self.0.get()
    }

    /// `ticks + 1`, for `ticks` below 2^30; wraps to 1 there.
    #[inline]
    pub(super) const fn after(ticks: u32) -> Self {
        match Self::new((ticks & Self::MAX.get() >> 1) + 1) {
            Some(next) => next,
            None => Self::ONE,
        }
    }
}
