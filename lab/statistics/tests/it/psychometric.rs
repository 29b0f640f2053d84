//! Fits of psychometric functions to simulated answers.

use experiment_statistics::StatisticsError;
use experiment_statistics::proportion::Proportion;
use experiment_statistics::psychometric::{Level, Model, Shape};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

const LEVELS: [f64; 5] = [0.3, 0.6, 1.0, 1.6, 2.5];

fn level(level: f64, correct: u32, total: u32) -> Level {
    let answers = Proportion::new(correct, total).expect("a proportion");
    Level { level, answers }
}

/// 2AFC with a Weibull function of location 1 and exponent 1.5.
fn model(lapse: f64) -> Model {
    Model { shape: Shape::Weibull, guess: 0.5, lapse }
}

fn simulated(lapse: f64, total: u32, random: &mut Xoshiro256PlusPlus) -> Vec<Level> {
    let of_level = |x: f64| {
        let p = 0.5 + (0.5 - lapse) * (1.0 - (-x.powf(1.5)).exp());
        let correct = (0..total).filter(|_| random.random::<f64>() < p).count();
        level(x, correct as u32, total)
    };
    LEVELS.map(of_level).to_vec()
}

#[test]
fn intervals_from_the_standard_error_and_the_bootstrap_contain_the_truth_as_often_as_they_say() {
    const EXPERIMENTS: u32 = 100;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    // At this proportion the level is 1.
    let proportion = 0.5 + 0.5 * (1.0 - (-1f64).exp());
    let (mut by_error, mut by_bootstrap) = (0, 0);
    for experiment in 0..EXPERIMENTS {
        let levels = simulated(0.0, 60, &mut random);
        let fit = model(0.0).fit(&levels).expect("a fit");
        let threshold = fit.threshold(proportion).expect("a threshold");
        by_error += u32::from((threshold.level - 1.0).abs() < 1.96 * threshold.standard_error);
        let seed = u64::from(experiment);
        let bootstrap = fit.bootstrap(&levels, proportion, 0.95, 200, seed).expect("a bootstrap");
        let interval = bootstrap.interval;
        by_bootstrap += u32::from(interval.low < 1.0 && 1.0 < interval.high);
        let ratio = bootstrap.standard_error / threshold.standard_error;
        assert!((0.5..2.0).contains(&ratio), "standard errors differ by {ratio}");
    }
    println!("of {EXPERIMENTS}: {by_error} by standard error, {by_bootstrap} by bootstrap");
    assert!(by_error >= 88 && by_bootstrap >= 88);
}

#[test]
fn the_same_seed_gives_the_same_bootstrap() {
    let levels = simulated(0.0, 60, &mut Xoshiro256PlusPlus::seed_from_u64(4));
    let fit = model(0.0).fit(&levels).expect("a fit");
    let bootstrap = |seed| fit.bootstrap(&levels, 0.75, 0.95, 100, seed).expect("a bootstrap");
    assert_eq!(bootstrap(1), bootstrap(1));
    assert_ne!(bootstrap(1), bootstrap(2));
}

#[test]
fn no_other_parameters_are_more_likely() {
    let levels = simulated(0.0, 40, &mut Xoshiro256PlusPlus::seed_from_u64(5));
    let fit = model(0.0).fit(&levels).expect("a fit");
    let likelihood = |location: f64, slope: f64| -> f64 {
        let of_level = |level: &Level| {
            let p = 1.0 - 0.5 * (-(level.level / location).powf(slope)).exp();
            let correct = f64::from(level.answers.correct());
            correct * p.ln() + (f64::from(level.answers.total()) - correct) * (1.0 - p).ln()
        };
        levels.iter().map(of_level).sum()
    };
    assert!((likelihood(fit.location, fit.slope) - fit.log_likelihood).abs() < 1e-9);
    for factor in [1.0 - 1e-4, 1.0 + 1e-4] {
        assert!(likelihood(fit.location * factor, fit.slope) < fit.log_likelihood);
        assert!(likelihood(fit.location, fit.slope * factor) < fit.log_likelihood);
    }
}

/// Of very many answers, so that chance is small.
#[test]
fn a_fitted_lapse_rate_is_that_of_the_answers() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(6);
    for lapse in [0.0, 0.03] {
        let levels = simulated(lapse, 20_000, &mut random);
        let fit = model(0.5).fit_with_lapse(&levels, 0.1).expect("a fit");
        assert!((fit.model.lapse - lapse).abs() < 0.005, "{lapse}: {fit:?}");
        assert!((fit.location - 1.0).abs() < 0.03 && (fit.slope - 1.5).abs() < 0.1, "{fit:?}");
        assert!(fit.deviance_p.expect("more than two levels") > 1e-3);
    }
}

#[test]
fn a_proportion_in_parts_gives_the_fit_of_the_whole() {
    let whole = [level(1.0, 24, 40), level(2.0, 30, 40), level(3.0, 38, 40)];
    let parts = [
        level(3.0, 20, 21),
        level(1.0, 14, 20),
        level(1.0, 10, 20),
        level(2.0, 30, 40),
        level(3.0, 18, 19),
    ];
    let fit = |levels: &[Level]| model(0.0).fit(levels).expect("a fit");
    assert_eq!(fit(&whole), fit(&parts));
}

#[test]
fn answers_that_determine_no_rising_function_are_refused() {
    let not_determined = StatisticsError::NotDetermined { what: "the slope" };
    let falling = [level(1.0, 38, 40), level(2.0, 30, 40), level(3.0, 22, 40)];
    let step = [level(1.0, 0, 40), level(2.0, 0, 40), level(3.0, 40, 40)];
    let perfect = [level(1.0, 40, 40), level(2.0, 40, 40)];
    for levels in [&falling[..], &step, &perfect] {
        for shape in [Shape::Weibull, Shape::CumulativeNormal] {
            let model = Model { shape, guess: 0.0, lapse: 0.0 };
            assert_eq!(model.fit(levels), Err(not_determined.clone()), "{levels:?}");
        }
    }
    assert!(model(0.0).fit(&[level(1.0, 30, 40)]).is_err(), "one level");
    assert!(model(0.0).fit(&[level(0.0, 30, 40), level(1.0, 35, 40)]).is_err(), "no logarithm");
    assert!(model(0.5).fit(&falling).is_err(), "guess and lapse leave nothing");
    let fit = model(0.02).fit(&[level(1.0, 24, 40), level(2.0, 35, 40)]).expect("a fit");
    assert!(fit.threshold(0.5).is_err() && fit.threshold(0.98).is_err());
    assert_eq!(fit.deviance_p, None);
}
