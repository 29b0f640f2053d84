//! What a session file says, checked: everything that the plan and the executor need.

use std::path::Path;

use contact_model::material::{self, Material};
use experiment_statistics::staircase::Staircase;
use serde::{Deserialize, Serialize};
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;

use crate::{Design, PlannedTrial, Present, Presented, SessionError, Stimulus, file};

/// A session, as its file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    /// Title, for people.
    pub title: String,
    /// Short name of the task, of letters and digits only, such as `p5`; it names the recorded files.
    pub task: String,
    /// Where the experiment comes from.
    pub cite: String,
    /// What the participant reads before the first trial.
    pub instruction: String,
    /// How displays are set up, and at which interval the device reports; `None`: no station presents a display or has a skin
    /// thermistor, and the session needs no device.
    pub device: Option<DeviceSetup>,
    /// Materials that this session describes, by name; [`Session::material`] finds them and the named ones.
    pub materials: Vec<(String, Material)>,
    /// Where the fingers go.
    pub stations: Vec<Station>,
    /// What the stations present.
    pub present: Present,
    /// What must hold before a trial.
    pub rest: Option<Rest>,
    /// How a trial proceeds.
    pub trial: TrialRules,
    /// What the participant is asked in each trial; `None` if nothing.
    pub answer: Option<Answer>,
    /// Which trials there are and in which order.
    pub design: Design,
    /// Staircases, whose trials the plan numbers.
    pub staircases: Vec<StaircaseRule>,
    /// Shortest break, s.
    pub break_s: f64,
    /// What makes a trial void.
    pub voids: VoidRules,
    /// How the session is scored.
    pub score: Score,
    /// The text of the file.
    pub text: String,
}

impl Session {
    /// Reads and checks a session file.
    ///
    /// # Errors
    /// What is wrong with it: file, line, problem, and what is allowed.
    pub fn read(path: &Path) -> Result<Self, SessionError> {
        file::read(path)
    }

    /// Checks the text of a session file; `path` names it in errors.
    ///
    /// # Errors
    /// What is wrong with it: file, line, problem, and what is allowed.
    pub fn parse(text: &str, path: &Path) -> Result<Self, SessionError> {
        file::parse(text, path)
    }

    /// Whether the file of another session says the same: only comments, spaces and line ends may differ.
    pub fn says_the_same_as(&self, other: &Self) -> bool {
        let read = Self { text: other.text.clone(), ..self.clone() };
        read == *other
    }

    /// The material of a name: one that the session describes, or one of [`material::MATERIALS`].
    pub fn material(&self, name: &str) -> Option<Material> {
        let described = self.materials.iter().find(|(known, _)| known == name);
        described.map(|(_, material)| *material).or_else(|| material::find(name).copied())
    }

    /// Whether the device has to be told the properties of a material, because it does not know its name.
    pub fn describes_material(&self, name: &str) -> bool {
        self.materials.iter().any(|(known, _)| known == name)
    }

    /// The fingers of the device that present something in this session, in ascending order.
    pub fn device_fingers(&self) -> Vec<u8> {
        let stimuli = self.present.cases.iter().flat_map(|case| &case.stations);
        ascending(stimuli.filter_map(Stimulus::device_finger))
    }

    /// The finger of the device whose skin thermistor measures at a station, by its index, that presents something: that of the
    /// key `skin_sensor`, otherwise that of the display.
    pub fn skin_sensor(&self, station: usize, presented: &Presented) -> Option<u8> {
        self.stations.get(station)?.skin_sensor_at(presented)
    }

    /// The fingers of the device whose skin thermistors measure in a trial, in ascending order.
    pub fn skin_sensors(&self, trial: &PlannedTrial) -> Vec<u8> {
        ascending(skin_sensors(&self.stations, &trial.presented))
    }

    /// The fingers of the device that report in a trial, in ascending order: those that present something, and those whose skin
    /// thermistors measure.
    pub fn reporting_fingers(&self, trial: &PlannedTrial) -> Vec<u8> {
        let displays = trial.presented.iter().filter_map(Presented::device_finger);
        ascending(displays.chain(self.skin_sensors(trial)))
    }

    /// Why the finger that the displays assume contradicts the place where fingers rest, in words; `None` if it does not, or no display
    /// renders an object with contact resistance. A finger loses heat to the air and not to a pad, which no sensor shows.
    pub fn contradiction_of_finger_and_rest(&self) -> Option<String> {
        let (device, rest) = (self.device.as_ref()?, self.rest?);
        let mut stimuli = self.present.cases.iter().flat_map(|case| &case.stations);
        let renders = device.mode == ContactModel::ContactResistance
            && stimuli.any(|stimulus| matches!(stimulus, Stimulus::Display { .. }));
        let (place, fitting) = match (rest.place, device.assumed_finger) {
            (RestPlace::Pad, AssumedFinger::Mean) => ("pad", AssumedFinger::MeanOnPad),
            (RestPlace::Air, AssumedFinger::MeanOnPad) => ("air", AssumedFinger::Mean),
            _ => return None,
        };
        renders.then(|| {
            format!(
                "rest.place = {place:?} contradicts device.assumed_finger = {:?}; without {:?} the skin is off by about 0.1 K",
                device.assumed_finger.name(),
                fitting.name()
            )
        })
    }

    /// Whether a display presents something, or a skin thermistor measures at a station that presents something. Otherwise the
    /// session needs no device, even if its file describes one.
    pub fn needs_device(&self) -> bool {
        let at_stations = |case: &crate::PresentCase| {
            let mut stations = self.stations.iter().zip(&case.stations);
            stations.any(|(station, stimulus)| {
                stimulus.device_finger().is_some()
                    || *stimulus != Stimulus::Nothing && station.skin_sensor.is_some()
            })
        };
        self.device.is_some() && self.present.cases.iter().any(at_stations)
    }

    /// Whether a skin thermistor measures at a station in any trial.
    pub fn measures_skin(&self) -> bool {
        let is_named = |station: &Station| station.skin_sensor.is_some();
        self.stations.iter().any(is_named) || !self.device_fingers().is_empty()
    }
}

impl Station {
    /// The finger of the device whose skin thermistor measures what the station presents: that of the key `skin_sensor`, otherwise
    /// that of the display. `None` where it presents nothing.
    fn skin_sensor_at(&self, presented: &Presented) -> Option<u8> {
        if *presented == Presented::Nothing {
            return None;
        }
        self.skin_sensor.or_else(|| presented.device_finger())
    }
}

/// The fingers of the device whose skin thermistors measure what stations present, in the order of the stations.
pub fn skin_sensors(stations: &[Station], presented: &[Presented]) -> impl Iterator<Item = u8> {
    let stations = stations.iter().zip(presented);
    stations.filter_map(|(station, presented)| station.skin_sensor_at(presented))
}

/// Each number once, in ascending order.
fn ascending(numbers: impl Iterator<Item = u8>) -> Vec<u8> {
    let mut numbers: Vec<u8> = numbers.collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// How the device is set up.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceSetup {
    /// Control law.
    pub law: Law,
    /// Contact model.
    pub mode: ContactModel,
    /// The finger that the device assumes.
    pub assumed_finger: AssumedFinger,
    /// Temperature of objects, °C; `None` for that of the room.
    pub object_c: Option<f64>,
    /// Skin that set-points assume, °C; `None` for that of the sensor.
    pub assumed_skin_c: Option<f64>,
    /// Interval of telemetry, ms.
    pub stream_ms: u32,
}

/// Where a finger goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Station {
    /// Its name, which answers and columns use.
    pub name: String,
    /// The participant's finger that goes there, in words.
    pub finger: String,
    /// The finger of the device whose skin thermistor is on that finger; `None` for that of the display.
    pub skin_sensor: Option<u8>,
}

/// Where the fingers rest before a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestPlace {
    /// On a pad of their own.
    Pad,
    /// On the display, which holds the temperature of the gate.
    Display,
    /// In the air.
    Air,
}

/// What must hold before a trial: the skin is at a temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Where the fingers rest.
    pub place: RestPlace,
    /// Temperature of the skin, °C.
    pub skin_c: f64,
    /// Largest distance of the mean over a second, K.
    pub within_k: f64,
    /// How long it must hold, s.
    pub for_s: f64,
    /// Time after which the operator is asked, s.
    pub timeout_s: f64,
}

/// How the participant touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactRule {
    /// As the participant likes, with lifting and touching again.
    Free,
    /// Once, until the tone.
    Hold,
    /// Once, following the target force of the trial.
    Force,
}

/// What happens in a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Procedure {
    /// The participant touches the stimuli after a tone.
    Touch {
        /// Time between the tone to move and the tone to touch, s.
        reach_s: f64,
        /// How the participant touches.
        contact: ContactRule,
        /// Longest contact, s; with [`ContactRule::Hold`] and [`ContactRule::Force`] its length.
        max_s: f64,
    },
    /// The fingers stay on the display, which departs from its base temperature in two intervals.
    Intervals {
        /// Length of an interval, s.
        interval_s: f64,
        /// Time between the intervals, s.
        gap_s: f64,
    },
}

/// How a trial proceeds.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialRules {
    /// What happens in it.
    pub procedure: Procedure,
    /// Longest time from the tone to the landing, s.
    pub land_s: f64,
    /// Longest time for an answer after the contact, s.
    pub answer_s: f64,
    /// Whether the participant is told whether the answer was correct.
    pub feedback: bool,
    /// Force to be followed with [`ContactRule::Force`], N.
    pub target_force_n: Option<Quantity>,
}

/// What the participant is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The question.
    pub ask: String,
    /// The answers that are allowed.
    pub kind: AnswerKind,
}

/// The answers that are allowed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AnswerKind {
    /// One of these words.
    OneOf(Vec<String>),
    /// A number from the first to the second for each station.
    NumberPerStation(f64, f64),
}

/// What makes a trial void.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoidRules {
    /// Largest distance of the display from its set-point at landing, K.
    pub display_off_preset_k: f64,
    /// Largest force, N.
    pub force_max_n: f64,
    /// Shortest contact, s.
    pub contact_min_s: f64,
    /// Largest relative distance of the mean force of the last two seconds from the target.
    pub force_off_target: Option<f64>,
    /// Largest time between the landings of two fingers on displays, s.
    pub landings_apart_s: Option<f64>,
    /// Most attempts at one trial.
    pub attempts_max: u32,
}

/// Which answer is correct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CorrectAnswer {
    /// None.
    None,
    /// The station where skin and material meet at the lowest temperature: that with the largest effusivity if the objects are
    /// colder than the skin, and with the smallest if they are warmer; none if they are equal.
    ColderStation,
    /// The level of this factor.
    Factor(String),
    /// `same` or `different`, by the materials of the stations.
    Same,
}

/// How a session is scored.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Which answer is correct.
    pub correct: CorrectAnswer,
    /// Proportion correct by chance.
    pub chance: Option<f64>,
    /// Proportion correct that counts as told apart.
    pub threshold: Option<f64>,
    /// Tables and tests of the analysis, by name; each is one of [`ANALYSES`].
    pub analyses: Vec<String>,
    /// The published table with which `chi-squared-against` compares; one of [`PUBLISHED_TABLES`].
    pub against: Option<String>,
}

/// Words for tables and tests of the analysis, each with what it needs of a session.
pub const ANALYSES: [(&str, &str); 21] = [
    ("pairs", "correct, and two materials in each trial"),
    ("pairs-by-mode", "correct, and a sample and a display in each trial"),
    ("identical-pairs", "correct = \"colder\""),
    ("confusion", "correct = { factor = … } whose levels are the answers"),
    ("information", "correct = { factor = … } whose levels are the answers"),
    ("oddity", "three stations, which are the answers and the levels of the correct factor"),
    ("same-different", "correct = \"same\""),
    ("falls", "contact = \"hold\" or \"force\""),
    ("exponential-fit", "contact = \"hold\" or \"force\""),
    ("levene", "contact = \"hold\" or \"force\""),
    ("pearson-with-model", "contact = \"hold\" or \"force\""),
    ("force-matching", "contact = \"force\""),
    ("anova-within", "a factor with two levels or more"),
    ("anova-split-plot", "two parts or more, and a factor with two levels or more"),
    ("tukey", "anova-within or anova-split-plot"),
    ("ancova", "pairs or confusion"),
    ("pearson-between-parts", "confusion or falls, and two parts or more"),
    ("chi-squared-against", "pairs or pairs-by-mode, and the key against"),
    ("staircase", "a staircase"),
    ("psychometric-fit", "correct, and pulses"),
    ("magnitudes", "an answer by number_per_station"),
];

/// Published tables with which the analysis can compare.
pub const PUBLISHED_TABLES: [&str; 1] = ["table-3-3"];

/// A number in the description of a stimulus.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// The same in all trials.
    Fixed(f64),
    /// The level of this factor.
    Factor(String),
}

/// A staircase, whose level follows the answers.
#[derive(Clone, Debug, PartialEq)]
pub struct StaircaseRule {
    /// Its name.
    pub name: String,
    /// The staircase before its first trial; its levels are K.
    pub initial: Staircase,
    /// Name of the part in which it runs.
    pub part: String,
    /// Levels of factors in its trials, by factor.
    pub levels: Vec<(String, String)>,
}
