//! Small systems of linear equations.

/// Solves `a x = b` for a symmetric, positive definite `a` of which the lower triangle counts, by Cholesky's method
/// without roots; `n` equations of at most `N`. `None` if `a` is not positive definite.
#[must_use]
pub fn solve<const N: usize>(a: &mut [[f64; N]; N], b: &mut [f64; N], n: usize) -> Option<()> {
    let n = n.min(N);
    for i in 0..n {
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
    for i in 0..n {
        b[i] -= (0..i).map(|k| a[i][k] * b[k]).sum::<f64>();
    }
    for i in (0..n).rev() {
        b[i] = b[i] / a[i][i] - (i + 1..n).map(|k| a[k][i] * b[k]).sum::<f64>();
    }
    Some(())
}
