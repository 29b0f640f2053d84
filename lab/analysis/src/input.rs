//! What the analyses see of recorded sessions: the trials that count, with their factors and materials.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use contact_model::material::{self, Material};
use experiment_statistics::staircase::Staircase;
use thermal_session::dataset::{RecordedSession, SessionInfo};
use thermal_session::record::{StationRecord, TrialRecord};
use thermal_session::{AnswerKind, Departure, Presented, Session};

/// The sessions of one task that have the same session file.
#[derive(Clone, Debug)]
pub struct Task {
    pub name: String,
    /// The name; with a number where session files of the task differ.
    pub label: String,
    /// That session files of the task differ, and who has which.
    pub differs: Option<String>,
    /// That simulated participants were left out, or are pooled with real ones.
    pub mixed: Option<String>,
    /// That the data set was recorded with different versions of program or firmware, and who with which.
    pub versions: Vec<String>,
    pub title: String,
    pub cite: String,
    pub question: Option<String>,
    /// The answers that are allowed, if they are words.
    pub answers: Vec<String>,
    pub chance: Option<f64>,
    pub threshold: Option<f64>,
    /// Words of the session file.
    pub analyses: Vec<String>,
    pub stations: Vec<String>,
    pub factors: Vec<String>,
    /// Levels of the factors in the plans, each once.
    pub planned_levels: Vec<(String, String)>,
    pub staircases: Vec<(String, Staircase)>,
    pub materials: BTreeMap<String, Material>,
    pub participants: Vec<Participant>,
}

/// The session of one participant.
#[derive(Clone, Debug)]
pub struct Participant {
    pub code: String,
    pub is_simulated: bool,
    /// Number of trials of the plan.
    pub planned: usize,
    /// All records, void ones among them.
    pub records: Vec<TrialRecord>,
    /// The trials that count.
    pub trials: Vec<Trial>,
    pub telemetry: PathBuf,
    /// What in its files is not as it was recorded.
    pub remarks: Vec<String>,
}

/// A trial that counts.
#[derive(Clone, Debug)]
pub struct Trial {
    pub record: TrialRecord,
    /// Level of each factor, without those that the trial does not have.
    pub levels: Vec<(String, String)>,
    pub staircase: Option<usize>,
    pub presented: Vec<Presented>,
    /// The finger of the device whose skin thermistor was at each station.
    pub skin_sensors: Vec<Option<u8>>,
}

/// A material at a station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stimulus<'a> {
    pub station: usize,
    pub material: &'a str,
    /// On the display; otherwise a sample.
    pub is_simulated: bool,
}

/// What is done with simulated participants where there are real ones of the same task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simulated {
    /// They are left out.
    Apart,
    /// They are analysed together with the real ones.
    Pooled,
}

/// The tasks of a data set, by name. Where session files of a task differ, each makes a task of its own; comments do not count.
pub fn tasks(sessions: &[&RecordedSession], simulated: Simulated) -> Vec<Task> {
    let mut tasks: Vec<(&Session, Task)> = Vec::new();
    let is_mixed = |task: &str| {
        let own = || sessions.iter().filter(|one| one.session.task == task);
        own().any(|one| one.info.has_simulated_part())
            && own().any(|one| !one.info.has_simulated_part())
    };
    for &recorded in sessions {
        let is_left_out = simulated == Simulated::Apart && recorded.info.has_simulated_part();
        if is_left_out && is_mixed(&recorded.session.task) {
            continue;
        }
        let session = &recorded.session;
        let known = tasks.iter().position(|(known, _)| known.says_the_same_as(session));
        let at = known.unwrap_or_else(|| {
            tasks.push((session, task(session)));
            tasks.len() - 1
        });
        if let Some((_, task)) = tasks.get_mut(at) {
            task.add(recorded);
        }
    }
    let mut tasks: Vec<Task> = tasks.into_iter().map(|(_, task)| task).collect();
    tasks.sort_by(|one, other| one.name.cmp(&other.name));
    for same in tasks.chunk_by_mut(|one, other| one.name == other.name) {
        tell_apart(same);
        let name = same[0].name.clone();
        let mixed = is_mixed(&name).then(|| mixed(sessions, &name, simulated));
        for task in same {
            task.mixed.clone_from(&mixed);
        }
    }
    let versions = versions(sessions);
    for task in &mut tasks {
        task.versions.clone_from(&versions);
    }
    tasks
}

/// A sentence for program and for firmware, if sessions of a data set differ in it.
fn versions(sessions: &[&RecordedSession]) -> Vec<String> {
    let programs = mixed_versions("thermal-lab", sessions, |info| info.programs().collect());
    let firmware = mixed_versions("firmware", sessions, |info| info.firmware().collect());
    programs.into_iter().chain(firmware).collect()
}

fn mixed_versions(
    what: &str,
    sessions: &[&RecordedSession],
    versions: impl Fn(&SessionInfo) -> Vec<String>,
) -> Option<String> {
    let mut who: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for info in sessions.iter().map(|session| &session.info) {
        for version in versions(info) {
            who.entry(version).or_default().insert(format!("{} ({})", info.participant, info.task));
        }
    }
    let of_each = who.iter().map(|(version, sessions)| {
        let sessions: Vec<_> = sessions.iter().map(String::as_str).collect();
        format!("{version}: {}", sessions.join(", "))
    });
    let of_each: Vec<_> = of_each.collect();
    (who.len() > 1).then(|| {
        format!(
            "The data set was recorded with {} versions of {what}. {}.",
            who.len(),
            of_each.join("; ")
        )
    })
}

/// What was done with the simulated participants of a task that has real ones, too.
fn mixed(sessions: &[&RecordedSession], task: &str, simulated: Simulated) -> String {
    let own =
        sessions.iter().filter(|one| one.session.task == task && one.info.has_simulated_part());
    let codes: Vec<_> = own.map(|one| &*one.info.participant).collect();
    let (count, codes) = (codes.len(), codes.join(", "));
    match simulated {
        Simulated::Apart => format!(
            "{count} simulated participant(s) were left out ({codes}), because this task has real ones; \
             --pool-simulated analyses them together."
        ),
        Simulated::Pooled => format!(
            "Real participants and {count} simulated one(s) ({codes}) are analysed together, as was asked for."
        ),
    }
}

/// Labels the tasks of one name, and says why there are several.
fn tell_apart(same: &mut [Task]) {
    if same.len() < 2 {
        return;
    }
    for (number, task) in (1..).zip(&mut *same) {
        task.label = format!("{}-{number}", task.name);
    }
    let of_each = same.iter().map(|task| {
        let codes: Vec<_> = task.participants.iter().map(|one| &*one.code).collect();
        format!("{} has {}", task.label, codes.join(", "))
    });
    let of_each: Vec<_> = of_each.collect();
    let sentence = format!(
        "Session files of this task differ, so its sessions are analysed apart: {}.",
        of_each.join("; ")
    );
    for task in same {
        task.differs = Some(sentence.clone());
    }
}

fn task(session: &Session) -> Task {
    let answers = match session.answer.as_ref().map(|answer| &answer.kind) {
        Some(AnswerKind::OneOf(words)) => words.clone(),
        _ => Vec::new(),
    };
    let staircases = session.staircases.iter();
    Task {
        name: session.task.clone(),
        label: session.task.clone(),
        differs: None,
        mixed: None,
        versions: Vec::new(),
        title: session.title.clone(),
        cite: session.cite.clone(),
        question: session.answer.as_ref().map(|answer| answer.ask.clone()),
        answers,
        chance: session.score.chance,
        threshold: session.score.threshold,
        analyses: session.score.analyses.clone(),
        stations: session.stations.iter().map(|station| station.name.clone()).collect(),
        factors: Vec::new(),
        planned_levels: Vec::new(),
        staircases: staircases.map(|named| (named.name.clone(), named.initial.clone())).collect(),
        materials: BTreeMap::new(),
        participants: Vec::new(),
    }
}

fn participant(recorded: &RecordedSession) -> Participant {
    let planned: BTreeMap<u32, _> =
        recorded.plan.trials.iter().map(|trial| (trial.number, trial)).collect();
    let trial = |record: &TrialRecord| {
        let plan = planned.get(&record.trial);
        let levels = recorded.plan.factors.iter().zip(&record.levels);
        let presented = plan.map_or(Vec::new(), |plan| plan.presented.clone());
        let stations = presented.iter().enumerate();
        Trial {
            levels: levels
                .filter(|(_, level)| !level.is_empty())
                .map(|(factor, level)| (factor.clone(), level.clone()))
                .collect(),
            staircase: plan.and_then(|plan| plan.staircase),
            skin_sensors: stations
                .map(|(station, presented)| recorded.session.skin_sensor(station, presented))
                .collect(),
            presented,
            record: record.clone(),
        }
    };
    Participant {
        code: recorded.info.participant.clone(),
        is_simulated: recorded.info.has_simulated_part(),
        planned: recorded.plan.trials.len(),
        records: recorded.records.clone(),
        trials: recorded.counted().map(trial).collect(),
        telemetry: recorded.telemetry_path(),
        remarks: recorded.remarks.clone(),
    }
}

impl Task {
    fn add(&mut self, recorded: &RecordedSession) {
        for factor in &recorded.plan.factors {
            if !self.factors.contains(factor) {
                self.factors.push(factor.clone());
            }
        }
        for planned in &recorded.plan.trials {
            for level in recorded.plan.factors.iter().cloned().zip(planned.levels.iter().cloned()) {
                if !level.1.is_empty() && !self.planned_levels.contains(&level) {
                    self.planned_levels.push(level);
                }
            }
        }
        let participant = participant(recorded);
        for name in participant.trials.iter().flat_map(Trial::materials) {
            // A material that the session describes itself is not among the named ones.
            let known = material::find(name).copied();
            if let Some(found) = known.or_else(|| recorded.session.material(name)) {
                self.materials.insert(name.into(), found);
            }
        }
        self.participants.push(participant);
    }

    /// All trials that count, with the number of their participant.
    pub fn trials(&self) -> impl Iterator<Item = (usize, &Trial)> {
        let numbered = self.participants.iter().enumerate();
        numbered.flat_map(|(number, one)| one.trials.iter().map(move |trial| (number, trial)))
    }

    /// Participants with their numbers of something, such as `(P01: 2, P03: 1)`, from a participant for each of it.
    pub fn shares(&self, participants: &[usize]) -> String {
        let of_each = self.participants.iter().enumerate().filter_map(|(number, one)| {
            let count = participants.iter().filter(|other| **other == number).count();
            (count > 0).then(|| format!("{}: {count}", one.code))
        });
        format!("({})", of_each.collect::<Vec<_>>().join(", "))
    }

    pub fn asks_for(&self, word: &str) -> bool {
        self.analyses.iter().any(|asked| asked == word)
    }

    /// Contact coefficient of a material, J/(m² s^½ K).
    pub fn effusivity(&self, material: &str) -> Option<f64> {
        let effusivity = self.materials.get(material)?.effusivity();
        effusivity.is_finite().then_some(effusivity)
    }

    /// Names of the parts in the order in which they first occur.
    pub fn parts(&self) -> Vec<&str> {
        crate::cells::distinct(self.trials().map(|(_, trial)| trial.record.part.as_str()))
    }

    /// Materials by falling contact coefficient, those of unknown properties last.
    pub fn sorted<'a>(&self, materials: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
        let mut sorted = crate::cells::distinct(materials);
        sorted.sort_by(|one, other| {
            let of = |name: &str| self.effusivity(name).unwrap_or(0.0);
            of(other).total_cmp(&of(one)).then_with(|| one.cmp(other))
        });
        sorted
    }
}

impl Trial {
    /// Materials at the stations.
    pub fn stimuli(&self) -> impl Iterator<Item = Stimulus<'_>> {
        let numbered = self.presented.iter().enumerate();
        numbered.filter_map(|(station, presented)| {
            let (material, is_simulated) = match presented {
                Presented::Sample { material } => (material, false),
                Presented::Material { material, .. } => (material, true),
                _ => return None,
            };
            Some(Stimulus { station, material, is_simulated })
        })
    }

    fn materials(&self) -> impl Iterator<Item = &str> {
        self.stimuli().map(|stimulus| stimulus.material)
    }

    pub fn station(&self, index: usize) -> Option<&StationRecord> {
        self.record.stations.get(index)
    }

    /// Time from the first landing to the answer, s.
    pub fn response_s(&self) -> Option<f64> {
        let (answer_s, land_s) = self.record.answer_s.zip(self.record.land_s)?;
        finite(answer_s - land_s)
    }

    /// By how much the departures of the two intervals differ, K.
    pub fn change_k(&self) -> Option<f64> {
        let of_staircase = self.record.staircase_level_k;
        let of_pulses = self.presented.iter().find_map(|presented| match presented {
            Presented::Pulses {
                departures_k: [Departure::Fixed(first), Departure::Fixed(second)],
                ..
            } => Some((first - second).abs()),
            _ => None,
        });
        of_staircase.or(of_pulses).and_then(finite)
    }

    /// Levels of all factors as one text.
    pub fn condition(&self, without: &[&str]) -> String {
        let levels = self.levels.iter().filter(|(factor, _)| !without.contains(&factor.as_str()));
        let levels: Vec<_> = levels.map(|(factor, level)| format!("{factor} {level}")).collect();
        levels.join(", ")
    }
}

/// The value, if it is a number.
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
