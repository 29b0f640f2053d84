//! The table `[score]`.

use super::design::Parts;
use super::source::SessionError;
use super::trial::{Trial, follows_force};
use super::value::{Number, Table, Value, listed};
use crate::{
    ANALYSES, AnswerKind, ContactRule, CorrectAnswer, PUBLISHED_TABLES, Present, Procedure, Score,
    Station, Stimulus,
};

pub(super) const SCORE_KEYS: [&str; 5] = ["correct", "chance", "threshold", "analyses", "against"];
pub(super) const CORRECT_KEYS: [&str; 1] = ["factor"];
pub(super) const CHANCE: Number = Number::new("chance", 0.0, 1.0, None);
pub(super) const THRESHOLD: Number = Number::new("threshold", 0.0, 1.0, None);

/// What the table is checked against.
pub(super) struct Facts<'f, 'a> {
    pub stations: &'f [Station],
    pub present: &'f Present,
    pub trial: &'f Trial<'a>,
    pub design: &'f Parts<'a>,
}

pub(super) fn score<'a>(
    given: Option<&Value<'a>>,
    file: &Table<'a>,
    facts: &Facts<'_, 'a>,
) -> Result<Score, SessionError> {
    let table = match given {
        Some(given) => given.table(&SCORE_KEYS)?,
        None => file.empty("score"),
    };
    let correct = match table.get("correct") {
        None => CorrectAnswer::None,
        Some(value) => correct(value, facts)?,
    };
    if let (true, CorrectAnswer::None, Some(feedback)) =
        (facts.trial.rules.feedback, &correct, &facts.trial.feedback)
    {
        return Err(feedback.wrong("false, or true beside score.correct"));
    }
    if let (CorrectAnswer::None, Some(staircase)) = (&correct, facts.design.staircase_at.first()) {
        let problem = "a staircase follows correct answers; it is allowed beside score.correct";
        return Err(staircase.error(problem));
    }
    if correct == CorrectAnswer::None {
        table.without(&["chance", "threshold"], "beside score.correct")?;
    }
    let optional =
        |key: &Number| (table.get(key.key)).map(|value| value.number(key.range)).transpose();
    let answers = facts.trial.words.len();
    let by_number = (correct != CorrectAnswer::None && answers > 0).then(|| 1.0 / answers as f64);
    let (chance, threshold) = (optional(&CHANCE)?.or(by_number), optional(&THRESHOLD)?);
    if let (Some(chance), Some(threshold), Some(value)) =
        (chance, threshold, table.get(THRESHOLD.key))
        && threshold <= chance
    {
        return Err(value.wrong(format!("more than the chance {chance:.3}")));
    }
    let analyses = analyses(&table, &correct, facts)?;
    let published = PUBLISHED_TABLES.map(|table| (table, table));
    let against = table.get("against").map(|value| value.word(&published)).transpose()?;
    let compares = analyses.iter().any(|analysis| analysis == "chi-squared-against");
    if !compares {
        table.without(&["against"], "beside \"chi-squared-against\" in score.analyses")?;
    }
    Ok(Score { correct, chance, threshold, analyses, against: against.map(Into::into) })
}

/// How many materials the stations of a case present, at least.
fn least_materials(present: &Present) -> usize {
    let materials = |stations: &Vec<Stimulus>| {
        stations.iter().filter(|stimulus| stimulus.material().is_some()).count()
    };
    let counts = present.cases.iter().map(|case| materials(&case.stations));
    counts.min().unwrap_or_default()
}

/// Which answer is correct: it must be one of the answers in all trials.
fn correct(value: &Value<'_>, facts: &Facts<'_, '_>) -> Result<CorrectAnswer, SessionError> {
    const ALLOWED: &str = "\"none\", \"colder\", \"same\" or a table { factor = … }";
    let words: Vec<_> = facts.trial.words.iter().map(|(word, _)| &**word).collect();
    let needs_words = |what: &str| {
        value.error(format!(
            "{} = {what} without answers; it is allowed beside trial.answer.one_of",
            value.key
        ))
    };
    if value.is_table() {
        let table = value.table(&CORRECT_KEYS)?;
        let parts = facts.design.all();
        let allowed = format!("a factor of all parts: {}", facts.design.common(&parts));
        let factor = table.need("factor", &allowed)?;
        let name = factor.string(&allowed)?;
        for part in parts {
            let Some(levels) = facts.design.factor(part, name) else {
                return Err(factor.wrong(allowed));
            };
            if words.is_empty() {
                return Err(needs_words("a factor"));
            }
            if let Some((level, _)) =
                levels.levels.iter().find(|(level, _)| !words.contains(&&**level))
            {
                let problem = format!(
                    "{} = {name:?}, whose level {level:?} is no answer; allowed is a factor of which each level is one of {}",
                    factor.key,
                    listed(&words)
                );
                return Err(factor.error(problem));
            }
        }
        return Ok(CorrectAnswer::Factor(name.into()));
    }
    let kinds =
        [("none", CorrectKind::None), ("colder", CorrectKind::Colder), ("same", CorrectKind::Same)];
    let kind = value.word(&kinds).map_err(|_| value.wrong(ALLOWED))?;
    if kind == CorrectKind::None {
        return Ok(CorrectAnswer::None);
    }
    if words.is_empty() {
        return Err(needs_words(if kind == CorrectKind::Colder {
            "\"colder\""
        } else {
            "\"same\""
        }));
    }
    if least_materials(facts.present) < 2 {
        let problem = format!(
            "{} compares materials; it is allowed if each trial presents two materials or more",
            value.key
        );
        return Err(value.error(problem));
    }
    if kind == CorrectKind::Same {
        let odd =
            facts.trial.words.iter().find(|(word, _)| !["same", "different"].contains(&&**word));
        return match odd {
            None => Ok(CorrectAnswer::Same),
            Some((_, at)) => Err(at.wrong("same and different with score.correct = \"same\"")),
        };
    }
    let stations: Vec<_> = facts.stations.iter().map(|station| &*station.name).collect();
    if let Some((_, at)) = facts.trial.words.iter().find(|(word, _)| !stations.contains(&&**word)) {
        return Err(
            at.wrong(format!("a station, with score.correct = \"colder\": {}", listed(&stations)))
        );
    }
    let presents = |index: usize| {
        let mut stimuli = facts.present.cases.iter().filter_map(|case| case.stations.get(index));
        stimuli.any(|stimulus| stimulus.material().is_some())
    };
    let unanswered = |(index, name): &(usize, &&str)| presents(*index) && !words.contains(*name);
    if let Some((_, station)) = stations.iter().enumerate().find(unanswered) {
        let problem = format!(
            "{} = \"colder\", but {station:?} is no answer; it is allowed if trial.answer.one_of names each station \
             that presents a material",
            value.key
        );
        return Err(value.error(problem));
    }
    Ok(CorrectAnswer::ColderStation)
}

#[derive(Clone, Copy, PartialEq)]
enum CorrectKind {
    None,
    Colder,
    Same,
}

fn analyses(
    table: &Table<'_>,
    correct: &CorrectAnswer,
    facts: &Facts<'_, '_>,
) -> Result<Vec<String>, SessionError> {
    let Some(list) = table.get("analyses") else {
        return Ok(Vec::new());
    };
    let known = ANALYSES.map(|(word, needs)| (word, (word, needs)));
    let words = known.map(|(word, _)| word);
    let allowed = format!("a list of some of {}", listed(&words));
    let values = list.list(&allowed)?;
    let mut analyses: Vec<String> = Vec::new();
    for value in &values {
        let (word, needs) = value.word(&known).map_err(|_| value.wrong(listed(&words)))?;
        if analyses.iter().any(|before| before == word) {
            continue;
        }
        analyses.push(word.into());
        let chosen =
            |word: &str| values.iter().any(|value| value.string("").is_ok_and(|it| it == word));
        if !has_what_it_needs(word, &chosen, table, correct, facts) {
            return Err(value.error(format!("score.analyses: {word:?} needs {needs}")));
        }
    }
    Ok(analyses)
}

/// Whether a session has what an analysis needs; [`ANALYSES`] says it in words.
fn has_what_it_needs(
    word: &str,
    chosen: &dyn Fn(&str) -> bool,
    table: &Table<'_>,
    correct: &CorrectAnswer,
    facts: &Facts<'_, '_>,
) -> bool {
    let rules = &facts.trial.rules;
    let has_correct = *correct != CorrectAnswer::None;
    let rests = follows_force(rules)
        || matches!(rules.procedure, Procedure::Touch { contact: ContactRule::Hold, .. });
    let parts = facts.design.design.parts.len();
    let has_factor = facts.design.design.factor_names().iter().any(|name| {
        let mut levels: Vec<_> = (facts.design.factors.iter())
            .filter(|factor| factor.name == *name)
            .flat_map(|factor| factor.levels.iter().map(|(level, _)| level))
            .collect();
        levels.sort();
        levels.dedup();
        levels.len() > 1
    });
    let confusion = || match correct {
        CorrectAnswer::Factor(factor) => {
            let answers = facts.trial.words.iter();
            let levels = |word: &str| {
                let mut factors =
                    facts.design.factors.iter().filter(|of_part| of_part.name == *factor);
                factors.any(|of_part| of_part.levels.iter().any(|(level, _)| level == word))
            };
            answers.into_iter().all(|(word, _)| levels(word))
        }
        _ => false,
    };
    match word {
        "pairs" => has_correct && least_materials(facts.present) >= 2,
        "pairs-by-mode" => {
            let both = facts.present.cases.iter().all(|case| {
                let sample = |stimulus: &Stimulus| matches!(stimulus, Stimulus::Sample(_));
                let display = |stimulus: &Stimulus| matches!(stimulus, Stimulus::Display { .. });
                case.stations.iter().any(sample) && case.stations.iter().any(display)
            });
            has_correct && both
        }
        "identical-pairs" => *correct == CorrectAnswer::ColderStation,
        "confusion" | "information" => confusion(),
        "oddity" => {
            let is_answer =
                |station: &Station| facts.trial.words.iter().any(|(word, _)| *word == station.name);
            facts.stations.len() == 3 && confusion() && facts.stations.iter().all(is_answer)
        }
        "same-different" => *correct == CorrectAnswer::Same,
        "falls" | "exponential-fit" | "levene" | "pearson-with-model" => rests,
        "force-matching" => follows_force(rules),
        "anova-within" => has_factor,
        "anova-split-plot" => has_factor && parts > 1,
        "ancova" => chosen("pairs") || chosen("confusion"),
        "tukey" => chosen("anova-within") || chosen("anova-split-plot"),
        "pearson-between-parts" => (chosen("confusion") || chosen("falls")) && parts > 1,
        "chi-squared-against" => {
            (chosen("pairs") || chosen("pairs-by-mode")) && table.get("against").is_some()
        }
        "staircase" => !facts.design.staircases.is_empty(),
        "psychometric-fit" => {
            let mut stimuli = facts.present.cases.iter().flat_map(|case| &case.stations);
            has_correct && stimuli.any(|stimulus| matches!(stimulus, Stimulus::Pulses(_)))
        }
        "magnitudes" => matches!(
            facts.trial.answer.as_ref().map(|answer| &answer.kind),
            Some(AnswerKind::NumberPerStation(..))
        ),
        _ => false,
    }
}
