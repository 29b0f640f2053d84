//! Falls of the skin's temperature.

use experiment_statistics::levene::levene as levene_of;
use experiment_statistics::standard_deviation;

use super::design::Design;
use super::left_out;
use crate::cells::{distinct, mean, means_of_participants, over_participants};
use crate::input::{Task, Trial, finite};
use crate::picture::{Intervals, Mark};
use crate::report::{Section, Table, cells, numbers, probabilities, words};

/// Levene's p below which falls are transformed.
const ALPHA: f64 = 0.05;

/// The fall of a contact.
pub struct Fall {
    pub participant: usize,
    pub group: Group,
    pub fall_k: f64,
    pub skin_c: Option<f64>,
    pub room_c: Option<f64>,
}

/// What is compared: a material in a part of the session, as a sample or simulated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// The part, and the mode where a part has both.
    pub part: String,
    pub material: String,
}

/// The falls of all contacts.
pub fn all(task: &Task) -> Vec<Fall> {
    let both = parts_with_both_modes(task);
    let mut falls = Vec::new();
    for (participant, trial) in task.trials() {
        for stimulus in trial.stimuli() {
            let Some(station) = trial.station(stimulus.station) else {
                continue;
            };
            let Some(fall_k) = station.skin_fall_k.and_then(finite) else {
                continue;
            };
            falls.push(Fall {
                participant,
                group: group(&trial.record.part, &stimulus, &both),
                fall_k,
                skin_c: station.skin_before_c.and_then(finite),
                room_c: trial.record.room_c.and_then(finite),
            });
        }
    }
    falls
}

/// Participants of the contacts of a finger with a skin thermistor that have no fall, one for each.
fn without_fall(task: &Task) -> Vec<usize> {
    let mut participants = Vec::new();
    for (participant, trial) in task.trials() {
        for stimulus in trial.stimuli() {
            let is_measured = trial.skin_sensors.get(stimulus.station).copied().flatten().is_some();
            let station = trial.station(stimulus.station);
            if is_measured && station.and_then(|station| station.skin_fall_k).is_none() {
                participants.push(participant);
            }
        }
    }
    participants
}

/// What was presented, as the groups of falls, whether a fall was measured or not.
fn presented(task: &Task) -> Vec<Group> {
    let both = parts_with_both_modes(task);
    let groups = task.trials().flat_map(|(_, trial)| {
        trial
            .stimuli()
            .map(|stimulus| group(&trial.record.part, &stimulus, &both))
            .collect::<Vec<_>>()
    });
    distinct(groups)
}

fn has_fall(trial: &Trial) -> bool {
    trial.record.stations.iter().any(|station| station.skin_fall_k.is_some())
}

/// Parts in which there are samples and simulated materials.
pub fn parts_with_both_modes(task: &Task) -> Vec<String> {
    let has = |part: &str, is_simulated: bool| {
        let mut of_part = task.trials().filter(|(_, trial)| trial.record.part == part);
        of_part
            .any(|(_, trial)| trial.stimuli().any(|stimulus| stimulus.is_simulated == is_simulated))
    };
    let parts = task.parts().into_iter();
    parts.filter(|part| has(part, true) && has(part, false)).map(str::to_owned).collect()
}

/// The group of a stimulus.
pub fn group(part: &str, stimulus: &crate::input::Stimulus<'_>, both: &[String]) -> Group {
    let mode = if stimulus.is_simulated { "simulated" } else { "real" };
    let has_both = both.iter().any(|one| one == part);
    Group {
        part: if has_both { format!("{part}, {mode}") } else { part.into() },
        material: stimulus.material.into(),
    }
}

/// Parts in the order of the session, and materials by falling contact coefficient.
pub fn levels(task: &Task, falls: &[Fall]) -> (Vec<String>, Vec<String>) {
    let parts = distinct(falls.iter().map(|fall| fall.group.part.clone()));
    let materials = task.sorted(falls.iter().map(|fall| fall.group.material.as_str()));
    (parts, materials.into_iter().map(str::to_owned).collect())
}

const NO_FALLS: &str = "no contact that counts has a skin thermistor before and at the end (that of a display, or the key skin_sensor of a station)";

/// Falls by part and material.
pub fn falls(task: &Task) -> Section {
    let mut section = Section::new("falls", "Falls of the skin's temperature").note(
        "The fall is the mean of the skin thermistor over the last 0.5 s before the landing less that over the last 0.5 s of the \
         contact; on a sample, before the tone to touch in place of the landing. n counts contacts; SD is that of the contacts, SEM that of the participants' means.",
    );
    let what = "contacts of a finger with a skin thermistor, without a fall";
    left_out::count(&mut section, task, &without_fall(task), what);
    let falls = all(task);
    if falls.is_empty() {
        section.lacks("Falls", NO_FALLS);
        return section;
    }
    let measured =
        |part: &str| task.trials().any(|(_, trial)| trial.record.part == part && has_fall(trial));
    for part in task.parts() {
        if !measured(part) {
            section.lacks(part, NO_FALLS);
        }
    }
    let mut table = Table::new(
        "falls",
        "Falls by part and material; n counts contacts",
        [
            words("part"),
            words("material"),
            words("n"),
            numbers("mean fall", "K", 3),
            numbers("SD", "K", 3),
            numbers("least", "K", 3),
            numbers("largest", "K", 3),
            words("participants"),
            numbers("SEM", "K", 3),
            numbers("skin before", "°C", 2),
            numbers("room", "°C", 2),
        ],
    );
    let (parts, materials) = levels(task, &falls);
    let mut marks = Vec::new();
    for (series, part) in parts.iter().enumerate() {
        for material in &materials {
            let of = || {
                falls
                    .iter()
                    .filter(|fall| fall.group.part == *part && fall.group.material == *material)
            };
            let values: Vec<f64> = of().map(|fall| fall.fall_k).collect();
            let own: Vec<_> = of().map(|fall| (fall.participant, fall.fall_k)).collect();
            let (participants, over, sem) = over_participants(&own);
            if values.is_empty() {
                continue;
            }
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            table.row(cells![
                part.clone(),
                material.clone(),
                values.len(),
                mean(values.iter().copied()),
                standard_deviation(&values).ok(),
                least,
                largest,
                participants,
                sem,
                mean(of().filter_map(|fall| fall.skin_c)),
                mean(of().filter_map(|fall| fall.room_c))
            ]);
            marks.extend(over.map(|value| Mark {
                row: material.clone(),
                series,
                value,
                interval: sem.map(|sem| (value - sem, value + sem)),
            }));
        }
    }
    let names: Vec<&str> = parts.iter().map(String::as_str).collect();
    section.draw(
        "Mean falls over participants",
        picture("fall / K, with ± 1 SEM of the participants", &marks, &names),
    );
    section.add(table);
    section
}

/// A picture of means on an axis that contains 0 and all of them.
pub fn picture(axis: &str, marks: &[Mark], series: &[&str]) -> anyhow::Result<String> {
    let ends = marks.iter().flat_map(|mark| {
        let (from, to) = mark.interval.unwrap_or((mark.value, mark.value));
        [from, to, mark.value]
    });
    let (low, high) =
        ends.fold((0.0_f64, 0.0_f64), |(low, high), end| (low.min(end), high.max(end)));
    let step = nice_step(high - low);
    Intervals {
        axis,
        range: ((low / step).floor() * step, (high / step).ceil().max(1.0) * step),
        step,
        series,
        lines: Vec::new(),
    }
    .draw(marks)
}

/// A step of 1, 2 or 5 times a power of ten that divides a span into at most some ten parts.
fn nice_step(span: f64) -> f64 {
    if !(span.is_finite() && span > 0.0) {
        return 1.0;
    }
    let decade = 10f64.powf((span / 10.0).log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * decade >= span / 10.0);
    factor.unwrap_or(10.0) * decade
}

/// Participants' means of the groups.
fn groups(task: &Task, falls: &[Fall]) -> Vec<Vec<f64>> {
    let (parts, materials) = levels(task, falls);
    let mut groups = Vec::new();
    for part in &parts {
        for material in &materials {
            let of = falls
                .iter()
                .filter(|fall| fall.group.part == *part && fall.group.material == *material);
            let column = means_of_participants(of.map(|fall| (fall.participant, fall.fall_k)));
            if !column.is_empty() {
                groups.push(column);
            }
        }
    }
    groups
}

/// Whether the variances of the groups differ, so that the analyses of variance take the square root of the falls.
fn needs_root(task: &Task, falls: &[Fall]) -> bool {
    let groups = groups(task, falls);
    let differ = levene_of(&groups).is_ok_and(|test| test.effect.p < ALPHA);
    task.asks_for("levene") && differ && falls.iter().all(|fall| fall.fall_k >= 0.0)
}

/// Levene's test of the groups, before and after the transformation.
pub fn levene(task: &Task) -> Section {
    let mut section = Section::new("levene", "Equality of variances (Levene)").note(
        "Of the participants' mean falls in each group of part and material. Where p < .05 and no fall is negative, the analyses \
         of variance and Tukey's test use the square root of the falls, as section 4.4.2 of the thesis does.",
    );
    let falls = all(task);
    if falls.is_empty() {
        section.lacks("Levene's test", NO_FALLS);
        return section;
    }
    let groups = groups(task, &falls);
    if groups.iter().all(|group| group.len() < 3) {
        section.lacks(
            "Levene's test",
            "two means have equal distances from their own mean; three participants or more are needed",
        );
        return section;
    }
    let mut table = Table::new(
        "levene",
        "Levene's test; n counts participants' means",
        [
            words("of"),
            words("groups"),
            words("n"),
            numbers("F", "", 3),
            numbers("df", "", 0),
            numbers("df error", "", 0),
            probabilities("p"),
        ],
    );
    let roots: Vec<Vec<f64>> =
        groups.iter().map(|group| group.iter().map(|fall| fall.sqrt()).collect()).collect();
    let is_negative = falls.iter().any(|fall| fall.fall_k < 0.0);
    for (name, groups) in [("falls", &groups), ("square roots of the falls", &roots)] {
        if name != "falls" && is_negative {
            section.lacks(name, "some falls are negative, so they have none");
            continue;
        }
        match levene_of(groups) {
            Ok(test) => table.row(cells![
                name,
                groups.len(),
                groups.iter().map(Vec::len).sum::<usize>(),
                test.effect.f,
                test.effect.df,
                test.effect.error_df,
                test.effect.p
            ]),
            Err(error) => section.lacks(name, error),
        }
    }
    let root = needs_root(task, &falls);
    section.notes.push(
        if root {
            "The analyses use the square root."
        } else {
            "The analyses use the falls themselves."
        }
        .into(),
    );
    section.add(table);
    section
}

/// Falls as the analyses of variance use them, and their name.
fn transformed(task: &Task, falls: &[Fall]) -> (Vec<f64>, &'static str) {
    if needs_root(task, falls) {
        (falls.iter().map(|fall| fall.fall_k.sqrt()).collect(), "square root of fall / √K")
    } else {
        (falls.iter().map(|fall| fall.fall_k).collect(), "fall / K")
    }
}

pub fn designs(task: &Task) -> Vec<Design> {
    let falls = all(task);
    let (values, name) = transformed(task, &falls);
    let (parts, materials) = levels(task, &falls);
    let presented = presented(task);
    let of_part = |part: &String| {
        let own = falls.iter().zip(&values).filter(|(fall, _)| fall.group.part == *part);
        let own: Vec<_> = own
            .map(|(fall, value)| (fall.participant, fall.group.material.clone(), *value))
            .collect();
        let is_there = |material: &&String| own.iter().any(|(_, one, _)| one == *material);
        let levels: Vec<String> = materials.iter().filter(is_there).cloned().collect();
        let presented = presented.iter().filter(|group| group.part == *part);
        Design::one(format!("{name}, {part}"), "material", &levels, &own)
            .without("material", presented.map(|group| &group.material))
    };
    parts.iter().map(of_part).collect()
}

pub fn design_of_parts(task: &Task) -> Design {
    let falls = all(task);
    let (values, name) = transformed(task, &falls);
    let (parts, materials) = levels(task, &falls);
    let observations: Vec<_> = falls
        .iter()
        .zip(&values)
        .map(|(fall, value)| {
            let cell = (fall.group.part.clone(), fall.group.material.clone());
            (fall.participant, cell, *value)
        })
        .collect();
    let presented = presented(task);
    Design::two(name, ("part", &parts), ("material", &materials), &observations)
        .without("part", presented.iter().map(|group| &group.part))
        .without("material", presented.iter().map(|group| &group.material))
}
