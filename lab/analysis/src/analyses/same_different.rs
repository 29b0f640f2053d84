//! Same or different: whether two materials are told apart.

use experiment_statistics::distribution::normal_quantile;

use super::design::Design;
use super::share::Share;
use super::{NO_ANSWERS, chi_square, left_out, pairs};
use crate::cells::distinct;
use crate::input::{Task, Trial};
use crate::report::{Section, Table, cells, numbers, probabilities, words};
use experiment_statistics::chi_square::contingency;

struct Answer<'a> {
    participant: usize,
    /// The materials, that of the larger contact coefficient first.
    pair: [&'a str; 2],
    says_different: bool,
}

impl Answer<'_> {
    fn name(&self) -> String {
        self.pair.join(pairs::BETWEEN)
    }

    fn is_equal(&self) -> bool {
        self.pair[0] == self.pair[1]
    }
}

const SAME: &str = "same";
const DIFFERENT: &str = "different";

fn answers(task: &Task) -> Vec<Answer<'_>> {
    task.trials().filter_map(|(participant, trial)| answer(task, participant, trial)).collect()
}

fn answer<'a>(task: &Task, participant: usize, trial: &'a Trial) -> Option<Answer<'a>> {
    let says_different = match trial.record.answer.as_deref()? {
        SAME => false,
        DIFFERENT => true,
        _ => return None,
    };
    let materials = trial.stimuli().map(|stimulus| stimulus.material);
    let materials = task.sorted(materials.collect::<Vec<_>>());
    Some(Answer { participant, pair: [*materials.first()?, *materials.last()?], says_different })
}

/// The pairs by the place of their materials.
fn sorted_pairs<'a>(task: &Task, answers: &[Answer<'a>]) -> Vec<[&'a str; 2]> {
    let materials = task.sorted(answers.iter().flat_map(|answer| answer.pair));
    let place = |name: &str| materials.iter().position(|one| *one == name);
    let mut pairs = distinct(answers.iter().map(|answer| answer.pair));
    pairs.sort_by_key(|pair| pair.map(place));
    pairs
}

/// Answers `different` to different and to equal materials.
pub fn same_different(task: &Task) -> Section {
    let mut section = Section::new("same-different", "Same or different").note(
        "Hits are answers \"different\" to different materials, false alarms those to equal ones. z(H) − z(F), of log-linear \
         shares, is the distance in a yes-no task; where participants compare the two sensations with each other it \
         underestimates their sensitivity. chi-squared compares the hits of a pair with all false alarms.",
    );
    let answers = answers(task);
    let others = task.trials().filter(|(one, trial)| answer(task, *one, trial).is_none());
    let others: Vec<_> = others.map(|(participant, _)| participant).collect();
    left_out::count(&mut section, task, &others, "trials without the answer same or different");
    if answers.is_empty() {
        section.lacks("Table", NO_ANSWERS);
        return section;
    }
    let share = |is_of: &dyn Fn(&&Answer<'_>) -> bool| {
        let of = answers.iter().filter(is_of);
        Share::new(of.map(|answer| (answer.participant, answer.says_different)))
    };
    let alarms = share(&|answer| answer.is_equal());
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
            numbers("smallest expected count", "", 1),
        ],
    );
    for pair in sorted_pairs(task, &answers) {
        let own = share(&|answer| answer.pair == pair);
        let is_equal = pair[0] == pair[1];
        let (low, high) = own.interval().unzip();
        let hits = (!is_equal && alarms.total() > 0).then_some(&own);
        let test = hits.and_then(|hits| contingency(&[counts(hits), counts(&alarms)]).ok());
        let pair = pair.join(pairs::BETWEEN);
        section.warn(test.and_then(|test| chi_square::warning(&pair, &test)));
        table.row(cells![
            pair,
            own.total(),
            own.correct(),
            own.percent(),
            low,
            high,
            hits.and_then(|hits| Some(z(hits)? - z(&alarms)?)),
            test.map(|test| test.statistic),
            test.map(|test| test.p),
            test.map(|test| test.smallest_expected)
        ]);
    }
    section.add(table);
    section
}

pub fn design(task: &Task) -> Design {
    let answers = answers(task);
    let levels: Vec<String> =
        sorted_pairs(task, &answers).into_iter().map(|pair| pair.join(pairs::BETWEEN)).collect();
    let observations: Vec<_> = answers
        .iter()
        .map(|answer| {
            (answer.participant, answer.name(), 100.0 * f64::from(u8::from(answer.says_different)))
        })
        .collect();
    Design::one("answers \"different\" / %", "pair", &levels, &observations)
}
