//! The figures as text.

use std::fmt::Write;

use super::{Boxed, Row, Scenario};
use crate::metrics::{Errors, PerTick};

const HEAD: &str = "law           N    judged            skin rms   display max/rms    A max/rms     J     E      instructions   cycles (est.)";
const NAME: usize = 20;

/// One line for each law and, unless `every` is set, for each case of a name, the force with which it is worst.
#[must_use]
pub fn table(rows: &[Row], every: bool) -> String {
    let mut text = String::new();
    for scenario in Scenario::ALL {
        let own: Vec<_> = rows.iter().filter(|row| row.scenario == scenario).collect();
        if own.is_empty() {
            continue;
        }
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "\n{}: {}\n{:NAME$}{HEAD}",
            scenario.name(),
            scenario.title(),
            "material"
        );
        let shown = if every { own.clone() } else { worst(&own) };
        let mut name = "";
        for row in shown {
            let label = if row.case == name { "" } else { &row.case };
            name = &row.case;
            let _ = writeln!(text, "{label:NAME$}{}", line(row));
        }
        text += &verdicts(&own);
    }
    text
}

/// For each name, law and removed bound the row with the worst force.
fn worst<'a>(rows: &[&'a Row]) -> Vec<&'a Row> {
    let mut worst: Vec<&Row> = Vec::new();
    for row in rows {
        let same =
            |other: &&mut &Row| (&other.case, other.law, other.without) == (&row.case, row.law, row.without);
        match worst.iter_mut().find(same) {
            Some(other) if other.badness() < row.badness() => *other = row,
            Some(_) => {}
            None => worst.push(row),
        }
    }
    worst
}

/// How many rows are within their bound, law by law.
fn verdicts(rows: &[&Row]) -> String {
    let mut kinds: Vec<_> = rows.iter().map(|row| (row.law, row.without)).collect();
    kinds.sort_by_key(|(law, without)| (without.map(|w| w.name()), *law));
    kinds.dedup();
    let mut text = String::new();
    for (law, without) in kinds {
        let own = || rows.iter().filter(|row| (row.law, row.without) == (law, without));
        let judged = own().filter(|row| row.judged.bound.is_some()).count();
        let within = own().filter(|row| row.judged.within == Some(true)).count();
        let worst = own().max_by(|a, b| a.badness().total_cmp(&b.badness()));
        let Some(worst) = worst else { continue };
        let without = without.map_or(String::new(), |without| format!(" without {}", without.name()));
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{law}{without}: {within} of {judged} within their bound; worst {} ({}, {} N)",
            judged_text(worst),
            worst.case,
            worst.force_n
        );
    }
    text
}

fn line(row: &Row) -> String {
    let figures = &row.figures;
    let law = match row.without {
        Some(without) => format!("{} -{}", row.law, without.name()),
        None => row.law.into(),
    };
    let mut line = format!(
        "{law:<12} {:>4}  {:<16} {}  {}  {:>5.2}/{:<5.2} {:>6.1} {:>5}  {:<14} {:<14}",
        row.force_n,
        judged_text(row),
        figures
            .skin_error_mk
            .map_or("-".into(), |errors| format!("{:>8.1}", errors.rms)),
        figures.display_error_mk.map_or("-".into(), display),
        figures.current_a.max_abs,
        figures.current_a.rms,
        figures.energy_j,
        figures.kernel_evaluations.map_or("-".into(), |n| n.to_string()),
        cost(figures.instructions_per_tick),
        cost(figures.cycles_per_tick),
    );
    for tripped in &figures.faults {
        line += &format!(" {} at {:.3} s", tripped.fault, tripped.t_s);
    }
    line.trim_end().to_owned()
}

fn judged_text(row: &Row) -> String {
    let judged = &row.judged;
    let value = judged.value.map_or("never".into(), |value| match judged.unit {
        "s" => format!("{value:.3}"),
        _ => format!("{value:.1}"),
    });
    let verdict = match judged.within {
        _ if judged.bound.is_none() => "",
        Some(true) => "ok",
        _ => "over",
    };
    format!("{value} {} {verdict}", judged.unit).trim_end().to_owned()
}

fn display(errors: Errors) -> String {
    let max = errors
        .max_after_50ms
        .map_or("-".into(), |max| format!("{max:.1}"));
    format!("{max:>7} /{:>7.1}", errors.rms)
}

fn cost(cost: PerTick) -> String {
    match (cost.mean, cost.max) {
        (Some(mean), Some(max)) => format!("{mean:.0}/{max}"),
        _ => "-".into(),
    }
}

/// The box: percentiles and the worst draws.
#[must_use]
pub fn box_table(boxed: &Boxed) -> String {
    let mut text = format!(
        "\nA over the box: {} draws, seed {}, engine {}; mK, skin error\n{:14}largest after 50 ms, 50/95/99 %, max     rms, 50/95/99 %, max          faulty\n",
        boxed.draws, boxed.seed, boxed.engine, "law"
    );
    for law in &boxed.laws {
        let (max, rms) = (law.max_after_50ms_mk, law.rms_mk);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:12}{:>8.1}{:>8.1}{:>8.1}{:>9.1} {:<5}{:>8.1}{:>8.1}{:>8.1}{:>9.1}{:>7}",
            law.law,
            max.p50,
            max.p95,
            max.p99,
            max.max,
            if law.within { "ok" } else { "over" },
            rms.p50,
            rms.p95,
            rms.p99,
            rms.max,
            law.faulty
        );
    }
    for law in &boxed.laws {
        for one in &law.worst {
            let _ = writeln!(
                text,
                "{:12}draw {:>4}: {:>8.1} mK, {} at {} N {}",
                law.law,
                one.number,
                one.max_after_50ms_mk,
                one.material,
                one.force_n,
                one.faults.join(", ")
            );
        }
    }
    text
}
