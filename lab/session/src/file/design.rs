//! The tables `[design]`, `[[part]]` and `[[staircase]]`.

use experiment_statistics::staircase::{self, Staircase};

use super::setup::RESERVED;
use super::source::SessionError;
use super::value::{NAME, Number, Table, Value, Whole, is_name, listed};
use crate::{Blocks, Design, Factor, Pairs, Part, StaircaseRule, Station};

pub(super) const PART_KEYS: [&str; 9] = [
    "constants",
    "pairs",
    "factors",
    "random",
    "balance",
    "repeat",
    "blocks",
    "max_run",
    "break_after",
];
pub(super) const PAIRS_KEYS: [&str; 4] = ["of", "into", "ordered", "identical"];
pub(super) const BLOCKS_KEYS: [&str; 2] = ["by", "repetitions"];
pub(super) const REPEAT: Whole = Whole::new("repeat", 1, 1000, Some(1));
pub(super) const REPETITIONS: Whole = Whole::new("repetitions", 1, 1000, Some(1));
pub(super) const BREAK_AFTER: Whole = Whole::new("break_after", 0, 1000, None);
pub(super) const BREAK_S: Number = Number::new("break_s", 0.0, 3600.0, Some(60.0));
pub(super) const MAX_RUN: (u32, u32) = (1, 100);

pub(super) const STAIRCASE_KEYS: [&str; 10] = [
    "name",
    "part",
    "levels",
    "start_k",
    "max_k",
    "factor",
    "down",
    "reversals",
    "counted",
    "trials_max",
];
pub(super) const START_K: Number = Number::new("start_k", 0.001, 20.0, None);
pub(super) const MAX_K: Number = Number::new("max_k", 0.001, 20.0, None);
pub(super) const FACTOR: Number = Number::new("factor", 1.01, 10.0, Some(1.41));
pub(super) const DOWN: Whole = Whole::new("down", 1, 10, Some(2));
/// Smallest level, K: a course of the device has steps of 1 mK.
const LEAST_K: f64 = 1e-3;
pub(super) const REVERSALS: Whole = Whole::new("reversals", 2, 100, Some(8));
pub(super) const COUNTED: Whole = Whole::new("counted", 1, 100, Some(6));
pub(super) const TRIALS_MAX: Whole = Whole::new("trials_max", 2, 1000, Some(80));

/// Most trials of a session.
const TRIALS: usize = 10_000;
/// Most parts of a session.
const PARTS: usize = 100;
/// Most factors of a part.
const FACTORS: usize = 20;
/// The part of a file without `[[part]]`.
const ONLY_PART: &str = "main";

/// A factor of a part, with its places in the file.
pub(super) struct Levels<'a> {
    /// Index of its part.
    pub part: usize,
    pub name: String,
    pub levels: Vec<(String, Value<'a>)>,
}

/// The design, with what other tables check and point to in their errors.
pub(super) struct Parts<'a> {
    pub design: Design,
    pub staircases: Vec<StaircaseRule>,
    pub break_s: f64,
    pub factors: Vec<Levels<'a>>,
    /// The table of each staircase.
    pub staircase_at: Vec<Value<'a>>,
}

impl<'a> Parts<'a> {
    /// Indices of all parts.
    pub fn all(&self) -> Vec<usize> {
        (0..self.design.parts.len()).collect()
    }

    pub fn factor(&self, part: usize, name: &str) -> Option<&Levels<'a>> {
        let mut factors = self.factors.iter();
        factors.find(|factor| factor.part == part && factor.name == name)
    }

    /// The factors that all of these parts have, as errors list them.
    pub fn common(&self, parts: &[usize]) -> String {
        let mut names = self.design.factor_names();
        names.retain(|name| parts.iter().all(|part| self.factor(*part, name).is_some()));
        if names.is_empty() { "none".into() } else { listed(&names) }
    }

    /// The levels of a factor in all parts that are numbers.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        let factors = self.factors.iter().filter(|factor| factor.name == name);
        let levels = factors.flat_map(|factor| &factor.levels);
        levels.filter_map(|(level, _)| level.parse().ok()).collect()
    }
}

pub(super) fn design<'a>(
    file: &Table<'a>,
    stations: &[Station],
) -> Result<Parts<'a>, SessionError> {
    const LIST: &str = "a list of tables: [[part]]";
    let given = file.get("design");
    let single = [&PART_KEYS[..], &["break_s"]].concat();
    let table = match given {
        Some(value) => value.table(&single)?,
        None => file.empty("design"),
    };
    let mut reader = Reader { stations, factors: Vec::new() };
    let staircase_list = match file.get("staircase") {
        None => Vec::new(),
        Some(value) => value.list("a list of tables: [[staircase]]")?,
    };
    let mut parts = Vec::new();
    // Where an error of a part as a whole points to.
    let mut tables = Vec::new();
    match file.get("part") {
        None => {
            parts.push(reader.part(0, ONLY_PART.into(), &table)?);
            tables.push(table);
        }
        Some(list) => {
            table.without(&PART_KEYS, "in a [[part]], if the file has parts")?;
            let keys = [&["name", "instruction"], &PART_KEYS[..]].concat();
            for (index, value) in list.list(LIST)?.iter().enumerate() {
                if index == PARTS {
                    let problem = format!("more than {PARTS} parts; allowed is 1 to {PARTS}");
                    return Err(value.error(problem));
                }
                let part = value.table(&keys)?;
                let name_value = part.need("name", NAME)?;
                let name = name_value.name()?;
                if parts.iter().any(|other: &Part| other.name == name) {
                    return Err(name_value.wrong("a name that no other part has"));
                }
                let instruction = part.get("instruction").map(|text| text.text(super::TEXT_MAX));
                let read = Part {
                    instruction: instruction.transpose()?,
                    ..reader.part(index, name, &part)?
                };
                parts.push(read);
                tables.push(part);
            }
            if parts.is_empty() {
                return Err(list.wrong(LIST));
            }
        }
    }
    let (mut staircases, mut staircase_at) = (Vec::new(), Vec::new());
    for value in staircase_list {
        let staircase = reader.staircase(&value, &mut parts, &tables)?;
        let named = |other: &StaircaseRule| other.name == staircase.name;
        if staircases.iter().any(named) {
            let table = value.table(&STAIRCASE_KEYS)?;
            return Err(table.need("name", NAME)?.wrong("a name that no other staircase has"));
        }
        staircases.push(staircase);
        staircase_at.push(value);
    }
    let count = |part: &Part| {
        let stairs = staircases.iter().filter(|staircase| staircase.part == part.name);
        let of_stairs: usize =
            stairs.map(|staircase| staircase.initial.rule().trials_max as usize).sum();
        if of_stairs > 0 {
            of_stairs
        } else {
            combinations(part).saturating_mul(part.repeat as usize)
        }
    };
    let mut trials = 0_usize;
    for (part, table) in parts.iter().zip(&tables) {
        trials = trials.saturating_add(count(part));
        if trials > TRIALS {
            let problem = format!("more than {TRIALS} trials; allowed is 1 to {TRIALS}");
            return Err(table.error(problem));
        }
    }
    let break_s = match given {
        Some(value) => value.table(&single)?.number(&BREAK_S)?,
        None => file.empty("design").number(&BREAK_S)?,
    };
    let parts = Parts {
        design: Design { parts },
        staircases,
        break_s,
        factors: reader.factors,
        staircase_at,
    };
    same_factors(&parts)?;
    balanced(&parts, &tables)?;
    Ok(parts)
}

/// How many combinations a part has, without making them.
fn combinations(part: &Part) -> usize {
    let pairs = part.pairs.as_ref().map_or(1, |pairs| pairs.combinations().len());
    let levels = part.factors.iter().map(|factor| factor.levels.len());
    levels.fold(pairs, usize::saturating_mul)
}

/// The levels of a balanced factor occur equally often only if the number of trials is a multiple of theirs.
fn balanced(parts: &Parts<'_>, tables: &[Table<'_>]) -> Result<(), SessionError> {
    for (part, table) in parts.design.parts.iter().zip(tables) {
        let names = |factor: &&Factor| part.balance.contains(&factor.name);
        for factor in part.random.iter().filter(names) {
            let count = factor.levels.len();
            let problem = |key: String, given: u32| {
                format!(
                    "{key} = {given} with {:?} in balance; allowed is a multiple of its {count} levels",
                    factor.name
                )
            };
            let of_part = |(staircase, _): &(&StaircaseRule, _)| staircase.part == part.name;
            let staircases = parts.staircases.iter().zip(&parts.staircase_at);
            let mut staircases = staircases.filter(of_part).peekable();
            let repeats = staircases.peek().is_none();
            if repeats && !(part.repeat as usize).is_multiple_of(count) {
                let problem = problem(table.key(REPEAT.key), part.repeat);
                let at = table.get(REPEAT.key).or(table.get("balance"));
                return Err(at.map_or_else(|| table.error(&*problem), |at| at.error(&*problem)));
            }
            for (staircase, at) in staircases {
                if !(staircase.initial.rule().trials_max as usize).is_multiple_of(count) {
                    let table = at.table(&STAIRCASE_KEYS)?;
                    let key = table.key(TRIALS_MAX.key);
                    let at = table.get(TRIALS_MAX.key).unwrap_or(at);
                    return Err(at.error(problem(key, staircase.initial.rule().trials_max)));
                }
            }
        }
    }
    Ok(())
}

/// All staircases of a part must tell the levels of the same factors.
fn same_factors(parts: &Parts<'_>) -> Result<(), SessionError> {
    for (index, (staircase, at)) in parts.staircases.iter().zip(&parts.staircase_at).enumerate() {
        let names = |staircase: &StaircaseRule| {
            let mut names: Vec<_> = staircase.levels.iter().map(|(name, _)| name.clone()).collect();
            names.sort();
            names
        };
        let before =
            (parts.staircases.iter().take(index)).find(|other| other.part == staircase.part);
        if let Some(other) = before
            && names(other) != names(staircase)
        {
            let problem = format!(
                "staircase.levels has the factors {:?}; allowed are those of the staircase {:?} in the same part: {:?}",
                names(staircase),
                other.name,
                names(other)
            );
            return Err(at.error(problem));
        }
    }
    Ok(())
}

struct Reader<'a, 's> {
    stations: &'s [Station],
    factors: Vec<Levels<'a>>,
}

impl<'a> Reader<'a, '_> {
    /// Adds a factor to a part.
    fn add(
        &mut self,
        part: usize,
        name: &str,
        at: &Value<'a>,
        levels: Vec<(String, Value<'a>)>,
    ) -> Result<(), SessionError> {
        let error = |allowed: String| {
            at.error(format!("{}: {name:?} is a factor; allowed is {allowed}", at.key))
        };
        if !is_name(name) || RESERVED.contains(&name) {
            return Err(error(format!("as a name {NAME}, and none of {}", listed(&RESERVED))));
        }
        let is_of_station = |station: &Station| {
            name.strip_prefix(&*station.name)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
        };
        if let Some(station) = self.stations.iter().find(|station| is_of_station(station)) {
            return Err(error(format!(
                "a name that is not that of the station {0:?} and does not begin with \"{0}_\", as that station's columns do",
                station.name
            )));
        }
        if self.factors.iter().any(|factor| factor.part == part && factor.name == name) {
            return Err(error("each factor once in a part".into()));
        }
        if self.factors.iter().filter(|factor| factor.part == part).count() == FACTORS {
            return Err(error(format!("0 to {FACTORS} factors in a part")));
        }
        self.factors.push(Levels { part, name: name.into(), levels });
        Ok(())
    }

    /// A table of factors with their levels.
    fn factors(&mut self, part: usize, value: &Value<'a>) -> Result<Vec<Factor>, SessionError> {
        let table = value.any_table("a table of factors with lists of levels")?;
        let mut factors = Vec::new();
        for (name, list) in &table.values {
            let levels = levels(list)?;
            factors.push(Factor { name: (*name).into(), levels: texts(&levels) });
            self.add(part, name, list, levels)?;
        }
        Ok(factors)
    }

    fn part(
        &mut self,
        index: usize,
        name: String,
        table: &Table<'a>,
    ) -> Result<Part, SessionError> {
        let mut part = Part {
            name,
            instruction: None,
            factor_names: Vec::new(),
            constants: Vec::new(),
            pairs: None,
            factors: Vec::new(),
            random: Vec::new(),
            balance: Vec::new(),
            repeat: table.whole(&REPEAT)?,
            blocks: Blocks::Repetitions(1),
            max_run: Vec::new(),
            break_after: table
                .get(BREAK_AFTER.key)
                .map(|_| table.whole(&BREAK_AFTER))
                .transpose()?,
        };
        // In the order of the file, which is that of the columns.
        for (key, value) in &table.values {
            match *key {
                "constants" => {
                    let constants = value.any_table("a table of factors with a level each")?;
                    for (name, value) in &constants.values {
                        let level = value.level()?;
                        part.constants.push(((*name).into(), level.clone()));
                        self.add(index, name, value, vec![(level, value.clone())])?;
                    }
                }
                "pairs" => part.pairs = Some(self.pairs(index, value)?),
                "factors" => part.factors = self.factors(index, value)?,
                "random" => part.random = self.factors(index, value)?,
                _ => {}
            }
        }
        let factors = self.factors.iter().filter(|factor| factor.part == index);
        part.factor_names = factors.map(|factor| factor.name.clone()).collect();
        part.balance = balance(table, &part)?;
        part.blocks = blocks(table, &part)?;
        if let Some(value) = table.get("max_run") {
            let runs = value.any_table("a table of factors with a whole number each")?;
            for (name, value) in &runs.values {
                if !part.factor_names.iter().any(|known| known == name) {
                    let problem = format!(
                        "{}: {name:?} is no factor; allowed are {}",
                        value.key,
                        listed(&part.factor_names)
                    );
                    return Err(value.error(problem));
                }
                let (least, most) = MAX_RUN;
                let key = Whole::new("", least, most, None);
                part.max_run.push(((*name).into(), value.whole(&key)?));
            }
        }
        Ok(part)
    }

    fn pairs(&mut self, part: usize, value: &Value<'a>) -> Result<Pairs, SessionError> {
        const INTO: &str = "a list of two names of factors";
        let table = value.table(&PAIRS_KEYS)?;
        let levels = levels(table.need("of", LEVELS)?)?;
        let into = table.need("into", INTO)?;
        let names = into.list(INTO)?;
        let [first, second] = &names[..] else {
            return Err(into.wrong(INTO));
        };
        let into = [first.name()?, second.name()?];
        let ordered = table.boolean_or("ordered", false)?;
        let identical = table.boolean_or("identical", !ordered)?;
        if let (true, true, Some(value)) = (ordered, identical, table.get("identical")) {
            return Err(value.wrong(
                "false with ordered = true; all pairs of two factors are their combinations: use factors",
            ));
        }
        self.add(part, &into[0], first, levels.clone())?;
        self.add(part, &into[1], second, levels.clone())?;
        Ok(Pairs { into, levels: texts(&levels), ordered, identical })
    }

    fn staircase(
        &mut self,
        value: &Value<'a>,
        parts: &mut [Part],
        tables: &[Table<'a>],
    ) -> Result<StaircaseRule, SessionError> {
        let table = value.table(&STAIRCASE_KEYS)?;
        let names = parts.iter().map(|part| part.name.clone()).collect::<Vec<_>>();
        let wanted = table.get("part").map(Value::name).transpose()?;
        let index = match (&wanted, parts.len()) {
            (None, 1) => Some(0),
            (None, _) => None,
            (Some(wanted), _) => names.iter().position(|name| name == wanted),
        };
        let (Some(index), allowed) = (index, listed(&names)) else {
            let at = table.get("part").unwrap_or(value);
            return Err(at.error(format!(
                "staircase.part must name a part; allowed are {}",
                listed(&names)
            )));
        };
        let (Some(part), Some(of_part)) = (parts.get_mut(index), tables.get(index)) else {
            return Err(
                value.error(format!("staircase.part must name a part; allowed are {allowed}"))
            );
        };
        let of_orders = ["pairs", "factors", "repeat", "blocks", "max_run"];
        of_part.without(&of_orders, "in a part without staircases; their levels tell factors")?;
        let (start_k, max_k) = (table.number(&START_K)?, table.number(&MAX_K)?);
        let (reversals, counted) = (table.whole(&REVERSALS)?, table.whole(&COUNTED)?);
        let at = |key: &str| table.get(key).unwrap_or(value);
        if start_k > max_k {
            return Err(at("start_k").wrong(format!("at most max_k = {max_k}")));
        }
        if counted > reversals {
            return Err(at("counted").wrong(format!("at most reversals = {reversals}")));
        }
        let factor = table.number(&FACTOR)?;
        let initial = Staircase::new(staircase::StaircaseRule {
            start: start_k,
            least: LEAST_K,
            most: max_k,
            correct_to_fall: table.whole(&DOWN)?,
            factor,
            coarse_factor: factor,
            coarse_reversals: 0,
            reversals: reversals as usize,
            averaged: counted as usize,
            trials_max: table.whole(&TRIALS_MAX)?,
        })
        .map_err(|error| value.error(error.to_string()))?;
        let mut rule = StaircaseRule {
            name: table.need("name", NAME)?.name()?,
            initial,
            part: part.name.clone(),
            levels: Vec::new(),
        };
        if let Some(levels) = table.get("levels") {
            for (name, value) in levels.any_table("a table of factors with a level each")?.values {
                let level = value.level()?;
                rule.levels.push((name.into(), level.clone()));
                let of_part = part.factor_names.iter().any(|known| known == name);
                let mut known = self.factors.iter_mut();
                let known = known.find(|factor| factor.part == index && factor.name == name);
                match known {
                    // A factor that another staircase has, too.
                    Some(factor)
                        if part.random.iter().all(|random| random.name != name)
                            && part.constants.iter().all(|(constant, _)| constant != name) =>
                    {
                        factor.levels.push((level, value));
                    }
                    _ => self.add(index, name, &value.clone(), vec![(level, value)])?,
                }
                if !of_part {
                    part.factor_names.push(name.into());
                }
            }
        }
        Ok(rule)
    }
}

const LEVELS: &str = "a list of 2 to 100 different levels: words or numbers";

/// A list of levels.
fn levels<'a>(list: &Value<'a>) -> Result<Vec<(String, Value<'a>)>, SessionError> {
    let values = list.list(LEVELS)?;
    if !(2..=100).contains(&values.len()) {
        return Err(list.wrong(LEVELS));
    }
    let mut levels: Vec<(String, Value<'a>)> = Vec::new();
    for value in values {
        let level = value.level()?;
        let number = level.parse::<f64>().ok();
        let same = |(known, _): &(String, Value<'a>)| {
            *known == level || (number.is_some() && known.parse().ok() == number)
        };
        if levels.iter().any(same) {
            return Err(value.wrong(format!("each level once in {}", list.key)));
        }
        levels.push((level, value));
    }
    Ok(levels)
}

fn texts(levels: &[(String, Value<'_>)]) -> Vec<String> {
    levels.iter().map(|(level, _)| level.clone()).collect()
}

/// The factors that are balanced.
fn balance(table: &Table<'_>, part: &Part) -> Result<Vec<String>, SessionError> {
    let Some(list) = table.get("balance") else {
        return Ok(Vec::new());
    };
    let names: Vec<_> = part.random.iter().map(|factor| &*factor.name).collect();
    let allowed = format!("a list of factors of random: {}", listed(&names));
    let mut balance: Vec<String> = Vec::new();
    for value in list.list(&allowed)? {
        let name = value.string(&allowed)?;
        if !names.contains(&name) {
            return Err(value.wrong(allowed));
        }
        if !balance.iter().any(|known| known == name) {
            balance.push(name.into());
        }
    }
    Ok(balance)
}

fn blocks(table: &Table<'_>, part: &Part) -> Result<Blocks, SessionError> {
    const ALLOWED: &str = "\"repetition\", \"none\" or a table with the keys by, repetitions";
    let Some(value) = table.get("blocks") else {
        return Ok(Blocks::Repetitions(1));
    };
    if !value.is_table() {
        let words = [("repetition", 1), ("none", part.repeat)];
        let repetitions = value.word(&words).map_err(|_| value.wrong(ALLOWED))?;
        return Ok(Blocks::Repetitions(repetitions));
    }
    let blocks = value.table(&BLOCKS_KEYS)?;
    let repetitions = blocks.whole(&REPETITIONS)?;
    if !part.repeat.is_multiple_of(repetitions) {
        let at = blocks.get(REPETITIONS.key).unwrap_or(value);
        return Err(at.wrong(format!("a divisor of {} = {}", table.key("repeat"), part.repeat)));
    }
    let Some(by) = blocks.get("by") else {
        return Ok(Blocks::Repetitions(repetitions));
    };
    let names: Vec<_> = part.factors.iter().map(|factor| &*factor.name).collect();
    let allowed = format!("a factor of factors: {}", listed(&names));
    let name = by.string(&allowed)?;
    if !names.contains(&name) {
        return Err(by.wrong(allowed));
    }
    Ok(Blocks::OneLevel { factor: name.into(), repetitions })
}
