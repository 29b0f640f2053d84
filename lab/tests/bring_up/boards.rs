//! Sound boards pass, and broken ones are found by what is measured.

use std::thread;

use documented_figures::one_case_in;
use thermal_lab::bring_up::{Report, STAGES, Verdict};
use thermal_sim::board::{BROKEN_BOARDS, Board, SOUND};

use super::brought_up;

/// Boards that are drawn from the tolerances of their parts, and of how many the suite takes one.
const DRAWN: u64 = 20;
const ONE_DRAWN_IN: usize = 4;
/// A broken board without tolerances, and with some that could hide it. The suite takes one of these for each.
const TOLERANCES: [Option<u64>; 3] = [None, Some(3), Some(4)];

/// Broken board, the stage in which it must be found, and words of a finding that names what is broken.
const FOUND: &[(&str, &str, &[&str])] = &[
    ("swapped-wires", "sensors", &["sink", "room", "swapped", "PA4"]),
    ("ladder-resistor", "rails", &["R1 (3.4 kΩ)", "ladder"]),
    ("divider-resistor", "sensors", &["sink", "as of a pull-up of 1", "R1 (10 kΩ 0.1 %"]),
    ("missing-pull-down", "bare-board", &["pull-down R3", "PB10"]),
    ("dead-comparator", "latch", &["comparator does not cut", "hot side X3"]),
    ("dead-cold-side", "latch", &["comparator does not cut", "cold side X4"]),
    ("side-stuck", "latch", &["PB2 (CN10-22)", "low", "destroyed"]),
    ("latch-not-set", "supply", &["latch X6", "not set at power-on"]),
    ("reset-not-latched", "latch", &["reset does not cut the bridge supply", "NRST"]),
    ("shorted-switch", "supply", &["high-side switch M1", "shorted"]),
    ("open-switch", "latch", &["does not come back", "high-side switch M1"]),
    ("missing-bleeder", "latch", &["bleeder R7"]),
    ("wrong-inductors", "load", &["inductors L1, L2 (4.7 µH"]),
    ("reversed-tile", "tile", &["tile's wires P and N are swapped"]),
    ("brown-out-not-set", "chip", &["BOR_LEV"]),
    ("mirror-without-rc", "load", &["current measurement has no filter", "68 nF"]),
    ("other-thermistor", "tile", &["second display thermistor", "another type", "beta"]),
    ("stop-bypassed", "bare-board", &["emergency stop does not open", "S1"]),
    ("stop-sense-open", "supply", &["second contact S2", "PC13"]),
    ("no-usb-clock", "chip", &["8 MHz", "SB50"]),
    ("force-wires-swapped", "sensors", &["load cell are swapped"]),
    ("sense-resistors", "load", &["sense resistors R5, R6 (5 mΩ"]),
    ("lossy-line", "line", &["serial line loses lines"]),
    ("plate-not-bonded", "bare-board", &["plate is not bonded", "R1 (1 kΩ"]),
];

/// Stages in which the bridge drives a current.
const DRIVEN: [&str; 4] = ["load", "tile", "commissioning", "run"];
/// Boards whose comparator, latch or switch cannot cut the supply.
const WITHOUT_COMPARATOR: [&str; 6] = [
    "dead-comparator",
    "dead-cold-side",
    "side-stuck",
    "latch-not-set",
    "shorted-switch",
    "missing-bleeder",
];

fn board(name: &str, seed: Option<u64>) -> Board {
    Board::named(name, seed).expect("a board")
}

#[test]
fn a_sound_board_passes_every_check_of_every_stage() {
    let report = brought_up(board(SOUND, None), Report::default(), None);
    assert!(report.passed(), "{:#?}", report.findings());
    assert_eq!(report.findings(), Vec::<&str>::new());
    assert_eq!(report.settings.len(), 8, "settings of commissioning");
}

#[test]
fn boards_drawn_from_tolerances_pass() {
    let seeds: Vec<u64> = (1..=DRAWN).step_by(one_case_in(ONE_DRAWN_IN)).collect();
    thread::scope(|scope| {
        for half in seeds.chunks(seeds.len().div_ceil(2)) {
            scope.spawn(move || {
                for seed in half {
                    let report = brought_up(board(SOUND, Some(*seed)), Report::default(), None);
                    assert!(report.passed(), "seed {seed}: {:#?}", report.findings());
                }
            });
        }
    });
}

#[test]
fn each_broken_board_is_found_in_its_stage_and_named() {
    let mut listed: Vec<_> = FOUND.iter().map(|(name, ..)| *name).collect();
    let mut all: Vec<_> = BROKEN_BOARDS.iter().map(|broken| broken.name).collect();
    listed.sort_unstable();
    all.sort_unstable();
    assert_eq!(listed, all);
    let step = one_case_in(TOLERANCES.len());
    for (number, (name, stage, words)) in FOUND.iter().enumerate() {
        for seed in TOLERANCES.iter().skip(number % step).step_by(step) {
            let report = brought_up(board(name, *seed), Report::default(), None);
            assert!(!report.passed(), "{name}");
            let findings = report.findings();
            let first = report.records.iter().find(|record| record.verdict == Verdict::Failed);
            assert_eq!(
                first.map(|record| record.stage.as_str()),
                Some(*stage),
                "{name}: {findings:#?}"
            );
            let is_named = |finding: &&str| words.iter().all(|word| finding.contains(word));
            assert!(findings.iter().any(is_named), "{name}: {findings:#?}");
            assert_eq!(report.resume.map(|resume| resume.stage).as_deref(), Some(*stage));
        }
    }
}

#[test]
fn no_stage_with_a_current_is_started_with_a_failed_comparator() {
    for name in WITHOUT_COMPARATOR {
        let report = brought_up(board(name, None), Report::default(), None);
        let driven = report.records.iter().find(|record| DRIVEN.contains(&record.stage.as_str()));
        assert!(driven.is_none(), "{name}: {driven:?}");
    }
}

#[test]
fn the_document_lists_every_broken_board_with_its_stage() {
    let document = include_str!("../../../docs/bring-up.md");
    for (name, stage, _) in FOUND {
        let row = document.lines().find(|line| line.starts_with(&format!("| `{name}` |")));
        let row = row.unwrap_or_else(|| panic!("no row of {name}"));
        assert!(row.ends_with(&format!("| `{stage}` |")), "{row}");
    }
    for stage in STAGES.iter() {
        assert!(document.contains(&format!("| `{}` |", stage.name)));
    }
}
