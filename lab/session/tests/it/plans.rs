//! What holds for plans of any session.

use std::collections::HashMap;
use std::path::Path;

use thermal_session::record::TrialRecord;
use thermal_session::{Plan, PlanError, PlannedTrial, Schedule, Session};

use crate::{changed, plan, ready};

/// A plan is a promise: a laboratory that goes on next year with the seeds of this year must get the same trials.
#[test]
fn plans_do_not_change_with_versions() {
    for name in ["p5-real-and-simulated", "p8-force-matching", "p9-change-threshold"] {
        let path = format!("{}/tests/data/{name}.csv", env!("CARGO_MANIFEST_DIR"));
        let stored = std::fs::read_to_string(Path::new(&path)).expect(&path);
        assert!(plan(&ready(name), "P01", 1).csv() == stored, "{name}");
    }
}

#[test]
fn the_same_seed_and_participant_give_the_same_plan() {
    for name in ["p1-discrimination", "p10-pulse-difference"] {
        let session = ready(name);
        assert_eq!(plan(&session, "P01", 7), plan(&session, "P01", 7));
        assert_ne!(plan(&session, "P01", 7), plan(&session, "P01", 8));
        assert_ne!(plan(&session, "P01", 7), plan(&session, "P02", 7));
    }
}

#[test]
fn texts_and_comments_do_not_change_a_plan() {
    let one = plan(&ready("p5-real-and-simulated"), "P01", 1);
    let asked =
        changed("p5-real-and-simulated", "Which hand felt the colder material?", "Left or right?");
    assert_eq!(plan(&asked, "P01", 1), one);
}

/// A random factor more must not change the order of trials.
#[test]
fn each_purpose_has_its_own_random_numbers() {
    let (one, more) = (
        ready("p5-real-and-simulated"),
        changed(
            "p5-real-and-simulated",
            "random = {",
            "random = { voice = [\"low\", \"high\", \"none\"], ",
        ),
    );
    let (one, more) = (plan(&one, "P01", 1), plan(&more, "P01", 1));
    assert_eq!(more.factors, ["real", "simulated", "voice", "side"]);
    let levels =
        |trial: &PlannedTrial, indices: [usize; 3]| indices.map(|i| trial.levels[i].clone());
    let of_one: Vec<_> = one.trials.iter().map(|trial| levels(trial, [0, 1, 2])).collect();
    let of_more: Vec<_> = more.trials.iter().map(|trial| levels(trial, [0, 1, 3])).collect();
    assert_eq!(of_one, of_more);
}

/// The places of a trial in the first block, over many seeds: each place equally often within six standard deviations.
#[test]
fn orders_are_uniform() {
    let session = ready("p5-real-and-simulated");
    let (seeds, places) = (1600_u32, 16);
    let mut counts = vec![0_u32; places];
    for seed in 0..seeds {
        let plan = plan(&session, "P01", u64::from(seed));
        let place = plan.trials.iter().position(|trial| trial.levels[..2] == ["copper", "abs"]);
        counts[place.expect("the pair")] += 1;
    }
    let expected = f64::from(seeds) / places as f64;
    for count in counts {
        assert!(
            (f64::from(count) - expected).abs() < 6.0 * expected.sqrt(),
            "{count} of {expected}"
        );
    }
}

#[test]
fn participants_are_independent() {
    let session = ready("p5-real-and-simulated");
    let sides = |participant: u32| -> Vec<String> {
        let plan = plan(&session, &format!("P{participant}"), 1);
        plan.trials.iter().map(|trial| trial.levels[2].clone()).collect()
    };
    // Agreement of the sides of two participants at the same trial: half of them by chance.
    let all: Vec<_> = (0..40).map(sides).collect();
    let pairs =
        all.windows(2).map(|pair| pair[0].iter().zip(&pair[1]).filter(|(a, b)| a == b).count());
    let share = pairs.sum::<usize>() as f64 / (39.0 * 64.0);
    assert!((share - 0.5).abs() < 0.06, "{share}");
}

#[test]
fn no_level_runs_longer_than_the_session_allows() {
    let session = changed(
        "p5-real-and-simulated",
        "blocks = \"repetition\"",
        "blocks = \"repetition\"\nmax_run = { real = 2, side = 3 }",
    );
    let longest = |session, factor: usize| {
        let trials = plan(session, "P01", 1).trials;
        let runs = trials.chunk_by(|one, other| one.levels[factor] == other.levels[factor]);
        runs.map(<[_]>::len).max()
    };
    assert_eq!((longest(&session, 0), longest(&session, 2)), (Some(2), Some(3)));
    let free = ready("p5-real-and-simulated");
    assert!(longest(&free, 2) > Some(3), "without the constraint this seed has longer runs");
}

#[test]
fn a_constraint_that_no_order_fulfils_is_named() {
    // Three of four trials have the same level.
    let session = changed(
        "p4-identification",
        "repeat = 3\nblocks = \"none\"",
        "repeat = 3\nblocks = \"none\"\nmax_run = { material = 3, mode = 4 }",
    );
    let error = thermal_session::Plan::new(&session, "P01", 1).expect_err("one mode for 15 trials");
    assert_eq!(
        error.to_string(),
        "no order of the trials fulfils max_run.mode = 4 of the part \"real\" in 10000 attempts"
    );
}

#[test]
fn participants_are_codes() {
    let session = ready("p1-discrimination");
    for code in ["P01", "7", "abcdefghijklmnopqrs9"] {
        plan(&session, code, 1);
    }
    for name in ["", "Anna", "P 1", "P-1", "Zoë1", "abcdefghijklmnopqrst9"] {
        let error = thermal_session::Plan::new(&session, name, 1).expect_err(name);
        assert_eq!(error, PlanError::Participant { code: name.into() });
    }
}

#[test]
fn blocks_of_one_level_alternate_and_the_first_is_drawn() {
    let session = ready("p8-force-matching");
    let mut first = HashMap::new();
    for participant in 0..40 {
        let plan = plan(&session, &format!("P{participant}"), 1);
        let windows: Vec<&str> = plan.trials.chunks(15).map(|block| &*block[0].levels[0]).collect();
        assert!(
            windows == ["baf2", "zns", "baf2", "zns"] || windows == ["zns", "baf2", "zns", "baf2"]
        );
        *first.entry(windows[0].to_owned()).or_insert(0) += 1;
    }
    assert!(first.values().all(|count| (8..=32).contains(count)), "{first:?}");
}

#[test]
fn breaks_can_come_after_a_number_of_trials_or_never() {
    let breaks = |to: &str| -> Vec<u32> {
        let session = changed("p5-real-and-simulated", "blocks = \"repetition\"", to);
        let trials = plan(&session, "P01", 1).trials;
        trials.iter().filter(|trial| trial.break_before).map(|trial| trial.number).collect()
    };
    assert_eq!(breaks("blocks = \"repetition\""), [17, 33, 49]);
    assert_eq!(breaks("blocks = \"none\""), [0; 0]);
    assert_eq!(breaks("blocks = \"none\"\nbreak_after = 24"), [25, 49]);
    assert_eq!(breaks("blocks = \"repetition\"\nbreak_after = 0"), [0; 0]);
}

/// Two materials on two displays, whose objects have a temperature, °C.
fn colder_of_two(object_c: &str) -> Session {
    let text = format!(
        r#"format = 1
title = "Which is colder?"
task = "colder"
cite = "own"
instruction = "Touch both."
[device]
object_c = {object_c}
[stations.left]
finger = "left index"
[stations.right]
finger = "right index"
[present]
left = {{ display = "abs", device_finger = 0 }}
right = {{ display = "test", device_finger = 1 }}
[rest]
skin_c = 33
[trial]
contact = "hold"
answer = {{ ask = "Which is colder?", one_of = ["left", "right"] }}
[design]
factors.test = ["copper", "foam"]
[score]
correct = "colder"
"#
    );
    Session::parse(&text, Path::new("colder.toml")).expect("a valid session")
}

/// Copper takes more heat than ABS from a skin that is warmer, and gives more to one that is colder (Bergmann Tiest and Kappers
/// 2008 have found the same reversal in people); foam does both less.
#[test]
fn the_colder_of_two_materials_is_the_one_at_which_the_skin_is_colder() {
    for (object_c, beside_copper, beside_foam) in [
        ("\"room\"", Some("right"), Some("left")),
        ("15", Some("right"), Some("left")),
        ("41", Some("left"), Some("right")),
        ("33", None, None),
    ] {
        let session = colder_of_two(object_c);
        let plan = Plan::new(&session, "01", 1).expect("a plan");
        for trial in &plan.trials {
            let expected = match plan.level(trial, "test") {
                Some("copper") => beside_copper,
                _ => beside_foam,
            };
            assert_eq!(trial.correct.as_deref(), expected, "{object_c}: {:?}", trial.levels);
        }
    }
}

/// With three attempts at a trial, as docs/sessions.md says.
#[test]
fn attempts_in_which_nothing_was_presented_do_not_count_but_the_tenth_ends_the_trial() {
    let session = ready("p1-discrimination");
    let mut plan = plan(&session, "01", 1);
    plan.trials.truncate(1);
    let attempts = |is_presented: fn(u32) -> bool| {
        let mut schedule = Schedule::new(&session, &plan);
        let mut count = 0;
        while let Some(next) = schedule.next_trial() {
            count += 1;
            assert_eq!(next.attempt, count);
            schedule.ended(&TrialRecord {
                trial: next.trial.number,
                attempt: next.attempt,
                void: Some("the computer stood still for 5.0 s".into()),
                touch_cue_s: is_presented(next.attempt).then_some(1.0),
                ..TrialRecord::default()
            });
        }
        assert_eq!(schedule.given_up(), [1]);
        count
    };
    assert_eq!(attempts(|_| true), 3);
    assert_eq!(attempts(|attempt| attempt > 5), 5 + 3);
    assert_eq!(attempts(|attempt| attempt == 2), 10 + 1);
    assert_eq!(attempts(|_| false), 10);
}
