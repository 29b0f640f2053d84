//! The report as text.

use std::fmt::Write;

use serde::Serialize;

use super::Chapter;
use super::figure::FigureDifference;
use super::measured::{Measurement, VARIANTS};
use super::row::{Row, Verdict};

/// Number of rows by verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// All rows.
    pub rows: usize,
    /// [`Verdict::Agrees`].
    pub agrees: usize,
    /// [`Verdict::Cut`].
    pub cut: usize,
    /// [`Verdict::Differs`].
    pub differs: usize,
    /// [`Verdict::Damaged`].
    pub damaged: usize,
    /// [`Verdict::Wrong`].
    pub wrong: usize,
}

impl Counts {
    /// Counts the rows of all chapters.
    pub fn of(chapters: &[Chapter]) -> Self {
        let mut counts = Self::default();
        for row in chapters.iter().flat_map(|chapter| &chapter.rows) {
            counts.rows += 1;
            *match row.verdict() {
                Verdict::Agrees => &mut counts.agrees,
                Verdict::Cut => &mut counts.cut,
                Verdict::Differs(_) => &mut counts.differs,
                Verdict::Damaged => &mut counts.damaged,
                Verdict::Wrong => &mut counts.wrong,
            } += 1;
        }
        counts
    }

    /// The counts as a sentence.
    pub(super) fn text(&self) -> String {
        let Self { rows, agrees, cut, differs, damaged, wrong } = self;
        format!(
            "{rows} numbers: {agrees} agree, {cut} cut instead of rounded, {damaged} damaged in the text, {wrong} \
             wrong in the thesis, {differs} differ"
        )
    }
}

/// The report: one line for each row and each figure, and the counts.
pub fn table(
    chapters: &[Chapter],
    figures: &[FigureDifference],
    measured: &[Measurement],
) -> String {
    let rows = || chapters.iter().flat_map(|chapter| &chapter.rows);
    let width =
        |text: fn(&Row) -> String| rows().map(|row| text(row).chars().count()).max().unwrap_or(0);
    let quantity = |row: &Row| row.quantity.clone();
    let stated = |row: &Row| row.stated.to_string();
    let (quantities, stateds) = (width(quantity), width(stated));
    let computeds = width(Row::computed_text);
    let units = width(|row| row.unit.into());
    let mut text = String::new();
    for chapter in chapters {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "Chapter {}: {}", chapter.number, chapter.title);
        for row in &chapter.rows {
            let remark = match row.remark_text() {
                remark if remark.is_empty() || row.verdict() == Verdict::Agrees => String::new(),
                remark => format!(": {remark}"),
            };
            let _ = writeln!(
                text,
                "  {:<13}  {:<quantities$}  {:>stateds$}  {:>computeds$}  {:<units$}  {}{remark}",
                row.place,
                row.quantity,
                row.stated.to_string(),
                row.computed_text(),
                row.unit,
                row.verdict(),
            );
        }
        text.push('\n');
    }
    let _ = writeln!(text, "Model figures by the plant's finite volumes, against the closed forms");
    for figure in figures {
        let _ = writeln!(text, "{}", figure.text());
    }
    text.push('\n');
    text.push_str(&measured_table(measured));
    let _ = writeln!(text, "\n{}", Counts::of(chapters).text());
    text
}

/// One line for each measurement, with what each plant gives.
fn measured_table(measured: &[Measurement]) -> String {
    let mut text = String::from("Measurements beside the plant\n");
    for (i, variant) in VARIANTS.iter().enumerate() {
        let _ = writeln!(
            text,
            "Plant {}: finger {}, contact {}",
            i + 1,
            variant.finger(),
            variant.contact()
        );
    }
    let width = measured.iter().map(|row| row.quantity.chars().count()).max().unwrap_or(0);
    for row in measured {
        let plants = row.plant_texts().map(|text| format!("{text:>9}")).concat();
        let why = if row.why().is_empty() { String::new() } else { format!(": {}", row.why()) };
        let _ = writeln!(
            text,
            "- {:<13}  {:<width$}  {:>13}{plants}  {:<2}  {}{why}",
            row.place,
            row.quantity,
            row.measured.to_string(),
            row.unit,
            row.shown().text(),
        );
    }
    text
}
