//! A thermoelectric module that loses most of its cooling power is detected before the display departs far from a sound one.

use system_tests::{forces, natively, scene};

/// At the current limit a controller with a high gain, as with a fast thermistor, corrects its own model, so that the residual
/// alone stays small.
#[test]
fn a_weak_module_trips_while_its_display_is_near_that_of_a_sound_one() {
    /// The limit of the fault list, 4 K, plus 50 ms at 16 K/s, which 6 A cause.
    const NEAR_K: f64 = 4.0 + 0.05 * 16.0;
    let quick = "[plant]\nsensors.display.lag_s = 0.024\nsensors.check.lag_s = 0.024\n";
    let weak = "[[fault]]\nkind = \"module-weak\"\nvalue = 0.1\nt_s = 1.002\n";
    let [sound, weak] = ["", weak].map(|fault| {
        let mut scene = scene("copper", 3.0, "", &(forces(&[(0.2, 2.0)]) + fault + quick));
        scene.object.appears_t_s = 1.0;
        natively(&scene)
    });
    let rows = || weak.trace.rows().iter().zip(sound.trace.rows());
    let driven = rows()
        .rposition(|(weak, _)| weak.current_a != 0.0)
        .expect("the bridge drives before the fault");
    for (weak, sound) in rows().take(driven + 1) {
        let apart_k = (weak.display_c - sound.display_c).abs();
        assert!(apart_k < NEAR_K, "{apart_k} K at {} s, driven", weak.t_s);
    }
    let last = weak.trace.rows().last().and_then(|row| row.device.as_ref());
    let remark = last.and_then(|device| device.remark());
    assert_eq!(remark, Some("unlike-model"));
}
