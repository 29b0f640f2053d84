//! The analyses, by the words of the session file.

mod against;
mod ancova;
mod anova;
mod chi_square;
mod confusion;
mod courses;
mod design;
mod falls;
mod force;
mod identical;
mod left_out;
mod magnitudes;
mod model;
mod oddity;
mod overview;
mod pairs;
mod parts;
mod psychometric;
mod published;
mod same_different;
mod share;
mod staircases;
mod tukey;

use crate::input::Task;
use crate::report::{Section, TaskAnalysis};

/// An analysis of a task.
type Analyse = fn(&Task) -> Section;

/// The analyses by their words, in the order of the page.
const ANALYSES: [(&str, Analyse); 21] = [
    ("pairs", pairs::pairs),
    ("pairs-by-mode", pairs::by_mode),
    ("identical-pairs", identical::identical_pairs),
    ("same-different", same_different::same_different),
    ("oddity", oddity::oddity),
    ("confusion", confusion::confusion),
    ("information", confusion::information),
    ("falls", falls::falls),
    ("levene", falls::levene),
    ("exponential-fit", courses::exponential_fit),
    ("pearson-with-model", model::pearson_with_model),
    ("force-matching", force::force_matching),
    ("magnitudes", magnitudes::magnitudes),
    ("staircase", staircases::staircase),
    ("psychometric-fit", psychometric::psychometric_fit),
    ("anova-within", anova::within),
    ("anova-split-plot", anova::split_plot),
    ("tukey", tukey::tukey),
    ("ancova", ancova::ancova),
    ("pearson-between-parts", parts::pearson_between_parts),
    ("chi-squared-against", against::chi_squared_against),
];

/// The analysis of a task: what every analysis has, what its session file asks for, and published results beside.
pub fn of_task(task: &Task) -> TaskAnalysis {
    let mut sections = vec![overview::participants(task), overview::measures(task)];
    let asked = ANALYSES.iter().filter(|(word, _)| task.asks_for(word));
    sections.extend(asked.map(|(_, analysis)| analysis(task)));
    sections.extend(published::published(task));
    for word in &task.analyses {
        if ANALYSES.iter().all(|(known, _)| known != word) {
            let mut section = Section::new(word, word);
            section.lacks(word, "this version knows no such analysis");
            sections.push(section);
        }
    }
    TaskAnalysis {
        task: task.label.clone(),
        title: task.title.clone(),
        cite: task.cite.clone(),
        question: task.question.clone(),
        participants: task.participants.iter().map(|one| one.code.clone()).collect(),
        is_simulated: task.participants.iter().any(|one| one.is_simulated),
        sections,
    }
}

/// The words.
#[cfg(test)]
pub const WORDS: [&str; ANALYSES.len()] = {
    let mut words = [""; ANALYSES.len()];
    let mut index = 0;
    while index < words.len() {
        words[index] = ANALYSES[index].0;
        index += 1;
    }
    words
};

/// Why a table of answers is empty.
const NO_ANSWERS: &str = "no trial that counts has an answer that is scored";

/// A name of a table of letters, digits and hyphens.
fn slug(text: &str) -> String {
    let plain = |letter: char| {
        if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '-' }
    };
    text.chars().map(plain).collect()
}
