//! Magnitudes that participants give for each station.

use experiment_statistics::standard_deviation;

use super::design::Design;
use super::falls::picture;
use super::left_out;
use crate::cells::{distinct, mean, over_participants};
use crate::input::{Task, Trial, finite};
use crate::picture::Mark;
use crate::report::{Section, Table, cells, numbers, words};

/// The magnitudes of an answer, in the order of the stations; `None` unless there is a number for each.
fn magnitudes_of(task: &Task, trial: &Trial) -> Option<Vec<f64>> {
    let numbers = trial
        .record
        .answer
        .as_ref()?
        .split(';')
        .map(|word| word.trim().parse().ok().and_then(finite));
    let numbers = numbers.collect::<Option<Vec<f64>>>()?;
    (numbers.len() == task.stations.len()).then_some(numbers)
}

/// Participant, condition, station and magnitude.
fn all(task: &Task) -> Vec<(usize, String, &str, f64)> {
    let of = task.trials().filter_map(|(participant, trial)| {
        let condition = trial.condition(&[]);
        let numbers = magnitudes_of(task, trial)?.into_iter().zip(&task.stations);
        Some(numbers.map(move |(number, station)| {
            (participant, condition.clone(), station.as_str(), number)
        }))
    });
    of.flatten().collect()
}

fn conditions(all: &[(usize, String, &str, f64)]) -> Vec<String> {
    let mut conditions = distinct(all.iter().map(|(_, condition, ..)| condition.clone()));
    conditions.sort_by(|one, other| {
        natural(one).partial_cmp(&natural(other)).unwrap_or(std::cmp::Ordering::Equal)
    });
    conditions
}

/// Words and numbers of a text, so that -8 comes before -2 and 10 after 9.
fn natural(text: &str) -> Vec<(String, f64)> {
    text.split(' ')
        .map(|word| match word.trim_end_matches(',').parse::<f64>() {
            Ok(number) if number.is_finite() => (String::new(), number),
            _ => (word.into(), 0.0),
        })
        .collect()
}

/// Mean magnitude by condition and station.
pub fn magnitudes(task: &Task) -> Section {
    let mut section = Section::new("magnitudes", "Magnitudes")
        .note("n counts answers; SD is that of the answers, SEM that of the participants' means.");
    let others = task.trials().filter(|(_, trial)| magnitudes_of(task, trial).is_none());
    let others: Vec<_> = others.map(|(participant, _)| participant).collect();
    let what = "trials without an answer with a number for each station";
    left_out::count(&mut section, task, &others, what);
    let all = all(task);
    if all.is_empty() {
        section.lacks(
            "Magnitudes",
            "no trial that counts has an answer with a number for each station",
        );
        return section;
    }
    let mut table = Table::new(
        "magnitudes",
        "Magnitudes by condition and station; n counts answers",
        [
            words("condition"),
            words("station"),
            words("n"),
            numbers("mean", "", 2),
            numbers("SD", "", 2),
            words("participants"),
            numbers("SEM", "", 2),
        ],
    );
    let mut marks = Vec::new();
    for condition in conditions(&all) {
        for (series, station) in task.stations.iter().enumerate() {
            let own = all.iter().filter(|(_, of, at, _)| *of == condition && at == station);
            let own: Vec<_> =
                own.map(|(participant, .., number)| (*participant, *number)).collect();
            let values: Vec<f64> = own.iter().map(|(_, number)| *number).collect();
            let (participants, over, sem) = over_participants(&own);
            table.row(cells![
                condition.clone(),
                station.clone(),
                values.len(),
                mean(values.iter().copied()),
                standard_deviation(&values).ok(),
                participants,
                sem
            ]);
            marks.extend(over.map(|value| Mark {
                row: condition.clone(),
                series,
                value,
                interval: sem.map(|sem| (value - sem, value + sem)),
            }));
        }
    }
    let stations: Vec<&str> = task.stations.iter().map(String::as_str).collect();
    section.draw(
        "Mean magnitudes",
        picture("magnitude, with ± 1 SEM of the participants", &marks, &stations),
    );
    section.add(table);
    section
}

pub fn design(task: &Task) -> Design {
    let all = all(task);
    let observations: Vec<_> = all
        .iter()
        .map(|(participant, condition, station, number)| {
            (*participant, (condition.clone(), (*station).to_owned()), *number)
        })
        .collect();
    Design::two(
        "magnitude",
        ("condition", &conditions(&all)),
        ("station", &task.stations),
        &observations,
    )
    .without("condition", task.trials().map(|(_, trial)| trial.condition(&[])))
}
