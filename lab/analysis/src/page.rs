//! The analysis as one HTML page.

use thermal_charts::{document, svg_element};
use thermal_client::text::escaped_text;

use crate::report::{Analysis, Cell, Column, Section, Shown, Table, TaskAnalysis};

const STYLE: &str = "body{max-width:76rem}table{font-size:.85rem;margin:.6rem 0 1.2rem}caption{text-align:left;\
font-weight:600;padding:.3rem 0}td.n,th.n{text-align:right}td.n{font-variant-numeric:tabular-nums;white-space:nowrap}\
figure{margin:1.2rem 0}figcaption{font-weight:600}.not{border-left:4px solid #b35900;padding-left:.8rem}\
.simulated{border-left:4px solid #6639ba;padding-left:.8rem}nav ul{columns:2}th .u{font-weight:400;color:#666}\
div.wide,details{overflow-x:auto}details{margin-bottom:1.2rem}td.w{white-space:nowrap}";

/// A text as a page shows it.
fn escape(text: &str) -> String {
    thermal_charts::escape(&escaped_text(text))
}

/// Letters of a cell from which it is wrapped.
const WRAPPED: usize = 48;

/// The page of all tasks.
pub fn page(analysis: &Analysis) -> String {
    let tasks = &*analysis.tasks;
    let title = match tasks {
        [one] => one.title.clone(),
        _ => "Analysis of experiments".into(),
    };
    let body: String = match tasks {
        [] => "<p>The data set has no sessions.</p>".into(),
        _ => tasks.iter().map(|task| of_task(task, tasks.len() > 1)).collect(),
    };
    let left_out = list("Not in any table of this page:", &analysis.left_out);
    document(&title, STYLE, &(left_out + &body))
}

/// A marked list with a heading; nothing without sentences.
fn list(heading: &str, sentences: &[String]) -> String {
    if sentences.is_empty() {
        return String::new();
    }
    let items: String =
        sentences.iter().map(|sentence| format!("<li>{}</li>", escape(sentence))).collect();
    format!("<div class=\"not\"><p>{heading}</p><ul>{items}</ul></div>")
}

fn of_task(task: &TaskAnalysis, is_one_of_many: bool) -> String {
    let mut body = String::new();
    let heading = if is_one_of_many { "h3" } else { "h2" };
    if is_one_of_many {
        body += &format!("<h2>{}</h2>", escape(&task.title));
    }
    body += &format!("<p>Task <code>{}</code>", escape(&task.task));
    if !task.cite.is_empty() {
        body += &format!(", after {}", escape(&task.cite));
    }
    body += ". ";
    body += &match &task.question {
        Some(question) => format!("Participants were asked: <q>{}</q>", escape(question)),
        None => "Participants were asked nothing.".into(),
    };
    body += "</p>";
    if task.is_simulated {
        body += "<p class=\"simulated\">Participants that are marked as simulated below were simulated with their device, or touched a simulated device: predictions, not measurements.</p>";
    }
    body += "<nav><ul>";
    for section in &task.sections {
        body += &format!(
            "<li><a href=\"#{}\">{}</a></li>",
            anchor(task, section),
            escape(&section.title)
        );
    }
    body += "</ul></nav>";
    body + &task
        .sections
        .iter()
        .map(|section| of_section(task, section, heading))
        .collect::<String>()
}

/// Name of a section in the page; words of an unchecked file must not end the attribute.
fn anchor(task: &TaskAnalysis, section: &Section) -> String {
    escape(&format!("{}-{}", task.task, section.name)).replace(['"', ' '], "-")
}

fn of_section(task: &TaskAnalysis, section: &Section, heading: &str) -> String {
    let mut text = format!(
        "<{heading} id=\"{}\">{}</{heading}>",
        anchor(task, section),
        escape(&section.title)
    );
    for note in &section.notes {
        text += &format!("<p>{}</p>", escape(note));
    }
    text += &list("Left out, or to be read with care:", &section.warnings);
    for picture in &section.pictures {
        text += &format!(
            "<figure><figcaption>{}</figcaption>{}</figure>",
            escape(&picture.caption),
            svg_element(&picture.svg)
        );
    }
    text += &section.tables.iter().map(of_table).collect::<String>();
    text + &list("Not possible with these data:", &section.not_possible)
}

fn of_table(table: &Table) -> String {
    // A column without any value, such as that of a score that the task has not, is in JSON and CSV only.
    let has_value = |index: &usize| {
        let mut cells = table.rows.iter().filter_map(|row| row.get(*index));
        cells.any(|cell| *cell != Cell::Nothing)
    };
    let columns = (0..table.columns.len()).filter(has_value);
    let is_number = |index: usize| {
        table
            .rows
            .iter()
            .any(|row| matches!(row.get(index), Some(Cell::Count(_) | Cell::Number(_))))
    };
    let class = |index: usize| if is_number(index) { " class=\"n\"" } else { "" };
    let columns: Vec<(usize, &str)> = columns.map(|index| (index, class(index))).collect();
    let caption = escape(&table.caption);
    let (begin, end) = if table.is_folded {
        (format!("<details><summary>{caption}</summary><table><tr>"), "</table></details>")
    } else {
        (format!("<div class=\"wide\"><table><caption>{caption}</caption><tr>"), "</table></div>")
    };
    let mut text = begin;
    for &(index, class) in &columns {
        let column = &table.columns[index];
        let unit = match column.unit {
            "" => String::new(),
            unit => format!(" <span class=\"u\">/ {}</span>", escape(unit)),
        };
        text += &format!("<th{class}>{}{unit}</th>", escape(&column.name));
    }
    text += "</tr>";
    for row in &table.rows {
        text += "<tr>";
        for &(index, class) in &columns {
            let cell = row.get(index).unwrap_or(&Cell::Nothing);
            let shown = shown(cell, &table.columns[index]);
            let class = match class {
                "" if shown.chars().count() < WRAPPED => " class=\"w\"",
                class => class,
            };
            text += &format!("<td{class}>{}</td>", escape(&shown));
        }
        text += "</tr>";
    }
    text + end
}

fn shown(cell: &Cell, column: &Column) -> String {
    match cell {
        Cell::Nothing => "–".into(),
        Cell::Text(text) => text.clone(),
        Cell::Count(count) => count.to_string(),
        Cell::Number(number) => match column.shown {
            Shown::Plain => number.to_string(),
            Shown::Decimals(decimals) => decimal(*number, decimals),
            Shown::Probability => probability(*number),
        },
    }
}

/// A number with this many decimals and a minus sign.
pub fn decimal(number: f64, decimals: usize) -> String {
    // A rounded negative zero is zero.
    let text = format!("{number:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|digit| matches!(digit, b'0' | b'.')) => digits.into(),
        Some(digits) => format!("\u{2212}{digits}"),
        None => text,
    }
}

/// A probability as journals print it.
pub fn probability(p: f64) -> String {
    if p < 0.001 {
        "< .001".into()
    } else if p >= 0.9995 {
        "1.000".into()
    } else {
        format!("{p:.3}").trim_start_matches('0').into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_printed_as_journals_do() {
        assert_eq!(probability(0.0004), "< .001");
        assert_eq!(probability(0.0123), ".012");
        assert_eq!(probability(0.99999), "1.000");
        assert_eq!(decimal(-0.004, 2), "0.00");
        assert_eq!(decimal(-0.006, 2), "\u{2212}0.01");
        assert_eq!(decimal(1.005, 1), "1.0");
    }
}
