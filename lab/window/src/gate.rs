//! What the session waits for next.

use std::time::Duration;

use thermal_session::{Phase, Procedure, Rest, TrialRules};

/// What ends the present phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Gate {
    /// What it is.
    pub what: &'static str,
    /// Its value now, and what it must be.
    pub value: Option<String>,
    /// How much of it is reached, 0 to 1.
    pub reached: f32,
    /// Time that is left, and what happens then.
    pub left: Option<(Duration, &'static str)>,
}

/// How far the skin is: its mean and how long it has been within the gate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SkinGate {
    /// Mean over the last second of the finger that is farthest from the gate, °C.
    pub skin_c: Option<f64>,
    /// Since when all fingers are within it.
    pub holds_since: Option<Duration>,
}

impl SkinGate {
    /// Takes note of the fingers' means.
    pub fn observe(
        &mut self,
        rest: &Rest,
        means: impl Iterator<Item = Option<f64>>,
        now: Duration,
    ) {
        let distance = |mean: Option<f64>| mean.map_or(f64::INFINITY, |c| (c - rest.skin_c).abs());
        let farthest = means.max_by(|a, b| distance(*a).total_cmp(&distance(*b))).flatten();
        self.skin_c = farthest;
        self.holds_since =
            if distance(farthest) <= rest.within_k { self.holds_since.or(Some(now)) } else { None };
    }
}

/// What a phase waits for.
pub(crate) struct Waiting<'a> {
    pub phase: Phase,
    pub since: Duration,
    pub rest: Option<&'a Rest>,
    pub rules: &'a TrialRules,
    pub break_s: f64,
    pub skin: &'a SkinGate,
    pub landed_at: Option<Duration>,
}

impl Waiting<'_> {
    /// The gate at a time.
    pub fn gate(&self, now: Duration) -> Option<Gate> {
        match self.phase {
            Phase::Rest => self.skin_gate(now),
            Phase::Reach => match self.rules.procedure {
                Procedure::Touch { reach_s, .. } => {
                    Some(self.timer("time to move", reach_s, "then the tone to touch", now))
                }
                Procedure::Intervals { .. } => None,
            },
            Phase::Contact => Some(self.contact_gate(now)),
            Phase::Respond => {
                Some(self.timer("answer", self.rules.answer_s, "then it is too late", now))
            }
            Phase::Break => Some(self.timer("break", self.break_s, "then it may end", now)),
            Phase::Connect | Phase::Prepare | Phase::Return | Phase::End => None,
        }
    }

    fn skin_gate(&self, now: Duration) -> Option<Gate> {
        let rest = self.rest?;
        let mean = self.skin.skin_c.map_or("not known".into(), |c| format!("{c:.2} °C"));
        let held = self.skin.holds_since.map_or(Duration::ZERO, |at| now.saturating_sub(at));
        let for_s = rest.for_s.max(f64::EPSILON);
        Some(Gate {
            what: "skin at rest",
            value: Some(format!(
                "{mean}; wanted {:.2} ± {:.2} °C for {:.0} s, held for {:.0} s",
                rest.skin_c,
                rest.within_k,
                rest.for_s,
                held.as_secs_f64().min(rest.for_s)
            )),
            reached: (held.as_secs_f64() / for_s).min(1.0) as f32,
            left: Some((left(self.since, rest.timeout_s, now), "then you are asked")),
        })
    }

    fn contact_gate(&self, now: Duration) -> Gate {
        match self.rules.procedure {
            Procedure::Intervals { interval_s, gap_s } => {
                self.timer("two intervals", 2.0 * interval_s + gap_s, "then the answer", now)
            }
            Procedure::Touch { max_s, .. } => match self.landed_at {
                Some(since) => timer("contact", since, max_s, "then the tone to lift", now),
                None => self.timer("landing", self.rules.land_s, "then the trial is void", now),
            },
        }
    }

    fn timer(&self, what: &'static str, length_s: f64, then: &'static str, now: Duration) -> Gate {
        timer(what, self.since, length_s, then, now)
    }
}

fn timer(
    what: &'static str,
    since: Duration,
    length_s: f64,
    then: &'static str,
    now: Duration,
) -> Gate {
    let left = left(since, length_s, now);
    let reached = 1.0 - left.as_secs_f64() / length_s.max(f64::EPSILON);
    Gate { what, value: None, reached: reached.clamp(0.0, 1.0) as f32, left: Some((left, then)) }
}

fn left(since: Duration, length_s: f64, now: Duration) -> Duration {
    let length = Duration::try_from_secs_f64(length_s).unwrap_or_default();
    (since + length).saturating_sub(now)
}
