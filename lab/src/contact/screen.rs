//! What the person at the display sees while the contact law is measured.

use std::borrow::Cow;

use contact_law_fit::{Step, TOTAL_S};

use crate::step_screen::{ShownStep, force_text};

/// Places of the bar, and the forces at its ends, N.
const PLACES: usize = 48;
const ENDS_N: (f64, f64) = (0.05, 4.0);

impl ShownStep for Step {
    fn instruction(&self) -> Cow<'static, str> {
        match self {
            Self::Lift => "Take the finger off the display, and touch nothing.",
            Self::Wait(_) => "The display goes to 24 C. Keep the finger in still air.",
            Self::Land => {
                "When the finger has been in still air for three minutes: land lightly, with 0.1 N, and keep * at |."
            }
            Self::Follow { .. } => "Up in 4 s, down in 4 s, up in 6 s, down in 6 s.",
            Self::End => "Thank you. Lift the finger.",
        }
        .into()
    }

    fn readings(&self) -> Option<String> {
        match self {
            Self::Wait(Some(surface_c)) => Some(format!(" display {surface_c:5.2} C ")),
            Self::Follow { since_s, force_n } => {
                let target_n = self.target_n();
                let (force, bar) = (force_text(*force_n), bar(target_n, *force_n));
                Some(format!(
                    "{since_s:5.1} of {TOTAL_S:.0} s  {target_n:5.2} N asked, {force} N  {bar}"
                ))
            }
            _ => None,
        }
    }
}

/// A line with `|` at the target and `*` at the force; equal distances are equal ratios.
fn bar(target_n: f64, force_n: Option<f64>) -> String {
    let place = |force_n: f64| {
        let part = (force_n / ENDS_N.0).ln() / (ENDS_N.1 / ENDS_N.0).ln();
        (part.clamp(0.0, 1.0) * (PLACES - 1) as f64).round() as usize
    };
    let mut bar = [b'-'; PLACES];
    bar[place(target_n)] = b'|';
    if let Some(force_n) = force_n {
        bar[place(force_n)] = b'*';
    }
    bar.map(char::from).iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step_screen::StepScreen;

    #[test]
    fn the_bar_is_logarithmic_and_keeps_its_ends() {
        let middle = (ENDS_N.0 * ENDS_N.1).sqrt();
        let text = bar(middle, Some(100.0));
        assert_eq!(text.len(), PLACES);
        assert!(text.ends_with('*'), "{text}");
        assert!(matches!(text.find('|'), Some(23 | 24)), "{text}");
        assert!(bar(2.0, Some(0.0)).starts_with('*'));
        assert!(!bar(2.0, None).contains('*'));
    }

    #[test]
    fn a_step_is_said_once_and_readings_are_shown() {
        let mut out = Vec::new();
        let mut screen = StepScreen::new(&mut out);
        for _ in 0..20 {
            screen.show(&Step::Lift);
        }
        for call in 0..10 {
            screen
                .show(&Step::Follow { since_s: 3.0 + 0.01 * f64::from(call), force_n: Some(0.5) });
        }
        let text = String::from_utf8(out).expect("text");
        assert_eq!(text.matches("Take the finger off").count(), 1);
        assert_eq!(text.matches("0.45 N asked,  0.50 N").count(), 1, "{text}");
        assert_eq!(text.matches('\r').count(), 2);
    }
}
