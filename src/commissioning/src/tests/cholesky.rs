//! Least squares on polynomials with known coefficients.

use crate::cholesky::solve_by_cholesky;

/// Normal equations for points on the parabola `c0 + c1 t + c2 t^2`.
fn parabola(
    points: impl Iterator<Item = f64> + Clone,
    [c0, c1, c2]: [f64; 3],
) -> ([[f64; 3]; 3], [f64; 3]) {
    let powers = |t: f64| [1.0, t, t * t];
    let (mut a, mut b) = ([[0.0; 3]; 3], [0.0; 3]);
    for t in points {
        let y = c0 + c1 * t + c2 * t * t;
        for (i, x) in powers(t).into_iter().enumerate() {
            b[i] += x * y;
            for (j, z) in powers(t).into_iter().enumerate() {
                a[i][j] += x * z;
            }
        }
    }
    (a, b)
}

#[test]
fn points_on_a_parabola_give_its_coefficients() {
    let known = [2.0, -3.0, 0.5];
    let (mut a, mut b) = parabola((0..5).map(f64::from), known);
    solve_by_cholesky(&mut a, &mut b).expect("five points");
    for (found, known) in b.into_iter().zip(known) {
        assert!((found - known).abs() < 1e-12, "{found}, {known}");
    }
}

/// Two points leave one coefficient undetermined.
#[test]
fn singular_equations_have_no_solution() {
    let (mut a, mut b) = parabola([1.0, 2.0].into_iter(), [2.0, -3.0, 0.5]);
    assert_eq!(solve_by_cholesky(&mut a, &mut b), None);
    assert_eq!(solve_by_cholesky(&mut [[f64::NAN]], &mut [1.0]), None);
}

/// A point at 0.5 with weight 4 and a prior at 0 with weight 1 have the weighted mean 0.4.
#[test]
fn one_unknown_is_the_weighted_mean_of_point_and_prior() {
    let (mut a, mut b) = ([[4.0 + 1.0]], [4.0 * 0.5]);
    solve_by_cholesky(&mut a, &mut b).expect("one equation");
    assert_eq!(b, [0.4]);
}
