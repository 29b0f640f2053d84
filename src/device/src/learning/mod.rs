//! Learning of the finger that touches, from a sensor of the heat flux between skin and display.
//!
//! ```text
//! code of the sensor, surface and force of the last tick -> sums of a window of ten ticks -> LearnerInput -> learner
//!                                                                                                            |
//!                              bodies, skin state, skin before contact <- in the last tick of the next window
//! ```
//!
//! The learner runs outside of the control path. What it has found is applied ten ticks after its input was taken, however
//! soon it was there, so that its computing time changes nothing.

mod beyond_model;
mod code_faults;
mod flux_parameters;
mod no_contact_code;
mod person_state;
mod self_test;
mod window_sums;

use thermal_learner::{
    Distrust, Flux, LearnerInput, LearnerOutput, PlaceBeforeContact, Restart, Trust, WINDOW_TICKS,
};
use thermal_settings::Person;

use crate::estimate::FluxPerMm2;
use beyond_model::{BeyondModel, flux_per_mm2};
use code_faults::{CodeFault, CodeFaults};
pub use flux_parameters::FluxParameters;
pub use no_contact_code::NoContactCodeSum;
use no_contact_code::NoContactCodes;
pub use person_state::PersonState;
pub use self_test::FluxSensorTest;
use window_sums::WindowSums;
pub use window_sums::{MeasuredTick, StateAtEnd};

/// From these ticks after landing on, what is learnt changes slowly, and is applied only after every eighth window: that takes
/// longer than all else of a tick.
const APPLIED_SELDOM_FROM_TICKS: u64 = 1000;
const SELDOM_WINDOWS: u16 = 8;

/// What the device reports to the host of the finger that is learnt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FingerKnowledge {
    /// A conversion had not ended in this window: a step towards the assumed finger. In contact the learner then distrusts the sensor
    /// until the next landing.
    NoCode,
    /// The sensor's code has been at a rail for 50 ms, or the same for 100 ms: towards the assumed finger while it lasts. In contact the
    /// learner then distrusts the sensor until the next landing.
    SensorFault,
    /// The learner has not answered in time: the assumed finger until this contact has ended.
    Late,
    /// What the learner itself says: learning, trusted, or distrusted for a reason.
    Learnt(Trust),
}

impl FingerKnowledge {
    /// All of it. With all but the first two the device has gone back to the assumed finger, or is on the way there.
    pub const ALL: [Self; 11] = [
        Self::Learnt(Trust::Learning),
        Self::Learnt(Trust::Trusted),
        Self::NoCode,
        Self::SensorFault,
        Self::Learnt(Trust::Mean(Distrust::Sensor)),
        Self::Learnt(Trust::Mean(Distrust::Between)),
        Self::Learnt(Trust::Mean(Distrust::Wet)),
        Self::Learnt(Trust::Mean(Distrust::Contact)),
        Self::Learnt(Trust::Mean(Distrust::Unexplained)),
        Self::Learnt(Trust::Mean(Distrust::Arithmetic)),
        Self::Late,
    ];

    /// Whether what the sensor reads can be right. Also for a finger that is not trusted: the finger is in doubt then, not the flux.
    const fn is_of_sound_sensor(self) -> bool {
        match self {
            Self::NoCode | Self::SensorFault | Self::Late => false,
            Self::Learnt(Trust::Mean(why)) => {
                !matches!(why, Distrust::Sensor | Distrust::Arithmetic)
            }
            Self::Learnt(Trust::Learning | Trust::Trusted) => true,
        }
    }

    /// Its word in the protocol.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NoCode => "no-code",
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

/// Learning of one finger: the sensor, the present window, and what was asked and answered.
#[derive(Clone, Debug)]
// In this order, because a load reaches 4 KB from the start of a station: what each tick needs comes first.
#[repr(C)]
pub struct FingerLearning {
    sums: WindowSums,
    /// The last code; 0 before the first.
    code: u16,
    /// The input of the last window, until the learner takes it.
    input: Option<LearnerInput>,
    parameters: FluxParameters,
    faults: CodeFaults,
    resting: NoContactCodes,
    beyond_model: BeyondModel,
    /// Windows in which the flux still counts if the finger has lifted.
    counting_windows: u32,
    /// Number of the last window.
    sequence: u16,
    /// Where another finger that may follow is before its contacts, until the learner has taken it with an input.
    restart: Option<PlaceBeforeContact>,
    /// Whether the finger has not lifted since the last restart: its contact had warmed or cooled its skin before learning began, so that
    /// nothing is learnt from it.
    has_unknown_history: bool,
    /// Whether the learner must answer that input before the present window ends, and its answer.
    is_asked: bool,
    answer: Option<Trust>,
    /// The finger of the last answer, and whether it was not compared with the applied one yet.
    learnt: Option<LearnerOutput>,
    is_new: bool,
    /// Whether an answer was missing since the last window without contact.
    was_late: bool,
    /// The finger that was applied last; `None` for the assumed one.
    applied: Option<LearnerOutput>,
    knowledge: FingerKnowledge,
    person: PersonState,
}

impl FingerLearning {
    /// Learning with this sensor, of a finger that is at `place` before its contacts.
    pub fn new(parameters: &FluxParameters, place: PlaceBeforeContact) -> Self {
        Self {
            sums: WindowSums::default(),
            code: 0,
            parameters: *parameters,
            faults: CodeFaults::default(),
            resting: NoContactCodes::default(),
            beyond_model: BeyondModel::default(),
            counting_windows: 0,
            sequence: 0,
            restart: Some(place),
            has_unknown_history: true,
            input: None,
            is_asked: false,
            answer: None,
            learnt: None,
            is_new: false,
            was_late: false,
            applied: None,
            knowledge: FingerKnowledge::Learnt(Trust::Learning),
            person: PersonState::new(None),
        }
    }

    /// Forgets the finger, because another one may follow, which is at `place` before its contacts: that of a person, or of an
    /// unknown one.
    pub fn restart(&mut self, place: PlaceBeforeContact, person: Option<Person>) {
        self.restart = Some(place);
        self.has_unknown_history = true;
        self.input = None;
        self.is_asked = false;
        self.answer = None;
        self.learnt = None;
        self.knowledge = FingerKnowledge::Learnt(Trust::Learning);
        self.person = PersonState::new(person);
    }

    /// Notes that the assumed finger is applied.
    pub const fn note_assumed_finger(&mut self) {
        self.applied = None;
    }

    /// Takes the sensor's code of this tick. Without one, because the conversion has not ended, the last code stands in, and the window
    /// is faulty. Returns the code that stands for the tick.
    #[inline(always)]
    pub const fn note_code(&mut self, code: Option<u16>) -> u16 {
        match code {
            Some(code) => self.code = code,
            None => self.sums.is_code_missing = true,
        }
        self.code
    }

    /// Adds a tick. Returns whether the window is complete, which [`Self::end_window`] must then end.
    #[inline(always)]
    pub fn add_tick(&mut self, tick: &MeasuredTick) -> bool {
        self.sums.add(tick)
    }

    /// Ends a complete window: makes the learner's next input, and returns the finger to apply in this tick; `None` if it hardly differs
    /// from the one in use. It is the learner's answer to the input before. While the codes cannot be right, and from a missing answer to
    /// the next window without contact, it is a step towards the assumed finger.
    pub fn end_window(&mut self, state: &StateAtEnd) -> Option<&LearnerOutput> {
        self.has_unknown_history &= self.sums.has_contact();
        let modelled_flux = self.sums.mean_modelled_flux();
        let flux_w_m2 = self.flux_of_window(modelled_flux, state.is_display_at_room);
        let mut contact = self.sums.contact(state);
        if let Some(contact) = &mut contact {
            contact.is_steady &= !self.faults.is_saturated() && !self.has_unknown_history;
        }
        self.sums.begin_next();
        let (answer, fault) = (self.answer.take(), self.faults.present());
        self.was_late &= contact.is_some();
        self.was_late |= self.is_asked && answer.is_none();
        self.knowledge = match (fault, answer) {
            (Some(CodeFault::Missing), _) => FingerKnowledge::NoCode,
            (Some(CodeFault::Range), _) => FingerKnowledge::SensorFault,
            _ if self.was_late => FingerKnowledge::Late,
            (None, Some(trust)) => FingerKnowledge::Learnt(trust),
            (None, None) => self.knowledge,
        };
        let flux = flux_w_m2.filter(|_| self.knowledge.is_of_sound_sensor());
        self.beyond_model.end_window(flux, modelled_flux, &self.parameters, state);
        if let Some(trust) = answer {
            let learnt = self.learnt.as_ref();
            (self.person).note(trust, learnt.and_then(|learnt| learnt.person.as_ref()));
        }
        self.sequence = self.sequence.wrapping_add(1);
        self.is_asked = true;
        self.input = Some(LearnerInput {
            sequence: self.sequence,
            restart: self.restart.map(|place| Restart {
                place,
                sensor: self.parameters.sensor,
                person: self.person.prior(),
            }),
            flux_w_m2,
            contact,
        });
        if self.was_late || fault.is_some() {
            self.is_new = true;
            let applied = self.applied.as_mut()?;
            return applied.approach_mean().then_some(applied);
        }
        let is_due = state.ticks_since_landing < APPLIED_SELDOM_FROM_TICKS
            || matches!(answer, Some(Trust::Mean(_)))
            || self.sequence.is_multiple_of(SELDOM_WINDOWS);
        let learnt = self.learnt.as_ref();
        let learnt = learnt.filter(|_| is_due && core::mem::take(&mut self.is_new))?;
        if (self.applied.as_ref()).is_some_and(|applied| applied.is_nearly(learnt)) {
            return None;
        }
        Some(self.applied.insert(*learnt))
    }

    /// Mean flux of the window, 0 without contact; `None` if the codes cannot be right. Notes the codes if no flux is expected.
    fn flux_of_window(&mut self, modelled: FluxPerMm2, is_display_at_room: bool) -> Option<Flux> {
        self.counting_windows = if self.sums.has_contact() {
            self.parameters.windows_after_lifting + 1
        } else {
            self.counting_windows.saturating_sub(1)
        };
        // The first window has fewer codes.
        if self.sequence == 0 && !self.is_asked {
            return Some(Flux::ZERO);
        }
        let sums = &self.sums;
        // The modelled flux is at least half of the measured one.
        let is_beyond_likely = || {
            let measured = flux_per_mm2(self.parameters.mean_flux(sums.codes()));
            modelled.saturating_mul_int(2).abs() >= measured.abs()
                && modelled.is_negative() == measured.is_negative()
        };
        let codes =
            (self.faults).judge(sums.codes(), self.code, sums.is_code_missing, is_beyond_likely);
        let is_valid = self.faults.present().is_none();
        let counts = self.counting_windows != 0;
        let is_resting = is_valid && !counts && is_display_at_room;
        self.resting.add(is_resting.then_some(codes));
        is_valid.then(|| if counts { self.parameters.mean_flux(codes) } else { Flux::ZERO })
    }

    /// Whether there is an input that the learner has not taken.
    pub const fn has_input(&self) -> bool {
        self.input.is_some()
    }

    /// The input of the last window, once.
    pub fn take_input(&mut self) -> Option<LearnerInput> {
        let input = self.input.take()?;
        self.restart = None;
        Some(input)
    }

    /// Keeps the learner's answer for the end of the present window. One to an earlier input than the last is void, and one from
    /// before a restart.
    pub fn put_output(&mut self, output: &LearnerOutput) {
        if output.sequence != self.sequence || !self.is_asked {
            return;
        }
        self.answer = Some(output.trust);
        if (self.learnt.as_ref()).is_none_or(|learnt| learnt.revision != output.revision) {
            self.learnt = Some(*output);
            self.is_new = true;
        }
    }

    /// The last flux, W/m²; `None` before the first code, and if the sensor's codes cannot be right.
    pub fn flux(&self) -> Option<Flux> {
        let is_valid = self.code != 0 && self.faults.present().is_none();
        is_valid.then(|| (self.parameters).mean_flux(WINDOW_TICKS * u32::from(self.code)))
    }

    /// Flux to be added to that of the modelled finger in the present window.
    pub const fn flux_beyond_model(&self) -> FluxPerMm2 {
        self.beyond_model.flux()
    }

    /// Mean code of half a second without contact, with the display at the temperature of the room.
    pub const fn no_contact_code(&self) -> Option<NoContactCodeSum> {
        self.resting.last()
    }

    /// What is known of the person.
    pub const fn person(&self) -> &PersonState {
        &self.person
    }

    /// What is known of the finger.
    pub const fn knowledge(&self) -> FingerKnowledge {
        self.knowledge
    }
}

#[cfg(test)]
mod tests;
