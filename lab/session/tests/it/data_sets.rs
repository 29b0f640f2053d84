//! Data sets with files that were copied, renamed, damaged or changed after the recording.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use thermal_session::dataset::{DataSetError, Recorder, recorded_sessions};
use thermal_session::record::TrialRecord;
use thermal_session::{PlannedTrial, Session};

use crate::{plan, ready};

/// A data set in a new folder of the tests, with the first trials of these participants.
pub struct Recorded {
    root: PathBuf,
}

const TRIALS: usize = 6;

/// A trial of a participant who knows the correct answer, and says "left" where none is.
fn record(planned: &PlannedTrial) -> TrialRecord {
    let begin_s = 30.0 * f64::from(planned.number);
    let answer = planned.correct.clone().unwrap_or_else(|| "left".into());
    TrialRecord {
        trial: planned.number,
        attempt: 1,
        part: planned.part.clone(),
        block: planned.block,
        levels: planned.levels.clone(),
        begin_s,
        end_s: begin_s + 20.0,
        expected: planned.correct.clone(),
        is_correct: planned.correct.is_some().then_some(true),
        answer: Some(answer),
        ..TrialRecord::default()
    }
}

impl Recorded {
    pub fn new(name: &str, participants: &[&str]) -> Self {
        let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ignored = fs::remove_dir_all(&root);
        let session = ready("p1-discrimination");
        let recorded = Self { root };
        for participant in participants {
            recorded.add(&session, participant);
        }
        recorded
    }

    pub fn add(&self, session: &Session, participant: &str) {
        let plan = plan(session, participant, 1);
        let who = (participant, 1);
        let mut recorder =
            Recorder::create(&self.root, session, &plan, who, true).expect("a recorder");
        for planned in &plan.trials[..TRIALS] {
            recorder.trial_ended(&record(planned), std::iter::empty()).expect("a record");
        }
        recorder.finish().expect("a data set");
    }

    pub fn root(&self) -> &Path {
        &self.root
    }

    pub fn source(&self, name: &str) -> PathBuf {
        self.root.join("sourcedata").join(name)
    }

    /// Changes a file of participant 02, given its lines.
    fn change(&self, file: &str, change: impl Fn(&mut Vec<String>)) {
        let path = self.source("sub-02/task-p1").join(file);
        let text = fs::read_to_string(&path).expect("a file");
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        change(&mut lines);
        fs::write(&path, lines.join("\n") + "\n").expect("a file");
    }

    /// The participants that can be read, and the messages of what is left out, without the folder of the data set.
    fn read(&self) -> (Vec<String>, Vec<String>) {
        let found = recorded_sessions(&self.root).expect("a data set");
        let codes = found.sessions.iter().map(|session| session.info.participant.clone());
        (codes.collect(), found.left_out.iter().map(|error| self.words(error)).collect())
    }

    /// The message of the error that the whole data set is.
    fn refused(&self) -> String {
        self.words(&recorded_sessions(&self.root).expect_err("an error"))
    }

    fn words(&self, error: &DataSetError) -> String {
        let root = self.root.join("sourcedata").display().to_string() + "/";
        error.to_string().replace('\\', "/").replace(&root, "")
    }

    /// Asserts that 01 and 03 are read, and 02 is left out with these words.
    #[track_caller]
    fn assert_left_out(&self, words: &str) {
        let (participants, left_out) = self.read();
        assert_eq!(participants, ["01", "03"]);
        assert!(left_out.len() == 1 && left_out[0].contains(words), "{left_out:?}");
    }
}

const THREE: [&str; 3] = ["01", "02", "03"];

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).expect("a copy");
        }
    }
}

#[test]
fn a_copied_folder_is_refused_by_the_names_of_both() {
    for (from, to) in [
        ("sub-01", "sub-01 - Copy"),
        ("sub-01", "sub-09"),
        ("sub-01/task-p1", "sub-01/task-p1 (conflicted copy)"),
        ("sub-01/task-p1", "sub-02/task-p1"),
    ] {
        let recorded = Recorded::new("copied", &["01", "02"]);
        copy(&recorded.source(from), &recorded.source(to));
        let words = recorded.refused();
        let task = |folder: &str| match folder.split_once('/') {
            Some(_) => folder.to_owned(),
            None => format!("{folder}/task-p1"),
        };
        for folder in [task(from), task(to)] {
            assert!(words.contains(&folder), "{folder}: {words}");
        }
        assert!(words.contains("both are of participant 01, task p1"), "{words}");
    }
}

#[test]
fn a_renamed_folder_is_refused() {
    let recorded = Recorded::new("renamed", &["01", "02"]);
    fs::rename(recorded.source("sub-02"), recorded.source("sub-07")).expect("a new name");
    let words = recorded.refused();
    assert!(words.contains("sub-07/task-p1: session.json says participant 02, task p1"), "{words}");
}

/// Another code gives another order of the trials: the records would be of other stimuli.
#[test]
fn a_session_that_was_renamed_in_its_description_too_is_left_out() {
    let recorded = Recorded::new("renamed-twice", &THREE);
    recorded.change("session.json", |lines| {
        let renamed = |line: &mut String| *line = line.replace("\"02\"", "\"07\"");
        lines.iter_mut().for_each(renamed);
    });
    fs::rename(recorded.source("sub-02"), recorded.source("sub-07")).expect("a new name");
    recorded
        .assert_left_out("sub-07/task-p1: the plan of session.toml, participant and seed is not");
}

#[test]
fn codes_that_differ_in_case_only_are_refused_by_the_names_of_both() {
    let recorded = Recorded::new("case", &["p03"]);
    let other = Recorded::new("case-other", &["P03"]);
    copy(&other.source("sub-P03"), &recorded.source("sub-P03"));
    let words = recorded.refused();
    assert!(words.contains("sub-P03/task-p1 and ") && words.contains("sub-p03/task-p1"), "{words}");
    assert!(words.contains("differ in case only"), "{words}");
}

#[test]
fn what_cannot_be_read_is_named_and_the_rest_is_read() {
    type Change = fn(&Recorded);
    let changes: [(Change, &str); 6] = [
        (
            |recorded| fs::remove_file(recorded.source("sub-02/task-p1/log.jsonl")).unwrap(),
            "sub-02/task-p1/log.jsonl: ",
        ),
        (
            |recorded| fs::remove_file(recorded.source("sub-02/task-p1/session.json")).unwrap(),
            "sub-02/task-p1/session.json: ",
        ),
        (
            |recorded| fs::remove_dir_all(recorded.source("sub-02/task-p1")).unwrap(),
            "sub-02: has no folder task-TASK",
        ),
        (
            |recorded| {
                fs::remove_dir_all(recorded.source("sub-02")).unwrap();
                fs::write(recorded.source("sub-02"), "no folder").unwrap();
            },
            "sub-02: is no folder sub-CODE",
        ),
        (
            |recorded| {
                fs::rename(recorded.source("sub-02"), recorded.source("Copy of sub-02")).unwrap();
            },
            "Copy of sub-02: is no folder sub-CODE",
        ),
        (
            |recorded| recorded.change("log.jsonl", |lines| lines[2].truncate(20)),
            "sub-02/task-p1/log.jsonl:3: ",
        ),
    ];
    for (change, words) in changes {
        let recorded = Recorded::new("unreadable", &THREE);
        change(&recorded);
        recorded.assert_left_out(words);
    }
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_entered_is_named() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let recorded = Recorded::new("closed", &THREE);
    let folder = recorded.source("sub-02");
    let allow = |mode: u32| {
        fs::set_permissions(&folder, fs::Permissions::from_mode(mode)).expect("a permission");
    };
    allow(0o000);
    // The superuser enters every folder.
    if fs::read_dir(&folder).is_err() {
        assert!(recorded.refused().starts_with("sub-02: "), "{}", recorded.refused());
    }
    allow(0o755);
    fs::remove_dir_all(&folder).expect("a folder");
    symlink("sub-02", &folder).expect("a link to itself");
    recorded.assert_left_out("sub-02: ");
}

/// What a program leaves that is killed while it writes a file: its name with the process and `.part`.
#[test]
fn parts_of_files_that_a_killed_program_has_left_are_removed_by_the_next_run() {
    let recorded = Recorded::new("parts", &["01"]);
    let session = ready("p1-discrimination");
    let plan = plan(&session, "01", 1);
    let ours = [
        "sourcedata/sub-01/task-p1/session.toml.4711.part",
        "sourcedata/sub-01/task-p1/clock.json.4711.part",
        "sub-01/beh/sub-01_task-p1_events.tsv.4711.part",
    ];
    let of_others = [
        "sourcedata/sub-01/task-p1/notes.part",
        "sub-01/beh/sub-01_task-p1_video.part",
        "sub-01/beh/sub-01_task-p14_events.tsv.4711.part",
    ];
    for file in ours.iter().chain(&of_others) {
        fs::write(recorded.root().join(file), "x").expect("a file");
    }
    let mut resumed =
        Recorder::resume(recorded.root(), &session, &plan, ("01", 1), true).expect("a session");
    resumed.finish().expect("a data set");
    let is_there = |file: &&str| recorded.root().join(file).exists();
    assert!(!ours.iter().any(is_there));
    assert!(of_others.iter().all(is_there));
}

#[test]
fn only_a_session_with_recorded_trials_is_said_to_go_on() {
    let session = ready("p1-discrimination");
    let plan = plan(&session, "01", 1);
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("file-in-place-of-a-data-set");
    fs::write(&file, "").expect("a file");
    let error = Recorder::create(&file.join("data"), &session, &plan, ("01", 1), true);
    let error = error.expect_err("no folder").to_string();
    assert!(
        error.contains("file-in-place-of-a-data-set") && !error.contains("--resume"),
        "{error}"
    );
    let recorded = Recorded::new("goes-on", &["01"]);
    let mut resumed =
        Recorder::resume(recorded.root(), &session, &plan, ("01", 1), true).expect("a session");
    let folder = recorded.source("sub-01/task-p1");
    fs::remove_dir_all(&folder).expect("a folder");
    fs::write(&folder, "").expect("a file");
    let error = resumed.program_of(None).expect_err("no folder").to_string();
    let goes_on =
        "What was recorded before is whole; --resume goes on when the file can be written";
    assert!(error.ends_with(goes_on), "{error}");
}

/// Whoever opens a FIFO for reading waits until another program writes into it.
#[cfg(unix)]
#[test]
fn a_fifo_or_folder_in_place_of_a_file_is_named_and_nothing_waits() {
    for file in ["log.jsonl", "session.json", "session.toml"] {
        let recorded = Recorded::new("fifo", &THREE);
        let path = recorded.source("sub-02/task-p1").join(file);
        fs::remove_file(&path).expect("a file");
        let mkfifo = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(mkfifo.expect("mkfifo").success());
        recorded.assert_left_out(&format!("{file}: this is a FIFO; allowed is a file"));
        fs::remove_file(&path).expect("a FIFO");
        fs::create_dir(&path).expect("a folder");
        recorded.assert_left_out(&format!("{file}: this is a folder; allowed is a file"));
    }
}

#[test]
fn a_list_of_participants_with_a_column_twice_is_refused() {
    let recorded = Recorded::new("column-twice", &["01"]);
    let list = "participant_id\texcluded\texcluded\nsub-01\tno\tyes\n";
    fs::write(recorded.root().join("participants.tsv"), list).expect("a list");
    let words = recorded.refused();
    assert!(
        words.ends_with("participants.tsv:1: two columns \"excluded\"; allowed is each name once"),
        "{words}"
    );
}

#[test]
fn records_that_contradict_each_other_or_the_plan_are_named_by_line() {
    type Change = fn(&mut Vec<String>);
    let changes: [(Change, &str); 11] = [
        (
            |lines| {
                lines.push(
                    lines[5].replace("\"attempt\":1,", "\"attempt\":2,").replace("0.0,", "9.0,"),
                )
            },
            "log.jsonl:7: trial 6, attempt 2: attempt 1, of line 6, counts already",
        ),
        (
            |lines| lines[2] = lines[2].replace("\"attempt\":1,", "\"attempt\":3,"),
            "log.jsonl:3: trial 3, attempt 3: it follows 0 attempt(s)",
        ),
        (
            |lines| lines[0] = lines[0].replace("\"answer\":\"right\"", "\"answer\":\"upper\""),
            "the answer is 'upper'; session.toml allows left, right",
        ),
        (
            |lines| lines.reverse(),
            "log.jsonl:2: trial 5, attempt 1: it begins at 150 s, before the trial of line 1 has ended, at 200 s; 5 contradictions in all",
        ),
        (
            |lines| lines.push(lines[4].clone()),
            "log.jsonl:7: trial 5, attempt 1: it is recorded twice, first in line 5",
        ),
        (
            |lines| lines.swap(2, 4),
            "log.jsonl:4: trial 4, attempt 1: it begins at 120 s, before the trial of line 3 has ended, at 170 s; 2 contradictions in all",
        ),
        (
            |lines| lines[1] = lines[1].replace("\"end_s\":80.0", "\"end_s\":20.0"),
            "log.jsonl:2: trial 2, attempt 1: it ends at 20 s, before its begin at 60 s",
        ),
        (
            |lines| lines[0] = lines[0].replace("\"answer\":\"right\"", "\"answer\":\"left\""),
            "log.jsonl:1: trial 1, attempt 1: the answer 'left' is recorded as correct, and the correct one is 'right'",
        ),
        (
            |lines| lines[0] = lines[0].replace("\"is_correct\":true", "\"is_correct\":null"),
            "the answer 'right' is recorded as not scored",
        ),
        (
            |lines| lines[0] = lines[0].replace(":\"right\"", ":\"left\""),
            "the correct answer is 'left'; by the plan it is 'right'",
        ),
        (
            |lines| lines[0] = lines[0].replace("\"trial\":1,", "\"trial\":200,"),
            "log.jsonl:1: trial 200, attempt 1: the plan has 84 trials",
        ),
    ];
    for (change, words) in changes {
        let recorded = Recorded::new("contradictions", &THREE);
        recorded.change("log.jsonl", change);
        recorded.assert_left_out(words);
    }
}

#[test]
fn a_damaged_end_and_a_changed_session_file_are_remarks() {
    let recorded = Recorded::new("remarks", &THREE);
    let log = |text: &str| recorded.change("log.jsonl", |lines| lines.push(text.into()));
    let remarks = || {
        let found = recorded_sessions(&recorded.root).expect("a data set");
        assert!(found.left_out.is_empty(), "{:?}", found.left_out);
        found.sessions.iter().map(|session| session.remarks.join("; ")).collect::<Vec<_>>()
    };
    assert_eq!(remarks(), ["", "", ""]);
    log("{\"t_s\":1");
    assert!(remarks()[1].contains("log.jsonl:7: "), "{:?}", remarks());
    recorded.change("log.jsonl", |lines| lines.truncate(TRIALS));
    recorded.change("telemetry.csv", Vec::clear);
    assert!(remarks()[1].contains("telemetry.csv: it has 1 bytes"), "{:?}", remarks());
    recorded.change("session.toml", |lines| lines.push("# Day 2".into()));
    assert!(remarks()[1].contains("session.toml: changed after the recording"), "{:?}", remarks());
}

/// Every text file that is read again, as editors and spreadsheets save it.
#[test]
fn a_byte_order_mark_changes_nothing_and_utf_16_is_named_with_its_file() {
    let of_02 = |file: &str| format!("sourcedata/sub-02/task-p1/{file}");
    let files = ["session.toml", "session.json", "log.jsonl"].map(of_02);
    for file in files.iter().map(String::as_str).chain(["participants.tsv"]) {
        let recorded = Recorded::new("encodings", &THREE);
        let path = recorded.root.join(file);
        let text = "\u{feff}".to_owned() + &fs::read_to_string(&path).expect("a file");
        fs::write(&path, &text).expect("a file");
        assert_eq!(recorded.read(), (THREE.map(str::to_owned).to_vec(), vec![]), "{file}");
        let session = ready("p1-discrimination");
        let plan = plan(&session, "02", 1);
        let mut resumed = Recorder::resume(&recorded.root, &session, &plan, ("02", 1), true);
        resumed.as_mut().expect(file).finish().expect(file);
        assert_eq!(recorded.read(), (THREE.map(str::to_owned).to_vec(), vec![]), "{file}");
        let utf_16: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        fs::write(&path, utf_16).expect("a file");
        let words =
            format!("{}: this is UTF-16; allowed is UTF-8", file.replace("sourcedata/", ""));
        if file == "participants.tsv" {
            let refused = recorded.refused();
            assert!(refused.ends_with(&words), "{refused}");
        } else {
            recorded.assert_left_out(&words);
        }
    }
}

/// A program that was killed while it wrote leaves a line without an end.
#[test]
fn a_line_that_was_not_written_to_its_end_is_no_damage() {
    let recorded = Recorded::new("killed", &["01"]);
    let path = recorded.source("sub-01/task-p1/log.jsonl");
    let text = fs::read_to_string(&path).expect("a log");
    fs::write(&path, text + "{\"t_s\":1").expect("a log");
    let found = recorded_sessions(&recorded.root).expect("a data set");
    assert_eq!(found.sessions[0].records.len(), TRIALS);
    assert!(found.sessions[0].remarks.is_empty());
}

/// Whatever the tables of a data set and their sidecars call something, and HED, which the validator of BIDS takes for its annotation.
#[test]
fn no_factor_and_no_station_has_the_name_of_a_column_of_the_tables_or_of_a_key_of_bids() {
    let recorded = Recorded::new("names", &["01"]);
    let read = |name: &str| fs::read_to_string(recorded.root.join(name)).expect(name);
    let events = read("sub-01/beh/sub-01_task-p1_events.tsv");
    let plan = read("sourcedata/sub-01/task-p1/plan.csv");
    let sidecar: serde_json::Value =
        serde_json::from_str(&read("sub-01/beh/sub-01_task-p1_events.json")).expect("JSON");
    let names: BTreeSet<&str> = (events.lines().next().expect("a header").split('\t'))
        .chain(plan.lines().next().expect("a header").split(','))
        .chain(sidecar.as_object().expect("an object").keys().map(String::as_str))
        .chain(["HED", "TaskName", "Instructions", "left_presented", "right_skin_fall"])
        .collect();
    assert!(names.len() > 50, "{names:?}");
    let text = ready("p5-real-and-simulated").text;
    let parsed = |from: &str, to: String| {
        assert!(text.contains(from), "{from}");
        Session::parse(&text.replace(from, &to), Path::new("s.toml"))
    };
    // What the session itself calls a factor of its pairs is refused as a second one of that name.
    for name in names.into_iter().filter(|name| !["first", "second", "side"].contains(name)) {
        let random = "random = { side =";
        let error = parsed(random, format!("random = {{ {name} =")).expect_err(name).to_string();
        assert!(error.contains(&format!("{name:?} is a factor; allowed is")), "{name}: {error}");
        let is_of_station = name.starts_with("left") || name.starts_with("right");
        if !is_of_station {
            let error = parsed("[stations.left]", format!("[stations.{name}]"));
            let error = error.expect_err(name).to_string();
            let says = format!("stations.{name}: allowed as a name is");
            assert!(error.contains(&says), "{name}: {error}");
        }
    }
}
