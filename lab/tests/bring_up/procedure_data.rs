//! The procedure's data against the netlists, and against what an emulated board understands and a device answers.

use std::collections::BTreeSet;

use hardware_benches::netlist::Netlists;
use serde_json::to_value;
use thermal_client::client::{Client, QueryBoard, QueryRaw, QuerySelfTest};
use thermal_client::commissioning::{BenchRequest, MeterPoint};
use thermal_lab::bring_up::{
    Check, Expected, ManualStep, Reading, STAGES, SimulatedBoard, StageId, Step,
};
use thermal_sim::board::{Board, SOUND, Wiring};

use super::on_the_bench;

fn checks() -> impl Iterator<Item = &'static Check> {
    let steps = STAGES.iter().flat_map(|stage| stage.steps);
    steps.filter_map(|step| match step {
        Step::Check(check) => Some(check),
        _ => None,
    })
}

fn manual_steps() -> impl Iterator<Item = &'static ManualStep> {
    let steps = STAGES.iter().flat_map(|stage| stage.steps);
    let manual = steps.filter_map(|step| match step {
        Step::Manual(step) => Some(step),
        _ => None,
    });
    manual.chain(STAGES.iter().map(|stage| &stage.needs))
}

#[test]
fn names_are_unique_and_stages_are_in_their_order() {
    assert!(STAGES.is_sorted_by_key(|stage| stage.id));
    let mut names = BTreeSet::new();
    for name in checks().map(|check| check.name) {
        assert!(names.insert(name), "{name}");
    }
}

/// Checks in their order, behind their stage and the first stage that a failure keeps from being started.
const ORDER: &str = "\
bare-board -: plate
bare-board rails: supply-to-ground
bare-board supply: bridge-supply-to-ground tile-terminals in1-pull-down in2-pull-down enable-pull-down boot0-pull-down
bare-board supply: test-pull-down side-pull-down nfault-pull-up
bare-board rails: fuse
bare-board supply: stop-released stop-pressed
rails chip: 12v 12v-current 5v 3v3
rails latch: cold-threshold hot-threshold cold-ratio hot-ratio
rails supply: bridge-supply-stopped
chip latch: brown-out-level clock watchdogs pwm-lock
line -: lines lines-lost lines-damaged receive-errors transmit-drops
reset supply: in1-in-reset in2-in-reset enable-in-reset test-in-reset boot0
sensors -: force-zero
sensors tile: force-weight force-gain
supply load: stop-sense-pressed
supply latch: stop-sense-released
supply load: latch-at-power-on bridge-supply-latched
latch edges: side-line hot-cut hot-supply hot-release cold-cut cold-supply cold-release supply result bridge-supply-on
latch edges: supply-sense
latch load: bridge-supply-in-reset
edges load: hot-edge cold-edge check-short check-open
load tile: load-voltage load-ripple mirror-ripple load-result load-current mirror-ratio
tile commissioning: display-at-rest check-at-rest sink-at-rest skin-at-rest room-at-rest cool-current display-response
tile commissioning: check-response warm-current
tile tile: tile-result
tile commissioning: warm-display warm-check cold-display cold-check
commissioning run: calibration phase-margin gain-margin
run -: run-warm-display run-cold-display run-sink stop-driving stop-current stop-supply seen-hottest";

#[test]
fn checks_are_in_the_order_of_power_and_block_what_is_unsafe_without_them() {
    let name = |id: StageId| STAGES.iter().find(|stage| stage.id == id).map(|stage| stage.name);
    let mut found = Vec::new();
    for stage in STAGES.iter() {
        for step in stage.steps {
            if let Step::Check(check) = step {
                let blocked = check.blocks.and_then(name).unwrap_or("-");
                found.push((format!("{} {blocked}", stage.name), check.name));
            }
        }
    }
    let mut expected = Vec::new();
    for line in ORDER.lines() {
        let (place, names) = line.split_once(": ").expect(line);
        expected.extend(names.split(' ').map(|name| (place.to_owned(), name)));
    }
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found, expected);
    }
    assert_eq!(found.len(), expected.len());
}

#[test]
fn each_field_that_a_check_reads_is_in_the_answer_of_the_device() {
    let (mut engine, bench) = on_the_bench(Board::named(SOUND, None).expect("a board"));
    let mut client = Client::new(SimulatedBoard::new(&mut engine, bench));
    let raw = to_value(client.ask(&QueryRaw).expect("an answer")).expect("JSON");
    let board = to_value(client.ask(&QueryBoard).expect("an answer")).expect("JSON");
    let self_test = to_value(client.ask(&QuerySelfTest).expect("an answer")).expect("JSON");
    for Check { name, reading, shown_as, .. } in checks() {
        let (answer, fields) = match reading {
            Reading::Raw(fields) => (&raw, fields),
            Reading::Board(fields) => (&board, fields),
            Reading::SelfTest(fields) => (&self_test, fields),
            _ => continue,
        };
        for field in fields.split(" + ") {
            let value = answer.get(field);
            let value = value.unwrap_or_else(|| panic!("{name} reads '{field}' of {answer}"));
            assert_eq!(value.is_boolean(), shown_as.is_some(), "{name}: shown_as of '{field}'");
        }
    }
}

#[test]
fn an_emulated_board_understands_every_line_and_every_point() {
    for line in manual_steps().flat_map(|step| step.lines) {
        let request: BenchRequest = line.parse().expect(line);
        assert_eq!(request.to_string(), *line);
    }
    for check in checks() {
        let Reading::Meter { point, .. } = check.reading else {
            continue;
        };
        let known = MeterPoint::ALL.iter().find(|known| known.name() == point);
        let known = known.unwrap_or_else(|| panic!("{}: {point}", check.name));
        let Expected::Range(_, _, unit) = check.expected else {
            panic!("{}: a meter shows a number", check.name);
        };
        let symbol = unit.symbol().replace('Ω', "ohm");
        assert_eq!(known.unit(), symbol, "{}", check.name);
    }
}

#[test]
fn lines_of_the_bench_are_refused_with_what_is_allowed() {
    for (line, part) in [
        ("meter volt 6v", "known: ohm plate, "),
        ("fit resistor nose 10", "known: display check sink skin room"),
        ("fit resistor sink -1", "'-1' ohm; allowed is 0 to 1000000"),
        ("fit load 0", "'0' ohm; allowed is 0.5 to 100"),
        ("press nothing", "known: stop, reset"),
        ("fit cat", "known: meter POINT, fit PART"),
    ] {
        let error = line.parse::<BenchRequest>().expect_err(line);
        assert!(error.contains(part), "{line}: {error}");
    }
}

/// Every check says what is broken, and where its limits come from.
#[test]
fn every_check_has_words_for_its_finding() {
    for check in checks() {
        let Check { name, low, high, basis, expected, .. } = check;
        assert!(!basis.is_empty(), "{name}");
        match expected {
            Expected::Range(least, most, _) => {
                assert!(least <= most, "{name}");
                assert!(!low.is_empty() || *least <= 0.0, "{name}");
                assert!(!high.is_empty() || most.is_infinite(), "{name}");
            }
            // What ends a self-test is explained by its word.
            Expected::Words(_) => assert!(!low.is_empty() || name.ends_with("result"), "{name}"),
        }
    }
}

#[test]
fn nominal_values_are_those_of_the_netlists() {
    let netlists = Netlists::load().expect("netlists");
    let param = |name: &str| netlists.param(name).expect(name);
    let n = Wiring::NOMINAL;
    for (check, ohm, value) in [
        ("plate", n.plate_ohm, param("r_bond")),
        ("in1-pull-down", n.in1_ohm, param("r_in_down")),
        ("in2-pull-down", n.in2_ohm, param("r_in_down")),
        ("enable-pull-down", n.enable_ohm, param("r_in_down")),
        ("test-pull-down", n.test_ohm, param("r_pull_down")),
        ("nfault-pull-up", n.nfault_ohm, param("r_fault")),
        ("fuse", n.fuse_ohm, param("r_fuse")),
        ("stop-released", n.stop_ohm, param("r_stop_contact")),
        ("bridge-supply-to-ground", n.sense_ohm, param("r_vbr_top") + param("r_vbr_bottom")),
    ] {
        assert_eq!(ohm, value, "{check}");
        let found = checks().find(|known| known.name == check).expect(check);
        let Expected::Range(least, most, _) = found.expected else {
            panic!("{check}");
        };
        assert!(least <= value && value <= most, "{check}: {value}");
    }
    let ladder = ["r_ladder_top", "r_ladder_mid", "r_ladder_bottom"].map(param);
    assert_eq!(n.ladder_ohm, ladder);
    assert_eq!(n.side_to_level_ohm, param("r_test_side"));
    assert_eq!(n.level_ohm, param("r_test_top"));
    assert_eq!(n.level_ohm, param("r_test_bottom"));
}
