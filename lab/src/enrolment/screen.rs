//! What the person at the display sees while being enrolled.

use std::borrow::Cow;

use super::Step;
use crate::step_screen::{ShownStep, force_text};

impl ShownStep for Step {
    fn instruction(&self) -> Cow<'static, str> {
        match self {
            Self::Rest(_) => "Keep the finger in still air.".into(),
            Self::Touch(object) => format!("Touch {object}, with 1 to 3 N.").into(),
            Self::Press(..) => "Stay, and press with 1 to 3 N.".into(),
        }
    }

    fn readings(&self) -> Option<String> {
        match self {
            Self::Rest(left_s) => Some(format!("{left_s:5.1} s ")),
            Self::Touch(_) => None,
            Self::Press(left_s, force_n) => {
                let force = force_text(*force_n);
                Some(format!("{left_s:5.1} s  {force} N "))
            }
        }
    }
}
