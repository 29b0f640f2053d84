//! The release image takes the bridge off when a sensor fails.

use system_tests::{between, forces, on_image, scene};

#[test]
fn broken_display_thermistor_ends_the_current_and_is_named() {
    for (kind, named) in [
        ("thermistor-open", "display-open"),
        ("thermistor-short", "display-short"),
    ] {
        let tables = forces(&[(0.5, 2.0)]) + &format!("[[fault]]\nkind = \"{kind}\"\nt_s = 1.0\n");
        let outcome = on_image(&scene("copper", 2.0, "", &tables));
        let driven = between(&outcome, 0.9, 1.0)
            .filter(|row| row.current_a != 0.0)
            .count();
        assert_eq!(driven, 100, "the bridge drives before the fault");
        // One tick of samples, one to convert and set, and the boundary after it.
        for row in between(&outcome, 1.003, 2.0) {
            let device = row.device.as_ref().expect("telemetry of every tick");
            assert_eq!(row.current_a, 0.0, "{kind} at {} s", row.t_s);
            assert_eq!(
                (device.state.as_str(), device.remark.as_deref()),
                ("tripped", Some(named))
            );
            assert_eq!(device.setpoint_c, None);
        }
    }
}

/// The over-temperature trip is what is left when the bridge works against its command.
#[test]
fn swapped_polarity_trips_before_the_skin_is_hurt() {
    let tables = forces(&[(0.5, 2.0)]) + "[[fault]]\nkind = \"polarity-swapped\"\nt_s = 1.0\n";
    let outcome = on_image(&scene("copper", 4.0, "", &tables));
    let last = outcome
        .trace
        .rows()
        .last()
        .and_then(|row| row.device.as_ref())
        .expect("telemetry");
    assert_eq!(last.state, "tripped");
    for row in outcome.trace.rows() {
        assert!(
            (13.0..45.0).contains(&row.skin_c),
            "skin {} C at {} s",
            row.skin_c,
            row.t_s
        );
    }
}
