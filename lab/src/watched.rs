//! A session of a simulated participant, and those who watch it.

use std::io::Write;

use thermal_client::text::escaped_text;
use thermal_session::{Decision, People, Response, Update};
use thermal_window::StopFlag;

/// A simulated participant with a simulated operator, watched by somebody who can stop the session.
pub struct Watched<'a, P> {
    simulated: P,
    watcher: &'a mut dyn People,
}

impl<'a, P> Watched<'a, P> {
    /// A simulated participant and operator, and who watches them.
    pub const fn new(simulated: P, watcher: &'a mut dyn People) -> Self {
        Self { simulated, watcher }
    }
}

impl<P: People> People for Watched<'_, P> {
    fn inform(&mut self, update: &Update) {
        self.simulated.inform(update);
        self.watcher.inform(update);
    }

    fn response(&mut self) -> Option<Response> {
        // The watcher's keys answer nothing, and do not wait for the next question either.
        let _ignored = self.watcher.response();
        self.simulated.response()
    }

    fn decision(&mut self) -> Option<Decision> {
        let watcher = self.watcher.decision();
        let simulated = self.simulated.decision();
        watcher.filter(|decision| *decision == Decision::Stop).or(simulated)
    }
}

/// A watcher at a terminal: a line for each trial.
pub struct Progress<'a> {
    screen: &'a mut dyn Write,
    stop: &'a StopFlag,
    trial: String,
    answer: String,
}

impl<'a> Progress<'a> {
    /// A watcher who writes here, and presses this stop.
    pub fn new(screen: &'a mut dyn Write, stop: &'a StopFlag) -> Self {
        Self { screen, stop, trial: String::new(), answer: String::new() }
    }

    fn tell(&mut self, text: &str) {
        // What is on the screen changes nothing of the session.
        let _ignored = writeln!(self.screen, "{}", escaped_text(text));
    }
}

impl People for Progress<'_> {
    fn inform(&mut self, update: &Update) {
        match update {
            Update::Trial { trial, attempt, of } => {
                let levels = trial.levels.join(" ");
                let again =
                    if *attempt > 1 { format!(", attempt {attempt}") } else { String::new() };
                self.trial = format!(
                    "trial {} of {of}, block {}{again}: {levels}",
                    trial.number, trial.block
                );
                self.answer.clear();
            }
            Update::Answered(Some(_)) => self.answer = ", answered".into(),
            Update::TrialEnded { void } => {
                let why = void.as_ref().map_or(String::new(), |why| format!(", void: {why}"));
                let line = format!("{}{}{why}", self.trial, self.answer);
                self.tell(&line);
            }
            Update::Notice(text) => self.tell(text),
            _ => {}
        }
    }

    fn response(&mut self) -> Option<Response> {
        None
    }

    fn decision(&mut self) -> Option<Decision> {
        self.stop.is_pressed().then_some(Decision::Stop)
    }
}
