//! Confusion matrix of an identification experiment: what was presented, by what was answered.

use crate::error::at_least;
use crate::proportion::Proportion;
use crate::{Result, StatisticsError};

/// Counts of answers; rows are presented, columns answered, both in the order of the labels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfusionMatrix {
    labels: Vec<String>,
    /// Row by row.
    counts: Vec<u32>,
}

/// Information that the answers transmit of what was presented, bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Information {
    /// `I = sum p_ij log2(p_ij / (p_i p_j))` of the observed proportions. Too large with few answers.
    pub observed_bits: f64,
    /// With the correction of Miller and Madow of the three entropies in it: `observed + (r + c - m - 1) / (2 n ln 2)`, where
    /// `r` rows, `c` columns and `m` cells have answers. It may be slightly negative where nothing is transmitted.
    pub corrected_bits: f64,
}

impl ConfusionMatrix {
    /// A matrix without answers.
    ///
    /// # Errors
    /// Fewer than two labels, or a label twice.
    pub fn new<S: Into<String>>(labels: impl IntoIterator<Item = S>) -> Result<Self> {
        let labels: Vec<String> = labels.into_iter().map(Into::into).collect();
        at_least("labels", labels.len(), 2)?;
        let mut numbered = labels.iter().enumerate();
        if let Some((_, label)) = numbered.find(|(i, label)| labels[..*i].contains(label)) {
            return Err(StatisticsError::Label { label: label.clone(), why: "is there twice" });
        }
        Ok(Self { counts: vec![0; labels.len() * labels.len()], labels })
    }

    /// The labels, in the order of rows and columns.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// Adds one answer.
    ///
    /// # Errors
    /// An unknown label.
    pub fn add(&mut self, presented: &str, answered: &str) -> Result<()> {
        self.add_many(presented, answered, 1)
    }

    /// Adds a number of equal answers.
    ///
    /// # Errors
    /// An unknown label.
    pub fn add_many(&mut self, presented: &str, answered: &str, count: u32) -> Result<()> {
        let (row, column) = (self.index(presented)?, self.index(answered)?);
        let size = self.labels.len();
        let cell = &mut self.counts[row * size + column];
        *cell = cell.saturating_add(count);
        Ok(())
    }

    /// Number of answers in a cell.
    ///
    /// # Errors
    /// An unknown label.
    pub fn count(&self, presented: &str, answered: &str) -> Result<u32> {
        let (row, column) = (self.index(presented)?, self.index(answered)?);
        Ok(self.counts[row * self.labels.len() + column])
    }

    /// The counts, a row for each presented label.
    pub fn rows(&self) -> impl Iterator<Item = &[u32]> {
        self.counts.chunks(self.labels.len())
    }

    /// Parts of the answers of each row, from 0 to 1; `None` for a label that was never presented.
    pub fn proportions(&self) -> Vec<Option<Vec<f64>>> {
        let of_row = |row: &[u32]| {
            let total = f64::from(row.iter().sum::<u32>());
            (total > 0.0).then(|| row.iter().map(|&n| f64::from(n) / total).collect())
        };
        self.rows().map(of_row).collect()
    }

    /// Correct answers of all.
    ///
    /// # Errors
    /// No answers.
    pub fn correct(&self) -> Result<Proportion> {
        let correct = self.rows().enumerate().map(|(i, row)| row[i]).sum();
        Proportion::new(correct, self.counts.iter().sum())
    }

    /// Correct answers where a label was presented.
    ///
    /// # Errors
    /// An unknown label, or no answers.
    pub fn correct_of(&self, presented: &str) -> Result<Proportion> {
        let row = self.index(presented)?;
        let counts = &self.counts[row * self.labels.len()..][..self.labels.len()];
        Proportion::new(counts[row], counts.iter().sum())
    }

    /// Information transmitted.
    ///
    /// # Errors
    /// No answers.
    pub fn information(&self) -> Result<Information> {
        let size = self.labels.len();
        let total: u32 = self.counts.iter().sum();
        at_least("answers", total as usize, 1)?;
        let total = f64::from(total);
        let presented: Vec<u32> = self.rows().map(|row| row.iter().sum()).collect();
        let answered: Vec<u32> =
            (0..size).map(|column| self.rows().map(|row| row[column]).sum()).collect();
        let cells = self.counts.iter().enumerate().filter(|&(_, &n)| n > 0);
        let observed_bits: f64 = cells
            .map(|(cell, &n)| {
                let by_chance =
                    f64::from(presented[cell / size]) * f64::from(answered[cell % size]) / total;
                f64::from(n) / total * (f64::from(n) / by_chance).log2()
            })
            .sum();
        let occupied = |counts: &[u32]| counts.iter().filter(|&&n| n > 0).count() as f64;
        let bins = occupied(&presented) + occupied(&answered) - occupied(&self.counts) - 1.0;
        Ok(Information {
            observed_bits,
            corrected_bits: observed_bits + bins / (2.0 * total * std::f64::consts::LN_2),
        })
    }

    fn index(&self, label: &str) -> Result<usize> {
        let known = self.labels.iter().position(|known| known == label);
        known.ok_or_else(|| StatisticsError::Label {
            label: label.into(),
            why: "is none of the matrix",
        })
    }
}
