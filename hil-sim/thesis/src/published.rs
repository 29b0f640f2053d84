//! Results of the thesis's experiments, for comparison with measured and predicted ones. Materials have the names of
//! [`MATERIALS`](contact_model::material::MATERIALS).

use serde::Deserialize;

use super::chapter3::{HIGH_LOW, LOW_HIGH, MODULI_GPA, table_3_3, table_3_5};
use super::statement::read;

/// Share of correct answers for two materials.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedPair {
    /// In Table 3-5 the target, otherwise the material with the larger contact coefficient.
    pub first: String,
    /// In Table 3-5 both distractors, otherwise the other material.
    pub second: String,
    /// Correct answers, %, rounded as printed.
    pub percent: f64,
}

/// Answers of a pair in Table 3-3: 10 subjects, 4 repetitions.
pub const ANSWERS_OF_TABLE_3_3: u32 = 40;

/// Answers of a target and its distractor in Table 3-5: 10 subjects, 3 positions, 3 repetitions.
pub const ANSWERS_OF_TABLE_3_5: u32 = 90;

fn pair(pair: &str, percent: f64) -> Option<PublishedPair> {
    let (first, second) = pair.split_once(" / ")?;
    let name = |words: &str| words.to_lowercase().replace(' ', "-");
    Some(PublishedPair { first: name(first), second: name(second), percent })
}

/// Table 3-3: which of two real materials is colder.
pub fn discrimination() -> Vec<PublishedPair> {
    let rows = table_3_3().into_iter();
    rows.filter_map(|row| pair(&row.pair, row.percent)).collect()
}

/// Table 3-5: which of three fingers touches another material than the other two.
pub fn localisation() -> Vec<PublishedPair> {
    let high = table_3_5(HIGH_LOW).into_iter();
    let high = high.filter_map(|row| pair(&row.pair, row.percent));
    let low = table_3_5(LOW_HIGH).into_iter();
    let low = low.filter_map(|row| pair(&row.pair, row.percent)).map(|row| PublishedPair {
        first: row.second,
        second: row.first,
        ..row
    });
    high.chain(low).collect()
}

/// Young's modulus of a material, GPa (Tables 3-2 and 4-1); `None` of one that the thesis does not have.
pub fn youngs_modulus_gpa(material: &str) -> Option<f64> {
    let mut moduli = MODULI_GPA.iter();
    moduli.find(|(name, _)| *name == material).map(|(_, gpa)| *gpa)
}

/// A result that the thesis states in words, because it is in a picture only.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct StatedResult {
    /// Where it stands.
    pub place: String,
    /// What it is of: a part, materials, a mode.
    pub of: String,
    /// What is stated: a number, or words.
    pub stated: String,
}

/// Identification of real and simulated materials, section 4.2.2: correct answers, %.
///
/// # Panics
/// The program's own table cannot be read.
pub fn identification() -> Vec<StatedResult> {
    results("Section 4.2.2")
}

/// Real against simulated materials, section 4.3.2: whether more answers than 72 % are correct.
///
/// # Panics
/// The program's own table cannot be read.
pub fn real_against_simulated() -> Vec<StatedResult> {
    results("Section 4.3.2")
}

fn results(place: &str) -> Vec<StatedResult> {
    let rows: Vec<StatedResult> =
        read("results.csv", include_str!("../data/results.csv")).expect("a table of the program");
    rows.into_iter().filter(|row| row.place == place).collect()
}

#[cfg(test)]
mod tests {
    use contact_model::material::find;

    use super::*;

    #[test]
    fn the_published_tables_are_complete_and_of_known_materials() {
        let (pairs, targets) = (discrimination(), localisation());
        assert_eq!((pairs.len(), targets.len()), (15, 20));
        for row in pairs.iter().chain(&targets) {
            assert!(find(&row.first).is_some() && find(&row.second).is_some(), "{row:?}");
        }
        let ss_granite =
            targets.iter().find(|row| row.first == "granite" && row.second == "stainless-steel");
        assert_eq!(ss_granite.map(|row| row.percent), Some(43.0));
        assert_eq!((identification().len(), real_against_simulated().len()), (9, 12));
    }
}
