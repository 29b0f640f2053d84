use experiment_statistics::proportion::Proportion;
use experiment_statistics::psychometric::{Level, Model, Shape};
use experiment_statistics::staircase::{Staircase, StaircaseRule};

use super::*;

fn streams() -> (Stream, Stream) {
    (Stream::new(1, "noise"), Stream::new(1, "lapse"))
}

fn judge(task: &Task, falls_k: &[f64], params: &ObserverParams) -> Option<Judgement> {
    let falls_k: Vec<Option<f64>> = falls_k.iter().copied().map(Some).collect();
    let (mut noise, mut lapses) = streams();
    task.judge(&falls_k, params, &mut noise, &mut lapses)
}

#[test]
fn each_task_has_its_rule() {
    let clear = &ObserverParams::NOISE_FREE;
    for (task, falls_k, choice) in [
        (Task::Extreme(Sensation::Cold, vec![0, 1]), vec![1.0, 1.1], 1),
        // The answers may be in another order than the stations.
        (Task::Extreme(Sensation::Cold, vec![1, 0]), vec![1.0, 1.1], 0),
        // The one that has lost less heat is the warmer one, whether the skin fell or rose.
        (Task::Extreme(Sensation::Warm, vec![0, 1]), vec![1.0, 1.1], 0),
        (Task::Extreme(Sensation::Warm, vec![0, 1]), vec![-1.0, -1.1], 1),
        (Task::Different(vec![0, 1, 2]), vec![1.0, 1.0, 0.9], 2),
        (Task::Different(vec![0, 1, 2]), vec![1.3, 1.0, 1.0], 0),
        (Task::Identify(vec![3.0, 1.0]), vec![1.8], 1),
        (Task::Same(0, 1), vec![1.0, 1.0], 0),
        (Task::Same(0, 1), vec![1.0, 1.01], 1),
        (Task::Interval(Some(1.0)), vec![0.2, -0.5], 0),
        (Task::Interval(Some(-1.0)), vec![0.2, -0.5], 1),
        (Task::Interval(None), vec![0.2, -0.5], 1),
    ] {
        assert_eq!(
            judge(&task, &falls_k, clear),
            Some(Judgement::Choice(choice)),
            "{task:?} {falls_k:?}"
        );
    }
    assert_eq!(
        judge(&Task::Magnitude(Sensation::Cold, 0.0, 100.0), &[0.0, 4.0, 9.0, -1.0], clear),
        Some(Judgement::Numbers(vec![0.0, 50.0, 100.0, 0.0]))
    );
    assert_eq!(
        judge(&Task::Magnitude(Sensation::Warm, 0.0, 100.0), &[0.0, -4.0, -9.0, 1.0], clear),
        Some(Judgement::Numbers(vec![0.0, 50.0, 100.0, 0.0]))
    );
}

#[test]
fn a_question_names_what_it_asks_for() {
    for (question, named) in [
        ("Which hand felt the colder material?", &[Sensation::Cold][..]),
        ("How cool?", &[Sensation::Cold]),
        ("Which is WARMER?", &[Sensation::Warm]),
        ("How hot did it get?", &[Sensation::Warm]),
        ("Which one was it: colder or warmer?", &[Sensation::Cold, Sensation::Warm]),
        ("Which photo, shot or scold?", &[]),
    ] {
        assert_eq!(Sensation::named(question), named, "{question}");
    }
}

#[test]
fn what_was_not_felt_is_not_judged() {
    let (mut noise, mut lapses) = streams();
    let params = &ObserverParams::NOISE_FREE;
    let task = Task::Extreme(Sensation::Cold, vec![0, 1]);
    assert_eq!(task.judge(&[None, Some(1.0)], params, &mut noise, &mut lapses), None);
    let random = &ObserverParams::RANDOM;
    assert_eq!(task.judge(&[None, None], random, &mut noise, &mut lapses), None);
}

#[test]
fn noise_grows_with_the_fall() {
    let touch = ObserverParams::TOUCH;
    assert_eq!(touch.sigma_k(0.0), touch.s0_k);
    assert!((touch.sigma_k(100.0) / 100.0 - touch.w).abs() < 1e-3);
}

#[test]
fn draws_agree_with_the_closed_form() {
    const DRAWS: u32 = 20_000;
    let (mut noise, mut lapses) = streams();
    let params = &ObserverParams::TOUCH;
    let mut share = |task: &Task, falls_k: &[Option<f64>]| {
        let is_first = |_: &u32| {
            task.judge(falls_k, params, &mut noise, &mut lapses) == Some(Judgement::Choice(0))
        };
        f64::from((0..DRAWS).filter(is_first).count() as u32) / f64::from(DRAWS)
    };
    let colder = share(&Task::Extreme(Sensation::Cold, vec![0, 1]), &[Some(4.0), Some(3.0)]);
    let different = share(&Task::Different(vec![0, 1, 2]), &[Some(4.0), Some(1.0), Some(1.0)]);
    let expected_k = vec![4.0, 1.0, 0.2];
    let identified = share(&Task::Identify(expected_k.clone()), &[Some(4.0)]);
    use crate::predictions::closed_form;
    for (drawn, exact) in [
        (colder, closed_form::colder(params, [4.0, 3.0])),
        (different, closed_form::different(params, 4.0, 1.0)),
        (identified, closed_form::identified(params, 4.0, &expected_k)[0]),
    ] {
        // Three and a half standard deviations of this many draws.
        assert!((drawn - exact).abs() < 0.0125, "{drawn}, {exact}");
    }
}

#[test]
fn a_fall_is_the_largest_one_since_the_landing() {
    let mut meter = FallMeter::default();
    for _ in 0..1000 {
        meter.push([33.0, 33.5]);
    }
    assert_eq!(meter.fall_k(), None);
    meter.begin();
    for (cold_c, ms) in [(31.0, 400), (32.5, 400)] {
        for _ in 0..ms {
            meter.push([cold_c, 33.0]);
        }
    }
    let fall_k = meter.fall_k().expect("a fall");
    assert!((fall_k - 2.0).abs() < 1e-9, "{fall_k}");
}

#[test]
fn a_short_dip_is_averaged() {
    let mut meter = FallMeter::default();
    for _ in 0..1000 {
        meter.push([33.0, 33.0]);
    }
    meter.begin();
    for ms in 0..1000 {
        meter.push([if ms < 100 { 31.0 } else { 33.0 }, 33.0]);
    }
    let fall_k = meter.fall_k().expect("a fall");
    assert!((fall_k - 1.0).abs() < 1e-9, "{fall_k}");
}

#[test]
fn warming_is_a_negative_fall_at_the_warm_receptors() {
    let mut meter = FallMeter::default();
    for _ in 0..1000 {
        meter.push([33.0, 33.2]);
    }
    meter.begin();
    for _ in 0..1000 {
        meter.push([34.0, 33.9]);
    }
    let fall_k = meter.fall_k().expect("a fall");
    assert!((fall_k + 0.7).abs() < 1e-9, "{fall_k}");
}

/// Falls of P9 per kelvin of the level, as `tests/it/thresholds.rs` finds them: of the change, and of the second interval after
/// it.
const FALLS_OF_P9: [[f64; 2]; 2] = [[0.556, -0.118], [-0.321, 0.112]];

/// Probability that the change is the larger one of two felt with independent normal noise, whatever their signs: with sum and
/// difference, whose noise is independent, it is that of a positive product.
fn larger(changed_k: f64, other_k: f64, sigma_k: f64) -> f64 {
    let phi = |z: f64| 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
    let scaled = |k: f64| k / (std::f64::consts::SQRT_2 * sigma_k);
    let (sum, difference) = (phi(scaled(changed_k + other_k)), phi(scaled(changed_k - other_k)));
    sum * difference + (1.0 - sum) * (1.0 - difference)
}

/// Probability of a correct answer at a level, the change being in either interval equally often.
fn correct_of_p9([changed, after]: [f64; 2], level_k: f64) -> f64 {
    let ObserverParams { s0_k, lapse, .. } = ObserverParams::THERMODE_FINGERTIP;
    let first = larger(changed * level_k, after * level_k, s0_k);
    let second = larger(changed * level_k, 0.0, s0_k);
    0.5 * lapse + (1.0 - lapse) * 0.5 * (first + second)
}

/// The level at which this part of the answers is correct.
fn level_of_p9(falls: [f64; 2], part: f64) -> f64 {
    let (mut low, mut high) = (0.01, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if correct_of_p9(falls, middle) < part {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Many staircases of P9, and the function that is fitted to all their answers: both come to what noise and falls imply,
/// which is not the 0.14 K of the observer, because skin and rebound stand between.
#[test]
fn staircase_and_fitted_function_find_the_threshold_that_the_noise_implies() {
    const STAIRCASES: u32 = 400;
    let params = &ObserverParams::THERMODE_FINGERTIP;
    let mut noise = Stream::new(2, "noise");
    let mut lapses = Stream::new(2, "lapse");
    let mut sides = Stream::new(2, "side");
    for falls in FALLS_OF_P9 {
        let [changed, after] = falls;
        let mut logarithms = 0.0;
        let mut counts: Vec<(f64, u32, u32)> = Vec::new();
        for _ in 0..STAIRCASES {
            let mut staircase = Staircase::new(StaircaseRule {
                start: 1.0,
                least: 1e-3,
                most: 2.0,
                correct_to_fall: 2,
                factor: 1.41,
                coarse_factor: 1.41,
                coarse_reversals: 0,
                // Longer than those of P9, which remember their start.
                reversals: 24,
                averaged: 16,
                trials_max: 400,
            })
            .expect("a rule");
            while !staircase.is_finished() {
                let level_k = staircase.level();
                let is_second = sides.index(2) == 1;
                let felt_k = if is_second {
                    [0.0, changed * level_k]
                } else {
                    [changed * level_k, after * level_k]
                };
                let judged =
                    Task::Interval(None).judge(&felt_k.map(Some), params, &mut noise, &mut lapses);
                let is_correct = judged == Some(Judgement::Choice(usize::from(is_second)));
                staircase.answered(is_correct);
                let known =
                    counts.iter().position(|(known, ..)| (known / level_k - 1.0).abs() < 1e-6);
                let at = known.unwrap_or_else(|| {
                    counts.push((level_k, 0, 0));
                    counts.len() - 1
                });
                counts[at].1 += u32::from(is_correct);
                counts[at].2 += 1;
            }
            logarithms += libm::log(staircase.threshold().expect("a threshold"));
        }
        let found_k = libm::exp(logarithms / f64::from(STAIRCASES));
        // The mean of reversals lies a quarter of a step, of a factor of 1.41, below the point of convergence.
        let expected_k =
            level_of_p9(falls, std::f64::consts::FRAC_1_SQRT_2) * libm::pow(1.41, -0.25);
        assert!(
            (found_k / expected_k - 1.0).abs() < 0.04,
            "staircases {found_k}, expected {expected_k}"
        );

        let levels: Vec<Level> = counts
            .iter()
            .map(|(level, correct, total)| Level {
                level: *level,
                answers: Proportion::new(*correct, *total).expect("a proportion"),
            })
            .collect();
        let model = Model { shape: Shape::Weibull, guess: 0.5, lapse: 0.0 };
        let fit = model.fit_with_lapse(&levels, 0.06).expect("a fit");
        let found_k = fit.threshold(0.75).expect("a threshold").level;
        let expected_k = level_of_p9(falls, 0.75);
        assert!(
            (found_k / expected_k - 1.0).abs() < 0.04,
            "function {found_k}, expected {expected_k}"
        );
    }
}
