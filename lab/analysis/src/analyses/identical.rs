//! Answers to pairs of equal materials: there is no correct one, but there may be a bias.

use experiment_statistics::proportion::Proportion;
use experiment_statistics::t_test::one_sample;

use super::left_out;
use super::share::Share;
use crate::cells::means_of_participants;
use crate::input::{Task, Trial};
use crate::report::{Section, Table, cells, numbers, probabilities, words};

/// An answer to equal materials.
struct Answer<'a> {
    participant: usize,
    material: &'a str,
    station: usize,
    /// Whether the named station presents a sample and the other a simulated material; `None` if both are of a kind.
    is_sample: Option<bool>,
}

fn answer<'a>(task: &Task, participant: usize, trial: &'a Trial) -> Option<Answer<'a>> {
    let stimuli: Vec<_> = trial.stimuli().collect();
    let [one, other] = stimuli[..] else {
        return None;
    };
    let named = trial.record.answer.as_ref()?;
    let station = task.stations.iter().position(|station| station == named)?;
    let of_named = stimuli.iter().find(|stimulus| stimulus.station == station)?;
    (one.material == other.material).then_some(Answer {
        participant,
        material: one.material,
        station,
        is_sample: (one.is_simulated != other.is_simulated).then_some(!of_named.is_simulated),
    })
}

/// Which station, and whether sample or simulated material, is called colder.
pub fn identical_pairs(task: &Task) -> Section {
    let mut section = Section::new("identical-pairs", "Pairs of equal materials").note(
        "Neither answer is correct. The exact binomial p, of either side, treats answers as independent; the t test compares \
         the participants' own shares with one half (degrees of freedom: participants less 1), and is the one to rely on.",
    );
    let all = task.trials();
    let answers: Vec<_> = all.filter_map(|(who, trial)| answer(task, who, trial)).collect();
    let unnamed = task.trials().filter(|(who, trial)| {
        let materials: Vec<_> = trial.stimuli().map(|stimulus| stimulus.material).collect();
        matches!(materials[..], [one, other] if one == other) && answer(task, *who, trial).is_none()
    });
    let unnamed: Vec<_> = unnamed.map(|(who, _)| who).collect();
    let what = "trials with equal materials and no answer that names a station";
    left_out::count(&mut section, task, &unnamed, what);
    let Some(last) = task.stations.last().filter(|_| !answers.is_empty()) else {
        section.lacks(
            "Bias",
            "no trial that counts presents equal materials and has an answer that names a station",
        );
        return section;
    };
    let mut table = Table::new(
        "identical-pairs",
        "Answers to equal materials; n counts answers",
        [
            words("material"),
            words("answer"),
            words("n"),
            words("times"),
            numbers("share", "%", 1),
            numbers("95 % from", "%", 1),
            numbers("95 % to", "%", 1),
            probabilities("p (binomial)"),
            words("participants"),
            numbers("t", "", 3),
            numbers("df", "", 0),
            probabilities("p (t)"),
        ],
    );
    let right = task.stations.len() - 1;
    let mut materials: Vec<Option<&str>> = vec![None];
    materials
        .extend(task.sorted(answers.iter().map(|answer| answer.material)).into_iter().map(Some));
    for material in materials {
        let of =
            answers.iter().filter(|answer| material.is_none_or(|name| answer.material == name));
        let of: Vec<_> = of.collect();
        let sides =
            Share::new(of.iter().map(|answer| (answer.participant, answer.station == right)));
        let kinds = of.iter().filter_map(|answer| Some((answer.participant, answer.is_sample?)));
        let kinds = Share::new(kinds);
        for (share, name) in [(sides, last.as_str()), (kinds, "the real one")] {
            let Some(proportion) = share.proportion() else {
                continue;
            };
            let own = means_of_participants(share.observations());
            let test = one_sample(&own, 0.5);
            if let (Err(error), None) = (&test, material) {
                section.lacks(&format!("t test of \"{name}\""), error);
            }
            let (low, high) = share.interval().unzip();
            table.row(cells![
                material.unwrap_or("all"),
                name,
                share.total(),
                share.correct(),
                share.percent(),
                low,
                high,
                two_sided(proportion),
                own.len(),
                test.as_ref().ok().map(|test| test.t),
                test.as_ref().ok().map(|test| test.df),
                test.as_ref().ok().map(|test| test.p)
            ]);
        }
    }
    section.add(table);
    section
}

/// Probability of a share as far from one half or farther.
fn two_sided(proportion: Proportion) -> Option<f64> {
    let wrong = proportion.total() - proportion.correct();
    let most = proportion.correct().max(wrong);
    let tail = Proportion::new(most, proportion.total()).ok()?.p_by_chance(0.5).ok()?;
    Some((2.0 * tail).min(1.0))
}
