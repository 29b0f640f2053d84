//! Numbered steps with headings, durations and a closing table.
use std::fmt;
use std::time::{Duration, Instant};

use anyhow::Result;

/// How a step ended.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Outcome {
    Passed,
    Failed,
    Skipped(String),
}

/// A run of a known number of steps. Headings go to standard error; `Display` is the table of what was done.
pub struct Steps {
    total: usize,
    done: Vec<(String, Outcome, Duration)>,
}

impl Steps {
    /// Announces `total` steps.
    pub fn new(total: usize) -> Self {
        Self {
            total,
            done: Vec::new(),
        }
    }

    /// Runs the next step under the heading `[n/total] title (hint)`; passes its result on.
    pub fn run<T>(
        &mut self,
        title: &str,
        hint: &str,
        step: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let hint = if hint.is_empty() {
            String::new()
        } else {
            format!(" ({hint})")
        };
        eprintln!("\n[{}/{}] {title}{hint}", self.done.len() + 1, self.total);
        let start = Instant::now();
        let result = step();
        let outcome = if result.is_ok() {
            Outcome::Passed
        } else {
            Outcome::Failed
        };
        self.done.push((title.into(), outcome, start.elapsed()));
        result
    }

    /// Leaves the next step out and says why.
    pub fn skip(&mut self, title: &str, why: &str) {
        eprintln!(
            "\n[{}/{}] {title}: SKIPPED, {why}",
            self.done.len() + 1,
            self.total
        );
        self.done
            .push((title.into(), Outcome::Skipped(why.into()), Duration::ZERO));
    }
}

impl fmt::Display for Steps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = self
            .done
            .iter()
            .map(|(title, ..)| title.chars().count())
            .max()
            .unwrap_or(0);
        let mut sum = Duration::ZERO;
        for (title, outcome, took) in &self.done {
            sum += *took;
            let verdict = match outcome {
                Outcome::Passed => "passed",
                Outcome::Failed => "FAILED",
                Outcome::Skipped(why) => &format!("SKIPPED, {why}"),
            };
            writeln!(
                f,
                "{title:width$}  {:>7.1} s  {verdict}",
                took.as_secs_f64()
            )?;
        }
        write!(
            f,
            "{:width$}  {:>7.1} s  {} of {} steps",
            "",
            sum.as_secs_f64(),
            self.done.len(),
            self.total
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_tells_passed_failed_and_skipped_apart() {
        let mut steps = Steps::new(4);
        assert_eq!(steps.run("one", "", || Ok(7)).unwrap(), 7);
        steps.skip("second", "no tool");
        assert!(
            steps
                .run("three", "slow", || -> Result<()> { anyhow::bail!("no") })
                .is_err()
        );
        let table = steps.to_string();
        let lines: Vec<_> = table.lines().collect();
        assert!(
            lines[0].starts_with("one     ") && lines[0].ends_with("passed"),
            "{table}"
        );
        assert!(lines[1].ends_with("SKIPPED, no tool"), "{table}");
        assert!(lines[2].ends_with("FAILED"), "{table}");
        assert!(lines[3].ends_with("3 of 4 steps"), "{table}");
    }
}
