//! Control laws, which choose the current from reference and estimates, and the bridge voltage for that current.

mod parameters;
mod voltage_feedforward;

pub use parameters::ControlParameters;
pub use voltage_feedforward::VoltageFeedforward;

use contact_model::fixed_point::{Celsius, product};
use thermal_settings::vocabulary;

use crate::drive::Current;
use crate::estimate::PlateObserver;
use crate::pi::Pi;
use crate::reference::Reference;
use crate::safety::limits::COOLING_DERATING_SINK_TEMPERATURE;

/// Slope by which the law `model` reduces its largest cooling current while the sink is above [`COOLING_DERATING_SINK_TEMPERATURE`]
/// (39.5 °C): by 1/2 (2^-1, this power of two) of the current limit per kelvin, so to zero at 41.5 °C.
const COOLING_LIMIT_FRACTION_LOST_PER_K_SHIFT: u32 = 1;

/// A plain law takes over once the display's reading and its estimated surface have stayed this near to the set-point, K, and the
/// current this near to its value, A, for so many ticks: it goes on from the current. One that answers a landing would take a display
/// with a slow thermistor by 5 K beyond its set-point; and while the surface passes a reading that lags, the current is steady at its
/// limit.
const TAKE_OVER_WITHIN: Celsius = Celsius::lit("0.5");
const TAKE_OVER_CURRENT_WITHIN: Current = Current::lit("0.5");
const TAKE_OVER_TICKS: u16 = 256;

vocabulary! {
    /// Control law that chooses the module's current from the reference and the readings of the display's thermistor;
    /// selected by the host's command `law`.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Law: "law" {
        /// Proportional-integral control of the reading of the display's thermistor to the set-point, updated ten times a
        /// second, as in the display of the thesis on which this project is based.
        Pi10Hz = "pi-10hz",
        /// Proportional-integral control of the reading of the display's thermistor to the set-point, updated at every tick
        /// of 1 ms.
        Pi = "pi",
        /// Feed-forward: computes the current that brings the surface of the internal plate model to the target in 12 ms,
        /// including the finger's estimated heat. A disturbance observer corrects the model by the display's reading.
        /// During contact the target contains a correction that brings the skin on the display to the temperature that it
        /// would have on the object; the other laws have no such correction. This law is the default.
        #[default]
        Model = "model",
    }
}

/// Controller of one finger's display: the selected law, and the states of the two proportional-integral laws, which
/// start from the present current when they are selected.
#[derive(Clone, Debug)]
pub struct Controller {
    law: Law,
    /// The law that the host has chosen, if it has not taken over yet.
    next_law: Option<NextLaw>,
    pi_10hz: Pi,
    pi: Pi,
    /// Current of the last tick, A (positive cools), chosen by the law or set by [`Self::track_current`]. A
    /// proportional-integral law that is newly selected starts from it.
    current: Current,
}

/// A plain law that waits for its turn.
#[derive(Clone, Copy, Debug)]
struct NextLaw {
    law: Law,
    /// Ticks for which the display has been near its set-point, and the current near `from`, A.
    ticks: u16,
    from: Current,
}

impl Controller {
    /// A controller with the default law `model` and no current, 0 A. No law ever chooses a current of more than
    /// `limit`, A, in magnitude.
    pub fn new(parameters: &ControlParameters, limit: Current) -> Self {
        Self {
            law: Law::default(),
            next_law: None,
            pi_10hz: Pi::new(parameters.pi_10hz, limit),
            pi: Pi::new(parameters.pi, limit),
            current: Current::ZERO,
        }
    }

    /// Replaces the gains of the two proportional-integral laws: at the start by those of the settings in flash, later
    /// when the host sets a new tile (commands `tune result`, `set tile`). The integral parts of the currents stay. The
    /// plate's observer must be given its own constants separately ([`PlateObserver::set_parameters`]).
    pub fn set_pi_gains(&mut self, parameters: &ControlParameters) {
        self.pi.set_coefficients(parameters.pi);
        self.pi_10hz.set_coefficients(parameters.pi_10hz);
    }

    /// The law that chooses the current.
    pub const fn law(&self) -> Law {
        self.law
    }

    /// The law that was selected last, which may have to take over yet.
    pub fn selected_law(&self) -> Law {
        self.next_law.map_or(self.law, |next| next.law)
    }

    /// Selects `law`. The law `model` takes over at once, because it continues from the observer, which follows the current
    /// under every law. A proportional-integral law starts from the present current, and one that moves a display which is on its
    /// way would take it beyond its set-point: such a law takes over when the display has come near its set-point and the current
    /// is steady, or when no law chooses the current.
    pub fn select_law(&mut self, law: Law) {
        self.next_law = None;
        match law {
            Law::Model => self.law = law,
            Law::Pi | Law::Pi10Hz if law != self.law => {
                self.next_law = Some(NextLaw { law, ticks: 0, from: self.current });
            }
            Law::Pi | Law::Pi10Hz => {}
        }
    }

    /// Takes the selected law over if the display, whose reading and estimated surface are given, has been near its set-point for some
    /// time, with a steady current.
    #[cold]
    #[inline(never)]
    fn take_over_if_settled(
        &mut self,
        reference: &Reference,
        display: Celsius,
        surface: Option<Celsius>,
    ) {
        let Some(next) = &mut self.next_law else {
            return;
        };
        let setpoint = reference.setpoint.celsius();
        let is_within = |celsius: Celsius| setpoint.abs_diff(celsius) <= TAKE_OVER_WITHIN;
        let is_near = is_within(display) && surface.is_none_or(is_within);
        if is_near && self.current.abs_diff(next.from) <= TAKE_OVER_CURRENT_WITHIN {
            next.ticks = next.ticks.saturating_add(1);
        } else {
            *next = NextLaw { ticks: 0, from: self.current, ..*next };
        }
        if next.ticks >= TAKE_OVER_TICKS {
            self.track_current(self.current);
        }
    }

    /// Largest magnitude, A, of the current that [`Self::choose_current`] returns: the `limit` that [`Self::new`] has
    /// received from the settings.
    pub const fn current_limit(&self) -> Current {
        self.pi.output_limit()
    }

    /// Sets the present current, A (positive cools), in a tick in which no law has chosen it: during the self-test or
    /// an identification, or while the bridge is off (0 A). The two proportional-integral laws continue from this
    /// current (bumpless transfer); the law `model` continues from the observer instead.
    pub fn track_current(&mut self, current: Current) {
        self.current = current;
        if let Some(next) = self.next_law.take() {
            self.law = next.law;
        }
        self.pi_10hz.track_current(current);
        self.pi.track_current(current);
    }

    /// Chooses the current of this tick, A (positive cools), by the selected law, within the current limit. The law
    /// `model` brings the display to the target of `reference`, the other laws bring it to the set-point. `display` and
    /// `sink` are this tick's readings, °C; the observer `plate` must already have been corrected by them.
    pub fn choose_current(
        &mut self,
        reference: &Reference,
        display: Celsius,
        sink: Celsius,
        plate: &PlateObserver,
    ) -> Current {
        if self.next_law.is_some() {
            self.take_over_if_settled(reference, display, plate.surface());
        }
        self.current = match self.law {
            Law::Pi10Hz => self.pi_10hz.update_output_when_due(reference.setpoint, display),
            Law::Pi => self.pi.update_output_when_due(reference.setpoint, display),
            Law::Model => plate
                .current_to_target(reference.target.celsius())
                .min(self.sink_derated_cooling_limit(sink))
                .max(-self.current_limit()),
        };
        self.current
    }

    /// Largest cooling current of the law `model`, A, when the sink has the temperature `sink`, °C: the current limit
    /// up to [`COOLING_DERATING_SINK_TEMPERATURE`] (39.5 °C), falling linearly to zero 2 K above it. At such temperatures more
    /// current would warm the sink more than cool the display.
    fn sink_derated_cooling_limit(&self, sink: Celsius) -> Current {
        let excess = sink.saturating_sub(COOLING_DERATING_SINK_TEMPERATURE).max(Celsius::ZERO)
            >> COOLING_LIMIT_FRACTION_LOST_PER_K_SHIFT;
        let part = Celsius::ONE.saturating_sub(excess).max(Celsius::ZERO);
        product(self.current_limit(), part)
    }
}
