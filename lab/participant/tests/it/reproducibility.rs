//! Everything in a trial is a function of session, participant, seed, trial and attempt.

use thermal_client::client::Client;
use thermal_participant::{Bench, BenchOptions};
use thermal_session::Executor;
use thermal_session::dataset::Recorder;
use thermal_session::{Plan, Schedule};

use crate::run::{folder, run, session};

#[test]
fn two_runs_feel_the_same_to_the_last_bit() {
    let session = session("p5-real-and-simulated.toml", &[]);
    let runs = ["first", "second"].map(|name| run(name, &session, BenchOptions::default(), 3));
    let [first, second] =
        runs.each_ref().map(|ran| serde_json::to_vec(&ran.observations).expect("serialisable"));
    assert_eq!(first, second);
    assert_eq!(runs[0].records, runs[1].records);
}

#[test]
fn a_trial_alone_is_that_of_the_sequence() {
    for file in ["p1-discrimination.toml", "p5-real-and-simulated.toml"] {
        let session = session(file, &[]);
        let sequence = run(&format!("sequence-{file}"), &session, BenchOptions::default(), 4);
        let (code, seed) = ("01", 1);
        let mut plan = Plan::new(&session, code, seed).expect("a plan");
        plan.trials.truncate(4);
        let bench =
            Bench::new(&session, &plan, code, seed, BenchOptions::default()).expect("a bench");
        let root = folder(&format!("alone-{file}"));
        let mut recorder =
            Recorder::create(&root, &session, &plan, (code, seed), true).expect("a recorder");
        let mut people = bench.people();
        let first_three = &sequence.records[..3];
        let schedule = Schedule::after(&session, &plan, first_three).expect("the same session");
        Executor::new(&session, Client::new(bench.link()), &mut people, &mut recorder)
            .run(&plan, schedule)
            .expect("the session ends by itself");
        assert_eq!(bench.observations(), sequence.observations[3..], "{file}");
    }
}
