//! All figures of the plant, timed in turn.
use serde::Serialize;
use thermal_plant::slab::Grading;

use super::super::figures::host;
use super::super::timing::{Time, side_by_side};
use super::bodies::{Cut, Worst};
use super::finger::{FORCE_N, Finger, OBJECT};
use super::fit;
use super::parts::{Candidate, Parts};

/// Milliseconds of a finger in a timed round, shared by all fingers of a candidate; steps of bodies.
const WORK: usize = 400;
/// Numbers of fingers that are timed on one core; each divides [`WORK`].
const FINGERS: [usize; 6] = [1, 2, 5, 10, 20, 40];
/// Ratios of successive cells of a mesh.
const GROWTHS: [f64; 5] = [1.30, 1.20, Grading::STANDARD.growth, 1.06, 1.03];
/// Time steps, ms.
const STEPS_MS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
/// Nanoseconds of a millisecond.
const MS_NS: f64 = 1e6;

/// A run of the benchmark.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Machine on which the times were measured.
    pub host: String,
    /// Number of rounds; medians over them are reported.
    pub rounds: usize,
    /// Number of cells of each body in a simulated run.
    pub cells: usize,
    /// Whole fingers, over their number.
    pub fingers: Vec<FingersFigures>,
    /// Exponent of the power law of total cost over the number of fingers.
    pub fingers_power: f64,
    /// Parts of a finger, and fingers with an addition.
    pub parts: Vec<PartFigures>,
    /// The bodies, over meshes.
    pub meshes: Vec<CutFigures>,
    /// Slope of the line of a step's cost over the number of cells, ns per cell of each of three bodies.
    pub cell_ns: f64,
    /// Intercept of that line, ns.
    pub no_cells_ns: f64,
    /// Largest relative deviation of a mesh from that line.
    pub worst_off_line: f64,
    /// The bodies, over time steps.
    pub steps: Vec<CutFigures>,
}

/// Several fingers in turn on one core.
#[derive(Clone, Debug, Serialize)]
pub struct FingersFigures {
    /// Number of fingers.
    pub fingers: usize,
    /// Cost of a millisecond of one finger.
    #[serde(flatten)]
    pub cost: Cost,
}

/// A part of one finger, or a finger with an addition.
#[derive(Clone, Debug, Serialize)]
pub struct PartFigures {
    /// Description.
    pub name: &'static str,
    /// Cost of a millisecond.
    #[serde(flatten)]
    pub cost: Cost,
}

/// Both fingers, object and tile in one discretization.
#[derive(Clone, Debug, Serialize)]
pub struct CutFigures {
    /// Ratio of successive cells.
    pub growth: f64,
    /// Number of cells of each of the three slabs.
    pub cells: usize,
    /// Time step, ms.
    pub step_ms: f64,
    /// Time of a step, median, ns.
    pub step_ns: f64,
    /// Cost of a millisecond.
    #[serde(flatten)]
    pub cost: Cost,
    /// Errors against Eq. 6-5 to 6-7.
    pub errors: Worst,
}

/// Cost of a simulated millisecond.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Cost {
    /// Median, ns.
    pub ns: f64,
    /// Fastest round, ns.
    pub least_ns: f64,
    /// Median over the rounds of the ratio to the time of one finger.
    pub ratio: f64,
    /// Ratio of simulated time to median run time.
    pub times_real_time: f64,
}

impl Cost {
    /// The cost of a candidate that took `time` for `ms` simulated milliseconds.
    fn new(time: Time, ms: f64) -> Self {
        let ns = time.ns / ms;
        Self {
            ns,
            least_ns: time.least_ns / ms,
            ratio: time.ratio / ms,
            times_real_time: MS_NS / ns,
        }
    }
}

/// Runs the benchmark and reports each step to `progress`.
///
/// # Errors
/// The device refused the scene or left the contact.
pub fn measure(rounds: usize, progress: impl Fn(&str)) -> anyhow::Result<Figures> {
    let cuts = cuts();
    progress("errors of meshes and steps");
    let errors = cuts.iter().map(Cut::errors).collect::<anyhow::Result<Vec<_>>>()?;
    progress("fingers into contact");
    let mut banks = FINGERS.map(bank).into_iter().collect::<anyhow::Result<Vec<_>>>()?;
    let mut parts = Parts::new(WORK)?;
    let bodies = cuts.iter().map(|cut| cut.in_contact(OBJECT, FORCE_N));
    let mut bodies = bodies.collect::<anyhow::Result<Vec<_>>>()?;

    progress("timing on the host");
    let mut candidates: Vec<Candidate> = Vec::new();
    for bank in &mut banks {
        candidates.push(Box::new(|| {
            for _ in 0..WORK / bank.len() {
                bank.iter_mut().for_each(|finger| finger.step(FORCE_N));
            }
        }));
    }
    let parts_at = candidates.len();
    let (names, parts_run): (Vec<_>, Vec<_>) = parts.candidates().into_iter().unzip();
    candidates.extend(parts_run);
    let bodies_at = candidates.len();
    for body in &mut bodies {
        candidates.push(Box::new(|| (0..WORK).for_each(|_| body.sub_step())));
    }
    // The first is one finger.
    let times = side_by_side(&mut candidates, 0, WORK, rounds);
    drop(candidates);

    banks.iter_mut().flatten().try_for_each(Finger::check_contact)?;
    parts.check()?;
    let fingers: Vec<_> = FINGERS
        .iter()
        .zip(&times)
        .map(|(&fingers, &time)| FingersFigures { fingers, cost: Cost::new(time, 1.0) })
        .collect();
    let part = |(name, time): (_, &Time)| PartFigures { name, cost: Cost::new(*time, 1.0) };
    let of_cuts: Vec<_> = (cuts.iter().zip(errors))
        .zip(&times[bodies_at..])
        .map(|((cut, errors), time)| CutFigures {
            growth: cut.grading.growth,
            cells: cut.cells(),
            step_ms: cut.step_s * 1e3,
            step_ns: time.ns,
            cost: Cost::new(*time, cut.step_s * 1e3),
            errors,
        })
        .collect();
    let (meshes, steps) = of_cuts.split_at(GROWTHS.len());
    let by_cells: Vec<_> = meshes.iter().map(|m| (m.cells as f64, m.cost.ratio)).collect();
    let line = fit::line(&by_cells);
    let one_ns = times[0].ns;
    let all: Vec<_> =
        fingers.iter().map(|f| (f.fingers as f64, f.fingers as f64 * f.cost.ratio)).collect();
    Ok(Figures {
        host: host(),
        rounds,
        cells: Cut::RUN.cells(),
        fingers_power: fit::power(&all),
        fingers,
        parts: names.into_iter().zip(&times[parts_at..]).map(part).collect(),
        meshes: meshes.to_vec(),
        cell_ns: line.slope * one_ns,
        no_cells_ns: line.start * one_ns,
        worst_off_line: line.worst_off,
        steps: steps.to_vec(),
    })
}

/// Figures over meshes, then over time steps.
fn cuts() -> Vec<Cut> {
    let meshes =
        GROWTHS.map(|growth| Cut { grading: Grading { growth, ..Grading::STANDARD }, ..Cut::RUN });
    let steps = STEPS_MS.map(|step_ms| Cut { step_s: step_ms * 1e-3, ..Cut::RUN });
    meshes.into_iter().chain(steps).collect()
}

/// Fingers with different noise.
fn bank(count: usize) -> anyhow::Result<Vec<Finger>> {
    (1..=count as u64).map(Finger::in_contact).collect()
}
