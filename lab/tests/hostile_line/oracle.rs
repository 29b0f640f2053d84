//! What a client may not do, whatever its line does.

use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::clients::{Client, Outcome};
use crate::kinds::{Kind, Signal};

/// Longest time from a signal to the end of a client (docs/lab.md).
const ENDS_WITHIN: Duration = Duration::from_secs(8);
/// Longest time that a client takes longer than on a line without a defect: the timeouts of a few answers.
const LONGER: Duration = Duration::from_secs(45);
/// Words by which a client calls for the emergency stop: the command, and the package for Python.
const ALARMS: [&str; 2] = ["MAY STILL BE ON", "may still be driven"];
/// Words by which it says that the bridge is off.
const OFF: [&str; 3] =
    ["thermal-lab: the bridge is off", "bridge off", "bridge off; the data set is being written"];

/// What was wrong; empty if nothing.
pub fn defects(client: &Client, kind: &Kind, outcome: &Outcome) -> Vec<String> {
    let mut found = Vec::new();
    let mut check = |is_wrong: bool, what: String| {
        if is_wrong {
            found.push(what);
        }
    };
    let is_python = client.is_python();
    let is_alarmed = ALARMS.iter().any(|words| outcome.said.contains(words));
    let says_off = outcome.said.lines().any(|line| OFF.contains(&line));
    // A process that a signal ends before it has sent anything has done nothing. Python leaves these signals to the program, and the
    // switching off to the device.
    let may_be_ended = outcome.client_lines == 0
        || kind.signal == Some(Signal::Kill)
        || is_python
            && (matches!(kind.signal, Some(Signal::Term | Signal::Hup))
                || !outcome.is_driven
                || kind.is_cut);
    let was_ended = outcome.code.is_none() && !outcome.was_killed;

    check(outcome.was_killed, "does not end".into());
    check(outcome.said.contains("panicked"), "panic".into());
    check(was_ended && !may_be_ended, "ended by the signal".into());
    let stop =
        if kind.signal == Some(Signal::Stop) { Duration::from_secs(4) } else { Duration::ZERO };
    let longest = if outcome.is_interrupted { ENDS_WITHIN } else { client.takes + LONGER + stop };
    let s = outcome.ended_after.as_secs_f64();
    check(!outcome.was_killed && outcome.ended_after > longest, format!("ends after {s:.1} s"));
    check(outcome.peak_mb > client.memory_max_mb, format!("{:.0} MB", outcome.peak_mb));
    if let Some(code) = outcome.code {
        check(!matches!(code, 0..=2), format!("exit {code}"));
        check(is_alarmed && code != 1 && !is_python, format!("alarm with exit {code}"));
    }

    // Of the bridge.
    let driven = &outcome.state;
    check(driven == "no answer", "the device does not answer the test".into());
    check(is_alarmed && !outcome.is_driven && !kind.hides_the_bridge, "false alarm".into());
    check(says_off && outcome.is_driven && !is_alarmed, format!("says off, is {driven}"));
    // It may have done its work when the signal came.
    let is_done = client.leaves_driven && outcome.code == Some(0);
    let is_left =
        (client.leaves_driven || client.is_armed_before) && (!outcome.is_interrupted || is_done);
    let is_told = is_alarmed || is_left;
    let is_over = kind.is_cut || was_ended || outcome.was_killed;
    check(outcome.is_driven && !is_told && !is_over, format!("silent, and {driven}"));
    let has_no_guard = !client.is_guarded && !client.is_armed_before;
    check(
        outcome.is_driven && !is_told && kind.is_cut && has_no_guard && !was_ended,
        format!("silent without a guard, and {driven}"),
    );
    check(
        outcome.is_driven_later && !is_told && is_over && client.is_guarded,
        format!("no guard, and {driven}"),
    );
    check(
        client.name == "play --arm"
            && outcome.code == Some(0)
            && !outcome.is_driven
            && !outcome.is_interrupted,
        format!("says that it plays, is {driven}"),
    );
    let says_state = outcome.said.lines().find_map(|line| line.strip_prefix("  state  "));
    let says_other =
        says_state.is_some_and(|said| said.trim() != driven && !outcome.is_interrupted);
    check(
        client.name == "info" && says_other,
        format!("says {}, is {driven}", says_state.unwrap_or("").trim()),
    );
    let watches = client.name.starts_with("monitor");
    let is_told = outcome.said.contains("no telemetry for");
    check(kind.hides_telemetry && watches && !is_told, "silent about silence".into());

    // Of what reaches the terminal, and of the files.
    // Without a player of sounds a session rings the bell of the terminal.
    let is_control = |character: char| {
        character.is_control() && !matches!(character, '\n' | '\r' | '\t' | '\u{7}')
    };
    check(outcome.said.contains(is_control), "control characters".into());
    let log = fs::read_to_string(outcome.folder.join("log.csv")).unwrap_or_default();
    check(has_ticks_of_the_future(&log), "a tick after its line".into());
    wrong_files(&outcome.folder, was_ended, &mut found);
    found
}

/// Whether a row of a log has the arrival of a line, its first column, before the tick that it names, its second.
fn has_ticks_of_the_future(log: &str) -> bool {
    let times = |row: &str| -> Option<(f64, f64)> {
        let mut cells = row.split(',').map(str::parse);
        Some((cells.next()?.ok()?, cells.next()?.ok()?))
    };
    log.lines().filter_map(times).any(|(received_s, tick_at_s)| tick_at_s > received_s)
}

/// Files that are not whole. A process that was killed leaves what it was writing.
fn wrong_files(folder: &Path, was_killed: bool, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            wrong_files(&path, was_killed, found);
            continue;
        }
        let text = fs::read_to_string(&path).unwrap_or_default();
        let is_whole = match path.extension().and_then(|end| end.to_str()) {
            _ if was_killed => true,
            Some("part") => false,
            Some("json") => serde_json::from_str::<serde_json::Value>(&text).is_ok(),
            Some("jsonl") => {
                text.lines().all(|line| serde_json::from_str::<serde_json::Value>(line).is_ok())
            }
            Some("csv") => {
                csv::Reader::from_reader(text.as_bytes()).records().all(|row| row.is_ok())
            }
            _ => true,
        };
        if !is_whole {
            found.push(format!("{name} is not whole"));
        }
    }
}
