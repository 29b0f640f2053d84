//! Analyses of variance.

use experiment_statistics::anova::{
    Effect, contrast_within, repeated_measures, split_plot as split_plot_of, two_within,
};

use super::design::{self, Contrast, Design, Marginal};
use super::left_out;
use crate::cells::distinct;
use crate::input::Task;
use crate::report::{Section, Table, cells, numbers, probabilities, words};

const READING: &str = "Each effect is tested against its own interaction with the participants. p is uncorrected, as the thesis \
     prints it; beside it stands p with both degrees of freedom times epsilon (Greenhouse and Geisser), which does not presuppose \
     sphericity and is the one to rely on. Participants without data in some cell are left out; n counts those that are not.";

/// Analyses of variance with all factors within participants.
pub fn within(task: &Task) -> Section {
    let mut section =
        Section::new("anova-within", "Repeated-measures analysis of variance").note(READING);
    let (mut table, mut contrasts) = (table("anova-within"), contrast_table());
    let designs = design::within(task);
    if designs.is_empty() {
        section.lacks(
            "Analysis of variance",
            "the session file asks for no table that has a dependent variable",
        );
    }
    for design in &designs {
        effects(task, design, &mut table, &mut section);
        contrasts_of(task, design, &mut contrasts, &mut section);
    }
    section.add(table);
    section.add(contrasts);
    section
}

/// Analyses of variance with the parts of the session as one factor.
pub fn split_plot(task: &Task) -> Section {
    let mut section = Section::new("anova-split-plot", "Analysis of variance with the parts of the session").note(
        "Where the same participants did all parts, both factors are within participants; the degrees of freedom are those that \
         the thesis prints for its \"split-plot\" designs. Only where different participants did the parts is the part a factor \
         between them.",
    );
    let mut table = table("anova-split-plot");
    let designs = design::of_parts(task);
    if designs.is_empty() {
        section.lacks(
            "Analysis of variance",
            "the session file asks for no table that has a dependent variable",
        );
    }
    for design in &designs {
        match groups(task, design) {
            Some(groups) => between(task, design, &groups, &mut table, &mut section),
            None => effects(task, design, &mut table, &mut section),
        }
    }
    section.add(table);
    section
}

fn table(name: &str) -> Table {
    Table::new(
        name,
        "Effects; n counts participants",
        [
            words("dependent variable"),
            words("effect"),
            words("n"),
            words("left out"),
            numbers("F", "", 3),
            numbers("df", "", 0),
            numbers("df error", "", 0),
            probabilities("p"),
            numbers("epsilon", "", 3),
            probabilities("p (Greenhouse-Geisser)"),
            numbers("partial eta squared", "", 3),
        ],
    )
}

fn add_effect(
    table: &mut Table,
    design: &Design,
    name: &str,
    (n, left_out): (usize, usize),
    effect: &Effect,
) {
    table.row(cells![
        design.dependent.clone(),
        name,
        n,
        left_out,
        effect.f,
        effect.df,
        effect.error_df,
        effect.p,
        effect.sphericity.map(|sphericity| sphericity.epsilon),
        effect.sphericity.map(|sphericity| sphericity.p),
        effect.partial_eta_squared
    ]);
}

fn effects(task: &Task, design: &Design, table: &mut Table, section: &mut Section) {
    left_out::of_design(section, task, design);
    let rows = &design.cells.rows;
    let n = (rows.len(), task.participants.len() - rows.len());
    if let Some(why) = impossible(task, design) {
        return section.lacks(&design.dependent, why);
    }
    let failed = match &design.factors[..] {
        [(name, _)] => match repeated_measures(rows) {
            Ok(anova) => {
                add_effect(table, design, name, n, &anova.effect);
                None
            }
            Err(error) => Some(error),
        },
        [(a, _), (b, seconds), ..] => match two_within(&design.cells.by_two(seconds.len())) {
            Ok(anova) => {
                add_effect(table, design, a, n, &anova.a);
                add_effect(table, design, b, n, &anova.b);
                add_effect(table, design, &format!("{a} × {b}"), n, &anova.interaction);
                None
            }
            Err(error) => Some(error),
        },
        [] => None,
    };
    if let Some(error) = failed {
        section.lacks(&design.dependent, error);
    }
}

/// Why a design has no analysis of variance, in the words of an experiment.
pub fn impossible(task: &Task, design: &Design) -> Option<String> {
    if let Some((factor, levels)) = design.factors.iter().find(|(_, levels)| levels.len() < 2) {
        return Some(format!(
            "{factor} has {} level(s) with data; two or more are needed",
            levels.len()
        ));
    }
    (design.cells.rows.len() < 2).then(|| {
        format!(
            "{} participant(s) with data in each of the {} cells, {} without; two or more are needed",
            design.cells.rows.len(),
            design.cells.levels.len(),
            task.participants.len() - design.cells.rows.len()
        )
    })
}

/// The participants of each part, if each did one part only.
fn groups(task: &Task, design: &Design) -> Option<Vec<Group>> {
    let [(_, parts), (_, levels)] = &design.factors[..] else {
        return None;
    };
    let done = |participant: usize| {
        let of = task.trials().filter(|(one, _)| *one == participant);
        distinct(of.map(|(_, trial)| trial.record.part.clone()))
    };
    let participants: Vec<_> = (0..task.participants.len()).map(|one| (one, done(one))).collect();
    if parts.len() < 2 || participants.iter().any(|(_, parts)| parts.len() > 1) {
        return None;
    }
    let group = |(part, name): (usize, &String)| -> Group {
        let members = participants.iter().filter(|(_, done)| done.first() == Some(name));
        let rows = members.filter_map(|(participant, _)| {
            let cells = design.cells.partial.iter().find(|(one, _)| one == participant)?;
            let own = cells.1.get(part * levels.len()..(part + 1) * levels.len())?;
            Some((*participant, own.iter().copied().collect::<Option<Vec<f64>>>()?))
        });
        rows.collect()
    };
    Some(parts.iter().enumerate().map(group).collect())
}

/// The participants of a part who have all its cells, and their cells.
type Group = Vec<(usize, Vec<f64>)>;

fn between(
    task: &Task,
    design: &Design,
    groups: &[Group],
    table: &mut Table,
    section: &mut Section,
) {
    left_out::levels(section, design);
    let members: Vec<usize> =
        groups.iter().flatten().map(|(participant, _)| *participant).collect();
    let others = (0..task.participants.len()).filter(|one| !members.contains(one));
    let others: Vec<_> = others.map(|one| &*task.participants[one].code).collect();
    if !others.is_empty() {
        section.warn([format!(
            "{}: {} left out: no data in some cells of their part.",
            design.dependent,
            others.join(", ")
        )]);
    }
    let (n, left_out) = (members.len(), others.len());
    let groups: Vec<Vec<Vec<f64>>> =
        groups.iter().map(|group| group.iter().map(|(_, cells)| cells.clone()).collect()).collect();
    let [(a, _), (b, _)] = &design.factors[..] else {
        return;
    };
    match split_plot_of(&groups) {
        Ok(anova) => {
            let n = (n, left_out);
            add_effect(table, design, &format!("{a} (between participants)"), n, &anova.between);
            add_effect(table, design, b, n, &anova.within);
            add_effect(table, design, &format!("{a} × {b}"), n, &anova.interaction);
        }
        Err(error) => section.lacks(&design.dependent, error),
    }
}

fn contrast_table() -> Table {
    Table::new(
        "contrasts",
        "Planned contrasts, each against its own variation over the participants; p is not corrected, beside it times the \
         number of contrasts (Bonferroni)",
        [
            words("dependent variable"),
            words("contrast"),
            numbers("difference", "", 3),
            numbers("F", "", 3),
            numbers("df error", "", 0),
            probabilities("p"),
            probabilities("p (Bonferroni)"),
        ],
    )
}

fn contrasts_of(task: &Task, design: &Design, table: &mut Table, section: &mut Section) {
    if design.contrast == Contrast::None || impossible(task, design).is_some() {
        return;
    }
    let Some(Marginal { levels, rows, .. }) = design.marginal(0) else {
        return;
    };
    let count = levels.len() as f64;
    for (index, level) in levels.iter().enumerate() {
        let is_own = |other: usize| f64::from(u8::from(other == index));
        let (weights, name): (Vec<f64>, _) = match design.contrast {
            Contrast::First if index == 0 => continue,
            Contrast::First => (
                (0..levels.len()).map(|i| is_own(i) - f64::from(u8::from(i == 0))).collect(),
                format!("{level} less {}", levels[0]),
            ),
            _ => (
                (0..levels.len()).map(|i| is_own(i) - 1.0 / count).collect(),
                format!("{level} less the mean of all"),
            ),
        };
        let contrasts = if design.contrast == Contrast::First { count - 1.0 } else { count };
        match contrast_within(&rows, &weights) {
            Ok(contrast) => table.row(cells![
                design.dependent.clone(),
                name,
                contrast.estimate,
                contrast.f,
                contrast.error_df,
                contrast.p,
                (contrast.p * contrasts).min(1.0)
            ]),
            Err(error) => section.lacks(&format!("{}, {name}", design.dependent), error),
        }
    }
}
