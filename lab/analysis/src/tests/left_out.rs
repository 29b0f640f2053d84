//! What was done and is in no table is said beside it.

use std::path::{Path, PathBuf};

use super::data::{self, display, participant, sample, task, trial};
use crate::analyses::of_task;
use crate::input::{Task, Trial};

/// A folder for telemetry, which is deleted at the end of the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("session-analysis-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&folder).expect("a folder of the test");
        Self(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ignored = std::fs::remove_dir_all(&self.0);
    }
}

fn each_trial(task: &mut Task, mut change: impl FnMut(usize, &mut Trial)) {
    for (number, participant) in task.participants.iter_mut().enumerate() {
        for trial in &mut participant.trials {
            change(number, trial);
        }
    }
}

#[test]
fn a_force_at_which_nobody_settles_is_named_beside_the_analyses_that_leave_it_out() {
    let folder = Folder::new("forces");
    let mut task = data::forces(4, &folder.0);
    each_trial(&mut task, |_, trial| {
        if trial.record.target_force_n == Some(0.1) {
            trial.record.stations[0].force_settled_s = None;
        }
    });
    let analysis = of_task(&task);
    let settled = analysis.table("force-matching").number(&["baf2"], "settled");
    assert!(settled < 0.5, "the first row is of 0.1 N");
    let sentence = "time to settle / s: force 0.1 N is left out: nobody has a value there.";
    for section in ["anova-within", "tukey"] {
        assert_eq!(analysis.warnings(section), [sentence], "{section}");
    }
    let page = crate::Analysis { left_out: Vec::new(), tasks: vec![analysis] }.page();
    assert!(page.contains(sentence));
}

#[test]
fn participants_who_lack_cells_are_named_with_their_cells() {
    let mut task = data::identification(4, 0.5);
    each_trial(&mut task, |_, trial| trial.record.block = 1);
    let retain = |trials: &mut Vec<Trial>, keep: fn(&str) -> bool| {
        trials.retain(|trial| keep(trial.record.expected.as_deref().unwrap_or_default()));
    };
    retain(&mut task.participants[1].trials, |expected| expected != "foam");
    retain(&mut task.participants[2].trials, |expected| expected == "foam");
    task.participants[3].trials.clear();
    let analysis = of_task(&task);
    let of_dependent: Vec<_> = analysis
        .warnings("anova-within")
        .into_iter()
        .filter_map(|sentence| sentence.strip_prefix("correct / %, real: "))
        .collect();
    assert_eq!(
        of_dependent,
        [
            "P01 is left out: no data at foam.",
            "P02 is left out: no data in 4 of 5 cells.",
            "P03 is left out: no data."
        ]
    );
}

#[test]
fn participants_of_one_part_who_lack_cells_are_named() {
    let mut task = data::identification(6, 0.5);
    for (person, participant) in task.participants.iter_mut().enumerate() {
        let part = if person < 3 { "real" } else { "simulated" };
        participant.trials.retain(|trial| trial.record.part == part);
    }
    for person in [1, 4] {
        let trials = &mut task.participants[person].trials;
        trials.retain(|trial| trial.record.expected.as_deref() != Some("foam"));
    }
    let analysis = of_task(&task);
    let table = analysis.table("anova-split-plot");
    let row = ["correct / %", "part (between participants)"];
    assert_eq!((table.number(&row, "n"), table.number(&row, "left out")), (4.0, 2.0));
    let sentence = "correct / %: P01, P04 left out: no data in some cells of their part.";
    assert!(analysis.warnings("anova-split-plot").contains(&sentence));
}

#[test]
fn trials_that_a_table_cannot_use_are_counted_by_participant() {
    let unanswered = |task: &mut Task| {
        each_trial(task, |number, trial| {
            if number == 1 && trial.record.trial <= 2 {
                trial.record.answer = None;
                trial.record.is_correct = None;
            }
        });
    };
    let tasks = [
        (data::localisation(2, 0.4), "pairs", "trials with two materials and no scored answer"),
        (
            data::localisation(2, 0.4),
            "oddity",
            "trials without a scored answer, or without three materials of which one differs",
        ),
        (
            data::identification(2, 0.4),
            "confusion",
            "trials without an answer, or a correct answer, that is one of the words",
        ),
        (
            data::same_or_different(2),
            "same-different",
            "trials without the answer same or different",
        ),
        (
            data::referral(2),
            "magnitudes",
            "trials without an answer with a number for each station",
        ),
        (
            data::thresholds(2, 0.3),
            "staircase",
            "trials of staircases without a level or a scored answer",
        ),
        (
            data::thresholds(2, 0.3),
            "psychometric-fit",
            "trials without a positive level or without a scored answer",
        ),
    ];
    for (mut task, section, what) in tasks {
        assert!(!of_task(&task).warnings(section).iter().any(|one| one.starts_with("Left out")));
        unanswered(&mut task);
        let sentence = format!("Left out: {what}: 2 (P01: 2).");
        let analysis = of_task(&task);
        assert!(
            analysis.warnings(section).contains(&&*sentence),
            "{:?}",
            analysis.warnings(section)
        );
    }
}

#[test]
fn contacts_without_a_measure_are_counted_by_participant() {
    let folder = Folder::new("contacts");
    let mut task = data::falls(2, &folder.0);
    each_trial(&mut task, |number, trial| {
        if number == 1 && trial.record.trial <= 2 {
            trial.record.stations[0].skin_fall_k = None;
        }
    });
    // The telemetry of both participants ends in the middle of a line.
    let lines = ["P00", "P01"]
        .map(|code| format!("Left out: damaged lines of the telemetry of {code}: 1."));
    let analysis = of_task(&task);
    let sentence =
        "Left out: contacts of a finger with a skin thermistor, without a fall: 2 (P01: 2).";
    assert_eq!(analysis.warnings("falls"), [sentence]);
    assert_eq!(analysis.warnings("exponential-fit"), lines);

    let mut task = data::forces(2, &folder.0);
    each_trial(&mut task, |number, trial| {
        let station = &mut trial.record.stations[0];
        match (number, trial.record.trial) {
            (0, 3) => station.force_mean_n = None,
            (1, 4 | 5) => station.force_end_mean_n = None,
            _ => {}
        }
    });
    let path = &task.participants[0].telemetry;
    let text = std::fs::read_to_string(path).expect("telemetry");
    // The first contact, from 35 s to 45 s.
    let is_first = |line: &&str| {
        let t_s = line.split(',').next().and_then(|word| word.parse::<f64>().ok());
        t_s.is_some_and(|t_s| t_s < 45.0)
    };
    let kept = text.lines().filter(|line| !is_first(line)).map(|line| format!("{line}\n"));
    let kept: String = kept.collect();
    std::fs::write(path, kept).expect("telemetry");
    std::fs::write(&task.participants[1].telemetry, "t_s,finger,skin_c\n").expect("telemetry");
    let analysis = of_task(&task);
    assert_eq!(
        analysis.warnings("force-matching"),
        [
            "Left out: contacts with a target force and no measured force: 1 (P00: 1).",
            "Left out: contacts too short for a force of the last 2 s, of which the other columns are: 2 (P01: 2).",
            "Left out: contacts without telemetry of force_n in the mean courses: 1 (P00: 1).",
        ]
    );
    let unread = "Courses: telemetry of P01 (it has no columns t_s, finger and force_n)";
    assert!(analysis.not_possible().contains(&unread), "{:?}", analysis.not_possible());
}

#[test]
fn pairs_that_only_one_experiment_has_are_named() {
    let mut task =
        task("pairs", &["left", "right"], &["left", "right"], &["pairs", "chi-squared-against"]);
    let of = |(index, (one, other)): (usize, &(&str, &str))| {
        trial(index as u32 + 1, "main", vec![sample(one), display(0, other)], "left", Some("left"))
    };
    let pairs = [("copper", "bronze"), ("copper", "zns"), ("copper", "abs")];
    task.participants.push(participant("P1", pairs.iter().enumerate().map(of).collect()));
    let analysis = of_task(&task);
    let warnings = analysis.warnings("chi-squared-against");
    assert!(warnings.contains(&"Left out, not in Table 3-3: copper / zns."), "{warnings:?}");
    let unanswered =
        warnings.iter().find(|one| one.starts_with("Left out, without answers here: "));
    let names: Vec<_> = unanswered.expect("a warning").split(", ").skip(1).collect();
    assert!(names.contains(&"bronze / abs") && names.len() == 13, "{names:?}");
}

#[test]
fn levels_and_trials_without_a_counted_attempt_and_remarks_are_named() {
    let mut task = data::real_and_simulated(2, 0.4);
    task.planned_levels = vec![("real".into(), "foam".into()), ("real".into(), "copper".into())];
    let person = &mut task.participants[1];
    person.trials.retain(|trial| trial.record.trial != 7);
    person.remarks.push("session.toml: changed after the recording".into());
    task.mixed = Some("1 simulated participant(s) were left out (S1)".into());
    let analysis = of_task(&task);
    assert_eq!(
        analysis.warnings("participants"),
        [
            "1 simulated participant(s) were left out (S1)",
            "Left out: trials of P01 of which each attempt was void (7).",
            "session.toml: changed after the recording",
            "No trial with real foam counts, so it is in no table.",
        ]
    );
}

#[test]
fn telemetry_that_is_not_there_is_said() {
    let folder = Folder::new("no-telemetry");
    let mut task = data::falls(2, &folder.0);
    task.participants[1].telemetry = Path::new("no such file").into();
    let sentences = of_task(&task);
    let said = |sentence: &&str| sentence.starts_with("Courses: telemetry of P01 (");
    assert!(sentences.not_possible().iter().any(said));
}
