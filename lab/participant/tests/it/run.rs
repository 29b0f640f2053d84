//! Runs sessions.

use std::fs;
use std::path::{Path, PathBuf};

use thermal_client::client::Client;
use thermal_participant::{Bench, BenchOptions, Observation};
use thermal_session::dataset::Recorder;
use thermal_session::record::TrialRecord;
use thermal_session::{Executor, Plan, Schedule, Session};

/// A session of the laboratory with lines replaced.
pub fn session(file: &str, replaced: &[(&str, &str)]) -> Session {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../sessions").join(file);
    let mut text = fs::read_to_string(&path).expect("the session file");
    for (from, to) in replaced {
        assert!(text.contains(from), "{file} has no {from}");
        text = text.replace(from, to);
    }
    Session::parse(&text, &path).expect("a valid session")
}

/// What a run has left.
pub struct Ran {
    /// Records of all attempts.
    pub records: Vec<TrialRecord>,
    /// What was felt.
    pub observations: Vec<Observation>,
}

impl Ran {
    /// Proportion of the trials with a correct answer that were answered correctly.
    pub fn correct(&self) -> (usize, usize) {
        let judged = self.records.iter().filter_map(|record| record.is_correct);
        let (mut correct, mut all) = (0, 0);
        for is_correct in judged {
            correct += usize::from(is_correct);
            all += 1;
        }
        (correct, all)
    }
}

/// A new folder for the data of a test.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).expect("the old folder can be removed");
    }
    folder
}

/// Runs a session, with the plan cut to its first trials.
pub fn run(name: &str, session: &Session, options: BenchOptions, trials: usize) -> Ran {
    let (code, seed) = ("01", 1);
    let mut plan = Plan::new(session, code, seed).expect("a plan");
    plan.trials.truncate(trials);
    let bench = Bench::new(session, &plan, code, seed, options).expect("a bench");
    let mut recorder =
        Recorder::create(&folder(name), session, &plan, (code, seed), true).expect("a recorder");
    let mut people = bench.people();
    let executor = Executor::new(session, Client::new(bench.link()), &mut people, &mut recorder);
    executor.run(&plan, Schedule::new(session, &plan)).expect("the session ends by itself");
    Ran { records: recorder.records().to_vec(), observations: bench.observations() }
}

/// The class values, which are those of a tile that was never identified.
#[test]
fn a_device_that_was_never_tuned_presents_no_session() {
    let (session, code, seed) = (session("p5-real-and-simulated.toml", &[]), "01", 1);
    let plan = Plan::new(&session, code, seed).expect("a plan");
    let bench = Bench::new(&session, &plan, code, seed, BenchOptions::default()).expect("a bench");
    let untuned = "set tile 2.957 0.0585 0.103 0.1 0.016";
    let answer = Client::new(bench.link()).query(untuned).expect("an answer");
    assert_eq!(answer, "ok");
    let name = folder("never-tuned");
    let mut recorder =
        Recorder::create(&name, &session, &plan, (code, seed), true).expect("a recorder");
    let mut people = bench.people();
    let executor = Executor::new(&session, Client::new(bench.link()), &mut people, &mut recorder);
    let end = executor.run(&plan, Schedule::new(&session, &plan)).expect_err("an untuned tile");
    assert!(end.to_string().contains("never tuned"), "{end}");
}
