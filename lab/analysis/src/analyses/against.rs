//! Comparison of the answers to pairs with a published experiment.

use experiment_statistics::chi_square::contingency;
use thermal_thesis::published::{ANSWERS_OF_TABLE_3_3, discrimination};

use super::chi_square;
use super::pairs::{BETWEEN, answers};
use crate::cells::distinct;
use crate::input::Task;
use crate::report::{Section, Table, cells, numbers, probabilities, words};

/// Correct answers by pair, here and in Table 3-3.
pub fn chi_squared_against(task: &Task) -> Section {
    let mut section = Section::new("chi-squared-against", "Comparison with Table 3-3").note(format!(
        "Correct answers of the pairs that both experiments have, pooled over participants, modes and parts. The first test asks \
         whether correct answers are distributed over the pairs as in Table 3-3, as section 4.3.2 of the thesis does; it does not \
         see a difference that all pairs share. The second one asks of each pair whether its share differs, p times the number of \
         pairs (Bonferroni). The published counts are the printed shares of {ANSWERS_OF_TABLE_3_3} answers."
    ));
    let answers = answers(task);
    let mut table = Table::new(
        "against-table-3-3",
        "Correct answers by pair; n counts answers",
        [
            words("pair"),
            words("n"),
            words("correct"),
            numbers("share", "%", 1),
            words("published correct"),
            numbers("published share", "%", 0),
            numbers("chi-squared", "", 3),
            probabilities("p"),
            probabilities("p (Bonferroni)"),
            numbers("smallest expected count", "", 1),
        ],
    );
    let mut counts: [Vec<u32>; 2] = Default::default();
    let (mut rows, mut unanswered) = (Vec::new(), Vec::new());
    for published in discrimination() {
        let of =
            answers.iter().filter(|answer| answer.pair == [&*published.first, &*published.second]);
        let of: Vec<bool> = of.map(|answer| answer.is_correct).collect();
        if of.is_empty() {
            unanswered.push([&*published.first, &*published.second].join(BETWEEN));
            continue;
        }
        let (total, correct) =
            (of.len() as u32, of.iter().filter(|correct| **correct).count() as u32);
        let of_40 = (published.percent / 100.0 * f64::from(ANSWERS_OF_TABLE_3_3)).round() as u32;
        counts[0].push(correct);
        counts[1].push(of_40);
        rows.push((published, total, correct, of_40));
    }
    let is_published = |pair: &[&str; 2]| {
        discrimination().iter().any(|published| *pair == [&*published.first, &*published.second])
    };
    let own = distinct(answers.iter().map(|answer| answer.pair));
    let own = own.into_iter().filter(|pair| !is_published(pair)).map(|pair| pair.join(BETWEEN));
    let own: Vec<_> = own.collect();
    for (pairs, why) in [(unanswered, "without answers here"), (own, "not in Table 3-3")] {
        let names = pairs.join(", ");
        section.warn((!pairs.is_empty()).then(|| format!("Left out, {why}: {names}.")));
    }
    let pairs = rows.len() as f64;
    for (published, total, correct, of_40) in rows {
        let of_pair = [[correct, total - correct], [of_40, ANSWERS_OF_TABLE_3_3 - of_40]];
        let test = contingency(&of_pair).ok();
        let pair = [&*published.first, &*published.second].join(BETWEEN);
        section.warn(test.and_then(|test| chi_square::warning(&pair, &test)));
        table.row(cells![
            pair,
            total,
            correct,
            100.0 * f64::from(correct) / f64::from(total),
            of_40,
            published.percent,
            test.map(|test| test.statistic),
            test.map(|test| test.p),
            test.map(|test| (test.p * pairs).min(1.0)),
            test.map(|test| test.smallest_expected)
        ]);
    }
    let mut all = Table::new(
        "chi-squared-against",
        "Correct answers by pair and experiment",
        [
            words("pairs"),
            numbers("chi-squared", "", 3),
            numbers("df", "", 0),
            probabilities("p"),
            numbers("smallest expected count", "", 1),
        ],
    );
    match contingency(&counts) {
        Ok(test) => {
            section.warn(chi_square::warning("Distribution over the pairs", &test));
            all.row(cells![
                counts[0].len(),
                test.statistic,
                test.df,
                test.p,
                test.smallest_expected
            ]);
        }
        Err(error) => section.lacks("Distribution over the pairs", error),
    }
    section.add(all);
    section.add(table);
    section
}
