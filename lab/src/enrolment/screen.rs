//! What the person at the display sees while being enrolled.

use std::io::Write;

use super::Step;

/// Calls between two lines of readings; a call comes every 20 ms.
const CALLS_PER_LINE: u32 = 5;

/// A terminal.
pub struct Screen<'a> {
    out: &'a mut dyn Write,
    /// What was said last; a step is said once.
    said: String,
    calls: u32,
}

impl<'a> Screen<'a> {
    /// A terminal that shows nothing yet.
    pub fn new(out: &'a mut dyn Write) -> Self {
        Self {
            out,
            said: String::new(),
            calls: 0,
        }
    }

    /// Shows a step; to be called for each.
    pub fn show(&mut self, step: &Step) {
        let text = match step {
            Step::Rest(_) => "Keep the finger in still air.".into(),
            Step::Touch(object) => format!("Touch {object}, with 1 to 3 N."),
            Step::Press(..) => "Stay, and press with 1 to 3 N.".into(),
        };
        if self.said != text {
            self.tell(&format!("\n{text}\n"));
            (self.said, self.calls) = (text, 0);
        }
        self.calls += 1;
        if self.calls % CALLS_PER_LINE != 1 {
            return;
        }
        match step {
            Step::Rest(left_s) => self.tell(&format!("\r {left_s:5.1} s ")),
            Step::Press(left_s, force_n) => {
                let force = force_n.map_or("    -".into(), |force_n| format!("{force_n:5.2}"));
                self.tell(&format!("\r {left_s:5.1} s  {force} N "));
            }
            Step::Touch(_) => {}
        }
    }

    fn tell(&mut self, text: &str) {
        // What is on the screen changes nothing of the enrolment.
        let _ignored = self.out.write_all(text.as_bytes());
        let _ignored = self.out.flush();
    }
}
