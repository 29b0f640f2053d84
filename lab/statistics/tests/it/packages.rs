//! Statistics of random data against what scipy, statsmodels and pingouin compute from them (`data/packages.py`).

use std::sync::LazyLock;

use experiment_statistics::ancova::{Group, ancova};
use experiment_statistics::anova::{
    Effect, contrast_between, contrast_within, one_way, repeated_measures, split_plot, two_within,
};
use experiment_statistics::chi_square::{contingency, goodness_of_fit};
use experiment_statistics::confusion::ConfusionMatrix;
use experiment_statistics::correlation::pearson;
use experiment_statistics::exponential::fit_exponential;
use experiment_statistics::levene::levene;
use experiment_statistics::proportion::{Proportion, criterion};
use experiment_statistics::psychometric::{Level, Model, Shape};
use experiment_statistics::regression::through_origin;
use experiment_statistics::sensitivity::{proportion_correct, proportion_correct_oddity};
use experiment_statistics::studentized_range::studentized_range_tail;
use experiment_statistics::t_test::{one_sample, paired};
use experiment_statistics::tukey::tukey_groups;
use serde::Deserialize;

use crate::Errors;

type Rows = Vec<Vec<f64>>;

#[derive(Deserialize)]
struct Golden {
    one_way: Vec<GoldenOneWay>,
    repeated_measures: Vec<GoldenRepeated>,
    two_within: Vec<GoldenTwoWithin>,
    split_plot: Vec<GoldenSplitPlot>,
    studentized_range: Vec<(f64, u32, f64, f64)>,
    counts: Vec<GoldenCounts>,
    pairs: Vec<GoldenPairs>,
    ancova: Vec<GoldenAncova>,
    exponential: Vec<GoldenExponential>,
    psychometric: Vec<GoldenPsychometric>,
    sensitivity: Vec<(u32, f64, f64)>,
    proportion: Vec<(u32, u32, f64, f64, f64, f64, i64)>,
}

#[derive(Deserialize)]
struct GoldenEffect {
    f: f64,
    p: f64,
    eta: f64,
    df: f64,
    error_df: f64,
    epsilon: Option<f64>,
    corrected_p: Option<f64>,
}

#[derive(Deserialize)]
struct GoldenPair {
    p: f64,
    low: f64,
    high: f64,
}

#[derive(Deserialize)]
struct GoldenOneWay {
    groups: Rows,
    effect: GoldenEffect,
    levene: (f64, f64),
    tukey: Vec<GoldenPair>,
    weights: Vec<f64>,
    contrast: (f64, f64, f64),
}

#[derive(Deserialize)]
struct GoldenRepeated {
    subjects: Rows,
    effect: GoldenEffect,
    sums_of_squares: (f64, f64),
    weights: Vec<f64>,
    contrast: (f64, f64),
}

#[derive(Deserialize)]
struct GoldenTwoWithin {
    subjects: Vec<Rows>,
    effects: [GoldenEffect; 3],
}

#[derive(Deserialize)]
struct GoldenSplitPlot {
    groups: Vec<Rows>,
    effects: [GoldenEffect; 3],
}

#[derive(Deserialize)]
struct GoldenCounts {
    table: Vec<Vec<u32>>,
    independence: (f64, f64, f64),
    proportions: Vec<f64>,
    fit: (f64, f64),
    bits: f64,
}

#[derive(Deserialize)]
struct GoldenPairs {
    x: Vec<f64>,
    y: Vec<f64>,
    pearson: (f64, f64, f64, f64),
    paired: (f64, f64, f64, f64),
    one_sample: (f64, f64),
    origin: (f64, f64, f64),
}

#[derive(Deserialize)]
struct GoldenGroup {
    x: Vec<f64>,
    y: Vec<f64>,
}

#[derive(Deserialize)]
struct GoldenAncova {
    groups: Vec<GoldenGroup>,
    slope: f64,
    factor: GoldenEffect,
    covariate: GoldenEffect,
}

#[derive(Deserialize)]
struct GoldenExponential {
    t: Vec<f64>,
    y: Vec<f64>,
    offset: f64,
    amplitude: f64,
    tau: f64,
    r2: f64,
}

#[derive(Deserialize)]
struct GoldenPsychometric {
    shape: String,
    guess: f64,
    lapse: f64,
    levels: Vec<f64>,
    correct: Vec<u32>,
    total: u32,
    location: f64,
    slope: f64,
    deviance: f64,
    proportion: f64,
    threshold: f64,
    standard_error: f64,
}

static GOLDEN: LazyLock<Golden> = LazyLock::new(|| {
    serde_json::from_str(include_str!("../data/packages.json")).expect("golden values")
});

/// Numbers that follow from sums of squares in closed form.
const EXACT: f64 = 1e-9;

fn add_effect(errors: &mut Errors, effect: &Effect, golden: &GoldenEffect) {
    assert_eq!((effect.df, effect.error_df), (golden.df, golden.error_df));
    errors.add("F", effect.f, golden.f);
    errors.add("p", effect.p, golden.p);
    errors.add("partial eta squared", effect.partial_eta_squared, golden.eta);
    assert_eq!(effect.sphericity.is_some(), golden.epsilon.is_some());
    if let (Some(found), Some(epsilon), Some(p)) =
        (effect.sphericity, golden.epsilon, golden.corrected_p)
    {
        errors.add("epsilon", found.epsilon, epsilon);
        errors.add("corrected p", found.p, p);
    }
}

const BETWEEN: [(&str, f64); 3] = [("F", EXACT), ("p", EXACT), ("partial eta squared", EXACT)];
const WITHIN: [(&str, f64); 5] = [
    ("F", EXACT),
    ("p", EXACT),
    ("partial eta squared", EXACT),
    ("epsilon", EXACT),
    ("corrected p", EXACT),
];

#[test]
fn analyses_between_subjects_meet_those_of_packages() {
    let mut errors = Errors::default();
    let mut others = Errors::default();
    assert_eq!(GOLDEN.one_way.len(), 4);
    for golden in &GOLDEN.one_way {
        let analysis = one_way(&golden.groups).expect("an analysis");
        add_effect(&mut errors, &analysis.effect, &golden.effect);
        let of_variances = levene(&golden.groups).expect("a test").effect;
        others.add("Levene, F", of_variances.f, golden.levene.0);
        others.add("Levene, p", of_variances.p, golden.levene.1);
        let contrast = contrast_between(&golden.groups, &golden.weights).expect("a contrast");
        let (estimate, standard_error, p) = golden.contrast;
        others.add("contrast", contrast.estimate, estimate);
        others.add("contrast, standard error", contrast.standard_error, standard_error);
        others.add("contrast, p", contrast.p, p);

        let tukey = tukey_groups(&golden.groups).expect("a comparison");
        let intervals = tukey.intervals(0.95).expect("intervals");
        assert_eq!(tukey.pairs.len(), golden.tukey.len());
        for ((pair, interval), golden) in tukey.pairs.iter().zip(intervals).zip(&golden.tukey) {
            others.add("Tukey, p", pair.p, golden.p);
            let half = 0.5 * (golden.high - golden.low);
            others.add_relative_to("Tukey, interval", interval.low, golden.low, half);
            others.add_relative_to("Tukey, interval", interval.high, golden.high, half);
        }
    }
    errors.assert(&BETWEEN);
    others.assert(&[
        ("Levene, F", EXACT),
        ("Levene, p", EXACT),
        ("contrast", EXACT),
        ("contrast, standard error", EXACT),
        ("contrast, p", EXACT),
        // Limited by scipy, see the test of its studentized range.
        ("Tukey, p", 1e-8),
        ("Tukey, interval", 1e-8),
    ]);
}

#[test]
fn repeated_measures_meet_those_of_packages() {
    let mut errors = Errors::default();
    let mut others = Errors::default();
    assert_eq!(GOLDEN.repeated_measures.len(), 4);
    for golden in &GOLDEN.repeated_measures {
        let effect = repeated_measures(&golden.subjects).expect("an analysis").effect;
        add_effect(&mut errors, &effect, &golden.effect);
        let (of_effect, of_error) = golden.sums_of_squares;
        others.add("sums of squares", effect.sum_of_squares, of_effect);
        others.add("sums of squares", effect.error_sum_of_squares, of_error);
        let contrast = contrast_within(&golden.subjects, &golden.weights).expect("a contrast");
        others.add("contrast, F", contrast.f, golden.contrast.0);
        others.add("contrast, p", contrast.p, golden.contrast.1);
    }
    errors.assert(&WITHIN);
    others.assert(&[("sums of squares", EXACT), ("contrast, F", EXACT), ("contrast, p", EXACT)]);
}

#[test]
fn two_factors_within_subjects_meet_those_of_packages() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.two_within.len(), 4);
    for golden in &GOLDEN.two_within {
        let found = two_within(&golden.subjects).expect("an analysis");
        for (effect, golden) in [found.a, found.b, found.interaction].iter().zip(&golden.effects) {
            add_effect(&mut errors, effect, golden);
        }
    }
    errors.assert(&WITHIN);
}

#[test]
fn split_plots_meet_those_of_packages() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.split_plot.len(), 3);
    for golden in &GOLDEN.split_plot {
        let found = split_plot(&golden.groups).expect("an analysis");
        let effects = [found.between, found.within, found.interaction];
        for (effect, golden) in effects.iter().zip(&golden.effects) {
            add_effect(&mut errors, effect, golden);
        }
    }
    errors.assert(&WITHIN);
}

/// Scipy integrates to about 1e-11 absolute, so that its small probabilities have few digits.
#[test]
fn studentized_ranges_meet_those_of_scipy() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.studentized_range.len(), 64);
    for &(q, means, df, p) in &GOLDEN.studentized_range {
        let found = studentized_range_tail(q, means, df).expect("a p");
        errors.add_relative_to("absolute", found, p, 1.0);
    }
    errors.assert(&[("absolute", 1e-9)]);
}

#[test]
fn tests_of_counts_meet_those_of_packages() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.counts.len(), 3);
    for golden in &GOLDEN.counts {
        let (statistic, df, p) = golden.independence;
        let found = contingency(&golden.table).expect("a test");
        assert_eq!(found.df, df);
        errors.add("chi²", found.statistic, statistic);
        errors.add("p", found.p, p);
        let found = goodness_of_fit(&golden.table[0], &golden.proportions).expect("a test");
        errors.add("chi²", found.statistic, golden.fit.0);
        errors.add("p", found.p, golden.fit.1);

        // A matrix of as many labels as the table has columns; its last rows may be empty.
        let labels: Vec<String> = (0..golden.proportions.len()).map(|i| i.to_string()).collect();
        let mut matrix = ConfusionMatrix::new(labels.clone()).expect("a matrix");
        for (row, presented) in golden.table.iter().zip(&labels) {
            for (&count, answered) in row.iter().zip(&labels) {
                matrix.add_many(presented, answered, count).expect("a label");
            }
        }
        let bits = matrix.information().expect("answers").observed_bits;
        errors.add("information", bits, golden.bits);
    }
    errors.assert(&[("chi²", EXACT), ("p", EXACT), ("information", EXACT)]);
}

#[test]
fn tests_of_pairs_meet_those_of_packages() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.pairs.len(), 4);
    for golden in &GOLDEN.pairs {
        let (x, y) = (&golden.x, &golden.y);
        let (r, p, low, high) = golden.pearson;
        let found = pearson(x, y).expect("a correlation");
        errors.add("r", found.r, r);
        errors.add("p of r", found.p, p);
        let interval = found.interval(0.95).expect("an interval");
        errors.add("interval of r", interval.low, low);
        errors.add("interval of r", interval.high, high);

        let (t, p, low, high) = golden.paired;
        let found = paired(x, y).expect("a test");
        errors.add("t", found.t, t);
        errors.add("p of t", found.p, p);
        let interval = found.interval(0.99).expect("an interval");
        errors.add("interval of t", interval.low, low);
        errors.add("interval of t", interval.high, high);
        let found = one_sample(x, 2.5).expect("a test");
        errors.add("t", found.t, golden.one_sample.0);
        errors.add("p of t", found.p, golden.one_sample.1);

        let (slope, standard_error, residual_sd) = golden.origin;
        let found = through_origin(x, y).expect("a line");
        errors.add("slope", found.slope, slope);
        errors.add("slope, standard error", found.standard_error, standard_error);
        errors.add("slope, residual", found.residual_sd, residual_sd);
    }
    let quantities = [
        "r",
        "p of r",
        "interval of r",
        "t",
        "p of t",
        "interval of t",
        "slope",
        "slope, standard error",
        "slope, residual",
    ];
    errors.assert(&quantities.map(|quantity| (quantity, EXACT)));
}

#[test]
fn analyses_of_covariance_meet_those_of_packages() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.ancova.len(), 3);
    for golden in &GOLDEN.ancova {
        let groups = golden
            .groups
            .iter()
            .map(|group| Group { covariate: group.x.clone(), y: group.y.clone() });
        let found = ancova(&groups.collect::<Vec<_>>()).expect("an analysis");
        assert!((found.slope / golden.slope - 1.0).abs() < EXACT);
        add_effect(&mut errors, &found.factor, &golden.factor);
        add_effect(&mut errors, &found.covariate, &golden.covariate);
    }
    errors.assert(&BETWEEN);
}

#[test]
fn exponentials_meet_those_of_scipy() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.exponential.len(), 3);
    for golden in &GOLDEN.exponential {
        let found = fit_exponential(&golden.t, &golden.y).expect("a fit");
        errors.add("offset", found.offset, golden.offset);
        errors.add("amplitude", found.amplitude, golden.amplitude);
        errors.add("time constant", found.time_constant, golden.tau);
        errors.add("R²", found.r_squared, golden.r2);
    }
    errors.assert(&[("offset", 1e-7), ("amplitude", 1e-7), ("time constant", 1e-6), ("R²", 1e-12)]);
}

#[test]
fn psychometric_functions_meet_those_of_packages() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.psychometric.len(), 5);
    for golden in &GOLDEN.psychometric {
        let model = Model {
            shape: match golden.shape.as_str() {
                "weibull" => Shape::Weibull,
                _ => Shape::CumulativeNormal,
            },
            guess: golden.guess,
            lapse: golden.lapse,
        };
        let levels = golden.levels.iter().zip(&golden.correct);
        let levels = levels.map(|(&level, &correct)| Level {
            level,
            answers: Proportion::new(correct, golden.total).expect("a proportion"),
        });
        let fit = model.fit(&levels.collect::<Vec<_>>()).expect("a fit");
        errors.add("location", fit.location, golden.location);
        errors.add("slope", fit.slope, golden.slope);
        errors.add("deviance", fit.deviance, golden.deviance);
        let threshold = fit.threshold(golden.proportion).expect("a threshold");
        errors.add("threshold", threshold.level, golden.threshold);
        errors.add("standard error", threshold.standard_error, golden.standard_error);
        let reached = fit.probability(threshold.level).expect("a proportion");
        errors.add("proportion at the threshold", reached, golden.proportion);
    }
    errors.assert(&[
        // The general optimiser finds its minimum to about the root of the rounding.
        ("location", 1e-6),
        ("slope", 1e-6),
        ("deviance", 1e-9),
        ("threshold", 1e-6),
        ("standard error", 1e-6),
        ("proportion at the threshold", 1e-12),
    ]);
}

#[test]
fn proportions_correct_by_sensitivity_meet_quadratures_of_scipy() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.sensitivity.len(), 26);
    for &(alternatives, d_prime, p) in &GOLDEN.sensitivity {
        let (name, found) = match alternatives {
            0 => ("oddity", proportion_correct_oddity(d_prime)),
            m => ("forced choice", proportion_correct(m, d_prime)),
        };
        errors.add(name, found.expect("a proportion"), p);
    }
    errors.assert(&[("oddity", 1e-11), ("forced choice", 1e-11)]);
}

#[test]
fn proportions_meet_those_of_scipy() {
    let mut errors = Errors::default();
    assert_eq!(GOLDEN.proportion.len(), 6);
    for &(correct, total, chance, p, low, high, least) in &GOLDEN.proportion {
        let found = Proportion::new(correct, total).expect("a proportion");
        errors.add("p", found.p_by_chance(chance).expect("a p"), p);
        let interval = found.interval(0.95).expect("an interval");
        errors.add("interval", interval.low, low);
        errors.add("interval", interval.high, high);
        let found = criterion(total, chance, 0.01).expect("a criterion");
        assert_eq!(found.map_or(-1, i64::from), least);
    }
    errors.assert(&[("p", EXACT), ("interval", 1e-9)]);
}
