//! Small systems of linear equations.

/// Solves `a x = b` for a symmetric, positive definite `a` of which the lower triangle counts, by Cholesky's method
/// without roots; `n` equations of at most `N`. `None` if `a` is not positive definite.
#[must_use]
pub fn solve<const N: usize>(a: &mut [[f64; N]; N], b: &mut [f64; N], n: usize) -> Option<()> {
    let n = n.min(N);
    for i in 0..n {
        for j in 0..i {
            let mut sum = a[i][j];
            for k in 0..j {
                sum -= a[i][k] * a[j][k] * a[k][k];
            }
            a[i][j] = sum / a[j][j];
        }
        let mut pivot = a[i][i];
        for k in 0..i {
            pivot -= a[i][k] * a[i][k] * a[k][k];
        }
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        a[i][i] = pivot;
    }
    for i in 0..n {
        for k in 0..i {
            b[i] -= a[i][k] * b[k];
        }
    }
    for i in (0..n).rev() {
        b[i] /= a[i][i];
        for k in i + 1..n {
            b[i] -= a[k][i] * b[k];
        }
    }
    Some(())
}
