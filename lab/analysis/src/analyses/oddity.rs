//! The different one of three.

use experiment_statistics::sensitivity::{d_prime, d_prime_oddity};

use thermal_thesis::published::PublishedPair;

use super::design::Design;
use super::share::{READING, Share, columns, picture};
use super::{NO_ANSWERS, left_out};
use crate::input::{Task, Trial};
use crate::report::{Section, Table, cells, numbers, words};

struct Answer<'a> {
    participant: usize,
    target: &'a str,
    distractor: &'a str,
    /// Station of the target.
    position: usize,
    is_correct: bool,
}

const MODES: [&str; 2] = ["high/low", "low/high"];

fn answers(task: &Task) -> Vec<Answer<'_>> {
    task.trials().filter_map(|(participant, trial)| answer(participant, trial)).collect()
}

fn answer(participant: usize, trial: &Trial) -> Option<Answer<'_>> {
    let stimuli: Vec<_> = trial.stimuli().collect();
    let [one, two, three] = stimuli[..] else {
        return None;
    };
    let (target, distractor) = match (one.material == two.material, two.material == three.material)
    {
        (true, false) => (three, one),
        (false, true) => (one, two),
        (false, false) if one.material == three.material => (two, one),
        _ => return None,
    };
    Some(Answer {
        participant,
        target: target.material,
        distractor: distractor.material,
        position: target.station,
        is_correct: trial.record.is_correct?,
    })
}

impl Answer<'_> {
    fn is_high_low(&self, task: &Task) -> Option<bool> {
        Some(task.effusivity(self.target)? > task.effusivity(self.distractor)?)
    }

    fn mode(&self, task: &Task) -> Option<&'static str> {
        self.is_high_low(task).map(|is_high| MODES[usize::from(!is_high)])
    }
}

/// Answers by target and distractor, mode, and position.
pub fn oddity(task: &Task) -> Section {
    let mut section = Section::new("oddity", "The different one of three")
        .note(
            "high/low: the target has the larger contact coefficient and the two distractors the smaller one; low/high the \
             other way round.",
        )
        .note(READING)
        .note(
            "Participants look for the station that differs and are not told in which direction: this is an oddity task \
             (triangular method). d' of a three-alternative forced choice (3AFC), which the thesis prints, presupposes that the \
             target is known to be the colder one; it needs less evidence for the same share correct, so d' by 3AFC is too small \
             here. Both are of p = (k + ½)/(n + 1); by oddity it is 0 at chance and below.",
        );
    let answers = answers(task);
    let others = task.trials().filter(|(participant, trial)| answer(*participant, trial).is_none());
    let others: Vec<_> = others.map(|(participant, _)| participant).collect();
    let what = "trials without a scored answer, or without three materials of which one differs";
    left_out::count(&mut section, task, &others, what);
    if answers.is_empty() {
        section.lacks("Tables", NO_ANSWERS);
        return section;
    }
    let share = |is_of: &dyn Fn(&&Answer<'_>) -> bool| {
        let of = answers.iter().filter(is_of);
        Share::new(of.map(|answer| (answer.participant, answer.is_correct)))
    };
    let sensitivities = || [numbers("d' (oddity)", "", 2), numbers("d' (3AFC)", "", 2)];
    let sensitivity = |share: &Share| {
        let p = share.proportion().map(|proportion| proportion.log_linear());
        cells![p.and_then(|p| d_prime_oddity(p).ok()), p.and_then(|p| d_prime(3, p).ok())]
    };

    let mut table = Table::new(
        "oddity",
        "Correct answers by target and distractor; n counts answers",
        [
            words("target"),
            words("distractor"),
            words("mode"),
            numbers("ratio of contact coefficients", "", 2),
        ]
        .into_iter()
        .chain(columns())
        .chain(sensitivities()),
    );
    let materials =
        task.sorted(answers.iter().flat_map(|answer| [answer.target, answer.distractor]));
    let mut marks = Vec::new();
    for (i, high) in materials.iter().enumerate() {
        for low in &materials[i + 1..] {
            for (series, (target, distractor)) in [(high, low), (low, high)].into_iter().enumerate()
            {
                let share =
                    share(&|answer| answer.target == *target && answer.distractor == *distractor);
                if share.total() == 0 {
                    continue;
                }
                let both = task.effusivity(high).zip(task.effusivity(low));
                let mut row =
                    cells![*target, *distractor, MODES[series], both.map(|(high, low)| high / low)];
                row.extend(share.cells(task.chance));
                row.extend(sensitivity(&share));
                table.row(row);
                marks.extend(share.mark(format!("{high} / {low}"), series));
            }
        }
    }
    section.draw(
        "Correct answers by pair and mode",
        picture(&marks, &MODES, task.chance, task.threshold),
    );
    section.add(table);

    let mut table = Table::new(
        "oddity-modes",
        "Correct answers by mode and by the position of the target; n counts answers",
        [words("trials")].into_iter().chain(columns()).chain(sensitivities()),
    );
    let mut add = |name: &str, share: &Share| {
        if share.total() > 0 {
            let mut row = cells![name];
            row.extend(share.cells(task.chance));
            row.extend(sensitivity(share));
            table.row(row);
        }
    };
    add("all", &share(&|_| true));
    for mode in MODES {
        add(mode, &share(&|answer| answer.mode(task) == Some(mode)));
    }
    for (position, station) in task.stations.iter().enumerate() {
        add(&format!("target at {station}"), &share(&|answer| answer.position == position));
    }
    section.add(table);
    section
}

/// The answers to a published target and distractor.
pub fn share_of(task: &Task, published: &PublishedPair) -> Share {
    let answers = answers(task).into_iter();
    let of = answers
        .filter(|answer| answer.target == published.first && answer.distractor == published.second);
    Share::new(of.map(|answer| (answer.participant, answer.is_correct)))
}

pub fn designs(task: &Task) -> Vec<Design> {
    let answers = answers(task);
    let percent = |answer: &Answer<'_>| 100.0 * f64::from(u8::from(answer.is_correct));
    let owned =
        |names: &[&str]| -> Vec<String> { names.iter().map(|name| (*name).to_owned()).collect() };
    let materials =
        owned(&task.sorted(answers.iter().flat_map(|answer| [answer.target, answer.distractor])));
    let roles: Vec<_> = answers
        .iter()
        .flat_map(|answer| {
            [(answer.target, "target"), (answer.distractor, "distractor")].map(
                |(material, role)| {
                    (answer.participant, (material.to_owned(), role.to_owned()), percent(answer))
                },
            )
        })
        .collect();
    let positions: Vec<_> = answers
        .iter()
        .filter_map(|answer| {
            let station = task.stations.get(answer.position)?.clone();
            Some((answer.participant, (station, answer.mode(task)?.to_owned()), percent(answer)))
        })
        .collect();
    vec![
        Design::two(
            "correct / %, each trial once for its target and once for its distractor",
            ("material", &materials),
            ("role", &owned(&["target", "distractor"])),
            &roles,
        ),
        Design::two(
            "correct / %",
            ("position", &task.stations),
            ("mode", &owned(&MODES)),
            &positions,
        ),
    ]
}
