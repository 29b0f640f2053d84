//! Solution of the normal equations of least squares.

/// Solves the linear equations `a x = b` by a Cholesky decomposition without square roots (LDLᵀ), and replaces the
/// content of `b` by `x`. The matrix `a` must be symmetric and positive definite; only its lower triangle is used, and
/// its content is overwritten. Returns `None` if `a` is not positive definite.
#[must_use]
pub fn solve_by_cholesky<const N: usize>(a: &mut [[f64; N]; N], b: &mut [f64; N]) -> Option<()> {
    solve(a.as_flattened_mut(), &mut [0.0; N], b)
}

/// Not generic, so that the program has it once; `a` has its rows one after the other. Places are asked for by `get`, so that no
/// compiler leaves a check of an index in the code.
#[inline(never)]
fn solve(a: &mut [f64], pivots: &mut [f64], b: &mut [f64]) -> Option<()> {
    let count = b.len();
    for i in 0..count {
        let (above, rest) = a.split_at_mut_checked(i * count)?;
        let row = rest.get_mut(..count)?;
        for j in 0..i {
            let other = above.get(j * count..)?;
            let sum = weighted_product(row, other, pivots, j);
            let element = row.get_mut(j)?;
            *element = (*element - sum) / pivots.get(j)?;
        }
        let pivot = row.get(i)? - weighted_product(row, row, pivots, i);
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        *pivots.get_mut(i)? = pivot;
    }
    for i in 0..count {
        let row = a.get(i * count..)?;
        let sum: f64 = row.iter().zip(&*b).take(i).map(|(a, b)| a * b).sum();
        *b.get_mut(i)? -= sum;
    }
    for i in (0..count).rev() {
        let column = a.get(i..)?.iter().step_by(count.max(1));
        let below = column.zip(&*b).skip(i + 1);
        let sum: f64 = below.map(|(a, b)| a * b).sum();
        let element = b.get_mut(i)?;
        *element = *element / pivots.get(i)? - sum;
    }
    Some(())
}

/// Sum of the first `count` products of three elements.
fn weighted_product(a: &[f64], b: &[f64], weights: &[f64], count: usize) -> f64 {
    let elements = a.iter().zip(b).zip(weights).take(count);
    elements.map(|((a, b), weight)| a * b * weight).sum()
}
