//! Per cent correct in discriminating a touch on a display from a touch of the object itself.
//!
//! The largest error of the skin is assumed to last for the whole touch, so that the results are upper bounds: the error is smaller most
//! of the time, and at the depth of the receptors.

use std::fmt;

use serde::Serialize;

use super::chapter_3::falls_of_chapter_3;
use super::report::Falls;
use super::worth::percent_correct;
use super::{PredictionError, mean};
use crate::ObserverParams;

/// A touch on the display, and how far the skin was off.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderedTouch {
    /// The touches that it belongs to, such as all with one sensor.
    pub group: String,
    /// Name of the object, which begins with its material.
    pub object: String,
    /// Largest error of the skin from 50 ms after landing on, mK, 0 or more.
    pub max_after_50ms_mk: f64,
    /// The same from half a second on.
    pub max_after_500ms_mk: f64,
}

/// Per cent of trials in which an observer finds the colder of the object and its rendering; 50 is chance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ToldApart {
    /// The touches.
    pub group: String,
    /// The observer.
    pub observer: &'static str,
    /// Number of touches.
    pub touches: usize,
    /// By the error from 50 ms on: mean over the touches, and 95th percentile.
    pub after_50ms: [f64; 2],
    /// By the error from half a second on.
    pub after_500ms: [f64; 2],
}

/// All groups under all observers; `Display` writes it as a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ToldApartReport {
    /// Rows, group by group.
    pub rows: Vec<ToldApart>,
}

/// What the errors of touches on a display are worth, in the order in which their groups first come.
///
/// # Errors
/// An object whose name begins with no material of Table 3-3, or the simulated bench.
pub fn told_apart(touches: &[RenderedTouch]) -> Result<ToldApartReport, PredictionError> {
    let falls = falls_of_chapter_3()?;
    let mut groups: Vec<&str> = Vec::new();
    for touch in touches {
        if !groups.contains(&touch.group.as_str()) {
            groups.push(&touch.group);
        }
    }
    let mut rows = Vec::new();
    for group in groups {
        let own = touches.iter().filter(|touch| touch.group == group);
        let own: Vec<_> = own
            .map(|touch| Ok((touch, fall_k(&falls, &touch.object)?)))
            .collect::<Result<_, PredictionError>>()?;
        rows.extend(OBSERVERS.map(|one| row(group, &one, &own)));
    }
    Ok(ToldApartReport { rows })
}

/// An observer: name, parameters, and whether it touches the object. On a thermode the finger rests, and the error is all that
/// changes.
type Observer = (&'static str, ObserverParams, bool);

const OBSERVERS: [Observer; 3] = [
    ("touch", ObserverParams::TOUCH, true),
    ("thermode, fingertip", ObserverParams::THERMODE_FINGERTIP, false),
    ("thermode, thenar", ObserverParams::THERMODE_THENAR, false),
];

fn row(group: &str, observer: &Observer, touches: &[(&RenderedTouch, f64)]) -> ToldApart {
    let (name, params, touches_object) = observer;
    let of = |error_mk: fn(&RenderedTouch) -> f64| {
        let percent = touches.iter().map(|(touch, fall_k)| {
            let fall_k = if *touches_object { *fall_k } else { 0.0 };
            percent_correct(params, fall_k, error_mk(touch))
        });
        let mut percent: Vec<f64> = percent.collect();
        percent.sort_by(f64::total_cmp);
        // The smallest value that 95 of 100 do not exceed.
        let at = (0.95 * percent.len() as f64).ceil() as usize;
        [mean(percent.iter().copied()), percent[at.max(1) - 1]]
    };
    ToldApart {
        group: group.into(),
        observer: name,
        touches: touches.len(),
        after_50ms: of(|touch| touch.max_after_50ms_mk),
        after_500ms: of(|touch| touch.max_after_500ms_mk),
    }
}

/// Fall on the material with which the name of an object begins, K.
fn fall_k(falls: &Falls, object: &str) -> Result<f64, PredictionError> {
    let material = object.split([' ', ',']).next().unwrap_or_default();
    let found = falls.falls_k.iter().find(|(known, _)| known == material);
    found.map(|(_, fall_k)| *fall_k).ok_or_else(|| PredictionError::UnknownMaterial {
        object: object.into(),
        known: falls.falls_k.iter().map(|(name, _)| name.clone()).collect(),
    })
}

impl fmt::Display for ToldApartReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Per cent of trials in which the colder of an object and its rendering is found, if the largest error lasted; 50 is chance"
        )?;
        writeln!(
            f,
            "  {:18} {:20} {:>7}  {:>15}  {:>15}",
            "touches", "observer", "number", "from 50 ms on", "from 0.5 s on"
        )?;
        writeln!(
            f,
            "  {:18} {:20} {:>7}  {:>7} {:>7}  {:>7} {:>7}",
            "", "", "", "mean", "95 %", "mean", "95 %"
        )?;
        for row in &self.rows {
            let ([early, early_95], [late, late_95]) = (row.after_50ms, row.after_500ms);
            writeln!(
                f,
                "  {:18} {:20} {:7}  {early:7.1} {early_95:7.1}  {late:7.1} {late_95:7.1}",
                row.group, row.observer, row.touches
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
