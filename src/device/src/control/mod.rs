//! Control laws: from reference and estimate to current, and from current to bridge voltage.

mod parameters;
mod voltage_feedforward;

pub use parameters::ControlParameters;
pub use voltage_feedforward::VoltageFeedforward;

use contact_model::fixed_point::{Celsius, product};

use crate::drive::Current;
use crate::estimate::PlateObserver;
use crate::pi::Pi;
use crate::reference::Reference;
use crate::safety::limits::COOLING_REDUCED_FROM;

/// Above that sink temperature cooling is reduced by this part of its limit per K, as a power of two.
const COOLING_REDUCTION_SHIFT: u32 = 1;

/// Which law finds the current.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Law {
    /// Proportional-integral, ten times a second, as the thesis's display.
    Pi10Hz,
    /// Proportional-integral, at every tick.
    Pi,
    /// Feed-forward by the internal model of plate and finger, with a disturbance observer.
    #[default]
    Model,
}

impl Law {
    /// All laws with their words in the protocol.
    pub const PROTOCOL_WORDS: [(&'static str, Self); 3] = [
        ("pi-10hz", Self::Pi10Hz),
        ("pi", Self::Pi),
        ("model", Self::Model),
    ];

    /// The law's word in the protocol.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pi10Hz => "pi-10hz",
            Self::Pi => "pi",
            Self::Model => "model",
        }
    }
}

/// The controller: the law in use, and the state of the proportional-integral laws.
#[derive(Clone, Debug)]
pub struct Controller {
    law: Law,
    pi_10hz: Pi,
    pi: Pi,
    /// Current of the last tick.
    current: Current,
}

impl Controller {
    /// A controller with current zero, and the default law.
    #[must_use]
    pub fn new(parameters: &ControlParameters, limit: Current) -> Self {
        Self {
            law: Law::default(),
            pi_10hz: Pi::new(parameters.pi_10hz, limit),
            pi: Pi::new(parameters.pi, limit),
            current: Current::ZERO,
        }
    }

    /// Takes the parameters of another tile; the current goes on from where it is.
    pub fn set_parameters(&mut self, parameters: &ControlParameters) {
        self.pi.set_coefficients(parameters.pi);
        self.pi_10hz.set_coefficients(parameters.pi_10hz);
    }

    /// The law that chooses the current.
    #[must_use]
    pub const fn law(&self) -> Law {
        self.law
    }

    /// Uses another law, which starts from the present current (bumpless transfer).
    pub fn select_law(&mut self, law: Law) {
        if law != self.law {
            self.law = law;
            self.track_current(self.current);
        }
    }

    /// Largest current that [`Self::choose_current`] returns.
    #[must_use]
    pub const fn current_limit(&self) -> Current {
        self.pi.output_limit()
    }

    /// Takes the current of a tick in which something else has chosen it, so that the laws start from there.
    pub fn track_current(&mut self, current: Current) {
        self.current = current;
        self.pi_10hz.track_current(current);
        self.pi.track_current(current);
    }

    /// Current of this tick, A; positive cools. `plate` has been corrected by this tick's readings.
    pub fn choose_current(
        &mut self,
        reference: &Reference,
        display: Celsius,
        sink: Celsius,
        plate: &PlateObserver,
    ) -> Current {
        self.current = match self.law {
            Law::Pi10Hz => self.pi_10hz.update_output(reference.setpoint, display),
            Law::Pi => self.pi.update_output(reference.setpoint, display),
            Law::Model => plate
                .current_to_target(reference.target.celsius())
                .min(self.cooling_limit(sink))
                .max(-self.current_limit()),
        };
        self.current
    }

    /// Largest cooling current. It falls to zero over 2 K of the sink, because there more current would warm the sink more
    /// than cool the display.
    fn cooling_limit(&self, sink: Celsius) -> Current {
        let excess =
            sink.saturating_sub(COOLING_REDUCED_FROM).max(Celsius::ZERO) >> COOLING_REDUCTION_SHIFT;
        let part = Celsius::ONE.saturating_sub(excess).max(Celsius::ZERO);
        product(self.current_limit(), part)
    }
}
