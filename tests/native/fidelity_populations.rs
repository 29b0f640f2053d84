//! How close the skin comes to that on objects that are no half-spaces, and with fingers that are not the device's, on samples
//! of the populations that `cargo xtask fidelity --scenario E F G I` runs whole.

use documented_figures::{assert_figure, assert_sampled, one_case_in};
use thermal_campaigns::fidelity::{
    BoundResult, BoundRow, Percentiles, Population, Priors, Way, bound_rows, spread,
};
use thermal_campaigns::parallel_map;
use thermal_plant::Params;
use thermal_plant::finger::FingerParams;
use thermal_plant::parameters::FingerDraw;
use thermal_sim::scene::AssumedFinger;
use thermal_sim::{NativeRunner, SceneRunner};

/// Largest skin errors from 50 ms on, mK, of some cases of a population; no device reports a fault.
fn errors_mk(population: Population, draws: u64, sample: usize) -> Percentiles {
    let cases = spread(&population.cases(1, draws).expect("cases"), sample);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let results = parallel_map(&cases, threads, |case| case.run(&NativeRunner, Way::AsItIs), || ());
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
    let learnt = errors_mk(Population::DesignedSensor, 3, 18);
    assert_figure("population_sample.sensor_median", learnt.p50);
    assert_figure("population_sample.sensor_most", learnt.max);
}

/// Two fingers on ABS, half a second after landing.
#[test]
fn what_is_learnt_is_near_the_bound_of_cramer_and_rao() {
    let population = Population::DesignedSensor;
    let priors = Priors::of(population, 1).expect("scenes");
    let cases = population.cases(1, 2).expect("cases").into_iter();
    let cases = cases.filter(|case| case.object.name == "abs");
    let results = cases.map(|case| BoundResult::run(&case, &priors).expect("runs"));
    let rows = bound_rows(population, &results.collect::<Vec<_>>());
    let row = rows.into_iter().find(|row| row.since_s == 0.5);
    let BoundRow { contact, tissue, skin_mk, .. } = row.expect("a row");
    assert_figure("learner_bound.contact", 100.0 * contact.bound);
    assert_figure("learner_bound.contact_error", 100.0 * contact.error);
    assert_figure("learner_bound.tissue", 100.0 * tissue.bound);
    assert_figure("learner_bound.tissue_error", 100.0 * tissue.error);
    assert_figure("learner_bound.skin", skin_mk.bound);
    assert_figure("learner_bound.skin_error", skin_mk.error);
}

/// What a finger of `finger.draw` has of its draw; the rest is the nominal layered finger.
type Part = fn(&mut FingerParams, &FingerParams, &FingerDraw);

/// Of six fingers on six objects, the suite takes one pair in so many: each finger once, and each object once.
const ONE_IN: usize = 7;

/// Median of the largest skin errors from 50 ms on, mK, with six fingers that differ from the device's in one respect, on the
/// six objects and a nominal, commissioned device. `told` is whether the device is told of a pad.
fn median_of_part_mk(part: Part, told: bool) -> f64 {
    let cases = Population::DrawnFingers.cases(1, 6).expect("cases");
    let cases: Vec<_> = cases.into_iter().step_by(one_case_in(ONE_IN)).collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let work = |case: &thermal_campaigns::fidelity::PopulationCase| {
        let mut scene = case.scene(Way::AsItIs)?;
        let (drawn, draw) = (scene.params.finger.clone(), scene.draws.finger);
        let mut finger = FingerParams::layered();
        part(&mut finger, &drawn, &draw.expect("a drawn finger"));
        if !told {
            scene.assumed_finger = AssumedFinger::Mean;
        }
        scene.seed = 1;
        scene.params = Params { finger, ..Params::nominal() };
        let (_, figures) = NativeRunner.run(&scene)?;
        Ok(figures.skin_max_mk().unwrap_or(f64::INFINITY))
    };
    let errors = parallel_map(&cases, threads, work, || ()).expect("every case runs");
    Percentiles::of(&errors).expect("results").p50
}

#[test]
fn each_unknown_of_a_finger_costs_what_is_stated() {
    let place: Part = |finger, drawn, _| finger.air_w_m2k = drawn.air_w_m2k;
    let parts: [(&str, Part, bool); 7] = [
        ("nothing", |_, _, _| (), false),
        (
            "effusivity",
            |finger, _, draw| {
                for layer in &mut finger.layers {
                    layer.medium.conductivity_w_mk *= draw.effusivity_factor;
                    layer.medium.capacity_j_m3k *= draw.effusivity_factor;
                }
            },
            false,
        ),
        (
            "resistance",
            |finger, drawn, _| finger.resistance_factor = drawn.resistance_factor,
            false,
        ),
        (
            "shape",
            |finger, drawn, draw| {
                for (layer, drawn) in finger.layers.iter_mut().zip(&drawn.layers) {
                    layer.thickness_m = drawn.thickness_m;
                    let medium = &mut layer.medium;
                    medium.conductivity_w_mk =
                        drawn.medium.conductivity_w_mk / draw.effusivity_factor;
                    medium.capacity_j_m3k = drawn.medium.capacity_j_m3k / draw.effusivity_factor;
                }
            },
            false,
        ),
        ("blood", |finger, drawn, _| finger.vessels = drawn.vessels, false),
        ("place_not_told", place, false),
        ("place", place, true),
    ];
    let medians = parts.map(|(name, part, told)| (name, median_of_part_mk(part, told)));
    println!("{medians:?}");
    for (name, median_mk) in medians {
        assert_sampled(&format!("finger_part.{name}"), median_mk);
    }
}
