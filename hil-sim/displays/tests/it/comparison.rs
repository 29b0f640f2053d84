//! Displays side by side.

use contact_model::material::THESIS_MATERIALS;
use documented_figures::{assert_figure, assert_row};
use earlier_displays::{Comparison, Display, Report, Tissue, scene, table};
use thermal_sim::NativeRunner;

fn run(display: Display, material: &str, tissue: Tissue) -> Comparison {
    let run = Comparison::run(&NativeRunner, &scene(material, tissue), display);
    run.unwrap_or_else(|error| panic!("{error:#}")).0
}

#[test]
fn a_mode_of_the_device_is_compared_with_ours() {
    let rows = [Display::HoChapter4, Display::Ours]
        .map(|display| run(display, "granite", Tissue::HalfSpace));
    let report = Report::new(rows.to_vec());
    let [ho, ours] = report.rows.as_slice() else { panic!("two rows") };
    // Without contact resistance the display is colder than the object would be at once, and the skin follows late.
    assert!(ho.max_mk() > Some(200.0), "{:?}", ho.max_mk());
    assert!(ours.max_mk() < Some(13.0), "{:?}", ours.max_mk());
    // An ideal tile that follows Eq. 6-12 has the errors of plant and ideal tile only.
    assert!(ours.ideal_max_mk() < Some(0.5), "{:?}", ours.ideal_max_mk());
    assert_eq!((ho.better_than_ours, ours.better_than_ours), (Some(false), None));
    assert_eq!((ho.points, ours.course_error_mk), (None, None));
    let text = table(&report);
    assert!(text.contains("ho-2006-chapter-4") && text.contains("ours"), "{text}");
}

/// Largest error on an ideal tile, mK with one decimal.
fn ideal_mk(display: Display, material: &str, tissue: Tissue) -> f64 {
    let row = Comparison::on_ideal_tile(&scene(material, tissue), display);
    let row = row.unwrap_or_else(|error| panic!("{error:#}"));
    (row.ideal_max_mk().expect("a contact of 10 s") * 10.0).round() / 10.0
}

#[test]
fn the_documented_errors_on_an_ideal_tile_are_those_of_the_methods() {
    for tissue in Tissue::ALL {
        for display in Display::ALL {
            let errors_mk: Vec<_> = (THESIS_MATERIALS.into_iter())
                .map(|material| ideal_mk(display, material, tissue))
                .collect();
            let display = display.name();
            let key = match tissue {
                Tissue::HalfSpace => format!("ideal-display-half-space.{display}"),
                Tissue::Layered => format!("ideal-display-layered.{display}"),
            };
            assert_row(&key, &errors_mk);
        }
    }
}

#[test]
fn layers_without_resistance_are_better_than_ours_in_a_moist_contact() {
    let mut scene = scene("copper", Tissue::Layered);
    scene.params.contact.gap_w_m2k = 1000.0;
    let rows = [Display::LayeredBioHeat, Display::Ours].map(|display| {
        let run = Comparison::run(&NativeRunner, &scene, display);
        run.unwrap_or_else(|error| panic!("{error:#}")).0
    });
    let report = Report::new(rows.to_vec());
    let [layers, ours] = report.rows.as_slice() else { panic!("two rows") };
    assert_figure("moist-contact.layers", layers.max_mk().expect("a contact"));
    assert_figure("moist-contact.ours", ours.max_mk().expect("a contact"));
    assert_eq!(layers.better_than_ours, Some(true));
    assert!(table(&report).contains('*'));
}

#[test]
fn a_course_is_played_by_the_device_as_on_the_ideal_tile() {
    // A slow course that the tile can follow: the skin on the device is that on the ideal tile.
    let slow = run(Display::Yang, "foam", Tissue::HalfSpace);
    assert!(slow.faults.is_empty() && slow.refused_lines.is_empty(), "{slow:?}");
    assert!(slow.points <= Some(128) && slow.course_error_mk < Some(0.5), "{slow:?}");
    let (device_mk, ideal_mk) =
        (slow.max_mk().expect("a contact"), slow.ideal_max_mk().expect("a contact"));
    assert!((device_mk - ideal_mk).abs() < 5.0, "{device_mk} {ideal_mk}");
}
