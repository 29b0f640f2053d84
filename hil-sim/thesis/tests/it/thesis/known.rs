//! Completeness of the rows, and the known rows that do not agree.

use std::collections::BTreeSet;

use documented_figures::assert_figure;
use serde::Deserialize;
use thermal_thesis::row::Verdict;

use super::{all_rows, table};

#[test]
fn exactly_the_known_rows_do_not_agree() {
    #[derive(Deserialize)]
    struct Known {
        verdict: String,
        place: String,
        quantity: String,
    }
    let known: BTreeSet<_> = table::<Known>(include_str!("../../data/thesis_known.csv"))
        .into_iter()
        .map(|known| (known.verdict, known.place, known.quantity))
        .collect();
    let found: BTreeSet<_> = all_rows()
        .into_iter()
        .filter(|row| row.verdict() != Verdict::Agrees)
        .map(|row| (row.verdict().word().to_owned(), row.place.to_owned(), row.quantity))
        .collect();
    let new: Vec<_> = found.difference(&known).collect();
    let gone: Vec<_> = known.difference(&found).collect();
    assert!(new.is_empty() && gone.is_empty(), "new: {new:?}\ngone: {gone:?}");
}

#[test]
fn every_place_has_rows_and_no_row_is_repeated() {
    let rows = all_rows();
    let places: BTreeSet<_> = rows.iter().map(|row| row.place).collect();
    for place in [
        "Table 3-1",
        "Table 3-2",
        "Table 3-4",
        "Table 3-5",
        "Table 4-1",
        "Section 4.2.3",
        "Table 5-1",
        "Table 5-3",
        "Eq. 5-1",
        "Eq. 5-2",
        "Figure 5-8",
        "Figure 5-10",
        "Section 6.3",
        "Figure 6-6",
        "Figure 6-7",
        "Figure 6-8",
        "Figure 6-9",
        "Figure 6-10",
        "Figure 6-11",
        "Figure 6-12",
        "Figure 6-13",
        "Figure 6-19",
        "Figure 6-20",
        "Section 6.4.2",
        "Eq. 6-13",
    ] {
        assert!(places.contains(place), "{place} is missing");
    }
    let names: BTreeSet<_> = rows.iter().map(|row| (row.place, &row.quantity)).collect();
    assert_eq!(names.len(), rows.len());
    assert!(rows.iter().all(|row| row.computed.is_finite()));
}

#[test]
fn each_verdict_has_as_many_rows_as_documented() {
    let rows = all_rows();
    assert_figure("thesis.rows", rows.len() as f64);
    for name in ["agrees", "cut", "damaged", "wrong", "differs"] {
        let words = rows.iter().map(|row| row.verdict().word());
        let count = words.filter(|word| *word == name).count();
        assert_figure(&format!("thesis.{name}"), count as f64);
    }
}
