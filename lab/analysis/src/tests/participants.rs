//! One, many, perfect and random participants; void and missing trials.

use super::assert_near;
use super::data::{self, Noise};
use crate::analyses::of_task;
use crate::report::Cell;

#[test]
fn without_noise_all_answers_are_correct_and_what_does_not_vary_is_said() {
    let analysis = of_task(&data::real_and_simulated(3, 0.0));
    for row in &analysis.table("pairs-by-mode").rows {
        assert_eq!(row[5], Cell::from(100.0), "{row:?}");
    }
    assert!(analysis.not_possible().iter().any(|sentence| sentence.contains("does not vary")));
}

#[test]
fn random_answers_are_at_chance() {
    let mut task = data::identification(10, 0.0);
    let mut random = Noise::new(7);
    for trial in task.participants.iter_mut().flat_map(|person| &mut person.trials) {
        let answer = data::FIVE[random.index(5)].to_owned();
        trial.record.is_correct = Some(Some(&answer) == trial.record.expected.as_ref());
        trial.record.answer = Some(answer);
    }
    let analysis = of_task(&task);
    let table = analysis.table("identification");
    // 99.9 % of the binomial distribution of 450 answers with chance 1/5 lie from 63 to 119.
    let correct = table.number(&["simulated", "all"], "correct");
    assert!((63.0..=119.0).contains(&correct), "{correct}");
    let bits = analysis.table("information").number(&["simulated"], "corrected (Miller-Madow)");
    assert!(bits.abs() < 0.05, "{bits}");
}

#[test]
fn a_single_participant_gives_tables_and_sentences() {
    let analysis = of_task(&data::identification(1, 0.5));
    assert!(!analysis.table("confusion-real").rows.is_empty());
    assert!(analysis.section("anova-within").tables.is_empty());
    let sentences = &analysis.section("anova-within").not_possible;
    assert!(
        sentences.iter().all(|sentence| sentence.contains("two or more are needed")),
        "{sentences:?}"
    );
}

#[test]
fn an_interrupted_session_gives_what_there_is() {
    let mut task = data::identification(2, 0.5);
    let person = &mut task.participants[1];
    person.trials.truncate(7);
    person.records.truncate(7);
    let analysis = of_task(&task);
    assert!(
        analysis
            .section("participants")
            .notes
            .iter()
            .any(|note| note.contains("P01 has 7 of 60 trials"))
    );
    assert_near(analysis.table("information").number(&["real"], "n"), 22.0, 0.0);
}

#[test]
fn void_trials_do_not_count_and_are_listed_by_reason() {
    let mut task = data::real_and_simulated(2, 0.4);
    let mut other = task.participants[0].records[0].clone();
    other.void = Some("the display was 0.41 K from its set-point at the landing".into());
    task.participants[0].records.push(other);
    let analysis = of_task(&task);
    let voids = analysis.table("voids");
    assert_eq!(voids.rows.len(), 1, "reasons that differ in numbers only are one");
    assert_eq!(voids.rows[0][1..3], [Cell::from(3u32), Cell::from(2u32)]);
    let participants = analysis.table("participants");
    assert_near(participants.number(&["P00"], "attempts"), 66.0, 0.0);
    assert_near(participants.number(&["P00"], "void"), 2.0, 0.0);
    assert_near(participants.number(&["P00"], "counted"), 64.0, 0.0);
    assert_eq!(analysis.table("trials").rows.len(), 66 + 65);
}

#[test]
fn the_order_of_the_trials_does_not_matter() {
    let task = data::localisation(2, 0.4);
    let mut turned = task.clone();
    for person in &mut turned.participants {
        person.trials.reverse();
    }
    let (one, other) = (of_task(&task), of_task(&turned));
    assert_eq!(one.table("oddity").rows, other.table("oddity").rows);
    assert_eq!(one.table("anova-within").rows, other.table("anova-within").rows);
}

#[test]
fn published_results_stand_beside_those_of_shipped_sessions() {
    let rows = |analysis: &crate::TaskAnalysis| analysis.table("published").rows.len();
    assert_eq!(rows(&of_task(&data::discrimination(1, 0.4))), 15);
    assert_eq!(rows(&of_task(&data::localisation(1, 0.4))), 20);
    assert_eq!(rows(&of_task(&data::real_and_simulated(1, 0.4))), 12);
    let identification = of_task(&data::identification(2, 0.0));
    assert_eq!(rows(&identification), 9);
    let published = identification.table("published");
    assert_eq!(published.cell(&["real, foam"], "published"), &Cell::from("100"));
    assert_near(published.number(&["real, foam"], "here"), 100.0, 0.0);
    let other = of_task(&data::referral(1));
    assert!(other.sections.iter().all(|section| section.name != "published"));
}

#[test]
fn same_or_different_has_no_sensitivity_of_a_choice_of_two() {
    let analysis = of_task(&data::same_or_different(2));
    let row = ["copper / abs", "R/S > 1"];
    assert_eq!(analysis.table("pairs-by-mode").cell(&row, "d' (2AFC)"), &Cell::Nothing);
    assert_near(analysis.table("same-different").number(&["copper / abs"], "n"), 20.0, 0.0);
    let anova = analysis.table("anova-within");
    assert_near(anova.number(&["correct / %", "pair"], "n"), 2.0, 0.0);
}
