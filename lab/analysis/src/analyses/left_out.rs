//! Sentences on what the participants did and no table has.

use super::design::Design;
use crate::input::Task;
use crate::report::Section;

/// Most missing cells of a participant that are named; of more their number is said.
const NAMED: usize = 3;

/// Says how many of `what` are left out, from a participant for each of them.
pub fn count(section: &mut Section, task: &Task, participants: &[usize], what: &str) {
    if !participants.is_empty() {
        let (count, shares) = (participants.len(), task.shares(participants));
        section.warn([format!("Left out: {what}: {count} {shares}.")]);
    }
}

/// Levels that are not in the cells of a design, and participants who do not have all cells.
pub fn of_design(section: &mut Section, task: &Task, design: &Design) {
    levels(section, design);
    let dependent = &design.dependent;
    let codes = task.participants.iter().map(|participant| &participant.code);
    for (number, code) in codes.enumerate() {
        if !design.cells.participants.contains(&number) && !design.cells.levels.is_empty() {
            let why = missing_cells(design, number);
            section.warn([format!("{dependent}: {code} is left out: {why}.")]);
        }
    }
}

/// Levels that are not in the cells of a design.
pub fn levels(section: &mut Section, design: &Design) {
    let dependent = &design.dependent;
    for (factor, level) in &design.dropped {
        section.warn([format!(
            "{dependent}: {factor} {level} is left out: nobody has a value there."
        )]);
    }
}

/// The cells in which a participant has no data.
pub fn missing_cells(design: &Design, participant: usize) -> String {
    let partial = design.cells.partial.iter().find(|(number, _)| *number == participant);
    let Some((_, cells)) = partial else {
        return "no data".into();
    };
    let missing = design.cells.levels.iter().zip(cells).filter(|(_, cell)| cell.is_none());
    let names: Vec<_> = missing.map(|(level, _)| level.replace('\u{1f}', ", ")).collect();
    if names.len() > NAMED {
        format!("no data in {} of {} cells", names.len(), design.cells.levels.len())
    } else {
        format!("no data at {}", names.join("; "))
    }
}
