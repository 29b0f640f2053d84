//! The populations are those that they promise.

use std::collections::HashSet;

use contact_model::pressure::{THESIS_PRESSURES, pressure_pa};
use contact_model::reference::conductance_at_hardness;
use thermal_plant::parameters::PlaceBeforeContact;
use thermal_plant::slab::BackBoundary;
use thermal_sim::scene::AssumedFinger;

use super::*;

#[test]
fn there_are_234_different_objects_and_each_is_a_scene() {
    let cases = Population::Objects.cases(1, 36).expect("cases");
    assert_eq!(cases.len(), 234);
    let names: HashSet<_> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), cases.len());
    let (mut half_spaces, mut insulated, mut layered) = (0, 0, 0);
    for case in &cases {
        let scene = case.scene(Way::AsItIs).expect("a scene");
        assert_eq!(scene.assumed_finger, AssumedFinger::Thesis);
        let Some(old) = case.scene(Way::Version01).ok() else {
            panic!("{}", case.name);
        };
        assert_eq!(old.object, scene.object, "{}", case.name);
        assert!(old.object_as_half_space && !scene.object_as_half_space);
        half_spaces += usize::from(scene.object.is_half_space());
        layered += usize::from(scene.object.layers.len() > 1);
        insulated += usize::from(
            scene.object.layers.len() == 1
                && !scene.object.is_half_space()
                && scene.object.back == BackBoundary::Insulated,
        );
    }
    assert_eq!((half_spaces, insulated, layered), (9, 72, 9));
}

#[test]
fn each_draw_meets_six_objects_with_one_finger_on_one_device() {
    for population in [
        Population::FingerBox,
        Population::DrawnFingers,
        Population::DesignedSensor,
        Population::HypotheticalSensor,
        Population::KnownSurfaces,
        Population::EnrolledDesigned,
        Population::EnrolledHypothetical,
    ] {
        let cases = population.cases(1, 2).expect("cases");
        assert_eq!(cases.len(), 12);
        let scenes: Vec<_> =
            (cases.iter()).map(|case| case.scene(Way::AsItIs).expect("a scene")).collect();
        for pair in scenes[..6].windows(2) {
            assert_eq!((&pair[0].params, pair[0].seed), (&pair[1].params, pair[1].seed));
        }
        assert_ne!(scenes[0].params, scenes[6].params);
        assert_ne!(scenes[0].params.tile, scenes[6].params.tile);
        let [display, check, ..] = &scenes[0].params.sensors.thermistors;
        assert_eq!(display.lag_s, check.lag_s);
        assert!(scenes[0].commissioned);
        for scene in &scenes {
            let tissue = scene.draws.finger.and_then(|finger| finger.tissue);
            let on_pad = tissue.is_some_and(|tissue| tissue.before == PlaceBeforeContact::Pad);
            let expected = if on_pad { AssumedFinger::MeanOnPad } else { AssumedFinger::Mean };
            assert_eq!(scene.assumed_finger, expected);
        }
        if population.ways().contains(&Way::Version01) {
            let old = cases[0].scene(Way::Version01).expect("a scene");
            assert_eq!(old.assumed_finger, AssumedFinger::Thesis);
        }
        let drawn = scenes[0].draws.finger.is_some();
        assert_eq!(drawn, population != Population::FingerBox);
        let with_sensor = scenes[0].params.flux.is_some();
        assert_eq!(with_sensor, ["G", "H"].contains(&population.scenario()));
        assert_eq!(scenes[0].enrolled, population.scenario() == "H");
    }
}

/// Of 200 devices. The draws are cut at two standard deviations, which makes these 0.88 of what they are called.
#[test]
fn scenario_g_has_the_fingers_and_devices_of_f_and_sensors_of_two_classes() {
    let params = |population: Population| -> Vec<_> {
        (population.cases(1, 200).expect("cases").iter().step_by(6))
            .map(|case| case.scene(Way::AsItIs).expect("a scene").params)
            .collect()
    };
    let without = params(Population::DrawnFingers);
    for (population, gain, zero_w_m2, noise_w_m2) in [
        (Population::DesignedSensor, 0.015, 3.5, 6.5),
        (Population::HypotheticalSensor, 0.01, 2.7, 22.0),
    ] {
        let with = params(population);
        for (with, without) in with.iter().zip(&without) {
            let flux = None;
            assert_eq!(thermal_plant::Params { flux, ..with.clone() }, *without);
        }
        let rms = |of: fn(&FluxParams) -> f64| {
            let values = with.iter().filter_map(|params| params.flux.as_ref()).map(of);
            (values.map(|one| one * one).sum::<f64>() / with.len() as f64).sqrt()
        };
        assert!((rms(|flux| flux.gain_error) / (0.88 * gain) - 1.0).abs() < 0.1);
        assert!((rms(|flux| flux.zero_w_m2) / (0.88 * zero_w_m2) - 1.0).abs() < 0.1);
        assert!((rms(|flux| flux.noise_w_m2) / noise_w_m2 - 1.0).abs() < 0.05);
    }
}

#[test]
fn drawn_contact_laws_leave_all_else_nominal() {
    let scenes: Vec<_> = (Population::ContactLaws.cases(1, 3).expect("cases").iter())
        .map(|case| case.scene(Way::AsItIs).expect("a scene"))
        .collect();
    assert_eq!(scenes.len(), 18);
    for scene in &scenes {
        assert_eq!(scene.params.tile, scenes[0].params.tile);
        assert_eq!(scene.params.finger, scenes[0].params.finger);
        assert_eq!(scene.params.sensors, scenes[0].params.sensors);
    }
    assert_ne!(scenes[0].params.contact, scenes[6].params.contact);
}

/// Two fingers, one with a gap of more than 100 W/(m² K).
#[test]
fn measured_contact_laws_are_near_those_of_the_plant() {
    let exact = Population::ToldContactLaws.cases(1, 2).expect("cases");
    let measured = Population::MeasuredContactLaws.cases(1, 2).expect("cases");
    assert_eq!(exact.len(), measured.len());
    for (exact, measured) in exact.iter().zip(&measured).step_by(6) {
        let conductances = [exact, measured].map(|case| {
            let scene = case.scene(Way::AsItIs).expect("a scene");
            let [line] = scene.host.as_slice() else {
                panic!("one line");
            };
            let law = law(&line.line);
            [0.1, 0.5, 2.0].map(|force_n| law.conductance_w_m2k(20_000.0, pressure_pa(force_n)))
        });
        let [exact, measured] = conductances;
        for (exact, measured) in exact.iter().zip(measured) {
            let percent = 100.0 * (measured / exact - 1.0);
            assert!(percent.abs() < 12.0 && percent != 0.0, "{percent} %");
        }
    }
}

/// The law of a line.
fn law(line: &str) -> ContactLaw {
    let words: Vec<f64> =
        (line.split(' ').skip(1)).map(|word| word.parse().expect("a number")).collect();
    ContactLaw { exponent: words[0], hardness_pa: words[1], gap_w_m2k: words[2] }
}

/// At the forces of the thesis, and the same otherwise.
#[test]
fn told_contact_laws_are_those_of_the_plant() {
    let untold = Population::ContactLaws.cases(1, 3).expect("cases");
    let told = Population::ToldContactLaws.cases(1, 3).expect("cases");
    for (untold, told) in untold.iter().zip(&told) {
        let scene = told.scene(Way::AsItIs).expect("a scene");
        assert_eq!(untold.scene(Way::AsItIs).expect("a scene").params, scene.params);
        let [line] = scene.host.as_slice() else {
            panic!("one line");
        };
        let law = law(&line.line);
        let Params { contact, finger, display, .. } = &scene.params;
        for (force_n, pressure_pa) in THESIS_PRESSURES {
            let mean = conductance_at_hardness::<f64>(&finger.surface, display);
            let plant = contact.at_force(force_n, &finger.surface, display);
            let product =
                plant.expect("a force").resistance_m2k_w * law.conductance_w_m2k(mean, pressure_pa);
            assert!((product - 1.0).abs() < 1e-3, "{force_n} N: {product}");
        }
    }
}

#[test]
fn a_spread_sample_has_both_halves_of_a_list() {
    assert_eq!(spread(&[1, 2, 3, 4, 5, 6, 7, 8], 2), [1, 6]);
    assert_eq!(spread(&[1, 2], 5), [1, 2]);
    assert_eq!(spread(&[1, 2, 3], 0), [0; 0]);
}

/// Two of three draws have errors of 1 and 3 mK as told, and ten times these in version 0.1's way.
#[test]
fn statistics_are_by_way_and_compare_with_the_aims() {
    let result = |way, max_after_50ms_mk| PopulationResult {
        population: Population::Objects,
        case: "copper".into(),
        way,
        max_after_50ms_mk,
        max_after_500ms_mk: 0.5 * max_after_50ms_mk,
        rms_mk: 1.0,
        is_enrolled: false,
        faults: Vec::new(),
    };
    let results = [
        result(Way::AsItIs, 1.0),
        result(Way::Version01, 10.0),
        result(Way::AsItIs, 3.0),
        result(Way::Version01, 30.0),
    ];
    let report =
        PopulationReport::new(Population::Objects, &results, "native", None).expect("a report");
    let medians: Vec<_> = report.ways.iter().map(|way| way.max_after_50ms_mk.p50).collect();
    assert_eq!((report.cases, medians), (2, vec![2.0, 20.0]));
    let aims: Vec<_> =
        (report.aims.iter()).map(|aim| (aim.percent, aim.aim_mk, aim.value_mk)).collect();
    assert_eq!(aims, [(95.0, 10.0, 2.9), (100.0, 20.0, 3.0)]);
    assert_eq!(report.ways[1].worst[0].max_after_50ms_mk, 30.0);
    assert_eq!(PopulationReport::new(Population::ContactLaws, &results, "native", None), None);
}

#[test]
fn the_report_of_enrolled_fingers_says_how_many_were() {
    let result = |is_enrolled| PopulationResult {
        population: Population::EnrolledDesigned,
        case: "copper".into(),
        way: Way::AsItIs,
        max_after_50ms_mk: 1.0,
        max_after_500ms_mk: 1.0,
        rms_mk: 1.0,
        is_enrolled,
        faults: Vec::new(),
    };
    let results = [true, false, true].map(result);
    let report = PopulationReport::new(Population::EnrolledDesigned, &results, "native", None);
    let text = table(&[report.expect("a report")]);
    assert!(text.contains("finger enrolled in 2 of 3 cases"), "{text}");
}
