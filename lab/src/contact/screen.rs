//! What the person at the display sees while the contact law is measured.

use std::io::Write;

use contact_law_fit::{Step, TOTAL_S};

/// Places of the bar, and the forces at its ends, N.
const PLACES: usize = 48;
const ENDS_N: (f64, f64) = (0.05, 4.0);
/// Calls between two lines of readings; a call comes every 10 ms.
const CALLS_PER_LINE: u32 = 5;

/// A terminal.
pub struct Screen<'a> {
    out: &'a mut dyn Write,
    /// What was said last; a step is said once.
    said: Option<&'static str>,
    calls: u32,
}

impl<'a> Screen<'a> {
    /// A terminal that shows nothing yet.
    pub fn new(out: &'a mut dyn Write) -> Self {
        Self {
            out,
            said: None,
            calls: 0,
        }
    }

    /// Shows a step; to be called for each.
    pub fn show(&mut self, step: &Step) {
        let text = match step {
            Step::Lift => "Take the finger off the display, and touch nothing.",
            Step::Wait(_) => "The display goes to 24 C. Keep the finger in still air.",
            Step::Land => {
                "When the finger has been in still air for three minutes: land lightly, with 0.1 N, and keep * at |."
            }
            Step::Follow { .. } => "Up in 4 s, down in 4 s, up in 6 s, down in 6 s.",
            Step::End => "Thank you. Lift the finger.",
        };
        if self.said != Some(text) {
            self.tell(&format!("\n{text}\n"));
            (self.said, self.calls) = (Some(text), 0);
        }
        self.calls += 1;
        if self.calls % CALLS_PER_LINE != 1 {
            return;
        }
        match step {
            Step::Wait(Some(surface_c)) => self.tell(&format!("\r  display {surface_c:5.2} C ")),
            Step::Follow { since_s, force_n } => {
                let target_n = step.target_n();
                let force = force_n.map_or("    -".into(), |force_n| format!("{force_n:5.2}"));
                let bar = bar(target_n, *force_n);
                self.tell(&format!(
                    "\r {since_s:5.1} of {TOTAL_S:.0} s  {target_n:5.2} N asked, {force} N  {bar}"
                ));
            }
            _ => {}
        }
    }

    fn tell(&mut self, text: &str) {
        // What is on the screen changes nothing of the measurement.
        let _ignored = self.out.write_all(text.as_bytes());
        let _ignored = self.out.flush();
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
        let mut screen = Screen::new(&mut out);
        for _ in 0..20 {
            screen.show(&Step::Lift);
        }
        for call in 0..10 {
            screen.show(&Step::Follow {
                since_s: 3.0 + 0.01 * f64::from(call),
                force_n: Some(0.5),
            });
        }
        let text = String::from_utf8(out).expect("text");
        assert_eq!(text.matches("Take the finger off").count(), 1);
        assert_eq!(text.matches("0.45 N asked,  0.50 N").count(), 1, "{text}");
        assert_eq!(text.matches('\r').count(), 2);
    }
}
