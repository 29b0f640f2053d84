//! What is known of session and device, folded from what the worker says: no display, no clock of its own.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use thermal_client::client::{ReceivedEvent, ReceivedTelemetry, Telemetry};
use thermal_device::events::DeviceEventKind;
use thermal_session::{
    OperatorQuestion, Phase, PlannedTrial, Presented, Rest, Session, Station, TrialRules, Update,
    skin_sensors,
};

use crate::gate::{Gate, SkinGate, Waiting};
use crate::link_quality::LinkQuality;
use crate::participant::{Follow, ParticipantView, ShownCue};
use crate::texts;
use crate::trace::Trace;

/// Notices that are kept.
const NOTICES_MAX: usize = 200;
/// Most fingers of a device that are shown; a damaged number makes no more.
const FINGERS_MAX: u8 = 8;

/// What of a session is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct SessionView {
    /// Its title.
    pub title: String,
    /// Where the fingers go.
    pub stations: Vec<Station>,
    /// Condition on the skin before each trial, from the session file; `None` if there is none.
    pub rest: Option<Rest>,
    /// How a trial proceeds.
    pub rules: TrialRules,
    /// Shortest break, s.
    pub break_s: f64,
    /// What the operator should know before the first trial, in sentences.
    pub warnings: Vec<String>,
}

impl From<&Session> for SessionView {
    fn from(session: &Session) -> Self {
        Self {
            title: session.title.clone(),
            stations: session.stations.clone(),
            rest: session.rest,
            rules: session.trial.clone(),
            break_s: session.break_s,
            warnings: Vec::new(),
        }
    }
}

/// A finger of the device.
#[derive(Clone, Debug)]
pub struct FingerView {
    /// Its last line of telemetry.
    pub last: Telemetry,
    /// Its last 20 s.
    pub trace: Trace,
}

/// The trial that runs.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialView {
    /// The trial.
    pub trial: PlannedTrial,
    /// Number of the attempt, from 1.
    pub attempt: u32,
    /// Number of trials of the plan.
    pub of: usize,
}

/// A notice and when it came.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// When it came.
    pub at: Duration,
    /// Its text.
    pub text: String,
}

/// How the worker ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// Completed.
    Completed,
    /// Not, for this reason.
    Broken(String),
}

/// All that windows show. Its memory is bounded, whatever it is told.
#[derive(Clone, Debug, Default)]
pub struct Model {
    session: Option<SessionView>,
    fingers: BTreeMap<u8, FingerView>,
    phase: Option<(Phase, Duration)>,
    landed_at: Option<Duration>,
    skin: SkinGate,
    trial: Option<TrialView>,
    question: Option<OperatorQuestion>,
    participant: ParticipantView,
    notices: VecDeque<Notice>,
    link: LinkQuality,
    stopped: bool,
    end: Option<End>,
}

impl Model {
    /// Nothing is known yet; `None` without a session.
    pub fn new(session: Option<SessionView>) -> Self {
        let stations = session.iter().flat_map(|session| &session.stations);
        Self {
            participant: ParticipantView {
                stations: stations.map(|station| station.name.clone()).collect(),
                ..ParticipantView::default()
            },
            session,
            ..Self::default()
        }
    }

    /// Takes note of an update that came at a time.
    pub fn fold(&mut self, update: &Update, at: Duration) {
        match update {
            Update::Trial { trial, attempt, of } => {
                self.trial = Some(TrialView { trial: trial.clone(), attempt: *attempt, of: *of });
                self.set_question(None);
                (self.participant.cue, self.participant.question) = (None, None);
                self.participant.follow = None;
            }
            Update::Phase(phase) => self.begin_phase(*phase, at),
            Update::Cue(cue) => {
                self.participant.cue = Some(ShownCue { cue: *cue, at });
                self.participant.instruction = None;
            }
            Update::Instruction(text) => {
                self.participant.instruction = (!text.is_empty()).then(|| text.clone());
            }
            Update::Ask(question) => {
                let participant = &mut self.participant;
                participant.question = Some(question.clone());
                (participant.cue, participant.instruction) = (None, None);
                participant.answered = false;
            }
            Update::Answered(_) => self.participant.question = None,
            Update::Feedback { is_correct } => {
                self.participant.instruction = Some(texts::feedback(*is_correct).into());
            }
            Update::Decide(question) => self.set_question(Some(question.clone())),
            Update::Decided(_) => self.set_question(None),
            Update::TargetForce(target_n) => {
                let follow = target_n.filter(|target_n| *target_n > 0.0);
                self.participant.follow = follow.map(|target_n| Follow::new(target_n, at));
            }
            Update::Telemetry(received) => self.add_telemetry(received, at),
            Update::Event(event) => self.add_event(event, at),
            Update::TrialEnded { void } => {
                self.participant.question = None;
                self.participant.follow = None;
                if let Some(reason) = void {
                    let number = self.trial.as_ref().map_or(0, |view| view.trial.number);
                    self.note(format!("trial {number} is void: {reason}"), at);
                }
            }
            Update::Notice(text) => self.note(text.clone(), at),
            Update::Ended(reason) => self.end_by(reason.clone(), at),
        }
    }

    fn begin_phase(&mut self, phase: Phase, at: Duration) {
        self.phase = Some((phase, at));
        self.participant.phase = Some(phase);
        self.set_question(None);
        self.landed_at = None;
        if phase == Phase::Rest {
            self.skin.holds_since = None;
            self.participant.cue = None;
        }
    }

    fn set_question(&mut self, question: Option<OperatorQuestion>) {
        self.participant.waits = matches!(
            question,
            Some(OperatorQuestion::Tripped { .. } | OperatorQuestion::SkinNotReady { .. })
        );
        self.question = question;
    }

    fn add_telemetry(&mut self, received: &ReceivedTelemetry, at: Duration) {
        let finger = received.finger.unwrap_or(0);
        if finger >= FINGERS_MAX {
            return;
        }
        self.link.add(received.lost_before, at);
        let telemetry = &received.telemetry;
        let view = self
            .fingers
            .entry(finger)
            .or_insert_with(|| FingerView { last: *telemetry, trace: Trace::default() });
        view.last = *telemetry;
        view.trace.push(telemetry);
        if let Some(rest) = self.session.as_ref().and_then(|session| session.rest.as_ref()) {
            // As the executor: by the thermistors of the running trial only, whatever other fingers have reported before.
            let running = self.session.iter().zip(&self.trial);
            let sensors = running
                .flat_map(|(session, view)| skin_sensors(&session.stations, &view.trial.presented));
            let means = sensors.map(|sensor| self.fingers.get(&sensor)?.trace.skin_c());
            self.skin.observe(rest, means, at);
        }
        if finger == self.followed_finger()
            && let (Some(follow), Some(force_n)) = (&mut self.participant.follow, telemetry.force_n)
        {
            follow.add(force_n, at);
        }
    }

    /// The finger whose force the participant sees: the first display of the trial.
    fn followed_finger(&self) -> u8 {
        let presented = self.trial.iter().flat_map(|view| &view.trial.presented);
        let mut fingers = presented.filter_map(Presented::device_finger);
        fingers.next().unwrap_or(0)
    }

    fn add_event(&mut self, event: &ReceivedEvent, at: Duration) {
        let in_contact = matches!(self.phase, Some((Phase::Contact, _)));
        if event.event.kind == DeviceEventKind::Land && in_contact {
            self.landed_at = self.landed_at.or(Some(at));
        }
    }

    fn note(&mut self, text: String, at: Duration) {
        if self.notices.len() == NOTICES_MAX {
            self.notices.pop_front();
        }
        self.notices.push_back(Notice { at, text });
    }

    /// The worker has ended, completed or for a reason.
    pub(crate) fn end_by(&mut self, reason: Option<String>, at: Duration) {
        self.set_question(None);
        self.stopped = false;
        self.participant = ParticipantView {
            stations: std::mem::take(&mut self.participant.stations),
            phase: Some(Phase::End),
            ended: true,
            ..ParticipantView::default()
        };
        self.note(reason.clone().unwrap_or_else(|| "completed".into()), at);
        self.end = Some(reason.map_or(End::Completed, End::Broken));
    }

    /// The operator has decided.
    pub(crate) fn decided(&mut self) {
        self.set_question(None);
    }

    /// The participant has answered at this window.
    pub(crate) const fn responded(&mut self) {
        self.participant.answered = true;
    }

    /// The operator has stopped, or the stop was carried out.
    pub(crate) const fn set_stopped(&mut self, stopped: bool) {
        self.stopped = stopped;
    }

    /// The session; `None` while a device is monitored.
    pub const fn session(&self) -> Option<&SessionView> {
        self.session.as_ref()
    }

    /// The fingers of the device.
    pub const fn fingers(&self) -> &BTreeMap<u8, FingerView> {
        &self.fingers
    }

    /// Phase and since when.
    pub const fn phase(&self) -> Option<(Phase, Duration)> {
        self.phase
    }

    /// The trial that runs.
    pub const fn trial(&self) -> Option<&TrialView> {
        self.trial.as_ref()
    }

    /// What is to be placed where.
    pub fn placement(&self) -> Vec<String> {
        let both = self.session.as_ref().zip(self.trial.as_ref());
        both.map_or_else(Vec::new, |(session, view)| {
            texts::placement(&session.stations, &view.trial)
        })
    }

    /// What the session waits for.
    pub fn gate(&self, now: Duration) -> Option<Gate> {
        let (phase, since) = self.phase.filter(|_| self.end.is_none())?;
        let session = self.session.as_ref()?;
        let waiting = Waiting {
            phase,
            since,
            rest: session.rest.as_ref(),
            rules: &session.rules,
            break_s: session.break_s,
            skin: &self.skin,
            landed_at: self.landed_at,
        };
        waiting.gate(now)
    }

    /// What the operator is asked.
    pub const fn question(&self) -> Option<&OperatorQuestion> {
        self.question.as_ref()
    }

    /// What the participant sees.
    pub const fn participant(&self) -> &ParticipantView {
        &self.participant
    }

    /// The notices, the oldest first.
    pub const fn notices(&self) -> &VecDeque<Notice> {
        &self.notices
    }

    /// The line to the device.
    pub const fn link(&self) -> &LinkQuality {
        &self.link
    }

    /// Whether the operator has stopped, and the worker has not carried it out yet.
    pub const fn is_stopped(&self) -> bool {
        self.stopped
    }

    /// How the worker ended.
    pub const fn end(&self) -> Option<&End> {
        self.end.as_ref()
    }
}
