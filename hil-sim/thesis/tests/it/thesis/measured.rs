//! Measurements of the thesis beside the plant.

use documented_figures::assert_figure;
use serde::Deserialize;
use thermal_thesis::measured::{Measurement, Shown};
use thermal_thesis::measurements;

use super::table;

fn all() -> Vec<Measurement> {
    measurements().expect("good plants")
}

/// What a plant gives, by its place in `VARIANTS`.
fn plant(all: &[Measurement], variant: usize, quantity: &str) -> f64 {
    let mut found = all.iter().filter(|row| row.quantity == quantity);
    let row = found.next().unwrap_or_else(|| panic!("no {quantity}"));
    row.plant.expect("in the plant")[variant]
}

#[test]
fn exactly_the_known_measurements_are_shown() {
    #[derive(Deserialize)]
    struct Known {
        verdict: String,
        place: String,
        quantity: String,
    }
    let known: Vec<Known> = table(include_str!("../../data/measured_known.csv"));
    let known: Vec<_> =
        known.iter().map(|row| (&*row.verdict, &*row.place, &*row.quantity)).collect();
    let all = all();
    let found: Vec<_> =
        all.iter().map(|row| (row.shown().word(), row.place, &*row.quantity)).collect();
    assert_eq!(found, known);
    for row in &all {
        assert_eq!(row.why().is_empty(), row.shown() == Shown::Yes, "{row:?}");
    }
    for (name, shown) in [
        ("can", Shown::Yes),
        ("with_gap", Shown::WithGap),
        ("cannot", Shown::No),
        ("not_modelled", Shown::NotModelled),
    ] {
        let count = all.iter().filter(|row| row.shown() == shown).count();
        assert_figure(&format!("measured.{name}"), count as f64);
    }
}

#[test]
fn plant_gives_the_documented_numbers_beside_the_measured_ones() {
    const THESIS: usize = 0;
    const LAYERED: usize = 1;
    const LAYERED_WITH_GAP: usize = 3;
    let all = all();
    let at = |variant, quantity| plant(&all, variant, quantity);
    for (name, value) in [
        ("light", at(THESIS, "BaF2, fall within 10 s at 0.1 N")),
        ("light_layered", at(LAYERED, "BaF2, fall within 10 s at 0.1 N")),
        ("light_gap", at(LAYERED_WITH_GAP, "BaF2, fall within 10 s at 0.1 N")),
        ("firm", at(THESIS, "BaF2, fall within 10 s at 2.0 N")),
        ("firm_layered", at(LAYERED, "BaF2, fall within 10 s at 2.0 N")),
        ("early_light", at(LAYERED, "BaF2, part of the fall within 10 s made by 2 s, at 0.1 N")),
        ("early_firm", at(LAYERED, "BaF2, part of the fall within 10 s made by 2 s, at 2.0 N")),
        (
            "edge_real",
            at(LAYERED, "share of the mean fall within 10 s that an edge at 1.84 K sees, real"),
        ),
        (
            "edge_simulated",
            at(
                LAYERED,
                "share of the mean fall within 10 s that an edge at 1.54 K sees, simulated",
            ),
        ),
        (
            "edge_bronze",
            at(LAYERED, "bronze, share of the fall within 5 s that an edge at 1.44 K sees"),
        ),
        ("foam", at(THESIS, "foam, fall within 5 s, measured at the edge")),
        ("blood", at(LAYERED, "BaF2, fall within 10 s that stopped blood adds at 1.0 N")),
    ] {
        assert_figure(&format!("measured.{name}"), value);
    }
}

/// Against the closed form of half-spaces, whose fall a window of 10 mm nearly reaches and does not exceed.
#[test]
fn thesis_finger_on_a_window_falls_less_than_the_closed_form() {
    use contact_model::material::{REFERENCE_DISPLAY, SKIN, find};
    use contact_model::pressure::pressure_pa;
    use contact_model::reference::Contact;

    let all = all();
    for (name, key) in [("BaF2", "baf2"), ("ZnS", "zns")] {
        let window = find(key).expect("a material");
        for force in ["0.1", "0.25", "0.5", "1.0", "2.0"] {
            let pressure: f64 = pressure_pa(force.parse().expect("a force"));
            let contact = Contact::new((&SKIN, 34.6), (window, 25.9), &REFERENCE_DISPLAY, pressure);
            let closed_k = 34.6 - contact.at(10.0).skin_c;
            let quantity = format!("{name}, fall within 10 s at {force} N");
            let part = plant(&all, 0, &quantity) / closed_k;
            assert!((0.95..1.0).contains(&part), "{quantity}: {part}");
        }
    }
}

#[test]
fn a_verdict_asks_the_fingers_of_one_law_of_the_contact_at_a_time() {
    let all = all();
    let mut row = all
        .into_iter()
        .find(|row| row.quantity == "BaF2, fall within 10 s at 0.1 N")
        .expect("the row");
    for (plant, shown) in [
        (Some([4.0, 9.0, 9.0, 9.0]), Shown::Yes),
        (Some([9.0, 4.0, 9.0, 9.0]), Shown::Yes),
        (Some([9.0, 9.0, 4.0, 9.0]), Shown::WithGap),
        (Some([9.0, 9.0, 9.0, 4.0]), Shown::WithGap),
        (Some([9.0; 4]), Shown::No),
        (None, Shown::NotModelled),
    ] {
        row.plant = plant;
        assert_eq!(row.shown(), shown);
    }
}
