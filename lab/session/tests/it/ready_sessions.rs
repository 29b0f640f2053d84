//! What holds for each ready session.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use thermal_session::{
    Blocks, CorrectAnswer, Departure, Part, Plan, PlannedTrial, Presented, Quantity, Session,
};

use crate::{changed, folder, plan, ready};

/// A ready session: name, trials of each part, blocks of each part, and trials before which a break comes.
type Expected = (&'static str, &'static [usize], &'static [u32], &'static [u32]);

const SESSIONS: [Expected; 13] = [
    ("p1-discrimination", &[84], &[4], &[22, 43, 64]),
    ("p2-skin-temperature-fall", &[21], &[1], &[]),
    ("p3-localisation", &[180], &[3], &[61, 121]),
    ("p3-localisation-displays", &[180], &[3], &[61, 121]),
    ("p4-identification", &[15, 45], &[1, 3], &[16, 31, 46]),
    ("p5-real-and-simulated", &[64], &[4], &[17, 33, 49]),
    ("p5-real-and-simulated-contact-model", &[64], &[4], &[17, 33, 49]),
    ("p6-skin-temperature", &[15, 15], &[1, 1], &[16]),
    ("p8-force-matching", &[60], &[4], &[16, 31, 46]),
    ("p9-change-threshold", &[120], &[1], &[41, 81]),
    ("p10-pulse-difference", &[180], &[1], &[31, 61, 91, 121, 151]),
    ("p12-referral", &[32], &[4], &[9, 17, 25]),
    ("p14-same-or-different", &[96], &[6], &[17, 33, 49, 65, 81]),
];

/// Each session with some plans of it.
fn each(check: impl Fn(&Session, &Plan)) {
    for (name, ..) in SESSIONS {
        let session = ready(name);
        for (participant, seed) in [("P01", 1), ("P02", 1), ("P02", u64::MAX)] {
            check(&session, &plan(&session, participant, seed));
        }
    }
}

#[test]
fn the_folder_has_these_sessions() {
    let files = std::fs::read_dir(folder()).expect("the folder");
    let names =
        files.map(|file| file.expect("a file").file_name().into_string().expect("its name"));
    let expected = SESSIONS.map(|(name, ..)| format!("{name}.toml"));
    assert_eq!(names.collect::<BTreeSet<_>>(), expected.into_iter().collect());
}

/// Names of tasks are names of files: two sessions with the same one would mix their data.
#[test]
fn each_session_has_its_own_task() {
    let tasks: BTreeSet<_> = SESSIONS.iter().map(|(name, ..)| ready(name).task).collect();
    assert_eq!(tasks.len(), SESSIONS.len());
}

/// Samples alone need no device, even if the file describes one; a skin thermistor beside a sample does, and so does a display.
#[test]
fn a_session_needs_a_device_for_displays_and_skin_thermistors_only() {
    let without_device = ["p1-discrimination", "p3-localisation"];
    for (name, ..) in SESSIONS {
        let expected = !without_device.contains(&name);
        assert_eq!(ready(name).needs_device(), expected, "{name}");
    }
    let one_thermistor = changed("p2-skin-temperature-fall", "skin_sensor = 1\n", "");
    assert!(one_thermistor.needs_device());
    let text = one_thermistor.text.replace("skin_sensor = 0 ", "# ");
    let none = Session::parse(&text, Path::new("no thermistor")).expect("samples alone");
    assert!(none.device.is_some() && !none.needs_device());
    // A finger that touches nothing has no use for its thermistor.
    let beside = "present]\nleft = { sample = \"copper\" }\nright = \"nothing\"\n";
    for (thermistor_at, expected) in [("left", true), ("right", false)] {
        let keys = |station: &str| {
            let own = if station == thermistor_at { "skin_sensor = 0\n" } else { "" };
            format!("[stations.{station}]\nfinger = \"{station} index\"\n{own}")
        };
        let text = format!(
            "format = 1\ntitle = \"t\"\ntask = \"t\"\ncite = \"t\"\ninstruction = \"t\"\n[device]\n\
             {}{}[{beside}[trial]\n[design]\n",
            keys("left"),
            keys("right")
        );
        let session = Session::parse(&text, Path::new("one side")).expect("a session");
        assert_eq!(session.needs_device(), expected, "{thermistor_at}");
    }
}

#[test]
fn trials_blocks_and_breaks_are_those_of_the_source() {
    for (name, trials, blocks, breaks) in SESSIONS {
        let session = ready(name);
        let plan = plan(&session, "P01", 1);
        let of_part =
            |part: &Part| plan.trials.iter().filter(|trial| trial.part == part.name).count();
        let counts: Vec<_> = session.design.parts.iter().map(of_part).collect();
        assert_eq!(counts, trials, "{name}");
        let blocks_of = |part: &Part| {
            let trials = plan.trials.iter().filter(|trial| trial.part == part.name);
            trials.map(|trial| trial.block).collect::<BTreeSet<_>>().len() as u32
        };
        assert_eq!(
            session.design.parts.iter().map(blocks_of).collect::<Vec<_>>(),
            blocks,
            "{name}"
        );
        let before: Vec<_> = plan
            .trials
            .iter()
            .filter(|trial| trial.break_before)
            .map(|trial| trial.number)
            .collect();
        assert_eq!(before, breaks, "{name}");
    }
}

#[test]
fn trials_are_numbered_and_blocks_follow_each_other() {
    each(|_, plan| {
        for (index, trial) in plan.trials.iter().enumerate() {
            assert_eq!(trial.number as usize, index + 1);
            assert_eq!(
                (trial.levels.len(), trial.presented.len()),
                (plan.factors.len(), plan.stations.len())
            );
        }
        let blocks: Vec<_> = plan.trials.iter().map(|trial| trial.block).collect();
        assert!(blocks.windows(2).all(|pair| pair[1] == pair[0] || pair[1] == pair[0] + 1));
        assert_eq!(blocks[0], 1);
    });
}

/// The levels of a trial for these factors.
fn levels<'a>(plan: &'a Plan, trial: &'a PlannedTrial, factors: &[(&str, &str)]) -> Vec<&'a str> {
    factors.iter().map(|(factor, _)| plan.level(trial, factor).expect("a factor")).collect()
}

#[test]
fn each_block_has_each_combination_equally_often() {
    each(|session, plan| {
        for part in session.design.parts.iter().filter(|_| session.staircases.is_empty()) {
            let combinations = part.combinations();
            let blocks: BTreeSet<_> = plan
                .trials
                .iter()
                .filter(|trial| trial.part == part.name)
                .map(|trial| trial.block)
                .collect();
            let mut in_all: HashMap<Vec<&str>, u32> = HashMap::new();
            for block in blocks {
                let trials = plan.trials.iter().filter(|trial| trial.block == block);
                let mut counts: HashMap<Vec<&str>, u32> = HashMap::new();
                for trial in trials {
                    *counts.entry(levels(plan, trial, &combinations[0])).or_default() += 1;
                }
                let (repetitions, of_block) = match &part.blocks {
                    Blocks::Repetitions(repetitions) => (*repetitions, combinations.len()),
                    Blocks::OneLevel { factor, repetitions } => {
                        let factor = part.factors.iter().find(|known| known.name == *factor);
                        (
                            *repetitions,
                            combinations.len() / factor.expect("the factor").levels.len(),
                        )
                    }
                };
                assert_eq!(counts.len(), of_block);
                assert!(counts.values().all(|count| *count == repetitions), "{counts:?}");
                for (levels, count) in counts {
                    *in_all.entry(levels).or_default() += count;
                }
            }
            assert_eq!(in_all.len(), combinations.len());
            assert!(in_all.values().all(|count| *count == part.repeat));
        }
    });
}

#[test]
fn balanced_levels_occur_equally_often_with_each_combination() {
    let mut checked = 0;
    for (name, ..) in SESSIONS {
        let session = ready(name);
        let plan = plan(&session, "P03", 3);
        for part in &session.design.parts {
            let combination = part.combinations().remove(0);
            for factor in part.random.iter().filter(|factor| part.balance.contains(&factor.name)) {
                let mut counts: HashMap<(Vec<&str>, &str), u32> = HashMap::new();
                for trial in &plan.trials {
                    let level = plan.level(trial, &factor.name).expect("the factor");
                    *counts.entry((levels(&plan, trial, &combination), level)).or_default() += 1;
                }
                let each = part.repeat / factor.levels.len() as u32;
                assert!(counts.values().all(|count| *count == each), "{name}: {counts:?}");
                checked += 1;
            }
        }
    }
    // P1, both P5, P14.
    assert_eq!(checked, 4);
}

/// What the analysis takes for the stimulus is what the participant touches.
#[test]
fn stations_present_what_the_factors_say() {
    let session = ready("p5-real-and-simulated");
    for trial in &plan(&session, "P01", 1).trials {
        let [real, simulated, side] = &trial.levels[..] else {
            panic!("{:?}", trial.levels);
        };
        let sample = Presented::Sample { material: real.clone() };
        let display = Presented::Material { device_finger: 0, material: simulated.clone() };
        let expected = if side == "real-left" { [sample, display] } else { [display, sample] };
        assert_eq!(trial.presented, expected);
    }
    let session = ready("p3-localisation");
    let plan = plan(&session, "P01", 1);
    for trial in &plan.trials {
        let [target, distractor, position] = &trial.levels[..] else {
            panic!("{:?}", trial.levels);
        };
        for (station, presented) in plan.stations.iter().zip(&trial.presented) {
            let material = if station == position { target } else { distractor };
            assert_eq!(*presented, Presented::Sample { material: material.clone() });
        }
        assert_eq!(trial.correct.as_ref(), Some(position));
    }
}

#[test]
fn the_colder_station_has_the_larger_effusivity() {
    each(|session, plan| {
        if session.score.correct != CorrectAnswer::ColderStation {
            return;
        }
        for trial in &plan.trials {
            let effusivity = |presented: &Presented| match presented {
                Presented::Sample { material } | Presented::Material { material, .. } => {
                    session.material(material).expect("a material").effusivity()
                }
                other => panic!("{other:?}"),
            };
            let [left, right] = [0, 1].map(|station| effusivity(&trial.presented[station]));
            let expected = if left > right {
                Some("left")
            } else if left < right {
                Some("right")
            } else {
                None
            };
            assert_eq!(trial.correct.as_deref(), expected);
        }
    });
}

#[test]
fn p4_names_the_material_on_sample_and_display() {
    let plan = plan(&ready("p4-identification"), "P01", 1);
    for trial in &plan.trials {
        let [mode, material] = &trial.levels[..] else {
            panic!("{:?}", trial.levels);
        };
        let material = material.clone();
        assert_eq!((&trial.part, trial.correct.as_ref()), (mode, Some(&material)));
        let expected = if mode == "real" {
            Presented::Sample { material }
        } else {
            Presented::Material { device_finger: 0, material }
        };
        assert_eq!(trial.presented, [expected]);
    }
}

#[test]
fn p5_has_real_and_simulated_and_its_files_differ_in_the_device_only() {
    let (thesis, ours) =
        (ready("p5-real-and-simulated"), ready("p5-real-and-simulated-contact-model"));
    assert!(
        plan(&thesis, "P01", 1)
            .csv()
            .starts_with("trial,part,block,break_before,real,simulated,side,")
    );
    assert_ne!(thesis.device, ours.device);
    let same = Session {
        title: thesis.title.clone(),
        task: thesis.task.clone(),
        device: thesis.device.clone(),
        text: thesis.text.clone(),
        ..ours
    };
    assert_eq!(same, thesis);
}

#[test]
fn p8_follows_the_force_of_its_factor() {
    let session = ready("p8-force-matching");
    assert_eq!(session.trial.target_force_n, Some(Quantity::Factor("force_n".into())));
    for trial in &plan(&session, "P01", 1).trials {
        assert_eq!(
            trial.target_force_n.map(|force_n| force_n.to_string()).as_ref(),
            Some(&trial.levels[1])
        );
    }
}

#[test]
fn staircases_take_turns_and_the_change_is_in_the_interval_of_the_correct_answer() {
    for (name, standards_k, signs) in [
        ("p9-change-threshold", &[0.0, 0.0][..], &[-1.0, 1.0][..]),
        ("p10-pulse-difference", &[-2.0, -5.0, -8.0], &[-1.0; 3]),
    ] {
        let plan = plan(&ready(name), "P01", 1);
        for round in plan.trials.chunks(plan.staircases.len()) {
            let staircases: BTreeSet<_> =
                round.iter().filter_map(|trial| trial.staircase).collect();
            assert_eq!(staircases.len(), plan.staircases.len(), "{name}");
        }
        let mut firsts = 0;
        for trial in &plan.trials {
            let staircase = trial.staircase.expect("a staircase");
            let (standard_k, sign) = (standards_k[staircase], signs[staircase]);
            let [Presented::Pulses { departures_k, .. }] = &trial.presented[..] else {
                panic!("{:?}", trial.presented);
            };
            let (standard, changed) =
                (Departure::Fixed(standard_k), Departure::Staircase { standard_k, sign });
            let first = trial.correct.as_deref() == Some("first");
            firsts += usize::from(first);
            assert_eq!(
                *departures_k,
                if first { [changed, standard] } else { [standard, changed] }
            );
        }
        let share = firsts as f64 / plan.trials.len() as f64;
        assert!((share - 0.5).abs() < 0.2, "{name}: {share}");
    }
}

#[test]
fn p12_cools_the_outer_fingers_or_the_middle_one() {
    let session = ready("p12-referral");
    assert_eq!(session.device_fingers(), [1, 2, 3]);
    for trial in &plan(&session, "P01", 1).trials {
        let cold_c: f64 = trial.levels[1].parse().expect("a temperature");
        let (outer_c, middle_c) =
            if trial.levels[0] == "outer" { (cold_c, 33.0) } else { (33.0, cold_c) };
        for ((presented, celsius), device_finger) in
            trial.presented.iter().zip([outer_c, middle_c, outer_c]).zip(1..)
        {
            assert_eq!(*presented, Presented::Hold { device_finger, celsius });
        }
    }
}

/// The source: pairs with a ratio of contact coefficients below 2.04 were not told apart; PVC and wood are such a pair.
#[test]
fn p14_has_materials_of_its_own() {
    let session = ready("p14-same-or-different");
    let effusivity = |name: &str| session.material(name).expect(name).effusivity();
    assert!((effusivity("pvc") - 406.0).abs() < 0.5);
    assert!(effusivity("pvc") / effusivity("wood") < 2.04);
    assert!(effusivity("aluminium") / effusivity("ceramic") > 2.04);
    assert!(effusivity("ceramic") / effusivity("pvc") > 2.04);
    assert!(session.describes_material("wood") && !session.describes_material("copper"));
    let same = plan(&session, "P01", 1)
        .trials
        .iter()
        .filter(|trial| trial.correct.as_deref() == Some("same"))
        .count();
    assert_eq!(same, 24);
}

/// By the defaults of docs/sessions.md, `mean` and `pad` contradict each other, too.
#[test]
fn a_finger_that_is_assumed_elsewhere_than_it_rests_is_found_and_no_ready_session_has_one() {
    for entry in std::fs::read_dir(folder()).expect("the ready sessions") {
        let path = entry.expect("an entry").path();
        let session = Session::read(&path).expect("a session");
        assert_eq!(session.contradiction_of_finger_and_rest(), None, "{}", path.display());
    }
    let name = "p5-real-and-simulated-contact-model";
    let found = |finger: &str, place: &str| {
        let text = ready(name).text;
        let (old_finger, old_place) = ("assumed_finger = \"mean-on-pad\"", "place = \"pad\"");
        assert!(text.contains(old_finger) && text.contains(old_place));
        let text = text.replace(old_finger, finger).replace(old_place, place);
        let session = Session::parse(&text, Path::new(name)).expect("a session");
        session.contradiction_of_finger_and_rest().unwrap_or_default()
    };
    let mean = "assumed_finger = \"mean\"";
    let on_pad = "rest.place = \"pad\" contradicts device.assumed_finger = \"mean\"; without \"mean-on-pad\" the skin";
    assert!(found(mean, "place = \"pad\"").starts_with(on_pad));
    assert!(found("", "").starts_with(on_pad));
    let in_air = found("assumed_finger = \"mean-on-pad\"", "place = \"air\"");
    assert!(
        in_air.starts_with(
            "rest.place = \"air\" contradicts device.assumed_finger = \"mean-on-pad\""
        )
    );
    for (finger, place) in
        [(mean, "air"), (mean, "display"), ("assumed_finger = \"thesis\"", "pad")]
    {
        assert_eq!(found(finger, &format!("place = {place:?}")), "", "{finger} {place}");
    }
}
