//! The release image switches the bridge off when a sensor, the bridge or the converter fails, and limits the thermal dose.

use image_tests::on_image;
use system_tests::{between, forces, host, scene};
use thermal_sim::trace::TraceRow;

#[test]
fn a_broken_display_thermistor_ends_the_current_and_is_reported() {
    for (kind, named) in
        [("thermistor-open", "display-open"), ("thermistor-short", "display-short")]
    {
        let tables = forces(&[(0.5, 2.0)]) + &format!("[[fault]]\nkind = \"{kind}\"\nt_s = 1.0\n");
        let outcome = on_image(&scene("copper", 2.0, "", &tables));
        let driven = between(&outcome, 0.9, 1.0).filter(|row| row.current_a != 0.0).count();
        assert_eq!(driven, 100, "the bridge drives before the fault");
        // One tick of samples, one to convert and set, and the boundary after it.
        for row in between(&outcome, 1.003, 2.0) {
            let device = row.device.as_ref().expect("telemetry of every tick");
            assert_eq!(row.current_a, 0.0, "{kind} at {} s", row.t_s);
            assert_eq!((device.state.name(), device.remark()), ("tripped", Some(named)));
            assert_eq!(device.setpoint_c, None);
        }
    }
}

/// A bridge that works against its command.
#[test]
fn swapped_polarity_trips_before_the_skin_leaves_13_to_45_c() {
    let tables = forces(&[(0.5, 2.0)]) + "[[fault]]\nkind = \"polarity-swapped\"\nt_s = 1.0\n";
    let outcome = on_image(&scene("copper", 4.0, "", &tables));
    let last = outcome.trace.rows().last().and_then(|row| row.device.as_ref()).expect("telemetry");
    assert_eq!(last.state.name(), "tripped");
    let tripped = |row: &&TraceRow| {
        row.device.as_ref().is_some_and(|device| device.state.name() == "tripped")
    };
    // The tick that trips is followed by at most one step of the plant with its old duty.
    for row in outcome.trace.rows().iter().filter(tripped).skip(2) {
        assert_eq!(row.current_a, 0.0, "at {} s", row.t_s);
    }
    for row in outcome.trace.rows() {
        assert!(
            (12.0..46.0).contains(&row.display_c),
            "display {} C at {} s",
            row.display_c,
            row.t_s
        );
        assert!((13.0..45.0).contains(&row.skin_c), "skin {} C at {} s", row.skin_c, row.t_s);
    }
}

/// With a converter that repeats its last samples, the controller would integrate the last error without end.
#[test]
fn a_frozen_converter_trips_before_the_display_drifts() {
    let tables = forces(&[(0.5, 2.0)]) + "[[fault]]\nkind = \"adc-stuck\"\nt_s = 0.8\n";
    let outcome = on_image(&scene("copper", 3.0, "", &tables));
    let frozen = outcome.trace.rows().iter().find(|row| {
        row.device.as_ref().is_some_and(|device| device.remark() == Some("samples-frozen"))
    });
    assert!(frozen.is_some_and(|row| row.t_s < 0.86), "{:?}", frozen.map(|row| row.t_s));
    for row in between(&outcome, 0.86, 3.0) {
        assert_eq!(row.current_a, 0.0, "at {} s", row.t_s);
        assert!((15.0..42.0).contains(&row.display_c), "display {} C", row.display_c);
    }
}

/// A display held at 42 °C reaches the limit of the thermal dose after two minutes, with a restart in between.
#[test]
fn the_thermal_dose_survives_a_restart() {
    let lines = [
        (0.1, "hold 42"),
        (100.0, "abort"),
        (100.2, "save"),
        (101.0, "stream 1"),
        (101.2, "arm"),
        (104.0, "hold 42"),
        (159.0, "cause"),
    ];
    let tables = forces(&[(0.2, 2.0)]) + &host(&lines);
    let mut scene = scene("copper", 160.0, "", &tables);
    scene.object.appears_t_s = scene.duration_s;
    let outcome = on_image(&scene);
    let mut said = outcome.answers.iter().map(|(_, said)| said);
    assert!(said.any(|said| said.starts_with("ok cause=dose")), "{:?}", outcome.answers);
    let driven_s =
        (outcome.trace.rows().iter()).rfind(|row| row.current_a != 0.0).expect("driven").t_s;
    assert!((130.0..150.0).contains(&driven_s), "{driven_s}");
}
