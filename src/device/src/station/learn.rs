//! Learning of the finger that touches: between the station's estimates and its learner.

use contact_model::fixed_point::{Celsius, TissueStateFactors, TissueWeights, product};
use thermal_learner::{LearnerInput, LearnerOutput, Place};

use super::{DueWork, Station};
use crate::command::AssumedFinger;
use crate::estimate::ForceChange;
use crate::learning::{FingerKnowledge, StateAtEnd, TickOfContact};

/// Where the assumed finger is before its contacts.
const fn place(finger: AssumedFinger) -> Place {
    match finger {
        AssumedFinger::MeanOnPad => Place::Pad,
        AssumedFinger::Mean | AssumedFinger::Thesis => Place::Air,
    }
}

impl Station {
    /// [`crate::Device::note_flux_code`].
    pub(crate) const fn note_flux_code(&mut self, code: u16) {
        self.flux_code = code;
        self.due.add(DueWork::FLUX);
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

    /// [`crate::Device::finger_knowledge`].
    pub(crate) fn finger_knowledge(&self) -> FingerKnowledge {
        let learning = self.learning.as_ref();
        learning.map_or(FingerKnowledge::NoSensor, |learning| learning.knowledge())
    }

    /// Begins to learn another finger.
    pub(super) fn forget_learnt_finger(&mut self, finger: AssumedFinger) {
        if let Some(learning) = &mut self.learning {
            learning.restart(place(finger));
        }
    }

    /// Adds the last tick to the learner's window, with the sensor's code at its end. At a window's end, takes over what was learnt
    /// up to the window before. A finger that is the thesis's half-space is not learnt.
    pub(super) fn learn_from_flux(&mut self) {
        let Some(learning) = &mut self.learning else {
            return;
        };
        let finger = &mut self.estimator.finger;
        let skin = finger.sensed_skin_before_contact();
        let change = learning.skin_change(skin.is_some(), finger.has_filtered_skin());
        finger.shift_sensed_skin(change);
        let skin = skin.map(|skin| skin.saturating_add(change));
        let is_limited = (self.last.reference).is_some_and(|reference| reference.limited);
        let contact = finger.contact();
        let presses = self.contact.is_force_nonzero_debounced();
        let tick = skin.zip(self.estimator.plate.surface()).filter(|_| presses);
        let tick = tick.map(|(skin, surface)| TickOfContact {
            skin_above_display: learning.skin_without_offset(skin).saturating_sub(surface),
            is_steady: !is_limited
                && contact.is_some_and(|contact| contact.force_change() != ForceChange::New),
        });
        if !learning.add_tick(self.flux_code, tick) {
            return;
        }
        let above_room = skin.zip(finger.temperatures_before_contact());
        let above_room = above_room.map_or(Celsius::ZERO, |(skin, before)| {
            learning
                .skin_without_offset(skin)
                .saturating_sub(before.room)
        });
        let assumed = self.object.assumed_finger();
        let resistances = &self.object.bodies().resistances;
        let conductances = contact.and_then(|contact| contact.stored_conductances());
        let conductances = conductances.filter(|_| assumed.is_layered());
        let state = StateAtEnd {
            scaled_air_flux: product(above_room, assumed.body().air),
            resistance: conductances.map(|both| both.expected_display_resistance(resistances)),
            ticks_since_landing: contact.map_or(0, |contact| contact.ticks_since_landing()),
        };
        let learnt = learning.end_window(&state);
        if let Some(learnt) = learnt.filter(|_| assumed.is_layered()) {
            self.apply_learnt(&learnt);
        }
    }

    /// Goes on with the finger that was learnt, as if it had been known since landing.
    fn apply_learnt(&mut self, learnt: &LearnerOutput) {
        let from = self.object.bodies().finger.tissue;
        let to = TissueWeights::at_least_min(learnt.weights).tissue();
        let factors = TissueStateFactors::new(&from.relaxations(), &to.relaxations());
        let finger = &mut self.estimator.finger;
        finger.change_tissue(&factors, &to);
        self.reference.change_finger(&factors, &to);
        self.object
            .learn_finger(&to, learnt.air_change, learnt.resistance_factor);
        finger.forget_conductances();
        let has_skin = finger.sensed_skin_before_contact().is_some();
        if let Some(learning) = &mut self.learning {
            let change = learning.adopt_skin_offset(learnt.skin_offset_k, has_skin);
            finger.shift_sensed_skin(change);
        }
    }
}

#[cfg(test)]
mod tests;
