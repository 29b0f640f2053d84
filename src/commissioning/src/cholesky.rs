//! Solution of the normal equations of least squares.

/// Solves the linear equations `a x = b` by a Cholesky decomposition without square roots (LDLᵀ), and replaces the
/// content of `b` by `x`. The matrix `a` must be symmetric and positive definite; only its lower triangle is used, and
/// its content is overwritten. Returns `None` if `a` is not positive definite.
#[must_use]
pub fn solve_by_cholesky<const N: usize>(a: &mut [[f64; N]; N], b: &mut [f64; N]) -> Option<()> {
    for i in 0..N {
        for j in 0..i {
            let sum: f64 = (0..j).map(|k| a[i][k] * a[j][k] * a[k][k]).sum();
            a[i][j] = (a[i][j] - sum) / a[j][j];
        }
        let pivot = a[i][i] - (0..i).map(|k| a[i][k] * a[i][k] * a[k][k]).sum::<f64>();
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        a[i][i] = pivot;
    }
    for i in 0..N {
        b[i] -= (0..i).map(|k| a[i][k] * b[k]).sum::<f64>();
    }
    for i in (0..N).rev() {
        b[i] = b[i] / a[i][i] - (i + 1..N).map(|k| a[k][i] * b[k]).sum::<f64>();
    }
    Some(())
}
