//! Maximum-likelihood fit of the observer to published proportions.

use argmin::core::{CostFunction, Executor, State};
use argmin::solver::neldermead::NelderMead;
use serde::Serialize;

use super::closed_form::{colder, different};
use crate::ObserverParams;

/// A published cell with the falls that belong to it.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// The task and its falls, K.
    pub task: CellTask,
    /// Published proportion of correct answers.
    pub published: f64,
    /// Number of trials behind it.
    pub trials: u32,
}

/// The task of a cell.
#[derive(Clone, Copy, Debug)]
pub enum CellTask {
    /// The colder of two: the falls of the colder and of the warmer material, K.
    Colder([f64; 2]),
    /// The different one of three: the falls of target and distractors, K.
    Different(f64, f64),
}

impl Cell {
    /// Proportion of correct answers of an observer.
    pub fn predicted(&self, observer: &ObserverParams) -> f64 {
        match self.task {
            CellTask::Colder(falls_k) => colder(observer, falls_k),
            CellTask::Different(target_k, distractor_k) => {
                different(observer, target_k, distractor_k)
            }
        }
    }

    /// Deviance against the published proportion.
    pub fn deviance(&self, observer: &ObserverParams) -> f64 {
        let predicted = self.predicted(observer).clamp(1e-9, 1.0 - 1e-9);
        let term = |observed: f64, expected: f64| {
            if observed > 0.0 { observed * libm::log(observed / expected) } else { 0.0 }
        };
        let n = f64::from(self.trials);
        let p = self.published;
        2.0 * n * (term(p, predicted) + term(1.0 - p, 1.0 - predicted))
    }
}

/// Parameters that a fit has found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fitted {
    /// Noise of a fall of zero, K.
    pub s0_k: f64,
    /// Noise as a fraction of the fall.
    pub w: f64,
    /// Factor of three fingers.
    pub three_finger_factor: f64,
    /// Proportion of lapses.
    pub lapse: f64,
    /// Sum of the deviances of the cells.
    pub deviance: f64,
}

impl Fitted {
    /// The observer with these parameters.
    pub const fn observer(&self) -> ObserverParams {
        ObserverParams {
            s0_k: self.s0_k,
            w: self.w,
            three_finger_factor: self.three_finger_factor,
            lapse: self.lapse,
            ..ObserverParams::TOUCH
        }
    }
}

/// Largest proportion of lapses that a fit considers: beyond it a participant does not take part.
const LAPSE_MAX: f64 = 0.2;
/// Most iterations of the search; it ends earlier where the simplex has contracted.
const ITERATIONS_MAX: u64 = 2000;

struct Problem<'a> {
    cells: &'a [Cell],
    fits_factor: bool,
}

impl Problem<'_> {
    /// The observer at a point of the search, whose coordinates are unbounded.
    fn observer(&self, point: &[f64]) -> ObserverParams {
        let &[ln_s0, ln_w, lapse, ..] = point else {
            return ObserverParams::TOUCH;
        };
        let factor = match point.get(3).filter(|_| self.fits_factor) {
            Some(ln_factor) => libm::exp(*ln_factor),
            None => 1.0,
        };
        ObserverParams {
            s0_k: libm::exp(ln_s0),
            w: libm::exp(ln_w),
            three_finger_factor: factor,
            lapse: LAPSE_MAX / (1.0 + libm::exp(-lapse)),
            ..ObserverParams::TOUCH
        }
    }
}

impl CostFunction for Problem<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, point: &Vec<f64>) -> Result<f64, argmin::core::Error> {
        let observer = self.observer(point);
        Ok(self.cells.iter().map(|cell| cell.deviance(&observer)).sum())
    }
}

/// The observer under which the published cells are most likely; with `fits_factor` the factor of three fingers is fitted,
/// otherwise it is 1.
///
/// # Errors
/// The search has failed.
pub fn fit(cells: &[Cell], fits_factor: bool) -> Result<Fitted, argmin::core::Error> {
    let dimensions = if fits_factor { 4 } else { 3 };
    let start = [libm::log(0.5), libm::log(0.15), -1.0, 0.5];
    let mut simplex = vec![start[..dimensions].to_vec()];
    for dimension in 0..dimensions {
        let mut corner = start[..dimensions].to_vec();
        corner[dimension] += 0.5;
        simplex.push(corner);
    }
    let problem = Problem { cells, fits_factor };
    let solver = NelderMead::new(simplex).with_sd_tolerance(1e-9)?;
    let result =
        Executor::new(problem, solver).configure(|state| state.max_iters(ITERATIONS_MAX)).run()?;
    let point = result.state().get_best_param().cloned().unwrap_or_default();
    let observer = Problem { cells, fits_factor }.observer(&point);
    Ok(Fitted {
        s0_k: observer.s0_k,
        w: observer.w,
        three_finger_factor: observer.three_finger_factor,
        lapse: observer.lapse,
        deviance: result.state().get_best_cost(),
    })
}
