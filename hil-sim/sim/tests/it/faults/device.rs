//! Faults of a scene on the device, natively, and what a run is judged by.

use thermal_sim::metrics::{Figures, figures};

use super::ran;

fn fault(text: &str) -> String {
    format!("[[fault]]\n{text}\n")
}

fn judged(tables: &str) -> Figures {
    let (scene, outcome) = ran(tables);
    figures(&scene, &outcome)
}

/// The first fault that the device names, and when.
fn named(figures: &Figures) -> Option<(&str, f64)> {
    let first = figures.faults.first()?;
    Some((&first.fault, first.t_s))
}

#[test]
fn comparator_that_cuts_the_supply_is_seen_on_the_fault_pin() {
    let figures = judged(&fault("kind = \"comparator-stuck\"\nt_s = 2"));
    let (fault, t_s) = named(&figures).expect("a fault");
    assert_eq!(fault, "bridge");
    assert!((2.0..2.01).contains(&t_s), "{t_s}");
}

/// 1 K/s: the display's thermistors differ by 3 K after 3 s, and must for 100 ms.
#[test]
fn drift_takes_its_time() {
    let figures = judged(&fault("kind = \"thermistor-drift\"\nt_s = 2\nvalue = -5"));
    let (fault, t_s) = named(&figures).expect("a fault");
    assert_eq!(fault, "displays-apart");
    assert!((4.9..5.4).contains(&t_s), "{t_s}");
}

#[test]
fn fault_passes_at_its_end() {
    for (until, expected) in [("", "err"), ("until_s = 3", "ok")] {
        let open = fault(&format!("kind = \"thermistor-open\"\nt_s = 2\n{until}"));
        let (_, outcome) = ran(&format!("{open}[[host]]\nt_s = 4\nline = \"clear\"\n"));
        let (_, answer) = outcome.answers.last().expect("an answer");
        assert!(answer.starts_with(expected), "{until}: {answer}");
    }
}

/// A sink of 80 deg C heats the skin through a tile that is off. The dose is summed up by itself: 2 to the power of what
/// is above 43 deg C, 4 to the power of what is below.
#[test]
fn dose_and_range_are_those_of_the_rows() {
    let (scene, outcome) = ran(&fault("kind = \"sink-hot\"\nt_s = 1\nvalue = 80"));
    let figures = figures(&scene, &outcome);
    assert_eq!(named(&figures).map(|(fault, _)| fault), Some("sink-hot"));
    let rows = outcome.trace.rows();
    let mut dose_s = 0.0;
    for row in &rows[..rows.len() - 1] {
        let above_k = row.skin_c - 43.0;
        dose_s += match above_k {
            0.0.. => 1e-3 * (above_k * 2f64.ln()).exp(),
            -4.0.. => 1e-3 * (above_k * 4f64.ln()).exp(),
            _ => 0.0,
        };
    }
    assert!(dose_s > 60.0, "{dose_s} s");
    assert!((figures.cem43_min / (dose_s / 60.0) - 1.0).abs() < 1e-9);
    assert!(rows.iter().any(|row| row.display_c == figures.display_c.max));
    assert!(rows.iter().any(|row| row.display_c == figures.display_c.min));
    assert!(figures.display_c.max > 50.0 && figures.display_c.min < 30.0);
    assert!(rows.iter().all(|row| row.skin_c <= figures.skin_c.max));
}

#[test]
fn harmless_run_has_no_dose() {
    assert_eq!(judged("").cem43_min, 0.0);
}
