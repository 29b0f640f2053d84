//! The page of a bring-up: every value, expected and found.

use std::fmt::Write as _;

use super::report::{Report, Verdict};
use super::stages::STAGES;

const STYLE: &str = "\
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 76rem; padding: 0 1rem; color: #1b1b1b; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
table { border-collapse: collapse; width: 100%; } th, td { text-align: left; vertical-align: top; padding: .3rem .6rem;
  border-bottom: 1px solid #ddd; } th { font-weight: 600; } td.basis { color: #666; font-size: 13px; }
.passed { color: #1a6b2f; } .failed { color: #a1160f; font-weight: 600; } .not-reached { color: #666; }
.box { border: 2px solid; padding: .6rem 1rem; border-radius: 4px; } code, pre { font: 13px ui-monospace, monospace; }
.sign td { height: 2.4rem; width: 33%; } @media print { body { margin: 0; } }";

/// The page as HTML.
pub fn page(report: &Report) -> String {
    let mut html = String::new();
    // Writing to a string does not fail.
    let _ = write_page(&mut html, report);
    html
}

fn write_page(html: &mut String, report: &Report) -> std::fmt::Result {
    let passed = report.passed();
    let (class, verdict) = match (&report.resume, passed) {
        (_, true) => ("passed", "Passed: every check of every stage".to_owned()),
        (None, false) => ("failed", "Not passed".to_owned()),
        (Some(resume), false) => (
            "failed",
            format!(
                "Not finished: ended before or in stage {}: {}. Mend what is listed, then go on with --from {}",
                escaped(&resume.stage),
                escaped(&resume.reason),
                escaped(&resume.stage)
            ),
        ),
    };
    write!(
        html,
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Bring-up</title><style>\n{STYLE}\n</style></head>\
         <body>\n<h1>Bring-up of a thermal display</h1>\n"
    )?;
    if report.emulated {
        html.write_str(
            "<p><strong>An emulated board.</strong> Image and chip are emulated, circuits and tile simulated; nothing here was \
             measured.</p>\n",
        )?;
    }
    let unknown = || "not known".to_owned();
    let device = report.device.as_deref().map_or_else(unknown, escaped);
    let chip = report.chip.as_deref().map_or_else(unknown, escaped);
    let image = report.image.as_deref().map_or_else(unknown, escaped);
    write!(
        html,
        "<p class=\"box {class}\">{verdict}.</p>\n<table>\n<tr><th>device</th><td>{device}</td></tr>\n\
         <tr><th>microcontroller, unique identifier</th><td><code>{chip}</code></td></tr>\n\
         <tr><th>image, CRC-32</th><td><code>{image}</code></td></tr>\n</table>\n"
    )?;
    let findings = report.findings();
    if !findings.is_empty() {
        html.write_str("<h2>Findings</h2>\n<ol>\n")?;
        for finding in findings {
            writeln!(html, "<li>{}</li>", escaped(finding))?;
        }
        html.write_str("</ol>\n")?;
    }
    for stage in STAGES.iter() {
        write_stage(html, report, stage.name, stage.title)?;
    }
    if !report.settings.is_empty() {
        let lines = escaped(&report.settings.join("\n"));
        write!(html, "<h2>Settings</h2>\n<pre>{lines}</pre>\n")?;
    }
    html.write_str("<h2>Sign-off</h2>\n")?;
    html.write_str(if report.emulated {
        "<p>None: no finger can touch an emulated board.</p>\n</body></html>\n"
    } else {
        "<p>A finger may touch the display only if this page says passed, after everything was switched off and on again \
         without a debugger.</p>\n<table class=\"sign\"><tr><td>Name</td><td>Date</td><td>Signature</td></tr></table>\n\
         </body></html>\n"
    })
}

fn write_stage(html: &mut String, report: &Report, name: &str, title: &str) -> std::fmt::Result {
    let records: Vec<_> = report.records.iter().filter(|record| record.stage == name).collect();
    writeln!(html, "<h2 id=\"{name}\">{}</h2>", escaped(title))?;
    if records.is_empty() {
        return html.write_str("<p class=\"not-reached\">Not done.</p>\n");
    }
    html.write_str(
        "<table>\n<tr><th>what</th><th>expected</th><th>found</th><th>verdict</th><th>limits from</th></tr>\n",
    )?;
    for record in records {
        let (class, word) = match record.verdict {
            Verdict::Passed => ("passed", "passed"),
            Verdict::Failed => ("failed", "failed"),
            Verdict::NotReached => ("not-reached", "not reached"),
        };
        writeln!(
            html,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"{class}\">{word}</td><td class=\"basis\">{}</td></tr>",
            escaped(&record.what),
            escaped(&record.expected),
            escaped(&record.found),
            escaped(&record.basis)
        )?;
    }
    html.write_str("</table>\n")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
