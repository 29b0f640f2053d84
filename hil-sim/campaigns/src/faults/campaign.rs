//! What of the matrix is run, and what came of each row.

use serde::Serialize;
use thermal_plant::parameters::stream_seed;

use super::{Entry, Moment, Place, Trial};

/// A part of the matrix.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Rows.
    pub entries: Vec<Entry>,
    /// Places.
    pub places: Vec<Place>,
    /// Moments of each row.
    pub moments: usize,
    /// Of every draw, and of the device's converter.
    pub seed: u64,
}

impl Plan {
    /// The runs: the row's number, and the moment. The places where an entry is worst come first, the others in an order
    /// that is drawn for it; if there are more moments than places they come again.
    #[must_use]
    pub fn runs(&self) -> Vec<(usize, Moment)> {
        let mut runs = Vec::new();
        for (row, entry) in self.entries.iter().enumerate() {
            let name = entry.fault.to_string();
            let mut places = self.places.clone();
            places.retain(|place| !entry.never_at.contains(place));
            places.sort_by_key(|place| {
                let first = entry.places.iter().position(|worst| worst == place);
                (
                    first.unwrap_or(usize::MAX),
                    stream_seed(self.seed, &format!("{name} {}", place.name())),
                )
            });
            for (k, place) in places.iter().cycle().take(self.moments).enumerate() {
                let seed = stream_seed(self.seed, &format!("{name} {k}"));
                runs.push((row, place.moment(seed, k % 2 == 0)));
            }
        }
        runs
    }
}

/// What came of a row.
#[derive(Clone, Debug, Serialize)]
pub struct Outline {
    /// The fault.
    pub fault: String,
    /// It shows at the next self-test only, or not at all.
    pub latent: bool,
    /// All runs; none if the engine has no part that could fail so.
    pub trials: Vec<Trial>,
    /// No run has a breach.
    pub holds: bool,
}

impl Outline {
    /// Sums up the runs of an entry.
    #[must_use]
    pub fn new(entry: &Entry, trials: Vec<Trial>) -> Self {
        Self {
            fault: entry.fault.to_string(),
            latent: entry.latent,
            holds: trials.iter().all(|trial| trial.verdict.breaches.is_empty()),
            trials,
        }
    }

    /// Largest of a figure over the runs.
    #[must_use]
    pub fn most(&self, of: impl Fn(&Trial) -> Option<f64>) -> Option<f64> {
        self.trials.iter().filter_map(of).max_by(f64::total_cmp)
    }

    /// Reasons that were given, the most frequent first, and how often.
    #[must_use]
    pub fn reasons(&self) -> Vec<(&str, usize)> {
        let mut reasons: Vec<(&str, usize)> = Vec::new();
        for trial in &self.trials {
            let reason = trial.verdict.reason.as_str();
            match reasons.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, count)) => *count += 1,
                None => reasons.push((reason, 1)),
            }
        }
        reasons.sort_by_key(|(reason, count)| (usize::MAX - count, *reason));
        reasons
    }
}
