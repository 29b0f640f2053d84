//! `thermal-lab analyse` of data sets with copied, damaged and mixed sessions.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

use crate::folder::with_session;
use crate::program::{line, run};

/// A data set of these participants in a folder of the test, and where to write its analysis.
fn recorded(name: &str, participants: &[&str]) -> (PathBuf, PathBuf) {
    let (folder, session) = with_session(name);
    let data = folder.join("data");
    for participant in participants {
        let line = line(&session, &data);
        let done = run(&line.replace("--participant 01", &format!("--participant {participant}")));
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    }
    (data, folder.join("page"))
}

fn analyse(data: &Path, page: &Path, option: &str) -> Output {
    run(&format!("analyse {} --out {} --json{option}", data.display(), page.display()))
}

/// The analysis, and what was written to standard error.
fn analysed(data: &Path, page: &Path, option: &str) -> (Value, String) {
    let output = analyse(data, page, option);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{stderr}");
    (serde_json::from_slice(&output.stdout).unwrap(), stderr)
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).unwrap();
        }
    }
}

#[test]
fn a_copied_participant_is_refused_with_status_2_and_the_names_of_both_folders() {
    let (data, page) = recorded("analyse-copied", &["01"]);
    let source = data.join("sourcedata");
    copy(&source.join("sub-01"), &source.join("sub-01 - Copy"));
    let refused = analyse(&data, &page, "");
    let stderr = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{stderr}");
    for folder in ["sub-01", "sub-01 - Copy"] {
        let path = source.join(folder).join("task-p5").display().to_string();
        assert!(stderr.contains(&path), "{path}: {stderr}");
    }
    assert!(!page.exists());
}

#[test]
fn a_damaged_log_is_named_and_the_other_participants_are_analysed() {
    let (data, page) = recorded("analyse-damaged", &["01", "02", "03"]);
    let log = |participant: &str| {
        data.join("sourcedata").join(format!("sub-{participant}")).join("task-p5/log.jsonl")
    };
    let text = fs::read_to_string(log("01")).unwrap();
    let damaged = text.replacen("\n{", "\n{{", 2);
    fs::write(log("01"), damaged).unwrap();
    fs::remove_file(log("03")).unwrap();
    let (json, stderr) = analysed(&data, &page, "");
    let named = [format!("{}:2: ", log("01").display()), format!("{}: ", log("03").display())];
    let html = fs::read_to_string(page.join("analysis.html")).unwrap();
    for (index, words) in named.iter().enumerate() {
        assert!(json["left_out"][index].as_str().unwrap().starts_with(words), "{json}");
        assert!(stderr.contains(words) && html.contains(words), "{stderr}");
    }
    assert_eq!(json["tasks"][0]["participants"], serde_json::json!(["02"]));
    // Where nothing is left, that is an error.
    fs::remove_file(log("02")).unwrap();
    let refused = analyse(&data, &page, "");
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains(&log("02").display().to_string()));
}

#[test]
fn simulated_participants_are_pooled_with_real_ones_only_if_asked_for() {
    let (data, page) = recorded("analyse-mixed", &["01", "02"]);
    let info = data.join("sourcedata/sub-02/task-p5/session.json");
    let text = fs::read_to_string(&info).unwrap();
    fs::write(&info, text.replace("\"is_simulated\": true", "\"is_simulated\": false")).unwrap();
    let participants = |option: &str| {
        let (json, _) = analysed(&data, &page, option);
        json["tasks"][0]["participants"].clone()
    };
    assert_eq!(participants(""), serde_json::json!(["02"]));
    let html = fs::read_to_string(page.join("analysis.html")).unwrap();
    assert!(html.contains("1 simulated participant(s) were left out (01)"));
    assert_eq!(participants(" --pool-simulated"), serde_json::json!(["01", "02"]));
}

/// Beside the tables of this analysis those of an earlier one would look like its results.
#[test]
fn tables_of_an_earlier_analysis_are_removed_and_nothing_of_others() {
    let (data, page) = recorded("analyse-again", &["01"]);
    analysed(&data, &page, "");
    let json = page.join("analysis.json");
    let text = fs::read_to_string(&json).unwrap();
    // As if the earlier analysis had been one of a data set with staircases; and a list that somebody has changed.
    let table = |name: &str| format!("\"name\": \"{name}\"");
    let text = text.replace(&table("trials"), &table("staircases"));
    fs::write(&json, text.replace(&table("measures"), &table("../../data/outside"))).unwrap();
    let outside = data.join("outside.csv");
    let notes = page.join("p5_notes.csv");
    let old = page.join("p5_staircases.csv");
    for file in [&outside, &notes, &old] {
        fs::write(file, "x").unwrap();
    }
    let (_, stderr) = analysed(&data, &page, "");
    assert!(stderr.contains(&format!("removed {}", old.display())), "{stderr}");
    assert!(!old.exists() && outside.exists() && notes.exists());
    assert!(page.join("p5_trials.csv").exists());
    fs::write(&json, "{}").unwrap();
    fs::write(&old, "x").unwrap();
    let (_, stderr) = analysed(&data, &page, "");
    assert!(stderr.contains("analysis.json: this is not an analysis; tables"), "{stderr}");
    assert!(old.exists());
}

/// They would change the title of a terminal, and write from right to left.
#[test]
fn control_characters_of_a_data_set_are_shown_by_their_numbers() {
    let (data, page) = recorded("analyse-controls", &["01", "02"]);
    let list =
        "participant_id\texcluded\texclusion_reason\nsub-02\tyes\tmoved \u{1b}]0;x\u{202e}\n";
    fs::write(data.join("participants.tsv"), list).unwrap();
    let (_, stderr) = analysed(&data, &page, "");
    let html = fs::read_to_string(page.join("analysis.html")).unwrap();
    for shown in [&stderr, &html] {
        assert!(shown.contains(r"moved \u{1b}]0;x\u{202e}"), "{stderr}");
        assert!(!shown.contains(['\u{1b}', '\u{202e}']));
    }
}
