//! What every analysis has: participants, trials, void trials and why, response times, measures of the contacts.

use std::collections::BTreeSet;

use experiment_statistics::standard_deviation;
use thermal_session::record::{StationRecord, TrialRecord};

use crate::cells::{distinct, grouped, mean};
use crate::input::{Participant, Task, Trial, finite};
use crate::report::{Cell, Section, Table, cells, numbers, words};

/// Participants, their trials, and why trials were void.
pub fn participants(task: &Task) -> Section {
    let mut section = Section::new("participants", "Participants and trials").note(
        "Planned: trials of the plan; a staircase may end before its last one. Counted: trials that are not void and are analysed. \
         Void trials are repeated at the end of their block, so attempts may exceed the plan.",
    );
    section.notes.extend(task.differs.clone());
    section.warn(task.mixed.clone());
    section.warn(task.versions.clone());
    let mut table = Table::new(
        "participants",
        "Trials by participant",
        [
            words("participant"),
            words("simulated"),
            words("planned"),
            words("attempts"),
            words("void"),
            words("counted"),
            words("without answer"),
            words("correct"),
            words("scored"),
            numbers("share correct", "%", 1),
            numbers("median response time", "s", 2),
            numbers("duration", "min", 1),
        ],
    );
    for participant in &task.participants {
        let trials = &participant.trials;
        let is_void = |record: &&TrialRecord| record.void.is_some();
        let scored: Vec<bool> = trials.iter().filter_map(|trial| trial.record.is_correct).collect();
        let correct = scored.iter().filter(|correct| **correct).count();
        let asked = task.question.is_some();
        let silent = trials.iter().filter(|trial| asked && trial.record.answer.is_none()).count();
        let begin_s = participant.records.first().map(|record| record.begin_s);
        let end_s = participant.records.last().map(|record| record.end_s);
        table.row(cells![
            participant.code.clone(),
            if participant.is_simulated { "yes" } else { "no" },
            participant.planned,
            participant.records.len(),
            participant.records.iter().filter(is_void).count(),
            trials.len(),
            silent,
            (!scored.is_empty()).then_some(correct),
            (!scored.is_empty()).then_some(scored.len()),
            (!scored.is_empty()).then(|| 100.0 * correct as f64 / scored.len() as f64),
            median(trials.iter().filter_map(Trial::response_s)),
            begin_s.zip(end_s).map(|(begin_s, end_s)| (end_s - begin_s) / 60.0)
        ]);
        if trials.len() < participant.planned && task.staircases.is_empty() {
            section.notes.push(format!(
                "{} has {} of {} trials: the session was interrupted or has not ended, or trials were given up. Everything below \
                 is of the trials that there are.",
                participant.code,
                trials.len(),
                participant.planned
            ));
        }
    }
    for participant in &task.participants {
        section.warn(only_void(participant));
        section.warn(participant.remarks.clone());
    }
    for (factor, level) in &task.planned_levels {
        let is_there = |one: &(String, String)| one.0 == *factor && one.1 == *level;
        if !task.trials().any(|(_, trial)| trial.levels.iter().any(is_there)) {
            section.warn([format!("No trial with {factor} {level} counts, so it is in no table.")]);
        }
    }
    section.add(table);
    section.add(voids(task));
    if task.participants.is_empty() {
        section.lacks("Trials", "there is no participant");
    }
    section
}

/// Trials all of whose attempts are void.
fn only_void(participant: &Participant) -> Option<String> {
    let counted = participant.trials.iter().map(|trial| trial.record.trial);
    let mut known: BTreeSet<u32> = counted.collect();
    let numbers = participant.records.iter().map(|record| record.trial);
    let void: Vec<_> =
        numbers.filter(|number| known.insert(*number)).map(|number| number.to_string()).collect();
    (!void.is_empty()).then(|| {
        let (code, void) = (&participant.code, void.join(", "));
        format!("Left out: trials of {code} of which each attempt was void ({void}).")
    })
}

/// Reasons of void trials, without their numbers, so that like ones count together.
fn voids(task: &Task) -> Table {
    let mut table = Table::new(
        "voids",
        "Void trials by reason; n counts attempts",
        [words("reason"), words("n"), words("participants"), words("for example")],
    );
    let records = || {
        let all = task.participants.iter();
        all.flat_map(|one| {
            one.records.iter().filter_map(|record| Some((&one.code, record.void.as_ref()?)))
        })
    };
    let kind = |reason: &str| -> String {
        let words = reason.split(' ').map(|word| match word.trim_end_matches(',').parse::<f64>() {
            Ok(_) => "…",
            Err(_) => word,
        });
        words.collect::<Vec<_>>().join(" ")
    };
    for (reason, own) in grouped(records().map(|record| (kind(record.1), record))) {
        let participants = distinct(own.iter().map(|(code, _)| *code)).len();
        let example = own.first().map(|(_, example)| (*example).clone()).unwrap_or_default();
        table.row(cells![reason, own.len(), participants, example]);
    }
    table
}

/// The value in the middle.
fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let (low, high) =
        (values.get(values.len().checked_sub(1)? / 2)?, values.get(values.len() / 2)?);
    Some((low + high) / 2.0)
}

/// A measure of a trial: name, unit, decimals, value.
type Measure = (&'static str, &'static str, usize, fn(&Trial) -> Option<f64>);

/// A measure of a contact.
type OfStation = (&'static str, &'static str, usize, fn(&StationRecord) -> Option<f64>);

const OF_TRIALS: [Measure; 4] = [
    ("response time", "s", 2, Trial::response_s),
    ("time in contact", "s", 2, |trial| trial.record.contact_s),
    ("touches", "", 1, |trial| (trial.record.touches > 0).then(|| f64::from(trial.record.touches))),
    ("room", "°C", 2, |trial| trial.record.room_c),
];

const OF_STATIONS: [OfStation; 6] = [
    ("skin before", "°C", 2, |station| station.skin_before_c),
    ("fall of skin", "K", 3, |station| station.skin_fall_k),
    ("set-point at landing", "°C", 2, |station| station.setpoint_c),
    ("display less set-point at landing", "K", 3, |station| {
        Some(station.display_c? - station.setpoint_c?)
    }),
    ("mean force", "N", 2, |station| station.force_mean_n),
    ("SD of force", "N", 2, |station| station.force_sd_n),
];

/// Response times and measures by part, and trials by trial.
pub fn measures(task: &Task) -> Section {
    let mut section = Section::new("measures", "Trials and measures").note(
        "The response time counts from the first landing, so where a finger rests on the display it contains both intervals. \
         n counts trials that count, or contacts with a display or a skin thermistor; SD is that over them, participants mixed. Limited: contacts in \
         which the set-point was limited or not followed at some time.",
    );
    let mut table = Table::new(
        "measures",
        "Measures by part; n counts trials or contacts",
        [
            words("part"),
            words("measure"),
            words("station"),
            words("unit"),
            words("n"),
            numbers("mean", "", 3),
            numbers("SD", "", 3),
            numbers("median", "", 3),
            numbers("least", "", 3),
            numbers("largest", "", 3),
        ],
    );
    for part in task.parts() {
        let own =
            || task.trials().map(|(_, trial)| trial).filter(|trial| trial.record.part == part);
        for (name, unit, _, value) in OF_TRIALS {
            add(&mut table, [part, name, "", unit], own().filter_map(value));
        }
        for (index, station) in task.stations.iter().enumerate() {
            let of_station = || own().filter_map(|trial| trial.station(index));
            for (name, unit, _, value) in OF_STATIONS {
                add(&mut table, [part, name, station, unit], of_station().filter_map(value));
            }
            let limited: Vec<bool> =
                of_station().filter_map(|station| station.is_limited).collect();
            if limited.iter().any(|limited| *limited) {
                section.notes.push(format!(
                    "{part}, {station}: {} of {} contacts were limited.",
                    limited.iter().filter(|limited| **limited).count(),
                    limited.len()
                ));
            }
        }
    }
    if table.rows.is_empty() {
        section.lacks("Measures", "no trial that counts has any");
    }
    section.add(table);
    section.add(trials(task));
    section
}

fn add(table: &mut Table, words: [&str; 4], values: impl Iterator<Item = f64>) {
    let values: Vec<f64> = values.filter_map(finite).collect();
    if values.is_empty() {
        return;
    }
    let mut row: Vec<Cell> = words.into_iter().map(Cell::from).collect();
    row.extend(cells![
        values.len(),
        mean(values.iter().copied()),
        standard_deviation(&values).ok(),
        median(values.iter().copied()),
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    ]);
    table.row(row);
}

/// A row for each attempt, void ones among them.
fn trials(task: &Task) -> Table {
    let mut heads = vec![
        words("participant"),
        words("trial"),
        words("attempt"),
        words("part"),
        words("block"),
        words("void"),
    ];
    heads.extend(task.factors.iter().map(words));
    heads.extend(task.stations.iter().map(|station| words(format!("{station} presents"))));
    heads.extend([words("answer"), words("expected"), words("correct"), numbers("level", "K", 4)]);
    heads.extend(OF_TRIALS.map(|(name, unit, decimals, _)| numbers(name, unit, decimals)));
    for station in &task.stations {
        heads.extend(
            OF_STATIONS.map(|(name, unit, decimals, _)| {
                numbers(format!("{station} {name}"), unit, decimals)
            }),
        );
    }
    let mut table = Table::new("trials", "Trial by trial, void ones among them", heads);
    for participant in &task.participants {
        for record in &participant.records {
            let mut row = cells![
                participant.code.clone(),
                record.trial,
                record.attempt,
                record.part.clone(),
                record.block,
                record.void.clone()
            ];
            row.extend(
                (0..task.factors.len())
                    .map(|factor| Cell::from(record.levels.get(factor).cloned())),
            );
            let station = |index: usize| record.stations.get(index);
            let stations = 0..task.stations.len();
            row.extend(
                stations.map(|index| {
                    Cell::from(station(index).map(|station| station.presented.clone()))
                }),
            );
            row.extend(cells![
                record.answer.clone(),
                record.expected.clone(),
                record.is_correct.map(|correct| if correct { "yes" } else { "no" }),
                record.staircase_level_k
            ]);
            let trial = Trial {
                record: record.clone(),
                levels: Vec::new(),
                staircase: None,
                presented: Vec::new(),
                skin_sensors: Vec::new(),
            };
            row.extend(OF_TRIALS.map(|(.., value)| Cell::from(value(&trial))));
            for index in 0..task.stations.len() {
                row.extend(
                    OF_STATIONS.map(|(.., value)| Cell::from(station(index).and_then(value))),
                );
            }
            table.row(row);
        }
    }
    table.folded()
}
