//! Words and warnings that follow from a criterion, and rounding errors.

use super::assert_near;
use super::data::{self, display, participant, sample, task, trial};
use crate::analyses::of_task;
use crate::input::{Task, Trial};
use crate::report::{Cell, Table, cells, numbers, probabilities};

const SIDES: [&str; 2] = ["left", "right"];

/// A task with a threshold of 72 % and answers of which the first are correct.
fn answered(total: u32, correct: u32) -> Task {
    let mut task = task("pair", &SIDES, &SIDES, &["pairs", "chi-squared-against"]);
    task.threshold = Some(0.72);
    let of = |index: u32| -> Trial {
        let answer = if index < correct { "left" } else { "right" };
        let presented = vec![sample("copper"), sample("bronze")];
        trial(index + 1, "main", presented, answer, Some("left"))
    };
    task.participants.push(participant("P1", (0..total).map(of).collect()));
    task
}

/// By sums of binomial terms: 2 of 2 has p = .25 by chance, 7 of 8 .035, 8 of 8 .0039, 10 of 12 .019, 11 of 12 .0032.
#[test]
fn told_apart_is_said_by_the_criterion_only() {
    for (total, correct, verdict) in [
        (2, 2, "too few answers"),
        (2, 1, "too few answers"),
        (6, 6, "too few answers"),
        (8, 7, "too few answers"),
        (8, 8, "yes"),
        (12, 10, "too few answers"),
        (12, 11, "yes"),
        (12, 8, "no"),
        (40, 28, "no"),
    ] {
        let analysis = of_task(&answered(total, correct));
        let cell = analysis.table("pairs").cell(&["copper / bronze"], "told apart");
        assert_eq!(cell, &Cell::from(verdict), "{correct} of {total}");
    }
}

#[test]
fn without_chance_nothing_is_told_apart() {
    let mut task = answered(12, 12);
    task.chance = None;
    let analysis = of_task(&task);
    assert_eq!(analysis.table("pairs").cell(&["copper / bronze"], "told apart"), &Cell::Nothing);
}

/// 40 published answers, of which 28 (70 %) are correct, and 4 here: 13 wrong of 44 in all, 4 / 44 of them expected here.
#[test]
fn small_expected_counts_of_chi_squared_are_warned_of() {
    let analysis = of_task(&answered(4, 3));
    let table = analysis.table("against-table-3-3");
    let smallest = table.number(&["copper / bronze"], "smallest expected count");
    let published = table.number(&["copper / bronze"], "published correct");
    let expected = 4.0 * (40.0 - published + 1.0) / 44.0;
    assert_near(smallest, expected, 1e-12);
    let warnings = analysis.warnings("chi-squared-against");
    let sentence = format!(
        "copper / bronze: an expected count is {expected:.1}, below 5; p of chi-squared is a poor approximation."
    );
    assert!(warnings.contains(&&*sentence), "{warnings:?}");
    let many = of_task(&answered(200, 150));
    let said = many.warnings("chi-squared-against");
    assert!(!said.iter().any(|one| one.contains("expected count")), "{said:?}");
}

#[test]
fn hits_and_false_alarms_with_small_expected_counts_are_warned_of() {
    let mut task = task("same", &SIDES, &["same", "different"], &["same-different"]);
    let of = |index: u32| {
        let (other, answer) = if index < 5 { ("abs", "different") } else { ("copper", "same") };
        trial(index + 1, "main", vec![sample("copper"), display(0, other)], answer, None)
    };
    task.participants.push(participant("P1", (0..10).map(of).collect()));
    let analysis = of_task(&task);
    let table = analysis.table("same-different");
    assert_near(table.number(&["copper / abs"], "smallest expected count"), 2.5, 1e-12);
    let sentence = "copper / abs: an expected count is 2.5, below 5; p of chi-squared is a poor approximation.";
    assert_eq!(analysis.warnings("same-different"), [sentence]);
}

#[test]
fn half_of_the_answers_correct_is_a_sensitivity_of_zero() {
    let analysis = of_task(&answered(40, 20));
    assert_eq!(analysis.table("pairs").cell(&["copper / bronze"], "d' (2AFC)"), &Cell::Number(0.0));
}

#[test]
fn rounding_errors_are_zero_and_small_probabilities_stay() {
    let mut table = Table::new("t", "t", [numbers("d'", "", 2), probabilities("p")]);
    table.row(cells![1.276_756e-15, 1.276_756e-15]);
    table.row(cells![-1.276_756e-15, 0.5]);
    table.row(cells![1e-9, 0.5]);
    assert_eq!(table.rows[0], [Cell::Number(0.0), Cell::Number(1.276_756e-15)]);
    assert_eq!(table.rows[1][0], Cell::Number(0.0));
    assert_eq!(table.rows[2][0], Cell::Number(1e-9));
}

/// Trials of a staircase with these levels, correct answers and all answers.
fn staircase(levels: &[(f64, u32, u32)]) -> Task {
    let mut task = data::thresholds(1, 0.3);
    let template = task.participants[0].trials[0].clone();
    let of_level = |(level_k, correct, total): &(f64, u32, u32)| {
        let trial = |number: u32| {
            let mut trial = template.clone();
            trial.record.staircase_level_k = Some(*level_k);
            trial.record.is_correct = Some(number < *correct);
            trial
        };
        (0..*total).map(trial).collect::<Vec<_>>()
    };
    task.participants[0].trials = levels.iter().flat_map(of_level).collect();
    task
}

#[test]
fn a_slope_that_the_answers_do_not_determine_is_said_and_no_function_is_fitted() {
    let analysis = of_task(&staircase(&[
        (0.253, 0, 1),
        (0.35673, 4, 8),
        (0.50299, 11, 12),
        (0.70922, 4, 5),
        (1.0, 4, 5),
        (1.41, 2, 2),
    ]));
    let section = analysis.section("psychometric-fit");
    assert!(section.tables.is_empty());
    assert_eq!(section.not_possible, ["cooling, all: the data do not determine the slope"]);
}

#[test]
fn a_deviance_of_few_answers_is_warned_of() {
    let few = [(0.25, 6, 10), (0.35, 7, 10), (0.5, 8, 10), (0.7, 9, 10)];
    let sentence = "p of the deviance is a poor approximation where fewer than 5 correct or wrong answers are expected at a level (cooling, all: 4 of 4 levels).";
    assert!(of_task(&staircase(&few)).warnings("psychometric-fit").contains(&sentence));
    let many = [(0.25, 60, 100), (0.35, 70, 100), (0.5, 80, 100), (0.7, 90, 100)];
    assert!(of_task(&staircase(&many)).warnings("psychometric-fit").is_empty());
}

#[test]
fn bootstrap_samples_without_a_function_are_counted() {
    let analysis =
        of_task(&staircase(&[(0.25, 17, 30), (0.35, 21, 30), (0.5, 24, 30), (0.7, 27, 30)]));
    let row = ["cooling", "all"];
    assert!(analysis.table("psychometric-fit").number(&row, "95 % from") > 0.2);
    let warnings = analysis.warnings("psychometric-fit");
    let is_of_samples = |warning: &&str| {
        warning.starts_with("cooling, all: the interval is without ")
            && warning.ends_with(" of 400 bootstrap samples, which determine no function.")
    };
    assert!(warnings.iter().any(is_of_samples), "{warnings:?}");
}
