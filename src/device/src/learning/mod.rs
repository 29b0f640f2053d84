//! Learning of the finger that touches, from a sensor of the heat flux between skin and display.
//!
//! ```text
//! code of the sensor, estimates of the last tick -> sums of a window of ten ticks -> LearnerInput -> learner
//!                                                                                                     |
//!                       bodies, skin state, skin before contact <- in the last tick of the next window
//! ```
//!
//! The learner runs outside of the control path. What it has found is applied ten ticks after its input was taken, however
//! soon it was there, so that its computing time changes nothing.

mod flux_parameters;
mod flux_reading;
mod resting_code;
mod window_sums;

use contact_model::fixed_point::Celsius;
use thermal_learner::{Distrust, Flux, LearnerInput, LearnerOutput, Place, Restart, Trust};

use crate::estimate::{FluxPerMm2, filter_change};
use crate::low_pass::LowPass;
use crate::sense::CONTACT_DEBOUNCE_TICKS;
pub use flux_parameters::FluxParameters;
use flux_reading::FluxReading;
pub use resting_code::RestingCode;
use resting_code::RestingCodes;
use window_sums::WindowSums;
pub use window_sums::{StateAtEnd, TickOfContact};

/// What the host is told about the finger that is learnt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FingerKnowledge {
    /// No sensor of the heat flux is fitted: the assumed finger.
    NoSensor,
    /// The sensor reads beyond its range, or the same for too long: the assumed finger until the next contact without such codes.
    SensorFault,
    /// The learner has not answered in time: the assumed finger until this contact has ended.
    Late,
    /// What the learner says.
    Learnt(Trust),
}

impl FingerKnowledge {
    /// All with their words in the protocol. Those with a reason are on the way to the assumed finger, or there.
    pub const PROTOCOL_WORDS: [(&'static str, Self); 11] = [
        ("assumed", Self::NoSensor),
        ("learning", Self::Learnt(Trust::Learning)),
        ("trusted", Self::Learnt(Trust::Trusted)),
        ("sensor-range", Self::SensorFault),
        ("sensor", Self::Learnt(Trust::Mean(Distrust::Sensor))),
        ("between", Self::Learnt(Trust::Mean(Distrust::Between))),
        ("wet", Self::Learnt(Trust::Mean(Distrust::Wet))),
        ("contact", Self::Learnt(Trust::Mean(Distrust::Contact))),
        (
            "unexplained",
            Self::Learnt(Trust::Mean(Distrust::Unexplained)),
        ),
        (
            "arithmetic",
            Self::Learnt(Trust::Mean(Distrust::Arithmetic)),
        ),
        ("late", Self::Late),
    ];

    /// Its word in the protocol.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NoSensor => "assumed",
            Self::SensorFault => "sensor-range",
            Self::Late => "late",
            Self::Learnt(Trust::Learning) => "learning",
            Self::Learnt(Trust::Trusted) => "trusted",
            Self::Learnt(Trust::Mean(why)) => match why {
                Distrust::Sensor => "sensor",
                Distrust::Between => "between",
                Distrust::Wet => "wet",
                Distrust::Contact => "contact",
                Distrust::Unexplained => "unexplained",
                Distrust::Arithmetic => "arithmetic",
            },
        }
    }
}

/// What was measured at the end of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// Flux out of the skin; `None` if it is not valid.
    pub flux: Option<Flux>,
    /// Surface of the display, °C.
    pub surface: Option<Celsius>,
}

impl Measured {
    /// Before the first tick.
    const NOTHING: Self = Self {
        flux: Some(Flux::ZERO),
        surface: None,
    };
}

/// Learning of one finger: the sensor, the present window, and what was asked and answered.
#[derive(Clone, Debug)]
pub struct FingerLearning {
    parameters: FluxParameters,
    reading: FluxReading,
    resting: RestingCodes,
    /// The last two ticks, for which it is not known yet whether the finger presses.
    undecided: [Measured; CONTACT_DEBOUNCE_TICKS as usize],
    /// Flux that the device assumes, W/mm², behind the sensor's lag.
    modelled_behind_lag: LowPass,
    /// Ticks since the finger has lifted.
    lifted_ticks: u32,
    sums: WindowSums,
    /// Number of the last window.
    sequence: u16,
    /// The place of another finger that may follow, for the next input.
    restart: Option<Place>,
    /// The input of the last window, until the learner takes it.
    input: Option<LearnerInput>,
    /// Whether the learner must answer that input before the present window ends, and its answer.
    is_asked: bool,
    output: Option<LearnerOutput>,
    /// Whether an answer was missing since the last window without contact.
    was_late: bool,
    /// The finger that was applied last; `None` for the assumed one.
    applied: Option<LearnerOutput>,
    /// Skin offset that was learnt, and how much of it the filtered temperature of the skin before contact contains, K.
    skin_offset: Celsius,
    included_offset: Celsius,
    knowledge: FingerKnowledge,
}

impl FingerLearning {
    /// Learning with this sensor of a finger that is at `place` before its contacts.
    #[must_use]
    pub fn new(parameters: &FluxParameters, place: Place) -> Self {
        Self {
            parameters: *parameters,
            reading: FluxReading::new(parameters),
            resting: RestingCodes::default(),
            undecided: [Measured::NOTHING; CONTACT_DEBOUNCE_TICKS as usize],
            modelled_behind_lag: LowPass::new(parameters.lag),
            lifted_ticks: u32::MAX,
            sums: WindowSums::default(),
            sequence: 0,
            restart: Some(place),
            input: None,
            is_asked: false,
            output: None,
            was_late: false,
            applied: None,
            skin_offset: Celsius::ZERO,
            included_offset: Celsius::ZERO,
            knowledge: FingerKnowledge::Learnt(Trust::Learning),
        }
    }

    /// Forgets the finger, because another one may follow, which is at `place` before its contacts.
    pub fn restart(&mut self, place: Place) {
        self.restart = Some(place);
        self.is_asked = false;
        self.output = None;
        self.applied = None;
        self.skin_offset = Celsius::ZERO;
        self.knowledge = FingerKnowledge::Learnt(Trust::Learning);
    }

    /// Skin before contact as its thermistor has it, from the filtered temperature `skin`, which contains the learnt offset.
    #[must_use]
    pub const fn skin_without_offset(&self, skin: Celsius) -> Celsius {
        skin.saturating_sub(self.included_offset)
    }

    /// The change of the skin's filtered temperature in this tick, K, that lets it follow the thermistor's reading and the learnt
    /// offset, where the filter itself has followed the reading alone. `is_filtered` is whether it has done so in this tick;
    /// without an estimate of the skin nothing is included.
    pub fn skin_change(&mut self, has_estimate: bool, is_filtered: bool) -> Celsius {
        if !has_estimate {
            self.included_offset = Celsius::ZERO;
            return Celsius::ZERO;
        }
        if !is_filtered {
            return Celsius::ZERO;
        }
        // The filter has taken the included offset back by its share, which `filter_change` towards the offset makes up for.
        let lost = filter_change(Celsius::ZERO.saturating_sub(self.included_offset));
        let change = filter_change(self.skin_offset.saturating_sub(self.included_offset));
        self.included_offset = self.included_offset.saturating_add(change);
        change.saturating_sub(lost)
    }

    /// Takes the measurements at the end of the last tick, the sensor's code and the display's surface, and returns those of the
    /// tick before [`CONTACT_DEBOUNCE_TICKS`] others, of which it is known by now whether the finger pressed: a force off zero
    /// counts when it has lasted.
    pub fn take(&mut self, code: u16, surface: Option<Celsius>) -> Measured {
        let [decided, next] = self.undecided;
        let flux = self.reading.convert(code);
        let rests = flux.is_some() && self.is_lifted_for_long();
        self.resting.add(rests.then_some(code));
        self.undecided = [next, Measured { flux, surface }];
        decided
    }

    /// What the flux of the last tick was beyond the `modelled` one, W/mm²: slow differences as the sensor sees them, while the
    /// model alone shows what is quicker than the sensor. Also for a finger that is not trusted, whose model is the assumed one: it
    /// is the finger that is in doubt then, not the flux. Nothing without contact, and while the sensor itself is in doubt.
    pub fn flux_beyond_model(&mut self, modelled: Option<FluxPerMm2>) -> FluxPerMm2 {
        let is_sound = match self.knowledge {
            FingerKnowledge::Learnt(Trust::Mean(why)) => {
                !matches!(why, Distrust::Sensor | Distrust::Arithmetic)
            }
            FingerKnowledge::Learnt(Trust::Learning | Trust::Trusted) => true,
            FingerKnowledge::NoSensor | FingerKnowledge::SensorFault | FingerKnowledge::Late => {
                false
            }
        };
        let [_, Measured { flux, .. }] = self.undecided;
        let Some((modelled, flux)) = modelled.zip(flux).filter(|_| is_sound) else {
            self.modelled_behind_lag.set_output(FluxPerMm2::ZERO);
            return FluxPerMm2::ZERO;
        };
        self.modelled_behind_lag.update_by_input(modelled);
        let measured = i64::from(flux.to_bits()) << (FluxPerMm2::FRAC_NBITS - Flux::FRAC_NBITS);
        // A flux has 32 bits, and a million mm² are a m².
        let measured = FluxPerMm2::from_bits((measured / 1_000_000) as i32);
        measured.saturating_sub(self.modelled_behind_lag.output())
    }

    /// Whether the finger has been lifted for so long that a flux is none of its.
    const fn is_lifted_for_long(&self) -> bool {
        self.lifted_ticks > self.parameters.ticks_after_lifting
    }

    /// Adds a tick: its flux, and what was estimated at its end, if the finger pressed. Returns whether the window is complete.
    pub fn add_tick(&mut self, flux: Option<Flux>, contact: Option<TickOfContact>) -> bool {
        self.lifted_ticks = match contact {
            Some(_) => 0,
            None => self.lifted_ticks.saturating_add(1),
        };
        let counts = !self.is_lifted_for_long();
        let flux = flux.map(|flux| if counts { flux } else { Flux::ZERO });
        self.sums.add(flux, contact);
        self.sums.is_complete()
    }

    /// Ends a complete window: offers the next input, and returns the finger to be applied now, if it differs enough from the
    /// one that was applied last. That is the answer to the input before; if it is missing, one that is nearer to the assumed finger, until
    /// a window without contact. So it is while the sensor's code cannot be right.
    #[cold]
    #[inline(never)]
    pub fn end_window(&mut self, state: &StateAtEnd) -> Option<LearnerOutput> {
        let answer = self.output.take();
        let sums = core::mem::take(&mut self.sums);
        let contact = sums.contact(state);
        self.was_late &= contact.is_some();
        self.was_late |= self.is_asked && answer.is_none();
        self.knowledge = match &answer {
            _ if self.reading.is_faulty() => FingerKnowledge::SensorFault,
            _ if self.was_late => FingerKnowledge::Late,
            Some(answer) => FingerKnowledge::Learnt(answer.trust),
            None => self.knowledge,
        };
        self.sequence = self.sequence.wrapping_add(1);
        self.is_asked = true;
        self.input = Some(LearnerInput {
            sequence: self.sequence,
            restart: (self.restart.take()).map(|place| Restart {
                place,
                sensor: self.parameters.sensor,
            }),
            flux_w_m2: sums.mean_flux(),
            contact,
        });
        let next = match &self.applied {
            applied if self.was_late || self.reading.is_faulty() => applied
                .and_then(|applied| Some(applied.nearer_to_mean()).filter(|next| *next != applied)),
            Some(applied) => answer.filter(|answer| !applied.is_nearly(answer)),
            None => answer,
        };
        if next.is_some() {
            self.applied = next;
        }
        next
    }

    /// Notes the change of the skin before contact that the learnt offset makes now, K.
    pub fn adopt_skin_offset(&mut self, offset: Celsius, has_estimate: bool) -> Celsius {
        self.skin_offset = offset;
        if !has_estimate {
            return Celsius::ZERO;
        }
        let change = offset.saturating_sub(self.included_offset);
        self.included_offset = offset;
        change
    }

    /// Whether there is an input that the learner has not taken.
    #[must_use]
    pub const fn has_input(&self) -> bool {
        self.input.is_some()
    }

    /// The input of the last window, once.
    pub fn take_input(&mut self) -> Option<LearnerInput> {
        self.input.take()
    }

    /// Keeps the learner's answer for the end of the present window. One to an earlier input than the last is void, and one from
    /// before a restart.
    pub fn put_output(&mut self, output: &LearnerOutput) {
        if output.sequence == self.sequence && self.is_asked {
            self.output = Some(*output);
        }
    }

    /// How much of the learnt skin offset the filtered temperature of the skin contains, K.
    #[must_use]
    pub const fn included_offset(&self) -> Celsius {
        self.included_offset
    }

    /// The last flux, W/m²; `None` if the sensor's code cannot be right.
    #[must_use]
    pub fn flux(&self) -> Option<Flux> {
        self.reading.last()
    }

    /// The display's surface when that flux was read, °C.
    #[must_use]
    pub const fn surface(&self) -> Option<Celsius> {
        let [_, Measured { surface, .. }] = self.undecided;
        surface
    }

    /// Mean code of the last half second without contact.
    #[must_use]
    pub const fn resting_code(&self) -> Option<RestingCode> {
        self.resting.last()
    }

    /// What is known of the finger.
    #[must_use]
    pub const fn knowledge(&self) -> FingerKnowledge {
        self.knowledge
    }
}

#[cfg(test)]
mod tests;
