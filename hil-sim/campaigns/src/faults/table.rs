//! The matrix as text.

use std::fmt::Write;

use super::assessment::MILLISECONDS;
use super::{Breach, FaultRun, FaultSummary};

/// Largest width of the column of faults, characters; the uploads of objects are longer.
const FAULT_WIDTH_MAX: usize = 60;

/// One line for each fault, with its worst figures, followed by every run that broke a limit.
pub fn table(rows: &[FaultSummary]) -> String {
    let widths = rows.iter().map(|row| row.fault.len());
    let width = widths.max().unwrap_or(0).min(FAULT_WIDTH_MAX);
    let mut text = format!(
        "{:width$}  runs  detectable   to safe ms  skin C         CEM43  display C      reasons\n",
        "fault"
    );
    for row in rows {
        text += &line(row, width);
    }
    let runs: usize = rows.iter().map(|row| row.trials.len()).sum();
    let held = rows.iter().filter(|row| row.holds && !row.trials.is_empty()).count();
    let skipped = rows.iter().filter(|row| row.trials.is_empty()).count();
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "{runs} runs; {held} of {} faults held{}",
        rows.len() - skipped,
        if skipped > 0 {
            format!(", {skipped} mean nothing to this engine")
        } else {
            String::new()
        }
    );
    for row in rows {
        for trial in row.failing_runs() {
            let _ = writeln!(text, "{}: {}", row.fault, failing_run_text(trial));
        }
    }
    text
}

/// `ok`, or the names of the broken limits.
pub(super) fn outcome(row: &FaultSummary) -> String {
    if row.trials.is_empty() {
        return "-".into();
    }
    let mut breaches: Vec<Breach> =
        row.trials.iter().flat_map(|trial| trial.assessment.breaches.iter().copied()).collect();
    breaches.sort();
    breaches.dedup();
    if breaches.is_empty() {
        "ok".into()
    } else {
        let names: Vec<_> = breaches.iter().map(|breach| breach.name()).collect();
        names.join(",").to_uppercase()
    }
}

/// The cells of a row in the order of the columns: runs, detectable runs, longest time from the first symptom to zero
/// current, skin, dose, display, causes.
pub(super) fn cells(row: &FaultSummary) -> [String; 7] {
    let detectable =
        row.trials.iter().filter(|trial| trial.assessment.detectable_ms.is_some()).count();
    let took = row.most(|trial| trial.assessment.took_ms);
    let reasons: Vec<_> =
        (row.reasons().iter()).map(|(reason, count)| format!("{reason} {count}")).collect();
    let range = |least: Option<f64>, most: Option<f64>| match (least, most) {
        (Some(least), Some(most)) => format!("{:.2}..{most:.2}", -least),
        _ => "-".into(),
    };
    let cem43 = row.most(|trial| finite(trial.assessment.cem43_min));
    [
        row.trials.len().to_string(),
        detectable.to_string(),
        took.map_or("-".into(), |ms| format!("{ms:.0}")),
        range(
            row.most(|trial| finite(-trial.assessment.skin_c.min)),
            row.most(|trial| finite(trial.assessment.skin_c.max)),
        ),
        cem43.map_or("-".into(), |minutes| format!("{minutes:.3}")),
        range(
            row.most(|trial| finite(-trial.assessment.display_c.min)),
            row.most(|trial| finite(trial.assessment.display_c.max)),
        ),
        reasons.join(", "),
    ]
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn line(row: &FaultSummary, width: usize) -> String {
    let [runs, detectable, took, skin, cem43, display, reasons] = cells(row);
    format!(
        "{:width$}  {runs:>4}  {detectable:>10}  {took:>11}  {skin:<13}  {cem43:>5}  {display:<13}  {:<7} {reasons}{}\n",
        row.fault,
        outcome(row),
        if row.latent { " (latent)" } else { "" },
    )
}

/// A run that broke a limit, as text from which it can be repeated.
pub(super) fn failing_run_text(trial: &FaultRun) -> String {
    let assessment = &trial.assessment;
    let place = match trial.finger {
        Some(finger) => format!("{} of finger {finger}", trial.place),
        None => trial.place.into(),
    };
    match &assessment.ended {
        Some(ended) => {
            let names = assessment.names();
            format!("{names} in {place} at {:.3} s: {ended}", trial.t_s)
        }
        None => assessment.line(&place, trial.t_s, MILLISECONDS),
    }
}
