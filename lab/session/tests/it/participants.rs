//! Participants of a data set who are renamed or excluded.

use std::fs;

use thermal_session::Plan;
use thermal_session::dataset::{
    ChangeError, Recorder, RecordingError, exclude, recorded_sessions, rename,
};

use crate::data_sets::Recorded;
use crate::{plan, ready};

/// All paths and, of files without compression, contents that name a participant.
fn names(recorded: &Recorded, participant: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![recorded.root().to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(recorded.root()).expect("a name").display().to_string();
            let text = fs::read_to_string(&path).unwrap_or_default();
            if name.contains(participant) || text.contains(participant) {
                found.push(name);
            }
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
    found.sort();
    found
}

#[test]
fn a_renamed_participant_has_the_new_code_everywhere_and_is_read_with_the_plan_of_the_old_one() {
    let recorded = Recorded::new("rename", &["01", "X9", "X90"]);
    let write = |name: &str, text: &str| {
        let path = recorded.root().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("a file");
    };
    write("participants.tsv", "participant_id\tage\r\nsub-01\t30\r\nsub-X9\t31\r\nsub-X90\t32\r\n");
    write("phenotype/handedness.tsv", "participant_id\thand\nsub-X9\tleft\nsub-X90\tright\n");
    write("sub-X9/sub-X9_scans.tsv", "filename\nbeh/sub-X9_task-p1_events.tsv\n");
    let sessions = |code: &str| {
        let found = recorded_sessions(recorded.root()).expect("a data set");
        assert!(found.left_out.is_empty(), "{:?}", found.left_out);
        let session = found.sessions.into_iter().find(|session| session.info.participant == code);
        session.expect("a session")
    };
    let before = sessions("X9");
    assert_eq!(rename(recorded.root(), "X9", "02").expect("a new code"), 1);
    let after = sessions("02");
    assert_eq!((&after.plan, &after.records), (&before.plan, &before.records));
    assert_ne!(after.plan, plan(&ready("p1-discrimination"), "02", 1));
    assert_eq!(after.info.plan_code(), "X9");
    // What still has the old code: the record of the change, and another participant whose code begins with it.
    let left = names(&recorded, "X9");
    let (of_another, rest): (Vec<_>, Vec<_>) =
        left.into_iter().partition(|name| name.contains("sub-X90"));
    assert!(!of_another.is_empty());
    assert_eq!(
        rest,
        ["participants.tsv", "phenotype/handedness.tsv", "sourcedata/sub-02/task-p1/session.json"]
    );
    let read = |name: &str| fs::read_to_string(recorded.root().join(name)).expect("a file");
    assert_eq!(
        read("participants.tsv"),
        "participant_id\tage\r\nsub-01\t30\r\nsub-02\t31\r\nsub-X90\t32\r\n"
    );
    assert_eq!(
        read("phenotype/handedness.tsv"),
        "participant_id\thand\nsub-02\tleft\nsub-X90\tright\n"
    );
    assert_eq!(read("sub-02/sub-02_scans.tsv"), "filename\nbeh/sub-02_task-p1_events.tsv\n");
    assert!(read("sub-02/beh/sub-02_task-p1_events.tsv").starts_with("onset\t"));
}

#[test]
fn a_renamed_session_goes_on_with_the_plan_that_was_drawn_with_the_old_code() {
    let recorded = Recorded::new("rename-resumed", &["01"]);
    rename(recorded.root(), "01", "02").expect("a new code");
    rename(recorded.root(), "02", "03").expect("a new code");
    let session = ready("p1-discrimination");
    let resumed = |code: &str| {
        let plan = Plan::new(&session, code, 1).expect("a plan");
        Recorder::resume(recorded.root(), &session, &plan, ("03", 1), true)
    };
    assert!(matches!(resumed("03"), Err(RecordingError::OtherSession { .. })));
    let code = thermal_session::dataset::Folder::new(recorded.root(), "03", "p1").plan_code();
    assert_eq!(code.expect("a code"), "01");
    resumed("01").expect("a recorder").finish().expect("a data set");
    let found = recorded_sessions(recorded.root()).expect("a data set");
    assert_eq!(found.sessions[0].info.plan_code(), "01");
}

#[test]
fn a_session_renamed_before_its_first_trial_goes_on_with_the_same_plan() {
    let recorded = Recorded::new("rename-empty", &[]);
    let session = ready("p1-discrimination");
    let drawn = plan(&session, "01", 1);
    drop(Recorder::create(recorded.root(), &session, &drawn, ("01", 1), true).expect("a recorder"));
    rename(recorded.root(), "01", "02").expect("a new code");
    let resumed = Recorder::resume(recorded.root(), &session, &drawn, ("02", 1), true);
    drop(resumed.expect("a recorder"));
    let found = recorded_sessions(recorded.root()).expect("a data set");
    assert_eq!(found.sessions[0].plan, drawn);
}

/// Whatever has been done when the program is killed, the same call does the rest.
#[test]
fn an_interrupted_renaming_goes_on_by_the_same_call() {
    type Interrupt = fn(&Recorded);
    let interruptions: [Interrupt; 3] = [
        // After the descriptions.
        |recorded| {
            fs::rename(recorded.source("sub-02"), recorded.source("sub-01")).unwrap();
            restore_behaviour(recorded);
        },
        // After the recordings.
        restore_behaviour,
        // Before the folder of the tables.
        |recorded| {
            fs::rename(recorded.root().join("sub-02"), recorded.root().join("sub-01")).unwrap()
        },
    ];
    for interrupt in interruptions {
        let recorded = Recorded::new("rename-interrupted", &["01"]);
        rename(recorded.root(), "01", "02").expect("a new code");
        interrupt(&recorded);
        rename(recorded.root(), "01", "02").expect("the rest");
        let left = names(&recorded, "01");
        assert_eq!(left, ["sourcedata/sub-02/task-p1/session.json"]);
        let renamed =
            &recorded_sessions(recorded.root()).expect("a data set").sessions[0].info.renamed;
        assert_eq!(renamed.len(), 1);
    }
}

/// Tables and list as before the renaming.
fn restore_behaviour(recorded: &Recorded) {
    let root = recorded.root();
    fs::rename(root.join("sub-02"), root.join("sub-01")).unwrap();
    for entry in fs::read_dir(root.join("sub-01/beh")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().replace("sub-02", "sub-01");
        fs::rename(&path, path.with_file_name(name)).unwrap();
    }
    fs::write(root.join("participants.tsv"), "participant_id\nsub-01\n").unwrap();
}

#[test]
fn a_renaming_that_is_refused_changes_nothing() {
    let recorded = Recorded::new("rename-refused", &["01", "02", "p03"]);
    let list = recorded.root().join("participants.tsv");
    fs::write(&list, fs::read_to_string(&list).unwrap() + "sub-P04\n").unwrap();
    let before = names(&recorded, "");
    let refused = |old: &str, new: &str| {
        let error = rename(recorded.root(), old, new).expect_err("an error");
        assert_eq!(names(&recorded, ""), before);
        error.to_string()
    };
    for (old, new, words) in [
        ("01", "02", "sub-02: there is a participant 02 already"),
        ("01", "P04", "participants.tsv: there is a participant P04 already"),
        ("01", "P03", "there are data of p03"),
        ("01", "01", "participant 01 has this code"),
        ("01", "Anna", "participant \"Anna\"; allowed is a code"),
        ("../01", "5", "participant \"../01\"; allowed is a code"),
        ("5", "6", "there are no data of participant 5; there are data of 01, 02, p03"),
    ] {
        let message = refused(old, new);
        assert!(message.contains(words), "{message}");
    }
    let session = ready("p1-discrimination");
    let plan = plan(&session, "01", 1);
    let running = Recorder::resume(recorded.root(), &session, &plan, ("01", 1), true);
    assert!(refused("01", "5").contains("another program records this session"));
    drop(running);
    let no_data = rename(&recorded.root().join("nowhere"), "01", "02");
    assert!(matches!(no_data, Err(ChangeError::NoDataSet(_))), "{no_data:?}");
    assert!(!recorded.root().join("nowhere").exists());
    // On some computers both names are one folder.
    rename(recorded.root(), "p03", "P03").expect("another case");
}

#[test]
fn an_exclusion_stands_in_the_list_with_reason_and_time_and_is_read_again() {
    let recorded = Recorded::new("exclude", &["01", "02"]);
    let list = recorded.root().join("participants.tsv");
    fs::write(&list, "\u{feff}participant_id\tage\r\nsub-01\t30\r\nsub-02\t31\r\n").unwrap();
    exclude(recorded.root(), "02", " felt unwell after block 1 ").expect("an exclusion");
    let text = fs::read_to_string(&list).unwrap();
    let rows: Vec<Vec<_>> = text.lines().map(|line| line.split('\t').collect()).collect();
    assert_eq!(
        rows[0],
        ["participant_id", "age", "excluded", "exclusion_reason", "exclusion_time"]
    );
    assert_eq!(rows[1], ["sub-01", "30", "n/a", "n/a", "n/a"]);
    assert_eq!(rows[2][..4], ["sub-02", "31", "yes", "felt unwell after block 1"]);
    assert!(rows[2][4].starts_with("20") && rows[2][4].ends_with('Z'), "{text}");
    let about = fs::read_to_string(recorded.root().join("participants.json")).unwrap();
    for column in ["participant_id", "excluded", "exclusion_reason", "exclusion_time"] {
        assert!(about.contains(&format!("\"{column}\": {{")), "{about}");
    }
    let read = recorded_sessions(recorded.root()).expect("a data set").sessions;
    assert_eq!(read[0].excluded, None);
    let exclusion = read[1].excluded.clone().expect("an exclusion");
    assert_eq!(
        exclusion.to_string(),
        format!("excluded at {}: felt unwell after block 1", rows[2][4])
    );
    // A new code takes it along, and a participant who is added has none.
    rename(recorded.root(), "02", "05").expect("a new code");
    recorded.add(&ready("p1-discrimination"), "03");
    let read = recorded_sessions(recorded.root()).expect("a data set").sessions;
    let excluded: Vec<_> = read.iter().map(|session| session.excluded.is_some()).collect();
    assert_eq!(excluded, [false, false, true]);
}

#[test]
fn an_exclusion_without_a_participant_or_a_reason_or_twice_is_refused() {
    let recorded = Recorded::new("exclude-refused", &["01"]);
    let list = recorded.root().join("participants.tsv");
    let before = fs::read_to_string(&list).unwrap();
    for (code, reason, words) in [
        ("02", "ill", "there are no data of participant 02; there are data of 01"),
        ("01", " ", "the reason \"\"; allowed is a text of one line"),
        ("01", "ill\tthen well", "allowed is a text of one line"),
        ("01", "n/a", "other than n/a"),
    ] {
        let error = exclude(recorded.root(), code, reason).expect_err("an error").to_string();
        assert!(error.contains(words), "{error}");
        assert_eq!(fs::read_to_string(&list).unwrap(), before);
    }
    exclude(recorded.root(), "01", "ill").expect("an exclusion");
    let twice = exclude(recorded.root(), "01", "well").expect_err("an error").to_string();
    assert!(twice.contains("participant 01 is excluded at 20") && twice.contains("ill"), "{twice}");
}

#[test]
fn a_list_that_people_have_changed_is_read_by_its_words() {
    let recorded = Recorded::new("exclude-by-hand", &["01", "02", "03"]);
    let list = recorded.root().join("participants.tsv");
    let excluded = |rows: &str| {
        fs::write(&list, rows).unwrap();
        recorded_sessions(recorded.root()).map(|found| {
            let sessions = found.sessions.into_iter();
            sessions.filter_map(|session| Some(session.excluded?.to_string())).collect::<Vec<_>>()
        })
    };
    let by_hand = excluded("participant_id\texcluded\nsub-01\tYes\nsub-02\tno\nsub-03\n");
    assert_eq!(by_hand.unwrap(), ["excluded: no reason is recorded"]);
    let wrong = excluded("participant_id\texcluded\nsub-01\tn/a\nsub-02\tmaybe\n").unwrap_err();
    let words = "participants.tsv:3: excluded = \"maybe\"; allowed are yes, no and n/a";
    assert!(wrong.to_string().ends_with(words), "{wrong}");
    fs::remove_file(&list).unwrap();
    assert!(recorded_sessions(recorded.root()).is_ok());
}
