//! Sessions made by hand: a participant who senses the logarithm of the contact coefficient with noise.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use contact_model::material::MATERIALS;
use experiment_statistics::distribution::normal_quantile;
use experiment_statistics::staircase::{Staircase, StaircaseRule};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_session::record::{StationRecord, TrialRecord};
use thermal_session::{Departure, Presented};

use crate::input::{Participant, Task, Trial};

/// A task without participants.
pub fn task(name: &str, stations: &[&str], answers: &[&str], analyses: &[&str]) -> Task {
    let owned = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    Task {
        name: name.into(),
        label: name.into(),
        differs: None,
        mixed: None,
        versions: Vec::new(),
        title: format!("Experiment {name}"),
        cite: "a test".into(),
        question: Some("Which one?".into()),
        answers: owned(answers),
        chance: (!answers.is_empty()).then(|| 1.0 / answers.len() as f64),
        threshold: None,
        analyses: owned(analyses),
        stations: owned(stations),
        factors: Vec::new(),
        planned_levels: Vec::new(),
        staircases: Vec::new(),
        materials: MATERIALS
            .iter()
            .map(|(name, material)| ((*name).to_owned(), *material))
            .collect::<BTreeMap<_, _>>(),
        participants: Vec::new(),
    }
}

/// A participant who did these trials.
pub fn participant(code: &str, trials: Vec<Trial>) -> Participant {
    Participant {
        code: code.into(),
        is_simulated: true,
        planned: trials.len(),
        records: trials.iter().map(|trial| trial.record.clone()).collect(),
        trials,
        telemetry: PathBuf::new(),
        remarks: Vec::new(),
    }
}

pub fn sample(material: &str) -> Presented {
    Presented::Sample { material: material.into() }
}

pub fn display(device_finger: u8, material: &str) -> Presented {
    Presented::Material { device_finger, material: material.into() }
}

/// A trial that presents something and is answered.
pub fn trial(
    number: u32,
    part: &str,
    presented: Vec<Presented>,
    answer: &str,
    expected: Option<&str>,
) -> Trial {
    let begin_s = 30.0 * f64::from(number);
    Trial {
        record: TrialRecord {
            trial: number,
            attempt: 1,
            part: part.into(),
            block: 1,
            begin_s,
            land_s: Some(begin_s + 5.0),
            lift_s: Some(begin_s + 15.0),
            answer_s: Some(begin_s + 9.0),
            end_s: begin_s + 20.0,
            contact_s: Some(10.0),
            touches: 1,
            answer: Some(answer.into()),
            expected: expected.map(Into::into),
            is_correct: expected.map(|expected| expected == answer),
            room_c: Some(24.0),
            stations: presented
                .iter()
                .map(|presented| StationRecord {
                    presented: presented.to_string(),
                    ..StationRecord::default()
                })
                .collect(),
            ..TrialRecord::default()
        },
        levels: Vec::new(),
        staircase: None,
        skin_sensors: presented.iter().map(Presented::device_finger).collect(),
        presented,
    }
}

/// Random numbers of the tests.
pub struct Noise(Xoshiro256PlusPlus);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    pub fn normal(&mut self) -> f64 {
        normal_quantile(self.0.random_range(1e-9..1.0 - 1e-9)).unwrap_or(0.0)
    }

    pub fn index(&mut self, count: usize) -> usize {
        self.0.random_range(0..count)
    }

    /// What a finger on a material senses.
    fn coldness(&mut self, material: &str, noise: f64) -> f64 {
        let effusivity =
            contact_model::material::find(material).map_or(1.0, |found| found.effusivity());
        effusivity.log10() + noise * self.normal()
    }
}

fn largest(values: &[f64]) -> usize {
    let numbered = values.iter().enumerate();
    numbered.max_by(|one, other| one.1.total_cmp(other.1)).map_or(0, |(index, _)| index)
}

fn effusivity(material: &str) -> f64 {
    contact_model::material::find(material).map_or(0.0, |found| found.effusivity())
}

const SIDES: [&str; 2] = ["left", "right"];
pub const FIVE: [&str; 5] = ["copper", "stainless-steel", "granite", "abs", "foam"];

/// P1 (all pairs of six real materials) with this many participants.
pub fn discrimination(participants: usize, noise: f64) -> Task {
    let mut task =
        task("p1", &SIDES, &SIDES, &["pairs", "identical-pairs", "anova-within", "tukey"]);
    task.threshold = Some(0.72);
    let six = ["copper", "bronze", "stainless-steel", "g10", "abs", "foam"];
    for person in 0..participants {
        let mut random = Noise::new(person as u64);
        let mut trials = Vec::new();
        for _ in 0..4 {
            for (i, one) in six.iter().enumerate() {
                for other in &six[i..] {
                    let pair = if random.index(2) == 0 { [one, other] } else { [other, one] };
                    trials.push(colder(
                        &mut random,
                        trials.len(),
                        pair.map(|name| sample(name)),
                        noise,
                    ));
                }
            }
        }
        task.participants.push(participant(&format!("P{person:02}"), trials));
    }
    task
}

/// A trial in which the colder side is to be named.
fn colder(random: &mut Noise, index: usize, presented: [Presented; 2], noise: f64) -> Trial {
    let materials = presented.clone().map(|one| match one {
        Presented::Sample { material } | Presented::Material { material, .. } => material,
        _ => String::new(),
    });
    let sensed = [0, 1].map(|side| random.coldness(&materials[side], noise));
    let truth = [0, 1].map(|side: usize| effusivity(&materials[side]));
    let expected = (truth[0] != truth[1]).then(|| SIDES[largest(&truth)]);
    trial(index as u32 + 1, "main", presented.into(), SIDES[largest(&sensed)], expected)
}

/// P5 (four real against four simulated materials).
pub fn real_and_simulated(participants: usize, noise: f64) -> Task {
    let words =
        ["pairs-by-mode", "identical-pairs", "anova-within", "tukey", "chi-squared-against"];
    let mut task = task("p5", &SIDES, &SIDES, &words);
    task.threshold = Some(0.72);
    for person in 0..participants {
        let mut random = Noise::new(100 + person as u64);
        let mut trials = Vec::new();
        for _ in 0..4 {
            for real in &FIVE[..4] {
                for simulated in &FIVE[..4] {
                    let pair = [sample(real), display(0, simulated)];
                    let pair = if random.index(2) == 0 {
                        pair
                    } else {
                        [pair[1].clone(), pair[0].clone()]
                    };
                    let mut trial = colder(&mut random, trials.len(), pair, noise);
                    trial.levels = vec![
                        ("real".into(), (*real).into()),
                        ("simulated".into(), (*simulated).into()),
                    ];
                    trials.push(trial);
                }
            }
        }
        let mut person = participant(&format!("P{person:02}"), trials);
        let mut void = person.records[3].clone();
        void.void = Some("the display was 0.62 K from its set-point at the landing".into());
        person.records.insert(3, void);
        task.participants.push(person);
    }
    task.factors = vec!["real".into(), "simulated".into()];
    task
}

/// P3 (the different one of three).
pub fn localisation(participants: usize, noise: f64) -> Task {
    let fingers = ["index", "middle", "ring"];
    let mut task = task("p3", &fingers, &fingers, &["pairs", "oddity", "anova-within", "tukey"]);
    for person in 0..participants {
        let mut random = Noise::new(200 + person as u64);
        let mut trials = Vec::new();
        for repetition in 0..9 {
            for target in FIVE {
                for distractor in FIVE.into_iter().filter(|one| *one != target) {
                    let place = repetition % 3;
                    let at = |finger| if finger == place { target } else { distractor };
                    let sensed = [0, 1, 2].map(|finger| random.coldness(at(finger), noise));
                    let mean = sensed.iter().sum::<f64>() / 3.0;
                    let odd = largest(&sensed.map(|one| (one - mean).abs()));
                    let presented =
                        (0..3).map(|finger| display(finger as u8, at(finger))).collect();
                    let number = trials.len() as u32 + 1;
                    trials.push(trial(
                        number,
                        "main",
                        presented,
                        fingers[odd],
                        Some(fingers[place]),
                    ));
                }
            }
        }
        task.participants.push(participant(&format!("P{person:02}"), trials));
    }
    task
}

/// P4 (identification, real then simulated).
pub fn identification(participants: usize, noise: f64) -> Task {
    let words = [
        "confusion",
        "information",
        "anova-within",
        "anova-split-plot",
        "tukey",
        "pearson-between-parts",
    ];
    let mut task = task("p4", &["index"], &FIVE, &words);
    for person in 0..participants {
        let mut random = Noise::new(300 + person as u64);
        let mut trials = Vec::new();
        for (part, repetitions) in [("real", 3), ("simulated", 9)] {
            for repetition in 0..repetitions {
                for material in FIVE {
                    let sensed = random.coldness(material, noise);
                    let distances = FIVE.map(|other| -(effusivity(other).log10() - sensed).abs());
                    let presented =
                        if part == "real" { sample(material) } else { display(0, material) };
                    let answer = FIVE[largest(&distances)];
                    let mut trial = trial(
                        trials.len() as u32 + 1,
                        part,
                        vec![presented],
                        answer,
                        Some(material),
                    );
                    trial.record.block = if part == "real" { 1 } else { 2 + repetition / 3 };
                    trials.push(trial);
                }
            }
        }
        task.participants.push(participant(&format!("P{person:02}"), trials));
    }
    task
}

/// P6 (falls of the skin), with telemetry in a folder.
pub fn falls(participants: usize, folder: &Path) -> Task {
    let words = [
        "falls",
        "levene",
        "exponential-fit",
        "pearson-with-model",
        "anova-within",
        "anova-split-plot",
        "tukey",
        "pearson-between-parts",
    ];
    let mut task = task("p6", &["index"], &[], &words);
    task.question = None;
    for person in 0..participants {
        let mut random = Noise::new(400 + person as u64);
        let own = 1.0 + 0.1 * random.normal();
        let mut trials = Vec::new();
        let mut telemetry = String::from("t_s,finger,skin_c,force_n\n");
        for (part, slow) in [("real", 0.9), ("simulated", 1.4)] {
            for _ in 0..3 {
                for (material, fall_k) in FIVE.into_iter().zip([2.6, 2.4, 2.1, 1.2, 0.4]) {
                    let fall_k = fall_k * own * (1.0 + 0.15 * random.normal());
                    let number = trials.len() as u32 + 1;
                    let presented =
                        if part == "real" { sample(material) } else { display(0, material) };
                    let mut trial = trial(number, part, vec![presented], "", None);
                    trial.skin_sensors = vec![Some(0)];
                    trial.record.answer = None;
                    let land_s = trial.record.land_s.unwrap_or(0.0);
                    trial.record.stations[0] = StationRecord {
                        land_s: Some(land_s),
                        skin_before_c: Some(34.5),
                        skin_fall_k: Some(fall_k),
                        force_mean_n: Some(1.5),
                        ..StationRecord::default()
                    };
                    for step in 0..200 {
                        let t_s = 0.05 * f64::from(step);
                        let skin_c = 34.5 - fall_k * (1.0 - (-t_s / slow).exp());
                        let _ = writeln!(telemetry, "{:.4},0,{skin_c:.4},1.5", land_s + t_s);
                    }
                    trials.push(trial);
                }
            }
        }
        telemetry.push_str("torn li");
        let mut own = participant(&format!("P{person:02}"), trials);
        own.telemetry = folder.join(format!("{}-{}.csv", task.name, own.code));
        std::fs::write(&own.telemetry, telemetry).expect("a folder of the test");
        task.participants.push(own);
    }
    task
}

/// P8 (force matching), with telemetry in a folder.
pub fn forces(participants: usize, folder: &Path) -> Task {
    let words = ["force-matching", "falls", "anova-within", "tukey", "pearson-with-model"];
    let mut task = task("p8", &["index"], &[], &words);
    task.question = None;
    for person in 0..participants {
        let mut random = Noise::new(500 + person as u64);
        let mut trials = Vec::new();
        let mut telemetry = String::from("t_s,finger,skin_c,force_n\n");
        for _ in 0..6 {
            for material in ["baf2", "zns"] {
                for target_n in [0.1, 0.25, 0.5, 1.0, 2.0] {
                    let number = trials.len() as u32 + 1;
                    let mut trial = trial(number, "main", vec![display(0, material)], "", None);
                    trial.record.answer = None;
                    trial.record.target_force_n = Some(target_n);
                    let land_s = trial.record.land_s.unwrap_or(0.0);
                    let tau_s = 0.3 + 0.4 * target_n;
                    let end_n = target_n * (1.0 + 0.02 * random.normal());
                    for step in 0..200 {
                        let t_s = 0.05 * f64::from(step);
                        let force_n = end_n * (1.0 - (-t_s / tau_s).exp()) + 0.01 * random.normal();
                        let _ = writeln!(telemetry, "{:.4},0,33,{force_n:.4}", land_s + t_s);
                    }
                    trial.record.stations[0] = StationRecord {
                        land_s: Some(land_s),
                        skin_before_c: Some(34.6),
                        skin_fall_k: Some(3.0 + target_n.ln() * 0.5 + 0.3 * random.normal()),
                        force_mean_n: Some(end_n),
                        force_end_mean_n: Some(end_n),
                        force_end_sd_n: Some(0.01),
                        force_error_rms_n: Some((end_n - target_n).hypot(0.01)),
                        force_settled_s: (random.index(10) > 0).then_some(2.3 * tau_s),
                        ..StationRecord::default()
                    };
                    trials.push(trial);
                }
            }
        }
        let mut own = participant(&format!("P{person:02}"), trials);
        own.telemetry = folder.join(format!("{}-{}.csv", task.name, own.code));
        std::fs::write(&own.telemetry, telemetry).expect("a folder of the test");
        task.participants.push(own);
    }
    task
}

/// The rule of P9.
pub fn rule() -> StaircaseRule {
    StaircaseRule {
        start: 1.0,
        least: 0.01,
        most: 4.0,
        correct_to_fall: 2,
        factor: 1.41,
        coarse_factor: 1.41,
        coarse_reversals: 0,
        reversals: 8,
        averaged: 6,
        trials_max: 80,
    }
}

/// P9 (threshold of change).
pub fn thresholds(participants: usize, threshold_k: f64) -> Task {
    let intervals = ["first", "second"];
    let mut task = task("p9", &["index"], &intervals, &["staircase", "psychometric-fit"]);
    task.staircases = vec![("cooling".into(), Staircase::new(rule()).expect("a rule"))];
    for person in 0..participants {
        let mut random = Noise::new(600 + person as u64);
        let mut staircase = Staircase::new(rule()).expect("a rule");
        let mut trials = Vec::new();
        while !staircase.is_finished() {
            let level_k = staircase.level();
            let is_correct =
                level_k / threshold_k * 0.954 + std::f64::consts::SQRT_2 * random.normal() > 0.0;
            let presented = vec![Presented::Pulses {
                device_finger: 0,
                base_c: 33.0,
                departures_k: [
                    Departure::Fixed(0.0),
                    Departure::Staircase { standard_k: 0.0, sign: -1.0 },
                ],
                rate_k_s: 1.5,
            }];
            let answer = intervals[usize::from(is_correct)];
            let mut trial =
                trial(trials.len() as u32 + 1, "main", presented, answer, Some("second"));
            trial.staircase = Some(0);
            trial.record.staircase_level_k = Some(level_k);
            trials.push(trial);
            staircase.answered(is_correct);
        }
        task.participants.push(participant(&format!("P{person:02}"), trials));
    }
    task
}

/// P12 (referral).
pub fn referral(participants: usize) -> Task {
    let fingers = ["index", "middle", "ring"];
    let mut task = task("p12", &fingers, &[], &["magnitudes", "anova-within", "tukey"]);
    task.factors = vec!["cooled".into(), "cold_c".into()];
    for person in 0..participants {
        let mut random = Noise::new(700 + person as u64);
        let mut trials = Vec::new();
        for _ in 0..4 {
            for cooled in ["outer", "middle"] {
                for cold_c in [31, 29, 27, 25] {
                    let felt = |finger: usize| {
                        f64::from(33 - cold_c)
                            * if (finger == 1) == (cooled == "middle") { 9.0 } else { 5.0 }
                    };
                    let words: Vec<_> = (0..3)
                        .map(|finger| {
                            (felt(finger) + 4.0 * random.normal())
                                .clamp(0.0, 100.0)
                                .round()
                                .to_string()
                        })
                        .collect();
                    let presented = (0..3)
                        .map(|device_finger| Presented::Hold { device_finger, celsius: 33.0 })
                        .collect();
                    let mut trial =
                        trial(trials.len() as u32 + 1, "main", presented, &words.join(";"), None);
                    trial.levels = vec![
                        ("cooled".into(), cooled.into()),
                        ("cold_c".into(), cold_c.to_string()),
                    ];
                    trials.push(trial);
                }
            }
        }
        task.participants.push(participant(&format!("P{person:02}"), trials));
    }
    task
}

/// P14 (same or different).
pub fn same_or_different(participants: usize) -> Task {
    let mut task = task(
        "p14",
        &SIDES,
        &["same", "different"],
        &["pairs-by-mode", "same-different", "anova-within"],
    );
    for person in 0..participants {
        let mut random = Noise::new(800 + person as u64);
        let mut trials = Vec::new();
        for _ in 0..5 {
            for one in &FIVE[..4] {
                for other in &FIVE[..4] {
                    let apart = (random.coldness(one, 0.3) - random.coldness(other, 0.3)).abs();
                    let word = |is_different: bool| if is_different { "different" } else { "same" };
                    let presented = vec![sample(one), display(0, other)];
                    let number = trials.len() as u32 + 1;
                    trials.push(trial(
                        number,
                        "main",
                        presented,
                        word(apart > 0.5),
                        Some(word(one != other)),
                    ));
                }
            }
        }
        task.participants.push(participant(&format!("P{person:02}"), trials));
    }
    task
}
