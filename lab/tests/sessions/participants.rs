//! Codes that look alike, and participants who are renamed or excluded.

use std::fs;
#[cfg(unix)]
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Output;

#[cfg(unix)]
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use serde_json::Value;

use crate::folder::{contents, with_session};
use crate::program::{line, run};

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[track_caller]
fn succeeds(line: &str) -> Output {
    let output = run(line);
    assert!(output.status.success(), "{line}: {}", stderr(&output));
    output
}

#[track_caller]
fn is_refused(line: &str, words: &str) {
    let output = run(line);
    assert_eq!(output.status.code(), Some(2), "{line}: {}", stderr(&output));
    assert!(stderr(&output).contains(words), "{line}: {}", stderr(&output));
}

/// The line of a simulated session of a participant.
fn of(session: &Path, data: &Path, participant: &str) -> String {
    line(session, data).replace("--participant 01", &format!("--participant {participant}"))
}

#[test]
fn a_code_that_looks_like_one_with_data_is_refused_unless_it_is_said_to_be_of_a_new_person() {
    let (folder, session) = with_session("alike");
    let data = folder.join("data");
    succeeds(&of(&session, &data, "1"));
    let before = contents(&data);
    for code in ["01", "O1"] {
        let words = format!("there are data of participant 1; {code} looks alike. The same person");
        is_refused(&of(&session, &data, code), &words);
    }
    assert_eq!(contents(&data), before);
    succeeds(&(of(&session, &data, "01") + " --new-person"));
    succeeds(&of(&session, &data, "2"));
    let renamed = format!("rename 2 O1 --data {}", data.display());
    is_refused(&renamed, "there are data of participant 01; of 1; O1 looks alike");
    // The code that a participant had before is that of this participant.
    succeeds(&format!("rename 2 7 --data {}", data.display()));
    is_refused(&of(&session, &data, "2"), "there are data of participant 7, whose code was 2");
    // Who has data already is not asked once more: the refusal is another one.
    is_refused(&of(&session, &data, "01"), "this participant has done this task");
}

/// Answers the question whether this is a new person, at a terminal; returns the exit status and what the terminal showed.
#[cfg(unix)]
fn answered(line: &str, answers: &str) -> (Option<i32>, String) {
    use std::io::{Read, Write};
    let end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
    grantpt(&end).unwrap();
    unlockpt(&end).unwrap();
    let name = ptsname(&end, Vec::new()).unwrap();
    let terminal = File::options().read(true).write(true).open(name.to_str().unwrap()).unwrap();
    let mut command = crate::program::thermal_lab(line);
    command.stdin(terminal.try_clone().unwrap()).stderr(terminal);
    let mut screen = File::from(end);
    screen.write_all(answers.as_bytes()).unwrap();
    let mut child = command.spawn().unwrap();
    // The command holds the terminal, which ends when the program does.
    drop(command);
    let mut shown = Vec::new();
    let _ended = screen.read_to_end(&mut shown);
    (child.wait().unwrap().code(), String::from_utf8_lossy(&shown).into_owned())
}

#[cfg(unix)]
#[test]
fn whether_a_code_is_of_a_new_person_is_asked_at_a_terminal() {
    let (folder, session) = with_session("alike-asked");
    let data = folder.join("data");
    succeeds(&of(&session, &data, "1"));
    let line = of(&session, &data, "01");
    let question = "there are data of participant 1; 01 looks alike. Is this a new person? [y/n]";
    let (status, shown) = answered(&line, "maybe\nn\n");
    assert_eq!((status, shown.matches(question).count()), (Some(2), 2), "{shown}");
    assert!(!data.join("sourcedata/sub-01").exists());
    let (status, shown) = answered(&line, "y\n");
    assert_eq!((status, shown.matches(question).count()), (Some(0), 1), "{shown}");
    assert!(data.join("sub-01").exists());
}

/// The data set of an interrupted session of participant 01: its first three trials are recorded.
fn interrupted(folder: &Path, session: &Path) -> PathBuf {
    let data = folder.join("interrupted");
    succeeds(&line(session, &data));
    let log = data.join("sourcedata/sub-01/task-p5/log.jsonl");
    let text = fs::read_to_string(&log).unwrap();
    let mut left = 3;
    let until_third = text.split_inclusive('\n').take_while(|line| {
        let goes_on = left > 0;
        left -= usize::from(line.contains("telemetry_bytes"));
        goes_on
    });
    fs::write(&log, until_third.collect::<String>()).unwrap();
    data
}

#[test]
fn a_renamed_participant_goes_on_with_resume_and_is_analysed_as_if_nothing_had_happened() {
    let (folder, session) = with_session("renamed");
    let whole = folder.join("whole");
    succeeds(&line(&session, &whole));
    let data = interrupted(&folder, &session);
    let renamed = succeeds(&format!("rename 01 07 --data {}", data.display()));
    let said = String::from_utf8(renamed.stdout).unwrap();
    assert_eq!(said, "participant 01 is 07 now, in 1 session(s)\n");
    succeeds(&(of(&session, &data, "07") + " --resume"));
    let (whole, renamed) = (contents(&whole), contents(&data));
    let description = Path::new("sourcedata/sub-07/task-p5/session.json");
    for (name, bytes) in &renamed {
        let old = PathBuf::from(name.to_str().unwrap().replace("sub-07", "sub-01"));
        if name != description && name != Path::new("participants.tsv") {
            assert!(bytes == &whole[&old], "{} differs", name.display());
        }
    }
    assert_eq!(renamed.len(), whole.len());
    let info: Value = serde_json::from_slice(&renamed[description]).unwrap();
    assert_eq!(info["participant"], "07");
    assert_eq!(
        (&info["renamed"][0]["from"], &info["renamed"][0]["to"]),
        (&"01".into(), &"07".into())
    );
    assert!(info["renamed"][0]["time"].as_str().unwrap().ends_with('Z'));
    let page = folder.join("page");
    let analysed = succeeds(&format!("analyse {} --out {} --json", data.display(), page.display()));
    let json: Value = serde_json::from_slice(&analysed.stdout).unwrap();
    assert_eq!(json["tasks"][0]["participants"], serde_json::json!(["07"]));
    assert_eq!(json["left_out"], serde_json::json!([]));
    is_refused(&format!("rename 01 08 --data {}", data.display()), "there are data of 07");
}

#[test]
fn an_excluded_participant_is_left_out_by_name_and_reason() {
    let (folder, session) = with_session("excluded");
    let [data, page] = ["data", "page"].map(|name| folder.join(name));
    for code in ["01", "02"] {
        succeeds(&of(&session, &data, code));
    }
    let exclude = |code: &str, reason: &str| {
        let mut command =
            crate::program::thermal_lab(&format!("exclude {code} --data {}", data.display()));
        command.args(["--reason", reason]).output().unwrap()
    };
    assert_eq!(exclude("03", "ill").status.code(), Some(2));
    assert!(exclude("02", "felt unwell").status.success());
    let analyse = format!("analyse {} --out {} --json", data.display(), page.display());
    let analysed = succeeds(&analyse);
    let json: Value = serde_json::from_slice(&analysed.stdout).unwrap();
    assert_eq!(json["tasks"][0]["participants"], serde_json::json!(["01"]));
    let sentence = json["left_out"][0].as_str().unwrap();
    assert!(sentence.starts_with("participant 02: excluded at 20"), "{sentence}");
    assert!(sentence.ends_with("Z: felt unwell"), "{sentence}");
    assert!(stderr(&analysed).contains(sentence));
    assert!(fs::read_to_string(page.join("analysis.html")).unwrap().contains(sentence));
    // It can still be looked at, and if nobody is left, that is an error.
    succeeds(&format!("replay {} --participant 02 --headless --speed 10000", data.display()));
    assert!(exclude("01", "pressed too hard").status.success());
    is_refused(&analyse, "participant 01: excluded at 20");
}
