//! Comparison of all pairs of means after an analysis of variance.

use experiment_statistics::anova::{repeated_measures, two_within};
use experiment_statistics::tukey::tukey as compare;

use super::anova::impossible;
use super::design::{self, Design, Marginal};
use super::left_out;
use crate::cells::mean;
use crate::input::Task;
use crate::report::{Section, Table, cells, numbers, probabilities, words};

/// Tukey's test of the levels of each factor, and of the parts at each level.
pub fn tukey(task: &Task) -> Section {
    let mut section = Section::new("tukey", "Comparison of pairs of means (Tukey)").note(
        "q is the difference over the standard error of a mean, from the error of the analysis of variance; p is the \
         probability of such a difference between any two of the means of the factor, so it is corrected for the number of \
         pairs of that factor. Two levels are compared by the analysis of variance itself.",
    );
    let mut table = Table::new("tukey", "Pairs of levels; n counts participants", columns());
    if task.asks_for("anova-within") {
        for design in design::within(task) {
            levels(task, &design, &mut table, &mut section);
        }
    }
    section.add(table);
    if task.asks_for("anova-split-plot") {
        let mut table = Table::new(
            "tukey-parts",
            "Parts compared at each level, with the error of the interaction; p is that of one level, as in the thesis; beside it \
             times the number of levels (Bonferroni)",
            columns().into_iter().chain([probabilities("p (Bonferroni)")]),
        );
        for design in design::of_parts(task) {
            parts(task, &design, &mut table, &mut section);
        }
        section.add(table);
    }
    if section.tables.is_empty() && section.not_possible.is_empty() {
        section.lacks("Comparison", "there is no analysis of variance with more than one level");
    }
    section
}

fn columns() -> Vec<crate::report::Column> {
    vec![
        words("dependent variable"),
        words("factor"),
        words("first"),
        words("second"),
        words("n"),
        numbers("difference", "", 3),
        numbers("q", "", 3),
        words("means"),
        numbers("df error", "", 0),
        probabilities("p"),
    ]
}

fn levels(task: &Task, design: &Design, table: &mut Table, section: &mut Section) {
    left_out::of_design(section, task, design);
    if let Some(why) = impossible(task, design) {
        return section.lacks(&design.dependent, why);
    }
    for factor in 0..design.factors.len() {
        let Some(Marginal { factor: name, levels, rows }) = design.marginal(factor) else {
            continue;
        };
        if levels.len() < 3 {
            continue;
        }
        let compared = repeated_measures(&rows).and_then(|anova| {
            let error = anova.effect.mean_square_error();
            compare(&anova.means, rows.len(), error, anova.effect.error_df)
                .map(|pairs| (pairs, anova.effect.error_df))
        });
        match compared {
            Ok((tukey, error_df)) => {
                for pair in tukey.pairs {
                    table.row(cells![
                        design.dependent.clone(),
                        name,
                        levels[pair.first].clone(),
                        levels[pair.second].clone(),
                        rows.len(),
                        pair.difference,
                        pair.q,
                        levels.len(),
                        error_df,
                        pair.p
                    ]);
                }
            }
            Err(error) => section.lacks(&format!("{}, {name}", design.dependent), error),
        }
    }
}

/// The parts at each level of the other factor, as the thesis compares real and simulated materials.
fn parts(task: &Task, design: &Design, table: &mut Table, section: &mut Section) {
    let [(_, parts), (factor, levels)] = &design.factors[..] else {
        return;
    };
    left_out::of_design(section, task, design);
    if let Some(why) = impossible(task, design) {
        return section.lacks(&design.dependent, why);
    }
    let rows = &design.cells.rows;
    let anova = match two_within(&design.cells.by_two(levels.len())) {
        Ok(anova) => anova,
        Err(error) => return section.lacks(&design.dependent, error),
    };
    let (error, error_df) = (anova.interaction.mean_square_error(), anova.interaction.error_df);
    for (index, level) in levels.iter().enumerate() {
        let at = |part: usize| mean(rows.iter().map(|row| row[part * levels.len() + index]));
        let means: Vec<f64> = (0..parts.len()).filter_map(at).collect();
        match compare(&means, rows.len(), error, error_df) {
            Ok(tukey) => {
                for pair in tukey.pairs {
                    table.row(cells![
                        design.dependent.clone(),
                        format!("part, {factor} {level}"),
                        parts[pair.first].clone(),
                        parts[pair.second].clone(),
                        rows.len(),
                        pair.difference,
                        pair.q,
                        parts.len(),
                        error_df,
                        pair.p,
                        (pair.p * levels.len() as f64).min(1.0)
                    ]);
                }
            }
            Err(why) => section.lacks(&format!("{}, {level}", design.dependent), why),
        }
    }
}
