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
use crate::guard::Setpoint;
use crate::settings::Settings;

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
    /// Current of the last tick.
    last: Current,
}

/// What a law goes by in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// Eq. 6-12, or where the display is held.
    pub setpoint: Setpoint,
    /// The set-point, and what brings the skin back to where it should be.
    pub target: Setpoint,
    /// Display thermistor.
    pub display: Celsius,
    /// Sink thermistor.
    pub sink: Celsius,
    /// Heat from the finger into the display.
    pub finger: Watt,
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
            self.go_on_from(self.last);
        }
    }

    /// The largest current that [`Self::update`] returns.
    #[must_use]
    pub const fn limit(&self) -> Current {
        self.pi.limit()
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        self.go_on_from(Current::ZERO);
    }

    /// Begins its model anew, if it has one, from the current that flows: the readings are others than they were.
    pub fn begin_anew(&mut self) {
        if self.law == Law::Model {
            self.go_on_from(self.last);
        }
    }

    /// Starts anew, from a current that flows.
    pub fn go_on_from(&mut self, current: Current) {
        self.last = current;
        self.pi_10hz.restart(current);
        self.pi.restart(current);
        self.two_degrees.restart(current);
    }

    /// The display's surface, as well as the law in use knows it from its reading.
    #[must_use]
    pub fn surface(&self, reading: Celsius) -> Celsius {
        self.two_degrees.surface().unwrap_or(reading)
    }

    /// Whether the law's residual is beyond that of a sound tile; a law without a model, for which it stands still, knows nothing.
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

    /// Current for one tick; positive cools.
    pub fn update(&mut self, inputs: &Inputs) -> Current {
        self.last = match self.law {
            Law::Pi10Hz => self.pi_10hz.update(inputs.setpoint, inputs.display),
            Law::Pi => self.pi.update(inputs.setpoint, inputs.display),
            Law::Model => {
                let (target, display) = (inputs.target.celsius(), inputs.display);
                self.two_degrees
                    .update(&mut self.pi, target, display, inputs.sink, inputs.finger)
            }
        };
        self.last
    }
}
