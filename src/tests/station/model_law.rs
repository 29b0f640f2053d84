//! The set-point while the law `model` is in use, whose skin model estimates the temperature of the skin.

use contact_model::material::MATERIALS;

use super::rendering::assert_follows_new_contact;
use super::{TestBench, assert_close};
use crate::device::Station;
use crate::device::command::{Command, Reply};
use crate::device::control::Law;
use crate::tests::tuned_settings;

impl TestBench {
    /// A station that presents `material` on a plate that responds, untouched for 5 s.
    fn settled_presenting(material: &str) -> Self {
        let mut bench = Self::presenting(material);
        bench.plate_responds = true;
        bench.send_ok(&["law model"]);
        bench.steps(5000);
        bench
    }
}

#[test]
fn a_new_station_uses_the_law_model() {
    let mut station = Station::new(&tuned_settings());
    let law = station.execute(&Command::Law(None));
    assert_eq!(law, Ok(Reply::Law(Law::Model)));
}

/// The display has reached the preset temperature before the contact, and the force is constant.
#[test]
fn a_first_contact_follows_equation_6_12_for_every_material_and_force() {
    for (material, _) in MATERIALS {
        for force_n in [0.1, 0.5, 2.0] {
            let mut bench = TestBench::settled_presenting(material);
            assert_follows_new_contact(&mut bench, material, 24.0, force_n, 2000);
        }
    }
}

/// If 5 s on granite cool the skin by `m`, the preset changes by `-m (1 - ratio / weight)` (Eq. 6-12 from the present
/// skin temperature). A half-space that was held for 5 s and then left alone retains `2/pi asin sqrt(5/65)` of that
/// after 60 s.
#[test]
fn the_preset_accounts_for_skin_that_has_not_recovered() {
    let mut bench = TestBench::settled_presenting("granite");
    let recovered_c = bench.setpoint_c();
    bench.force_n = 2.0;
    let contact = bench.contact("granite", 24.0);
    bench.steps(5000);
    bench.force_n = 0.0;
    bench.steps(7);
    let cooled_k = 34.0 - contact.at(5.0).skin_c;
    let expected_c = recovered_c - cooled_k * (1.0 - contact.ratio / contact.weight);
    let touched_c = bench.setpoint_c();
    assert!(
        (touched_c - expected_c).abs() < 0.1 * (expected_c - recovered_c).abs(),
        "{touched_c} C, not {expected_c} C"
    );
    assert!((expected_c - recovered_c).abs() > 0.2, "{expected_c} C, recovered {recovered_c} C");
    bench.steps(60_000);
    let retained = (bench.setpoint_c() - recovered_c) / (touched_c - recovered_c);
    let expected = (5.0f64 / 65.0).sqrt().asin() * core::f64::consts::FRAC_2_PI;
    assert!((retained / expected - 1.0).abs() < 0.1, "{retained}, not {expected}");
}

/// The relaxations of one tissue say nothing about another one.
#[test]
fn another_tissue_begins_without_the_history_of_the_one_before() {
    let mut bench = TestBench::settled_presenting("granite");
    bench.send_ok(&["finger mean", "object slab 3mm insulated"]);
    let mut untouched = bench.clone();
    bench.force_n = 2.0;
    bench.steps(2000);
    bench.force_n = 0.0;
    bench.steps(7);
    let cooled_k = (bench.setpoint_c() - untouched.setpoint_c()).abs();
    assert!(cooled_k > 0.05, "{cooled_k} K");
    for one in [&mut bench, &mut untouched] {
        one.send_ok(&["finger thesis"]);
        one.steps(2);
    }
    let left_k = (bench.setpoint_c() - untouched.setpoint_c()).abs();
    assert!(left_k < 1e-3, "{left_k} K of {cooled_k} K");
}

/// The force rises within a few ticks, as the sensor's bandwidth lets it, and has a ripple of 0.6 mN.
#[test]
fn a_slowly_rising_noisy_force_gives_the_set_point_of_a_constant_one() {
    let mut bench = TestBench::settled_presenting("granite");
    for (force_n, rise_ticks) in [(2.0, 1.0), (0.1, 1.0), (2.0, 0.2)] {
        bench.force_n = force_n;
        let contact = bench.contact("granite", 24.0);
        for tick in 1..3000 {
            let rise = 1.0 - (-f64::from(tick) / rise_ticks).exp();
            let ripple_n = if tick % 14 < 7 { 0.6e-3 } else { -0.6e-3 };
            bench.force_n = force_n * rise + ripple_n;
            let setpoint_c = bench.setpoint_c();
            if tick > 20 {
                let expected_c = contact.at(f64::from(tick) * 1e-3).display_c;
                assert!(
                    (setpoint_c - expected_c).abs() < 6e-3,
                    "{force_n} N, tick {tick}: {setpoint_c} C, not {expected_c} C"
                );
            }
        }
        bench = TestBench::settled_presenting("granite");
    }
}

/// The mode of chapter 4 does not depend on the skin model.
#[test]
fn the_semi_infinite_mode_keeps_a_constant_set_point() {
    let mut bench = TestBench::settled_presenting("abs");
    bench.send_ok(&["mode semi-infinite"]);
    let held_c = bench.setpoint_c();
    for force_n in [2.0, 0.3, 0.0, 1.0] {
        bench.force_n = force_n;
        for _ in 0..300 {
            assert_close(bench.setpoint_c(), held_c);
        }
    }
}

/// The contact starts from the present temperature of the skin.
#[test]
fn contact_mode_chosen_under_a_finger_starts_a_new_contact() {
    let mut bench = TestBench::settled_presenting("copper");
    bench.send_ok(&["mode semi-infinite"]);
    bench.force_n = 2.0;
    bench.steps(5000);
    bench.send_ok(&["mode contact"]);
    for _ in 0..3000 {
        let setpoint_c = bench.setpoint_c();
        assert!((15.0..34.1).contains(&setpoint_c), "{setpoint_c} C");
    }
}

/// A contact under the law `pi` affects the preset of the law `model` as one of its own.
#[test]
fn the_skin_model_is_updated_under_every_law() {
    let preset_c = |law: &str| {
        let mut bench = TestBench::settled_presenting("granite");
        bench.send_ok(&[law]);
        bench.force_n = 2.0;
        bench.steps(5000);
        bench.force_n = 0.0;
        bench.steps(3);
        bench.send_ok(&["law model"]);
        bench.setpoint_c()
    };
    let (model_c, pi_c) = (preset_c("law model"), preset_c("law pi"));
    assert!((model_c - pi_c).abs() < 0.02, "{pi_c} C, not {model_c} C");
}

/// During a fault the contact is not observed, so the skin model starts from recovered skin.
#[test]
fn a_fault_resets_the_skin_model() {
    let mut bench = TestBench::settled_presenting("granite");
    let recovered_c = bench.setpoint_c();
    bench.force_n = 2.0;
    bench.steps(5000);
    bench.bridge_fault = true;
    bench.force_n = 0.0;
    bench.steps(100);
    bench.bridge_fault = false;
    bench.steps(3000);
    bench.send_ok(&["clear", "arm", "start"]);
    bench.step();
    assert_close(bench.setpoint_c(), recovered_c);
}
