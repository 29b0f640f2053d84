//! The device holds its display at a constant temperature without oscillation, with display thermistors of 0.02 to 0.5 s lag.

use documented_figures::assert_figure;
use system_tests::{between, natively, scene};

/// Commissioning identifies the lag. The display is held at the preset of a warm and of a cool object; only the noise of the
/// converter moves it.
#[test]
fn a_held_display_stays_within_4_mk_and_its_current_within_200_ma() {
    let (mut moves_k, mut moves_a) = (0.0f64, 0.0f64);
    for lag_s in [0.02, 0.1, 0.5] {
        for start_c in [22.0, 40.0] {
            let plant =
                format!("[plant.sensors]\ndisplay.lag_s = {lag_s}\ncheck.lag_s = {lag_s}\n");
            let mut scene = scene("granite", 10.0, "settle_s = 60", &plant);
            scene.object.start_c = Some(start_c);
            let outcome = natively(&scene);
            let rows = || between(&outcome, 0.0, 10.0);
            let preset_c = scene.exact_setpoint_c(0.0, 2.0);
            let (mut low_c, mut high_c, mut low_a, mut high_a) =
                (f64::MAX, f64::MIN, f64::MAX, f64::MIN);
            for row in rows() {
                (low_c, high_c) = (low_c.min(row.display_c), high_c.max(row.display_c));
                (low_a, high_a) = (low_a.min(row.current_a), high_a.max(row.current_a));
            }
            println!(
                "lag {lag_s} s, object of {start_c} C: display {:.2} mK, current {:.1} mA, off its preset by {:.2} and \
                 {:.2} mK",
                1e3 * (high_c - low_c),
                1e3 * (high_a - low_a),
                1e3 * (low_c - preset_c),
                1e3 * (high_c - preset_c)
            );
            (moves_k, moves_a) = (moves_k.max(high_c - low_c), moves_a.max(high_a - low_a));
        }
    }
    assert_figure("law.noisy_display", 1e3 * moves_k);
    assert_figure("law.noisy_current", moves_a);
}
