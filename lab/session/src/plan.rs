//! The trials of a session in their order: a pure function of session file, participant and seed.

use std::collections::HashMap;

use contact_model::material::SKIN;
use serde::{Deserialize, Serialize};

use crate::random::Stream;
use crate::{
    Blocks, CorrectAnswer, MaterialOf, Part, Pulses, Quantity, Session, StaircaseRule, Stimulus,
};

/// Most random orders of a block that are tried.
const ATTEMPTS: u32 = 10_000;

/// Skin, unless the session waits for another one, and room, °C, by which the colder of two stations is found.
const SKIN_C: f64 = 33.0;
const ROOM_C: f64 = 24.0;

/// All trials of a session for one participant.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Names of the factors, in the order of [`PlannedTrial::levels`].
    pub factors: Vec<String>,
    /// Names of the stations, in the order of [`PlannedTrial::presented`].
    pub stations: Vec<String>,
    /// Names of the staircases.
    pub staircases: Vec<String>,
    /// The trials in their order.
    pub trials: Vec<PlannedTrial>,
}

/// A trial of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlannedTrial {
    /// Its number, from 1.
    pub number: u32,
    /// Name of its part of the session.
    pub part: String,
    /// Number of its block, from 1 through the whole session.
    pub block: u32,
    /// Whether a break comes before it.
    pub break_before: bool,
    /// Level of each factor, as the session file writes it; empty if a staircase decides it or the part does not have it.
    pub levels: Vec<String>,
    /// What each station presents, in the order of the stations.
    pub presented: Vec<Presented>,
    /// Index of the staircase that decides the level; the trial is left out when that has finished.
    pub staircase: Option<usize>,
    /// Force to be followed, N.
    pub target_force_n: Option<f64>,
    /// The correct answer, if there is one.
    pub correct: Option<String>,
}

/// What a station presents in a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Presented {
    /// Nothing: no finger goes there.
    Nothing,
    /// A sample of a material, at room temperature.
    Sample {
        /// Name of the material.
        material: String,
    },
    /// The display, as an object of a material.
    Material {
        /// Finger of the device, from 0.
        device_finger: u8,
        /// Name of the material.
        material: String,
    },
    /// The display at a constant temperature.
    Hold {
        /// Finger of the device, from 0.
        device_finger: u8,
        /// Temperature, °C.
        celsius: f64,
    },
    /// The display at a base temperature, from which it departs in one of two intervals or in both.
    Pulses {
        /// Finger of the device, from 0.
        device_finger: u8,
        /// Temperature between the intervals, °C.
        base_c: f64,
        /// Departure in each interval, K.
        departures_k: [Departure; 2],
        /// Rate of departure and return, K/s.
        rate_k_s: f64,
    },
}

impl Presented {
    /// Its cell in [`Plan::csv`].
    fn cell(&self) -> String {
        match self {
            Self::Nothing => "nothing".into(),
            Self::Sample { material } => format!("sample {material}"),
            Self::Material { device_finger, material } => {
                format!("display {device_finger} {material}")
            }
            Self::Hold { device_finger, celsius } => format!("hold {device_finger} {celsius}"),
            Self::Pulses { device_finger, base_c, departures_k, rate_k_s } => {
                let [first, second] = departures_k.map(Departure::word);
                format!("pulses {device_finger} {base_c} {first} {second} {rate_k_s}")
            }
        }
    }
}

/// Departure from the base temperature in an interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Departure {
    /// This one, K.
    Fixed(f64),
    /// This one plus the level of the staircase times its sign, K: `Staircase { standard_k, sign }`.
    Staircase {
        /// Departure at level 0, K.
        standard_k: f64,
        /// -1 for cooling, 1 for warming.
        sign: f64,
    },
}

impl Departure {
    /// Its word in [`Plan::csv`]: `x` is the level of the staircase.
    fn word(self) -> String {
        match self {
            Self::Fixed(departure_k) => departure_k.to_string(),
            Self::Staircase { standard_k, sign } if sign < 0.0 => format!("{standard_k}-x"),
            Self::Staircase { standard_k, .. } => format!("{standard_k}+x"),
        }
    }
}

impl Plan {
    /// The trials for a participant, a code of letters and digits, and a seed.
    ///
    /// # Errors
    /// A code that may be a name, or a constraint of the session that no order of the trials fulfils.
    pub fn new(session: &Session, participant: &str, seed: u64) -> Result<Self, PlanError> {
        check_participant(participant)?;
        let factors = session.design.factor_names();
        let mut plan = Self {
            stations: session.stations.iter().map(|station| station.name.clone()).collect(),
            staircases: session.staircases.iter().map(|staircase| staircase.name.clone()).collect(),
            factors,
            trials: Vec::new(),
        };
        let mut block = 0;
        for part in &session.design.parts {
            let planner = Planner {
                session,
                part,
                seed,
                streams: format!("{}/{participant}/{}", session.task, part.name),
            };
            let before = plan.trials.len();
            for (number, drafts) in planner.blocks()?.into_iter().enumerate() {
                for (index, draft) in drafts.into_iter().enumerate() {
                    let in_part = plan.trials.len() - before;
                    let break_before = match part.break_after {
                        _ if plan.trials.is_empty() => false,
                        _ if in_part == 0 => true,
                        None => index == 0,
                        Some(0) => false,
                        Some(after) => in_part.is_multiple_of(after as usize),
                    };
                    let at = Place {
                        number: plan.trials.len() as u32 + 1,
                        block: block + number as u32 + 1,
                        break_before,
                    };
                    plan.trials.push(planner.trial(&plan.factors, draft, &at));
                }
            }
            block = plan.trials.last().map_or(block, |trial| trial.block);
        }
        Ok(plan)
    }

    /// The level of a factor in a trial; `None` if there is no such factor.
    pub fn level<'a>(&self, trial: &'a PlannedTrial, factor: &str) -> Option<&'a str> {
        let index = self.factors.iter().position(|name| name == factor)?;
        trial.levels.get(index).map(String::as_str)
    }

    /// The plan as a table with a row for each trial. After trial, part, block and break there is a column for each factor, then
    /// one for what each station presents; the last are force to be followed (N), staircase and correct answer. What a trial
    /// does not have is empty.
    pub fn csv(&self) -> String {
        let lists = [&self.factors[..], &self.stations[..]].concat();
        let mut csv = String::from("trial,part,block,break_before");
        for name in lists {
            csv += &format!(",{name}");
        }
        csv += ",target_force_n,staircase,correct\n";
        for trial in &self.trials {
            csv += &trial.row(&self.staircases);
        }
        csv
    }
}

impl PlannedTrial {
    /// Its row in [`Plan::csv`]. No name and no level has a comma.
    fn row(&self, staircases: &[String]) -> String {
        let mut row =
            format!("{},{},{},{}", self.number, self.part, self.block, u8::from(self.break_before));
        let presented = self.presented.iter().map(Presented::cell);
        let force_n = self.target_force_n.map(|force_n| force_n.to_string());
        let staircase = self.staircase.and_then(|index| staircases.get(index));
        let last = [force_n, staircase.cloned(), self.correct.clone()];
        let cells = self.levels.iter().cloned().chain(presented);
        for cell in cells.chain(last.map(Option::unwrap_or_default)) {
            row += ",";
            row += &cell;
        }
        row + "\n"
    }
}

/// Reports a participant that is no code.
///
/// # Errors
/// It is not of 1 to 20 letters and digits, or has no digit.
pub fn check_participant(code: &str) -> Result<(), PlanError> {
    let known = code.chars().all(|c| c.is_ascii_alphanumeric());
    let has_digit = code.contains(|c: char| c.is_ascii_digit());
    if known && has_digit && code.len() <= 20 {
        return Ok(());
    }
    Err(PlanError::Participant { code: code.into() })
}

/// A trial whose order is to be drawn: the level of each factor, and its staircase.
#[derive(Clone)]
struct Draft {
    levels: HashMap<String, String>,
    staircase: Option<usize>,
}

/// Where a trial stands in the plan.
struct Place {
    number: u32,
    block: u32,
    break_before: bool,
}

/// Plans a part.
struct Planner<'s> {
    session: &'s Session,
    part: &'s Part,
    seed: u64,
    /// Beginning of the purpose of its random streams.
    streams: String,
}

impl Planner<'_> {
    fn stream(&self, purpose: &str) -> Stream {
        Stream::new(self.seed, &format!("{}/{purpose}", self.streams))
    }

    /// The trials of each block in their order.
    fn blocks(&self) -> Result<Vec<Vec<Draft>>, PlanError> {
        let staircases: Vec<_> = (self.session.staircases.iter().enumerate())
            .filter(|(_, staircase)| staircase.part == self.part.name)
            .collect();
        if !staircases.is_empty() {
            return Ok(vec![self.interleaved(&staircases)]);
        }
        let mut blocks = self.divided();
        let mut before: Vec<Draft> = Vec::new();
        for (number, block) in blocks.iter_mut().enumerate() {
            let mut stream = self.stream(&format!("order of block {}", number + 1));
            self.order(&mut stream, &before, block)?;
            before.extend(block.iter().cloned());
        }
        Ok(blocks)
    }

    /// Rounds with one trial of each staircase that has trials left, in random order, so that all proceed together.
    fn interleaved(&self, staircases: &[(usize, &StaircaseRule)]) -> Vec<Draft> {
        let groups: Vec<_> = (staircases.iter())
            .map(|(_, staircase)| {
                let constants = &self.part.constants;
                let levels = constants.iter().chain(&staircase.levels).cloned().collect();
                (levels, staircase.initial.rule().trials_max as usize)
            })
            .collect();
        let mut drawn = self.repeated(&groups);
        for ((index, _), drafts) in staircases.iter().zip(&mut drawn) {
            for draft in drafts {
                draft.staircase = Some(*index);
            }
        }
        let rounds = drawn.iter().map(Vec::len).max().unwrap_or_default();
        let mut stream = self.stream("order of staircases");
        let round = |round: usize| {
            let mut trials: Vec<_> =
                drawn.iter().filter_map(|drafts| drafts.get(round).cloned()).collect();
            stream.shuffle(&mut trials);
            trials
        };
        (0..rounds).flat_map(round).collect()
    }

    /// The trials of each combination, with the levels of random factors drawn.
    fn repeated(&self, groups: &[(HashMap<String, String>, usize)]) -> Vec<Vec<Draft>> {
        let draft =
            |levels: &HashMap<String, String>| Draft { levels: levels.clone(), staircase: None };
        let mut drafts: Vec<Vec<_>> =
            (groups.iter()).map(|(levels, count)| vec![draft(levels); *count]).collect();
        for factor in &self.part.random {
            let mut stream = self.stream(&format!("levels of {}", factor.name));
            let balanced = self.part.balance.contains(&factor.name);
            for trials in &mut drafts {
                // Each level equally often over the trials of the combination, in random order.
                let mut order: Vec<usize> =
                    (0..trials.len()).map(|i| i % factor.levels.len()).collect();
                stream.shuffle(&mut order);
                for (trial, equal) in trials.iter_mut().zip(order) {
                    let index = if balanced { equal } else { stream.below(factor.levels.len()) };
                    if let Some(level) = factor.levels.get(index) {
                        trial.levels.insert(factor.name.clone(), level.clone());
                    }
                }
            }
        }
        drafts
    }

    /// The trials of each block, before their order is drawn.
    fn divided(&self) -> Vec<Vec<Draft>> {
        let owned = |combination: Vec<(&str, &str)>| -> HashMap<String, String> {
            combination.into_iter().map(|(name, level)| (name.into(), level.into())).collect()
        };
        let groups: Vec<_> = (self.part.combinations().into_iter())
            .map(|combination| (owned(combination), self.part.repeat as usize))
            .collect();
        let drafts = self.repeated(&groups);
        let (repetitions, levels, name) = match &self.part.blocks {
            Blocks::Repetitions(repetitions) => (*repetitions as usize, vec![None], ""),
            Blocks::OneLevel { factor, repetitions } => {
                let of_factor = self.part.factors.iter().find(|known| known.name == *factor);
                let levels = of_factor.map(|factor| &factor.levels[..]).unwrap_or_default();
                let mut levels: Vec<_> = levels.iter().map(Some).collect();
                self.stream(&format!("first {factor}")).shuffle(&mut levels);
                (*repetitions as usize, levels, &**factor)
            }
        };
        let mut blocks = Vec::new();
        for first in (0..self.part.repeat as usize).step_by(repetitions.max(1)) {
            for level in &levels {
                let of_level = |drafts: &&Vec<Draft>| {
                    level.is_none_or(|level| {
                        drafts.first().is_some_and(|draft| draft.levels.get(name) == Some(level))
                    })
                };
                let of_block = drafts.iter().filter(of_level);
                let trials =
                    of_block.flat_map(|drafts| drafts.iter().skip(first).take(repetitions));
                blocks.push(trials.cloned().collect());
            }
        }
        blocks
    }

    /// Draws the order of a block until it fulfils the constraints, with the trials before it.
    fn order(
        &self,
        stream: &mut Stream,
        before: &[Draft],
        block: &mut [Draft],
    ) -> Result<(), PlanError> {
        let constraints = &self.part.max_run;
        let mut failures = vec![0_u32; constraints.len()];
        // Only a run that reaches into this block can still become too long.
        let most = constraints.iter().map(|(_, most)| *most as usize).max();
        let tail = before.len().saturating_sub(most.unwrap_or_default());
        let before = before.get(tail..).unwrap_or_default();
        // Indices are drawn into an order, and levels are looked up once, because there may be many attempts.
        let drafts = block.to_vec();
        let levels: Vec<[Vec<Option<&String>>; 2]> = (constraints.iter())
            .map(|(factor, _)| {
                [before, &drafts].map(|trials| {
                    let levels = trials.iter().map(|draft| draft.levels.get(factor));
                    levels.collect()
                })
            })
            .collect();
        let mut order: Vec<usize> = (0..drafts.len()).collect();
        // The constraint that was broken last is looked at first: one that no order fulfils is soon given up.
        let mut last_broken = 0;
        for _ in 0..ATTEMPTS {
            stream.shuffle(&mut order);
            let is_broken = |index: &usize| {
                let known = constraints.get(*index).zip(levels.get(*index));
                known.is_some_and(|((_, most), [before, own])| {
                    let own = order.iter().filter_map(|index| own.get(*index));
                    has_run_above(before.iter().chain(own), *most)
                })
            };
            let mut last_broken_first = (last_broken..constraints.len()).chain(0..last_broken);
            let broken = last_broken_first.find(is_broken);
            last_broken = broken.unwrap_or_default();
            match broken.and_then(|index| failures.get_mut(index)) {
                None => {
                    for (place, index) in block.iter_mut().zip(order) {
                        place.clone_from(&drafts[index]);
                    }
                    return Ok(());
                }
                Some(failures) => *failures += 1,
            }
        }
        let constraint = constraints.iter().zip(&failures).max_by_key(|(_, failures)| **failures);
        let (factor, most) = constraint.map(|(worst, _)| worst.clone()).unwrap_or_default();
        Err(PlanError::Order {
            constraint: format!("max_run.{factor} = {most} of the part {:?}", self.part.name),
            attempts: ATTEMPTS,
        })
    }

    /// The trial of a draft.
    fn trial(&self, factors: &[String], draft: Draft, at: &Place) -> PlannedTrial {
        let level = |name: &str| draft.levels.get(name).cloned();
        let case = self.session.present.case(level);
        let stimuli = case.map(|case| &case.stations[..]).unwrap_or_default();
        let presented: Vec<_> =
            stimuli.iter().map(|stimulus| self.presented(stimulus, &draft)).collect();
        PlannedTrial {
            number: at.number,
            part: self.part.name.clone(),
            block: at.block,
            break_before: at.break_before,
            levels: factors.iter().map(|name| level(name).unwrap_or_default()).collect(),
            correct: self.correct(&presented, &draft),
            presented,
            staircase: draft.staircase,
            target_force_n: (self.session.trial.target_force_n.as_ref())
                .map(|force_n| number(force_n, &draft)),
        }
    }

    fn presented(&self, stimulus: &Stimulus, draft: &Draft) -> Presented {
        let name = |material: &MaterialOf| match material {
            MaterialOf::Named(name) => name.clone(),
            MaterialOf::Factor(factor) => draft.levels.get(factor).cloned().unwrap_or_default(),
        };
        match stimulus {
            Stimulus::Nothing => Presented::Nothing,
            Stimulus::Sample(material) => Presented::Sample { material: name(material) },
            Stimulus::Display { device_finger, material } => {
                Presented::Material { device_finger: *device_finger, material: name(material) }
            }
            Stimulus::Hold { device_finger, celsius } => {
                Presented::Hold { device_finger: *device_finger, celsius: number(celsius, draft) }
            }
            Stimulus::Pulses(pulses) => presented_pulses(pulses, draft),
        }
    }

    /// Temperature at which skin and a presented material meet, °C: that of two half-spaces in contact, by which the material with
    /// the larger effusivity is the colder one only as long as it is colder than the skin.
    fn contact_c(&self, presented: &Presented) -> Option<f64> {
        let device_c = || self.session.device.as_ref().and_then(|device| device.object_c);
        let (material, object_c) = match presented {
            Presented::Sample { material } => (material, ROOM_C),
            Presented::Material { material, .. } => (material, device_c().unwrap_or(ROOM_C)),
            Presented::Nothing | Presented::Hold { .. } | Presented::Pulses { .. } => return None,
        };
        let skin_c = self.session.rest.map_or(SKIN_C, |rest| rest.skin_c);
        let (object, skin) = (self.session.material(material)?.effusivity(), SKIN.effusivity());
        Some(skin_c + (object_c - skin_c) * object / (object + skin))
    }

    /// The correct answer; `None` if there is none, as with equal materials.
    fn correct(&self, presented: &[Presented], draft: &Draft) -> Option<String> {
        let materials = || {
            let stations = self.session.stations.iter().zip(presented);
            stations.filter_map(|(station, presented)| match presented {
                Presented::Sample { material } | Presented::Material { material, .. } => {
                    Some((&station.name, material))
                }
                _ => None,
            })
        };
        match &self.session.score.correct {
            CorrectAnswer::None => None,
            CorrectAnswer::Factor(factor) => draft.levels.get(factor).cloned(),
            CorrectAnswer::Same => {
                let (_, first) = materials().next()?;
                let same = materials().all(|(_, material)| material == first);
                Some(if same { "same" } else { "different" }.into())
            }
            CorrectAnswer::ColderStation => {
                let stations = self.session.stations.iter().zip(presented);
                let mut by_temperature: Vec<_> = stations
                    .filter_map(|(station, presented)| {
                        Some((self.contact_c(presented)?, &station.name))
                    })
                    .collect();
                by_temperature.sort_by(|(one, _), (other, _)| one.total_cmp(other));
                match by_temperature[..] {
                    [(first, _), (second, _), ..] if first >= second => None,
                    [(_, station), ..] => Some(station.clone()),
                    [] => None,
                }
            }
        }
    }
}

fn presented_pulses(pulses: &Pulses, draft: &Draft) -> Presented {
    let standard_k = number(&pulses.standard_k, draft);
    let changed = match &pulses.change_k {
        Some(change_k) => Departure::Fixed(standard_k + pulses.sign * number(change_k, draft)),
        None => Departure::Staircase { standard_k, sign: pulses.sign },
    };
    let standard = Departure::Fixed(standard_k);
    let is_second = draft.levels.get(&pulses.changed).is_some_and(|level| level == "second");
    Presented::Pulses {
        device_finger: pulses.device_finger,
        base_c: pulses.base_c,
        departures_k: if is_second { [standard, changed] } else { [changed, standard] },
        rate_k_s: pulses.rate_k_s,
    }
}

/// A number of a stimulus. That the level of its factor is one, the reader has checked.
fn number(quantity: &Quantity, draft: &Draft) -> f64 {
    match quantity {
        Quantity::Fixed(number) => *number,
        Quantity::Factor(factor) => {
            let level = draft.levels.get(factor).and_then(|level| level.parse().ok());
            level.unwrap_or(f64::NAN)
        }
    }
}

/// Whether more levels in sequence than these are the same.
fn has_run_above<L: PartialEq>(levels: impl Iterator<Item = L>, most: u32) -> bool {
    let (mut run, mut last) = (0, None);
    for level in levels {
        run = if last.as_ref() == Some(&level) { run + 1 } else { 1 };
        if run > most {
            return true;
        }
        last = Some(level);
    }
    false
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// The participant is no code.
    #[error(
        "participant {code:?}; allowed is a code of 1 to 20 letters and digits, a digit among them, such as P01: no name is recorded"
    )]
    Participant {
        /// What was given.
        code: String,
    },
    /// No order of the trials was found that fulfils a constraint.
    #[error("no order of the trials fulfils {constraint} in {attempts} attempts")]
    Order {
        /// The constraint by its key in the session file.
        constraint: String,
        /// Number of random orders that were tried.
        attempts: u32,
    },
}
