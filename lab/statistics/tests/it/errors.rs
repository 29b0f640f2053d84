//! What is refused, and how.

use experiment_statistics::StatisticsError::{self, *};
use experiment_statistics::anova::{
    contrast_within, one_way, repeated_measures, split_plot, two_within,
};
use experiment_statistics::chi_square::{contingency, goodness_of_fit};
use experiment_statistics::confusion::ConfusionMatrix;
use experiment_statistics::correlation::pearson;
use experiment_statistics::exponential::fit_exponential;
use experiment_statistics::proportion::Proportion;
use experiment_statistics::regression::through_origin;
use experiment_statistics::sensitivity::{d_prime, d_prime_oddity};
use experiment_statistics::t_test::one_sample;
use experiment_statistics::tukey::tukey;

#[test]
fn a_missing_cell_is_named() {
    let missing = repeated_measures(&[vec![1.0, 2.0, 3.0], vec![1.0, 3.0], vec![2.0, 1.0, 1.0]]);
    let error = missing.expect_err("a cell is missing");
    assert_eq!(
        error.to_string(),
        "subject 1 has 2 observations, the first one 3: every cell must be there once"
    );
    let group = vec![vec![1.0, 2.0], vec![2.0, 4.0]];
    let groups = [group.clone(), [group, vec![vec![1.0, 1.0]]].concat()];
    assert!(matches!(split_plot(&groups), Err(Unbalanced { what: "group", row: 1, .. })));
    let cells = [vec![vec![1.0, 2.0], vec![1.0]], vec![vec![2.0, 1.0], vec![3.0, 1.0]]];
    assert!(matches!(two_within(&cells), Err(Unbalanced { row: 1, count: 1, .. })));
}

#[test]
fn what_is_not_finite_is_named() {
    let rows = [[1.0, 2.0], [3.0, f64::NAN]];
    let place = NotFinite { what: "subject", row: 1, column: 1 };
    assert_eq!(repeated_measures(&rows), Err(place));
    assert!(matches!(one_way(&rows), Err(NotFinite { .. })));
    assert!(matches!(one_sample(&[1.0, f64::INFINITY], 0.0), Err(NotFinite { .. })));
}

#[test]
fn too_few_are_refused() {
    let few = |what, count, least| Err(TooFew { what, count, least });
    assert_eq!(repeated_measures(&[[1.0, 2.0]]), few("subjects", 1, 2));
    assert_eq!(repeated_measures(&[[1.0], [2.0]]), few("levels", 1, 2));
    assert_eq!(
        one_way(&[vec![1.0], vec![2.0]]).map(|_| ()),
        Err(TooFew { what: "observations", count: 2, least: 3 })
    );
    assert_eq!(
        pearson(&[1.0, 2.0], &[2.0, 3.0]).map(|_| ()),
        Err(TooFew { what: "pairs", count: 2, least: 3 })
    );
    assert!(Proportion::new(0, 0).is_err());
}

/// A noise-free observer is correct everywhere, or differs from cell to cell as all others do.
#[test]
fn subjects_that_do_not_differ_are_refused() {
    for row in [[1.0, 1.0, 1.0], [0.1, 0.2, 0.3]] {
        let rows = [row; 4];
        assert!(matches!(repeated_measures(&rows), Err(NoVariation { .. })));
        assert!(matches!(contrast_within(&rows, &[1.0, 0.0, -1.0]), Err(NoVariation { .. })));
    }
    assert!(matches!(one_sample(&[0.7; 10], 0.5), Err(NoVariation { .. })));
    assert!(matches!(pearson(&[0.1; 5], &[1.0, 2.0, 3.0, 4.0, 5.0]), Err(NoVariation { .. })));
    assert!(matches!(contingency(&[[0, 3], [0, 4]]), Err(NoVariation { .. })));
}

#[test]
fn what_the_data_do_not_determine_is_refused() {
    let t: Vec<f64> = (0..20).map(f64::from).collect();
    let line: Vec<f64> = t.iter().map(|t| 2.0 * t).collect();
    let what = "the time constant";
    assert_eq!(fit_exponential(&t, &line), Err(NotDetermined { what }));
    assert_eq!(through_origin(&[0.0, 0.0], &[1.0, 2.0]), Err(NotDetermined { what: "the slope" }));
}

#[test]
fn arguments_out_of_range_are_named_with_their_range() {
    let error = d_prime(3, 1.2).expect_err("no proportion");
    assert_eq!(error.to_string(), "proportion is 1.2; it must be from 0 to 1");
    let refused = |result: Result<f64, StatisticsError>| matches!(result, Err(OutOfRange { .. }));
    assert!(refused(d_prime(1, 0.5)));
    assert!(refused(d_prime_oddity(f64::NAN)));
    assert!(matches!(Proportion::new(3, 2), Err(OutOfRange { .. })));
    assert!(matches!(tukey(&[1.0, 2.0], 5, 0.0, 10.0), Err(OutOfRange { .. })));
    for proportion in [0.0, 2.1e-308, 0.9e-100] {
        let refused = goodness_of_fit(&[3, 4], &[1.0, proportion]);
        assert!(matches!(refused, Err(OutOfRange { .. })), "{refused:?}");
    }
    let smallest = goodness_of_fit(&[u32::MAX, u32::MAX], &[1e100, 1e-100]);
    assert!(smallest.expect("a test").statistic.is_finite());
    let rows = [[1.0, 2.0], [2.0, 5.0], [0.0, 1.0]];
    assert!(matches!(contrast_within(&rows, &[1.0, 1.0]), Err(OutOfRange { .. })));
}

#[test]
fn a_confusion_matrix_knows_its_labels() {
    let mut matrix = ConfusionMatrix::new(["copper", "granite", "foam"]).expect("a matrix");
    matrix.add_many("copper", "copper", 8).expect("a label");
    matrix.add("copper", "granite").expect("a label");
    matrix.add("granite", "copper").expect("a label");
    let unknown = matrix.add("copper", "tin").expect_err("no label");
    assert_eq!(unknown.to_string(), "the label 'tin' is none of the matrix");
    assert_eq!(matrix.count("copper", "granite"), Ok(1));
    let proportions = matrix.proportions();
    assert_eq!(proportions[0], Some(vec![8.0 / 9.0, 1.0 / 9.0, 0.0]));
    assert_eq!(proportions[2], None, "never presented");
    assert_eq!(matrix.correct(), Proportion::new(8, 10));
    assert_eq!(matrix.correct_of("granite"), Proportion::new(0, 1));
    assert!(matrix.correct_of("foam").is_err());
    assert!(ConfusionMatrix::new(["copper", "copper"]).is_err());
    assert!(ConfusionMatrix::new(["copper"]).is_err());
}

/// With 3 rows and columns and all 9 cells in use the correction is (3 + 3 - 9 - 1) / (2 n ln 2).
#[test]
fn information_of_a_perfect_identification_is_the_entropy_and_corrected_for_few_answers() {
    let labels = ["a", "b", "c"];
    let mut perfect = ConfusionMatrix::new(labels).expect("a matrix");
    let mut chance = perfect.clone();
    for presented in labels {
        perfect.add_many(presented, presented, 10).expect("a label");
        for answered in labels {
            chance.add_many(presented, answered, 2).expect("a label");
        }
    }
    let information = perfect.information().expect("answers");
    assert!((information.observed_bits - 3f64.log2()).abs() < 1e-12);
    // Three occupied cells in place of nine: 3 + 3 - 3 - 1.
    let correction = 2.0 / (60.0 * std::f64::consts::LN_2);
    assert!((information.corrected_bits - information.observed_bits - correction).abs() < 1e-12);
    let information = chance.information().expect("answers");
    assert!(information.observed_bits.abs() < 1e-12);
    let correction = -4.0 / (36.0 * std::f64::consts::LN_2);
    assert!((information.corrected_bits - correction).abs() < 1e-12);
}
