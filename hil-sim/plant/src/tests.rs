//! The whole plant with the mesh and the steps of every simulation.

mod flux;
mod layered;
mod reference;

use contact_model::material::{SKIN, find};
use contact_model::reference::erfcx;

use super::bridge::Leg;
use super::object::ObjectConfig;
use super::slab::BackBoundary;
use super::*;

fn config(material: &str) -> PlantConfig {
    PlantConfig {
        skin_c: 34.0,
        room_c: 24.0,
        object: ObjectConfig::half_space(
            *find(material).unwrap_or_else(|| panic!("no material {material}")),
            24.0,
        ),
        start_s: 0.0,
        appears_s: 0.0,
        duration_s: 60.0,
        seed: 1,
        params: Params::nominal(),
    }
}

/// With its supply connected.
fn plant(material: &str) -> Plant {
    let mut plant = Plant::new(&config(material)).expect("a good configuration");
    plant.connect_supply();
    plant
}

fn legs(a: f64, b: f64) -> BridgeOutputs {
    BridgeOutputs { a: Leg::Duty(a), b: Leg::Duty(b), enabled: true }
}

fn run(plant: &mut Plant, duration_s: f64, legs: &BridgeOutputs) {
    for _ in 0..(duration_s / STEP_S).round() as usize {
        plant.step(legs);
    }
}

#[test]
fn leg_a_above_leg_b_cools_and_leg_b_above_leg_a_heats() {
    for (a, b, sign) in [(1.0, 0.6, -1.0), (0.6, 1.0, 1.0)] {
        let mut plant = plant("copper");
        run(&mut plant, 1.0, &legs(a, b));
        assert!(sign * (plant.display_c() - 24.0) > 3.0, "{}", plant.display_c());
        assert!(sign * plant.current_a() < -3.0, "{}", plant.current_a());
        let codes = Channel::ALL.map(|channel| f64::from(plant.convert(channel)));
        let mirror_a = codes[Channel::Current as usize] / 400.0;
        assert!((mirror_a - plant.current_a().abs()).abs() < 0.02, "{mirror_a}");
    }
}

/// The latch is set at power-on; the end of a test of either side clears it.
#[test]
fn the_bridge_has_no_supply_until_the_comparator_was_tested() {
    let driven = legs(1.0, 0.6);
    for test in [ComparatorTest::Hot, ComparatorTest::Cold] {
        let mut plant = Plant::new(&config("copper")).expect("good");
        run(&mut plant, 0.1, &driven);
        assert_eq!((plant.current_a(), plant.bridge_fault()), (0.0, true));
        assert_eq!(plant.convert(Channel::Supply), 0);
        plant.comparator_test(test);
        run(&mut plant, 0.02, &driven);
        assert_eq!(plant.current_a(), 0.0);
        plant.comparator_test(ComparatorTest::None);
        run(&mut plant, 0.02, &driven);
        assert!(plant.current_a() > 3.0, "{}", plant.current_a());
        assert!(!plant.bridge_fault());
        let supply_v = f64::from(plant.convert(Channel::Supply)) / 288.65;
        assert!((11.8..12.05).contains(&supply_v), "{supply_v}");
    }
}

/// At half duty the ripple of two times 4.7 uH is 12 V / 4 / (9.4 uH * 96.98 kHz) = 3.29 A from peak to peak. Scans that are
/// whole numbers of periods apart all see it at one phase; those of the firmware are spread over a period.
#[test]
fn a_board_without_the_filters_of_the_current_measurement_sees_the_ripple_at_its_phase() {
    let reading_a = |lag_s: f64, phase: f64, phase_step: f64| {
        let mut config = config("copper");
        let mirror = &mut config.params.sensors.mirror;
        (mirror.lag_s, mirror.sampling_phase, mirror.phase_step) = (lag_s, phase, phase_step);
        config.params.sensors.converter.inl_counts = 0.0;
        let mut plant = Plant::new(&config).expect("good");
        plant.connect_supply();
        run(&mut plant, 0.1, &legs(1.0, 0.5));
        let codes = (0..16).map(|_| f64::from(plant.convert(Channel::Current)));
        codes.sum::<f64>() / (16.0 * 400.0) - plant.current_a().abs()
    };
    for (phase, error_a) in [(0.0, -1.645), (0.25, 0.0), (0.5, 1.645)] {
        let unfiltered_a = reading_a(0.0, phase, 0.0);
        assert!((unfiltered_a - error_a).abs() < 0.02, "{phase}: {unfiltered_a} A");
        let spread_a = reading_a(0.0, phase, 0.0614);
        assert!(spread_a.abs() < 0.06, "{phase}: {spread_a} A");
        let filtered_a = reading_a(0.43e-3, phase, 0.0);
        assert!(filtered_a.abs() < 0.01, "{phase}: {filtered_a} A");
    }
}

#[test]
fn disabled_bridge_drives_no_current() {
    let mut plant = plant("copper");
    run(&mut plant, 0.5, &BridgeOutputs { enabled: false, ..legs(1.0, 0.0) });
    assert_eq!(plant.current_a(), 0.0);
    assert!((plant.display_c() - 24.0).abs() < 1e-9);
}

#[test]
fn object_that_has_not_appeared_takes_no_heat() {
    let mut plant = Plant::new(&PlantConfig { appears_s: 0.2, ..config("copper") }).expect("good");
    plant.set_force(1.0);
    run(&mut plant, 0.2, &BridgeOutputs::default());
    assert_eq!(plant.skin_real_c(), 34.0);
    assert!(plant.skin_c() < 33.5, "the display is there: {}", plant.skin_c());
    run(&mut plant, 0.1, &BridgeOutputs::default());
    assert!(plant.skin_real_c() < 32.5, "{}", plant.skin_real_c());
}

#[test]
fn time_counts_from_the_start() {
    let mut plant = Plant::new(&PlantConfig { start_s: -1.0, ..config("abs") }).expect("good");
    run(&mut plant, 1.5, &BridgeOutputs::default());
    assert!((plant.time_s() - 0.5).abs() < 1e-12);
}

#[test]
fn runs_repeat_bit_for_bit() {
    let trace = || {
        let mut plant = plant("granite");
        let mut seen = Vec::new();
        for k in 0..2000 {
            plant.set_force(if (500..1500).contains(&k) { 1.5 } else { 0.0 });
            plant.step(&legs(0.5, 0.2));
            seen.push((Channel::ALL.map(|c| plant.convert(c)), plant.skin_c().to_bits()));
        }
        seen
    };
    assert!(trace() == trace());
}

#[test]
fn bad_configuration_is_named() {
    let cold = PlantConfig { skin_c: -300.0, ..config("abs") };
    let message = Plant::new(&cold).expect_err("too cold").to_string();
    assert_eq!(message, "skin temperature in deg C is -300; allowed is -40 to 100");
    let mut hollow = config("abs");
    hollow.object.layers[0].medium.capacity_j_m3k = 0.0;
    let message = Plant::new(&hollow).expect_err("no mass").to_string();
    assert_eq!(
        message,
        "heat capacity of an object's layer in J/(m3 K) is 0; allowed is a finite number above 0"
    );
    let endless = PlantConfig { duration_s: f64::NAN, ..config("abs") };
    assert!(Plant::new(&endless).is_err());
}

/// A slab of ABS on a warm back, which must not heat it before it appears; the simulated time must not matter either.
#[test]
fn object_keeps_its_start_temperature_until_it_appears() {
    let after = |settle_s: f64, duration_s: f64| {
        let mut config = config("abs");
        config.object.layers[0].thickness_m = 0.01;
        config.object.back = BackBoundary::Film { film_w_m2k: f64::INFINITY, temperature_c: 40.0 };
        (config.start_s, config.duration_s) = (-settle_s, duration_s);
        let mut plant = Plant::new(&config).expect("good");
        run(&mut plant, settle_s, &BridgeOutputs::default());
        assert!((plant.object_c() - 24.0).abs() < 2.0, "{}", plant.object_c());
        plant.set_force(2.0);
        run(&mut plant, 12.0, &BridgeOutputs::default());
        plant.skin_real_c()
    };
    let expected_c = after(8.0, 600.0);
    for (settle_s, duration_s) in [(8.0, 12.0), (60.0, 12.0)] {
        let off_mk = 1e3 * (after(settle_s, duration_s) - expected_c).abs();
        assert!(off_mk < 1.0, "{settle_s} s of settling, {duration_s} s simulated: {off_mk} mK");
    }
}

/// Skin on the object by Eq. 6-5 with twice the resistance, and the flux into the display reduced as much.
#[test]
fn resistance_factor_acts_on_object_and_display() {
    let granite = find("granite").expect("known");
    let landed = |factor: f64| {
        let mut config = config("granite");
        config.params.finger.resistance_factor = factor;
        let mut plant = Plant::new(&config).expect("good");
        plant.set_force(2.0);
        plant.step(&BridgeOutputs::default());
        plant
    };
    let surface = &granite.surface;
    let contact = ContactLaw::NOMINAL.at_force(2.0, &SKIN.surface, surface);
    let doubled_m2k_w = 2.0 * contact.expect("pressed").resistance_m2k_w;
    let mut plant = landed(2.0);
    let ratio = |finger| landed(1.0).heat.flux_w_m2(finger) / plant.heat.flux_w_m2(finger);
    // After 1 ms the resistance limits the flux.
    for finger in [Finger::OnObject, Finger::OnDisplay] {
        assert!((1.8..2.0).contains(&ratio(finger)), "{}", ratio(finger));
    }
    run(&mut plant, 0.999, &BridgeOutputs::default());
    let (es, eo) = (SKIN.effusivity(), granite.effusivity());
    let progress = 1.0 - erfcx((1.0 / es + 1.0 / eo) / doubled_m2k_w);
    let exact_c = 34.0 - 10.0 * eo / (eo + es) * progress;
    assert!((plant.skin_real_c() - exact_c).abs() < 1e-3);
}

/// Behind a good insulation the core would have to be at 1000 deg C to keep the skin warm.
#[test]
fn impossible_core_temperature_is_refused() {
    let mut config = config("abs");
    config.params.finger.core_w_m2k = Some(0.1);
    config.params.finger.air_w_m2k = 10.0;
    config.params.finger.layers[0].thickness_m = 1e-3;
    let message = Plant::new(&config).expect_err("1000 K").to_string();
    assert!(message.contains("core") && message.contains("allowed is 0 to 45"), "{message}");
}
