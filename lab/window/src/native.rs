//! Windows on a display: the operator's, and that of the participant during a session.

use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use eframe::egui::{self, ViewportBuilder, ViewportCommand, ViewportId};
use thermal_session::{AnswerKind, Question};

use crate::entry::NumberEntry;
use crate::keys::{Action, WindowKind, action};
use crate::link_quality::ScreenLatency;
use crate::model::{Model, SessionView};
use crate::people::{WindowPeople, WindowSide};
use crate::stop::StopFlag;
use crate::tone::Tones;
use crate::views;

/// Time between two frames: 60 a second, twice what matching a force needs.
const FRAME: Duration = Duration::from_millis(16);

/// What the windows are for.
#[derive(Debug, Default)]
pub struct WindowOptions {
    /// Title of the operator's window.
    pub title: String,
    /// The session; `None` for a monitored device, which has no participant.
    pub session: Option<SessionView>,
    /// The stop, which a handler of signals may press, too.
    pub stop: StopFlag,
    /// Tones for the participant.
    pub tones: Option<Tones>,
}

/// What remains when the windows are closed.
#[derive(Debug)]
pub struct Shown<T, E> {
    /// What the worker returned.
    pub result: Result<T, E>,
    /// How late updates were on the screen.
    pub latency: ScreenLatency,
}

/// Why there are no windows.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// There is no display, or it does not do what windows need. The worker has not begun.
    #[error("no window can be opened: {0}; `--headless` works without one")]
    NoDisplay(String),
    /// The worker ended by an error of its own. A device that streams and is driven trips by `host-silent` within 2 s.
    #[error(
        "the program behind the window has failed; if the device is driven, press the emergency stop"
    )]
    Worker,
}

/// Shows windows, and runs a worker in a thread of its own with the persons at them. Returns when the windows are closed and the
/// worker has ended; closing them while it runs stops it. Must be called by the main thread.
///
/// # Errors
/// See [`WindowError`].
pub fn run_window<T: Send, E: Display + Send>(
    options: WindowOptions,
    worker: impl FnOnce(&mut WindowPeople) -> Result<T, E> + Send,
) -> Result<Shown<T, E>, WindowError> {
    let WindowOptions { title, session, stop, tones } = options;
    let with_participant = session.is_some();
    let (mut people, window_side) = WindowPeople::new(session, stop.clone(), tones);
    let running = AtomicBool::new(false);
    let latency = Mutex::new(ScreenLatency::default());
    thread::scope(|scope| {
        let handle = Mutex::new(None);
        let viewport = ViewportBuilder::default()
            .with_title(&title)
            .with_inner_size([1280.0, 860.0])
            .with_min_inner_size([1000.0, 700.0]);
        let mut native = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
        // Two windows that wait for the monitor one after the other would have half its rate.
        native.glow_options.vsync = false;
        let gone = WindowGone(&stop);
        let (window_side, running, latency, end) =
            (&window_side, &running, &latency, window_side.clone());
        let shown = eframe::run_native(
            &title,
            native,
            Box::new(|context| {
                let state = views::OperatorState { dark: false, ..views::OperatorState::default() };
                views::apply(&context.egui_ctx, state.dark);
                running.store(true, Ordering::SeqCst);
                let spawned = scope.spawn(move || {
                    let _ended = Ended(running, end.clone());
                    let result = worker(&mut people);
                    end.end(result.as_ref().err().map(ToString::to_string));
                    result
                });
                *lock(&handle) = Some(spawned);
                Ok(Box::new(App {
                    window_side,
                    running,
                    latency,
                    state,
                    entry: None,
                    with_participant,
                    full_screen: false,
                }))
            }),
        );
        drop(gone);
        let handle = lock(&handle).take();
        match (handle, shown) {
            (Some(handle), _) => Ok(Shown {
                result: handle.join().map_err(|_| WindowError::Worker)?,
                latency: lock(latency).clone(),
            }),
            (None, Err(error)) => Err(WindowError::NoDisplay(error.to_string())),
            (None, Ok(())) => Err(WindowError::NoDisplay("it was closed before it opened".into())),
        }
    })
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Stops the worker when the windows are gone, also by a panic of the toolkit, as when another program destroys a window: the scope
/// then waits for the worker, which nobody could stop any more.
struct WindowGone<'a>(&'a StopFlag);

impl Drop for WindowGone<'_> {
    fn drop(&mut self) {
        self.0.press_and_close();
    }
}

/// Says that the worker has ended, also by a panic.
struct Ended<'a>(&'a AtomicBool, WindowSide);

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.1.end(Some(WindowError::Worker.to_string()));
        }
        self.0.store(false, Ordering::SeqCst);
    }
}

struct App<'a> {
    window_side: &'a WindowSide,
    running: &'a AtomicBool,
    latency: &'a Mutex<ScreenLatency>,
    state: views::OperatorState,
    /// Numbers of the question that is asked.
    entry: Option<(Question, NumberEntry)>,
    with_participant: bool,
    full_screen: bool,
}

impl eframe::App for App<'_> {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        ctx.request_repaint_after(FRAME);
        let (model, waited) = self.window_side.snapshot();
        if let Some(waited) = waited {
            self.state.latency.add(waited);
            *lock(self.latency) = self.state.latency.clone();
        }
        self.keep_entry(&model);
        let mut actions = keys(&ctx, WindowKind::Operator, &model);
        actions.extend(views::operator(ui, &model, &mut self.state, self.window_side.now()));
        if self.with_participant {
            actions.extend(self.participant(&ctx, &model));
        }
        for one in actions {
            self.act(one, &model, &ctx);
        }
        self.close(&ctx);
    }
}

fn keys(ctx: &egui::Context, window: WindowKind, model: &Model) -> Vec<Action> {
    let keys = views::pressed(ctx).into_iter();
    keys.filter_map(|key| action(key, window, model)).collect()
}

impl App<'_> {
    /// Begins the numbers of a new question, and forgets those of one that is over.
    fn keep_entry(&mut self, model: &Model) {
        let participant = model.participant();
        let asked = participant.question.as_ref();
        if self.entry.as_ref().map(|(question, _)| question) == asked {
            return;
        }
        self.entry = asked.and_then(|question| {
            let AnswerKind::NumberPerStation(least, most) = question.kind else {
                return None;
            };
            let entry = NumberEntry::new((least, most), participant.stations.len());
            Some((question.clone(), entry))
        });
    }

    /// The participant's window, a second one of the system, which may be on another monitor.
    fn participant(&mut self, ctx: &egui::Context, model: &Model) -> Vec<Action> {
        let builder = ViewportBuilder::default()
            .with_title("Participant")
            .with_inner_size([1024.0, 768.0])
            .with_fullscreen(self.full_screen);
        let now = self.window_side.now();
        let entry = &mut self.entry;
        ctx.show_viewport_immediate(ViewportId::from_hash_of("participant"), builder, |ui, _| {
            let mut actions = keys(ui.ctx(), WindowKind::Participant, model);
            views::participant_style(ui.style_mut());
            let frame = egui::Frame::new().fill(ui.visuals().panel_fill).inner_margin(24.0);
            egui::CentralPanel::default().frame(frame).show(ui, |ui| {
                let entry = entry.as_mut().map(|(_, entry)| entry);
                let response = views::participant(ui, model.participant(), entry, now);
                actions.extend(response.map(Action::Respond));
            });
            actions
        })
    }

    fn act(&mut self, one: Action, model: &Model, ctx: &egui::Context) {
        match one {
            Action::Stop => self.window_side.press_stop(),
            Action::Decide(decision) => self.window_side.decide(decision),
            Action::Order(order) => self.window_side.order(order),
            Action::Respond(response) => self.window_side.respond(response),
            Action::Enter(key) => {
                let entry = self.entry.as_mut();
                if let Some(response) = entry.and_then(|(_, entry)| entry.press(key)) {
                    self.window_side.respond(response);
                }
            }
            Action::FullScreen => self.full_screen = !self.full_screen,
            Action::NextFinger => self.state.next_finger(model),
            Action::Theme => {
                self.state.dark = !self.state.dark;
                views::apply(ctx, self.state.dark);
            }
        }
    }

    /// A window that is closed while the worker runs waits until that has switched the bridge off.
    fn close(&self, ctx: &egui::Context) {
        let is_running = self.running.load(Ordering::SeqCst);
        if ctx.input(|input| input.viewport().close_requested()) && is_running {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.window_side.close();
        }
        if self.window_side.stop().is_closing() && !is_running {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}
