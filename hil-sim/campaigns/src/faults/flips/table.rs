//! Flips as text.

use std::fmt::Write;

use super::{Class, Flipped, Region};
use crate::faults::Breach;
use crate::faults::verdict::MICROSECONDS;

/// Classes by region, reasons of trips below theirs; then every flip that broke a limit or ended its run.
#[must_use]
pub fn flip_table(runs: &[Flipped]) -> String {
    let mut text = format!("{:<24}", "");
    for (region, _) in Region::ALL {
        text += &format!("{:>9}", region.name());
    }
    text += "      all\n";
    for class in Class::ALL {
        line(&mut text, class.name(), runs, |run| run.class == class);
        if class == Class::Tripped {
            let mut reasons: Vec<_> = (runs.iter())
                .filter(|run| run.class == class)
                .map(|run| run.verdict.reason.as_str())
                .collect();
            reasons.sort_unstable();
            reasons.dedup();
            for reason in reasons {
                let by = |run: &Flipped| run.class == class && run.verdict.reason == reason;
                line(&mut text, &format!("  {reason}"), runs, by);
            }
        }
        if class == Class::Broken {
            for breach in Breach::ALL {
                let broke =
                    |run: &Flipped| run.class == class && run.verdict.breaches.contains(&breach);
                if runs.iter().any(broke) {
                    line(&mut text, &format!("  {}", breach.name()), runs, broke);
                }
            }
        }
    }
    line(&mut text, "all", runs, |_| true);
    let most = (runs.iter())
        .filter(|run| run.class == Class::Differs)
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
        let what = format!(
            "number {}: {} ({})",
            run.number,
            run.flip,
            run.region.name()
        );
        let _ = match (run.class, &run.verdict.ended) {
            (Class::Broken, _) => writeln!(
                text,
                "{what}: {}",
                run.verdict.line(run.place, run.t_s, MICROSECONDS)
            ),
            (Class::Ended, Some(ended)) => writeln!(
                text,
                "{what}: ended in {} at {:.6} s: {ended}",
                run.place, run.t_s
            ),
            _ => Ok(()),
        };
    }
    text
}

fn line(text: &mut String, name: &str, runs: &[Flipped], is_so: impl Fn(&Flipped) -> bool) {
    *text += &format!("{name:<24}");
    for (region, _) in Region::ALL {
        let count = runs
            .iter()
            .filter(|run| run.region == region && is_so(run))
            .count();
        *text += &format!("{count:>9}");
    }
    *text += &format!("{:>9}\n", runs.iter().filter(|run| is_so(run)).count());
}
