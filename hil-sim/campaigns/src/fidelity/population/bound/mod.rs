//! The learner against the bound of Cramér and Rao: what the readings of the heat-flux sensor can tell of a finger at most.
//!
//! ```text
//! display's surface in the run, finger and sensor with each parameter changed a little -> slopes of the readings
//!     -> information by a time, with that of the draw as a normal prior -> covariance -> deviation of contact resistance, tissue, skin
//! ```
//!
//! The display's surface counts as known, and the finger as one of layers with what was drawn. The skin's deviation is that on a
//! display which since landing has shown the object to a finger with the parameters' deviations of that time.

mod information;
mod parameters;

use std::array;
use std::collections::HashMap;
use std::fmt::Write;

use anyhow::Context;
use contact_model::finger::MEAN;
use contact_model::impedance::{Impedance, Relaxation};
use serde::Serialize;
use thermal_learner::LearnerOutput;
use thermal_plant::STEP_S;
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::metrics::skin_errors;
use thermal_sim::run::{Outcome, run};
use thermal_sim::scene::{AssumedFinger, Scene};

use super::{Population, PopulationCase, Way};
use information::{Information, deviation};
use parameters::{CONTACT, PARAMETERS, Touch, Vector, assumed_display_m2k_w, covariance};

/// Times since landing, s.
const TIMES_S: [f64; 3] = [0.05, 0.5, 2.0];
/// Change by which a slope is found, in prior deviations.
const CHANGE: f64 = 1e-3;
/// Draws whose covariance is the prior.
const PRIOR_DRAWS: u64 = 200;

/// Bound and error of a quantity, each an rms over contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Compared {
    /// Least standard deviation.
    pub bound: f64,
    /// Error of the device.
    pub error: f64,
}

/// What is known of fingers on an object some time after landing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoundRow {
    /// Name of the object.
    pub object: String,
    /// Time since landing, s.
    pub since_s: f64,
    /// Contact resistance with the display, relative.
    pub contact: Compared,
    /// Impedance of the tissue at the inverse of the time, relative: its effusivity, for a half-space.
    pub tissue: Compared,
    /// Skin, mK.
    pub skin_mk: Compared,
}

/// Covariance of what is drawn of fingers and sensors.
type Prior = [Vector; PARAMETERS];

/// The priors of a population: its draws by the object, and by whether the device is told that the finger was on a pad.
#[derive(Clone, Debug)]
pub struct Priors(HashMap<(String, bool), Prior>);

impl Priors {
    /// Those of the draws of a seed.
    ///
    /// # Errors
    /// A drawn scene contradicts itself, or its display has no sensor.
    pub fn of(population: Population, seed: u64) -> anyhow::Result<Self> {
        let mut drawn: HashMap<_, Vec<Vector>> = HashMap::new();
        for case in population.cases(seed, PRIOR_DRAWS)? {
            let scene = case.scene(Way::AsItIs)?;
            let alike = drawn.entry((case.object.name, is_on_pad(&scene)));
            alike.or_default().push(touch(&scene)?.parameters(&scene));
        }
        let priors = drawn.into_iter();
        Ok(Self(priors.map(|(of, drawn)| (of, covariance(&drawn))).collect()))
    }
}

fn is_on_pad(scene: &Scene) -> bool {
    scene.assumed_finger == AssumedFinger::MeanOnPad
}

fn touch(scene: &Scene) -> anyhow::Result<Touch> {
    let touch = Touch::of(scene);
    touch.context("the display has no sensor of the heat flux")
}

/// Bound and error of a case at each of the times.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundResult {
    population: Population,
    object: String,
    at: [[Compared; 3]; TIMES_S.len()],
}

impl BoundResult {
    /// Runs a case natively up to each time, and compares what the device has learnt.
    ///
    /// # Errors
    /// The device stopped, or refused the scene.
    pub fn run(case: &PopulationCase, priors: &Priors) -> anyhow::Result<Self> {
        let scene = case.scene(Way::AsItIs)?;
        let prior = (priors.0).get(&(case.object.name.clone(), is_on_pad(&scene)));
        let prior = prior.context("no prior of this population")?;
        let touch = touch(&scene)?;
        let mut at = [[Compared::default(); 3]; TIMES_S.len()];
        let mut last = None;
        for (since_s, at) in TIMES_S.into_iter().zip(&mut at) {
            let (outcome, learnt) = run_until(&scene, since_s)?;
            let assumed_m2k_w = assumed_display_m2k_w(&scene);
            let factor = learnt.resistance_factor.to_num::<f64>();
            at[0].error = (factor * assumed_m2k_w / touch.display_m2k_w()).ln();
            let s_1_s = since_s.recip();
            at[1].error =
                (learnt_impedance_m2k_w(&learnt, s_1_s) / touch.impedance_m2k_w(s_1_s)).ln();
            let error =
                skin_errors(&scene, &outcome).find(|(t_s, _)| *t_s >= since_s - 0.5 * STEP_S);
            at[2].error = 1e3 * error.map_or(0.0, |(_, error_k)| error_k);
            last = Some(outcome);
        }
        let rows = last.iter().flat_map(|outcome| outcome.trace.rows());
        // The step that ends in the first row with force had none.
        let display_c: Vec<_> =
            rows.skip_while(|row| row.force_n == 0.0).map(|row| row.display_c).collect();
        for (at, bounds) in at.iter_mut().zip(bounds(&touch, prior, &display_c)) {
            for (compared, bound) in at.iter_mut().zip(bounds) {
                compared.bound = bound;
            }
        }
        Ok(Self { population: case.population, object: case.object.name.clone(), at })
    }
}

/// A scene up to a time since landing, s, and what the device has learnt by then.
fn run_until(scene: &Scene, since_s: f64) -> anyhow::Result<(Outcome, LearnerOutput)> {
    let landing_s = scene.forces.first().map_or(0.0, |force| force.t_s);
    let scene = Scene { duration_s: landing_s + since_s, ..scene.clone() };
    let mut engine = NativeEngine::new(World::new(&scene)?);
    let outcome = run(&scene, &mut engine, |_| ())?;
    let learnt = engine.learnt().copied();
    Ok((outcome, learnt.context("the device has learnt nothing")?))
}

/// Impedance of the learnt tissue, m2 K/W, at a Laplace variable, 1/s.
fn learnt_impedance_m2k_w(learnt: &LearnerOutput, s_1_s: f64) -> f64 {
    let [integrator, others @ ..] = MEAN.impedance.relaxations else {
        return MEAN.impedance.direct_m2k_w;
    };
    let [weights @ .., direct] = learnt.weights.map(f64::from);
    let weighted = others
        .iter()
        .zip(weights)
        .map(|(one, weight)| Relaxation { gain_m2k_j: weight * one.gain_m2k_j, ..*one });
    let relaxations: Vec<_> = std::iter::once(*integrator).chain(weighted).collect();
    let impedance =
        Impedance { direct_m2k_w: direct * MEAN.impedance.direct_m2k_w, relaxations: &relaxations };
    impedance.at(s_1_s)
}

/// Least deviations of contact resistance and tissue, relative, and of the skin, mK, at each of the times, on a display whose surface,
/// deg C, has this course.
fn bounds(touch: &Touch, prior: &Prior, display_c: &[f64]) -> [[f64; 3]; TIMES_S.len()] {
    let steps = display_c.len().saturating_sub(1);
    let exact_c = touch.exact_display_c(steps);
    let (readings, skin) = (touch.readings_w_m2(display_c), touch.on_display(&exact_c).skin_c);
    let mut slopes: Vec<Vector> = vec![[0.0; PARAMETERS]; steps];
    let mut of_skin: Vec<Vector> = vec![[0.0; PARAMETERS]; steps + 1];
    let mut of_tissue = [[0.0; PARAMETERS]; TIMES_S.len()];
    for parameter in 0..PARAMETERS {
        let change = CHANGE * prior[parameter][parameter].sqrt();
        let changed = touch.changed(parameter, change);
        let other = changed.readings_w_m2(display_c);
        for (slopes, (other, own)) in slopes.iter_mut().zip(other.iter().zip(&readings)) {
            slopes[parameter] = (other - own) / change;
        }
        let shown = touch.on_display(&changed.exact_display_c(steps)).skin_c;
        for (slopes, (other, own)) in of_skin.iter_mut().zip(shown.iter().zip(&skin)) {
            slopes[parameter] = 1e3 * (other - own) / change;
        }
        for (slopes, since_s) in of_tissue.iter_mut().zip(TIMES_S) {
            let [other, own] = [&changed, touch].map(|one| one.impedance_m2k_w(since_s.recip()));
            slopes[parameter] = (other / own).ln() / change;
        }
    }
    let mut of_contact = [0.0; PARAMETERS];
    of_contact[CONTACT] = 1.0;
    let mut information = Information::of_prior(prior);
    let mut readings = slopes.iter();
    let mut taken = 0;
    array::from_fn(|i| {
        let until = ((TIMES_S[i] / STEP_S).round() as usize).min(steps);
        for slopes in readings.by_ref().take(until - taken) {
            information.add(slopes, touch.noise_w_m2());
        }
        taken = until;
        let covariance = information.covariance();
        [&of_contact, &of_tissue[i], &of_skin[until]].map(|slopes| deviation(&covariance, slopes))
    })
}

/// The rows of a population, by object and time; none without results.
pub fn rows(population: Population, results: &[BoundResult]) -> Vec<BoundRow> {
    let own = results.iter().filter(|one| one.population == population);
    let own: Vec<_> = own.collect();
    let mut objects: Vec<&str> = Vec::new();
    for result in &own {
        if !objects.contains(&result.object.as_str()) {
            objects.push(&result.object);
        }
    }
    let mut rows = Vec::new();
    for object in objects {
        let of_object = own.iter().filter(|one| one.object == object);
        let of_object: Vec<_> = of_object.collect();
        for (i, since_s) in TIMES_S.into_iter().enumerate() {
            let rms = |value: &dyn Fn(&BoundResult) -> f64| {
                let squares = of_object.iter().map(|one| value(one).powi(2));
                (squares.sum::<f64>() / of_object.len() as f64).sqrt()
            };
            let [contact, tissue, skin_mk] = array::from_fn(|quantity| Compared {
                bound: rms(&|one| one.at[i][quantity].bound),
                error: rms(&|one| one.at[i][quantity].error),
            });
            rows.push(BoundRow { object: object.into(), since_s, contact, tissue, skin_mk });
        }
    }
    rows
}

/// The rows as text.
pub fn table(rows: &[BoundRow]) -> String {
    let mut text = String::new();
    if rows.is_empty() {
        return text;
    }
    text += "bound of Cramér and Rao, rms error and their ratio    contact resistance, %         tissue, %              skin, mK\n";
    for row in rows {
        let BoundRow { object, since_s, contact, tissue, skin_mk } = row;
        let part = |scale: f64, Compared { bound, error }: &Compared| {
            format!("{:>8.2}{:>8.2}{:>6.1}", scale * bound, scale * error, error / bound)
        };
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{object:30} after {since_s:>4} s    {}  {}  {}",
            part(100.0, contact),
            part(100.0, tissue),
            part(1.0, skin_mk)
        );
    }
    text
}

#[cfg(test)]
mod tests;
