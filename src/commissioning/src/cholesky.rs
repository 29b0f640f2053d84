//! Solution of the normal equations of least squares.

/// Solves the linear equations `a x = b` by a Cholesky decomposition without square roots (LDLᵀ), and replaces the
/// content of `b` by `x`. The matrix `a` must be symmetric and positive definite; only its lower triangle is used, and
/// its content is overwritten. Returns `None` if `a` is not positive definite.
#[must_use]
pub fn solve_by_cholesky<const N: usize>(a: &mut [[f64; N]; N], b: &mut [f64; N]) -> Option<()> {
    // Sums run over iterators, not indices, so that no compiler leaves a check of an index in the code.
    let mut pivots = [0.0; N];
    for i in 0..N {
        for j in 0..i {
            let sum = weighted_product(&a[i], &a[j], &pivots, j);
            a[i][j] = (a[i][j] - sum) / pivots[j];
        }
        let pivot = a[i][i] - weighted_product(&a[i], &a[i], &pivots, i);
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        pivots[i] = pivot;
    }
    for i in 0..N {
        let sum: f64 = a[i].iter().zip(&*b).take(i).map(|(a, b)| a * b).sum();
        b[i] -= sum;
    }
    for i in (0..N).rev() {
        let below = a.iter().zip(&*b).skip(i + 1);
        let sum: f64 = below.filter_map(|(row, b)| Some(row.get(i)? * b)).sum();
        b[i] = b[i] / pivots[i] - sum;
    }
    Some(())
}

/// Sum of the first `count` products of three elements.
fn weighted_product<const N: usize>(
    a: &[f64; N],
    b: &[f64; N],
    weights: &[f64; N],
    count: usize,
) -> f64 {
    let elements = a.iter().zip(b).zip(weights).take(count);
    elements.map(|((a, b), weight)| a * b * weight).sum()
}
