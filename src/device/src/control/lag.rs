//! A first-order lag that forgets nothing to rounding.

use contact_model::fixed_point::Celsius;

use crate::TICK_HZ;

/// The part of the way that a lag goes in one tick, 2^-32; below one half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share(i32);

impl Share {
    /// Of a time constant, s: `1 - exp(-dt / lag)`, exact for a held input; a lag below 1.45 ticks counts as that. `f64`.
    #[must_use]
    pub fn of(lag_s: f64) -> Self {
        let share = 1.0 - libm::exp(-1.0 / (lag_s * f64::from(TICK_HZ)));
        Self(libm::ldexp(share.clamp(0.0, 0.499), 32) as i32)
    }
}

/// A temperature that follows another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lag {
    share: Share,
    /// K, 54 binary places.
    state: i64,
}

impl Lag {
    /// At zero.
    #[must_use]
    pub const fn new(share: Share) -> Self {
        Self { share, state: 0 }
    }

    /// Goes on with another share.
    pub const fn retune(&mut self, share: Share) {
        self.share = share;
    }

    /// Where it is.
    #[must_use]
    pub const fn value(&self) -> Celsius {
        Celsius::from_bits((self.state >> 32) as i32)
    }

    /// Puts it somewhere.
    pub fn set(&mut self, at: Celsius) {
        self.state = i64::from(at.to_bits()) << 32;
    }

    /// Follows an input for one tick, at most 512 K a time constant. It stays between the two, so nothing overflows.
    pub fn follow(&mut self, input: Celsius) {
        let to_go = input.saturating_sub(self.value());
        self.state += i64::from(to_go.to_bits()) * i64::from(self.share.0);
    }
}
