//! Displays side by side.

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
    let [ho, ours] = report.rows.as_slice() else {
        panic!("two rows")
    };
    // Without contact resistance the display is colder than the object would be at once, and the skin follows late.
    assert!(ho.max_mk() > Some(200.0), "{:?}", ho.max_mk());
    assert!(ours.max_mk() < Some(13.0), "{:?}", ours.max_mk());
    // An ideal tile that follows Eq. 6-12 has the errors of plant and ideal tile only.
    assert!(ours.ideal_max_mk() < Some(0.5), "{:?}", ours.ideal_max_mk());
    assert_eq!(
        (ho.better_than_ours, ours.better_than_ours),
        (Some(false), None)
    );
    assert_eq!((ho.points, ours.course_error_mk), (None, None));
    let text = table(&report);
    assert!(
        text.contains("ho-2006-chapter-4") && text.contains("ours"),
        "{text}"
    );
}
