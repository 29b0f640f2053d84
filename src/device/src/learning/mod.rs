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

mod code_faults;
mod flux_parameters;
mod resting_code;
mod window_sums;

use contact_model::fixed_point::Celsius;
use thermal_learner::{
    Distrust, Flux, LearnerInput, LearnerOutput, Place, Restart, Trust, WINDOW_TICKS,
};

use crate::sense::CONTACT_DEBOUNCE_TICKS;
use code_faults::{CodeFault, CodeFaults, within_range};
pub use flux_parameters::FluxParameters;
pub use resting_code::RestingCode;
use resting_code::RestingCodes;
pub use window_sums::StateAtEnd;
use window_sums::WindowSums;

/// What the host is told about the finger that is learnt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FingerKnowledge {
    /// No sensor of the heat flux is fitted: the assumed finger.
    NoSensor,
    /// The converter has not converted the sensor's voltage: the assumed finger until the next contact without such a tick.
    NoCode,
    /// The sensor reads beyond its range, or the same for too long: the assumed finger until the next contact without such codes.
    SensorFault,
    /// The learner has not answered in time: the assumed finger until this contact has ended.
    Late,
    /// What the learner says.
    Learnt(Trust),
}

impl FingerKnowledge {
    /// All with their words in the protocol. Those with a reason are on the way to the assumed finger, or there.
    pub const PROTOCOL_WORDS: [(&'static str, Self); 12] = [
        ("assumed", Self::NoSensor),
        ("learning", Self::Learnt(Trust::Learning)),
        ("trusted", Self::Learnt(Trust::Trusted)),
        ("no-code", Self::NoCode),
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

/// What was measured at the end of a tick.
#[derive(Clone, Copy, Debug)]
struct Measured {
    /// Code of the sensor, within the range of sound wires; 0 before the first.
    code: u16,
    /// Surface of the display, °C.
    surface: Celsius,
}

/// Learning of one finger: the sensor, the present window, and what was asked and answered.
#[derive(Clone, Debug)]
pub struct FingerLearning {
    /// The last two ticks, for which it is not known yet whether the finger pressed: a force off zero counts when it has lasted.
    undecided: [Measured; CONTACT_DEBOUNCE_TICKS as usize],
    /// Ticks in which the flux still counts if the finger has lifted.
    counting_ticks: u32,
    sums: WindowSums,
    parameters: FluxParameters,
    faults: CodeFaults,
    resting: RestingCodes,
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
    knowledge: FingerKnowledge,
}

impl FingerLearning {
    /// Learning with this sensor of a finger that is at `place` before its contacts.
    #[must_use]
    pub fn new(parameters: &FluxParameters, place: Place) -> Self {
        Self {
            undecided: [Measured {
                code: 0,
                surface: Celsius::ZERO,
            }; CONTACT_DEBOUNCE_TICKS as usize],
            counting_ticks: 0,
            sums: WindowSums::default(),
            parameters: *parameters,
            faults: CodeFaults::default(),
            resting: RestingCodes::default(),
            sequence: 0,
            restart: Some(place),
            input: None,
            is_asked: false,
            output: None,
            was_late: false,
            applied: None,
            knowledge: FingerKnowledge::Learnt(Trust::Learning),
        }
    }

    /// Forgets the finger, because another one may follow, which is at `place` before its contacts.
    pub fn restart(&mut self, place: Place) {
        self.restart = Some(place);
        self.is_asked = false;
        self.output = None;
        self.applied = None;
        self.knowledge = FingerKnowledge::Learnt(Trust::Learning);
    }

    /// Adds a tick: the sensor's code, the display's surface and whether the finger presses, all of the last tick. Code and surface
    /// count two ticks later, when it is known whether the finger pressed. Returns whether the window is complete, which
    /// [`Self::end_window`] must then end. `is_steady` is asked while the finger presses: no jump of the force, and no limited
    /// set-point.
    #[inline(always)]
    pub fn add_tick(
        &mut self,
        code: Option<u16>,
        surface: Option<Celsius>,
        presses: bool,
        is_steady: impl FnOnce() -> bool,
    ) -> bool {
        let [decided, last] = self.undecided;
        let code = match code {
            Some(code) => within_range(code),
            None => {
                self.sums.codes.is_one_missing = true;
                last.code
            }
        };
        let surface = surface.unwrap_or(last.surface);
        self.undecided = [last, Measured { code, surface }];
        self.counting_ticks = if presses {
            self.parameters.ticks_after_lifting + 1
        } else {
            self.counting_ticks.saturating_sub(1)
        };
        let counts = self.counting_ticks != 0;
        self.sums.codes.add(decided.code, last.code, counts);
        let contact = presses.then(|| (decided.surface, is_steady()));
        self.sums.add(contact)
    }

    /// Ends a complete window: offers the next input, and returns the finger to be applied now, if it differs enough from the
    /// one that was applied last. That is the answer to the input before; if it is missing, one that is nearer to the assumed finger, until
    /// a window without contact. So it is while the sensor's code cannot be right.
    pub fn end_window(&mut self, state: &StateAtEnd) -> Option<&LearnerOutput> {
        let sums = core::mem::take(&mut self.sums);
        let contact = sums.contact(state);
        self.judge_codes(&sums);
        let fault = self.faults.present();
        self.was_late &= contact.is_some();
        self.was_late |= self.is_asked && self.output.is_none();
        self.knowledge = match (fault, &self.output) {
            (Some(CodeFault::Missing), _) => FingerKnowledge::NoCode,
            (Some(CodeFault::Range), _) => FingerKnowledge::SensorFault,
            _ if self.was_late => FingerKnowledge::Late,
            (None, Some(answer)) => FingerKnowledge::Learnt(answer.trust),
            (None, None) => self.knowledge,
        };
        self.sequence = self.sequence.wrapping_add(1);
        self.is_asked = true;
        let (codes, ticks) = sums.codes.counting();
        self.input = Some(LearnerInput {
            sequence: self.sequence,
            restart: (self.restart.take()).map(|place| Restart {
                place,
                sensor: self.parameters.sensor,
            }),
            flux_w_m2: (fault.is_none()).then(|| self.parameters.mean_flux(codes, ticks)),
            contact,
        });
        let is_new = if self.was_late || fault.is_some() {
            (self.applied.as_mut()).is_some_and(LearnerOutput::approach_mean)
        } else {
            let is_known = |answer| {
                (self.applied.as_ref())
                    .is_some_and(|applied: &LearnerOutput| applied.is_nearly(answer))
            };
            let is_new = (self.output.as_ref()).is_some_and(|answer| !is_known(answer));
            if is_new {
                self.applied = self.output;
            }
            is_new
        };
        self.output = None;
        self.applied.as_ref().filter(|_| is_new)
    }

    /// Looks for codes of a window that cannot be right, and notes its sum if the finger was lifted. Not of the first window, which
    /// has ticks from before the first code.
    fn judge_codes(&mut self, sums: &WindowSums) {
        if self.sequence == 0 && !self.is_asked {
            return;
        }
        self.faults.judge(&sums.codes);
        let (_, counting_ticks) = sums.codes.counting();
        let rests = self.faults.present().is_none() && counting_ticks == 0;
        self.resting.add(rests.then_some(sums.codes.sum()));
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

    /// The last flux, W/m²; `None` before the first code, and if the sensor's codes cannot be right.
    #[must_use]
    pub fn flux(&self) -> Option<Flux> {
        let [_, Measured { code, .. }] = self.undecided;
        let ticks = WINDOW_TICKS;
        (code != 0 && self.faults.present().is_none())
            .then(|| self.parameters.mean_flux(ticks * u32::from(code), ticks))
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
