//! The model's curves of the thesis's figures, as data.
//!
//! Every curve over time comes from one [`Source`], so that another than the closed form can draw the same figures.

mod compare;
mod simulation;
mod validation;

pub use compare::{Apart, apart};

use crate::case::{Case, Source, Surfaces};

/// A figure of the thesis: the model's curves in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The thesis's number, with the part if it has parts: "6-13 A".
    pub number: &'static str,
    /// What it shows, and under which conditions.
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
    /// What the legend calls it.
    pub label: String,
    /// How it is drawn.
    pub kind: Kind,
    /// Which of the curves of one colour: the same object, pressure or finish.
    pub group: usize,
    /// x and y.
    pub points: Vec<(f64, f64)>,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Solid.
    Line,
    /// Dashed: the object beside the skin, or perfect contact beside the model.
    Dashed,
    /// At single places.
    Dots,
}

/// Every model figure, drawn from `source`; perfect contact (figures 3-2 and 6-10) always by Eq. 3-1 and 3-3.
///
/// # Errors
/// The source cannot compute a case.
pub fn figures(source: &dyn Source) -> anyhow::Result<Vec<Figure>> {
    let mut figures = simulation::figure_3_2();
    figures.extend(simulation::figures_6_6_to_6_9(source)?);
    figures.push(simulation::figure_6_10(source)?);
    figures.extend(simulation::figures_6_11_and_6_12(source)?);
    figures.extend(validation::figure_6_13(source)?);
    figures.extend(validation::figure_6_19(source)?);
    figures.extend(validation::figure_6_20(source)?);
    Ok(figures)
}

/// End of every figure over time, s.
pub(super) const END_S: f64 = 10.0;
/// Points of a curve over time, beside the one at zero.
const POINTS: u32 = 400;

/// Times of a curve, closer at the start, where everything is fast.
fn times_s() -> Vec<f64> {
    (0..=POINTS)
        .map(|i| END_S * (f64::from(i) / f64::from(POINTS)).powi(2))
        .collect()
}

/// A curve over time from the source.
fn over_time(
    source: &dyn Source,
    case: &Case,
    value: fn(&Surfaces) -> f64,
    (label, kind, group): (String, Kind, usize),
) -> anyhow::Result<Curve> {
    let times_s = times_s();
    let course = source.course(case, &times_s)?;
    Ok(Curve {
        label,
        kind,
        group,
        points: times_s.into_iter().zip(course.iter().map(value)).collect(),
    })
}

const TIME: &str = "time since landing / s";
const TEMPERATURE: &str = "temperature / °C";
const FLUX: &str = "heat flux out of the skin / W/m²";
