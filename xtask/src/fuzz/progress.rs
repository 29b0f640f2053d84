//! Progress of libFuzzer, parsed from its output.
use std::fmt;
use std::time::Duration;

/// Progress of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Executed inputs.
    pub executions: u64,
    /// Covered edges of the control flow.
    pub edges: u64,
    /// Covered edges, counted separately by ranges of their execution count.
    pub features: u64,
    /// Inputs in the corpus.
    pub inputs: u64,
}

impl Progress {
    /// Updates from a line such as `#4096 NEW cov: 660 ft: 858 corp: 8/3685b lim: 4096 exec/s: 2048 rss: 29Mb …` or
    /// `stat::number_of_executed_units: 4096`; ignores other lines.
    pub fn take(&mut self, line: &str) {
        if let Some(count) = line.strip_prefix("stat::number_of_executed_units:") {
            self.executions = count.trim().parse().unwrap_or(self.executions);
            return;
        }
        let mut words = line.split_ascii_whitespace();
        let count = words.next().and_then(|word| word.strip_prefix('#'));
        let Some(executions) = count.and_then(|count| count.parse().ok()) else {
            return;
        };
        self.executions = executions;
        while let Some(word) = words.next() {
            let place = match word {
                "cov:" => &mut self.edges,
                "ft:" => &mut self.features,
                "corp:" => &mut self.inputs,
                _ => continue,
            };
            let number = words.next().and_then(|word| word.split('/').next());
            *place = number.and_then(|number| number.parse().ok()).unwrap_or(*place);
        }
    }

    /// Sum for processes that share their corpus.
    pub fn together(all: &[Self]) -> Self {
        all.iter().fold(Self::default(), |sum, one| Self {
            executions: sum.executions + one.executions,
            edges: sum.edges.max(one.edges),
            features: sum.features.max(one.features),
            inputs: sum.inputs.max(one.inputs),
        })
    }
}

/// Result of fuzzing one target.
#[derive(Clone, Copy, Debug)]
pub struct Reached {
    /// Final progress.
    pub progress: Progress,
    /// Elapsed time.
    pub time: Duration,
}

/// Formats a row of the table.
impl fmt::Display for Reached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Progress { executions, edges, features, inputs } = self.progress;
        let per_s = executions as f64 / self.time.as_secs_f64().max(1e-3);
        write!(f, "{executions:>14}{per_s:>10.0}{edges:>8}{features:>10}{inputs:>8}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of libFuzzer, as LLVM's documentation has them.
    #[test]
    fn progress_is_parsed_from_the_lines_of_libfuzzer() {
        let mut progress = Progress::default();
        progress.take("INFO: Seed: 1523017872");
        assert_eq!(progress, Progress::default());
        progress.take("#2\tINITED cov: 3 ft: 3 corp: 1/1b exec/s: 0 rss: 24Mb");
        progress
            .take("#3811\tNEW    cov: 4 ft: 5 corp: 2/2b lim: 4 exec/s: 0 rss: 25Mb L: 1/1 MS: 5 ChangeBit-");
        let expected = Progress { executions: 3811, edges: 4, features: 5, inputs: 2 };
        assert_eq!(progress, expected);
        progress.take("stat::number_of_executed_units: 5000");
        assert_eq!(progress.executions, 5000);
    }
}
