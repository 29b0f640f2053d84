//! `events.tsv`: a row for each trial, and what its columns are.

use serde_json::{Map, Value, json};

use crate::record::{StationRecord, TrialRecord};
use crate::{Plan, Session};

/// What BIDS writes for a value that is not known.
pub(super) const UNKNOWN: &str = "n/a";

/// A column: name, description with unit, and the cell of a trial.
struct Column {
    name: String,
    description: String,
    unit: Option<&'static str>,
    cell: Box<dyn Fn(&TrialRecord) -> String>,
}

/// A text as a cell, which has no tabs and no line ends.
fn text(value: &str) -> String {
    let cell = value.replace(['\t', '\n', '\r'], " ");
    if cell.trim().is_empty() { UNKNOWN.into() } else { cell }
}

fn number(value: Option<f64>) -> String {
    let finite = value.filter(|value| value.is_finite());
    finite.map_or(UNKNOWN.into(), |value| {
        let rounded = format!("{value:.5}");
        let short = rounded.trim_end_matches('0').trim_end_matches('.');
        if short == "-0" { "0".into() } else { short.into() }
    })
}

fn flag(value: Option<bool>) -> String {
    value.map_or(UNKNOWN.into(), |value| u8::from(value).to_string())
}

fn column(
    name: impl Into<String>,
    unit: Option<&'static str>,
    description: impl Into<String>,
    cell: impl Fn(&TrialRecord) -> String + 'static,
) -> Column {
    Column { name: name.into(), description: description.into(), unit, cell: Box::new(cell) }
}

/// The columns of a session. The first two are those that BIDS asks for.
fn columns(session: &Session, plan: &Plan) -> Vec<Column> {
    let mut all = vec![
        column("onset", Some("s"), "Begin of the trial, from the begin of the session", |trial| {
            number(Some(trial.begin_s))
        }),
        column("duration", Some("s"), "Length of the trial", |trial| {
            number(Some(trial.end_s - trial.begin_s))
        }),
        column("trial", None, "Number of the trial in the plan, from 1", |trial| {
            trial.trial.to_string()
        }),
        column("attempt", None, "Number of the attempt at this trial, from 1", |trial| {
            trial.attempt.to_string()
        }),
        column("void", None, "Why the data of the trial do not count; n/a if they do", |trial| {
            text(trial.void.as_deref().unwrap_or_default())
        }),
        column("part", None, "Part of the session", |trial| text(&trial.part)),
        column("block", None, "Number of the block, from 1", |trial| trial.block.to_string()),
    ];
    for (index, factor) in plan.factors.iter().enumerate() {
        all.push(column(factor, None, format!("Level of the factor {factor}"), move |trial| {
            text(trial.levels.get(index).map_or("", String::as_str))
        }));
    }
    if !session.staircases.is_empty() {
        all.push(column("level_k", Some("K"), "Level of the staircase", |trial| {
            number(trial.staircase_level_k)
        }));
    }
    all.extend([
        column("answer", None, "Answer of the participant", |trial| {
            text(trial.answer.as_deref().unwrap_or_default())
        }),
        column("expected", None, "Correct answer; n/a if none is", |trial| {
            text(trial.expected.as_deref().unwrap_or_default())
        }),
        column("correct", None, "1 if the answer is the correct one, 0 if not", |trial| {
            flag(trial.is_correct)
        }),
        column(
            "response_time",
            Some("s"),
            "From the first landing, or the first tone, to the answer",
            |trial| number(trial.answer_s.zip(trial.land_s).map(|(answer, land)| answer - land)),
        ),
        column("reach_cue", Some("s"), "Tone to move above the stimuli", |trial| {
            number(trial.reach_cue_s)
        }),
        column("touch_cue", Some("s"), "Tone to touch, or of the first interval", |trial| {
            number(trial.touch_cue_s)
        }),
        column(
            "land",
            Some("s"),
            "First landing on a display, or the tone to touch where no display tells",
            |trial| number(trial.land_s),
        ),
        column("lift", Some("s"), "Last lift, or the end of the contact", |trial| {
            number(trial.lift_s)
        }),
        column("touches", None, "Landings on the display touched most often", |trial| {
            trial.touches.to_string()
        }),
        column("contact", Some("s"), "Time in contact with the display touched longest", |trial| {
            number(trial.contact_s)
        }),
        column("target_force", Some("N"), "Force to be followed", |trial| {
            number(trial.target_force_n)
        }),
        column("room", Some("degC"), "Room at the landing", |trial| number(trial.room_c)),
    ]);
    for (index, station) in session.stations.iter().enumerate() {
        all.extend(station_columns(index, &station.name));
    }
    all
}

/// The columns of a station.
fn station_columns(index: usize, station: &str) -> Vec<Column> {
    let measured = |name: &str,
                    unit: &'static str,
                    description: &str,
                    value: fn(&StationRecord) -> Option<f64>| {
        let description = format!("{description}, at the station {station}");
        column(format!("{station}_{name}"), Some(unit), description, move |trial| {
            number(trial.stations.get(index).and_then(value))
        })
    };
    vec![
        column(
            format!("{station}_presented"),
            None,
            format!("What the station {station} presented"),
            move |trial| text(trial.stations.get(index).map_or("", |station| &station.presented)),
        ),
        measured(
            "skin_before",
            "degC",
            "Skin thermistor before the landing (on a sample: before the tone to touch), mean of 0.5 s",
            |s| s.skin_before_c,
        ),
        measured(
            "skin_fall",
            "K",
            "Fall of the skin thermistor until the end of the contact, mean of 0.5 s",
            |s| s.skin_fall_k,
        ),
        measured("setpoint", "degC", "Set-point at the landing", |s| s.setpoint_c),
        measured("display", "degC", "Display thermistor at the landing", |s| s.display_c),
        measured("force_mean", "N", "Mean force from the landing to the lift", |s| s.force_mean_n),
        measured(
            "force_sd",
            "N",
            "Standard deviation of the force from the landing to the lift",
            |s| s.force_sd_n,
        ),
        measured("force_end_mean", "N", "Mean force of the last 2 s", |s| s.force_end_mean_n),
        measured("force_end_sd", "N", "Standard deviation of the force in the last 2 s", |s| {
            s.force_end_sd_n
        }),
        measured(
            "force_error_rms",
            "N",
            "RMS distance from the target force from 2 s after the landing on",
            |s| s.force_error_rms_n,
        ),
        measured(
            "force_settled",
            "s",
            "From the landing until the force stays within 10 % of its target",
            |s| s.force_settled_s,
        ),
        column(
            format!("{station}_limited"),
            None,
            format!("1 if the set-point at the station {station} was limited or not followed"),
            move |trial| flag(trial.stations.get(index).and_then(|station| station.is_limited)),
        ),
    ]
}

/// The table.
pub(super) fn table(session: &Session, plan: &Plan, records: &[TrialRecord]) -> String {
    let columns = columns(session, plan);
    let names: Vec<_> = columns.iter().map(|column| column.name.as_str()).collect();
    let mut table = names.join("\t") + "\n";
    for record in records {
        let cells: Vec<_> = columns.iter().map(|column| (column.cell)(record)).collect();
        table += &(cells.join("\t") + "\n");
    }
    table
}

/// What the columns are.
pub(super) fn sidecar(session: &Session, plan: &Plan) -> Value {
    let described = columns(session, plan).into_iter().map(|column| {
        let mut about = json!({ "Description": column.description });
        if let Some(unit) = column.unit {
            about["Units"] = unit.into();
        }
        (column.name, about)
    });
    let mut all: Map<String, Value> = described.collect();
    all.insert("TaskName".into(), session.title.clone().into());
    all.insert("TaskDescription".into(), session.cite.clone().into());
    all.insert("Instructions".into(), session.instruction.clone().into());
    let software = json!({
        "OperatingSystem": "n/a",
        "SoftwareName": "thermal-lab",
        "SoftwareVersion": env!("CARGO_PKG_VERSION"),
    });
    all.insert("StimulusPresentation".into(), software);
    Value::Object(all)
}
