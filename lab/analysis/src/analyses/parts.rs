//! Correlation between the parts of a session, such as real and simulated materials.

use experiment_statistics::correlation::pearson;

use super::{confusion, falls};
use crate::cells::mean;
use crate::input::Task;
use crate::report::{Section, Table, cells, numbers, probabilities, words};

/// Values of the cells of a part, by name.
type Values = Vec<((String, String), f64)>;

/// Correlation of the cells of each two parts.
pub fn pearson_between_parts(task: &Task) -> Section {
    let mut section = Section::new("pearson-between-parts", "Correlation between parts").note(
        "n counts cells: of the confusions those of what was presented and answered, as shares of what was presented; of the \
         falls the materials. The cells of a row of confusions sum to one and so are not independent; p takes them as if they \
         were.",
    );
    let mut table = Table::new(
        "pearson-between-parts",
        "Pearson's correlation of the cells of two parts",
        [
            words("of"),
            words("first"),
            words("second"),
            words("n"),
            numbers("r", "", 3),
            probabilities("p"),
        ],
    );
    let mut compared = 0;
    let mut compare = |what: &str, parts: &[(String, Values)]| {
        for (i, (first, one)) in parts.iter().enumerate() {
            for (second, other) in &parts[i + 1..] {
                let of_both = one.iter().filter_map(|(cell, x)| {
                    let y = other.iter().find(|(other, _)| other == cell)?.1;
                    Some((*x, y))
                });
                let (x, y): (Vec<f64>, Vec<f64>) = of_both.unzip();
                let alone = one.len() + other.len() - 2 * x.len();
                if alone > 0 {
                    section.warn([format!(
                        "Left out: {alone} cells of the {what} that only one of {first} and {second} has."
                    )]);
                }
                compared += 1;
                match pearson(&x, &y) {
                    Ok(found) => {
                        table.row(cells![
                            what,
                            first.clone(),
                            second.clone(),
                            found.pairs,
                            found.r,
                            found.p
                        ]);
                    }
                    Err(error) => section.lacks(&format!("{what}, {first} and {second}"), error),
                }
            }
        }
    };
    if task.asks_for("confusion") {
        let parts = task.parts().into_iter();
        let values: Vec<_> =
            parts.map(|part| (part.to_owned(), confusion::proportions(task, part))).collect();
        compare("confusions", &values);
    }
    if task.asks_for("falls") {
        let all = falls::all(task);
        let (parts, materials) = falls::levels(task, &all);
        let values = parts.iter().map(|part| {
            let of = |material: &String| {
                let own = all
                    .iter()
                    .filter(|fall| fall.group.part == *part && fall.group.material == *material);
                let fall_k = mean(own.map(|fall| fall.fall_k))?;
                Some(((material.clone(), String::new()), fall_k))
            };
            (part.clone(), materials.iter().filter_map(of).collect())
        });
        compare("falls", &values.collect::<Vec<_>>());
    }
    if compared == 0 {
        section.lacks("Correlation", "two parts with confusions or falls are needed");
    }
    section.add(table);
    section
}
