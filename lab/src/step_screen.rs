//! A terminal in front of a person whose finger does one step after another.

use std::borrow::Cow;
use std::io::Write;

/// Calls between two lines of readings; a call comes every 10 or 20 ms.
const CALLS_PER_LINE: u32 = 5;

/// What the person at the display sees of a step.
pub trait ShownStep {
    /// What to do.
    fn instruction(&self) -> Cow<'static, str>;

    /// Readings meanwhile, on one line.
    fn readings(&self) -> Option<String>;
}

/// A terminal, which shows an instruction once and writes readings over each other.
pub struct StepScreen<'a> {
    out: &'a mut dyn Write,
    shown: Cow<'static, str>,
    calls: u32,
}

impl<'a> StepScreen<'a> {
    /// A terminal that shows nothing yet.
    pub fn new(out: &'a mut dyn Write) -> Self {
        Self { out, shown: "".into(), calls: 0 }
    }

    /// Shows a step; to be called for each.
    pub fn show(&mut self, step: &impl ShownStep) {
        let instruction = step.instruction();
        if self.shown != instruction {
            self.write(&format!("\n{instruction}\n"));
            (self.shown, self.calls) = (instruction, 0);
        }
        self.calls += 1;
        if self.calls % CALLS_PER_LINE == 1
            && let Some(readings) = step.readings()
        {
            self.write(&format!("\r {readings}"));
        }
    }

    fn write(&mut self, text: &str) {
        // What is on the screen changes nothing of the procedure.
        let _ignored = self.out.write_all(text.as_bytes());
        let _ignored = self.out.flush();
    }
}

/// A force, N, in five places.
pub fn force_text(force_n: Option<f64>) -> String {
    force_n.map_or("    -".into(), |force_n| format!("{force_n:5.2}"))
}
