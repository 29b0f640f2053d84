//! Which trials a session has: parts, factors, blocks, and what the stations present.

use crate::Quantity;

/// Which trials there are and in which order.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Parts, which run one after the other, with a break between them.
    pub parts: Vec<Part>,
}

impl Design {
    /// All factors of all parts in the order in which the file names them, each once.
    pub fn factor_names(&self) -> Vec<String> {
        let mut names = Vec::new();
        for name in self.parts.iter().flat_map(|part| &part.factor_names) {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        names
    }

    /// The part of a name.
    pub fn part(&self, name: &str) -> Option<&Part> {
        self.parts.iter().find(|part| part.name == name)
    }
}

/// A part of a session, with factors of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// What the participant reads before it.
    pub instruction: Option<String>,
    /// Names of all its factors, of whatever kind, in the order of the file.
    pub factor_names: Vec<String>,
    /// Factors with one level in this part.
    pub constants: Vec<(String, String)>,
    /// Pairs of levels, which are crossed with `factors`.
    pub pairs: Option<Pairs>,
    /// Factors whose levels are crossed: each combination occurs `repeat` times.
    pub factors: Vec<Factor>,
    /// Factors whose level is drawn in each trial.
    pub random: Vec<Factor>,
    /// Those of `random` whose levels occur equally often over the repetitions of a combination, or over the trials of a
    /// staircase.
    pub balance: Vec<String>,
    /// How often each combination occurs.
    pub repeat: u32,
    /// How the trials are divided into blocks, within each of which their order is random.
    pub blocks: Blocks,
    /// Factors with the most trials in sequence that may have the same level.
    pub max_run: Vec<(String, u32)>,
    /// Number of trials after which there is a break, 0 for none; `None`: between blocks.
    pub break_after: Option<u32>,
}

impl Part {
    /// All combinations of the levels of `constants`, `pairs` and `factors`, in the order of the file.
    pub fn combinations(&self) -> Vec<Vec<(&str, &str)>> {
        let constants = (self.constants.iter()).map(|(name, level)| (&**name, &**level));
        let mut combinations = vec![constants.collect::<Vec<_>>()];
        if let Some(pairs) = &self.pairs {
            let [first, second] = &pairs.into;
            combinations = crossed(&combinations, &pairs.combinations(), |[one, other]| {
                vec![(&**first, one), (&**second, other)]
            });
        }
        for factor in &self.factors {
            let levels: Vec<&str> = factor.levels.iter().map(String::as_str).collect();
            combinations = crossed(&combinations, &levels, |level| vec![(&*factor.name, level)]);
        }
        combinations
    }
}

/// Each combination with the pairs of factor and level that each of `levels` stands for.
fn crossed<'a, L: Copy>(
    combinations: &[Vec<(&'a str, &'a str)>],
    levels: &[L],
    of: impl Fn(L) -> Vec<(&'a str, &'a str)>,
) -> Vec<Vec<(&'a str, &'a str)>> {
    let with = |combination: &Vec<_>, level| [combination.clone(), of(level)].concat();
    let each = combinations.iter().flat_map(|combination| {
        let longer = levels.iter().map(|level| with(combination, *level));
        longer.collect::<Vec<_>>()
    });
    each.collect()
}

/// A factor and its levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Factor {
    /// Its name.
    pub name: String,
    /// Its levels, as the file writes them.
    pub levels: Vec<String>,
}

/// Pairs of levels, as the levels of two factors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pairs {
    /// The two factors.
    pub into: [String; 2],
    /// The levels of both.
    pub levels: Vec<String>,
    /// Whether A with B and B with A are two pairs.
    pub ordered: bool,
    /// Whether each level is paired with itself, too.
    pub identical: bool,
}

impl Pairs {
    /// The pairs in the order of the levels.
    pub fn combinations(&self) -> Vec<[&str; 2]> {
        let mut pairs = Vec::new();
        for (i, one) in self.levels.iter().enumerate() {
            for (j, other) in self.levels.iter().enumerate() {
                if (i == j && self.identical) || i < j || (i > j && self.ordered) {
                    pairs.push([&**one, &**other]);
                }
            }
        }
        pairs
    }
}

/// How the trials of a part are divided into blocks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Blocks {
    /// A block has each combination so many times.
    Repetitions(u32),
    /// A block has one level of a factor, and each combination of the others so many times. The levels alternate, in an
    /// order that is drawn for each participant.
    OneLevel {
        /// The factor.
        factor: String,
        /// How often a block has each combination.
        repetitions: u32,
    },
}

/// What the stations present.
#[derive(Clone, Debug, PartialEq)]
pub struct Present {
    /// The factor on whose level it depends; `None` if all trials present the same.
    pub by: Option<String>,
    /// What is presented for each level; one case without a level if it does not depend on any.
    pub cases: Vec<PresentCase>,
}

impl Present {
    /// What the stations present in a trial in which `level` tells the level of each factor.
    pub fn case(&self, level: impl Fn(&str) -> Option<String>) -> Option<&PresentCase> {
        let Some(by) = &self.by else {
            return self.cases.first();
        };
        let level = level(by)?;
        self.cases.iter().find(|case| case.level.as_ref() == Some(&level))
    }
}

/// What the stations present for a level of a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct PresentCase {
    /// The level; `None` if it does not depend on any.
    pub level: Option<String>,
    /// What each station presents, in the order of the stations.
    pub stations: Vec<Stimulus>,
}

/// What a station presents.
#[derive(Clone, Debug, PartialEq)]
pub enum Stimulus {
    /// Nothing: no finger goes there.
    Nothing,
    /// A sample at room temperature.
    Sample(MaterialOf),
    /// The display as an object.
    Display {
        /// Finger of the device, from 0.
        device_finger: u8,
        /// Material of the object.
        material: MaterialOf,
    },
    /// The display at a constant temperature.
    Hold {
        /// Finger of the device, from 0.
        device_finger: u8,
        /// Temperature, °C.
        celsius: Quantity,
    },
    /// The display at a base temperature, from which it departs in two intervals.
    Pulses(Pulses),
}

impl Stimulus {
    /// The finger of the device that presents it; `None` for nothing and for samples.
    pub const fn device_finger(&self) -> Option<u8> {
        match self {
            Self::Nothing | Self::Sample(_) => None,
            Self::Display { device_finger, .. }
            | Self::Hold { device_finger, .. }
            | Self::Pulses(Pulses { device_finger, .. }) => Some(*device_finger),
        }
    }

    /// The material that it presents.
    pub const fn material(&self) -> Option<&MaterialOf> {
        match self {
            Self::Sample(material) | Self::Display { material, .. } => Some(material),
            Self::Nothing | Self::Hold { .. } | Self::Pulses(_) => None,
        }
    }
}

/// Departures from a base temperature in two intervals: the standard in one of them, and the standard and a change in the
/// other.
#[derive(Clone, Debug, PartialEq)]
pub struct Pulses {
    /// Finger of the device, from 0.
    pub device_finger: u8,
    /// Temperature between the intervals, °C.
    pub base_c: f64,
    /// Departure in both intervals, K.
    pub standard_k: Quantity,
    /// -1 for a change to colder, 1 for one to warmer.
    pub sign: f64,
    /// Size of the change, K; `None` if a staircase decides it.
    pub change_k: Option<Quantity>,
    /// The factor whose level, `first` or `second`, is the interval with the change.
    pub changed: String,
    /// Rate of departure and return, K/s.
    pub rate_k_s: f64,
}

/// A material of a stimulus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MaterialOf {
    /// This one in all trials.
    Named(String),
    /// The one that is the level of this factor.
    Factor(String),
}
