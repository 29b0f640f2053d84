//! Assessment of a run against the limits.

use serde::Serialize;
use thermal_client::client::Telemetry;
use thermal_sim::metrics::{Extremes, Figures};
use thermal_sim::named_enum;
use thermal_sim::run::Outcome;
use thermal_sim::trace::TraceRow;

use super::{ExpectedReaction, FaultCase, InjectionPoint, LearningExpected};

/// Allowed skin temperature, °C: between the thresholds of pain.
const SKIN_C: std::ops::RangeInclusive<f64> = 13.0..=45.0;
/// Limit of the dose, CEM43 in minutes.
const DOSE_MIN: f64 = 1.0;
/// Longest allowed time from the first symptom to zero current, ms.
const SAFE_MS: f64 = 50.0;
/// Time after a fault of the learning from which the skin is compared, s.
const COMPARED_AFTER_S: f64 = 0.2;
/// Decimals of the time of a fault in s and of times after it in ms, for faults at a tick and for bit flips between ticks.
pub(super) const MILLISECONDS: (usize, usize) = (3, 0);
pub(super) const MICROSECONDS: (usize, usize) = (6, 1);
/// Magnitude up to which a current counts as zero, A.
const NONE_A: f64 = 1e-6;

named_enum! {
    /// A limit that a run broke.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Breach {
        /// The run ended with something that is not modelled.
        Ended = "ended",
        /// The device tripped before the fault.
        Early = "early",
        /// The skin temperature left the range of 13 to 45 °C.
        Skin = "skin",
        /// The dose reached one minute of CEM43.
        Dose = "dose",
        /// Current flowed more than 50 ms after the first symptom.
        Late = "late",
        /// The device reported a wrong trip cause, or none.
        Reason = "reason",
        /// The set-point differed from that without the fault, which must not change it; or the skin by more than it may from that on
        /// a display that assumes its finger, or has learnt it without the fault.
        Changed = "changed",
        /// The device reported what it cannot know about the finger.
        Knowledge = "knowledge",
        /// One of five fingers, which does not have the fault, did not render as without it.
        Others = "others",
    }
}

/// Result of a run. Times count from the fault, ms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunAssessment {
    /// Time of the first symptom.
    pub detectable_ms: Option<f64>,
    /// Time of the first trip or reset.
    pub detected_ms: Option<f64>,
    /// Time after which no current flowed.
    pub safe_ms: Option<f64>,
    /// Time from the first symptom to zero current.
    pub took_ms: Option<f64>,
    /// State of the device at the end: its trip cause, `off` after a restart without a fault, or its state.
    pub reason: String,
    /// Skin on the display, °C.
    pub skin_c: Extremes,
    /// Dose of the skin, CEM43 in minutes.
    pub cem43_min: f64,
    /// Display, °C.
    pub display_c: Extremes,
    /// Largest difference of the skin from the run that it is compared with, for faults of the learning, K.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skin_difference_k: Option<f64>,
    /// What the device knows of the finger, with a heat-flux sensor, as its word in the protocol.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub knowledge: Option<String>,
    /// Limits that the run broke.
    pub breaches: Vec<Breach>,
    /// Why the run ended early.
    pub ended: Option<String>,
}

impl RunAssessment {
    /// The assessment of a run that ended early.
    pub(super) fn ended(error: &anyhow::Error) -> Self {
        let unknown = Extremes { min: f64::NAN, max: f64::NAN };
        Self {
            detectable_ms: None,
            detected_ms: None,
            safe_ms: None,
            took_ms: None,
            reason: "?".into(),
            skin_c: unknown,
            cem43_min: f64::NAN,
            display_c: unknown,
            skin_difference_k: None,
            knowledge: None,
            breaches: vec![Breach::Ended],
            ended: Some(format!("{error:#}")),
        }
    }

    /// Names of the broken limits.
    pub(super) fn names(&self) -> String {
        let names: Vec<_> = self.breaches.iter().map(|breach| breach.name()).collect();
        names.join(", ")
    }

    /// The figures of a completed run as text, with the scene and the time of the fault, s.
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

    /// Assesses a run by the rows of its trace; `fault_free` are the rows of the same scene without the fault, if a symptom needs them.
    pub(super) fn new(
        fault_case: &FaultCase,
        point: InjectionPoint,
        outcome: &Outcome,
        rows: &[TraceRow],
        figures: &Figures,
        fault_free: &[TraceRow],
    ) -> Self {
        let t_s = point.t_s;
        // The fault is present from the first boundary at or after its time.
        let from = rows.partition_point(|row| row.t_s < t_s - 1e-9);
        let symptoms = fault_case.symptoms.iter();
        let detectable_s = symptoms
            .filter_map(|symptom| {
                symptom.onset_s(rows, fault_free, from, point.scene.tested_from_s())
            })
            .min_by(f64::total_cmp);
        let before = point.scene.has_tripped_before().map(|fault| fault.name());
        let detected_s = detected(outcome, from, t_s, before);
        let safe_s = safe(rows);
        let ms = |at_s: f64| (at_s - t_s) * 1e3;
        let end = FinalAnswers::new(outcome, t_s);
        let mut assessment = Self {
            detectable_ms: detectable_s.map(ms),
            detected_ms: detected_s.map(ms),
            safe_ms: safe_s.map(ms),
            took_ms: detectable_s
                .zip(safe_s)
                .map(|(onset_s, safe_s)| (safe_s - onset_s).max(0.0) * 1e3),
            reason: end.reason(before),
            skin_c: figures.skin_c,
            cem43_min: figures.cem43_min,
            display_c: figures.display_c,
            skin_difference_k: (fault_case.learning)
                .and_then(|_| skin_difference_k(rows, fault_free, t_s + COMPARED_AFTER_S)),
            knowledge: end.knowledge.map(Into::into),
            breaches: Vec::new(),
            ended: None,
        };
        let changed = match fault_case.learning {
            Some(LearningExpected { skin_max_k, .. }) => {
                let difference_k = assessment.skin_difference_k;
                !difference_k.is_some_and(|difference_k| difference_k <= skin_max_k)
            }
            None => fault_case.unchanged && setpoints_differ(rows, fault_free),
        };
        assessment.judge(fault_case, &point, &rows[..from], before, changed);
        assessment
    }

    fn judge(
        &mut self,
        fault_case: &FaultCase,
        point: &InjectionPoint,
        rows_before: &[TraceRow],
        before: Option<&str>,
        changed: bool,
    ) {
        let early = rows_before.iter().any(|row| {
            let device = row.device.as_ref();
            let fault = device.and_then(Telemetry::fault);
            fault.is_some_and(|fault| Some(fault.name()) != before)
        });
        let reached = self.detectable_ms.is_some();
        let late = reached && !self.took_ms.is_some_and(|took_ms| took_ms <= SAFE_MS + 1e-6);
        let said = self.reason.as_str();
        let is_misjudged = (fault_case.learning)
            .is_some_and(|learning| !learning.allows(self.knowledge.as_deref(), point.scene));
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
            (Breach::Changed, changed),
            (Breach::Knowledge, is_misjudged),
        ] {
            if is_so {
                self.breaches.push(breach);
            }
        }
    }
}

const OFF: &str = "off";

/// The states in which the device continues to work without a fault.
pub(super) const WORKING_STATES: [&str; 6] =
    ["self-test", "ready", "armed", "preset", "contact", "stimulus"];

/// Whether the device works without a fault at the end of a run.
pub(super) fn works_at_end(outcome: &Outcome, t_s: f64) -> bool {
    let reason = FinalAnswers::new(outcome, t_s).reason(None);
    WORKING_STATES.contains(&reason.as_str())
}

/// Time of the first reset or of the first trip from row `from` on, except the trip before the fault.
fn detected(outcome: &Outcome, from: usize, t_s: f64, before: Option<&str>) -> Option<f64> {
    let tripped = outcome.trace.rows()[from..].iter().find(|row| {
        let device = row.device.as_ref();
        let fault = device.and_then(Telemetry::fault);
        fault.is_some_and(|fault| Some(fault.name()) != before)
    });
    let reset = outcome.resets.iter().find(|reset| reset.t_s >= t_s - 1e-6);
    let times = [tripped.map(|row| row.t_s), reset.map(|reset| reset.t_s)];
    times.into_iter().flatten().min_by(f64::total_cmp)
}

/// Whether a set-point differs from that of the other run in a tick of which both have telemetry, or there is no such tick.
fn setpoints_differ(rows: &[TraceRow], others: &[TraceRow]) -> bool {
    let both = rows.iter().zip(others);
    let mut both =
        both.filter_map(|(row, other)| row.device.as_ref().zip(other.device.as_ref())).peekable();
    both.peek().is_none() || both.any(|(one, other)| one.setpoint_c != other.setpoint_c)
}

/// Largest difference of the skin on the display from that of the other run, K, from a time on, s; none without a row of both.
fn skin_difference_k(rows: &[TraceRow], others: &[TraceRow], from_s: f64) -> Option<f64> {
    let both = rows.iter().zip(others).filter(|(row, _)| row.t_s >= from_s);
    both.map(|(row, other)| (row.skin_c - other.skin_c).abs()).max_by(f64::total_cmp)
}

/// Time after which no current flows; `None` if current flows at the end.
fn safe(rows: &[TraceRow]) -> Option<f64> {
    let last = rows.iter().rposition(|row| row.current_a.abs() > NONE_A);
    rows.get(last.map_or(0, |last| last + 1)).map(|row| row.t_s)
}

/// Answers of the device at the end of a run.
struct FinalAnswers<'a> {
    /// State and fault of the last `state` answer.
    state: Option<(&'a str, &'a str)>,
    /// The present fault for which the device refused `clear`.
    refused_clear: Option<&'a str>,
    /// Word of the last `flux` answer for what is known of the finger.
    knowledge: Option<&'a str>,
}

impl<'a> FinalAnswers<'a> {
    fn new(outcome: &'a Outcome, t_s: f64) -> Self {
        let lines = || outcome.answers.iter().filter(|(at_s, _)| *at_s >= t_s);
        let word =
            |line: &'a str, key: &str| line.split(' ').find_map(|word| word.strip_prefix(key));
        let state = lines().rev().find_map(|(_, line)| {
            let line = line.strip_prefix("ok ")?;
            Some((word(line, "state=")?, word(line, "fault=")?))
        });
        let refused_clear = lines().find_map(|(_, line)| {
            let rest = line.strip_prefix("err fault ")?;
            rest.strip_suffix(" is still present")
        });
        Self {
            state,
            refused_clear,
            knowledge: lines().rev().find_map(|(_, line)| word(line, "finger=")),
        }
    }

    /// The fault, or the state if there is none. If a trip before the injection was not cleared, the fault that prevented it.
    fn reason(&self, before: Option<&str>) -> String {
        match (self.state, self.refused_clear) {
            (None, _) => "silent".into(),
            (Some(("tripped", fault)), Some(refused_clear)) if Some(fault) == before => {
                refused_clear.into()
            }
            (Some(("tripped", fault)), _) => fault.into(),
            (Some((state, _)), _) => state.into(),
        }
    }
}
