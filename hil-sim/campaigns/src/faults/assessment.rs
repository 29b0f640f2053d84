//! What came of a run, against what must be.

use serde::Serialize;
use thermal_sim::metrics::{Extremes, Figures};
use thermal_sim::named_enum;
use thermal_sim::run::Outcome;
use thermal_sim::trace::TraceRow;

use super::{ExpectedReaction, FaultCase, InjectionPoint};

/// Range of the skin, °C: pain begins at its ends.
const SKIN_C: std::ops::RangeInclusive<f64> = 13.0..=45.0;
/// Most of the dose, CEM43 in minutes.
const DOSE_MIN: f64 = 1.0;
/// Longest time from detectable to safe, ms.
const SAFE_MS: f64 = 50.0;
/// Decimals of a moment in s, and of times from it on in ms: of faults, which come at a tick, and of those that do not.
pub(super) const MILLISECONDS: (usize, usize) = (3, 0);
pub(super) const MICROSECONDS: (usize, usize) = (6, 1);
/// Current that is none, A.
const NONE_A: f64 = 1e-6;

named_enum! {
    /// What a run did that it must not.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Breach {
        /// The run ended with something that is not modelled.
        Ended = "ended",
        /// It tripped before the fault.
        Early = "early",
        /// The skin left 13 to 45 °C.
        Skin = "skin",
        /// A minute of CEM43 or more.
        Dose = "dose",
        /// Detectable, but current flowed later than 50 ms after that.
        Late = "late",
        /// Another reason than a right one, or none.
        Reason = "reason",
    }
}

/// What came of a run. Times count from the fault on, ms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunAssessment {
    /// When the first sign was reached.
    pub detectable_ms: Option<f64>,
    /// When the device first said that it is tripped, or was reset.
    pub detected_ms: Option<f64>,
    /// From when on no current flowed, if it stayed so.
    pub safe_ms: Option<f64>,
    /// From the first sign to that.
    pub took_ms: Option<f64>,
    /// What the device says in the end: its fault, `off` if it has restarted without one, or its state.
    pub reason: String,
    /// Skin on the display, °C.
    pub skin_c: Extremes,
    /// Dose of the skin, CEM43 in minutes.
    pub cem43_min: f64,
    /// Display, °C.
    pub display_c: Extremes,
    /// What must not be.
    pub breaches: Vec<Breach>,
    /// Why the run ended early.
    pub ended: Option<String>,
}

impl RunAssessment {
    /// A run that did not come to its end.
    pub(super) fn ended(error: &anyhow::Error) -> Self {
        let unknown = Extremes {
            min: f64::NAN,
            max: f64::NAN,
        };
        Self {
            detectable_ms: None,
            detected_ms: None,
            safe_ms: None,
            took_ms: None,
            reason: "?".into(),
            skin_c: unknown,
            cem43_min: f64::NAN,
            display_c: unknown,
            breaches: vec![Breach::Ended],
            ended: Some(format!("{error:#}")),
        }
    }

    /// What it did that it must not, in words.
    pub(super) fn names(&self) -> String {
        let names: Vec<_> = self.breaches.iter().map(|breach| breach.name()).collect();
        names.join(", ")
    }

    /// The figures of a run to its end, of a fault at a place and a time, s.
    pub(super) fn line(&self, place: &str, t_s: f64, (of_s, of_ms): (usize, usize)) -> String {
        let ms = |value: Option<f64>| value.map_or("-".into(), |ms| format!("{ms:.of_ms$} ms"));
        format!(
            "{} in {place} at {t_s:.of_s$} s: detectable {}, detected {}, safe {}, reason {}, skin {:.2} to {:.2} C, CEM43 \
             {:.3} min, display {:.2} to {:.2} C",
            self.names(),
            ms(self.detectable_ms),
            ms(self.detected_ms),
            ms(self.safe_ms),
            self.reason,
            self.skin_c.min,
            self.skin_c.max,
            self.cem43_min,
            self.display_c.min,
            self.display_c.max,
        )
    }

    /// Judges a run; `sound` are the rows of the same without the fault, if a sign needs them.
    pub(super) fn of(
        fault_case: &FaultCase,
        moment: InjectionPoint,
        outcome: &Outcome,
        figures: &Figures,
        sound: &[TraceRow],
    ) -> Self {
        let rows = outcome.trace.rows();
        let t_s = moment.t_s;
        // The fault is there from the first boundary at or after its time on.
        let from = rows.partition_point(|row| row.t_s < t_s - 1e-9);
        let symptoms = fault_case.symptoms.iter();
        let detectable_s = symptoms
            .filter_map(|sign| sign.reached_s(rows, sound, from, moment.place.tested_from_s()))
            .min_by(f64::total_cmp);
        let before = moment.place.has_tripped_before().map(|fault| fault.name());
        let detected_s = detected(outcome, from, t_s, before);
        let safe_s = safe(rows);
        let ms = |at_s: f64| (at_s - t_s) * 1e3;
        let end = End::of(outcome, t_s);
        let mut assessment = Self {
            detectable_ms: detectable_s.map(ms),
            detected_ms: detected_s.map(ms),
            safe_ms: safe_s.map(ms),
            took_ms: detectable_s
                .zip(safe_s)
                .map(|(sign_s, safe_s)| (safe_s - sign_s).max(0.0) * 1e3),
            reason: end.reason(before),
            skin_c: figures.skin_c,
            cem43_min: figures.cem43_min,
            display_c: figures.display_c,
            breaches: Vec::new(),
            ended: None,
        };
        assessment.judge(fault_case, &rows[..from], before);
        assessment
    }

    fn judge(&mut self, fault_case: &FaultCase, rows_before: &[TraceRow], before: Option<&str>) {
        let early = rows_before.iter().any(|row| {
            let device = row.device.as_ref();
            device.is_some_and(|device| {
                device.state == "tripped" && device.remark.as_deref() != before
            })
        });
        let reached = self.detectable_ms.is_some();
        let late = reached
            && !self
                .took_ms
                .is_some_and(|took_ms| took_ms <= SAFE_MS + 1e-6);
        let said = self.reason.as_str();
        let right = match fault_case.expected {
            ExpectedReaction::Trip(faults) => {
                let named = faults.iter().any(|fault| fault.name() == said);
                named || !reached && WORKING_STATES.contains(&said)
            }
            ExpectedReaction::Restart => said == OFF,
        };
        for (breach, is_so) in [
            (Breach::Early, early),
            (
                Breach::Skin,
                !SKIN_C.contains(&self.skin_c.min) || !SKIN_C.contains(&self.skin_c.max),
            ),
            (Breach::Dose, self.cem43_min >= DOSE_MIN),
            (Breach::Late, late),
            (Breach::Reason, !right),
        ] {
            if is_so {
                self.breaches.push(breach);
            }
        }
    }
}

const OFF: &str = "off";

/// The states in which the device continues to work without a fault.
pub(super) const WORKING_STATES: [&str; 5] = ["self-test", "ready", "armed", "preset", "contact"];

/// First trip from a row on that is not the one before, or first reset.
fn detected(outcome: &Outcome, from: usize, t_s: f64, before: Option<&str>) -> Option<f64> {
    let tripped = outcome.trace.rows()[from..].iter().find(|row| {
        let device = row.device.as_ref();
        device.is_some_and(|device| device.state == "tripped" && device.remark.as_deref() != before)
    });
    let reset = outcome.resets.iter().find(|reset| reset.t_s >= t_s - 1e-6);
    let times = [tripped.map(|row| row.t_s), reset.map(|reset| reset.t_s)];
    times.into_iter().flatten().min_by(f64::total_cmp)
}

/// From when on no current flows till the end; none if some does at the end.
fn safe(rows: &[TraceRow]) -> Option<f64> {
    let last = rows.iter().rposition(|row| row.current_a.abs() > NONE_A);
    rows.get(last.map_or(0, |last| last + 1)).map(|row| row.t_s)
}

/// What the device answers in the end.
struct End<'a> {
    /// State and fault.
    state: Option<(&'a str, &'a str)>,
    /// A fault that kept `clear` from being obeyed.
    still: Option<&'a str>,
}

impl<'a> End<'a> {
    fn of(outcome: &'a Outcome, t_s: f64) -> Self {
        let lines = || outcome.answers.iter().filter(|(at_s, _)| *at_s >= t_s);
        let word =
            |line: &'a str, key: &str| line.split(' ').find_map(|word| word.strip_prefix(key));
        let state = lines().rev().find_map(|(_, line)| {
            let line = line.strip_prefix("ok ")?;
            Some((word(line, "state=")?, word(line, "fault=")?))
        });
        let still = lines().find_map(|(_, line)| {
            let rest = line.strip_prefix("err fault ")?;
            rest.strip_suffix(" is still present")
        });
        Self { state, still }
    }

    /// The fault, or the state if there is none; a fault of before stands for what keeps it from being cleared.
    fn reason(&self, before: Option<&str>) -> String {
        match (self.state, self.still) {
            (None, _) => "silent".into(),
            (Some(("tripped", fault)), Some(still)) if Some(fault) == before => still.into(),
            (Some(("tripped", fault)), _) => fault.into(),
            (Some((state, _)), _) => state.into(),
        }
    }
}
