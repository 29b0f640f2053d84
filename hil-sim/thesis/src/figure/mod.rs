//! The model curves of the thesis's figures.
//!
//! Every curve over time comes from one [`ContactSolver`], so that another than the closed form can draw the same figures.

mod difference;
mod simulation;
mod validation;

pub use difference::{FigureDifference, differences};

use crate::contact_case::{Case, ContactSolver, Surfaces};

/// The model curves of a figure of the thesis.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Number in the thesis, with the part if there are several: "6-13 A".
    pub number: &'static str,
    /// Content and conditions.
    pub title: String,
    /// Quantity and unit of x.
    pub x: &'static str,
    /// Quantity and unit of y.
    pub y: &'static str,
    /// The curves, in the order of the legend.
    pub curves: Vec<Curve>,
}

/// A curve of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub label: String,
    /// How it is drawn.
    pub kind: Kind,
    /// Index of the colour, shared by curves of the same object, pressure or finish.
    pub group: usize,
    /// Points `(x, y)`.
    pub points: Vec<(f64, f64)>,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Solid line.
    Line,
    /// Dashed line: the object beside the skin, or the continuous model beside single pressures.
    Dashed,
    /// Single points.
    Dots,
}

/// Every model figure, drawn from `solver`; perfect contact (figures 3-2 and 6-10) always by Eq. 3-1 and 3-3.
///
/// # Errors
/// The source cannot compute a case.
pub fn figures(solver: &dyn ContactSolver) -> anyhow::Result<Vec<Figure>> {
    let mut figures = simulation::figure_3_2();
    figures.extend(simulation::figures_6_6_to_6_9(solver)?);
    figures.push(simulation::figure_6_10(solver)?);
    figures.extend(simulation::figures_6_11_and_6_12(solver)?);
    figures.extend(validation::figure_6_13(solver)?);
    figures.extend(validation::figure_6_19(solver)?);
    figures.extend(validation::figure_6_20(solver)?);
    Ok(figures)
}

/// End of the time axis, s.
pub(super) const END_S: f64 = 10.0;
/// Number of points of a curve over time, without that at zero.
const POINTS: u32 = 400;

/// Times of a curve, s, denser at the start, where temperatures change fast.
fn times_s() -> Vec<f64> {
    (0..=POINTS).map(|i| END_S * (f64::from(i) / f64::from(POINTS)).powi(2)).collect()
}

/// A curve over time from the solver.
fn over_time(
    solver: &dyn ContactSolver,
    case: &Case,
    value: fn(&Surfaces) -> f64,
    (label, kind, group): (String, Kind, usize),
) -> anyhow::Result<Curve> {
    let times_s = times_s();
    let surfaces = solver.solve(case, &times_s)?;
    Ok(Curve {
        label,
        kind,
        group,
        points: times_s.into_iter().zip(surfaces.iter().map(value)).collect(),
    })
}

const TIME: &str = "time since landing / s";
const TEMPERATURE: &str = "temperature / °C";
const FLUX: &str = "heat flux out of the skin / W/m²";
