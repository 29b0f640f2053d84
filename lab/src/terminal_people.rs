//! Operator and participant at one terminal, without a window: plain lines out, lines of standard input in.

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::mpsc::TryRecvError;

use thermal_client::client::ReceivedTelemetry;
use thermal_client::text::escaped_text;
use thermal_device::StateName;
use thermal_session::{AnswerKind, Decision, OperatorQuestion, People, Question, Response, Update};
use thermal_window::{MonitorPeople, Order, StopFlag, Tones, texts};

use crate::bench_operator::Lines;

/// What is entered to end everything with the bridge off.
const STOP: &str = "stop";
/// Ticks between two lines of readings.
const READINGS_EVERY_TICKS: u32 = 1000;

/// Two persons who share a terminal. Answers are numbers, decisions are letters, so that neither is taken for the other.
pub struct TerminalPeople<'a> {
    lines: Lines,
    screen: &'a mut dyn Write,
    stop: StopFlag,
    tones: Option<Tones>,
    /// Whether readings are printed, as a monitor does.
    readings: bool,
    question: Option<Question>,
    stations: usize,
    to_decide: Option<OperatorQuestion>,
    response: Option<Response>,
    decision: Option<Decision>,
    order: Option<Order>,
    /// Last state of each finger.
    states: BTreeMap<Option<u8>, StateName>,
    last_tick: Option<u32>,
    ended: bool,
}

impl<'a> TerminalPeople<'a> {
    /// Persons of a session with so many stations.
    pub fn of_session(
        lines: Lines,
        screen: &'a mut dyn Write,
        stop: StopFlag,
        tones: Option<Tones>,
        stations: usize,
    ) -> Self {
        Self {
            lines,
            screen,
            stop,
            tones,
            readings: false,
            question: None,
            stations,
            to_decide: None,
            response: None,
            decision: None,
            order: None,
            states: BTreeMap::new(),
            last_tick: None,
            ended: false,
        }
    }

    /// The operator of a monitored device.
    pub fn of_monitor(lines: Lines, screen: &'a mut dyn Write, stop: StopFlag) -> Self {
        let mut people = Self::of_session(lines, screen, stop, None, 0);
        people.readings = true;
        people.tell("`arm`, `clear`, `abort` (bridge off); `stop` ends with the bridge off");
        people.tell(texts::EMERGENCY_STOP);
        people
    }

    fn tell(&mut self, text: &str) {
        // What is on the screen changes nothing of the session.
        let _ignored =
            writeln!(self.screen, "{}", escaped_text(text)).and_then(|()| self.screen.flush());
    }

    /// Takes what was entered meanwhile; never waits.
    fn look(&mut self) {
        loop {
            match self.lines.try_recv() {
                Ok(Ok(line)) => self.enter(line.trim()),
                Ok(Err(_)) => {}
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => {
                    // Nobody is there to answer any more.
                    if !self.ended {
                        self.ended = true;
                        self.tell("standard input has ended: stopped");
                        self.stop.press_and_close();
                    }
                    return;
                }
            }
        }
    }

    fn enter(&mut self, line: &str) {
        if line.eq_ignore_ascii_case(STOP) {
            self.stop.press_and_close();
            return;
        }
        if self.readings {
            let orders = [Order::Off, Order::Arm, Order::Clear];
            match orders.into_iter().find(|order| order.word() == line) {
                Some(order) => self.order = Some(order),
                None if line.is_empty() => {}
                None => {
                    self.tell(&format!("'{line}' is no order; allowed: arm, clear, abort, stop"))
                }
            }
            return;
        }
        if let Some(question) = &self.to_decide {
            let mut choices = texts::choices(question).iter();
            let choice = choices.find(|choice| line.eq_ignore_ascii_case(&choice.key.to_string()));
            if let Some(choice) = choice {
                self.decision = Some(choice.decision);
                self.to_decide = None;
                return;
            }
        }
        if let Some(question) = &self.question {
            match response(question, self.stations, line) {
                Ok(response) => {
                    self.response = Some(response);
                    self.question = None;
                }
                Err(why) => self.tell(&why),
            }
        } else if !line.is_empty() {
            self.tell(&format!("'{line}' is not expected now; `stop` ends with the bridge off"));
        }
    }

    fn ask(&mut self, question: &Question) {
        self.tell(&question.ask);
        match &question.kind {
            AnswerKind::OneOf(words) => {
                let lines = words
                    .iter()
                    .enumerate()
                    .map(|(index, word)| format!("  {}  {word}", index + 1));
                let lines: Vec<_> = lines.collect();
                self.tell(&lines.join("\n"));
            }
            AnswerKind::NumberPerStation(least, most) => {
                let text = format!(
                    "  {} numbers from {least} to {most}, with spaces between",
                    self.stations
                );
                self.tell(&text);
            }
        }
        self.question = Some(question.clone());
        self.response = None;
    }

    fn decide(&mut self, question: &OperatorQuestion) {
        let (title, text) = texts::question(question);
        self.tell(&format!("{title}: {text}"));
        for choice in texts::choices(question) {
            self.tell(&format!("  {}  {}", choice.key, choice.label));
        }
        self.to_decide = Some(question.clone());
        self.decision = None;
    }

    /// State when it changes, and readings once a second.
    fn telemetry(&mut self, received: &ReceivedTelemetry) {
        let telemetry = &received.telemetry;
        let before = self.states.insert(received.finger, telemetry.state);
        if before != Some(telemetry.state) {
            let (word, meaning) = texts::state(telemetry.state);
            let of = received.finger.map_or(String::new(), |finger| format!("finger {finger}: "));
            self.tell(&format!("{of}{word}: {meaning}"));
            if let Some(fault) = telemetry.fault() {
                let words = thermal_client::fault_words(fault);
                self.tell(&format!(
                    "  {}: {}. What to do: {}.",
                    fault.name(),
                    words.meaning,
                    words.remedy
                ));
            }
        }
        let due = self
            .last_tick
            .is_none_or(|last| telemetry.tick.wrapping_sub(last) >= READINGS_EVERY_TICKS);
        if self.readings && due {
            self.last_tick = Some(telemetry.tick);
            let number =
                |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.2}"));
            let text = format!(
                "set-point {} C, display {} C, skin {} C, force {} N, current {} A",
                number(telemetry.setpoint_c),
                number(telemetry.display_c),
                number(telemetry.skin_c),
                number(telemetry.force_n),
                number(telemetry.current_a)
            );
            self.tell(&text);
        }
    }
}

/// The response that a line is, or what is allowed.
fn response(question: &Question, stations: usize, line: &str) -> Result<Response, String> {
    match &question.kind {
        AnswerKind::OneOf(words) => {
            let number =
                line.parse::<usize>().ok().filter(|number| (1..=words.len()).contains(number));
            let word = || words.iter().position(|word| word.eq_ignore_ascii_case(line));
            let index = number.map(|number| number - 1).or_else(word);
            index.map(Response::Choice).ok_or_else(|| {
                format!("'{line}' is no answer; allowed: 1 to {}, or the word", words.len())
            })
        }
        AnswerKind::NumberPerStation(least, most) => {
            let numbers = line
                .split_ascii_whitespace()
                .map(|word| word.replace(',', ".").parse::<f64>().ok());
            let numbers: Option<Vec<f64>> = numbers.collect();
            let fits = |numbers: &Vec<f64>| {
                numbers.len() == stations
                    && numbers.iter().all(|number| (*least..=*most).contains(number))
            };
            numbers.filter(fits).map(Response::Numbers).ok_or_else(|| {
                format!("'{line}' is no answer; allowed: {stations} numbers from {least} to {most}")
            })
        }
    }
}

impl People for TerminalPeople<'_> {
    fn inform(&mut self, update: &Update) {
        match update {
            Update::Trial { trial, attempt, of } => {
                self.tell(&format!(
                    "trial {} of {of}, block {}, attempt {attempt}",
                    trial.number, trial.block
                ));
            }
            Update::Phase(phase) => {
                self.tell(&format!("{}: {}", phase.name(), texts::phase(*phase)))
            }
            Update::Cue(cue) => {
                if let Some(tones) = &self.tones {
                    tones.play(*cue);
                }
                self.tell(&format!(">> {}", texts::cue(*cue)));
            }
            Update::Instruction(text) | Update::Notice(text) => self.tell(text),
            Update::Ask(question) => self.ask(question),
            Update::Answered(answered) => {
                self.question = None;
                if answered.is_none() {
                    self.tell("too late");
                }
            }
            Update::Feedback { is_correct } => self.tell(texts::feedback(*is_correct)),
            Update::Decide(question) => self.decide(question),
            Update::Decided(_) => self.to_decide = None,
            Update::TargetForce(Some(target_n)) => self.tell(&format!("press with {target_n} N")),
            Update::TargetForce(None) => {}
            Update::Telemetry(received) => self.telemetry(received),
            Update::Event(_) => {}
            Update::TrialEnded { void: Some(reason) } => self.tell(&format!("void: {reason}")),
            Update::TrialEnded { void: None } => {}
            Update::Ended(None) => self.tell("the session is complete"),
            Update::Ended(Some(reason)) => self.tell(&format!("the session has ended: {reason}")),
        }
    }

    fn response(&mut self) -> Option<Response> {
        self.look();
        self.response.take()
    }

    fn decision(&mut self) -> Option<Decision> {
        self.look();
        if self.stop.is_pressed() {
            return Some(Decision::Stop);
        }
        self.decision.take()
    }
}

impl MonitorPeople for TerminalPeople<'_> {
    fn order(&mut self) -> Option<Order> {
        self.look();
        if self.stop.take() {
            self.order = None;
            return Some(Order::Off);
        }
        self.order.take()
    }

    fn is_closing(&self) -> bool {
        self.stop.is_closing()
    }
}

#[cfg(test)]
mod tests {
    use std::io;
    use std::sync::mpsc::{Sender, channel};

    use thermal_session::Phase;

    use super::*;

    fn people<'a>(
        screen: &'a mut Vec<u8>,
        stop: &StopFlag,
    ) -> (TerminalPeople<'a>, Sender<io::Result<String>>) {
        let (sender, lines) = channel();
        (TerminalPeople::of_session(lines, screen, stop.clone(), None, 2), sender)
    }

    fn enter(sender: &Sender<io::Result<String>>, line: &str) {
        sender.send(Ok(line.into())).unwrap();
    }

    fn one_of_two() -> Update {
        Update::Ask(Question {
            ask: "Which side felt colder?".into(),
            kind: AnswerKind::OneOf(vec!["left".into(), "right".into()]),
        })
    }

    #[test]
    fn an_answer_is_its_number_or_its_word_and_anything_else_is_refused() {
        let mut screen = Vec::new();
        let (mut people, sender) = people(&mut screen, &StopFlag::default());
        people.inform(&one_of_two());
        enter(&sender, "3");
        assert_eq!(people.response(), None);
        enter(&sender, "2");
        assert_eq!(people.response(), Some(Response::Choice(1)));
        people.inform(&one_of_two());
        enter(&sender, "Left");
        assert_eq!(people.response(), Some(Response::Choice(0)));
        drop(people);
        let screen = String::from_utf8(screen).unwrap();
        assert!(screen.contains("'3' is no answer; allowed: 1 to 2, or the word"), "{screen}");
    }

    #[test]
    fn numbers_are_entered_in_one_line() {
        let mut screen = Vec::new();
        let (mut people, sender) = people(&mut screen, &StopFlag::default());
        people.inform(&Update::Ask(Question {
            ask: "How cold?".into(),
            kind: AnswerKind::NumberPerStation(0.0, 100.0),
        }));
        for wrong in ["40", "40 101", "40 x"] {
            enter(&sender, wrong);
            assert_eq!(people.response(), None);
        }
        enter(&sender, "40 62,5");
        assert_eq!(people.response(), Some(Response::Numbers(vec![40.0, 62.5])));
    }

    #[test]
    fn decisions_are_letters_while_the_participant_answers_with_numbers() {
        let mut screen = Vec::new();
        let (mut people, sender) = people(&mut screen, &StopFlag::default());
        people.inform(&one_of_two());
        people.inform(&Update::Decide(OperatorQuestion::SkinNotReady {
            skin_c: None,
            wanted_c: 34.0,
        }));
        enter(&sender, "w");
        enter(&sender, "1");
        assert_eq!(people.decision(), Some(Decision::Wait));
        assert_eq!(people.response(), Some(Response::Choice(0)));
    }

    #[test]
    fn stop_and_the_end_of_the_input_stop() {
        for ends in [false, true] {
            let mut screen = Vec::new();
            let stop = StopFlag::default();
            let (mut people, sender) = people(&mut screen, &stop);
            assert_eq!(people.decision(), None);
            if !ends {
                enter(&sender, "STOP");
            }
            drop(sender);
            assert_eq!(people.decision(), Some(Decision::Stop));
            assert!(stop.is_closing());
        }
    }

    #[test]
    fn a_monitor_takes_its_orders_and_names_what_is_allowed() {
        let mut screen = Vec::new();
        let (sender, lines) = channel();
        let mut people = TerminalPeople::of_monitor(lines, &mut screen, StopFlag::default());
        enter(&sender, "start");
        assert_eq!(people.order(), None);
        enter(&sender, "arm");
        assert_eq!(people.order(), Some(Order::Arm));
        enter(&sender, "arm");
        enter(&sender, "stop");
        assert_eq!(people.order(), Some(Order::Off));
        assert!(people.is_closing());
        drop(people);
        let screen = String::from_utf8(screen).unwrap();
        assert!(
            screen.contains("'start' is no order; allowed: arm, clear, abort, stop"),
            "{screen}"
        );
        assert!(screen.contains(texts::EMERGENCY_STOP), "{screen}");
    }

    #[test]
    fn phases_and_cues_are_plain_lines() {
        let mut screen = Vec::new();
        let (mut people, _sender) = people(&mut screen, &StopFlag::default());
        people.inform(&Update::Phase(Phase::Contact));
        people.inform(&Update::Cue(thermal_session::Cue::Touch));
        drop(people);
        assert_eq!(screen, b"contact: the participant touches\n>> Touch\n");
    }
}
