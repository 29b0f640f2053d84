//! The two persons at the windows: the side of the executor, and the side of the windows.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use thermal_session::{Decision, People, Response, Update};

use crate::model::{Model, SessionView};
use crate::monitor::{MonitorPeople, Order};
use crate::stop::StopFlag;
use crate::tone::Tones;

/// What windows and worker share.
///
/// Updates are folded where they arise, in the worker's thread: there is no queue that could grow, and the windows hold the lock
/// only to copy the model.
#[derive(Debug)]
struct Shared {
    model: Model,
    response: Option<Response>,
    decision: Option<Decision>,
    order: Option<Order>,
    /// When the oldest update came that no frame has drawn.
    undrawn_since: Option<Duration>,
}

/// The windows' end: gives copies of the model, and takes what is pressed.
#[derive(Clone, Debug)]
pub struct WindowSide {
    shared: Arc<Mutex<Shared>>,
    stop: StopFlag,
    zero: Instant,
}

/// The worker's end: participant and operator at the windows. Nothing waits here.
#[derive(Debug)]
pub struct WindowPeople {
    window_side: WindowSide,
    tones: Option<Tones>,
}

impl WindowPeople {
    /// Persons at the windows of a session, or of a monitored device; and the windows' end.
    pub fn new(
        session: Option<SessionView>,
        stop: StopFlag,
        tones: Option<Tones>,
    ) -> (Self, WindowSide) {
        let shared = Shared {
            model: Model::new(session),
            response: None,
            decision: None,
            order: None,
            undrawn_since: None,
        };
        let window_side =
            WindowSide { shared: Arc::new(Mutex::new(shared)), stop, zero: Instant::now() };
        (Self { window_side: window_side.clone(), tones }, window_side)
    }

    /// The operator's stop.
    pub const fn stop(&self) -> &StopFlag {
        &self.window_side.stop
    }
}

impl People for WindowPeople {
    fn inform(&mut self, update: &Update) {
        if let (Update::Cue(cue), Some(tones)) = (update, &self.tones) {
            tones.play(*cue);
        }
        let at = self.window_side.now();
        let mut shared = self.window_side.shared();
        match update {
            // What was pressed before the question is no answer to it.
            Update::Ask(_) | Update::Answered(_) => shared.response = None,
            Update::Decide(_) => shared.decision = None,
            _ => {}
        }
        shared.model.fold(update, at);
        shared.undrawn_since = shared.undrawn_since.or(Some(at));
    }

    fn response(&mut self) -> Option<Response> {
        self.window_side.shared().response.take()
    }

    fn decision(&mut self) -> Option<Decision> {
        if self.window_side.stop.is_pressed() {
            return Some(Decision::Stop);
        }
        self.window_side.shared().decision.take()
    }
}

impl MonitorPeople for WindowPeople {
    fn order(&mut self) -> Option<Order> {
        let mut shared = self.window_side.shared();
        if self.window_side.stop.take() {
            // Orders from before the stop do not come after it.
            shared.order = None;
            shared.model.set_stopped(false);
            return Some(Order::Off);
        }
        shared.order.take()
    }

    fn is_closing(&self) -> bool {
        self.window_side.stop.is_closing()
    }
}

impl WindowSide {
    fn shared(&self) -> MutexGuard<'_, Shared> {
        // A panic elsewhere leaves a model that can be shown, and a stop that must work.
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Time since the beginning.
    pub fn now(&self) -> Duration {
        self.zero.elapsed()
    }

    /// The model for a frame, and how long its oldest update has waited for it.
    pub fn snapshot(&self) -> (Model, Option<Duration>) {
        let mut shared = self.shared();
        let waited = shared.undrawn_since.take();
        let model = shared.model.clone();
        (model, waited.map(|since| self.now().saturating_sub(since)))
    }

    /// The participant's answer; the first one to a question counts.
    pub fn respond(&self, response: Response) {
        let mut shared = self.shared();
        let participant = shared.model.participant();
        if participant.question.is_some() && !participant.answered {
            shared.response = Some(response);
            shared.model.responded();
        }
    }

    /// The operator's decision; the first one to a question counts, and the stop always.
    pub fn decide(&self, decision: Decision) {
        if decision == Decision::Stop {
            self.press_stop();
            return;
        }
        let mut shared = self.shared();
        if shared.model.question().is_some() {
            shared.decision = Some(decision);
            shared.model.decided();
        }
    }

    /// An order to a monitored device.
    pub fn order(&self, order: Order) {
        if order == Order::Off {
            self.press_stop();
        } else {
            self.shared().order = Some(order);
        }
    }

    /// Stops: bridge off.
    pub fn press_stop(&self) {
        self.stop.press();
        self.show_stop();
    }

    fn show_stop(&self) {
        let mut shared = self.shared();
        let is_running = shared.model.end().is_none();
        shared.model.set_stopped(is_running);
    }

    /// Stops, and closes the windows when the worker has ended.
    pub fn close(&self) {
        self.stop.press_and_close();
        self.show_stop();
    }

    /// The stop.
    pub const fn stop(&self) -> &StopFlag {
        &self.stop
    }

    /// The worker has ended: completed, or for a reason; the executor may have said so before.
    pub fn end(&self, reason: Option<String>) {
        let at = self.now();
        let mut shared = self.shared();
        if shared.model.end().is_none() {
            shared.model.end_by(reason, at);
        }
    }
}
