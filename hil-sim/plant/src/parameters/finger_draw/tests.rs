use contact_model::material::find;

use super::*;
use crate::finger::Vessels;
use crate::object::ObjectConfig;
use crate::{Params, Plant, PlantConfig};

const DRAWS: u64 = 2000;

fn drawn(finger: FingerParams, seed: u64, with_tissue: bool) -> (FingerParams, FingerDraw) {
    let mut finger = finger;
    let draw = draw_finger(&mut finger, seed, with_tissue);
    (finger, draw)
}

#[test]
fn homogeneous_finger_differs_in_effusivity_and_resistance_only() {
    let nominal = FingerParams::homogeneous();
    let (mut effusivity, mut ln_resistance) = (0.0, 0.0);
    for seed in 0..DRAWS {
        let (finger, draw) = drawn(nominal.clone(), seed, false);
        assert_eq!(draw.tissue, None);
        let [was, is] = [&nominal, &finger].map(|finger| finger.layers[0].medium);
        let factor = |of: f64, to: f64| to / of;
        let k = factor(was.conductivity_w_mk, is.conductivity_w_mk);
        let c = factor(was.capacity_j_m3k, is.capacity_j_m3k);
        assert!((k - draw.effusivity_factor).abs() < 1e-12 && (c - k).abs() < 1e-12);
        assert!((0.8..=1.2).contains(&k));
        assert!((0.5..=2.0).contains(&draw.resistance_factor));
        let mut back = finger.clone();
        back.layers.clone_from(&nominal.layers);
        back.resistance_factor = 1.0;
        assert_eq!(back, nominal);
        assert_eq!(finger.resistance_factor, draw.resistance_factor);
        effusivity += k;
        ln_resistance += draw.resistance_factor.ln();
    }
    // Five standard errors of a uniform distribution's mean.
    let error = 5.0 / (12.0 * DRAWS as f64).sqrt();
    assert!((effusivity / DRAWS as f64 - 1.0).abs() < 0.4 * error);
    assert!((ln_resistance / DRAWS as f64).abs() < 4f64.ln() * error);
}

#[test]
fn layered_finger_takes_every_shape_in_its_share() {
    let nominal = FingerParams::layered();
    let mut seen = [0u32; 5];
    for seed in 0..DRAWS {
        let (finger, draw) = drawn(nominal.clone(), seed, true);
        assert_eq!(finger.surface, nominal.surface, "drawn with the plant");
        let tissue = draw.tissue.expect("a tissue");
        let epidermis = finger.layers[0];
        let k_w_mk = epidermis.medium.conductivity_w_mk / draw.effusivity_factor;
        let within = |value: f64, (least, most): (f64, f64)| {
            assert!((least - 1e-12..=most + 1e-12).contains(&value), "{value}: {draw:?}");
        };
        let (m, w_mk) = match tissue.epidermis {
            Epidermis::Box => ((0.5005e-3, 0.7995e-3), (0.189, 0.231)),
            Epidermis::Callus => ((0.8e-3, 1.4e-3), (0.14, 0.19)),
            Epidermis::Thin => ((0.26e-3, 0.5e-3), (0.189, 0.231)),
        };
        within(epidermis.thickness_m, m);
        within(k_w_mk, w_mk);
        let film = match tissue.before {
            PlaceBeforeContact::Air => (5.0, 15.0),
            PlaceBeforeContact::Pad => (0.5, 3.0),
        };
        within(finger.air_w_m2k, film);
        let vessels = finger.vessels;
        match tissue.blood {
            BloodUnderForce::Open => assert_eq!(vessels, None),
            BloodUnderForce::ShutByForce => {
                let Vessels { open_n, shut_n } = vessels.expect("vessels");
                within(open_n, (0.24, 0.36));
                within(shut_n, (0.8, 1.2));
            }
        }
        let is = [
            tissue.epidermis == Epidermis::Box,
            tissue.epidermis == Epidermis::Callus,
            tissue.epidermis == Epidermis::Thin,
            tissue.blood == BloodUnderForce::Open,
            tissue.before == PlaceBeforeContact::Air,
        ];
        for (seen, is) in seen.iter_mut().zip(is) {
            *seen += u32::from(is);
        }
    }
    for (seen, share) in seen.into_iter().zip([0.5, 0.25, 0.25, 0.5, 0.5]) {
        let off = f64::from(seen) / DRAWS as f64 - share;
        assert!(off.abs() < 5.0 * (0.25 / DRAWS as f64).sqrt(), "{seen} of {DRAWS}");
    }
}

#[test]
fn draws_depend_on_the_seed_only() {
    let of = |seed| drawn(FingerParams::layered(), seed, true);
    assert_eq!(of(7), of(7));
    assert_ne!(of(7).0, of(8).0);
    // The same person, homogeneous.
    let (_, plain) = drawn(FingerParams::homogeneous(), 7, false);
    let (_, layered) = of(7);
    assert_eq!(plain.effusivity_factor, layered.effusivity_factor);
    assert_eq!(plain.resistance_factor, layered.resistance_factor);
}

#[test]
fn every_drawn_finger_is_a_plant() {
    let granite = find("granite").expect("known");
    for seed in 0..200 {
        let (finger, _) = drawn(FingerParams::layered(), seed, true);
        for skin_c in [30.0, 35.0] {
            let config = PlantConfig {
                skin_c,
                room_c: 24.0,
                object: ObjectConfig::half_space(*granite, 24.0),
                start_s: 0.0,
                appears_s: 0.0,
                duration_s: 1.0,
                seed,
                params: Params { finger: finger.clone(), ..Params::nominal() },
            };
            Plant::new(&config).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        }
    }
}
