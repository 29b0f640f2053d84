//! Sessions on samples of real materials.

use thermal_participant::{BenchOptions, HandParams, ObserverParams};

use crate::run::{run, session};

#[test]
fn an_observer_without_noise_is_always_right() {
    let options = BenchOptions {
        observer: Some(ObserverParams::NOISE_FREE),
        hand: HandParams::STEADY,
        ..BenchOptions::default()
    };
    for file in ["p1-discrimination.toml", "p3-localisation.toml"] {
        let ran = run(&format!("noise-free-{file}"), &session(file, &[]), options.clone(), 1000);
        let (correct, all) = ran.correct();
        assert_eq!(correct, all, "{file}");
        assert!(all >= 60, "{file}: {all}");
        assert!(ran.records.iter().all(|record| record.void.is_none()));
    }
}

#[test]
fn a_random_observer_is_at_chance() {
    let options =
        BenchOptions { observer: Some(ObserverParams::RANDOM), ..BenchOptions::default() };
    for (file, chance) in [("p1-discrimination.toml", 0.5), ("p3-localisation.toml", 1.0 / 3.0)] {
        let ran = run(&format!("random-{file}"), &session(file, &[]), options.clone(), 1000);
        let (correct, all) = ran.correct();
        // 3.3 standard deviations: 99.9 % of a binomial distribution of this many trials.
        let expected = chance * all as f64;
        let sd = (expected * (1.0 - chance)).sqrt();
        let off = (correct as f64 - expected).abs();
        assert!(off <= 3.3 * sd + 0.5, "{file}: {correct} of {all}");
    }
}
