//! Set-point to current, and current to bridge voltage.

mod lag;
mod pi;
mod plate;
mod tuned;
mod two_degrees;
mod voltage;

pub use pi::{Period, Pi, Response};
pub use plate::Watt;
pub use tuned::Tuned;
use two_degrees::TwoDegrees;
pub use voltage::{Legs, Voltage};

use contact_model::fixed_point::Celsius;

use crate::drive::Current;
use crate::safety::Setpoint;
use thermal_settings::Settings;

/// Which law finds the current.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Law {
    /// Proportional-integral, ten times a second, as the thesis's display.
    Pi10Hz,
    /// Proportional-integral, every tick.
    Pi,
    /// With a model of plate and finger beside the loop.
    #[default]
    Model,
}

impl Law {
    /// All of them, by their words in the protocol.
    pub const WORDS: [(&'static str, Self); 3] = [
        ("pi-10hz", Self::Pi10Hz),
        ("pi", Self::Pi),
        ("model", Self::Model),
    ];

    /// Its word in the protocol.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pi10Hz => "pi-10hz",
            Self::Pi => "pi",
            Self::Model => "model",
        }
    }
}

/// The law in use.
#[derive(Clone, Debug)]
pub struct Control {
    law: Law,
    pi_10hz: Pi,
    pi: Pi,
    two_degrees: TwoDegrees,
    /// Reading of this tick.
    display: Celsius,
    /// Current of the last tick.
    last: Current,
}

impl Control {
    /// At rest; `f64`, once.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let tuned = Tuned::new(settings);
        let limit = Current::saturating_from_num(settings.module.current_limit_a);
        Self {
            law: Law::default(),
            pi_10hz: Pi::new(tuned.pi_10hz, limit),
            pi: Pi::new(tuned.pi, limit),
            two_degrees: TwoDegrees::new(tuned, limit),
            display: Celsius::ZERO,
            last: Current::ZERO,
        }
    }

    /// Controls another tile; goes on from where it is.
    pub fn retune(&mut self, tuned: &Tuned) {
        self.pi.retune(tuned.pi);
        self.pi_10hz.retune(tuned.pi_10hz);
        self.two_degrees.retune(tuned);
    }

    /// The law in use.
    #[must_use]
    pub const fn law(&self) -> Law {
        self.law
    }

    /// Uses another law, which goes on with the current that flows.
    pub fn select(&mut self, law: Law) {
        if law != self.law {
            self.law = law;
            self.restart_loops();
        }
    }

    /// The largest current that [`Self::update`] returns.
    #[must_use]
    pub const fn limit(&self) -> Current {
        self.pi.limit()
    }

    /// The reading is to be of another scale.
    pub const fn rescale(&mut self) {
        self.two_degrees.rescale();
    }

    /// A tick from which nothing is known; the current is zero.
    pub fn lose_sight(&mut self) {
        self.two_degrees.lose_sight();
    }

    /// Takes a tick's reading of the display, the sink, and the heat from the finger into the display.
    pub fn observe(&mut self, display: Celsius, sink: Celsius, finger: Watt) {
        self.display = display;
        self.two_degrees.observe(display, sink, finger);
    }

    /// Takes the current of a tick in which something else has chosen it.
    pub fn follow(&mut self, current: Current) {
        self.last = current;
        self.restart_loops();
        self.two_degrees.go_on(current);
    }

    fn restart_loops(&mut self) {
        self.pi_10hz.restart(self.last);
        self.pi.restart(self.last);
    }

    /// The display's surface, as well as model and reading know it.
    #[must_use]
    pub fn surface(&self, reading: Celsius) -> Celsius {
        self.two_degrees.surface().unwrap_or(reading)
    }

    /// Whether the model's residual is beyond that of a sound tile.
    #[must_use]
    pub fn strays(&self) -> bool {
        self.two_degrees.strays()
    }

    /// Ends and mean of the legs.
    #[must_use]
    pub fn legs(&self, display: Celsius, sink: Celsius) -> Legs {
        if self.two_degrees.surface().is_none() {
            return Legs::between(display, sink);
        }
        let plate = self.two_degrees.plate();
        Legs {
            cold: plate.surface(),
            hot: plate.hot(),
            mean: plate.legs(),
        }
    }

    /// The law's current for a tick that was [observed](Self::observe); positive cools. `target` is the set-point, and what
    /// brings the skin back to where it should be; the plain loops go by the set-point.
    pub fn update(&mut self, setpoint: Setpoint, target: Setpoint) -> Current {
        self.last = match self.law {
            Law::Pi10Hz => self.pi_10hz.update(setpoint, self.display),
            Law::Pi => self.pi.update(setpoint, self.display),
            Law::Model => self.two_degrees.wish(target.celsius()),
        };
        self.two_degrees.go_on(self.last);
        self.last
    }
}
