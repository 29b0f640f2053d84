//! The results of bit flips as text.

use std::fmt::Write;

use super::{FlipEffect, FlipRegion, FlipResult};
use crate::faults::Breach;
use crate::faults::assessment::MICROSECONDS;

/// Table of effects by region, with the causes of trips, followed by every flip that broke a limit or ended its run.
pub fn flip_table(runs: &[FlipResult]) -> String {
    let mut text = format!("{:<24}", "");
    for region in FlipRegion::ALL {
        text += &format!("{:>9}", region.name());
    }
    text += "      all\n";
    for class in FlipEffect::ALL {
        line(&mut text, class.name(), runs, |run| run.class == class);
        if class == FlipEffect::Tripped {
            let mut reasons: Vec<_> = (runs.iter())
                .filter(|run| run.class == class)
                .map(|run| run.assessment.reason.as_str())
                .collect();
            reasons.sort_unstable();
            reasons.dedup();
            for reason in reasons {
                let by = |run: &FlipResult| run.class == class && run.assessment.reason == reason;
                line(&mut text, &format!("  {reason}"), runs, by);
            }
        }
        if class == FlipEffect::Broken {
            for breach in Breach::ALL {
                let broke = |run: &FlipResult| {
                    run.class == class && run.assessment.breaches.contains(&breach)
                };
                if runs.iter().any(broke) {
                    line(&mut text, &format!("  {}", breach.name()), runs, broke);
                }
            }
        }
    }
    line(&mut text, "all", runs, |_| true);
    let most = (runs.iter())
        .filter(|run| run.class == FlipEffect::Differs)
        .filter_map(|run| Some((run.deviation_k?, run.number)))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    // Writing to a String cannot fail.
    if let Some((kelvin, number)) = most {
        let _ = writeln!(
            text,
            "farthest from its reference without a trip: {kelvin:.3} K, number {number}"
        );
    }
    for run in runs {
        let what = format!("number {}: {} ({})", run.number, run.flip, run.region.name());
        let _ = match (run.class, &run.assessment.ended) {
            (FlipEffect::Broken, _) => {
                writeln!(text, "{what}: {}", run.assessment.line(run.place, run.t_s, MICROSECONDS))
            }
            (FlipEffect::Ended, Some(ended)) => {
                writeln!(text, "{what}: ended in {} at {:.6} s: {ended}", run.place, run.t_s)
            }
            _ => Ok(()),
        };
    }
    text
}

fn line(text: &mut String, name: &str, runs: &[FlipResult], is_so: impl Fn(&FlipResult) -> bool) {
    *text += &format!("{name:<24}");
    for region in FlipRegion::ALL {
        let count = runs.iter().filter(|run| run.region == region && is_so(run)).count();
        *text += &format!("{count:>9}");
    }
    *text += &format!("{:>9}\n", runs.iter().filter(|run| is_so(run)).count());
}
