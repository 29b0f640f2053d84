//! Numbered steps with headings, times and a closing table.
use std::fmt;
use std::time::{Duration, Instant};

use anyhow::Result;

/// How a step ended.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Outcome {
    Unfinished,
    Passed,
    Failed,
    Skipped(String),
}

/// A run of a known number of steps. Headings go to standard error; `Display` is the closing table.
pub struct Steps {
    total: usize,
    begun: Instant,
    done: Vec<(String, Outcome, Duration)>,
}

impl Steps {
    /// Announces `total` steps.
    pub fn new(total: usize) -> Self {
        Self { total, begun: Instant::now(), done: Vec::new() }
    }

    /// Runs the next step under the heading `[n/total] title (hint)`; passes its result on.
    pub fn run<T>(
        &mut self,
        title: &str,
        hint: &str,
        step: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let hint = if hint.is_empty() { String::new() } else { format!(" ({hint})") };
        let index = self.start(title, &hint);
        let start = Instant::now();
        let result = step();
        self.finish(index, result.is_ok(), start.elapsed());
        result
    }

    /// Announces the next step, which others may run beside; its index.
    pub fn start(&mut self, title: &str, hint: &str) -> usize {
        let index = self.done.len();
        eprintln!("\n[{}/{}] {title}{hint}", index + 1, self.total);
        let entry = (title.into(), Outcome::Unfinished, Duration::ZERO);
        self.done.push(entry);
        index
    }

    /// Records how the step of an index ended.
    pub fn finish(&mut self, index: usize, passed: bool, took: Duration) {
        let (_, outcome, time) = &mut self.done[index];
        *time = took;
        *outcome = if passed { Outcome::Passed } else { Outcome::Failed };
    }

    /// Leaves the next step out and says why.
    pub fn skip(&mut self, title: &str, why: &str) {
        let index = self.start(title, &format!(": SKIPPED, {why}"));
        self.done[index].1 = Outcome::Skipped(why.into());
    }
}

impl fmt::Display for Steps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lengths = self.done.iter().map(|(title, ..)| title.chars().count());
        let width = lengths.max().unwrap_or(0);
        for (title, outcome, took) in &self.done {
            let verdict = match outcome {
                Outcome::Unfinished => "not finished",
                Outcome::Passed => "passed",
                Outcome::Failed => "FAILED",
                Outcome::Skipped(why) => &format!("SKIPPED, {why}"),
            };
            let took = took.as_secs_f64();
            writeln!(f, "{title:width$}  {took:>7.1} s  {verdict}")?;
        }
        let all = self.begun.elapsed().as_secs_f64();
        let (done, total) = (self.done.len(), self.total);
        write!(f, "{:width$}  {all:>7.1} s  {done} of {total} steps", "")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_distinguishes_passed_failed_skipped_and_unfinished_steps() {
        let mut steps = Steps::new(5);
        assert_eq!(steps.run("one", "", || Ok(7)).unwrap(), 7);
        steps.skip("second", "no tool");
        let failing = || -> Result<()> { anyhow::bail!("no") };
        assert!(steps.run("three", "slow", failing).is_err());
        steps.start("four", "");
        let table = steps.to_string();
        let lines: Vec<_> = table.lines().collect();
        assert!(lines[0].starts_with("one     ") && lines[0].ends_with("passed"));
        assert!(lines[1].ends_with("SKIPPED, no tool"), "{table}");
        assert!(lines[2].ends_with("FAILED"), "{table}");
        assert!(lines[3].ends_with("not finished"), "{table}");
        assert!(lines[4].ends_with("4 of 5 steps"), "{table}");
    }
}
