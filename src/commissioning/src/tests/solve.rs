//! Least squares against polynomials that are known.

use crate::solve::solve;

/// Normal equations of `c0 + c1 t + c2 t^2` for points on it.
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
    solve(&mut a, &mut b, 3).expect("five points");
    for (found, known) in b.into_iter().zip(known) {
        assert!((found - known).abs() < 1e-12, "{found}, {known}");
    }
}

/// Two points leave a direction of parabolas free.
#[test]
fn too_few_points_are_no_parabola() {
    let (mut a, mut b) = parabola([1.0, 2.0].into_iter(), [2.0, -3.0, 0.5]);
    assert_eq!(solve(&mut a, &mut b, 3), None);
    assert_eq!(solve(&mut [[f64::NAN]], &mut [1.0], 1), None);
}

/// `1/d^2` of a point beside `1/s^2` of what is likely: the mean goes by those weights.
#[test]
fn only_the_first_equations_count() {
    let (mut a, mut b) = ([[4.0 + 1.0, 9.0], [9.0, -9.0]], [4.0 * 0.5, 7.0]);
    solve(&mut a, &mut b, 1).expect("one equation");
    assert_eq!(b, [0.4, 7.0]);
}
