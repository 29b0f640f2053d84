//! Files that nobody would write: an error names one of the file's lines, and what is accepted has a plan, or a sentence why it
//! has none, in bounded time and memory.

use std::path::Path;
use std::time::{Duration, Instant};

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_session::{Plan, PlanError, Session};

use crate::folder;

const CHANGED_FILES: u32 = 6000;
/// Most trials of a session ([sessions.md](../../../../docs/sessions.md)).
const TRIALS: usize = 10_000;
/// Some hundred times what the slowest of the files below takes.
const TIME_MAX: Duration = Duration::from_secs(60);

/// What the reader says of a text: the session if it is accepted. Panics where a promise is broken.
fn read(text: &str) -> Result<Session, String> {
    let begin = Instant::now();
    let read = Session::parse(text, Path::new("s.toml"));
    let read = match read {
        Ok(session) => {
            check_plan(&session);
            Ok(session)
        }
        Err(error) => {
            let lines = 1 + text.matches('\n').count();
            let line = error.line().unwrap_or_default();
            assert!((1..=lines).contains(&line), "{lines} lines: {error}");
            assert!(!error.problem().trim().is_empty(), "{error}\n{text}");
            Err(error.to_string())
        }
    };
    assert!(begin.elapsed() < TIME_MAX, "{:?}", begin.elapsed());
    read
}

/// The plan is a pure function, and each part has the trials that its design announces.
fn check_plan(session: &Session) {
    let plan = Plan::new(session, "P01", 1);
    assert_eq!(plan, Plan::new(session, "P01", 1));
    let plan = match plan {
        Ok(plan) => plan,
        Err(PlanError::Order { .. }) => return,
        Err(error) => panic!("{error}"),
    };
    assert!((1..=TRIALS).contains(&plan.trials.len()));
    for part in &session.design.parts {
        let staircases = session.staircases.iter();
        let of_staircases: u32 = staircases
            .filter(|staircase| staircase.part == part.name)
            .map(|staircase| staircase.initial.rule().trials_max)
            .sum();
        let announced = match of_staircases {
            0 => part.combinations().len() * part.repeat as usize,
            trials => trials as usize,
        };
        let planned = plan.trials.iter().filter(|trial| trial.part == part.name);
        assert_eq!(planned.count(), announced, "{:?}", part.name);
    }
    let numbers = plan.trials.iter().map(|trial| trial.number as usize);
    assert!(numbers.eq(1..=plan.trials.len()));
    assert_eq!(plan.csv().lines().count(), 1 + plan.trials.len());
}

fn texts() -> Vec<String> {
    let entries = std::fs::read_dir(folder()).expect("the ready sessions");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let texts = paths.iter().map(|path| std::fs::read_to_string(path).expect("text"));
    texts.collect()
}

/// Random changes of ready sessions, whose lines, keys and words are mixed.
#[test]
fn changed_files_are_refused_with_a_line_or_have_a_plan() {
    let texts = texts();
    let all: Vec<&str> = texts.iter().flat_map(|text| text.lines()).collect();
    let is_end = |c: char| !c.is_alphanumeric() && !"-_.\"".contains(c);
    let mut words: Vec<&str> = all.iter().flat_map(|line| line.split(is_end)).collect();
    words.extend([
        "0",
        "-1",
        "1e308",
        "nan",
        "9223372036854775807",
        "[]",
        "{}",
        "''",
        "\"\"\"",
        "a.b.c",
        "=",
        "[[part]]\n",
        "\n",
        "\u{fe0f}",
    ]);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let (mut accepted, mut refused) = (0, 0);
    for number in 0..CHANGED_FILES {
        let text = &texts[number as usize % texts.len()];
        let mut lines: Vec<String> = text.lines().map(Into::into).collect();
        for _ in 0..random.random_range(1..=3) {
            let at = random.random_range(0..lines.len());
            let any = all[random.random_range(0..all.len())];
            let word = words[random.random_range(0..words.len())];
            match random.random_range(0..6) {
                0 => drop(lines.remove(at)),
                1 => lines.insert(at, any.into()),
                2 => lines[at] = any.into(),
                3 => {
                    let other = random.random_range(0..lines.len());
                    lines.swap(at, other);
                }
                4 => {
                    let line = &lines[at];
                    let own: Vec<&str> = line.split(is_end).filter(|own| !own.is_empty()).collect();
                    if !own.is_empty() {
                        let own = own[random.random_range(0..own.len())];
                        lines[at] = line.replacen(own, word, 1);
                    }
                }
                _ => {
                    let line = &mut lines[at];
                    let cut = line.char_indices().map(|(index, _)| index);
                    let cuts: Vec<usize> = cut.collect();
                    if !cuts.is_empty() {
                        line.insert_str(cuts[random.random_range(0..cuts.len())], word);
                    }
                }
            }
            if lines.is_empty() {
                lines.push(String::new());
            }
        }
        match read(&lines.join("\n")) {
            Ok(_) => accepted += 1,
            Err(_) => refused += 1,
        }
    }
    // Neither is rare.
    assert!(accepted > 500 && refused > 2000, "{accepted}, {refused}");
}

/// A session with this design.
fn with_design(design: &str) -> String {
    format!(
        "format = 1\ntitle = \"t\"\ntask = \"t\"\ncite = \"t\"\ninstruction = \"t\"\n[stations.a]\nfinger = \"f\"\n\
         [present]\na = {{ sample = \"copper\" }}\n[trial]\n{design}"
    )
}

fn joined(count: usize, item: impl Fn(usize) -> String) -> String {
    let items: Vec<String> = (0..count).map(item).collect();
    items.join(", ")
}

/// The largest files have a megabyte. Lists that long are refused before anything is built from them.
#[test]
fn large_files_are_refused_soon() {
    let levels = joined(90_000, |index| format!("\"l{index}\""));
    let factors = |count| joined(count, |index| format!("f{index} = [\"a\", \"b\"]"));
    let parts: Vec<String> =
        (0..30_000).map(|index| format!("[[part]]\nname = \"p{index}\"")).collect();
    let analyses = joined(90_000, |_| "\"falls\"".into());
    for (design, problem) in [
        (
            format!("[design]\nfactors = {{ f = [{levels}] }}\n"),
            "a list of 2 to 100 different levels",
        ),
        (
            format!("[design]\nrandom = {{ {} }}\nrepeat = 1000\n", factors(45_000)),
            "0 to 20 factors in a part",
        ),
        (format!("[design]\nfactors = {{ {} }}\n", factors(20)), "more than 10000 trials"),
        (parts.join("\n"), "more than 100 parts"),
        (format!("[score]\nanalyses = [{analyses}]\n"), "\"falls\" needs contact"),
    ] {
        let text = with_design(&design);
        assert!(text.len() < 1 << 20, "{}", text.len());
        let error = read(&text).expect_err(problem);
        assert!(error.contains(problem), "{error}");
    }
}

/// A constraint that cannot be fulfilled, after others that always are, with as many factors as a part may have.
#[test]
fn an_order_that_does_not_exist_is_given_up_soon() {
    let many = joined(19, |index| format!("f{index} = [\"a\", \"b\"]"));
    let runs = joined(19, |index| format!("f{index} = 100"));
    let design = format!(
        "[design]\nfactors = {{ one = [\"a\", \"b\", \"c\", \"d\", \"e\", \"f\", \"g\", \"h\", \"i\", \"j\"] }}\n\
         random = {{ {many} }}\nrepeat = 200\nblocks = \"none\"\nmax_run = {{ {runs}, one = 1 }}\n"
    );
    let session = read(&with_design(&design)).expect("a session");
    let error = Plan::new(&session, "P01", 1).expect_err("no order");
    assert!(error.to_string().contains("max_run.one = 1"), "{error}");
}
