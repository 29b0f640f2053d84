//! The figures as text.

use std::fmt::Write;

use crate::metrics::{CostPerTick, ErrorFigures, Figures};
use crate::speed::Speed;

/// Refused lines that the table shows.
const REFUSED_SHOWN: usize = 5;

/// Names and values with units, in the order of the table.
pub(super) fn rows(figures: &Figures) -> Vec<(&'static str, String)> {
    let errors = |errors: Option<ErrorFigures>| {
        errors.map_or("no contact".into(), |errors| {
            let max = errors.max_after_50ms.map_or("none".into(), |max| format!("{max:.1} mK"));
            format!("{max} after 50 ms, {:.1} mK RMS", errors.rms)
        })
    };
    let cost = |cost: CostPerTick| match cost {
        CostPerTick { mean: Some(mean), max: Some(max) } => format!("{mean:.0} mean, {max} max"),
        _ => "unknown to this engine".into(),
    };
    let list = |events: Vec<String>| match events.as_slice() {
        [] => "none".into(),
        events => events.join(", "),
    };
    let at = |what: &str, t_s: f64| format!("{what} at {t_s:.3} s");
    let faults = figures.faults.iter().map(|fault| at(&fault.fault, fault.t_s));
    let resets = figures.resets.iter().map(|reset| at(&reset.cause, reset.t_s));
    let mut rows = vec![
        ("material", figures.material.clone()),
        ("object", figures.object.clone()),
        ("engine", figures.engine.into()),
        ("control ticks", figures.ticks.to_string()),
        ("skin error", errors(figures.skin_error_mk)),
        ("display error", errors(figures.display_error_mk)),
        (
            "skin on the display",
            format!("{:.2} to {:.2} C", figures.skin_c.min, figures.skin_c.max),
        ),
        ("thermal dose", format!("{:.3} min CEM43", figures.cem43_min)),
        ("display", format!("{:.2} to {:.2} C", figures.display_c.min, figures.display_c.max)),
        (
            "kernel evaluations",
            figures.kernel_evaluations.map_or("unknown".into(), |n| n.to_string()),
        ),
        ("instructions a tick", cost(figures.instructions_per_tick)),
        ("cycles a tick", format!("{} (estimated)", cost(figures.cycles_per_tick))),
    ];
    if let (Some(load), Some(stack)) = (figures.cpu_load, figures.stack_bytes) {
        rows.push(("CPU load", format!("{:.1} % (estimated)", load * 100.0)));
        rows.push(("stack used", format!("{stack} bytes")));
    }
    let Speed { real_time_factor, loop_real_time_factor } = figures.speed;
    rows.push((
        "real-time factor",
        format!("{real_time_factor:.1}, of the loop {loop_real_time_factor:.0}"),
    ));
    rows.push(("faults", list(faults.collect())));
    rows.push(("resets", list(resets.collect())));
    if figures.answered_lines > 0 {
        let (refused, answered) = (figures.refused_lines.len(), figures.answered_lines);
        rows.push(("host lines refused", format!("{refused} of {answered}")));
    }
    for refused in figures.refused_lines.iter().take(REFUSED_SHOWN) {
        let line = refused.line.as_deref().unwrap_or("-");
        let (t_s, answer) = (refused.t_s, &refused.answer);
        rows.push(("", format!("t={t_s:.3} {line:?}: {answer}")));
    }
    if let Some(draws) = &figures.draws {
        let values = draws.parameters.iter();
        let values = values.map(|(key, value)| format!("{key} = {value:.4e}"));
        rows.push(("drawn", list(values.collect())));
    }
    rows
}

/// The figures, one per line.
pub fn table(figures: &Figures) -> String {
    rows(figures).into_iter().fold(String::new(), |mut text, (name, value)| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<21}{value}");
        text
    })
}
