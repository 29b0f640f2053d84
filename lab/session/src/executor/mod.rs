//! Runs a session: sets up the device, leads participant and operator through the trials, and records each.
//!
//! ```text
//! connect -> [ rest -> prepare -> reach -> contact -> respond -> return ] ... break ... -> end
//! ```
//!
//! The device is set up anew at each trial, so one that has restarted between two trials is no problem. A trip, a refused line
//! or a restart within a trial makes that trial void.

mod connect;
mod fingers;
mod gate;
mod intervals;
mod set_up;
mod touch;
mod trial;
mod wait;

use thermal_client::client::{Client, ClientError};
use thermal_client::link::{Link, LinkError};

use crate::dataset::{Recorder, RecordingError};
use crate::record::TrialRecord;
use crate::schedule::{Next, Schedule};
use crate::{Decision, OperatorQuestion, People, Phase, Plan, Procedure, Session, Update};

pub use connect::check_device;
use fingers::Fingers;
use trial::RunningTrial;

/// Step in which the session's clock counts, s.
const CLOCK_STEP_S: f64 = 1e-4;
/// Void trials in sequence after which the operator is asked.
const VOIDS_IN_SEQUENCE: usize = 3;

/// Why a session has ended before its last trial. What was recorded until then is whole, and the session can be resumed.
#[derive(Debug, thiserror::Error)]
pub enum SessionEnd {
    /// The operator has stopped it, or the program was asked to end.
    #[error("stopped by the operator; --resume goes on with the trial that was running")]
    Stopped,
    /// The device can no longer be reached.
    #[error(
        "the device is gone: {0}. Check cable and power; a device without a host switches its bridge off after 2 s. \
         --resume goes on with the trial that was running"
    )]
    Gone(String),
    /// The device has not confirmed that its bridge is off.
    #[error("{0}. What was recorded is whole")]
    NotOff(ClientError),
    /// The device cannot run the session.
    #[error("the device cannot run this session: {0}")]
    Unsuitable(String),
    /// The data cannot be written.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

/// Why a trial does not go on.
#[derive(Debug)]
enum TrialEnd {
    /// Its data do not count, for this reason; the session goes on.
    Void(String),
    /// The device has tripped by the fault with this word.
    Tripped(&'static str),
    /// The session ends.
    Session(SessionEnd),
}

impl<E: Into<SessionEnd>> From<E> for TrialEnd {
    fn from(end: E) -> Self {
        Self::Session(end.into())
    }
}

impl From<LinkError> for SessionEnd {
    fn from(error: LinkError) -> Self {
        match error {
            LinkError::Gone(why) => Self::Gone(why),
            LinkError::Interrupted => Self::Stopped,
        }
    }
}

/// What a command without its reply means for the trial. A device that answers nothing at all is found before the next one.
fn trial_end_of(error: ClientError) -> TrialEnd {
    match error {
        ClientError::Link(error) => error.into(),
        other => TrialEnd::Void(other.to_string()),
    }
}

/// A session while it runs.
pub struct Executor<'a, L> {
    session: &'a Session,
    client: Client<L>,
    people: &'a mut dyn People,
    recorder: &'a mut Recorder,
    /// What is added to the link's clock to give that of the session, ns.
    clock_offset_ns: i64,
    /// The device's fingers.
    fingers: Fingers,
    /// The trial that runs, or has run last.
    trial: RunningTrial,
    /// What the operator has decided, until it is used.
    decision: Option<Decision>,
    /// Whether the operator is being asked.
    operator_is_asked: bool,
    /// Time of the last line of telemetry, or of the command from which on it must come, s; `None` while the device does not
    /// stream.
    streaming_since_s: Option<f64>,
    /// Whether the session's clock runs, so that what happens is recorded. Before that the device is connected.
    is_recording: bool,
}

impl<'a, L: Link> Executor<'a, L> {
    /// A session on the device of a client, recorded by a recorder, which knows the trials of an earlier run. A session without
    /// displays and skin thermistors sends nothing, and only the clock of the client's link counts.
    pub fn new(
        session: &'a Session,
        client: Client<L>,
        people: &'a mut dyn People,
        recorder: &'a mut Recorder,
    ) -> Self {
        Self {
            session,
            client,
            people,
            recorder,
            clock_offset_ns: 0,
            fingers: Fingers::default(),
            trial: RunningTrial::default(),
            decision: None,
            operator_is_asked: false,
            streaming_since_s: None,
            is_recording: false,
        }
    }

    /// Runs the trials that the recorder does not have yet. Whatever happens, the bridge is switched off at the end, and what
    /// was recorded is written out as a data set.
    ///
    /// # Errors
    /// The session has ended early.
    pub fn run(mut self, plan: &Plan, schedule: Schedule<'_>) -> Result<(), SessionEnd> {
        let ended = self.run_trials(plan, schedule);
        self.phase(Phase::End);
        let off = self.switch_off();
        if off.is_ok() && self.session.needs_device() {
            // The disk may take seconds.
            self.inform(Update::Notice("bridge off; the data set is being written".into()));
        }
        let written = self.recorder.finish().map_err(SessionEnd::from);
        let ended = match off {
            // Nothing is more important than a bridge that may be on.
            Err(end @ SessionEnd::NotOff(_)) => Err(end),
            off => ended.and(off).and(written),
        };
        let why = ended.as_ref().err().map(ToString::to_string);
        self.people.inform(&Update::Ended(why));
        ended
    }

    fn run_trials(&mut self, plan: &Plan, mut schedule: Schedule<'_>) -> Result<(), SessionEnd> {
        self.phase(Phase::Connect);
        if self.session.needs_device() {
            self.connect(plan)?;
        }
        if !self.recorder.records().is_empty() {
            self.operator(OperatorQuestion::Ready("the session goes on".into()))?;
        }
        // The session's clock goes on where the last recorded trial has ended.
        self.clock_offset_ns = self.recorder.end_ns() - self.link_ns();
        self.is_recording = true;
        while let Some(next) = schedule.next_trial() {
            if next.break_before {
                self.take_a_break()?;
            }
            let first_of_part = (plan.trials.iter()).find(|trial| trial.part == next.trial.part);
            if first_of_part == Some(next.trial) && next.attempt == 1 {
                self.instruct(&next.trial.part)?;
            }
            let record = self.run_trial(&next, plan.trials.len())?;
            schedule.ended(&record);
        }
        for number in schedule.given_up() {
            self.inform(Update::Notice(format!(
                "trial {number} was void in all its attempts and is left out"
            )));
        }
        Ok(())
    }

    /// Runs a trial and records it.
    fn run_trial(&mut self, next: &Next<'_>, of: usize) -> Result<TrialRecord, SessionEnd> {
        self.recorder.check_disk()?;
        self.drop_late_lines()?;
        self.trial = RunningTrial::new(next, self.now_s(), self.fingers.count());
        self.inform(Update::Trial { trial: next.trial.clone(), attempt: next.attempt, of });
        self.ask_about_voids()?;
        self.meet_device(next.trial)?;
        // After a time in which this program did not run they are of before the device was met, and may say that it is tripped.
        self.drop_late_lines()?;
        let void = match self.conduct(next) {
            Ok(()) => self.trial.void.take(),
            Err(TrialEnd::Void(why)) => Some(why),
            Err(TrialEnd::Tripped(fault)) => Some(format!("the device tripped: {fault}")),
            Err(TrialEnd::Session(end)) => return Err(end),
        };
        self.take_late_lines()?;
        self.inform(Update::TargetForce(None));
        self.inform(Update::TrialEnded { void: void.clone() });
        let end_s = self.now_s();
        let record = self.trial.record(self.session, next.trial, void, end_s);
        (self.recorder).trial_ended(&record, self.trial.telemetry())?;
        Ok(record)
    }

    fn conduct(&mut self, next: &Next<'_>) -> Result<(), TrialEnd> {
        self.set_up_device(next.trial)?;
        match self.session.trial.procedure {
            Procedure::Touch { reach_s, contact, max_s } => {
                self.touch(next.trial, reach_s, contact, max_s)
            }
            Procedure::Intervals { interval_s, gap_s } => self.intervals(next, interval_s, gap_s),
        }
    }

    /// Lets the participant read the instruction of a part.
    fn instruct(&mut self, part: &str) -> Result<(), SessionEnd> {
        let of_part = self.session.design.part(part).and_then(|part| part.instruction.clone());
        let text = of_part.unwrap_or_else(|| self.session.instruction.clone());
        if text.trim().is_empty() {
            return Ok(());
        }
        self.inform(Update::Instruction(text));
        let ready = "the participant has read the instruction".into();
        self.operator(OperatorQuestion::Ready(ready))?;
        Ok(())
    }

    /// Asks the operator after some void trials in sequence, so that an absent participant does not use up the plan.
    fn ask_about_voids(&mut self) -> Result<(), SessionEnd> {
        let records = self.recorder.records();
        let voids = records.iter().rev().map_while(|record| record.void.clone());
        let voids: Vec<_> = voids.collect();
        if voids.is_empty() || !voids.len().is_multiple_of(VOIDS_IN_SEQUENCE) {
            return Ok(());
        }
        let text =
            format!("{} trials in sequence were void, the last one: {}", voids.len(), voids[0]);
        self.operator(OperatorQuestion::Ready(text))?;
        Ok(())
    }

    /// Waits for the shortest break, and then for the operator.
    fn take_a_break(&mut self) -> Result<(), SessionEnd> {
        // Counted from the last trial, so that a resumed session has the same times.
        let end_s = seconds(self.recorder.end_ns()) + self.session.break_s;
        self.switch_off()?;
        self.phase(Phase::Break);
        // The next trial finds a device that has tripped or restarted.
        self.wait_between_trials(end_s)?;
        self.operator(OperatorQuestion::BreakOver)?;
        Ok(())
    }

    /// Tells participant and operator, and records it.
    fn inform(&mut self, update: Update) {
        if self.is_recording {
            let now_s = self.now_s();
            self.recorder.update(now_s, &update);
        }
        self.people.inform(&update);
    }

    fn phase(&mut self, phase: Phase) {
        self.inform(Update::Phase(phase));
    }

    /// Time by the link's clock, ns.
    fn link_ns(&mut self) -> i64 {
        self.client.link().now().as_nanos() as i64
    }

    /// Time by the session's clock, s.
    fn now_s(&mut self) -> f64 {
        seconds(self.link_ns() + self.clock_offset_ns)
    }
}

/// Seconds of a time in ns, rounded to 0.1 ms, so that a resumed session, whose clock has another offset, records the same times.
fn seconds(ns: i64) -> f64 {
    (ns as f64 / 1e5).round() / 1e4
}
