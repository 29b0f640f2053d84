//! The views without a display: what they say, and what a click does.

mod common;

use std::time::Duration;

use common::{choice, numbers, operator_questions, session_view, telemetry, trial};
use egui::{Context, Event, Modifiers, PointerButton, Pos2, RawInput, Rect, Shape, pos2, vec2};
use thermal_client::fault_words;
use thermal_device::StateName;
use thermal_device::safety::Fault;
use thermal_session::{Cue, Decision, Phase, Response, Update};
use thermal_window::views::{OperatorState, operator, participant, pressed};
use thermal_window::{Action, Key, Model, NumberEntry, Order, SessionView, texts};

const NOW: Duration = Duration::from_secs(2);

/// A screen without a display.
struct Screen {
    ctx: Context,
    texts: Vec<(String, Rect)>,
}

impl Screen {
    fn new() -> Self {
        Self { ctx: Context::default(), texts: Vec::new() }
    }

    /// Draws a frame with these events, and keeps its texts.
    fn frame<T>(&mut self, events: Vec<Event>, mut draw: impl FnMut(&mut egui::Ui) -> T) -> T {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 860.0))),
            events,
            ..RawInput::default()
        };
        let mut drawn = None;
        let output = self.ctx.run_ui(input, |ui| drawn = Some(draw(ui)));
        self.texts.clear();
        for clipped in output.shapes {
            self.keep(&clipped.shape);
        }
        drawn.unwrap()
    }

    fn keep(&mut self, shape: &Shape) {
        match shape {
            Shape::Text(text) => {
                let place = text.galley.rect.translate(text.pos.to_vec2());
                self.texts.push((text.galley.text().to_owned(), place));
            }
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| self.keep(shape)),
            _ => {}
        }
    }

    fn all(&self) -> String {
        let texts: Vec<_> = self.texts.iter().map(|(text, _)| text.as_str()).collect();
        texts.join("\n")
    }

    fn place(&self, part: &str) -> Pos2 {
        let found = self.texts.iter().find(|(text, _)| text.contains(part));
        found.unwrap_or_else(|| panic!("no '{part}' in\n{}", self.all())).1.center()
    }

    /// Draws until the layout rests, clicks on a text, and returns what that does.
    fn click<T>(&mut self, part: &str, mut draw: impl FnMut(&mut egui::Ui) -> T) -> T {
        for _ in 0..3 {
            self.frame(vec![], &mut draw);
        }
        let pos = self.place(part);
        let button = |pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        self.frame(vec![Event::PointerMoved(pos), button(true)], &mut draw);
        self.frame(vec![button(false)], &mut draw)
    }
}

fn after(updates: &[Update]) -> Model {
    let mut model = Model::new(Some(session_view()));
    model.fold(&trial(), Duration::ZERO);
    for update in updates {
        model.fold(update, Duration::from_secs(1));
    }
    model
}

fn draw_operator(model: &Model) -> impl FnMut(&mut egui::Ui) -> Vec<Action> {
    let mut state = OperatorState::default();
    move |ui| operator(ui, model, &mut state, NOW)
}

fn situations() -> Vec<Model> {
    let mut all = vec![Model::new(None), after(&[])];
    all.extend(operator_questions().map(|question| after(&[Update::Decide(question)])));
    all.push(after(&[telemetry(1, StateName::Contact, 33.0), Update::Phase(Phase::Contact)]));
    all.push(after(&[telemetry(1, StateName::Tripped(Fault::SinkHot), 33.0)]));
    all.push(after(&[Update::TargetForce(Some(1.0)), telemetry(1, StateName::Contact, 33.0)]));
    all.push(after(&[Update::Ended(Some("stopped".into()))]));
    all
}

#[test]
fn every_screen_of_the_operator_has_the_stop_and_names_the_emergency_stop() {
    for model in situations() {
        let mut screen = Screen::new();
        let clicked = screen.click("STOP", draw_operator(&model));
        assert_eq!(clicked, [Action::Stop]);
        assert!(screen.all().contains(texts::EMERGENCY_STOP));
    }
}

#[test]
fn warnings_of_a_session_are_on_the_operators_screen_until_its_first_trial() {
    let warnings = vec!["the skin reaches the dose in trial 3".into()];
    let mut model = Model::new(Some(SessionView { warnings, ..session_view() }));
    let is_shown = |model: &Model| {
        let mut screen = Screen::new();
        (0..3).for_each(|_| drop(screen.frame(vec![], draw_operator(model))));
        screen.all().contains("the dose in trial 3")
    };
    assert!(is_shown(&model));
    model.fold(&trial(), NOW);
    assert!(!is_shown(&model));
}

#[test]
fn a_click_on_a_choice_is_its_decision() {
    for question in operator_questions() {
        let model = after(&[Update::Decide(question.clone())]);
        for choice in texts::choices(&question) {
            let mut screen = Screen::new();
            let clicked = screen.click(choice.label, draw_operator(&model));
            assert_eq!(clicked, [Action::Decide(choice.decision)]);
        }
    }
    let clicked = Screen::new().click("Arm", draw_operator(&Model::new(None)));
    assert_eq!(clicked, [Action::Order(Order::Arm)]);
    assert!(!matches!(clicked[0], Action::Decide(Decision::Stop)));
}

#[test]
fn every_fault_is_explained_on_the_operators_screen() {
    let mut screen = Screen::new();
    for &fault in Fault::ALL {
        let model = after(&[telemetry(1, StateName::Tripped(fault), 33.0)]);
        let mut draw = draw_operator(&model);
        for _ in 0..2 {
            screen.frame(vec![], &mut draw);
        }
        let all = screen.all();
        let words = fault_words(fault);
        for part in [fault.name(), words.meaning, words.remedy] {
            assert!(all.contains(part), "{part}");
        }
    }
}

#[test]
fn a_silent_device_has_no_state_on_the_screen() {
    let model = after(&[telemetry(1, StateName::Contact, 33.0)]);
    let mut state = OperatorState::default();
    let mut screen = Screen::new();
    let mut draw = |ui: &mut egui::Ui| operator(ui, &model, &mut state, Duration::from_secs(9));
    for _ in 0..2 {
        screen.frame(vec![], &mut draw);
    }
    assert!(screen.all().contains("No telemetry for 8 s"));
    assert!(!screen.all().contains("CONTACT"));
}

#[test]
fn a_click_on_an_answer_is_the_response() {
    let model = after(&[choice()]);
    let draw = |ui: &mut egui::Ui| participant(ui, model.participant(), None, NOW);
    assert_eq!(Screen::new().click("right", draw), Some(Response::Choice(1)));
}

#[test]
fn a_number_for_each_station_is_confirmed_by_a_click() {
    let model = after(&[numbers()]);
    let mut entry = NumberEntry::new((0.0, 100.0), 2);
    entry.set(0, 40.0);
    let mut unfinished = entry.clone();
    let draw = |ui: &mut egui::Ui| participant(ui, model.participant(), Some(&mut unfinished), NOW);
    assert_eq!(Screen::new().click("Enter", draw), None);
    entry.set(1, 60.0);
    let draw = |ui: &mut egui::Ui| participant(ui, model.participant(), Some(&mut entry), NOW);
    let response = Screen::new().click("Enter", draw);
    assert_eq!(response, Some(Response::Numbers(vec![40.0, 60.0])));
}

/// Neither readings nor materials, levels or the correct answer beyond what the question itself says.
#[test]
fn the_participant_sees_nothing_that_tells_what_is_presented() {
    let telemetry = telemetry(1, StateName::Contact, 33.5);
    let tripped =
        Update::Telemetry(match common::telemetry(2, StateName::Tripped(Fault::SinkHot), 33.5) {
            Update::Telemetry(line) => line,
            _ => unreachable!(),
        });
    let mut all: Vec<Vec<Update>> =
        operator_questions().map(|question| vec![Update::Decide(question)]).into();
    all.extend([
        vec![choice()],
        vec![numbers()],
        vec![Update::Cue(Cue::Touch)],
        vec![Update::Cue(Cue::Interval(1))],
        vec![Update::TargetForce(Some(1.0))],
        vec![Update::Notice("granite at 28 °C".into())],
        vec![Update::TrialEnded { void: Some("granite".into()) }],
        vec![Update::Ended(Some("sink-hot".into()))],
        vec![tripped],
    ]);
    for mut updates in all {
        updates.insert(0, telemetry.clone());
        updates.push(telemetry.clone());
        let model = after(&updates);
        let mut entry = NumberEntry::new((0.0, 100.0), 2);
        let mut screen = Screen::new();
        for _ in 0..2 {
            screen.frame(vec![], |ui| participant(ui, model.participant(), Some(&mut entry), NOW));
        }
        let shown = screen.all();
        for secret in [
            "°C", "28.", "33.", "1.6", "2.5", "copper", "granite", "sample", "main", "block",
            "sink", "23", "64",
        ] {
            assert!(!shown.contains(secret), "'{secret}' in\n{shown}");
        }
    }
}

#[test]
fn feedback_and_instructions_are_shown_to_the_participant() {
    for (update, text) in [
        (Update::Instruction("Correct".into()), "Correct"),
        (Update::Cue(Cue::Reach), "Move above"),
        (Update::Cue(Cue::Lift), "Lift"),
        (choice(), "Which side felt colder?"),
        (Update::Phase(Phase::Break), "Break"),
    ] {
        let model = after(&[update]);
        let mut screen = Screen::new();
        screen.frame(vec![], |ui| participant(ui, model.participant(), None, NOW));
        assert!(screen.all().contains(text), "{text}");
    }
}

#[test]
fn a_held_key_answers_once_and_stops_always() {
    let key = |key, repeat, modifiers| Event::Key {
        key,
        physical_key: None,
        pressed: true,
        repeat,
        modifiers,
    };
    let mut screen = Screen::new();
    let events = vec![
        key(egui::Key::Num2, false, Modifiers::NONE),
        key(egui::Key::Num2, true, Modifiers::NONE),
        key(egui::Key::C, false, Modifiers::CTRL),
        key(egui::Key::V, false, Modifiers::NONE),
        key(egui::Key::Escape, true, Modifiers::CTRL),
    ];
    let keys = screen.frame(events, |ui| pressed(ui.ctx()));
    assert_eq!(keys, [Key::Digit(2), Key::Letter('v'), Key::Escape]);
}

/// Layouts are for a screen of a laptop as well.
#[test]
fn the_stop_is_inside_of_the_smallest_window() {
    let model = after(&[telemetry(1, StateName::Contact, 33.0)]);
    let ctx = Context::default();
    let size = vec2(1000.0, 700.0);
    let mut state = OperatorState::default();
    let input = RawInput {
        screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), size)),
        ..RawInput::default()
    };
    let output = ctx.run_ui(input, |ui| drop(operator(ui, &model, &mut state, NOW)));
    let stop = output.shapes.iter().find_map(|clipped| match &clipped.shape {
        Shape::Text(text) if text.galley.text().contains("STOP") => {
            Some(text.galley.rect.translate(text.pos.to_vec2()))
        }
        _ => None,
    });
    let inside = Rect::from_min_size(Pos2::ZERO, size);
    assert!(inside.contains_rect(stop.unwrap()));
}
