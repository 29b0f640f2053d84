//! Analysis of covariance: whether what else distinguishes the materials goes with the answers.

use experiment_statistics::ancova::{Group, ancova as analyse};
use thermal_thesis::published::youngs_modulus_gpa;

use super::design::Design;
use super::{confusion, left_out, pairs};
use crate::input::Task;
use crate::report::{Section, Table, cells, numbers, probabilities, words};

/// A property of a material.
type Property = fn(&Task, &str) -> Option<f64>;

/// Properties of the materials whose logarithm is a covariate.
const PROPERTIES: [(&str, Property); 3] = [
    ("roughness Rq", |task, material| Some(task.materials.get(material)?.surface.roughness_um)),
    ("Young's modulus", |_, material| youngs_modulus_gpa(material)),
    ("contact coefficient", Task::effusivity),
];

/// Covariates of what pairs and confusions have, one at a time.
pub fn ancova(task: &Task) -> Section {
    let mut section = Section::new("ancova", "Analysis of covariance")
        .note(
            "Per cent correct of each participant with each pair, or material, by participant and one covariate: y = m + b x, with \
             a mean m of each participant and the same slope b for all (each effect adjusted for the other). n counts cells.",
        )
        .note(
            "The covariate of a pair is the binary logarithm of the ratio of its materials' properties, the larger over the \
             smaller; of a single material it is that of its property. Roughnesses are those of the session's materials, Young's \
             moduli those of Tables 3-2 and 4-1 of the thesis; it does not say what its factor was.",
        )
        .note(
            "The properties of few materials go together, such as those of foam, so that a small p is no evidence of a cause.",
        );
    let mut table = Table::new(
        "ancova",
        "Covariates beside the participants; n counts participants times pairs or materials",
        [
            words("dependent variable"),
            words("covariate"),
            words("participants"),
            words("n"),
            numbers("slope", "% per doubling", 2),
            numbers("F", "", 3),
            numbers("df", "", 0),
            numbers("df error", "", 0),
            probabilities("p"),
            numbers("partial eta squared", "", 3),
            numbers("F of participants", "", 3),
            probabilities("p of participants"),
        ],
    );
    let mut designs = Vec::new();
    if task.asks_for("pairs") {
        designs.push(pairs::design(task));
    }
    if task.asks_for("confusion") {
        designs.extend(confusion::designs_of_materials(task));
    }
    for design in &designs {
        left_out::levels(&mut section, design);
        for (number, participant) in task.participants.iter().enumerate() {
            if !design.cells.participants.contains(&number) {
                let (what, code) = (&design.dependent, &participant.code);
                let why = left_out::missing_cells(design, number);
                section.warn([format!("{what}: {code} has {why}.")]);
            }
        }
        for (name, property) in PROPERTIES {
            covariate(task, design, (name, property), &mut table, &mut section);
        }
    }
    section.add(table);
    section
}

fn covariate(
    task: &Task,
    design: &Design,
    (name, property): (&str, Property),
    table: &mut Table,
    section: &mut Section,
) {
    let what = format!("{}, {name}", design.dependent);
    let levels = &design.cells.levels;
    let values: Option<Vec<f64>> =
        levels.iter().map(|level| doublings(task, level, property)).collect();
    let Some(values) = values else {
        return section.lacks(&what, "it is zero, or not known, of a material");
    };
    let groups = design.cells.partial.iter().map(|(_, cells)| {
        let there = values.iter().zip(cells).filter_map(|(x, y)| Some((*x, (*y)?)));
        let (covariate, y) = there.unzip();
        Group { covariate, y }
    });
    let groups: Vec<Group> = groups.filter(|group| !group.y.is_empty()).collect();
    match analyse(&groups) {
        Ok(found) => table.row(cells![
            design.dependent.clone(),
            name,
            groups.len(),
            groups.iter().map(|group| group.y.len()).sum::<usize>(),
            found.slope,
            found.covariate.f,
            found.covariate.df,
            found.covariate.error_df,
            found.covariate.p,
            found.covariate.partial_eta_squared,
            found.factor.f,
            found.factor.p
        ]),
        Err(error) => section.lacks(&what, error),
    }
}

/// Binary logarithm of the property of a material, or of the ratio of those of a pair, the larger over the smaller.
fn doublings(task: &Task, level: &str, property: Property) -> Option<f64> {
    let value = match level.split_once(pairs::BETWEEN) {
        Some((one, other)) => {
            let ratio = property(task, one)? / property(task, other)?;
            ratio.max(1.0 / ratio)
        }
        None => property(task, level)?,
    };
    Some(value.log2()).filter(|doublings| doublings.is_finite())
}
