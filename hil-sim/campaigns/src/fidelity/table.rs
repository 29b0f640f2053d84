//! The figures as text.

use std::fmt::Write;

use thermal_sim::metrics::{CostPerTick, ErrorFigures};

use super::{BoxReport, FidelityRow, Scenario};

const HEAD: &str = "   N    judged            skin rms   display max/rms    A max/rms     J     E      instructions   cycles (est.)";
const NAME: usize = 20;

/// One line for each case and law, at the worst force or, with `every`, at every force.
pub fn table(rows: &[FidelityRow], every: bool) -> String {
    let mut text = String::new();
    for scenario in Scenario::ALL {
        let own: Vec<_> = rows.iter().filter(|row| row.scenario == scenario).collect();
        if own.is_empty() {
            continue;
        }
        let law_width = own.iter().map(|row| law(row).len()).max().unwrap_or(0);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "\n{}: {}\n{:NAME$}{:<law_width$} {HEAD}",
            scenario.name(),
            scenario.title(),
            "material",
            "law"
        );
        let shown = if every { own.clone() } else { worst(&own) };
        let mut name = "";
        for row in shown {
            let label = if row.case == name { "" } else { &row.case };
            name = &row.case;
            let _ = writeln!(text, "{label:NAME$}{:<law_width$} {}", law(row), line(row));
        }
        text += &verdicts(&own);
    }
    text
}

/// The row with the worst force for each name, law and removed limit.
fn worst<'a>(rows: &[&'a FidelityRow]) -> Vec<&'a FidelityRow> {
    let mut worst: Vec<&FidelityRow> = Vec::new();
    for row in rows {
        let same = |other: &&mut &FidelityRow| {
            (&other.case, other.law, other.without) == (&row.case, row.law, row.without)
        };
        match worst.iter_mut().find(same) {
            Some(other) if other.compare(row).is_lt() => *other = row,
            Some(_) => {}
            None => worst.push(row),
        }
    }
    worst
}

/// Number of rows within their bound, by law.
fn verdicts(rows: &[&FidelityRow]) -> String {
    let mut laws: Vec<_> = rows.iter().map(|row| law(row)).collect();
    laws.sort();
    laws.dedup();
    let mut text = String::new();
    for name in laws {
        let own = || rows.iter().filter(|row| law(row) == name);
        let judged = own().filter(|row| row.judged.bound.is_some()).count();
        let within = own().filter(|row| row.judged.within == Some(true)).count();
        let worst = own().max_by(|a, b| a.compare(b));
        let Some(worst) = worst else { continue };
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{name}: {within} of {judged} within their bound; worst {} ({}, {} N)",
            judged_text(worst),
            worst.case,
            worst.force_n
        );
    }
    text
}

/// The law and the removed limit.
fn law(row: &FidelityRow) -> String {
    match row.without {
        Some(without) => format!("{} without {}", row.law, without.name()),
        None => row.law.into(),
    }
}

fn line(row: &FidelityRow) -> String {
    let figures = &row.figures;
    let mut line = format!(
        "{:>4}  {:<16} {}  {}  {:>5.2}/{:<5.2} {:>6.1} {:>5}  {:<14} {:<14}",
        row.force_n,
        judged_text(row),
        figures.skin_error_mk.map_or("-".into(), |errors| format!("{:>8.1}", errors.rms)),
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

fn judged_text(row: &FidelityRow) -> String {
    let judged = &row.judged;
    let value = judged.value.map_or("never".into(), |value| match judged.unit {
        "s" => format!("{value:.3} s"),
        unit => format!("{value:.1} {unit}"),
    });
    let assessment = match judged.within {
        _ if judged.bound.is_none() => "",
        Some(true) => "ok",
        _ => "over",
    };
    format!("{value} {assessment}").trim_end().to_owned()
}

fn display(errors: ErrorFigures) -> String {
    let max = errors.max_after_50ms.map_or("-".into(), |max| format!("{max:.1}"));
    format!("{max:>7} /{:>7.1}", errors.rms)
}

fn cost(cost: CostPerTick) -> String {
    match (cost.mean, cost.max) {
        (Some(mean), Some(max)) => format!("{mean:.0}/{max}"),
        _ => "-".into(),
    }
}

/// Percentiles and worst draws by law.
pub fn box_table(boxed: &BoxReport) -> String {
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
