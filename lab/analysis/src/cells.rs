//! Observations by participant and level, as the cells of a repeated-measures design.

use std::collections::BTreeMap;

/// Means by participant and level. Participants without an observation in some cell are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// Levels, in the order in which they were given.
    pub levels: Vec<String>,
    /// A row of means for each participant that has all cells.
    pub rows: Vec<Vec<f64>>,
    /// The participants of the rows.
    pub participants: Vec<usize>,
    /// The cells of every participant, those left out among them.
    pub partial: Vec<(usize, Vec<Option<f64>>)>,
}

impl Cells {
    /// Cells at all `levels` from observations: participant, level, value.
    pub fn new<L: PartialEq + ToString>(levels: &[L], observations: &[(usize, L, f64)]) -> Self {
        let mut cells = Self {
            levels: levels.iter().map(ToString::to_string).collect(),
            rows: Vec::new(),
            participants: Vec::new(),
            partial: Vec::new(),
        };
        let of_each =
            observations.iter().map(|(participant, level, value)| (*participant, (level, *value)));
        for (participant, observations) in grouped(of_each) {
            let mean_at = |level: &L| {
                let of_cell =
                    observations.iter().filter(|(at, value)| *at == level && value.is_finite());
                mean(of_cell.map(|(_, value)| *value))
            };
            let own: Vec<Option<f64>> = levels.iter().map(mean_at).collect();
            cells.partial.push((participant, own.clone()));
            match own.into_iter().collect::<Option<Vec<_>>>() {
                Some(row) if !row.is_empty() => {
                    cells.rows.push(row);
                    cells.participants.push(participant);
                }
                _ => {}
            }
        }
        cells
    }

    /// The rows as tables whose first factor has levels of `second` cells each.
    pub fn by_two(&self, second: usize) -> Vec<Vec<Vec<f64>>> {
        let of_row = |row: &Vec<f64>| row.chunks(second.max(1)).map(<[f64]>::to_vec).collect();
        self.rows.iter().map(of_row).collect()
    }
}

/// Arithmetic mean; `None` of nothing.
pub fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0u32), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// Values in the order in which they first occur, each once.
pub fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut known = Vec::new();
    for value in values {
        if !known.contains(&value) {
            known.push(value);
        }
    }
    known
}

/// Values by key, in the order in which the keys first occur.
pub fn grouped<K: Ord + Clone, T>(values: impl IntoIterator<Item = (K, T)>) -> Vec<(K, Vec<T>)> {
    let mut groups: Vec<(K, Vec<T>)> = Vec::new();
    let mut places = BTreeMap::new();
    for (key, value) in values {
        let place = *places.entry(key.clone()).or_insert_with(|| {
            groups.push((key, Vec::new()));
            groups.len() - 1
        });
        groups[place].1.push(value);
    }
    groups
}

/// Participants' own means, from observations: participant, value.
pub fn means_of_participants(observations: impl Iterator<Item = (usize, f64)>) -> Vec<f64> {
    let of_each = grouped(observations.filter(|(_, value)| value.is_finite()));
    of_each.into_iter().filter_map(|(_, own)| mean(own.into_iter())).collect()
}

/// Number of participants, mean of their own means, and its standard error.
pub fn over_participants(observations: &[(usize, f64)]) -> (usize, Option<f64>, Option<f64>) {
    let means = means_of_participants(observations.iter().copied());
    let sem = experiment_statistics::standard_error_of_mean(&means).ok();
    (means.len(), mean(means.iter().copied()), sem)
}
