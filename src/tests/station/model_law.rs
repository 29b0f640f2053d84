//! The set-point while the law with a model is in use, and follows the skin for itself.

use contact_model::material::MATERIALS;

use super::rendering::follows_a_contact;
use super::{Bench, assert_close};
use crate::device::Station;
use crate::device::command::{Command, Reply};
use crate::device::control::Law;
use crate::settings::Settings;

impl Bench {
    /// `material` is presented by a display that does what it should, and nobody has touched it for long.
    fn settled_on(material: &str) -> Self {
        let mut bench = Self::presenting(material);
        bench.answers = true;
        bench.obey(&["law model"]);
        bench.steps(5000);
        bench
    }
}

#[test]
fn it_is_the_law_of_a_new_device() {
    let mut station = Station::new(&Settings::default());
    let law = station.execute(Command::Law(None));
    assert_eq!(law, Ok(Reply::Law(Law::Model)));
}

/// A preset that is in time, a force that stays.
#[test]
fn a_first_contact_follows_equation_6_12_for_every_material_and_force() {
    for (material, _) in MATERIALS {
        for force_n in [0.1, 0.5, 2.0] {
            let mut bench = Bench::settled_on(material);
            follows_a_contact(&mut bench, material, 24.0, force_n, 2000);
        }
    }
}

/// A skin that 5 s on granite have cooled by `m` changes the preset by `-m (1 - ratio / weight)` (Eq. 6-12 from the skin
/// as it is). A half-space that was held for 5 s and then left alone keeps `2/pi asin sqrt(5/65)` of that after 60 s.
#[test]
fn a_skin_that_was_touched_is_not_taken_for_rested() {
    let mut bench = Bench::settled_on("granite");
    let rested_c = bench.setpoint_c();
    bench.force_n = 2.0;
    let contact = bench.contact("granite", 24.0);
    bench.steps(5000);
    bench.force_n = 0.0;
    bench.steps(3);
    let cooled_k = 34.0 - contact.at(5.0).skin_c;
    let moved_c = rested_c - cooled_k * (1.0 - contact.ratio / contact.weight);
    let touched_c = bench.setpoint_c();
    assert!(
        (touched_c - moved_c).abs() < 0.1 * (moved_c - rested_c).abs(),
        "{touched_c} C, not {moved_c} C"
    );
    assert!(
        (moved_c - rested_c).abs() > 0.2,
        "{moved_c} C, rested {rested_c} C"
    );
    bench.steps(60_000);
    let kept = (bench.setpoint_c() - rested_c) / (touched_c - rested_c);
    let expected = (5.0f64 / 65.0).sqrt().asin() * core::f64::consts::FRAC_2_PI;
    assert!(
        (kept / expected - 1.0).abs() < 0.1,
        "{kept}, not {expected}"
    );
}

/// A constant force that its sensor and noise let rise in a few ticks and swing by 0.6 mN is constant.
#[test]
fn a_force_that_rises_through_its_sensor_is_constant() {
    let mut bench = Bench::settled_on("granite");
    for (force_n, rise_ticks) in [(2.0, 1.0), (0.1, 1.0), (2.0, 0.2)] {
        bench.force_n = force_n;
        let contact = bench.contact("granite", 24.0);
        for tick in 1..3000 {
            let risen = 1.0 - (-f64::from(tick) / rise_ticks).exp();
            let swing_n = if tick % 14 < 7 { 0.6e-3 } else { -0.6e-3 };
            bench.force_n = force_n * risen + swing_n;
            let setpoint_c = bench.setpoint_c();
            if tick > 20 {
                let expected_c = contact.at(f64::from(tick) * 1e-3).display_c;
                assert!(
                    (setpoint_c - expected_c).abs() < 6e-3,
                    "{force_n} N, tick {tick}: {setpoint_c} C, not {expected_c} C"
                );
            }
        }
        bench = Bench::settled_on("granite");
    }
}

/// Chapter 4's mode is no business of the skin's.
#[test]
fn semi_infinite_mode_is_constant() {
    let mut bench = Bench::settled_on("abs");
    bench.obey(&["mode semi-infinite"]);
    let held_c = bench.setpoint_c();
    for force_n in [2.0, 0.3, 0.0, 1.0] {
        bench.force_n = force_n;
        for _ in 0..300 {
            assert_close(bench.setpoint_c(), held_c);
        }
    }
}

/// Whatever a finger touched meanwhile, contact mode begins with a contact of the two skins as they are.
#[test]
fn another_mode_under_a_finger_starts_a_new_contact() {
    let mut bench = Bench::settled_on("copper");
    bench.obey(&["mode semi-infinite"]);
    bench.force_n = 2.0;
    bench.steps(5000);
    bench.obey(&["mode contact"]);
    for _ in 0..3000 {
        let setpoint_c = bench.setpoint_c();
        assert!((15.0..34.1).contains(&setpoint_c), "{setpoint_c} C");
    }
}

/// The skin is followed whatever the law: a contact under another one is remembered.
#[test]
fn the_skin_is_remembered_whatever_the_law() {
    let preset_c = |law: &str| {
        let mut bench = Bench::settled_on("granite");
        bench.obey(&[law]);
        bench.force_n = 2.0;
        bench.steps(5000);
        bench.force_n = 0.0;
        bench.steps(3);
        bench.obey(&["law model"]);
        bench.setpoint_c()
    };
    let (followed_c, other_c) = (preset_c("law model"), preset_c("law pi"));
    assert!(
        (followed_c - other_c).abs() < 0.02,
        "{other_c} C, not {followed_c} C"
    );
}

/// After a fault, during which nobody watched the finger, the skin counts as rested.
#[test]
fn a_fault_forgets_the_skin() {
    let mut bench = Bench::settled_on("granite");
    let rested_c = bench.setpoint_c();
    bench.force_n = 2.0;
    bench.steps(5000);
    bench.bridge_fault = true;
    bench.force_n = 0.0;
    bench.steps(100);
    bench.bridge_fault = false;
    bench.steps(3000);
    bench.obey(&["clear", "arm", "start"]);
    bench.step();
    assert_close(bench.setpoint_c(), rested_c);
}
