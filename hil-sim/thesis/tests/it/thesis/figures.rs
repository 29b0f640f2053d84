//! The curves of the figures against golden values, and the solver behind them.

use serde::Deserialize;
use thermal_thesis::figure::{Figure, Kind, differences, figures};
use thermal_thesis::{Case, ClosedForm, ContactSolver, FiniteVolumes, Surfaces};

use super::{computed, name, table};

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "columns of the golden table")]
struct Contact {
    material: String,
    condition: String,
    #[serde(rename = "T_skin_i_C")]
    skin_before_c: f64,
    #[serde(rename = "T_object_i_C")]
    object_before_c: f64,
    t_s: f64,
    #[serde(rename = "T_skin_s_C")]
    skin_c: f64,
    #[serde(rename = "T_object_s_C")]
    object_c: f64,
    #[serde(rename = "q_W_m2")]
    flux_w_m2: f64,
    #[serde(rename = "T_display_C")]
    display_c: f64,
}

fn contacts() -> Vec<Contact> {
    table(include_str!("../../../../../model/tests/data/contact.csv"))
}

fn closed_form() -> Vec<Figure> {
    figures(&ClosedForm).expect("the closed form")
}

/// The value at `x` of the curve called `label` in figure `number`.
fn point(figures: &[Figure], number: &str, label: &str, x: f64) -> Option<f64> {
    let figure = figures.iter().find(|figure| figure.number == number).expect("the figure");
    let curve = figure.curves.iter().find(|curve| curve.label == label).expect("the curve");
    let point = curve.points.iter().find(|(at, _)| (at - x).abs() < 1e-9);
    point.map(|(_, y)| *y)
}

#[test]
fn curves_of_the_simulation_meet_golden_values() {
    let figures = closed_form();
    let mut checked = 0;
    for golden in contacts() {
        let five = ["copper", "stainless-steel", "granite", "abs", "foam"]
            .contains(&golden.material.as_str());
        if golden.condition != "sim_2N_135mm2"
            || !five
            || golden.object_before_c != 24.0
            || golden.skin_before_c != 34.0
        {
            continue;
        }
        let label = name(&golden.material);
        for (number, exact, allowed) in [
            ("6-6", golden.skin_c, 1e-9),
            ("6-7", golden.object_c, 1e-9),
            ("6-8", golden.flux_w_m2, 1e-8),
            ("6-9", golden.display_c, 1e-9),
        ] {
            if let Some(value) = point(&figures, number, label, golden.t_s) {
                let error = value - exact;
                assert!(
                    error.abs() < allowed,
                    "{number}, {label}, {} s: off by {error:e}",
                    golden.t_s
                );
                checked += 1;
            }
        }
    }
    // Landing, 1 ms, 0.1 s and 10 s are on the curves.
    assert_eq!(checked, 5 * 4 * 4);
}

#[test]
fn curves_and_rows_of_the_validation_meet_golden_values() {
    let figures = closed_form();
    let contacts = contacts();
    let mut checked = 0;
    for (material, part) in [("baf2", "A"), ("zns", "B")] {
        for (condition, label, pressure_pa) in [
            ("val_0.1N", "0.73 kPa (0.1 N)", 730.0),
            ("val_0.5N", "3.14 kPa (0.5 N)", 3140.0),
            ("val_2N", "10.98 kPa (2 N)", 10_980.0),
        ] {
            let golden = |t_s: f64| {
                let found = contacts.iter().find(|golden| {
                    let conditions = (golden.skin_before_c, golden.object_before_c) == (34.0, 26.0);
                    conditions
                        && golden.material == material
                        && golden.condition == condition
                        && golden.t_s == t_s
                });
                found.unwrap_or_else(|| panic!("{material}, {condition}, {t_s} s"))
            };
            let kpa = pressure_pa / 1e3;
            let end = golden(10.0);
            let fall_k = 34.0 - end.skin_c;
            let close = |value: Option<f64>, exact: f64| {
                let value = value.expect("a point of the curve");
                assert!((value - exact).abs() < 1e-9, "{material}, {label}: {value} for {exact}");
            };
            close(point(&figures, &format!("6-20 {part}"), label, 10.0), end.skin_c);
            close(point(&figures, &format!("6-19 {part}"), "at the five pressures", kpa), fall_k);
            let share = (34.0 - golden(2.0).skin_c) / fall_k * 100.0;
            let name = name(material);
            let quantity = format!("{name}, {kpa:.2} kPa, part of the 10 s fall made by 2 s");
            close(Some(computed("Figure 6-20", &quantity)), share);
            checked += 1;
            if condition == "val_2N" {
                close(point(&figures, "6-13 A", &format!("{name}, skin"), 10.0), end.skin_c);
                close(point(&figures, "6-13 A", &format!("{name}, surface"), 10.0), end.object_c);
                close(point(&figures, "6-13 B", name, 10.0), end.flux_w_m2);
            }
        }
    }
    assert_eq!(checked, 6);
}

#[test]
fn every_curve_over_time_is_computed_by_the_solver() {
    /// The closed form with all values increased by one.
    struct Raised;
    impl ContactSolver for Raised {
        fn solve(&self, case: &Case, times_s: &[f64]) -> anyhow::Result<Vec<Surfaces>> {
            let surfaces = ClosedForm.solve(case, times_s)?.into_iter();
            Ok(surfaces
                .map(|at| Surfaces {
                    skin_c: at.skin_c + 1.0,
                    object_c: at.object_c + 1.0,
                    display_c: at.display_c + 1.0,
                    flux_w_m2: at.flux_w_m2 + 1.0,
                })
                .collect())
        }
    }
    let raised = figures(&Raised).expect("the source");
    for (figure, other) in closed_form().iter().zip(&raised) {
        for (curve, other) in figure.curves.iter().zip(&other.curves) {
            // Perfect contact has no solver, and a fall is a difference.
            let perfect =
                figure.number.starts_with("3-2") || curve.label.ends_with("perfect contact");
            let expected = if perfect || figure.number.starts_with("6-19") { 0.0 } else { 1.0 };
            for ((_, y), (_, raised)) in curve.points.iter().zip(&other.points) {
                assert!((raised - y - expected).abs() < 1e-9, "{} {}", figure.number, curve.label);
            }
        }
    }
    let numbers: Vec<_> = raised.iter().map(|figure| figure.number).collect();
    assert_eq!(
        numbers,
        [
            "3-2 A", "3-2 B", "6-6", "6-7", "6-8", "6-9", "6-10", "6-11", "6-12", "6-13 A",
            "6-13 B", "6-19 A", "6-19 B", "6-20 A", "6-20 B"
        ]
    );
}

#[test]
fn error_of_the_solver_is_returned_by_figures() {
    struct Broken;
    impl ContactSolver for Broken {
        fn solve(&self, _: &Case, _: &[f64]) -> anyhow::Result<Vec<Surfaces>> {
            anyhow::bail!("no plant")
        }
    }
    assert_eq!(figures(&Broken).expect_err("no figures").to_string(), "no plant");
}

#[test]
fn line_style_of_every_curve_follows_from_its_label() {
    for figure in closed_form() {
        for curve in figure.curves {
            let expected = match curve.label.rsplit(", ").next() {
                Some("surface" | "model") => Kind::Dashed,
                Some("perfect contact" | "at the five pressures") => Kind::Dots,
                _ => Kind::Line,
            };
            assert_eq!(curve.kind, expected, "{} {}", figure.number, curve.label);
            assert!(!curve.points.is_empty());
        }
    }
}

/// Mesh and steps of the plant in every contact of the thesis's figures.
#[test]
fn finite_volumes_agree_with_the_closed_form_in_every_figure() {
    let differences = differences(&closed_form(), &figures(&FiniteVolumes).expect("the plant"));
    assert_eq!(differences.len(), 13);
    for figure in &differences {
        // 1 mK; of a flux 1e-4 of what it begins with.
        let allowed = if figure.y.contains("flux") { 1e-4 * figure.range } else { 1e-3 };
        assert!(figure.settled < allowed, "{}", figure.text());
        assert!(figure.largest > 0.0 && figure.largest < 50.0 * allowed, "{}", figure.text());
    }
}
