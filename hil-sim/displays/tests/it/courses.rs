//! The courses of single displays.

use contact_model::material::SKIN;
use contact_model::pressure::pressure_pa;
use contact_model::reference::Contact;
use earlier_displays::{Display, RcLadder, Showing, SingleContact, Tissue, scene};
use thermal_client::course::Course;

fn touch(material: &str, tissue: Tissue) -> (thermal_sim::scene::Scene, SingleContact) {
    let scene = scene(material, tissue);
    let touch = SingleContact::of(&scene).expect("one contact");
    (scene, touch)
}

fn ideal(display: Display, material: &str, tissue: Tissue) -> Course {
    let (scene, touch) = touch(material, tissue);
    display.ideal_course(&scene, &touch).expect("a plant")
}

/// The thesis's contact of skin and object under a pressure, Pa.
fn contact(touch: &SingleContact, pressure_pa: f64) -> Contact<f64> {
    Contact::new(
        (&SKIN, touch.skin_c),
        (&touch.object, touch.object_c),
        &touch.display,
        pressure_pa,
    )
}

#[test]
fn yamamotos_preset_is_that_from_which_a_half_space_of_ceramic_comes_to_the_contact_temperature() {
    // Effusivities by hand: sqrt(0.37 * 1000 * 3700), sqrt(2.79 * 2630 * 775) and that of the ceramic, sqrt(24 * 3.05e6).
    let (skin, granite, ceramic) = (1_170.042_7, 2_384.684_7, 8_555.699_9);
    let contact_c = (24.0 * granite + 34.0 * skin) / (granite + skin);
    let static_c = contact_c + (contact_c - 34.0) * skin / ceramic;
    let (scene, touch) = touch("granite", Tissue::HalfSpace);
    let Ok(Showing::Course { course, .. }) = Display::Yamamoto.showing(&scene, &touch) else {
        panic!("a course");
    };
    // The device is told tenths of a millikelvin.
    assert!((course.at(0.0) - static_c).abs() < 1e-4, "{} {static_c}", course.at(0.0));
    for t_s in [earlier_displays::YAMAMOTO_RAMP_S, 1.0, 10.0] {
        assert!((course.at(t_s) - contact_c).abs() < 1e-4, "{t_s} s");
    }
    // Two half-spaces at that temperature and that of the skin meet at the contact temperature.
    let meet_c = (static_c * ceramic + 34.0 * skin) / (ceramic + skin);
    assert!((meet_c - contact_c).abs() < 1e-9);
}

#[test]
fn hos_and_yamamotos_ideal_displays_hold_the_contact_temperature() {
    for display in [Display::HoChapter4, Display::Yamamoto] {
        let course = ideal(display, "copper", Tissue::HalfSpace);
        // Thesis, Table 4-1 and Eq. 3-1: 34 and 24 °C meet at 24.31 °C on copper.
        assert!((course.at(0.0) - 24.307).abs() < 2e-3, "{}", course.at(0.0));
        assert_eq!(course.at(0.0), course.at(10.0));
    }
}

#[test]
fn yangs_course_is_that_of_the_contact_model_at_depth_under_great_pressure() {
    for material in ["copper", "granite", "abs", "foam"] {
        let (_, touch) = touch(material, Tissue::HalfSpace);
        let course = ideal(Display::Yang, material, Tissue::HalfSpace);
        // Under 1 GPa the resistance is some 1e-9 m² K/W.
        let contact = contact(&touch, 1e9);
        for t_s in [0.0, 0.1, 1.0, 3.0, 10.0] {
            let exact_c = contact.skin_at_depth(&SKIN, 1.24e-3, t_s);
            assert!(
                (course.at(t_s) - exact_c).abs() < 1e-4,
                "{material} {t_s} s: {} {exact_c}",
                course.at(t_s)
            );
        }
    }
}

#[test]
fn inos_recording_on_a_half_space_is_the_skin_of_eq_6_5() {
    for material in ["copper", "abs"] {
        let (_, touch) = touch(material, Tissue::HalfSpace);
        let course = ideal(Display::Ino, material, Tissue::HalfSpace);
        let contact = contact(&touch, pressure_pa(2.0));
        for t_s in [0.02, 0.5, 10.0] {
            let difference_k: f64 = course.at(t_s) - contact.at(t_s).skin_c;
            assert!(difference_k.abs() < 0.1e-3, "{material} {t_s} s: {difference_k} K");
        }
    }
}

#[test]
fn caldwells_recording_lags_behind_inos_by_its_time_constant() {
    let (fast, slow) = (
        ideal(Display::Ino, "granite", Tissue::HalfSpace),
        ideal(Display::Caldwell, "granite", Tissue::HalfSpace),
    );
    // The integral of `fast - slow` over time is the time constant times the fall of `slow`, for any first-order sensor.
    let mut lag_ks = 0.0;
    for ms in 0..10_000 {
        let t_s = (f64::from(ms) + 0.5) / 1e3;
        lag_ks += (fast.at(t_s) - slow.at(t_s)) / 1e3;
    }
    let time_constant_s = lag_ks / (slow.at(10.0) - slow.at(0.0));
    assert!((time_constant_s - 4.0 / 3.0).abs() < 2e-3, "{time_constant_s}");
}

#[test]
fn a_ladder_of_many_cells_is_the_half_space() {
    for material in ["copper", "granite", "abs", "foam"] {
        let (_, touch) = touch(material, Tissue::HalfSpace);
        let contact = contact(&touch, pressure_pa(2.0));
        let error_k = |order: u32, from_s: f64| {
            let course = RcLadder { order }.skin(&touch);
            let times = (1..=100).map(|i| from_s + (10.0 - from_s) * f64::from(i) / 100.0);
            times
                .map(|t_s: f64| (course.at(t_s) - contact.at(t_s).skin_c).abs())
                .fold(0.0, f64::max)
        };
        let errors = [50, 200, 800].map(|order| error_k(order, 0.2));
        // From 0.2 s on the cells of 4 times as many are resolved: the error falls with the square, to the 0.02 mK that
        // the finite depth of three diffusion lengths, erfc(3), leaves.
        assert!(errors[2] < 1e-3, "{material}: {errors:?}");
        assert!(errors[1] < errors[0] / 8.0, "{material}: {errors:?}");
        // Ten cells do not resolve the first second, which matters where the contact resistance is not most of all.
        assert!(material == "foam" || error_k(10, 0.05) > 0.02, "{material}");
    }
}

#[test]
fn a_ladder_begins_as_a_divider_of_its_resistors() {
    let (_, touch) = touch("granite", Tissue::HalfSpace);
    let course = RcLadder { order: 10 }.skin(&touch);
    // Half a cell of skin, the contact, half a cell of granite, by hand: 3 sqrt(alpha 10 s) / 10 / 2 / k.
    let half = |k: f64, alpha: f64| 3.0 * (alpha * 10.0_f64).sqrt() / 20.0 / k;
    let (skin, granite) = (half(0.37, 1e-7), half(2.79, 2.79 / (2630.0 * 775.0)));
    let contact = contact(&touch, pressure_pa(2.0)).resistance_m2k_w;
    let exact_c = 34.0 - 10.0 * skin / (skin + contact + granite);
    assert!((course.at(0.0) - exact_c).abs() < 1e-9, "{} {exact_c}", course.at(0.0));
}

#[test]
fn the_layered_finger_meets_the_object_at_the_contact_temperature_of_its_epidermis() {
    // Effusivity of the epidermis by hand: sqrt(0.21 * 1110 * 3600).
    let (epidermis, granite) = (916.056, 2_384.685);
    let contact_c = (24.0 * granite + 34.0 * epidermis) / (granite + epidermis);
    let course = ideal(Display::LayeredBioHeat, "granite", Tissue::Layered);
    for t_s in [0.0, 0.02, 0.1] {
        assert!(
            (course.at(t_s) - contact_c).abs() < 0.05,
            "{t_s} s: {} {contact_c}",
            course.at(t_s)
        );
    }
    // Heat from depth and blood: later it is warmer than two half-spaces would be.
    assert!(course.at(10.0) > contact_c + 0.05, "{}", course.at(10.0));
}

#[test]
fn ours_is_eq_6_12_for_a_half_space_and_another_course_for_layers() {
    let eq_6_12 = ideal(Display::HoChapter6, "abs", Tissue::Layered);
    assert_eq!(
        ideal(Display::Ours, "abs", Tissue::HalfSpace),
        ideal(Display::HoChapter6, "abs", Tissue::HalfSpace)
    );
    let ours = ideal(Display::Ours, "abs", Tissue::Layered);
    assert!((ours.at(0.0) - eq_6_12.at(0.0)).abs() < 1e-9);
    assert!((ours.at(1.0) - eq_6_12.at(1.0)).abs() > 0.05);
}
