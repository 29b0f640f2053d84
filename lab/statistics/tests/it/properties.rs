//! Properties that hold for all data.

use experiment_statistics::ancova::{Group, ancova};
use experiment_statistics::anova::{
    Effect, contrast_between, contrast_within, one_way, repeated_measures, split_plot, two_within,
};
use experiment_statistics::chi_square::{contingency, goodness_of_fit};
use experiment_statistics::correlation::pearson;
use experiment_statistics::distribution::{
    binomial_tail, chi_square_tail, f_tail, normal_cdf, t_tail,
};
use experiment_statistics::exponential::fit_exponential;
use experiment_statistics::levene::levene;
use experiment_statistics::proportion::{Proportion, criterion};
use experiment_statistics::psychometric::{Level, Model, Shape};
use experiment_statistics::regression::through_origin;
use experiment_statistics::sensitivity::{
    d_prime, d_prime_oddity, proportion_correct, proportion_correct_oddity,
};
use experiment_statistics::studentized_range::studentized_range_tail;
use experiment_statistics::t_test::{one_sample, paired};
use experiment_statistics::tukey::{tukey, tukey_groups};
use experiment_statistics::{mean, standard_error_of_mean};
use proptest::collection::vec;
use proptest::prelude::*;

/// Cells of an experiment.
fn cell() -> impl Strategy<Value = f64> {
    -100.0..100.0f64
}

/// Subjects with equally many cells.
fn subjects() -> impl Strategy<Value = Vec<Vec<f64>>> {
    (2..8usize, 3..9usize).prop_flat_map(|(levels, count)| vec(vec(cell(), levels), count))
}

/// Rows of rows of cells without a missing one.
fn blocks() -> impl Strategy<Value = Vec<Vec<Vec<f64>>>> {
    (2..5usize, 2..5usize, 2..6usize).prop_flat_map(|(a, b, c)| vec(vec(vec(cell(), c), b), a))
}

fn total_sum_of_squares(values: &[f64]) -> f64 {
    let mean = mean(values).expect("values");
    values.iter().map(|y| (y - mean).powi(2)).sum()
}

fn both(effect: &Effect) -> f64 {
    effect.sum_of_squares + effect.error_sum_of_squares
}

fn is_close(value: f64, expected: f64) -> bool {
    (value - expected).abs() <= 1e-9 * expected.abs().max(1e-9)
}

/// Numbers as they come from a file with mistakes: not finite, huge, tiny, all alike.
fn anything() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => cell(),
        2 => (-2..3i32).prop_map(f64::from),
        1 => any::<f64>(),
        1 => Just(1e200),
        1 => Just(f64::NAN),
    ]
}

/// Rows that are sometimes of different length.
fn any_rows() -> impl Strategy<Value = Vec<Vec<f64>>> {
    let finite =
        (0..4usize, 0..5usize, prop_oneof![Just(0.0), Just(1.0), Just(1e160), Just(1e-170)])
            .prop_flat_map(|(count, length, scale)| {
                let cell = (-2..3i32).prop_map(move |i| scale * f64::from(i) + 0.1);
                vec(vec(cell, length), count)
            });
    prop_oneof![
        finite,
        (0..4usize).prop_flat_map(|length| vec(vec(anything(), length), 0..4)),
        vec(vec(anything(), 0..5), 0..4),
    ]
}

/// The result contains no NaN and no infinite number, or is an error.
#[track_caller]
fn assert_numbers<T: std::fmt::Debug>(result: experiment_statistics::Result<T>) {
    if let Ok(result) = result {
        let text = format!("{result:?}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}

proptest! {
    #[test]
    fn sums_of_squares_of_groups_add_up(groups in vec(vec(cell(), 2..7), 2..6)) {
        let effect = one_way(&groups).expect("an analysis").effect;
        prop_assert!(is_close(both(&effect), total_sum_of_squares(&groups.concat())));
    }

    #[test]
    fn sums_of_squares_of_repeated_measures_add_up(subjects in subjects()) {
        let found = repeated_measures(&subjects).expect("an analysis");
        let sum = both(&found.effect) + found.subjects_sum_of_squares;
        prop_assert!(is_close(sum, total_sum_of_squares(&subjects.concat())));
    }

    #[test]
    fn sums_of_squares_of_two_factors_add_up(subjects in blocks()) {
        let found = two_within(&subjects).expect("an analysis");
        let of_subjects: Vec<Vec<f64>> = subjects.iter().map(|s| s.concat()).collect();
        let between = repeated_measures(&of_subjects).expect("an analysis").subjects_sum_of_squares;
        let sum = both(&found.a) + both(&found.b) + both(&found.interaction) + between;
        prop_assert!(is_close(sum, total_sum_of_squares(&of_subjects.concat())));
    }

    #[test]
    fn sums_of_squares_of_a_split_plot_add_up(groups in blocks()) {
        let found = split_plot(&groups).expect("an analysis");
        let sum = both(&found.between) + both(&found.within) + found.interaction.sum_of_squares;
        prop_assert!(is_close(sum, total_sum_of_squares(&groups.concat().concat())));
    }

    #[test]
    fn epsilon_is_between_its_bounds_and_one_for_two_levels(subjects in subjects()) {
        let effect = repeated_measures(&subjects).expect("an analysis").effect;
        let sphericity = effect.sphericity.expect("a factor within subjects");
        prop_assert!(sphericity.epsilon >= 1.0 / effect.df - 1e-12 && sphericity.epsilon <= 1.0);
        if effect.df == 1.0 {
            prop_assert!(is_close(sphericity.epsilon, 1.0));
        }
    }

    #[test]
    fn an_analysis_does_not_depend_on_unit_and_zero(
        subjects in subjects(), factor in 0.01..100.0f64, zero in -50.0..50.0f64,
    ) {
        let other: Vec<Vec<f64>> = subjects.iter()
            .map(|row| row.iter().map(|y| factor * y + zero).collect())
            .collect();
        let (one, other) = (repeated_measures(&subjects), repeated_measures(&other));
        let (one, other) = (one.expect("an analysis").effect, other.expect("an analysis").effect);
        prop_assert!((other.f - one.f).abs() <= 1e-7 * one.f.max(1e-3));
    }

    #[test]
    fn two_levels_are_a_paired_t_test(pairs in vec((cell(), cell()), 3..12)) {
        let rows: Vec<[f64; 2]> = pairs.iter().map(|&(a, b)| [a, b]).collect();
        let (a, b): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        let test = paired(&a, &b).expect("a test");
        let effect = repeated_measures(&rows).expect("an analysis").effect;
        let contrast = contrast_within(&rows, &[1.0, -1.0]).expect("a contrast");
        prop_assert!(is_close(effect.f, test.t * test.t));
        prop_assert!(is_close(effect.p, test.p));
        prop_assert!(is_close(contrast.f, effect.f));
        prop_assert!(is_close(contrast.estimate, test.difference));
    }

    #[test]
    fn a_binomial_tail_is_the_sum_of_its_terms(total in 1..120u32, chance in 0.01..0.99f64) {
        // Terms from n correct answers down, each from the one before.
        let mut term = chance.powi(total as i32);
        let mut sum = 0.0;
        for k in (0..=total).rev() {
            sum += term;
            let tail = binomial_tail(total, k, chance).expect("a p");
            prop_assert!((tail / sum - 1.0).abs() < 1e-11, "{k}: {tail}, {sum}");
            term *= f64::from(k) / f64::from(total - k + 1) * (1.0 - chance) / chance;
        }
    }

    #[test]
    fn a_criterion_is_the_smallest_number_above_chance(
        total in 1..150u32, chance in 0.05..0.9f64, alpha in 1e-6..0.3f64,
    ) {
        let brute = (0..=total).find(|&k| binomial_tail(total, k, chance).expect("a p") < alpha);
        prop_assert_eq!(criterion(total, chance, alpha), Ok(brute));
    }

    #[test]
    fn an_interval_contains_its_proportion(total in 1..200u32, part in 0.0..=1.0f64) {
        let correct = (part * f64::from(total)) as u32;
        let answers = Proportion::new(correct, total).expect("a proportion");
        let interval = answers.interval(0.95).expect("an interval");
        prop_assert!(interval.low <= answers.value() && answers.value() <= interval.high);
        prop_assert!(answers.log_linear() > 0.0 && answers.log_linear() < 1.0);
        // The correction pulls towards a half.
        prop_assert!((answers.log_linear() - 0.5).abs() <= (answers.value() - 0.5).abs());
    }

    #[test]
    fn sensitivities_survive_the_way_there_and_back(m in 2..10u32, d in -2.0..4.0f64) {
        let p = proportion_correct(m, d).expect("a p");
        prop_assert!((d_prime(m, p).expect("a d'") - d).abs() < 1e-9);
        if d > 0.05 {
            let p = proportion_correct_oddity(d).expect("a p");
            prop_assert!((d_prime_oddity(p).expect("a d'") - d).abs() < 1e-9);
        }
    }

    #[test]
    fn sensitivity_of_two_alternatives_is_a_normal_quantile(d in -4.0..4.0f64) {
        let p = proportion_correct(2, d).expect("a p");
        prop_assert!((p - normal_cdf(d / 2f64.sqrt())).abs() < 1e-14);
    }

    #[test]
    fn a_tail_falls(f in 0.0..50.0f64, step in 0.01..5.0f64, a in 0.5..30.0f64, b in 1.0..300.0f64) {
        prop_assert!(f_tail(f + step, a, b) .expect("a p") <= f_tail(f, a, b).expect("a p"));
        prop_assert!(chi_square_tail(f + step, a).expect("a p") <= chi_square_tail(f, a).expect("a p"));
        let q = |q| studentized_range_tail(q, 4, b).expect("a p");
        prop_assert!(q(f + step) <= q(f) + 1e-14);
    }

    #[test]
    fn information_of_counts_does_not_exceed_the_entropy_of_the_stimuli(counts in vec(0..20u32, 9)) {
        use experiment_statistics::confusion::ConfusionMatrix;
        let labels = ["a", "b", "c"];
        let mut matrix = ConfusionMatrix::new(labels).expect("a matrix");
        for (cell, &count) in counts.iter().enumerate() {
            matrix.add_many(labels[cell / 3], labels[cell % 3], count).expect("a label");
        }
        if let Ok(information) = matrix.information() {
            prop_assert!(information.observed_bits > -1e-12);
            prop_assert!(information.observed_bits < 3f64.log2() + 1e-12);
        }
    }

    #[test]
    fn nothing_gives_a_number_that_is_none(rows in any_rows(), x in anything(), y in anything()) {
        let empty = Vec::new();
        let first = rows.first().unwrap_or(&empty);
        let last = rows.last().unwrap_or(&empty);
        assert_numbers(one_way(&rows));
        assert_numbers(levene(&rows));
        assert_numbers(repeated_measures(&rows));
        assert_numbers(two_within(&[rows.clone(), rows.iter().rev().cloned().collect()]));
        assert_numbers(split_plot(&[rows.clone(), rows.iter().rev().cloned().collect()]));
        assert_numbers(contrast_within(&rows, &[1.0, x, -1.0 - x]));
        assert_numbers(contrast_between(&rows, &[1.0, x, -1.0 - x]));
        assert_numbers(tukey_groups(&rows).map(|tukey| tukey.pairs));
        assert_numbers(tukey(first, 3, x, y));
        assert_numbers(pearson(first, last));
        assert_numbers(pearson(first, last).and_then(|r| r.interval(0.95)));
        assert_numbers(paired(first, last));
        assert_numbers(one_sample(first, x));
        assert_numbers(one_sample(first, x).and_then(|test| test.interval(0.95)));
        assert_numbers(through_origin(first, last));
        assert_numbers(fit_exponential(first, last));
        let of_rows = |row: &Vec<f64>| Group { covariate: row.clone(), y: last.clone() };
        assert_numbers(ancova(&rows.iter().map(of_rows).collect::<Vec<_>>()));
        assert_numbers(mean(first));
        assert_numbers(standard_error_of_mean(first));
        assert_numbers(goodness_of_fit(&[3, 4, 5], first));
        assert_numbers(contingency(&[[x as u32, 3], [4, y as u32]]));
        assert_numbers(f_tail(x, y, x));
        assert_numbers(t_tail(x, y));
        assert_numbers(studentized_range_tail(x, 3, y));
        assert_numbers(d_prime(3, x));
        assert_numbers(proportion_correct(3, x));
        assert_numbers(d_prime_oddity(x));
        for shape in [Shape::Weibull, Shape::CumulativeNormal] {
            let model = Model { shape, guess: 0.5, lapse: 0.0 };
            let levels: Vec<Level> = first.iter().enumerate().map(|(i, &level)| Level {
                level,
                answers: Proportion::new(10 + 3 * i as u32, 20).expect("a proportion"),
            }).collect();
            let fit = model.fit(&levels);
            assert_numbers(fit.clone().and_then(|fit| fit.threshold(0.75)));
            assert_numbers(fit);
        }
    }
}
