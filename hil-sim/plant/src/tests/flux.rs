//! The heat-flux sensor on the display of a whole plant.

use contact_model::material::{REFERENCE_DISPLAY, SKIN_MICROHARDNESS_PA};
use contact_model::pressure::contact_area_m2;
use contact_model::reference::conductance_at_hardness;

use super::*;
use crate::finger::FingerParams;
use crate::sensors::{FluxDefect, FluxParams};
use crate::slab::{Layer, Medium};
use crate::tile::CoolingDefects;

/// Without errors.
const IDEAL: FluxParams = FluxParams { noise_w_m2: 0.0, ..FluxParams::NOMINAL };

fn fitted(flux: Option<FluxParams>, finger: FingerParams) -> Plant {
    let mut config = config("granite");
    config.params.flux = flux;
    config.params.finger = finger;
    let mut plant = Plant::new(&config).expect("a good configuration");
    plant.connect_supply();
    plant
}

/// Thickness of the skin that has a steady state, m; it is reached with a time constant of some 2 s.
const SKIN_M: f64 = 0.5e-3;

/// Skin on a core at 34 deg C: a body that has a steady state with a flux.
fn skin_on_a_core() -> FingerParams {
    FingerParams {
        layers: vec![Layer { thickness_m: SKIN_M, medium: Medium::without_blood(&SKIN) }],
        core_w_m2k: Some(f64::INFINITY),
        ..FingerParams::homogeneous()
    }
}

/// All that is seen of a plant, the codes included.
fn seen(plant: &mut Plant) -> ([u16; CHANNELS], [f64; 5]) {
    let values =
        [plant.display_c(), plant.skin_c(), plant.skin_real_c(), plant.sink_c(), plant.current_a()];
    (plant.convert_scan(), values)
}

#[test]
fn a_sensor_without_resistance_changes_nothing_else() {
    let finger = FingerParams::homogeneous;
    let weightless = FluxParams { resistance_m2k_w: 0.0, ..FluxParams::NOMINAL };
    let mut plants =
        [None, Some(weightless), Some(FluxParams::NOMINAL)].map(|flux| fitted(flux, finger()));
    for step in 0..400 {
        let seen = plants.each_mut().map(|plant| {
            plant.set_force(if (50..300).contains(&step) { 2.0 } else { 0.0 });
            plant.step(&legs(0.8, 0.6));
            seen(plant)
        });
        assert_eq!(seen[0], seen[1], "step {step}");
        assert!(step < 60 || seen[0].1 != seen[2].1, "step {step}: no layer");
    }
    let codes = plants.map(|plant| plant.flux_code().is_some());
    assert_eq!(codes, [false, true, true]);
}

/// Between the isothermal core and the face of the display, in the steady state, lie the skin, the contact by Eq. 6-8, and the
/// layer of the sensor.
#[test]
fn the_layer_is_in_series_with_skin_and_contact() {
    for force_n in [0.25, 2.0] {
        let relative = force_n / contact_area_m2(force_n) / SKIN_MICROHARDNESS_PA;
        let contact_w_m2k =
            conductance_at_hardness::<f64>(&SKIN.surface, &REFERENCE_DISPLAY) * relative.powf(0.95);
        for layer_m2k_w in [0.0, 3e-5, 2.3e-4] {
            let flux = FluxParams { resistance_m2k_w: layer_m2k_w, ..IDEAL };
            let mut plant = fitted(Some(flux), skin_on_a_core());
            plant.set_force(force_n);
            plant.set_defects(&Defects {
                cooling: CoolingDefects { held_c: Some(24.0), ..CoolingDefects::default() },
                ..Defects::default()
            });
            run(&mut plant, 60.0, &BridgeOutputs::default());
            let between_m2k_w =
                SKIN_M / SKIN.surface.conductivity_w_mk + 1.0 / contact_w_m2k + layer_m2k_w;
            let exact_w_m2 = (34.0 - plant.display_c()) / between_m2k_w;
            let flux_w_m2 = plant.flux_w_m2().expect("a sensor");
            let off = flux_w_m2 / exact_w_m2 - 1.0;
            assert!(off.abs() < 1e-5, "{force_n} N, {layer_m2k_w}: {off}");
            let skin_c = plant.display_c() + exact_w_m2 * (1.0 / contact_w_m2k + layer_m2k_w);
            assert!((plant.skin_c() - skin_c).abs() < 1e-4, "{}", plant.skin_c());
            let read_w_m2 = FluxParams::read_w_m2(plant.flux_code().expect("a sensor"));
            assert!((read_w_m2 - exact_w_m2).abs() < 5.0, "{read_w_m2}");
        }
    }
}

/// Readings times area and time, over a landing, a driven display, and a lift. What a first-order lag still holds at the end
/// is `lag * flux`; 0.5 counts of quantisation average out over the transients.
#[test]
fn readings_add_up_to_the_heat_that_the_finger_gives() {
    for seconds in [0.5, 4.0] {
        let mut plant = fitted(Some(IDEAL), FingerParams::homogeneous());
        plant.set_force(2.0);
        let area_m2 = contact_area_m2(2.0);
        let steps = (seconds / STEP_S) as usize;
        let mut read_j_m2 = 0.0;
        let read = |plant: &Plant| FluxParams::read_w_m2(plant.flux_code().expect("a sensor"));
        for _ in 0..steps {
            plant.step(&legs(0.8, 0.6));
            read_j_m2 += STEP_S * read(&plant);
        }
        let given_j_m2 = plant.energy().from_finger_j / area_m2;
        let decay = (-STEP_S / IDEAL.lag_s).exp();
        // The readings are those at the ends of the steps.
        let held_j_m2 = read(&plant) * STEP_S * decay / (1.0 - decay);
        assert!(given_j_m2 > 1000.0, "{given_j_m2}");
        let off_j_m2 = read_j_m2 + held_j_m2 - given_j_m2;
        let rounding_j_m2 = 0.5 / IDEAL.counts_per_w_m2 * seconds;
        assert!(off_j_m2.abs() < 0.5 * rounding_j_m2, "{off_j_m2} J/m2");
        assert!(off_j_m2.abs() < 1e-3 * given_j_m2, "{off_j_m2} of {given_j_m2}");
    }
}

#[test]
fn without_contact_the_sensor_sees_the_air_film_on_the_display() {
    let mut plant = fitted(Some(IDEAL), FingerParams::homogeneous());
    assert_eq!(plant.flux_w_m2(), Some(0.0));
    run(&mut plant, 5.0, &legs(0.6, 0.64));
    let warmer_k = plant.display_c() - 24.0;
    assert!(warmer_k > 2.0, "{warmer_k} K");
    // 10 W/(m2 K), into the air.
    let off_w_m2 = plant.flux_w_m2().expect("a sensor") + 10.0 * warmer_k;
    assert!(off_w_m2.abs() < 1e-9, "{off_w_m2}");

    let mut config = config("granite");
    config.params.flux = Some(IDEAL);
    config.params.tile.coolant_k = -5.0;
    let plant = Plant::new(&config).expect("a good configuration");
    assert_eq!(plant.flux_w_m2(), Some(50.0));
    // 50 W/m2 are 6 counts.
    assert_eq!(plant.flux_code(), Some(2054));
}

#[test]
fn defects_reach_the_sensor() {
    let mut plant = fitted(Some(IDEAL), FingerParams::homogeneous());
    plant.set_defects(&Defects {
        flux: FluxDefect { zero_w_m2: 838.9, ..FluxDefect::default() },
        ..Defects::default()
    });
    run(&mut plant, 0.01, &BridgeOutputs::default());
    assert_eq!(plant.flux_code(), Some(2148));
}
