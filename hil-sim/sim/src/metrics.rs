//! Figures of a run.

use std::collections::BTreeMap;

use serde::Serialize;
use thermal_plant::bridge::BridgeOutputs;
use thermal_plant::parameters::{self, FingerDraw};
use thermal_plant::{Plant, PlantConfig, STEP_S};

use crate::dose::cem43_min;
use crate::run::{Exchange, Outcome};
use crate::scene::{Draws, Scene};
use crate::speed::Speed;
use crate::trace::TraceRow;

/// Time after landing from which the largest error counts, s.
const AFTER_S: f64 = 0.05;

/// Errors during contact, mK.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ErrorFigures {
    /// Largest magnitude from 50 ms after each landing on; null if no contact lasted that long.
    pub max_after_50ms: Option<f64>,
    /// Root mean square over all contact time.
    pub rms: f64,
}

/// Smallest and largest value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extremes {
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
}

/// Mean and largest cost of a tick; null if the engine does not measure it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CostPerTick {
    /// Mean.
    pub mean: Option<f64>,
    /// Largest.
    pub max: Option<u64>,
}

/// Current through the module, A.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CurrentFigures {
    /// Largest magnitude.
    pub max_abs: f64,
    /// Root mean square.
    pub rms: f64,
}

/// A trip reported by the device.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TripRecord {
    /// Time, s.
    pub t_s: f64,
    /// Name of the fault.
    pub fault: String,
}

/// A reset of the device after its power-up.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResetRecord {
    /// Time, s; negative while the scene settles.
    pub t_s: f64,
    /// Cause: software, independent-watchdog, window-watchdog, brown-out, reset-pin or power-on.
    pub cause: String,
}

/// A line of the host that the device has refused.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RefusedLine {
    /// Time of the answer, s.
    pub t_s: f64,
    /// The line; null if none is known that the device may have meant.
    pub line: Option<String>,
    /// The answer.
    pub answer: String,
}

/// What was drawn of contact and finger, with the values that the run has.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrawFigures {
    /// Seed of the contact law.
    pub contact: Option<u64>,
    /// The finger's draw.
    pub finger: Option<FingerDraw>,
    /// Parameters of what was drawn, by key.
    pub parameters: BTreeMap<String, f64>,
}

/// The figures of a run, as `--json` prints them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Name of the engine.
    pub engine: &'static str,
    /// Name of the material.
    pub material: String,
    /// The object's layers and back ([`Object::description`](crate::scene::Object::description)), and what the device is
    /// told.
    pub object: String,
    /// Control ticks of the scene.
    pub ticks: usize,
    /// Skin on the display minus skin on the real object.
    pub skin_error_mk: Option<ErrorFigures>,
    /// Display minus the exact set-point for a nominal finger on the object as it is.
    pub display_error_mk: Option<ErrorFigures>,
    /// Skin on the display, °C.
    pub skin_c: Extremes,
    /// Thermal dose of the skin on the display, equivalent minutes at 43 °C ([`crate::dose`]).
    pub cem43_min: f64,
    /// Display's surface under the finger, °C.
    pub display_c: Extremes,
    /// Current through the module, over the whole scene.
    pub current_a: CurrentFigures,
    /// Electrical energy taken up by the module during the scene, J.
    pub energy_j: f64,
    /// Evaluations of `erfcx`.
    pub kernel_evaluations: Option<u64>,
    /// Instructions of the control tick, emulated.
    pub instructions_per_tick: CostPerTick,
    /// Cycles of the control tick, estimated.
    pub cycles_per_tick: CostPerTick,
    /// Fraction of the time in which the CPU is not asleep, estimated.
    pub cpu_load: Option<f64>,
    /// Largest stack use, emulated, bytes.
    pub stack_bytes: Option<u32>,
    /// How much faster than real time the run was.
    #[serde(flatten)]
    pub speed: Speed,
    /// Faults that the device reported.
    pub faults: Vec<TripRecord>,
    /// Resets of the device after its power-up.
    pub resets: Vec<ResetRecord>,
    /// Lines of the host that the device has answered from time zero on.
    pub answered_lines: usize,
    /// Those of them that it has refused.
    pub refused_lines: Vec<RefusedLine>,
    /// Draws of contact and finger; absent if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub draws: Option<DrawFigures>,
}

impl Figures {
    /// Names of the faults by which the device tripped, and `reset` for each reset.
    pub fn trips_and_resets(&self) -> Vec<String> {
        let trips = self.faults.iter().map(|tripped| tripped.fault.clone());
        trips.chain(self.resets.iter().map(|_| "reset".into())).collect()
    }
}

impl Figures {
    /// Largest skin error from 50 ms after each landing on, mK.
    pub fn skin_max_mk(&self) -> Option<f64> {
        self.skin_error_mk?.max_after_50ms
    }

    /// RMS skin error, mK.
    pub fn skin_rms_mk(&self) -> Option<f64> {
        Some(self.skin_error_mk?.rms)
    }
}

/// Time since the last landing on a present object, s, for each row; `None` without contact.
pub fn contact_times(scene: &Scene, outcome: &Outcome) -> Vec<Option<f64>> {
    let mut landed_s = None;
    let rows = outcome.trace.rows().iter();
    rows.map(|row| {
        if row.force_n > 0.0 && row.t_s >= scene.object.appears_t_s {
            Some(row.t_s - *landed_s.get_or_insert(row.t_s))
        } else {
            landed_s = None;
            None
        }
    })
    .collect()
}

/// Computes the figures.
pub fn figures(scene: &Scene, outcome: &Outcome) -> Figures {
    let rows = outcome.trace.rows();
    let evaluations = || {
        rows.iter()
            .filter_map(|row| row.device.as_ref())
            .filter_map(|device| device.evaluations.map(u64::from))
    };
    let skins = || rows.iter().map(|row| row.skin_c);
    let mut exchanges = outcome.exchanges();
    exchanges.retain(|exchange| exchange.t_s >= 0.0);
    Figures {
        engine: outcome.engine,
        material: scene.object.name.clone(),
        object: object(scene),
        ticks: rows.len().saturating_sub(1),
        skin_error_mk: errors(skin_errors(scene, outcome)),
        display_error_mk: errors(display_errors(scene, outcome).into_iter().flatten()),
        skin_c: range(skins()),
        // The last row begins no step.
        cem43_min: cem43_min(skins().take(rows.len().saturating_sub(1)), STEP_S),
        display_c: range(rows.iter().map(|row| row.display_c)),
        current_a: current(outcome),
        energy_j: outcome.electrical_j,
        kernel_evaluations: evaluations()
            .next()
            .zip(evaluations().next_back())
            .map(|(a, b)| b.saturating_sub(a)),
        instructions_per_tick: CostPerTick {
            mean: outcome.cost.map(|cost| cost.instructions_mean),
            max: outcome.cost.map(|cost| cost.instructions_max),
        },
        cycles_per_tick: CostPerTick {
            mean: outcome.cost.map(|cost| cost.cycles_mean),
            max: outcome.cost.map(|cost| cost.cycles_max),
        },
        cpu_load: outcome.cost.map(|cost| cost.load),
        stack_bytes: outcome.cost.and_then(|cost| cost.stack_bytes),
        speed: outcome.clock.speed(scene.duration_s),
        faults: faults(outcome),
        resets: resets(outcome),
        answered_lines: exchanges.len(),
        refused_lines: refused(&exchanges),
        draws: draws(scene),
    }
}

/// Time since the last landing, s, and error of the display, K, for each row; `None` without contact and, where finger or
/// object is no half-space, in the row of a landing.
pub fn display_errors(scene: &Scene, outcome: &Outcome) -> Vec<Option<(f64, f64)>> {
    let rows = outcome.trace.rows();
    let contacts = contact_times(scene, outcome);
    let exact_c = if scene.has_closed_form() {
        let rows = rows.iter().zip(&contacts);
        rows.map(|(row, since_s)| Some(scene.exact_setpoint_c((*since_s)?, row.force_n))).collect()
    } else {
        nominal_setpoints_c(scene, rows)
    };
    let rows = rows.iter().zip(contacts).zip(exact_c);
    rows.map(|((row, since_s), exact_c)| Some((since_s?, row.display_c - exact_c?))).collect()
}

/// The exact set-point for the scene's finger with nominal parameters, °C, for each row with a contact: that finger on the
/// object, as the plant solves it.
fn nominal_setpoints_c(scene: &Scene, rows: &[TraceRow]) -> Vec<Option<f64>> {
    let config =
        PlantConfig { start_s: 0.0, params: scene.nominal.clone(), ..scene.plant_config() };
    let Ok(mut plant) = Plant::new(&config) else {
        return vec![None; rows.len()];
    };
    rows.iter()
        .map(|row| {
            plant.set_force(row.force_n);
            let exact_c = plant.exact_display_c();
            plant.step(&BridgeOutputs::default());
            exact_c
        })
        .collect()
}

/// Time since the last landing, s, and error of the skin, K, at every row in contact.
pub fn skin_errors(scene: &Scene, outcome: &Outcome) -> impl Iterator<Item = (f64, f64)> {
    let rows = outcome.trace.rows().iter().zip(contact_times(scene, outcome));
    rows.filter_map(|(row, since_s)| Some((since_s?, row.skin_c - row.skin_real_c)))
}

/// Time since the landing, s, and difference of the display to the scene's course, K, at every row in contact; nothing without
/// a course.
pub fn course_errors(scene: &Scene, outcome: &Outcome) -> impl Iterator<Item = (f64, f64)> {
    let rows = outcome.trace.rows().iter();
    let rows = rows.zip(contact_times(scene, outcome));
    let course = scene.course.as_ref();
    rows.filter_map(move |(row, since_s)| {
        let since_s = since_s?;
        Some((since_s, row.display_c - course?.at(since_s)))
    })
}

fn range(values: impl Iterator<Item = f64>) -> Extremes {
    let none = Extremes { min: f64::INFINITY, max: f64::NEG_INFINITY };
    values.fold(none, |range, value| Extremes {
        min: range.min.min(value),
        max: range.max.max(value),
    })
}

fn current(outcome: &Outcome) -> CurrentFigures {
    let amperes = || outcome.trace.rows().iter().map(|row| row.current_a);
    let squares: f64 = amperes().map(|ampere| ampere * ampere).sum();
    CurrentFigures {
        max_abs: amperes().fold(0.0, |most, ampere| ampere.abs().max(most)),
        rms: (squares / outcome.trace.rows().len().max(1) as f64).sqrt(),
    }
}

/// Errors in mK from time since landing in s and error in K; `None` without contact.
pub fn errors(samples: impl Iterator<Item = (f64, f64)>) -> Option<ErrorFigures> {
    let (mut count, mut squares, mut max_k) = (0u32, 0.0, None::<f64>);
    for (since_s, error_k) in samples {
        count += 1;
        squares += error_k * error_k;
        if since_s >= AFTER_S {
            max_k = Some(max_k.unwrap_or(0.0).max(error_k.abs()));
        }
    }
    let rms = (squares / f64::from(count)).sqrt() * 1e3;
    (count > 0).then_some(ErrorFigures { max_after_50ms: max_k.map(|error_k| error_k * 1e3), rms })
}

fn draws(scene: &Scene) -> Option<DrawFigures> {
    let Draws { contact, finger, .. } = scene.draws;
    let parts = [contact.map(|_| "contact."), finger.map(|_| "finger.")];
    let drawn = |key: &str| parts.iter().flatten().any(|part| key.starts_with(part));
    let parameters: BTreeMap<_, _> = parameters::all(&scene.params)
        .into_iter()
        .filter(|parameter| drawn(&parameter.key))
        .map(|parameter| (parameter.key, parameter.value))
        .collect();
    (!parameters.is_empty()).then_some(DrawFigures { contact, finger, parameters })
}

/// The object, and that the device is told of a half-space if it is none.
fn object(scene: &Scene) -> String {
    let object = scene.object.description();
    if scene.object_as_half_space && !scene.object.is_half_space() {
        object + "; told: half-space"
    } else {
        object
    }
}

fn refused(exchanges: &[Exchange<'_>]) -> Vec<RefusedLine> {
    let refused = exchanges.iter().filter(|exchange| exchange.answer.starts_with("err"));
    refused
        .map(|exchange| RefusedLine {
            t_s: exchange.t_s,
            line: exchange.line.map(Into::into),
            answer: exchange.answer.into(),
        })
        .collect()
}

fn resets(outcome: &Outcome) -> Vec<ResetRecord> {
    let resets = outcome.resets.iter();
    resets.map(|reset| ResetRecord { t_s: reset.t_s, cause: reset.cause.to_string() }).collect()
}

/// The trips: every change into the state `tripped`.
fn faults(outcome: &Outcome) -> Vec<TripRecord> {
    let mut faults = Vec::new();
    let mut tripped = false;
    for row in outcome.trace.rows() {
        let Some(device) = &row.device else { continue };
        let now = device.fault().is_some();
        if now && !tripped {
            faults.push(TripRecord {
                t_s: row.t_s,
                fault: device.remark().unwrap_or_default().into(),
            });
        }
        tripped = now;
    }
    faults
}
