//! Published results of the shipped sessions beside the measured ones.

use thermal_thesis::published::{
    ANSWERS_OF_TABLE_3_3, ANSWERS_OF_TABLE_3_5, PublishedPair, StatedResult, discrimination,
    identification, localisation, real_against_simulated,
};

use super::share::Share;
use super::{confusion, oddity, pairs};
use crate::input::Task;
use crate::report::{Section, Table, cells, numbers, words};

const CITATION: &str = "H.-N. Ho, Development and Evaluation of a Thermal Model for Haptic Interfaces, PhD thesis, \
     Massachusetts Institute of Technology, 2006";

/// The published results of a shipped session; `None` of others.
pub fn published(task: &Task) -> Option<Section> {
    let mut section = Section::new("published", "Published results beside these")
        .note(format!("Published: {CITATION}."));
    match task.name.as_str() {
        "p1" => shares(&mut section, "Table 3-3", discrimination(), ANSWERS_OF_TABLE_3_3, |row| {
            pairs::share_of(task, row)
        }),
        "p3" | "p3displays" => {
            shares(&mut section, "Table 3-5", localisation(), ANSWERS_OF_TABLE_3_5, |row| {
                oddity::share_of(task, row)
            })
        }
        "p4" => {
            stated(&mut section, "% correct", identification(), |of| confusion::measured(task, of))
        }
        "p5" | "p5contact" => stated(&mut section, "% correct", real_against_simulated(), |of| {
            pairs::measured(task, of)
        }),
        _ => return None,
    }
    Some(section)
}

fn shares(
    section: &mut Section,
    name: &str,
    published: Vec<PublishedPair>,
    answers: u32,
    share: impl Fn(&PublishedPair) -> Share,
) {
    let mut table = Table::new(
        "published",
        &format!("{name} (n = {answers} each) beside these data; n counts answers"),
        [
            words("first, or target"),
            words("second, or distractor"),
            numbers("published", "%", 0),
            numbers("here", "%", 1),
            words("n"),
            numbers("95 % from", "%", 1),
            numbers("95 % to", "%", 1),
            numbers("difference", "%", 1),
        ],
    );
    let (mut squares, mut count, mut of_both) = (0.0, 0.0, (0.0, 0.0));
    for row in published {
        let share = share(&row);
        let here = share.percent();
        let (low, high) = share.interval().unzip();
        if let Some(here) = here {
            squares += (here - row.percent).powi(2);
            count += 1.0;
            of_both = (of_both.0 + row.percent, of_both.1 + here);
        }
        table.row(cells![
            row.first,
            row.second,
            row.percent,
            here,
            share.total(),
            low,
            high,
            here.map(|here| here - row.percent)
        ]);
    }
    if count > 0.0 {
        section.notes.push(format!(
            "Over the {count:.0} rows with answers: mean {:.1} % published, {:.1} % here; RMS difference {:.1} %.",
            of_both.0 / count,
            of_both.1 / count,
            f64::sqrt(squares / count)
        ));
    }
    section.add(table);
}

fn stated(
    section: &mut Section,
    unit: &str,
    published: Vec<StatedResult>,
    here: impl Fn(&str) -> Option<f64>,
) {
    section.notes.push(
        "The thesis shows these results in pictures; its text states what is in the table.".into(),
    );
    let place = published.first().map_or(String::new(), |row| row.place.clone());
    let mut table = Table::new(
        "published",
        &format!("{place}, {unit}, beside these data"),
        [words("of"), words("published"), numbers("here", "", 2)],
    );
    for row in published {
        table.row(cells![row.of.clone(), row.stated, here(&row.of)]);
    }
    section.add(table);
}
