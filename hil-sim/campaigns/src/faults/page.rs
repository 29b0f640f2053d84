//! The matrix as a page.

use std::fmt::Write;

use thermal_charts::{document, escape};

use super::table::{cells, failing_run_text, outcome};
use super::{Breach, FaultSummary};

/// Name of the page.
pub const HTML: &str = "faults.html";

const STYLE: &str = "body{max-width:88rem}table{font-size:.85rem;width:100%}th{position:sticky;top:0;background:#fff}\
td.n{text-align:right}td.f,td.n{white-space:nowrap}td.ok{background:#d7f0dc}td.bad{background:#f9d0d0;font-weight:600}\
td.none{background:#eee}ul{font-size:.85rem}";
const HEADS: [&str; 9] = [
    "fault",
    "outcome",
    "runs",
    "detectable",
    "to safe / ms",
    "skin / °C",
    "CEM43 / min",
    "display / °C",
    "reasons",
];

/// A page that needs no other file.
pub fn page(sections: &[(&str, &[FaultSummary])], engine: &str) -> String {
    let mut body = format!(
        "<p>Engine {}; everything here is simulated, nobody has run it on hardware. Worst case of each fault over its \
         runs. Held to: skin within 13 to 45 °C, CEM43 below one minute, no current from 50 ms after the fault is \
         detectable on, a right reason, no trip before the fault, an unchanged set-point where nothing may change. On five fingers those without the fault render as before.</p>",
        escape(engine)
    );
    for (title, rows) in sections {
        // Writing to a String cannot fail.
        let _ = write!(body, "<h2>{title}</h2><table><tr>");
        for head in HEADS {
            let _ = write!(body, "<th>{head}</th>");
        }
        body += "</tr>";
        for row in *rows {
            body += &line(row);
        }
        body += "</table>";
    }
    let rows = sections.iter().flat_map(|(_, rows)| *rows);
    let mut list = String::new();
    for row in rows.filter(|row| !row.holds) {
        for trial in row.failing_runs() {
            let _ = write!(
                list,
                "<li>{}: {}</li>",
                escape(&row.fault),
                escape(&failing_run_text(trial))
            );
        }
    }
    if !list.is_empty() {
        let _ = write!(body, "<h2>Runs with a breach</h2><ul>{list}</ul>");
    }
    document("Single faults", STYLE, &body)
}

fn line(row: &FaultSummary) -> String {
    let is = |breach: Breach| {
        let has = |trial: &super::FaultRun| trial.assessment.breaches.contains(&breach);
        row.trials.iter().any(has)
    };
    let class = |bad: bool| match (row.trials.is_empty(), bad) {
        (true, _) => "none",
        (_, true) => "bad",
        (_, false) => "ok",
    };
    let [runs, detectable, took, skin, cem43, display, reasons] = cells(row);
    let latent = if row.latent { " (latent)" } else { "" };
    format!(
        "<tr><td class=\"f\">{}{latent}</td><td class=\"f {}\">{}</td><td class=\"n\">{runs}</td><td class=\"n\">\
         {detectable}</td><td class=\"n {}\">{took}</td><td class=\"f {}\">{skin}</td><td class=\"n {}\">{cem43}</td>\
         <td class=\"f\">{display}</td><td class=\"{}\">{}</td></tr>",
        escape(&row.fault),
        class(!row.holds),
        outcome(row),
        class(is(Breach::Late)),
        class(is(Breach::Skin)),
        class(is(Breach::Dose)),
        class(is(Breach::Reason) || is(Breach::Early) || is(Breach::Others)),
        escape(&reasons),
    )
}
