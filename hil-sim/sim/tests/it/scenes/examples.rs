//! Physics that must hold in the examples.

use thermal_plant::infrared::{Optic, OpticalPath, Surroundings, radiance, temperature_c};

use super::{at, example, rows, scene};

#[test]
fn layered_finger_rests_in_equilibrium_until_it_touches() {
    let rows = rows(&example("layered-finger", &[]));
    for row in rows.iter().take_while(|row| row.t_s < 1.0) {
        // Nine seconds have passed, settling included. In an epidermis without blood temperature is linear: the film's
        // 10 W/(m2 K) times 10 K over 0.21 W/(m K).
        for (receptors_c, skin_c) in
            [(row.receptors_c, row.skin_c), (row.receptors_real_c, row.skin_real_c)]
        {
            assert!((skin_c - 33.0).abs() < 1e-9, "skin {skin_c} at {} s", row.t_s);
            for (receptor_c, depth_m) in receptors_c.iter().zip([0.16e-3, 0.45e-3]) {
                let exact_c = 33.0 + 100.0 * depth_m / 0.21;
                let off_c = receptor_c.expect("thick enough") - exact_c;
                assert!(off_c.abs() < 1e-6, "{depth_m} m off by {off_c} at {} s", row.t_s);
            }
        }
    }
}

#[test]
fn force_ramps_and_blood_that_it_presses_out_cools_the_skin() {
    let pressed = rows(&example("layered-finger", &[]));
    for (t_s, force_n) in [(1.0, 0.1), (2.5, 1.05), (3.0, 2.0), (11.0, 1.15), (13.0, 0.0)] {
        assert!((at(&pressed, t_s).force_n - force_n).abs() < 1e-9, "at {t_s} s");
    }
    let flowing = rows(&example("layered-finger", &[("vessels = true", "vessels = false")]));
    let warmer_c = |t_s| at(&flowing, t_s).skin_real_c - at(&pressed, t_s).skin_real_c;
    assert_eq!(warmer_c(1.5), 0.0, "full flow up to 0.3 N");
    assert!(warmer_c(10.0) > 0.01, "{}", warmer_c(10.0));
}

#[test]
fn finite_block_leaves_the_skin_warmer_than_a_half_space() {
    let shape = ("thickness_m = 0.010\nback = \"insulated\"", "");
    let block = rows(&example("layered-finger", &[]));
    let endless = rows(&example("layered-finger", &[shape]));
    assert!(at(&block, 13.0).skin_real_c > at(&endless, 13.0).skin_real_c);
}

#[test]
fn slabs_with_every_back_follow_their_exact_solution() {
    // Skin after 10 s at 2 N: half-space on slab in the Laplace domain, inverted numerically (Talbot, 48 points).
    for (material, shape, exact_c) in [
        ("copper", "", 25.756_038),
        ("copper", "thickness_m = 0.01", 26.249_827),
        ("granite", "thickness_m = 0.004", 28.408_463),
        ("granite", "thickness_m = 0.004\nback = \"held\"", 27.768_548),
        ("granite", "thickness_m = 0.004\nback = \"film\"\nback_film_w_m2k = 200", 28.322_451),
    ] {
        let text = format!(
            "duration_s = 10\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"{material}\"\n{shape}\n\
             [[force]]\nt_s = 0\nforce_n = 2\n"
        );
        let off_c = at(&rows(&text), 10.0).skin_real_c - exact_c;
        assert!(off_c.abs() < 1e-3, "{material}, {shape}: off by {off_c}");
    }
}

/// A slab of granite on a colder back: 2 mm of granite take the temperature of their back in some seconds.
#[test]
fn a_colder_back_cools_the_real_object_from_when_it_appears() {
    let slab = |back: &str| {
        rows(&format!(
            "duration_s = 60\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"granite\"\nappears_t_s = 1\n\
             thickness_m = 0.002\nback = \"held\"\n{back}[[force]]\nt_s = 55\nforce_n = 2\n"
        ))
    };
    let (as_object, colder) = (slab(""), slab("back_c = 20\n"));
    // Before it appears, and in the step in which it does.
    for t_s in [0.0, 0.5, 1.0] {
        assert_eq!(at(&colder, t_s).object_real_c, 24.0, "at {t_s} s");
    }
    // Three seconds are L^2 / a, so after fifty it has the temperature of its back.
    let untouched_c = at(&colder, 54.9).object_real_c;
    assert!((untouched_c - 20.0).abs() < 1e-3, "{untouched_c}");
    assert_eq!(at(&as_object, 54.9).object_real_c, 24.0);
    // A linear problem: all temperatures but the skin's are 4 K lower, so the skin falls by 14/10 of what it did.
    let fall = |rows: &[_]| 34.0 - at(rows, 60.0).skin_real_c;
    let ratio = fall(&colder) / fall(&as_object);
    assert!((ratio - 1.4).abs() < 1e-3, "{ratio}");
}

#[test]
fn warm_slab_warms_the_finger_more_with_each_touch() {
    let rows = rows(&example("lift-and-replace", &[]));
    let mut before_c = 33.0;
    for contact in 0..5 {
        let landed_s = 1.0 + 2.0 * f64::from(contact);
        let (landed, lifted) = (at(&rows, landed_s), at(&rows, landed_s + 1.0));
        assert!(contact == 0 || landed.skin_real_c > before_c + 0.1, "contact {contact}");
        assert!(lifted.skin_real_c > landed.skin_real_c + 1.0, "contact {contact}");
        assert!(lifted.skin_real_c < 41.0);
        // The insulated skin keeps a part of it; the slab comes back to its hotplate's temperature.
        let again = at(&rows, landed_s + 1.999);
        assert!(again.skin_real_c < lifted.skin_real_c);
        assert!(again.object_real_c > lifted.object_real_c);
        assert!((again.object_real_c - 41.0).abs() < 0.01);
        before_c = landed.skin_real_c;
    }
}

/// Errors of the recovered skin temperature, C, in frames.
fn camera_errors(changes: &[(&str, &str)]) -> Vec<f64> {
    let rows = rows(&example("worst-case-box", changes));
    let frames: Vec<_> = rows.iter().filter(|row| row.camera.is_some()).collect();
    // 25 Hz over 12 s, both ends included.
    assert_eq!(frames.len(), 301);
    for (i, row) in frames.iter().enumerate() {
        assert!((row.t_s - 0.04 * i as f64).abs() < 1e-9, "frame {i} at {} s", row.t_s);
    }
    let error =
        |row: &&thermal_sim::trace::TraceRow| Some(row.camera?.recovered_c - row.skin_real_c);
    frames.iter().filter_map(error).collect()
}

#[test]
fn camera_recovers_the_true_skin_within_its_noise() {
    let errors = camera_errors(&[("camera_c = 30.0", "pixels = 16")]);
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    let deviation = (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n).sqrt();
    // Table 5-3: 0.65 by 0.54 of the skin's radiance arrives, times its emissivity.
    let expected = 0.08 / 4.0 / (0.95 * 0.65 * 0.54);
    assert!((deviation / expected - 1.0).abs() < 0.15, "{deviation} instead of {expected}");
    assert!(mean.abs() < 4.0 * expected / n.sqrt(), "{mean}");
}

#[test]
fn camera_that_sees_itself_takes_the_skin_for_warmer() {
    // The camera of 30 C takes the place of a room of 26 C in what the window mirrors, past the beamsplitter twice.
    let through = OpticalPath::new(Optic::Zns, 0.95, &Surroundings::at(26.0));
    let more = 0.22 * 0.54 * 0.54 * (radiance(30.0) - radiance(26.0));
    let taken_c =
        temperature_c(through.target_radiance(through.total_radiance(radiance(29.0)) + more));
    let errors = camera_errors(&[("rate_hz = 25", "rate_hz = 25\nnetd_k = 0")]);
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    assert!((mean - (taken_c - 29.0)).abs() < 0.03, "{mean} instead of {}", taken_c - 29.0);
}

#[test]
fn drawn_plant_is_drawn_by_its_seed_and_what_the_scene_says_stays() {
    use thermal_plant::{Params, parameters};
    let mut drawn = Params::nominal();
    parameters::draw(&mut drawn, 17);
    for (key, value) in [
        ("bridge.supply_v", 11.4),
        ("tile.sink_k_w", 0.4),
        ("tile.coolant_k", 6.0),
        ("sensors.display.lag_s", 0.3),
        ("sensors.check.lag_s", 0.3),
    ] {
        parameters::set(&mut drawn, key, value).expect("a key");
    }
    assert_eq!(scene(&example("worst-case-box", &[])).params, drawn);
    let hot = rows(&example("worst-case-box", &[]));
    let cool = rows(&example("worst-case-box", &[("coolant_k = 6.0", "coolant_k = 0.0")]));
    assert!(at(&hot, 12.0).sink_c > at(&cool, 12.0).sink_c + 0.3);
}
