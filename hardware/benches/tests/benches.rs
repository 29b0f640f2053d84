//! Every bench holds on the circuits of the repository and fails on a circuit with one deliberate error.

use documented_figures::one_case_in;
use hardware_benches::benches::ALL;
use hardware_benches::netlist::Netlists;
use hardware_benches::ngspice;

/// Whether ngspice is there; where not, says that nothing is simulated.
fn can_simulate() -> bool {
    let installed = ngspice::is_installed();
    if !installed {
        println!("skipped: ngspice is not installed, which `cargo xtask hardware` provides");
    }
    installed
}

#[test]
fn every_simulated_quantity_is_allowed() {
    if !can_simulate() {
        return;
    }
    let netlists = Netlists::load().unwrap();
    for bench in ALL {
        let quantities = bench.run(&netlists).unwrap();
        assert!(!quantities.is_empty(), "{}", bench.name);
        for quantity in quantities {
            assert!(quantity.holds(), "{}: {quantity:?}", bench.name);
        }
    }
}

/// Of the broken circuits, the suite simulates one in so many.
const ONE_BROKEN_IN: usize = 3;

#[test]
fn every_bench_fails_on_its_broken_circuit() {
    if !can_simulate() {
        return;
    }
    let netlists = Netlists::load().unwrap();
    for bench in ALL.iter().step_by(one_case_in(ONE_BROKEN_IN)) {
        let broken = (bench.broken)(&netlists).unwrap();
        let notices = bench.fails(&broken);
        assert!(notices, "{} does not notice its broken circuit", bench.name);
    }
}
