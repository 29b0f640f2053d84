//! Same or different: whether two materials are told apart.

use experiment_statistics::distribution::normal_quantile;

use super::NO_ANSWERS;
use super::design::Design;
use super::share::Share;
use crate::cells::distinct;
use crate::input::Task;
use crate::report::{Section, Table, cells, numbers, probabilities, words};
use experiment_statistics::chi_square::contingency;

struct Answer {
    participant: usize,
    pair: String,
    is_equal: bool,
    says_different: bool,
}

const SAME: &str = "same";
const DIFFERENT: &str = "different";

fn answers(task: &Task) -> Vec<Answer> {
    let all = task.trials().filter_map(|(participant, trial)| {
        let says_different = match trial.record.answer.as_deref()? {
            SAME => false,
            DIFFERENT => true,
            _ => return None,
        };
        let materials = task.sorted(trial.stimuli().map(|stimulus| stimulus.material));
        let (first, last) = (materials.first()?, materials.last()?);
        Some(Answer {
            participant,
            pair: format!("{first} / {last}"),
            is_equal: materials.len() == 1,
            says_different,
        })
    });
    all.collect()
}

/// Answers `different` to different and to equal materials.
pub fn same_different(task: &Task) -> Section {
    let mut section = Section::new("same-different", "Same or different").note(
        "Hits are answers \"different\" to different materials, false alarms those to equal ones. z(H) − z(F), of log-linear \
         shares, is the distance in a yes-no task; where participants compare the two sensations with each other it \
         underestimates their sensitivity. chi-squared compares the hits of a pair with all false alarms.",
    );
    let answers = answers(task);
    if answers.is_empty() {
        section.lacks("Table", NO_ANSWERS);
        return section;
    }
    let share = |is_of: &dyn Fn(&&Answer) -> bool| {
        let of = answers.iter().filter(is_of);
        Share::new(of.map(|answer| (answer.participant, answer.says_different)))
    };
    let alarms = share(&|answer| answer.is_equal);
    if alarms.total() == 0 {
        section.lacks(
            "z(H) − z(F)",
            "no trial that counts presents equal materials, so there are no false alarms",
        );
    }
    let z = |share: &Share| normal_quantile(share.proportion()?.log_linear()).ok();
    let counts = |share: &Share| [share.correct(), share.total() - share.correct()];
    let mut table = Table::new(
        "same-different",
        "Answers \"different\" by pair; n counts answers",
        [
            words("pair"),
            words("n"),
            words("different"),
            numbers("share", "%", 1),
            numbers("95 % from", "%", 1),
            numbers("95 % to", "%", 1),
            numbers("z(H) - z(F)", "", 2),
            numbers("chi-squared", "", 2),
            probabilities("p"),
        ],
    );
    for pair in distinct(answers.iter().map(|answer| &answer.pair)) {
        let own = share(&|answer| answer.pair == *pair);
        let is_equal = answers
            .iter()
            .any(|answer| answer.pair == *pair && answer.is_equal);
        let (low, high) = own.interval().unzip();
        let hits = (!is_equal && alarms.total() > 0).then_some(&own);
        let test = hits.and_then(|hits| contingency(&[counts(hits), counts(&alarms)]).ok());
        table.row(cells![
            pair.clone(),
            own.total(),
            own.correct(),
            own.percent(),
            low,
            high,
            hits.and_then(|hits| Some(z(hits)? - z(&alarms)?)),
            test.map(|test| test.statistic),
            test.map(|test| test.p)
        ]);
    }
    section.add(table);
    section
}

pub fn design(task: &Task) -> Design {
    let answers = answers(task);
    let levels = distinct(answers.iter().map(|answer| answer.pair.clone()));
    let observations: Vec<_> = answers
        .iter()
        .map(|answer| {
            (
                answer.participant,
                answer.pair.clone(),
                100.0 * f64::from(u8::from(answer.says_different)),
            )
        })
        .collect();
    Design::one("answers \"different\" / %", "pair", &levels, &observations)
}
