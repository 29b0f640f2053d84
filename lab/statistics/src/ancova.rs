//! Analysis of covariance: a factor between groups and a covariate, with the same slope in all groups.

use crate::anova::Effect;
use crate::error::at_least;
use crate::sample::{check_rows, mean_of, varies};
use crate::{Result, StatisticsError};

/// Analysis of covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ancova {
    /// Slope of the covariate within the groups, in the unit of `y` over that of the covariate.
    pub slope: f64,
    /// The covariate beside the factor, with 1 degree of freedom.
    pub covariate: Effect,
    /// The factor beside the covariate, with `k - 1` degrees of freedom.
    pub factor: Effect,
}

/// Observations of a group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// The covariate, such as the logarithm of a ratio of roughnesses.
    pub covariate: Vec<f64>,
    /// The dependent variable, in the same order.
    pub y: Vec<f64>,
}

/// Analysis of covariance by the regression `y = m_g + b x`: each effect is what the residual sum of squares grows by without
/// it (type III); the error has `N - k - 1` degrees of freedom.
///
/// # Errors
/// Fewer than two groups, an empty group, fewer than `k + 2` observations, lists of different length, a number that is not
/// finite, a covariate that does not vary within the groups, or an exact fit.
pub fn ancova(groups: &[Group]) -> Result<Ancova> {
    at_least("groups", groups.len(), 2)?;
    for (row, Group { covariate, y }) in groups.iter().enumerate() {
        if covariate.len() != y.len() {
            return Err(StatisticsError::Unbalanced {
                what: "list of the covariate of group",
                row,
                count: covariate.len(),
                expected: y.len(),
            });
        }
        at_least("observations of a group", y.len(), 1)?;
    }
    let covariates: Vec<&[f64]> = groups.iter().map(|g| g.covariate.as_slice()).collect();
    let ys: Vec<&[f64]> = groups.iter().map(|g| g.y.as_slice()).collect();
    check_rows("covariate of group", &covariates)?;
    check_rows("group", &ys)?;
    let (x, y) = (covariates.concat(), ys.concat());
    at_least("observations", y.len(), groups.len() + 2)?;

    let (x_within, y_within) = (centred_by_group(&covariates), centred_by_group(&ys));
    if !varies(square(&x_within), x.iter().copied()) {
        return Err(StatisticsError::NoVariation { what: "the covariate within the groups" });
    }
    let (slope, residual) = regress(&x_within, &y_within);
    if !varies(residual, y.iter().copied()) {
        return Err(StatisticsError::NoVariation {
            what: "what covariate and factor leave of the dependent variable",
        });
    }
    let error = (residual, (y.len() - groups.len() - 1) as f64);
    let (_, without_factor) = regress(&centred_by_group(&[&x]), &centred_by_group(&[&y]));
    let explained = slope * slope * square(&x_within);
    Ok(Ancova {
        slope,
        covariate: Effect::new((explained, 1.0), error, None)?,
        factor: Effect::new(
            // Rounding may make it negative where the groups do not differ.
            ((without_factor - residual).max(0.0), (groups.len() - 1) as f64),
            error,
            None,
        )?,
    })
}

/// Slope of the regression through the origin and the residual sum of squares.
fn regress(x: &[f64], y: &[f64]) -> (f64, f64) {
    let slope = x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / square(x);
    let residuals = x.iter().zip(y).map(|(x, y)| (y - slope * x).powi(2));
    (slope, residuals.sum())
}

fn centred_by_group(groups: &[&[f64]]) -> Vec<f64> {
    let centred = groups.iter().flat_map(|group| {
        let mean = mean_of(group);
        group.iter().map(move |y| y - mean)
    });
    centred.collect()
}

fn square(row: &[f64]) -> f64 {
    row.iter().map(|y| y * y).sum()
}
