//! Learning of the finger that touches: between the station's estimates and its learner.

use contact_model::fixed_point::{Celsius, TissueStateFactors, TissueWeights, product};
use fixed::types::{U10F22, U16F16};
use thermal_learner::{LearnerInput, LearnerOutput, PlaceBeforeContact, WINDOW_TICKS};
use thermal_settings::Person;

use super::{DueWork, Station};
use crate::command::{AssumedFinger, FluxState, Refused};
use crate::estimate::FluxPerMm2;
use crate::events::DeviceEventKind;
use crate::learning::{
    FingerLearning, FluxParameters, MeasuredTick, NoContactCodeSum, PersonState, StateAtEnd,
};

/// Largest temperature difference of display and room at which the zero may be taken, K: the air then takes some 3 W/m².
const FLUX_ZERO_ROOM_DIFFERENCE_MAX: U10F22 = U10F22::lit("0.3");

/// Where the assumed finger is before its contacts.
const fn place_before_contact(finger: AssumedFinger) -> PlaceBeforeContact {
    match finger {
        AssumedFinger::MeanOnPad => PlaceBeforeContact::Pad,
        AssumedFinger::Mean | AssumedFinger::Thesis => PlaceBeforeContact::Air,
    }
}

impl Station {
    /// Uses this heat-flux sensor from now on, or none, and forgets what was learnt. A finger that touches begins a new contact.
    pub(super) fn replace_flux_sensor(&mut self, sensor: Option<&FluxParameters>) {
        if self.learning.is_none() && sensor.is_none() {
            return;
        }
        let place = place_before_contact(self.object.assumed_finger());
        self.learning = sensor.map(|sensor| FingerLearning::new(sensor, place));
        let layer = sensor.map_or(U16F16::ZERO, |sensor| sensor.display_layer);
        self.object.set_display_layer(layer);
        self.reference.forget_resistances();
        self.estimator.finger.set_skin_offset(Celsius::ZERO);
        (self.estimator.finger).set_flux_beyond_model(FluxPerMm2::ZERO);
        self.due.add(DueWork::ASSUMED_FINGER);
        self.due.add(DueWork::CONTACT_RESTART);
    }

    /// Discards what was learnt: tissue, resistance and conductances are those of the assumed finger again.
    pub(super) fn restore_assumed_finger(&mut self) {
        self.object.restore_assumed_finger();
        self.estimator.finger.forget_tissue_history();
        self.estimator.finger.forget_conductances();
    }

    /// [`crate::Device::finger_has_flux_sensor`].
    pub(crate) const fn has_flux_sensor(&self) -> bool {
        self.learning.is_some()
    }

    /// Flux and knowledge; `None` without a heat-flux sensor.
    pub(super) fn flux_state(&self) -> Option<FluxState> {
        let learning = self.learning.as_ref()?;
        Some(FluxState {
            flux: learning.flux(),
            surface: self.estimator.plate.surface(),
            knowledge: learning.knowledge(),
        })
    }

    /// Mean code of the heat-flux sensor, at a time at which no flux is expected.
    pub(super) fn flux_zero(&self) -> Result<NoContactCodeSum, Refused> {
        let learning = self.learning.as_ref().ok_or(Refused::NoFluxSensor("flux zero"))?;
        if self.contact.touching() {
            return Err(Refused::Touched("flux zero"));
        }
        if !self.is_display_at_room() {
            let readings = &self.last.readings;
            let (display, room) = (readings.display.ok(), readings.room.ok());
            return Err(Refused::DisplayNotAtRoom { display, room });
        }
        if learning.flux().is_none() {
            return Err(Refused::FluxSensorFault);
        }
        learning.no_contact_code().ok_or(Refused::TooEarly)
    }

    /// Whether hardly any heat flows through the heat-flux sensor without a finger.
    fn is_display_at_room(&self) -> bool {
        let readings = &self.last.readings;
        let both = readings.display.ok().zip(readings.room.ok());
        both.is_some_and(|(display, room)| {
            display.saturating_sub(room).unsigned_abs() <= FLUX_ZERO_ROOM_DIFFERENCE_MAX
        })
    }

    /// [`crate::Device::note_flux_code`]. Adds the last tick to the learner's window.
    #[inline(always)]
    pub(crate) fn note_flux_code(&mut self, code: Option<u16>) -> bool {
        let Some(learning) = &mut self.learning else {
            return false;
        };
        let tick = MeasuredTick {
            code: learning.note_code(code),
            surface: (self.estimator.plate.surface())
                .or(self.last.readings.display.ok())
                .unwrap_or_default(),
            modelled_flux: self.estimator.finger.modelled_flux(),
            presses: self.contact.is_force_nonzero_debounced(),
        };
        if learning.add_tick(&tick) {
            self.due.add(DueWork::FLUX_WINDOW);
        }
        learning.has_input()
    }

    /// [`crate::Device::take_learner_input`].
    pub(crate) fn take_learner_input(&mut self) -> Option<LearnerInput> {
        self.learning.as_mut()?.take_input()
    }

    /// [`crate::Device::put_learner_output`].
    pub(crate) fn put_learner_output(&mut self, output: &LearnerOutput) {
        if let Some(learning) = &mut self.learning {
            learning.put_output(output);
        }
    }

    /// Begins to learn another finger.
    pub(super) fn forget_learnt_finger(&mut self, finger: AssumedFinger) {
        if let Some(learning) = &mut self.learning {
            learning.restart(place_before_contact(finger), None);
            self.estimator.finger.set_skin_offset(Celsius::ZERO);
        }
    }

    /// What is stored of a person holds with the nominal contact law only.
    pub(super) const fn require_nominal_contact_law(&self) -> Result<(), Refused> {
        match self.object.bodies().resistances.law {
            None => Ok(()),
            Some(_) => Err(Refused::OtherContactLaw(self.object.contact_law)),
        }
    }

    /// Begins to learn the finger of this person, or of an unknown one.
    pub(super) fn choose_person(&mut self, person: Option<Person>) -> Result<(), Refused> {
        let finger = self.object.assumed_finger();
        if !finger.is_layered() {
            return Err(Refused::NeedsLayeredFinger("person"));
        }
        let learning = (self.learning.as_mut()).ok_or(Refused::NoFluxSensor("person"))?;
        learning.restart(place_before_contact(finger), person);
        self.estimator.finger.set_skin_offset(Celsius::ZERO);
        Ok(())
    }

    /// The chosen person, and what was learnt since.
    pub(super) fn person_state(&self) -> Result<PersonState, Refused> {
        let learning = self.learning.as_ref();
        let learning = learning.ok_or(Refused::NoFluxSensor("person"))?;
        Ok(*learning.person())
    }

    /// Ends the learner's window, and takes over what was learnt up to the window before. A finger that is the thesis's half-space
    /// is not learnt.
    pub(super) fn end_flux_window(&mut self) {
        let is_display_at_room = self.is_display_at_room();
        let Some(learning) = &mut self.learning else {
            return;
        };
        let finger = &self.estimator.finger;
        let skin = finger.skin_before_contact_by_thermistor();
        let above_room = skin.zip(finger.temperatures_before_contact());
        let above_room =
            above_room.map_or(Celsius::ZERO, |(skin, before)| skin.saturating_sub(before.room));
        let contact = finger.contact();
        let assumed = self.object.assumed_finger();
        let resistances = &self.object.bodies().resistances;
        let conductances = contact.and_then(|contact| contact.stored_conductances());
        let conductances = conductances.filter(|_| assumed.is_layered());
        let state = StateAtEnd {
            skin,
            scaled_air_flux: product(above_room, assumed.body().air),
            resistance: conductances.map(|both| both.expected_display_resistance(resistances)),
            ticks_since_landing: contact.map_or(0, |contact| contact.ticks_since_landing()),
            is_steady: contact
                .is_some_and(|contact| !contact.force_means().have_jumped_within(WINDOW_TICKS))
                && !(self.last.reference).is_some_and(|reference| reference.limited),
            is_display_at_room,
        };
        let before = learning.knowledge();
        let learnt = learning.end_window(&state).filter(|_| assumed.is_layered());
        if let Some(learnt) = learnt {
            // Goes on with the finger that was learnt, as if it had been known since landing.
            let from = &self.object.bodies().finger.tissue;
            let to = TissueWeights::at_least_min(learnt.weights).tissue();
            let factors = TissueStateFactors::new(&from.relaxations(), &to.relaxations());
            let finger = &mut self.estimator.finger;
            finger.change_tissue(&factors, &to);
            self.reference.change_finger(&factors, &to);
            self.object.learn_finger(&to, learnt.air_flux_deviation, learnt.resistance_factor);
            finger.forget_conductances();
            finger.set_skin_offset(learnt.skin_offset_k);
        }
        (self.estimator.finger).set_flux_beyond_model(learning.flux_beyond_model());
        if learning.knowledge() != before {
            (self.events).note(DeviceEventKind::FingerKnowledge, self.tick, 0);
        }
    }
}

#[cfg(test)]
mod tests;
