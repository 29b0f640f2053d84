//! Identification: confusions, information transmitted, response bias.

use experiment_statistics::confusion::ConfusionMatrix;
use experiment_statistics::correlation::pearson;

use super::design::{Contrast, Design};
use super::share::{READING, Share, columns, picture};
use super::{NO_ANSWERS, left_out};
use crate::cells::{distinct, mean};
use crate::input::{Task, Trial};
use crate::picture::matrix;
use crate::report::{Column, Section, Table, cells, numbers, words};

/// A trial that has an answer and a correct answer among the words of the session.
struct Answer<'a> {
    participant: usize,
    trial: &'a Trial,
    presented: &'a str,
    answered: &'a str,
}

fn answer<'a>(task: &Task, participant: usize, trial: &'a Trial) -> Option<Answer<'a>> {
    let word = |text: &'a Option<String>| {
        let text = text.as_deref()?;
        task.answers.iter().any(|known| known == text).then_some(text)
    };
    Some(Answer {
        participant,
        trial,
        presented: word(&trial.record.expected)?,
        answered: word(&trial.record.answer)?,
    })
}

/// Says how many trials have no answer or no correct answer among the words.
fn say_others(section: &mut Section, task: &Task) {
    let others = task.trials().filter(|(one, trial)| answer(task, *one, trial).is_none());
    let others: Vec<_> = others.map(|(participant, _)| participant).collect();
    let what = "trials without an answer, or a correct answer, that is one of the words";
    left_out::count(section, task, &others, what);
}

fn answers<'a>(task: &'a Task, part: Option<&str>) -> Vec<Answer<'a>> {
    let all = task.trials();
    let all = all.filter_map(|(participant, trial)| answer(task, participant, trial));
    all.filter(|answer| part.is_none_or(|part| answer.trial.record.part == part)).collect()
}

/// Counts of a part of the session.
fn matrix_of(
    task: &Task,
    answers: &[Answer<'_>],
) -> experiment_statistics::Result<ConfusionMatrix> {
    let mut matrix = ConfusionMatrix::new(task.answers.clone())?;
    for answer in answers {
        matrix.add(answer.presented, answer.answered)?;
    }
    Ok(matrix)
}

/// Matrices and shares correct, part by part.
pub fn confusion(task: &Task) -> Section {
    let mut section = Section::new("confusion", "Confusions").note(READING);
    say_others(&mut section, task);
    let mut shares = Table::new(
        "identification",
        "Correct answers by what was presented; n counts answers",
        [words("part"), words("presented")].into_iter().chain(columns()),
    );
    let mut marks = Vec::new();
    let parts = task.parts();
    for (series, part) in parts.iter().enumerate() {
        let answers = answers(task, Some(part));
        let counted = matrix_of(task, &answers);
        let counts = match &counted {
            Ok(matrix) if !answers.is_empty() => {
                matrix.rows().map(<[u32]>::to_vec).collect::<Vec<_>>()
            }
            Ok(_) => {
                section.lacks(part, NO_ANSWERS);
                continue;
            }
            Err(error) => {
                section.lacks(part, error);
                continue;
            }
        };
        section.draw(
            format!("{part}: answers, and their part of what was presented; n = {}", answers.len()),
            matrix(&task.answers, &counts),
        );
        let heads = [words("presented")].into_iter().chain(task.answers.iter().map(words));
        let mut table = Table::new(
            &format!("confusion-{}", super::slug(part)),
            &format!("{part}: answers by what was presented"),
            heads.collect::<Vec<Column>>(),
        );
        for (label, row) in task.answers.iter().zip(&counts) {
            let mut all = cells![label.clone()];
            all.extend(row.iter().map(|count| (*count).into()));
            table.row(all);
        }
        section.add(table);
        for label in [None].into_iter().chain(task.answers.iter().map(Some)) {
            let of =
                answers.iter().filter(|answer| label.is_none_or(|label| answer.presented == label));
            let share = Share::new(
                of.map(|answer| (answer.participant, answer.presented == answer.answered)),
            );
            if share.total() > 0 {
                let name = label.map_or("all", String::as_str);
                let mut row = cells![*part, name];
                row.extend(share.cells(task.chance));
                shares.row(row);
                marks.extend(share.mark(name, series));
            }
        }
    }
    if !marks.is_empty() {
        section.draw(
            "Correct answers by what was presented",
            picture(&marks, &parts, task.chance, task.threshold),
        );
    }
    if parts.is_empty() {
        section.lacks("Confusions", NO_ANSWERS);
    }
    section.add(shares);
    section
}

/// Information transmitted, part by part.
pub fn information(task: &Task) -> Section {
    let mut section = Section::new("information", "Information transmitted").note(
        "I = Σ p_ij log2(p_ij / (p_i p_j)) of the pooled answers. Few answers make it too large; the corrected value subtracts \
         the bias of its three entropies (Miller and Madow). It counts consistent confusions as information, too.",
    );
    say_others(&mut section, task);
    let mut table = Table::new(
        "information",
        "Information transmitted; n counts answers",
        [
            words("part"),
            words("n"),
            numbers("observed", "bit", 3),
            numbers("corrected (Miller-Madow)", "bit", 3),
            numbers("most possible", "bit", 3),
        ],
    );
    let parts = task.parts();
    for part in &parts {
        let answers = answers(task, Some(part));
        match matrix_of(task, &answers).and_then(|matrix| matrix.information()) {
            Ok(information) => {
                let presented = distinct(answers.iter().map(|answer| answer.presented)).len();
                table.row(cells![
                    *part,
                    answers.len(),
                    information.observed_bits,
                    information.corrected_bits,
                    (presented as f64).log2()
                ]);
            }
            Err(error) => section.lacks(part, error),
        }
    }
    if parts.is_empty() {
        section.lacks("Information", NO_ANSWERS);
    }
    section.add(table);
    section
}

/// For each part: response bias, shares correct, and learning over the blocks.
pub fn designs(task: &Task) -> Vec<Design> {
    let mut designs = Vec::new();
    for part in task.parts() {
        let answers = answers(task, Some(part));
        let participants = distinct(answers.iter().map(|answer| answer.participant));
        let counts: Vec<_> = participants
            .iter()
            .flat_map(|participant| {
                let own: Vec<_> =
                    answers.iter().filter(|answer| answer.participant == *participant).collect();
                let of = |word: &String| {
                    let named = own.iter().filter(|answer| answer.answered == word).count();
                    (*participant, word.clone(), named as f64 / own.len() as f64)
                };
                task.answers.iter().map(of).collect::<Vec<_>>()
            })
            .collect();
        let bias = format!("share of all answers (response bias), {part}");
        designs.push(Design::one(bias, "answer", &task.answers, &counts).with(Contrast::First));
        designs.push(design_of_materials(task, part, &answers));
        let mut blocks = distinct(answers.iter().map(|answer| answer.trial.record.block));
        blocks.sort_unstable();
        if blocks.len() > 1 {
            let by_block: Vec<_> = answers
                .iter()
                .map(|answer| (answer.participant, answer.trial.record.block, percent(answer)))
                .collect();
            designs.push(Design::one(
                format!("correct / %, {part} (learning)"),
                "block",
                &blocks,
                &by_block,
            ));
        }
    }
    designs
}

/// Shares correct of a part, by what was presented.
fn design_of_materials(task: &Task, part: &str, answers: &[Answer<'_>]) -> Design {
    let correct = answers
        .iter()
        .map(|answer| (answer.participant, answer.presented.to_owned(), percent(answer)));
    Design::one(
        format!("correct / %, {part}"),
        "presented",
        &words_presented(task, answers),
        &correct.collect::<Vec<_>>(),
    )
    .without("presented", expected_words(task, Some(part)))
}

/// Shares correct of each part, by what was presented.
pub fn designs_of_materials(task: &Task) -> Vec<Design> {
    let parts = task.parts().into_iter();
    parts.map(|part| design_of_materials(task, part, &answers(task, Some(part)))).collect()
}

/// An answer in per cent correct.
fn percent(answer: &Answer<'_>) -> f64 {
    100.0 * f64::from(u8::from(answer.presented == answer.answered))
}

fn words_presented(task: &Task, answers: &[Answer<'_>]) -> Vec<String> {
    let is_there = |word: &&String| answers.iter().any(|answer| answer.presented == *word);
    task.answers.iter().filter(is_there).cloned().collect()
}

/// Words that were correct in trials of a part, whether they were answered or not.
fn expected_words<'a>(task: &'a Task, part: Option<&str>) -> Vec<&'a str> {
    let of_part =
        task.trials().filter(|(_, trial)| part.is_none_or(|part| trial.record.part == part));
    distinct(of_part.filter_map(|(_, trial)| trial.record.expected.as_deref()))
}

pub fn design_of_parts(task: &Task) -> Design {
    let answers = answers(task, None);
    let parts: Vec<String> = task.parts().into_iter().map(str::to_owned).collect();
    let observations: Vec<_> = answers
        .iter()
        .map(|answer| {
            let cell = (answer.trial.record.part.clone(), answer.presented.to_owned());
            (answer.participant, cell, percent(answer))
        })
        .collect();
    let presented = words_presented(task, &answers);
    Design::two("correct / %", ("part", &parts), ("presented", &presented), &observations)
        .without("presented", expected_words(task, None))
}

/// Parts of the answers of each cell in a part of the session: presented, answered, share of the row.
pub fn proportions(task: &Task, part: &str) -> Vec<((String, String), f64)> {
    let answers = answers(task, Some(part));
    let mut cells = Vec::new();
    for presented in &task.answers {
        for answered in &task.answers {
            let row = answers.iter().filter(|answer| answer.presented == presented);
            let share = mean(row.map(|answer| f64::from(u8::from(answer.answered == answered))));
            cells.extend(share.map(|share| ((presented.clone(), answered.clone()), share)));
        }
    }
    cells
}

/// What a published result is of, `PART, MATERIAL`, %, or the correlation of the parts.
pub fn measured(task: &Task, of: &str) -> Option<f64> {
    let Some((part, what)) = of.split_once(", ") else {
        let (one, other) = (proportions(task, "real"), proportions(task, "simulated"));
        let of_both = one
            .iter()
            .filter_map(|(cell, x)| Some((*x, other.iter().find(|(other, _)| other == cell)?.1)));
        let (x, y): (Vec<f64>, Vec<f64>) = of_both.unzip();
        return pearson(&x, &y).ok().map(|found| found.r);
    };
    let answers = answers(task, Some(part));
    let percent = |word: Option<&str>| {
        let of = answers.iter().filter(|answer| word.is_none_or(|word| answer.presented == word));
        Share::new(of.map(|answer| (answer.participant, answer.presented == answer.answered)))
            .percent()
    };
    match what {
        "all" => percent(None),
        "worst material" => {
            let of_each = task.answers.iter().filter_map(|word| percent(Some(word)));
            of_each.min_by(f64::total_cmp)
        }
        material => percent(Some(material)),
    }
}
