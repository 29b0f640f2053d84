//! The finger on a tile that follows its course exactly.

use contact_model::material::SKIN;
use contact_model::pressure::pressure_pa;
use contact_model::reference::{Contact, erfcx};
use earlier_displays::{Display, SingleContact, Tissue, scene, skin_on_ideal_tile};
use thermal_client::course::{Course, CoursePoint};

#[test]
fn the_course_of_eq_6_12_brings_the_skin_to_eq_6_5() {
    for material in ["copper", "granite", "abs", "foam"] {
        let scene = scene(material, Tissue::HalfSpace);
        let touch = SingleContact::of(&scene).expect("one contact");
        let course = Display::HoChapter6.ideal_course(&scene, &touch).expect("a plant");
        let skin_c = skin_on_ideal_tile(&touch, &course).expect("a plant");
        let contact =
            Contact::new((&SKIN, 34.0), (&touch.object, 24.0), &touch.display, pressure_pa(2.0));
        assert_eq!(skin_c.len(), 10_001);
        for (ms, skin_c) in skin_c.iter().enumerate().skip(50) {
            let exact_c = contact.at(ms as f64 / 1e3).skin_c;
            assert!((skin_c - exact_c).abs() < 0.4e-3, "{material} {ms} ms: {skin_c} {exact_c}");
        }
    }
}

#[test]
fn skin_on_a_constant_surface_follows_the_error_function() {
    // A half-space with effusivity e behind a resistance R, on a surface that is 6 K colder:
    // the skin falls by 6 K (1 - erfcx(sqrt t / (R e))).
    let scene = scene("granite", Tissue::HalfSpace);
    let touch = SingleContact::of(&scene).expect("one contact");
    let course = Course::new(vec![CoursePoint { t_s: 0.0, celsius: 28.0 }]).expect("a course");
    let skin_c = skin_on_ideal_tile(&touch, &course).expect("a plant");
    let resistance: f64 = contact_model::reference::contact_resistance(
        &SKIN.surface,
        &touch.display,
        pressure_pa(2.0),
    );
    for ms in [20, 50, 200, 1000, 10_000] {
        let z = (f64::from(ms) / 1e3).sqrt() / (resistance * SKIN.effusivity());
        let exact_c = 34.0 - 6.0 * (1.0 - erfcx::<f64>(z));
        let skin_c = skin_c[ms as usize];
        assert!((skin_c - exact_c).abs() < 0.1e-3, "{ms} ms: {skin_c} {exact_c}");
    }
}
