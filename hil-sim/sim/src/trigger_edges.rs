//! Rising edges at the trigger input, as a scene and the faults of the input's wire give them.

use std::collections::VecDeque;
use std::ops::Range;

use crate::scene::{FaultKind, Scene, ScheduledFault};

/// Level from which on a stuck input is high.
const HIGH: f64 = 0.5;

/// Time for which edges are computed at once, us: an input that chatters has too many for a whole run.
const COMPUTED_US: i64 = 1_000_000;

/// The rising edges of a run, one after the other.
#[derive(Debug)]
pub struct TriggerEdges {
    /// Those that are computed and still to come, us since time zero of the scene.
    ahead_us: VecDeque<i64>,
    /// Time up to which they are computed.
    computed_us: i64,
}

impl TriggerEdges {
    /// The edges from a time on, us since time zero of the scene.
    pub const fn new(from_us: i64) -> Self {
        Self { ahead_us: VecDeque::new(), computed_us: from_us }
    }

    /// The next edge of the scene before a time, us since time zero.
    pub fn next_before(&mut self, scene: &Scene, until_us: i64) -> Option<i64> {
        while self.ahead_us.is_empty() && self.computed_us < until_us {
            let range_us = self.computed_us..self.computed_us + COMPUTED_US;
            self.ahead_us = trigger_edges_us(scene, &range_us).into();
            self.computed_us = range_us.end;
        }
        self.ahead_us.pop_front_if(|us| *us < until_us)
    }
}

/// Times of the rising edges in a range, µs since time zero of the scene, in order. A stuck input has none but the one with
/// which it goes high; one that chatters has its own in addition.
pub fn trigger_edges_us(scene: &Scene, range_us: &Range<i64>) -> Vec<i64> {
    let to_us = |t_s: f64| (t_s * 1e6).round() as i64;
    let of_kind = |kind| {
        let faults = scene.faults.iter();
        faults.filter(move |fault| fault.fault.kind == kind)
    };
    let is_stuck = |us: i64| {
        of_kind(FaultKind::TriggerStuck)
            .any(|fault| us >= to_us(fault.t_s) && (us as f64) < fault.until_s * 1e6)
    };
    let sound = scene.triggers_s.iter().map(|t_s| to_us(*t_s));
    let goes_high = of_kind(FaultKind::TriggerStuck)
        .filter(|fault| fault.fault.value >= HIGH)
        .map(|fault| to_us(fault.t_s));
    let chatter = of_kind(FaultKind::TriggerChatter).flat_map(|fault| chatter_us(fault, range_us));
    let moving = sound.chain(chatter).filter(|us| !is_stuck(*us));
    let mut edges: Vec<_> = (moving.chain(goes_high)).filter(|us| range_us.contains(us)).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The edges of an input that chatters at the rate of the fault's value, from the first period that ends in the range on.
fn chatter_us(fault: &ScheduledFault, range_us: &Range<i64>) -> impl Iterator<Item = i64> {
    let period_us = 1e6 / fault.fault.value;
    let (from_us, until_us) = (fault.t_s * 1e6, fault.until_s * 1e6);
    let first = ((range_us.start as f64 - from_us) / period_us).floor();
    let end_us = until_us.min(range_us.end as f64 + period_us);
    (first.max(0.0) as u64..)
        .map(move |period| from_us + period as f64 * period_us)
        .take_while(move |us| *us < end_us)
        .map(|us| us.round() as i64)
}
