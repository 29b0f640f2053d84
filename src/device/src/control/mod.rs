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

/// For each kelvin of the sink above [`COOLING_REDUCED_FROM`] the law `model` reduces the limit of the cooling current
/// by one half (this power of two) of the whole.
const COOLING_REDUCTION_SHIFT: u32 = 1;

/// Control law that chooses the module's current from the reference and the readings; selected by the host's command
/// `law`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Law {
    /// Proportional-integral control of the display's reading, ten times a second, as the display of the thesis.
    Pi10Hz,
    /// Proportional-integral control of the display's reading, at every tick of 1 ms.
    Pi,
    /// Feed-forward by the internal model of plate and finger, with a disturbance observer; it also corrects the skin's
    /// temperature. The default.
    #[default]
    Model,
}

impl Law {
    /// All laws, each with its word on the line to the host.
    pub const PROTOCOL_WORDS: [(&'static str, Self); 3] = [
        ("pi-10hz", Self::Pi10Hz),
        ("pi", Self::Pi),
        ("model", Self::Model),
    ];

    /// The law's word on the line to the host, as in [`Self::PROTOCOL_WORDS`].
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pi10Hz => "pi-10hz",
            Self::Pi => "pi",
            Self::Model => "model",
        }
    }
}

/// The controller of one finger's display: the selected law, and the states of both proportional-integral laws, which
/// start from the present current when their law is selected.
#[derive(Clone, Debug)]
pub struct Controller {
    law: Law,
    /// The law `pi-10hz`.
    pi_10hz: Pi,
    /// The law `pi`.
    pi: Pi,
    /// Current of the last tick, A; positive cools.
    current: Current,
}

impl Controller {
    /// A controller with the default law `model` and no current; no law ever chooses more than `limit`, A, in
    /// magnitude.
    #[must_use]
    pub fn new(parameters: &ControlParameters, limit: Current) -> Self {
        Self {
            law: Law::default(),
            pi_10hz: Pi::new(parameters.pi_10hz, limit),
            pi: Pi::new(parameters.pi, limit),
            current: Current::ZERO,
        }
    }

    /// Takes the gains of another tile, after the host has stored a new identification; the integral parts of the
    /// currents stay. The plate's observer takes its own constants.
    pub fn set_parameters(&mut self, parameters: &ControlParameters) {
        self.pi.set_coefficients(parameters.pi);
        self.pi_10hz.set_coefficients(parameters.pi_10hz);
    }

    /// The law that chooses the current.
    #[must_use]
    pub const fn law(&self) -> Law {
        self.law
    }

    /// Selects another law. The proportional-integral laws start from the present current (bumpless transfer), the law
    /// `model` from the observer, which has followed that current. The law in use, selected again, continues
    /// undisturbed.
    pub fn select_law(&mut self, law: Law) {
        if law != self.law {
            self.law = law;
            self.track_current(self.current);
        }
    }

    /// Largest magnitude, A, of the current that [`Self::choose_current`] returns.
    #[must_use]
    pub const fn current_limit(&self) -> Current {
        self.pi.output_limit()
    }

    /// Takes the current, A, of a tick in which the self-test or an identification has chosen it, or in which the
    /// bridge is off, so that the laws start from there.
    pub fn track_current(&mut self, current: Current) {
        self.current = current;
        self.pi_10hz.track_current(current);
        self.pi.track_current(current);
    }

    /// Chooses the current of this tick, A (positive cools), by the selected law. `display` and `sink` are this tick's
    /// readings, °C, by which the observer `plate` has already been corrected.
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

    /// Largest cooling current of the law `model`, A, at this temperature of the sink, °C. It falls to zero over 2 K
    /// above [`COOLING_REDUCED_FROM`], because there more current would warm the sink more than cool the display.
    fn cooling_limit(&self, sink: Celsius) -> Current {
        let excess =
            sink.saturating_sub(COOLING_REDUCED_FROM).max(Celsius::ZERO) >> COOLING_REDUCTION_SHIFT;
        let part = Celsius::ONE.saturating_sub(excess).max(Celsius::ZERO);
        product(self.current_limit(), part)
    }
}
