//! The tables `[trial]` and `[void]`.

use thermal_client::text::is_control;

use super::design::Parts;
use super::present::{Presentation, quantity};
use super::setup::setpoints_c;
use super::source::SessionError;
use super::value::{Number, Table, Value, Whole};
use crate::{
    Answer, AnswerKind, ContactRule, Procedure, Pulses, Quantity, Station, Stimulus, TrialRules,
    VoidRules,
};

const TOUCH_KEYS: [&str; 5] = ["reach_s", "contact", "max_s", "land_s", "target_force_n"];
const INTERVALS_KEYS: [&str; 2] = ["interval_s", "gap_s"];
pub(super) const TRIAL_KEYS: [&str; 11] = [
    "procedure",
    "reach_s",
    "contact",
    "max_s",
    "land_s",
    "target_force_n",
    "interval_s",
    "gap_s",
    "answer",
    "answer_s",
    "feedback",
];
pub(super) const REACH_S: Number = Number::new("reach_s", 0.0, 60.0, Some(0.0));
pub(super) const MAX_S: Number = Number::new("max_s", 0.5, 600.0, Some(10.0));
pub(super) const LAND_S: Number = Number::new("land_s", 0.5, 60.0, Some(5.0));
pub(super) const TARGET_FORCE_N: Number = Number::new("target_force_n", 0.05, 5.0, None);
pub(super) const INTERVAL_S: Number = Number::new("interval_s", 0.5, 60.0, None);
pub(super) const GAP_S: Number = Number::new("gap_s", 0.5, 60.0, None);
pub(super) const ANSWER_S: Number = Number::new("answer_s", 1.0, 600.0, Some(10.0));
pub(super) const ANSWER_KEYS: [&str; 3] = ["ask", "one_of", "number_per_station"];

pub(super) const VOID_KEYS: [&str; 6] = [
    "display_off_preset_k",
    "force_max_n",
    "contact_min_s",
    "force_off_target",
    "landings_apart_s",
    "attempts_max",
];
pub(super) const DISPLAY_OFF_PRESET_K: Number =
    Number::new("display_off_preset_k", 0.01, 10.0, Some(0.3));
pub(super) const FORCE_MAX_N: Number = Number::new("force_max_n", 0.1, 10.0, Some(5.0));
pub(super) const CONTACT_MIN_S: Number = Number::new("contact_min_s", 0.0, 600.0, Some(0.5));
pub(super) const FORCE_OFF_TARGET: Number = Number::new("force_off_target", 0.01, 1.0, None);
pub(super) const LANDINGS_APART_S: Number = Number::new("landings_apart_s", 0.01, 10.0, None);
pub(super) const ATTEMPTS_MAX: Whole = Whole::new("attempts_max", 1, 20, Some(3));

/// The table `[trial]`, with what other tables point to in their errors.
pub(super) struct Trial<'a> {
    pub rules: TrialRules,
    pub answer: Option<Answer>,
    /// The words of an answer that is one of them.
    pub words: Vec<(String, Value<'a>)>,
    pub feedback: Option<Value<'a>>,
}

/// Whether the rules are those of a force that is followed.
pub(super) fn follows_force(rules: &TrialRules) -> bool {
    matches!(rules.procedure, Procedure::Touch { contact: ContactRule::Force, .. })
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Touch,
    Intervals,
}

pub(super) fn trial<'a>(
    file: &Value<'a>,
    present: &Presentation<'_>,
    parts: &Parts<'_>,
) -> Result<Trial<'a>, SessionError> {
    let table = file.table(&TRIAL_KEYS)?;
    let kinds = [("touch", Kind::Touch), ("intervals", Kind::Intervals)];
    let kind = table.word_or("procedure", &kinds, Kind::Touch)?;
    let procedure = match kind {
        Kind::Touch => {
            table.without(&INTERVALS_KEYS, "with trial.procedure = \"intervals\"")?;
            let contacts = [
                ("free", ContactRule::Free),
                ("hold", ContactRule::Hold),
                ("force", ContactRule::Force),
            ];
            Procedure::Touch {
                reach_s: table.number(&REACH_S)?,
                contact: table.word_or("contact", &contacts, ContactRule::Free)?,
                max_s: table.number(&MAX_S)?,
            }
        }
        Kind::Intervals => {
            table.without(&TOUCH_KEYS, "with trial.procedure = \"touch\"")?;
            Procedure::Intervals {
                interval_s: table.number(&INTERVAL_S)?,
                gap_s: table.number(&GAP_S)?,
            }
        }
    };
    for (stimulus, value) in &present.stimuli {
        match (kind, stimulus) {
            (Kind::Touch, Stimulus::Pulses(_)) => {
                let problem = format!(
                    "{} presents pulses; they are allowed with trial.procedure = \"intervals\"",
                    value.key
                );
                return Err(value.error(problem));
            }
            (
                Kind::Intervals,
                Stimulus::Sample(_) | Stimulus::Display { .. } | Stimulus::Hold { .. },
            ) => {
                let problem = format!(
                    "{} presents no pulses; allowed with trial.procedure = \"intervals\" are pulses and \"nothing\"",
                    value.key
                );
                return Err(value.error(problem));
            }
            _ => {}
        }
        if let (Procedure::Intervals { interval_s, gap_s }, Stimulus::Pulses(pulses)) =
            (procedure, stimulus)
        {
            fits(pulses, value, parts, interval_s.min(gap_s))?;
        }
    }
    let (answer, words) = answer(&table, parts)?;
    let rules = TrialRules {
        procedure,
        land_s: table.number(&LAND_S)?,
        answer_s: table.number(&ANSWER_S)?,
        feedback: table.boolean_or("feedback", false)?,
        target_force_n: target_force(&table, procedure, parts)?,
    };
    if let (true, None) = (follows_force(&rules), &present.display) {
        let at = table.get("contact").unwrap_or(file);
        return Err(at.wrong("\"force\" with a station that presents a display, which measures it"));
    }
    Ok(Trial { rules, answer, words, feedback: table.get("feedback").cloned() })
}

/// The largest departure must be reached within an interval, be undone within the time between two of them, and stay within
/// the set-points of the device.
fn fits(
    pulses: &Pulses,
    value: &Value<'_>,
    parts: &Parts<'_>,
    time_s: f64,
) -> Result<(), SessionError> {
    let levels = |quantity: &Quantity| match quantity {
        Quantity::Fixed(number) => vec![*number],
        Quantity::Factor(name) => parts.numbers(name),
    };
    let changes_k = match &pulses.change_k {
        Some(change_k) => levels(change_k),
        None => parts.staircases.iter().map(|staircase| staircase.initial.rule().most).collect(),
    };
    let standards_k = levels(&pulses.standard_k);
    let departures_k = standards_k.iter().flat_map(|standard_k| {
        let changed_k = changes_k.iter().map(|change_k| standard_k + pulses.sign * change_k);
        changed_k.chain([*standard_k]).collect::<Vec<_>>()
    });
    let (least, most) = setpoints_c();
    for departure_k in departures_k {
        let (reached_c, needed_s) =
            (pulses.base_c + departure_k, departure_k.abs() / pulses.rate_k_s);
        if !(least..=most).contains(&reached_c) {
            let problem =
                format!("{} reaches {reached_c:.2} C; allowed is {least} to {most} C", value.key);
            return Err(value.error(problem));
        }
        if needed_s > time_s {
            let problem = format!(
                "{} departs by {departure_k} K in {needed_s:.1} s; allowed is at most {time_s} s, the shorter of \
                 trial.interval_s and trial.gap_s",
                value.key
            );
            return Err(value.error(problem));
        }
    }
    Ok(())
}

/// The force that the participant follows, which a contact by force needs.
fn target_force(
    table: &Table<'_>,
    procedure: Procedure,
    parts: &Parts<'_>,
) -> Result<Option<Quantity>, SessionError> {
    let follows = matches!(procedure, Procedure::Touch { contact: ContactRule::Force, .. });
    let key = &TARGET_FORCE_N;
    match (follows, table.get(key.key)) {
        (false, None) => Ok(None),
        (false, Some(_)) => {
            table.without(&[key.key], "with trial.contact = \"force\"")?;
            Ok(None)
        }
        (true, _) => {
            let (least, most) = key.range;
            let allowed = format!("{least} to {most} or a factor");
            let given = table.need(key.key, &allowed)?;
            quantity(given, key.range, parts, &parts.all()).map(Some)
        }
    }
}

/// Whether a spreadsheet would compute a cell of this text; answers are cells of tables, and stay there as they are.
fn is_formula(text: &str) -> bool {
    match text.strip_prefix(['+', '-']) {
        Some(rest) => !rest.is_empty() && text.parse::<f64>().is_err(),
        None => text.starts_with(['=', '@']),
    }
}

type Words<'a> = Vec<(String, Value<'a>)>;

fn answer<'a>(
    table: &Table<'a>,
    parts: &Parts<'_>,
) -> Result<(Option<Answer>, Words<'a>), SessionError> {
    const NUMBERS: &str = "two numbers from -1000 to 1000, the smaller one first";
    const WORDS: &str = "2 to 10 different words";
    const NO_FORMULA: &str = "a word that no spreadsheet takes for a formula: without = or @ at its begin, and + or - there only as a sign alone or of a number";
    let Some(value) = table.get("answer") else {
        table.without(&["answer_s", "feedback"], "beside trial.answer")?;
        if let Some(staircase) = parts.staircase_at.first() {
            let problem = "a staircase follows answers; it is allowed beside trial.answer";
            return Err(staircase.error(problem));
        }
        return Ok((None, Vec::new()));
    };
    let answer = value.table(&ANSWER_KEYS)?;
    let ask = answer.need("ask", "the question")?.text(200)?;
    let (kind, words) = match (answer.get("one_of"), answer.get("number_per_station")) {
        (Some(list), None) => {
            let mut words: Words<'a> = Vec::new();
            for word in list.list(WORDS)? {
                let text = word.text(40)?;
                if is_formula(&text) {
                    return Err(word.wrong(NO_FORMULA));
                }
                if text.contains(is_control) || words.iter().any(|(known, _)| *known == text) {
                    return Err(word.wrong(WORDS));
                }
                words.push((text, word));
            }
            if !(2..=10).contains(&words.len()) {
                return Err(list.wrong(WORDS));
            }
            let texts = words.iter().map(|(word, _)| word.clone()).collect();
            (AnswerKind::OneOf(texts), words)
        }
        (None, Some(range)) => {
            let numbers = range.list(NUMBERS)?;
            let [least, most] = &numbers[..] else {
                return Err(range.wrong(NUMBERS));
            };
            let (least, most) = (least.number((-1000.0, 1000.0))?, most.number((-1000.0, 1000.0))?);
            if least >= most {
                return Err(range.wrong(NUMBERS));
            }
            (AnswerKind::NumberPerStation(least, most), Vec::new())
        }
        _ => {
            let problem = format!(
                "{} needs one of one_of and number_per_station; allowed is either",
                value.key
            );
            return Err(value.error(problem));
        }
    };
    Ok((Some(Answer { ask, kind }), words))
}

pub(super) fn voids<'a>(
    given: Option<&Value<'a>>,
    file: &Table<'a>,
    trial: &Trial<'_>,
    stations: &[Station],
    parts: &Parts<'_>,
) -> Result<VoidRules, SessionError> {
    let table = match given {
        Some(given) => given.table(&VOID_KEYS)?,
        None => file.empty("void"),
    };
    if !follows_force(&trial.rules) {
        table.without(&["force_off_target"], "with trial.contact = \"force\"")?;
    }
    if stations.len() < 2 {
        table.without(&["landings_apart_s"], "with two stations or more")?;
    }
    let optional =
        |key: &Number| (table.get(key.key)).map(|value| value.number(key.range)).transpose();
    let voids = VoidRules {
        display_off_preset_k: table.number(&DISPLAY_OFF_PRESET_K)?,
        force_max_n: table.number(&FORCE_MAX_N)?,
        contact_min_s: table.number(&CONTACT_MIN_S)?,
        force_off_target: optional(&FORCE_OFF_TARGET)?,
        landings_apart_s: optional(&LANDINGS_APART_S)?,
        attempts_max: table.whole(&ATTEMPTS_MAX)?,
    };
    let longest_s = match trial.rules.procedure {
        Procedure::Touch { max_s, .. } => max_s,
        Procedure::Intervals { .. } => f64::INFINITY,
    };
    if let (true, Some(value)) = (voids.contact_min_s > longest_s, table.get(CONTACT_MIN_S.key)) {
        return Err(value.wrong(format!("0 to trial.max_s = {longest_s}")));
    }
    let targets_n = match &trial.rules.target_force_n {
        None => Vec::new(),
        Some(Quantity::Fixed(target_n)) => vec![*target_n],
        Some(Quantity::Factor(factor)) => parts.numbers(factor),
    };
    let largest_n = targets_n.into_iter().fold(0.0, f64::max);
    if voids.force_max_n < largest_n {
        let problem = format!(
            "void.force_max_n = {}; allowed is at least the largest target force, {largest_n} N",
            voids.force_max_n
        );
        return Err(table
            .get(FORCE_MAX_N.key)
            .map_or_else(|| table.error(&*problem), |at| at.error(&*problem)));
    }
    Ok(voids)
}
