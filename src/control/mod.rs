//! Set-point to current, and current to bridge voltage.

mod pi;
mod voltage;

pub use pi::{Period, Pi};
pub use voltage::Voltage;

use contact_model::fixed_point::Celsius;

use crate::drive::Current;
use crate::guard::Setpoint;
use crate::settings::{Gains, Settings, Tile};

/// Which law finds the current.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Law {
    /// Proportional-integral, ten times a second, as the thesis's display.
    Pi10Hz,
    /// Proportional-integral, every tick.
    #[default]
    Pi,
}

impl Law {
    /// All of them, by their words in the protocol.
    pub const WORDS: [(&'static str, Self); 2] = [("pi-10hz", Self::Pi10Hz), ("pi", Self::Pi)];

    /// Its word in the protocol.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pi10Hz => "pi-10hz",
            Self::Pi => "pi",
        }
    }
}

/// The law in use.
#[derive(Clone, Debug)]
pub struct Control {
    law: Law,
    pi_10hz: Pi,
    pi: Pi,
}

impl Control {
    /// At rest; `f64`, once.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let limit_a = settings.module.current_limit_a;
        Self {
            law: Law::default(),
            pi_10hz: Pi::new(&settings.gains_10hz, limit_a, Period::TenthOfASecond),
            pi: Pi::new(&settings.gains, limit_a, Period::EveryTick),
        }
    }

    /// Controls another tile, from rest.
    pub fn retune(&mut self, tile: &Tile) {
        let limit_a = self.limit().to_num();
        let [gains, gains_10hz] = Gains::of_tile(tile);
        self.pi = Pi::new(&gains, limit_a, Period::EveryTick);
        self.pi_10hz = Pi::new(&gains_10hz, limit_a, Period::TenthOfASecond);
    }

    /// The law in use.
    #[must_use]
    pub const fn law(&self) -> Law {
        self.law
    }

    /// Uses another law, from rest.
    pub fn select(&mut self, law: Law) {
        if law != self.law {
            self.law = law;
            self.reset();
        }
    }

    /// The largest current that [`Self::update`] returns.
    #[must_use]
    pub const fn limit(&self) -> Current {
        self.pi.limit()
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        self.pi_10hz.reset();
        self.pi.reset();
    }

    /// Current for one tick; positive cools.
    pub fn update(&mut self, setpoint: Setpoint, display: Celsius) -> Current {
        match self.law {
            Law::Pi10Hz => self.pi_10hz.update(setpoint, display),
            Law::Pi => self.pi.update(setpoint, display),
        }
    }
}
