//! Probabilities and sensitivities against exact values, which `data/generate.py` computes with many digits; among them the
//! statistics that the thesis prints.

use documented_figures::run_generator;
use experiment_statistics::Result;
use experiment_statistics::distribution::{
    binomial_tail, chi_square_tail, correlation_tail, f_tail, normal_cdf, normal_quantile,
    t_quantile, t_tail,
};
use experiment_statistics::proportion::{Proportion, criterion};
use experiment_statistics::sensitivity::{
    d_prime, d_prime_oddity, proportion_correct, proportion_correct_oddity,
};
use experiment_statistics::studentized_range::{
    studentized_range_quantile, studentized_range_tail,
};
use serde::Deserialize;

use crate::{Errors, table};

#[test]
fn committed_exact_values_are_those_that_the_generator_writes() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/generate.py");
    run_generator(script, &["--check"]);
}

/// Probability of a statistic, named as in the tables.
fn tail(statistic: &str, df: &str, value: f64) -> Result<f64> {
    let df: Vec<f64> = df.split(' ').map(|n| n.parse().expect("a number")).collect();
    match (statistic, df.as_slice()) {
        ("F", &[effect, error]) => f_tail(value, effect, error),
        ("t", &[df]) => t_tail(value, df),
        ("chi2", &[df]) => chi_square_tail(value, df),
        ("binomial", &[total, chance]) => binomial_tail(total as u32, value as u32, chance),
        ("q", &[means, error]) => studentized_range_tail(value, means as u32, error),
        ("r", &[pairs]) => correlation_tail(value, pairs as usize),
        _ => panic!("unknown statistic {statistic} {df:?}"),
    }
}

#[test]
fn tails_meet_exact_values() {
    #[derive(Deserialize)]
    struct Golden {
        statistic: String,
        df: String,
        value: f64,
        p: f64,
    }
    let golden: Vec<Golden> = table(include_str!("../data/tails.csv"));
    assert_eq!(golden.len(), 67);
    let mut errors = Errors::default();
    for Golden { statistic, df, value, p } in golden {
        errors.add(&statistic, tail(&statistic, &df, value).expect("a p"), p);
    }
    errors.assert(&[
        ("F", 1e-10),
        ("t", 1e-10),
        ("chi2", 1e-10),
        ("binomial", 1e-10),
        ("q", 1e-10),
    ]);
}

#[test]
fn normal_probabilities_meet_exact_values() {
    #[derive(Deserialize)]
    struct Golden {
        z: f64,
        p: f64,
    }
    let golden: Vec<Golden> = table(include_str!("../data/normal.csv"));
    assert_eq!(golden.len(), 28);
    let mut errors = Errors::default();
    for Golden { z, p } in golden {
        errors.add("p of z", normal_cdf(z), p);
    }
    errors.assert(&[("p of z", 1e-14)]);
    assert_eq!(
        [f64::NEG_INFINITY, -40.0, 40.0, f64::INFINITY].map(normal_cdf),
        [0.0, 0.0, 1.0, 1.0]
    );
    assert!(normal_cdf(f64::NAN).is_nan());
}

/// What the thesis prints, and what it should have printed.
#[derive(Debug, Deserialize)]
struct Printed {
    statistic: String,
    df: String,
    value: String,
    printed_p: String,
    exact_p: f64,
    verdict: String,
    remark: String,
}

fn printed() -> Vec<Printed> {
    table(include_str!("../data/thesis.csv"))
}

/// Half a unit of the last printed digit.
fn half_unit(printed: &str) -> f64 {
    let digits = printed.split_once('.').map_or(0, |(_, digits)| digits.len());
    0.5 * 0.1f64.powi(digits as i32)
}

/// Whether a printed p, which may be a limit, is a p rounded.
fn agrees(printed: &str, p: f64) -> bool {
    if let Some(limit) = printed.strip_prefix('<') {
        return p < limit.parse().expect("a number");
    }
    if let Some(limit) = printed.strip_prefix('>') {
        return p > limit.parse().expect("a number");
    }
    let number: f64 = printed.parse().expect("a number");
    (number - p).abs() <= half_unit(printed) * (1.0 + 1e-9)
}

#[test]
fn statistics_of_the_thesis_have_their_exact_p() {
    let printed = printed();
    assert_eq!(printed.len(), 56);
    let mut errors = Errors::default();
    for row in &printed {
        let value = row.value.parse().expect("a number");
        let p = tail(&row.statistic, &row.df, value).expect("a p");
        errors.add(&row.statistic, p, row.exact_p);
    }
    errors.assert(&[
        ("F", 1e-10),
        ("t", 1e-10),
        ("chi2", 1e-10),
        ("binomial", 1e-10),
        ("q", 1e-10),
        ("r", 1e-10),
    ]);
}

#[test]
fn a_printed_p_of_the_thesis_is_wrong_exactly_where_the_table_says_so() {
    for row in printed() {
        let value: f64 = row.value.parse().expect("a number");
        let half = half_unit(&row.value);
        let exact = agrees(&row.printed_p, row.exact_p);
        // Over what was rounded to the printed value, at ten places.
        let rounded = (-10..=10).any(|i| {
            let value = value + half * f64::from(i) / 10.0;
            let p = tail(&row.statistic, &row.df, value.max(0.0)).expect("a p");
            row.statistic != "binomial" && agrees(&row.printed_p, p)
        });
        let verdict = match (exact, rounded) {
            (true, _) => "right",
            (false, true) => "rounded",
            (false, false) => "wrong",
        };
        assert_eq!(row.verdict, verdict, "{row:?}");
        assert!(verdict != "wrong" || !row.remark.is_empty(), "{row:?}");
    }
}

/// 72 % of 40 answers, 42 of 90 and 54 % of 90, 40 % of 30: the criteria of sections 3.2.2, 3.3.2 and 4.2.2. The thesis says
/// 54 % where 47 % suffice, and counts 70 % of 40 as not told apart, which is above chance.
#[test]
fn criteria_of_the_thesis_are_not_the_smallest() {
    assert_eq!(criterion(40, 0.5, 0.01), Ok(Some(28)));
    assert_eq!(criterion(90, 1.0 / 3.0, 0.01), Ok(Some(42)));
    assert_eq!(criterion(90, 1.0 / 3.0, 0.0001), Ok(Some(48)));
    assert_eq!(criterion(30, 0.2, 0.01), Ok(Some(12)));
    assert_eq!(criterion(90, 0.2, 0.01), Ok(Some(28)));
    assert_eq!(criterion(3, 0.5, 0.01), Ok(None));
    let seventy = Proportion::new(28, 40).expect("a proportion");
    assert!(seventy.p_by_chance(0.5).expect("a p") < 0.01);
}

#[test]
fn sensitivities_meet_exact_values() {
    #[derive(Deserialize)]
    struct Forced {
        n_afc: u32,
        p_correct: f64,
        d_prime: f64,
    }
    #[derive(Deserialize)]
    struct Odd {
        p_correct: f64,
        d_prime: f64,
    }
    let forced: Vec<Forced> = table(include_str!("../data/forced_choice.csv"));
    let odd: Vec<Odd> = table(include_str!("../data/oddity.csv"));
    assert_eq!((forced.len(), odd.len()), (19, 12));
    let mut errors = Errors::default();
    for golden in forced {
        let (m, p, d) = (golden.n_afc, golden.p_correct, golden.d_prime);
        let found = d_prime(m, p).expect("a d'");
        errors.add_relative_to("d' of forced choice, absolute", found, d, 1.0);
        errors.add("p of forced choice", proportion_correct(m, d).expect("a p"), p);
    }
    for Odd { p_correct, d_prime } in odd {
        errors.add("d' of oddity", d_prime_oddity(p_correct).expect("a d'"), d_prime);
        let p = proportion_correct_oddity(d_prime).expect("a p");
        errors.add("p of oddity", p, p_correct);
    }
    errors.assert(&[
        ("d' of forced choice, absolute", 1e-12),
        ("p of forced choice", 1e-14),
        // Near chance the curve is level: d' of 0.27 changes by 1.7e-15 over its slope.
        ("d' of oddity", 1e-12),
        ("p of oddity", 1e-14),
    ]);
}

/// One third is chance; a half is the value of tables of the triangular method.
#[test]
fn sensitivity_to_the_different_one_of_three_starts_at_chance() {
    assert!(d_prime_oddity(1.0 / 3.0 + 1e-6).expect("a d'") < 1e-2);
    assert_eq!(d_prime_oddity(0.2), Ok(0.0));
    assert!((d_prime_oddity(0.5).expect("a d'") - 1.47).abs() < 5e-3);
    assert!((d_prime_oddity(0.9).expect("a d'") - 4.03).abs() < 5e-3);
    assert!((proportion_correct_oddity(0.0).expect("a p") - 1.0 / 3.0).abs() < 1e-15);
}

#[test]
fn quantiles_are_where_the_tail_is() {
    let mut errors = Errors::default();
    for p in [1e-6, 0.001, 0.05, 0.5, 0.9, 0.999] {
        errors.add("normal", normal_cdf(normal_quantile(p).expect("a z")), p);
        for df in [1.0, 3.7, 9.0, 36.0, 500.0] {
            let t = t_quantile(p, df).expect("a t");
            errors.add("t", t_tail(t, df).expect("a p"), p);
        }
    }
    for means in [2, 5, 20] {
        let q = studentized_range_quantile(0.05, means, 36.0).expect("a q");
        errors.add("q", studentized_range_tail(q, means, 36.0).expect("a p"), 0.05);
    }
    errors.assert(&[("normal", 1e-12), ("t", 1e-12), ("q", 1e-12)]);
}

/// With one degree of freedom the variable is a Cauchy variable: the quantile is `cot(pi p / 2)`.
#[test]
fn a_far_quantile_of_t_is_that_of_a_cauchy_variable() {
    for p in [1e-3, 1e-9, 1e-12, 1e-100] {
        let t = t_quantile(p, 1.0).expect("a t");
        let exact = (0.5 * std::f64::consts::PI * p).tan().recip();
        assert!((t / exact - 1.0).abs() < 1e-9, "{p:e}: {t:e}, {exact:e}");
    }
}

#[test]
fn a_range_of_two_means_is_a_t_test() {
    for (q, df) in [(0.1, 4.0), (3.67, 36.0), (9.0, 2.0), (12.0, 60.0)] {
        let of_t = t_tail(q / 2f64.sqrt(), df).expect("a p");
        let of_range = studentized_range_tail(q, 2, df).expect("a p");
        assert!((of_range / of_t - 1.0).abs() < 1e-10, "{q}, {df}: {of_range}, {of_t}");
    }
}
