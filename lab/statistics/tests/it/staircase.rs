//! The staircase as a session drives it.

use experiment_statistics::StatisticsError;
use experiment_statistics::distribution::normal_cdf;
use experiment_statistics::staircase::{Staircase, StaircaseRule};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

fn rule(correct_to_fall: u32) -> StaircaseRule {
    StaircaseRule {
        start: 8.0,
        least: 1e-3,
        most: 100.0,
        correct_to_fall,
        factor: 1.1,
        coarse_factor: 2.0,
        coarse_reversals: 2,
        reversals: 14,
        averaged: 12,
        trials_max: 1000,
    }
}

fn new(rule: StaircaseRule) -> Staircase {
    Staircase::new(rule).expect("a rule")
}

/// Proportion correct of the simulated observer: 2AFC, no lapses.
fn proportion(level: f64) -> f64 {
    0.5 + 0.5 * normal_cdf(2.0 * level.ln())
}

/// Proportion correct of the observer at the mean logarithm of the threshold of many runs of so many reversals, of which all
/// but the first fifth are averaged.
fn converges_to(correct_to_fall: u32, reversals: usize) -> f64 {
    const RUNS: u32 = 400;
    let rule = StaircaseRule {
        reversals,
        averaged: reversals - reversals / 5,
        trials_max: u32::MAX,
        ..rule(correct_to_fall)
    };
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    let of_run = |_| {
        let mut staircase = new(rule);
        while !staircase.is_finished() {
            let correct = random.random::<f64>() < proportion(staircase.level());
            staircase.answered(correct);
        }
        staircase.threshold().expect("enough reversals").ln()
    };
    let logarithms: f64 = (0..RUNS).map(of_run).sum();
    proportion((logarithms / f64::from(RUNS)).exp())
}

/// The level is left in either direction equally often where `p^n = 1/2`. A short run still remembers its start.
#[test]
fn two_down_converges_to_70_7_percent_and_three_down_to_79_4() {
    for (correct_to_fall, exact) in [(2, 0.5f64.sqrt()), (3, 0.5f64.cbrt())] {
        let [short, long] = [15, 200].map(|reversals| converges_to(correct_to_fall, reversals));
        println!(
            "{correct_to_fall} down: {:.1} % correct after 15 reversals, {:.1} % after 200, for {:.1} %",
            100.0 * short,
            100.0 * long,
            100.0 * exact
        );
        assert!((long - exact).abs() < 0.01, "{correct_to_fall}: {long}");
    }
}

#[test]
fn levels_follow_the_answers() {
    let mut staircase = new(rule(2));
    let mut levels = vec![staircase.level()];
    for correct in [true, true, true, true, false, true, false, true, true, true, false] {
        staircase.answered(correct);
        levels.push(staircase.level());
    }
    // Twice down by 2, up at the first reversal, up once more, down at the second reversal by the fine factor, then one
    // correct answer, which a wrong one forgets.
    let expected = [8.0, 8.0, 4.0, 4.0, 2.0, 4.0, 4.0, 8.0, 8.0, 8.0 / 1.1, 8.0 / 1.1, 8.0];
    for (i, (level, expected)) in levels.iter().zip(expected).enumerate() {
        assert!((level / expected - 1.0).abs() < 1e-12, "{i}: {levels:?}");
    }
    let reversals = staircase.reversals();
    assert_eq!(reversals.len(), 3);
    assert!((reversals[2] - 8.0 / 1.1).abs() < 1e-12);
    assert_eq!((reversals[0], reversals[1]), (2.0, 8.0));
    assert_eq!(staircase.trials(), 11);
    assert_eq!((staircase.is_finished(), staircase.threshold()), (false, None));
}

#[test]
fn the_threshold_is_the_geometric_mean_of_the_last_reversals() {
    let mut staircase = new(StaircaseRule {
        factor: 2.0,
        reversals: 4,
        averaged: 2,
        coarse_reversals: 0,
        ..rule(1)
    });
    // Reversals at 4, 8, 4 and 8.
    for correct in [true, false, true, false, true] {
        assert!(!staircase.is_finished());
        staircase.answered(correct);
    }
    assert_eq!(staircase.reversals(), [4.0, 8.0, 4.0, 8.0]);
    assert!(staircase.is_finished());
    let threshold = staircase.threshold().expect("enough reversals");
    assert!((threshold - 32f64.sqrt()).abs() < 1e-12);
}

#[test]
fn answers_after_the_end_change_nothing() {
    let mut staircase = new(StaircaseRule { trials_max: 3, ..rule(2) });
    for _ in 0..3 {
        staircase.answered(true);
    }
    let ended = staircase.clone();
    staircase.answered(false);
    assert_eq!(staircase, ended);
    assert_eq!((ended.is_finished(), ended.threshold()), (true, None));
}

#[test]
fn levels_stay_within_their_limits() {
    let limits = StaircaseRule { least: 3.0, most: 10.0, ..rule(1) };
    for (answer, end) in [(true, 3.0), (false, 10.0)] {
        let mut staircase = new(limits);
        for _ in 0..20 {
            staircase.answered(answer);
        }
        assert_eq!(staircase.level(), end);
        assert!(staircase.reversals().is_empty(), "an end is no reversal");
    }
}

#[test]
fn the_same_answers_lead_to_the_same_levels() {
    let mut one = new(rule(2));
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut copies = Vec::new();
    let answers: Vec<bool> = (0..40).map(|_| random.random::<f64>() < 0.7).collect();
    for &answer in &answers {
        copies.push(one.clone());
        one.answered(answer);
    }
    // A copy from any trial goes on as the first did.
    for (i, mut copy) in copies.into_iter().enumerate() {
        answers[i..].iter().for_each(|&answer| copy.answered(answer));
        assert_eq!(copy, one);
    }
}

#[test]
fn a_wrong_rule_is_refused() {
    let wrong = [
        StaircaseRule { start: f64::NAN, ..rule(2) },
        StaircaseRule { start: 200.0, ..rule(2) },
        StaircaseRule { least: 0.0, ..rule(2) },
        StaircaseRule { most: f64::INFINITY, ..rule(2) },
        StaircaseRule { factor: 1.0, ..rule(2) },
        StaircaseRule { coarse_factor: f64::INFINITY, ..rule(2) },
        StaircaseRule { averaged: 0, ..rule(2) },
        StaircaseRule { averaged: 13, ..rule(2) },
        StaircaseRule { trials_max: 0, ..rule(2) },
        rule(0),
    ];
    for rule in wrong {
        let refused = Staircase::new(rule);
        assert!(matches!(refused, Err(StatisticsError::OutOfRange { .. })), "{rule:?}");
    }
}
