//! A host that assumes a skin other than the finger's: only set-points change, and the display follows them as before.

use system_tests::{between, forces, host, natively, scene};
use thermal_sim::run::Outcome;
use thermal_sim::trace::TraceRow;

const FINGERS: [&str; 2] = ["thesis", "mean"];

fn assert_untripped(outcome: &Outcome, name: &str) {
    let mut states = (outcome.answers.iter()).filter(|(_, answer)| answer.contains(" fault="));
    let (_, state) = states.next_back().expect("an answer to `state`");
    assert!(state.contains(" fault=-"), "{name}: {state}");
}

/// A display held from 0.1 s on, at this temperature at once, under a finger of 34 °C from 4 s on.
fn held(finger: &str, held_c: f64, lines: &[(f64, &str)]) -> Outcome {
    let hold = format!("hold {held_c} 100");
    let all = [&[(0.1, hold.as_str())], lines, &[(9.5, "state")]].concat();
    let tables = forces(&[(4.0, 2.0)])
        + &host(&all)
        + &format!("[device]\ncommissioned = true\nfinger = \"{finger}\"\n");
    let mut scene = scene("copper", 10.0, "", &tables);
    scene.object.appears_t_s = scene.duration_s;
    natively(&scene)
}

fn display_apart_k(a: &Outcome, b: &Outcome) -> f64 {
    let pairs = a.trace.rows().iter().zip(b.trace.rows());
    let apart = pairs.map(|(a, b)| (a.display_c - b.display_c).abs());
    apart.fold(0.0, f64::max)
}

#[test]
fn a_held_display_takes_the_heat_of_the_finger_and_not_of_the_assumed_skin() {
    for finger in FINGERS {
        for held_c in [18.0, 40.0] {
            let sensed = held(finger, held_c, &[]);
            for line in ["skin 15", "skin 42"] {
                let name = format!("{finger}, {held_c} C, {line}");
                // Bare, and under the finger.
                for (t_s, most_k) in [(1.0, 0.0), (6.0, 1e-3)] {
                    let assumed = held(finger, held_c, &[(t_s, line)]);
                    assert_untripped(&assumed, &name);
                    let apart_k = display_apart_k(&assumed, &sensed);
                    println!("{name} at {t_s} s: {:.3} mK apart", 1e3 * apart_k);
                    assert!(apart_k <= most_k, "{name} at {t_s} s: {apart_k} K");
                }
            }
        }
    }
}

/// Largest distance of the display from its set-point from 0.1 s after the landing on, K, and the largest set-point, °C, on
/// granite.
fn followed(finger: &str, line: &str) -> (f64, f64) {
    let tables = forces(&[(2.0, 2.0)])
        + &host(&[(0.1, line), (5.5, "state")])
        + &format!("[device]\ncommissioned = true\nfinger = \"{finger}\"\n");
    let outcome = natively(&scene("granite", 6.0, "", &tables));
    assert_untripped(&outcome, &format!("{finger}, {line}"));
    let setpoint_c = |row: &TraceRow| row.device.as_ref().and_then(|device| device.setpoint_c);
    let followed = between(&outcome, 2.1, 6.0)
        .filter_map(|row| Some((row.display_c, setpoint_c(row)?)))
        .fold((0.0f64, f64::MIN), |(most_k, most_c), (display_c, set_c)| {
            (most_k.max((display_c - set_c).abs()), most_c.max(set_c))
        });
    println!("{finger}, {line}: {followed:?}");
    followed
}

#[test]
fn a_set_point_of_an_assumed_skin_is_followed_as_closely() {
    for finger in FINGERS {
        let (sensed_k, sensed_c) = followed(finger, "skin sensor");
        for (line, above_k) in [("skin 29", -2.0), ("skin 39", 2.0)] {
            let (assumed_k, assumed_c) = followed(finger, line);
            assert!(assumed_k < 1.5 * sensed_k, "{line}: {assumed_k} K");
            assert!((assumed_c - sensed_c) * above_k > 1.0, "{line}: {assumed_c} C");
        }
    }
}
