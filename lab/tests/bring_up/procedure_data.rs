//! The procedure's data against the netlists, and against what an emulated board understands.

use std::collections::BTreeSet;

use hardware_benches::netlist::Netlists;
use thermal_client::commissioning::{BenchRequest, MeterPoint};
use thermal_lab::bring_up::{Check, Expected, ManualStep, Reading, STAGES, Step};
use thermal_sim::board::Wiring;

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
