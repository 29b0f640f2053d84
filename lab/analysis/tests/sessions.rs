//! The ready sessions, answered by chance, and their analyses.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::json;
use session_analysis::{Analysis, Simulated, TaskAnalysis};
use thermal_session::dataset::{
    DataSet, DataSetError, Folder, ProgramVersion, RecordedSession, SessionInfo,
};
use thermal_session::record::{StationRecord, TrialRecord};
use thermal_session::{ANALYSES, AnswerKind, Plan, PlannedTrial, Presented, Session};

fn files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../sessions");
    let entries = std::fs::read_dir(folder).expect("the ready sessions");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> =
        paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    files.sort();
    files
}

/// A number from 0 to below 1 that looks random.
fn scrambled(number: u32) -> f64 {
    f64::from(number.wrapping_mul(2_654_435_769) >> 8) / f64::from(1u32 << 24)
}

fn record(session: &Session, planned: &PlannedTrial, person: u32) -> TrialRecord {
    let chance = |salt: u32| scrambled(planned.number * 31 + person * 7919 + salt);
    let answer = session.answer.as_ref().map(|answer| match &answer.kind {
        AnswerKind::OneOf(words) => words[(chance(1) * words.len() as f64) as usize].clone(),
        AnswerKind::NumberPerStation(low, high) => {
            let number = |salt: u32| (low + (high - low) * chance(salt)).round().to_string();
            (0..session.stations.len() as u32).map(number).collect::<Vec<_>>().join(";")
        }
    });
    let begin_s = 30.0 * f64::from(planned.number);
    let station = |(index, presented): (usize, &Presented)| StationRecord {
        presented: presented.to_string(),
        land_s: Some(begin_s + 5.0),
        skin_before_c: Some(34.0),
        skin_fall_k: Some(1.0 + chance(50 + index as u32)),
        force_mean_n: Some(1.0 + chance(60)),
        force_end_mean_n: planned.target_force_n,
        force_error_rms_n: Some(0.1 * chance(61)),
        force_settled_s: Some(chance(62)),
        ..StationRecord::default()
    };
    TrialRecord {
        trial: planned.number,
        attempt: 1,
        part: planned.part.clone(),
        block: planned.block,
        levels: planned.levels.clone(),
        staircase_level_k: planned.staircase.map(|_| 0.05 + chance(70)),
        begin_s,
        land_s: Some(begin_s + 5.0),
        lift_s: Some(begin_s + 15.0),
        answer_s: Some(begin_s + 6.0 + 5.0 * chance(80)),
        end_s: begin_s + 20.0,
        target_force_n: planned.target_force_n,
        is_correct: planned.correct.as_ref().map(|correct| Some(correct) == answer.as_ref()),
        expected: planned.correct.clone(),
        answer,
        room_c: Some(24.0),
        stations: planned.presented.iter().enumerate().map(station).collect(),
        ..TrialRecord::default()
    }
}

/// A session that somebody who guesses has done.
fn recorded(session: &Session, person: u32) -> RecordedSession {
    let participant = format!("P{person}");
    let plan = Plan::new(session, &participant, 1).expect("a plan");
    let records = plan.trials.iter().map(|planned| record(session, planned, person));
    RecordedSession {
        folder: Folder::new(Path::new("no such folder"), &participant, &session.task),
        info: SessionInfo {
            title: session.title.clone(),
            task: session.task.clone(),
            cite: session.cite.clone(),
            participant,
            seed: 1,
            is_simulated: true,
            program: ProgramVersion::default(),
            resumed_by: Vec::new(),
            session_sha256: String::new(),
            plan_sha256: String::new(),
            devices: Vec::new(),
            renamed: Vec::new(),
        },
        records: records.collect(),
        session: session.clone(),
        plan,
        log: Vec::new(),
        excluded: None,
        remarks: Vec::new(),
    }
}

fn analyse(sessions: &[RecordedSession]) -> Analysis {
    let data = DataSet { sessions: sessions.to_vec(), left_out: Vec::new() };
    session_analysis::analyse(&data, Simulated::Apart)
}

fn of_one(sessions: &[RecordedSession]) -> TaskAnalysis {
    let mut tasks = analyse(sessions).tasks;
    assert_eq!(tasks.len(), 1);
    tasks.remove(0)
}

#[test]
fn every_word_of_the_ready_sessions_gives_its_tables() {
    assert!(files().len() >= 11);
    for file in files() {
        let session = Session::read(&file).expect("a session");
        let sessions: Vec<_> = (1..=3).map(|person| recorded(&session, person)).collect();
        let analysis = of_one(&sessions);
        for word in &session.score.analyses {
            let section = analysis.sections.iter().find(|section| section.name == *word);
            let section = section.unwrap_or_else(|| panic!("{}: {word}", file.display()));
            // Courses need telemetry, and two windows are too few for a correlation.
            if word != "exponential-fit"
                && (session.task.as_str(), &**word) != ("p8", "pearson-with-model")
            {
                assert!(
                    !section.tables.is_empty(),
                    "{}: {word}: {:?}",
                    file.display(),
                    section.not_possible
                );
            }
        }
    }
}

#[test]
fn the_analyses_are_those_that_a_session_file_may_ask_for() {
    let mut session = Session::read(&files()[0]).expect("a session");
    session.score.analyses = ANALYSES.iter().map(|(word, _)| (*word).to_owned()).collect();
    let analysis = of_one(&[recorded(&session, 1)]);
    let known: BTreeSet<_> = analysis.sections.iter().map(|section| section.name.clone()).collect();
    for word in &session.score.analyses {
        assert!(known.contains(word), "{word}");
    }
    let unknown = "this version knows no such analysis";
    let mut sentences = analysis.sections.iter().flat_map(|section| &section.not_possible);
    assert!(!sentences.any(|sentence| sentence.contains(unknown)));
}

#[test]
fn sessions_of_several_tasks_are_analysed_apart() {
    let sessions: Vec<_> =
        files().iter().map(|file| recorded(&Session::read(file).expect("a session"), 1)).collect();
    let analysis = analyse(&sessions);
    assert_eq!(analysis.tasks.len(), sessions.len());
    assert!(analysis.page().contains("<h1>Analysis of experiments</h1>"));
    let names: BTreeSet<_> = analysis.csv().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names.len(), analysis.csv().len());
}

/// Comments and order of participants do not matter; another rule of the trials does.
#[test]
fn sessions_of_a_task_whose_files_differ_are_analysed_apart() {
    let file = files().into_iter().find(|file| file.ends_with("p1-discrimination.toml"));
    let path = file.expect("P1");
    let text = std::fs::read_to_string(&path).expect("a file");
    let parsed = |text: &str| Session::parse(text, &path).expect("a session");
    let (one, comment) = (parsed(&text), parsed(&format!("# Day 2\n{text}")));
    let other = parsed(&text.replace("max_s = 10.0", "max_s = 5.0"));
    let sessions = [recorded(&one, 1), recorded(&other, 2), recorded(&comment, 3)];
    let analysis = analyse(&sessions);
    let sentence = "Session files of this task differ, so its sessions are analysed apart: p1-1 has P1, P3; p1-2 has P2.";
    let found: Vec<_> =
        analysis.tasks.iter().map(|task| (&*task.task, task.participants.join(" "))).collect();
    assert_eq!(found, [("p1-1", "P1 P3".into()), ("p1-2", "P2".into())]);
    for task in &analysis.tasks {
        assert!(task.sections[0].notes.contains(&sentence.to_owned()));
        assert!(task.sections.iter().any(|section| section.name == "published"));
    }
    let names: BTreeSet<_> = analysis.csv().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names.len(), analysis.csv().len());
    assert_eq!(of_one(&[recorded(&one, 1), recorded(&comment, 3)]).task, "p1");
}

/// Codes of the participants of the only task, and the first warning beside them.
fn who(sessions: &[RecordedSession], simulated: Simulated) -> (String, Option<String>) {
    let data = DataSet { sessions: sessions.to_vec(), left_out: Vec::new() };
    let tasks = session_analysis::analyse(&data, simulated).tasks;
    assert_eq!(tasks.len(), 1);
    (tasks[0].participants.join(" "), tasks[0].sections[0].warnings.first().cloned())
}

#[test]
fn simulated_participants_are_kept_apart_from_real_ones_unless_asked_for() {
    let file = files().into_iter().find(|file| file.ends_with("p1-discrimination.toml"));
    let session = Session::read(&file.expect("P1")).expect("a session");
    let simulated = [1, 2, 3].map(|person| recorded(&session, person));
    assert_eq!(who(&simulated, Simulated::Apart), ("P1 P2 P3".into(), None));
    let mut mixed = simulated.clone();
    mixed[1].info.is_simulated = false;
    let (codes, sentence) = who(&mixed, Simulated::Apart);
    assert_eq!(codes, "P2");
    assert_eq!(
        sentence.as_deref(),
        Some(
            "2 simulated participant(s) were left out (P1, P3), because this task has real ones; --pool-simulated analyses them together."
        )
    );
    let (codes, sentence) = who(&mixed, Simulated::Pooled);
    assert_eq!(codes, "P1 P2 P3");
    assert_eq!(
        sentence.as_deref(),
        Some(
            "Real participants and 2 simulated one(s) (P1, P3) are analysed together, as was asked for."
        )
    );
    let mut real = simulated;
    real.iter_mut().for_each(|session| session.info.is_simulated = false);
    assert_eq!(who(&real, Simulated::Apart), ("P1 P2 P3".into(), None));
}

/// Another task without real participants is not affected.
#[test]
fn simulated_participants_of_a_task_without_real_ones_are_analysed() {
    let mut sessions: Vec<_> = files()[..2]
        .iter()
        .map(|file| recorded(&Session::read(file).expect("a session"), 1))
        .collect();
    sessions[0].info.is_simulated = false;
    assert_eq!(analyse(&sessions).tasks.len(), 2);
}

#[test]
fn what_was_not_read_is_on_the_page_and_in_the_json() {
    let missing = DataSetError::OtherPlan("sub-02/task-p1".into());
    let words = missing.to_string();
    let data = DataSet { sessions: Vec::new(), left_out: vec![missing] };
    let analysis = session_analysis::analyse(&data, Simulated::Apart);
    assert!(analysis.page().contains(&words));
    assert!(analysis.json().contains(&words));
    assert_eq!(analysis.left_out, [words]);
}

#[test]
fn a_level_of_the_plan_without_a_counted_trial_is_named() {
    let file = files().into_iter().find(|file| file.ends_with("p8-force-matching.toml"));
    let session = Session::read(&file.expect("P8")).expect("a session");
    let mut one = recorded(&session, 1);
    for record in &mut one.records {
        if record.target_force_n == Some(0.1) {
            record.void = Some("no landing within 5 s".into());
        }
    }
    let warnings = of_one(&[one]).sections[0].warnings.clone();
    assert!(
        warnings.contains(&"No trial with force_n 0.1 counts, so it is in no table.".into()),
        "{warnings:?}"
    );
    let void = "Left out: trials of P1 of which each attempt was void (";
    assert!(warnings.iter().any(|warning| warning.starts_with(void)), "{warnings:?}");
}

/// As they stand in session.json.
#[test]
fn versions_of_program_and_firmware_that_differ_in_a_data_set_are_said_with_who_has_which() {
    let session = Session::read(&files()[0]).expect("a session");
    let mut sessions = [1, 2, 3].map(|person| recorded(&session, person));
    let device =
        |version: &str| json!({ "identity": { "name": "thermal-display", "version": version } });
    for session in &mut sessions {
        session.info.program = ProgramVersion { version: "0.2.0".into(), commit: None };
        session.info.devices = vec![device("0.2.0")];
    }
    let said = |sessions: &[RecordedSession]| -> Vec<String> {
        let analysis = of_one(sessions);
        let participants = analysis.sections.iter().find(|section| section.name == "participants");
        let warnings = participants.expect("a section").warnings.iter();
        warnings.filter(|one| one.contains("versions of")).cloned().collect()
    };
    assert_eq!(said(&sessions), [""; 0]);
    sessions[1].info.resumed_by =
        vec![ProgramVersion { version: "0.2.0".into(), commit: Some("1a2b3c".into()) }];
    sessions[0].info.devices[0]["program"] = "0123abcd".into();
    sessions[2].info.devices = vec![device("0.1.0")];
    let task = &session.task;
    assert_eq!(
        said(&sessions),
        [
            format!(
                "The data set was recorded with 2 versions of thermal-lab. 0.2.0: P1 ({task}), P2 ({task}), P3 ({task}); 0.2.0 of \
                 commit 1a2b3c: P2 ({task})."
            ),
            format!(
                "The data set was recorded with 3 versions of firmware. thermal-display 0.1.0: P3 ({task}); thermal-display 0.2.0: \
                 P2 ({task}); thermal-display 0.2.0 (program 0123abcd): P1 ({task})."
            ),
        ]
    );
}
