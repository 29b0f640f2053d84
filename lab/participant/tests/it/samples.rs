//! Sessions on samples of real materials.

use std::time::Instant;

use contact_model::material::find;
use thermal_participant::{Bench, BenchOptions, HandParams, ObserverParams};
use thermal_session::{PlannedTrial, Response};

use crate::driver::{plan, run_samples, sample_trial, session, touch_samples};

const MATERIALS: [&str; 6] = ["copper", "bronze", "stainless-steel", "g10", "abs", "foam"];

/// All ordered pairs.
fn pairs() -> Vec<PlannedTrial> {
    let ordered = MATERIALS
        .iter()
        .flat_map(|left| MATERIALS.iter().map(move |right| (left, right)));
    (1..)
        .zip(ordered)
        .map(|(number, (left, right))| sample_trial(number, &[left, right]))
        .collect()
}

#[test]
fn speed() {
    let plan = plan(pairs());
    let session = session(&["left", "right"], &["left", "right"]);
    let begin = Instant::now();
    let bench = Bench::new(&session, &plan, "P01", 1, BenchOptions::default()).expect("a bench");
    let observations = run_samples(&bench, &plan);
    let s = begin.elapsed().as_secs_f64();
    println!("{} trials in {s} s", observations.len());
    for o in observations.iter().take(12) {
        println!("{o:?}");
    }
    let _ = (find("copper"), HandParams::STEADY, ObserverParams::NOISE_FREE);
    let _: Option<Response> = touch_samples(&bench, &plan.trials[0], 2, 3);
}
