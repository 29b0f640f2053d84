//! `thermal-lab run`, `analyse` and `replay` as a user starts them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use thermal_session::dataset::Folder;

use crate::folder::{assert_equal, contents, with_ready, with_session};

pub fn thermal_lab(line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_thermal-lab"));
    command.args(line.split(' ')).stdin(Stdio::null());
    command
}

pub fn run(line: &str) -> Output {
    thermal_lab(line).output().unwrap()
}

/// The command line of a simulated session.
pub fn line(session: &Path, out: &Path) -> String {
    format!(
        "run {} --simulated --participant 01 --seed 1 --headless --out {}",
        session.display(),
        out.display()
    )
}

fn stderr(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).unwrap()
}

#[test]
fn the_same_arguments_give_the_same_bytes_but_for_what_the_clock_says() {
    let (folder, session) = with_session("same");
    let [one, other] = ["one", "other"].map(|name| folder.join(name));
    for out in [&one, &other] {
        let done = run(&line(&session, out));
        assert!(done.status.success(), "{}", stderr(&done));
    }
    assert_equal(&one, &other);
    let another = folder.join("another");
    let done = run(&line(&session, &another).replace("--seed 1", "--seed 2"));
    assert!(done.status.success(), "{}", stderr(&done));
    assert_ne!(contents(&one), contents(&another));
}

#[test]
fn the_data_set_has_the_structure_of_bids() {
    let (folder, session) = with_session("bids");
    let out = folder.join("data");
    fs::create_dir(&out).unwrap();
    assert!(run(&line(&session, &out)).status.success());
    let files = contents(&out);
    let text = |name: &str| std::str::from_utf8(&files[Path::new(name)]).unwrap();
    let json = |name: &str| serde_json::from_str::<Value>(text(name)).unwrap();
    let description = json("dataset_description.json");
    assert!(description["Name"].is_string() && description["BIDSVersion"].is_string());
    assert_eq!(text("participants.tsv"), "participant_id\nsub-01\n");

    let events = text("sub-01/beh/sub-01_task-p5_events.tsv");
    let header: Vec<_> = events.lines().next().unwrap().split('\t').collect();
    assert_eq!(header[..2], ["onset", "duration"]);
    let about = json("sub-01/beh/sub-01_task-p5_events.json");
    for column in &header {
        assert!(about[column]["Description"].is_string(), "{column} has no description");
    }
    let rows: Vec<Vec<_>> = events.lines().skip(1).map(|row| row.split('\t').collect()).collect();
    assert_eq!(rows.len(), 8);
    let onset = |row: &Vec<&str>| row[0].parse::<f64>().unwrap();
    assert!(
        rows.iter().all(|row| row.len() == header.len() && row.iter().all(|cell| !cell.is_empty()))
    );
    assert!(rows.windows(2).all(|pair| onset(&pair[0]) < onset(&pair[1])));

    let physio = json("sub-01/beh/sub-01_task-p5_recording-finger0_physio.json");
    let columns = physio["Columns"].as_array().unwrap().len();
    assert_eq!(physio["SamplingFrequency"], 100.0);
    assert_eq!(physio["StartTime"], 0.0);
    assert_eq!(physio["TaskName"], about["TaskName"]);
    let packed = &files[Path::new("sub-01/beh/sub-01_task-p5_recording-finger0_physio.tsv.gz")];
    // RFC 1952: the time is in bytes 4 to 7.
    assert_eq!(packed[..2], [0x1f, 0x8b]);
    assert_eq!(packed[4..8], [0; 4]);
    let mut unpacked = String::new();
    std::io::Read::read_to_string(&mut flate2::read::GzDecoder::new(&packed[..]), &mut unpacked)
        .unwrap();
    let is_number = |cell: &str| cell == "n/a" || cell.parse::<f64>().is_ok();
    assert!(
        unpacked
            .lines()
            .all(|row| row.split('\t').count() == columns && row.split('\t').all(is_number))
    );
    // A row every 10 ms from the begin of the session to the end of the last trial.
    let end_s = onset(&rows[7]) + rows[7][1].parse::<f64>().unwrap();
    let length_s = unpacked.lines().count() as f64 / 100.0;
    assert!((length_s - end_s).abs() < 0.1, "{length_s} s of telemetry, {end_s} s of session");
}

/// The rows are counted anew from the telemetry. At 250 ms the ticks of the device are up to half an interval from those of the session.
#[test]
fn the_sidecar_of_a_recording_says_how_far_its_rows_are_from_the_telemetry() {
    let (folder, session) = with_session("time-error");
    let text = fs::read_to_string(&session).unwrap();
    for stream_ms in [10, 30, 250] {
        fs::write(&session, text.replace("stream_ms = 10", &format!("stream_ms = {stream_ms}")))
            .unwrap();
        let out = folder.join(format!("{stream_ms}"));
        assert!(run(&line(&session, &out)).status.success());
        let about = out.join("sub-01/beh/sub-01_task-p5_recording-finger0_physio.json");
        let about: Value = serde_json::from_slice(&fs::read(about).unwrap()).unwrap();
        let interval_s = 1e-3 * f64::from(stream_ms);
        assert_eq!(about["SamplingFrequency"], 1.0 / interval_s);
        assert_eq!(about["StartTime"], 0.0);
        assert!(about["TimeErrorDescription"].is_string());
        let said_s = about["TimeErrorMax"].as_f64().unwrap();
        let telemetry = Folder::new(&out, "01", "p5").source("telemetry.csv");
        let mut nearest = BTreeMap::new();
        for row in fs::read_to_string(telemetry).unwrap().lines().skip(1) {
            let t_s: f64 = row.split(',').next().unwrap().parse().unwrap();
            let number = (t_s / interval_s).round();
            nearest.entry(number as u64).or_insert((t_s - number * interval_s).abs());
        }
        let largest_s = nearest.into_values().fold(0.0, f64::max);
        assert!((said_s - largest_s).abs() < 1e-4, "{stream_ms}: {said_s} s, {largest_s} s");
        assert!(said_s <= interval_s / 2.0 + 1e-4, "{stream_ms}: {said_s} s");
        // The stream of each trial has its own phase.
        assert!(stream_ms < 250 || said_s > 0.01, "{stream_ms}: {said_s} s");
    }
}

/// A device on a line that is not there, a person who is refused, answers that nobody understands, nothing to go on with.
#[test]
fn a_session_that_is_refused_makes_no_folder() {
    let (folder, session) = with_session("no-folder");
    let out = folder.join("data");
    let simulated = line(&session, &out);
    let at = |target: &str| simulated.replace("--simulated", target);
    let unknown = folder.join("unknown.toml");
    let text = fs::read_to_string(&session).unwrap();
    let ask = "the colder material?";
    assert!(text.contains(ask));
    fs::write(&unknown, text.replace(ask, "the colder or warmer material?")).unwrap();
    let missing = folder.join("missing.toml");
    for (line, words) in [
        (at("--port /dev/no-such-port"), "/dev/no-such-port"),
        (at("--tcp 127.0.0.1:1"), "127.0.0.1:1"),
        (simulated.replace(" --simulated", ""), "which device?"),
        (simulated.replace("--participant 01", "--participant Anna"), "Anna"),
        (format!("{simulated} --resume"), "there is no session to resume"),
        (line(&unknown, &out), "the colder or warmer material?"),
        (line(&missing, &out), "missing.toml"),
    ] {
        let refused = run(&line);
        assert_eq!(refused.status.code(), Some(2), "{line}: {}", stderr(&refused));
        assert!(stderr(&refused).contains(words), "{line}: {}", stderr(&refused));
        assert!(!out.exists(), "{line}");
    }
}

/// Against what git and the device say.
#[test]
fn session_json_has_the_versions_of_program_and_firmware_and_the_commit() {
    let (folder, session) = with_session("versions");
    let out = folder.join("data");
    assert!(run(&line(&session, &out)).status.success());
    let file = Folder::new(&out, "01", "p5").source("session.json");
    let info: Value = serde_json::from_slice(&fs::read(file).unwrap()).unwrap();
    assert_eq!(info["program_version"], env!("CARGO_PKG_VERSION"));
    let head = Command::new("git").args(["rev-parse", "HEAD"]).output();
    match head.ok().filter(|head| head.status.success()) {
        Some(head) => {
            let commit = info["program_commit"].as_str().unwrap();
            let clean = commit.strip_suffix("-dirty").unwrap_or(commit);
            assert_eq!(clean, String::from_utf8(head.stdout).unwrap().trim());
        }
        None => assert!(info["program_commit"].is_null()),
    }
    let identity = run("info --simulated --json");
    let identity: Value = serde_json::from_slice(&identity.stdout).unwrap();
    assert_eq!(info["devices"][0]["identity"], identity["device"]);
}

#[test]
fn a_plan_is_printed_without_a_device() {
    let (_, session) = with_session("plan");
    let plan = run(&format!("run {} --participant 01 --plan", session.display()));
    assert!(plan.status.success());
    let text = String::from_utf8(plan.stdout).unwrap();
    let header = text.lines().next().unwrap();
    assert!(header.contains(",real,simulated,side,"), "{header}");
    assert_eq!(text.lines().count(), 1 + 8);
}

#[test]
fn a_finger_that_is_assumed_elsewhere_than_it_rests_is_warned_about_before_the_session() {
    let mean = [("assumed_finger = \"mean-on-pad\"", "assumed_finger = \"mean\"")];
    for (name, replaced, is_warned) in [("pad-mean", &mean[..], true), ("pad-on-pad", &[], false)] {
        let (_, session) = with_ready(name, "p5-real-and-simulated-contact-model", replaced);
        let plan = run(&format!("run {} --participant 01 --plan", session.display()));
        assert!(plan.status.success());
        let says = "short.toml: rest.place = \"pad\" contradicts device.assumed_finger = \"mean\"";
        assert_eq!(stderr(&plan).contains(says), is_warned, "{}", stderr(&plan));
    }
}

#[test]
fn wrong_arguments_are_answered_with_status_2() {
    let (folder, session) = with_session("wrong");
    let out = folder.join("data");
    let expect = |line: &str, status: i32, words: &str| {
        let output = run(line);
        assert_eq!(output.status.code(), Some(status), "{line}: {}", stderr(&output));
        assert!(stderr(&output).contains(words), "{line}: {}", stderr(&output));
    };
    let resume = line(&session, &out) + " --resume";
    expect(&resume, 2, "there is no session to resume");
    assert!(run(&line(&session, &out)).status.success());
    expect(&line(&session, &out), 2, "this participant has done this task");
    expect(&resume.replace("--seed 1", "--seed 2"), 2, "recorded with the seed 1; given is 2");
    expect(&line(&session, &out).replace("01", "Anna"), 2, "Anna");
    let text = fs::read_to_string(&session).unwrap();
    fs::write(&session, text.replace("repeat = 2", "repeat = 0")).unwrap();
    expect(&line(&session, &out), 2, "repeat = 0; allowed");
    expect(&format!("analyse {}", session.display()), 2, "short.toml");
}

#[test]
fn a_recorded_session_is_analysed_and_replayed() {
    let (folder, session) = with_session("analysed");
    let [data, page] = ["data", "page"].map(|name| folder.join(name));
    assert!(run(&line(&session, &data)).status.success());
    let analysed = run(&format!("analyse {} --json --out {}", data.display(), page.display()));
    assert!(analysed.status.success(), "{}", stderr(&analysed));
    let json: Value = serde_json::from_slice(&analysed.stdout).unwrap();
    assert_eq!(json["tasks"][0]["task"], "p5");
    assert!(fs::read_to_string(page.join("analysis.html")).unwrap().contains("<svg"));
    let replayed = run(&format!("replay {} --headless --speed 10000", data.display()));
    assert!(replayed.status.success(), "{}", stderr(&replayed));
    assert_eq!(stderr(&replayed).matches(" of 8, block").count(), 8);
}
