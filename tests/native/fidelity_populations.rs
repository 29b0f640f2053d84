//! How close the skin comes to that on objects that are no half-spaces, and with fingers that are not the device's, on samples
//! of the populations that `cargo xtask fidelity --scenario E F I` runs whole.

use documented_figures::assert_figure;
use thermal_campaigns::fidelity::{Percentiles, Population, Way, spread};
use thermal_campaigns::parallel_map;
use thermal_sim::NativeRunner;

/// Largest skin errors from 50 ms on, mK, of some cases of a population; no device reports a fault.
fn errors_mk(population: Population, draws: u64, sample: usize) -> Percentiles {
    let cases = spread(&population.cases(1, draws), sample);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let results = parallel_map(
        &cases,
        threads,
        |case| case.run(&NativeRunner, Way::AsItIs),
        || (),
    );
    let results = results.expect("every case runs");
    let faulty = results.iter().find(|one| !one.faults.is_empty());
    assert_eq!(faulty, None);
    let errors: Vec<_> = results.iter().map(|one| one.max_after_50ms_mk).collect();
    Percentiles::of(&errors).expect("results")
}

#[test]
fn skin_follows_slabs_half_spaces_and_layers() {
    let errors = errors_mk(Population::Objects, 0, 30);
    assert_figure("population_sample.objects_median", errors.p50);
    assert_figure("population_sample.objects_most", errors.max);
}

#[test]
fn skin_follows_with_fingers_that_the_device_does_not_know() {
    let of_box = errors_mk(Population::FingerBox, 3, 18);
    let drawn = errors_mk(Population::DrawnFingers, 3, 18);
    assert_figure("population_sample.box_median", of_box.p50);
    assert_figure("population_sample.box_most", of_box.max);
    assert_figure("population_sample.drawn_median", drawn.p50);
    assert_figure("population_sample.drawn_most", drawn.max);
}
