//! What keys do. The key of the stop works in both windows, because only one of them has the keyboard; the keys of answers and
//! those of decisions have nothing in common, so that both persons can press theirs at any time.

use thermal_session::{AnswerKind, Decision, OperatorQuestion, Response};

use crate::model::Model;
use crate::monitor::Order;
use crate::texts::choices;

/// A key that means something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Stop.
    Escape,
    /// Confirms a number.
    Enter,
    /// Deletes a digit.
    Backspace,
    /// The next station.
    Tab,
    /// Left.
    Left,
    /// Right.
    Right,
    /// Up.
    Up,
    /// Down.
    Down,
    /// A digit, also of the numeric keypad.
    Digit(u8),
    /// Decimal point or comma.
    Point,
    /// Minus.
    Minus,
    /// A letter, in lower case.
    Letter(char),
    /// Full screen.
    F11,
}

/// The window that has the keyboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindowKind {
    /// The operator's.
    Operator,
    /// The participant's.
    Participant,
}

/// What a key does.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Bridge off.
    Stop,
    /// The operator's decision.
    Decide(Decision),
    /// An order to the monitored device.
    Order(Order),
    /// The participant's answer.
    Respond(Response),
    /// A key of a number.
    Enter(Key),
    /// The participant's window fills the screen, or no longer.
    FullScreen,
    /// The next finger is shown.
    NextFinger,
    /// Light or dark.
    Theme,
}

/// What a key does in a window now; `None` if nothing.
pub fn action(key: Key, window: WindowKind, model: &Model) -> Option<Action> {
    match key {
        Key::Escape => Some(Action::Stop),
        Key::F11 => Some(Action::FullScreen),
        Key::Letter(letter) => letter_action(letter, window, model),
        _ => answer(key, model),
    }
}

fn letter_action(letter: char, window: WindowKind, model: &Model) -> Option<Action> {
    let is_operator = window == WindowKind::Operator;
    if let Some(question) = model.question() {
        let mut choices = choices(question).iter();
        let decision = choices.find(|choice| choice.key == letter);
        // A participant who leans on the keyboard must not go on after a trip or without the skin's gate.
        let harmless = matches!(question, OperatorQuestion::Ready(_) | OperatorQuestion::BreakOver);
        if let Some(choice) = decision.filter(|_| is_operator || harmless) {
            return Some(Action::Decide(choice.decision));
        }
    }
    match letter {
        'f' if is_operator => Some(Action::NextFinger),
        'l' if is_operator => Some(Action::Theme),
        _ if is_operator && model.session().is_none() => {
            let mut orders = Order::ALL.into_iter();
            let order = orders.find(|order| order.key() == letter)?;
            Some(Action::Order(order))
        }
        _ => None,
    }
}

fn answer(key: Key, model: &Model) -> Option<Action> {
    let participant = model.participant();
    if participant.answered {
        return None;
    }
    let words = match &participant.question.as_ref()?.kind {
        AnswerKind::NumberPerStation(..) => return Some(Action::Enter(key)),
        AnswerKind::OneOf(words) => words,
    };
    let index = match key {
        Key::Digit(digit) => usize::from(digit).checked_sub(1)?,
        Key::Left => sideways(words, "left", 0)?,
        Key::Right => sideways(words, "right", 1)?,
        _ => return None,
    };
    (index < words.len()).then_some(Action::Respond(Response::Choice(index)))
}

/// The answer of an arrow: the one with its word, or with two answers the one on its side of the screen.
fn sideways(words: &[String], word: &str, of_two: usize) -> Option<usize> {
    let named = words.iter().position(|answer| answer.eq_ignore_ascii_case(word));
    named.or_else(|| (words.len() == 2).then_some(of_two))
}
