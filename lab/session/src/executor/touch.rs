//! A trial in which the participant touches the stimuli after a tone.

use thermal_client::link::Link;

use super::set_up::device_fingers;
use super::{Executor, TrialEnd};
use crate::{
    ContactRule, Cue, Decision, OperatorQuestion, Phase, PlannedTrial, Procedure, Question,
    RestPlace, Update,
};

/// Longest time for the finger to lift after the tone, s.
const LIFT_S: f64 = 10.0;
/// Force below which the finger has lifted, N, and for how long, ms.
const LIFTED_N: f64 = 0.02;
const LIFTED_MS: u32 = 300;

impl<L: Link> Executor<'_, L> {
    /// The trial from the first tone to the lift.
    pub(super) fn touch(
        &mut self,
        trial: &PlannedTrial,
        reach_s: f64,
        contact: ContactRule,
        max_s: f64,
    ) -> Result<(), TrialEnd> {
        let displays: Vec<u8> = device_fingers(trial).collect();
        self.phase(Phase::Reach);
        let now_s = self.now_s();
        if reach_s > 0.0 {
            self.trial.reach_cue_s = Some(now_s);
            self.inform(Update::Cue(Cue::Reach));
            self.wait_until(now_s + reach_s)?;
        }
        self.phase(Phase::Contact);
        if displays.iter().any(|finger| self.lies_on(*finger)) {
            let why = "a finger was on the display before the tone to touch";
            return Err(TrialEnd::Void(why.into()));
        }
        self.trial.forget_contacts();
        let cue_s = self.now_s();
        self.trial.touch_cue_s = Some(cue_s);
        self.inform(Update::TargetForce(trial.target_force_n));
        self.inform(Update::Cue(Cue::Touch));
        self.wait_for_landings(&displays, cue_s)?;
        let begin_s = displays.iter().filter_map(|finger| self.trial.land_s(*finger));
        let begin_s = begin_s.reduce(f64::min).unwrap_or(cue_s);
        if contact == ContactRule::Free {
            self.ask();
        }
        let until_s = begin_s + max_s;
        self.wait_for(until_s, |executor| {
            executor.check_force(&displays);
            contact == ContactRule::Free && executor.trial.response.is_some()
        })?;
        self.inform(Update::Cue(Cue::Lift));
        self.inform(Update::TargetForce(None));
        let now_s = self.now_s();
        self.trial.contact_end_s = Some(now_s);
        self.respond(trial)?;
        self.wait_for_lift(&displays)?;
        self.check_contact(trial, &displays);
        Ok(())
    }

    /// Asks the participant, unless the session asks nothing.
    fn ask(&mut self) {
        if let Some(answer) = &self.session.answer {
            let question = Question { ask: answer.ask.clone(), kind: answer.kind.clone() };
            self.trial.is_asked = true;
            self.inform(Update::Ask(question));
        }
    }

    /// Waits for the answer, which may have been given, and tells the participant whether it is correct if the session wants
    /// that.
    pub(super) fn respond(&mut self, trial: &PlannedTrial) -> Result<(), TrialEnd> {
        self.wait_for_answer()?;
        if self.session.trial.feedback
            && let Some(is_correct) = self.trial.is_correct(self.session, trial)
        {
            self.inform(Update::Feedback { is_correct });
        }
        Ok(())
    }

    fn wait_for_answer(&mut self) -> Result<(), TrialEnd> {
        if self.session.answer.is_none() || self.trial.response.is_some() {
            return Ok(());
        }
        self.phase(Phase::Respond);
        if !self.trial.is_asked {
            self.ask();
        }
        let until_s = self.now_s() + self.session.trial.answer_s;
        if self.wait_for(until_s, |executor| executor.trial.response.is_some())? {
            return Ok(());
        }
        self.trial.is_asked = false;
        self.inform(Update::Answered(None));
        Err(TrialEnd::Void(format!("no answer within {} s", self.session.trial.answer_s)))
    }

    fn wait_for_landings(&mut self, displays: &[u8], cue_s: f64) -> Result<(), TrialEnd> {
        let land_s = self.session.trial.land_s;
        let all_landed = |executor: &mut Self| {
            executor.check_force(displays);
            displays.iter().all(|finger| executor.trial.land_s(*finger).is_some())
        };
        if self.wait_for(cue_s + land_s, all_landed)? {
            return Ok(());
        }
        self.inform(Update::Cue(Cue::Lift));
        Err(TrialEnd::Void(format!("no landing within {land_s} s")))
    }

    /// Waits until no finger presses any more.
    fn wait_for_lift(&mut self, displays: &[u8]) -> Result<(), TrialEnd> {
        self.phase(Phase::Return);
        let until_s = self.now_s() + LIFT_S;
        if self.wait_for(until_s, |executor| executor.are_free(displays))? {
            Ok(())
        } else {
            Err(TrialEnd::Void(format!("the finger has not lifted after {LIFT_S} s")))
        }
    }

    /// Waits for the lift of fingers that lie on displays from before the trial, and names them: the contact must begin after the
    /// tone. Where fingers rest or stay on the display they may lie there.
    pub(super) fn wait_for_free_displays(&mut self, displays: &[u8]) -> Result<(), TrialEnd> {
        let rests_on_display =
            self.session.rest.is_some_and(|rest| rest.place == RestPlace::Display);
        let stays = matches!(self.session.trial.procedure, Procedure::Intervals { .. });
        if rests_on_display || stays {
            return Ok(());
        }
        while let Some(finger) = displays.iter().find(|finger| self.lies_on(**finger)) {
            let why = format!("a finger lies on display {finger}; the trial waits until it lifts");
            self.inform(Update::Notice(why.clone()));
            self.inform(Update::Instruction("Lift your finger from the display.".into()));
            self.inform(Update::Cue(Cue::Lift));
            let until_s = self.now_s() + LIFT_S;
            if self.wait_for(until_s, |executor| executor.are_free(displays))? {
                break;
            }
            if self.operator(OperatorQuestion::Ready(why.clone()))? == Decision::Void {
                return Err(TrialEnd::Void(why));
            }
        }
        self.trial.forget_contacts();
        Ok(())
    }

    /// Whether a finger presses a display, also one that has landed before the trial.
    fn lies_on(&self, finger: u8) -> bool {
        let lines = self.trial.last_lines(finger, LIFTED_MS);
        let presses = |force_n: f64| force_n >= LIFTED_N;
        self.trial.is_touching(finger)
            || !lines.is_empty() && lines.iter().all(|line| line.force_n.is_some_and(presses))
    }

    /// Whether no finger has pressed these displays for some time.
    fn are_free(&self, displays: &[u8]) -> bool {
        displays.iter().all(|finger| {
            let lines = self.trial.last_lines(*finger, LIFTED_MS);
            let presses = |force_n: f64| force_n >= LIFTED_N;
            !self.trial.is_touching(*finger)
                && !lines.iter().any(|line| line.force_n.is_none_or(presses))
        })
    }

    /// A trial with too much force does not count; the participant goes on undisturbed.
    pub(super) fn check_force(&mut self, displays: &[u8]) {
        let max_n = self.session.voids.force_max_n;
        for finger in displays {
            let force_n = self.trial.last_line(*finger).and_then(|line| line.force_n);
            if let Some(force_n) = force_n.filter(|force_n| *force_n > max_n)
                && self.trial.void.is_none()
            {
                let why = format!("a force of {force_n:.2} N; allowed are {max_n} N");
                self.inform(Update::Notice(why.clone()));
                self.trial.void = Some(why);
            }
        }
    }

    /// Checks what can be judged after the contact only.
    fn check_contact(&mut self, trial: &PlannedTrial, displays: &[u8]) {
        let now_s = self.now_s();
        let record = self.trial.record(self.session, trial, None, now_s);
        let rules = &self.session.voids;
        let on_displays = || {
            let stations = trial.presented.iter().zip(&record.stations);
            stations
                .filter(|(presented, _)| presented.device_finger().is_some())
                .map(|(_, station)| station)
        };
        let off_preset = on_displays()
            .filter_map(|station| Some((station.display_c? - station.setpoint_c?).abs()))
            .find(|off_k| *off_k > rules.display_off_preset_k);
        let landings = || displays.iter().filter_map(|finger| self.trial.land_s(*finger));
        let apart_s =
            landings().reduce(f64::max).unwrap_or(0.0) - landings().reduce(f64::min).unwrap_or(0.0);
        let force_off = trial.target_force_n.zip(rules.force_off_target);
        let force_off = force_off.and_then(|(target_n, most)| {
            on_displays()
                .filter_map(|station| station.force_end_mean_n)
                .find(|mean_n| (mean_n - target_n).abs() > most * target_n)
        });
        let why = if let Some(off_k) = off_preset {
            Some(format!(
                "the display was {off_k:.2} K from its set-point at the landing; allowed are {} K",
                rules.display_off_preset_k
            ))
        } else if let Some(contact_s) = (displays.iter())
            .map(|finger| self.trial.contact_s(*finger))
            .find(|contact_s| *contact_s < rules.contact_min_s)
        {
            Some(format!(
                "a contact of {contact_s:.2} s; allowed are {} s or more",
                rules.contact_min_s
            ))
        } else if let Some(mean_n) = force_off {
            Some(format!("a force of {mean_n:.2} N at the end, too far from its target"))
        } else {
            (rules.landings_apart_s.filter(|most_s| apart_s > *most_s))
                .map(|most_s| format!("landings {apart_s:.2} s apart; allowed are {most_s} s"))
        };
        self.trial.void = self.trial.void.take().or(why);
    }
}
