//! Section 6.4: pressures, the fall of the skin's temperature on BaF2 and ZnS, and how soon it is steady.

use contact_model::pressure::{STATED, contact_area_m2};

use crate::case::{Case, sample};
use crate::row::{Correction, Row};
use crate::stated::{Stated, cut, printed};

const WINDOWS: [&str; 2] = ["baf2", "zns"];
/// How far below 100 % of its fall a temperature still passes for steady, %.
const STEADY_PERCENT: f64 = 5.0;

/// What section 6.4.1 simulates with, beside what its procedure measured: "they are the average skin and contact material temperatures in this experiment."
pub(super) fn conditions() -> Vec<Row> {
    vec![
        Row::new(
            "Section 6.4.1",
            "mean skin before contact, as the procedure has it",
            "°C",
            printed(34.0, 0),
            34.6,
        )
        .wrong(
            "the same section contradicts itself",
            Correction::Reads(printed(34.6, 1)),
        ),
        Row::new(
            "Section 6.4.1",
            "mean window before contact, as the procedure has it",
            "°C",
            printed(26.0, 0),
            25.9,
        ),
    ]
}

/// Areas behind the stated pressures.
pub(super) fn pressures() -> Vec<Row> {
    let area_mm2 = |force_n| contact_area_m2(force_n) * 1e6;
    let growth = area_mm2(2.0) - area_mm2(0.1);
    let below_1n = (area_mm2(1.0) - area_mm2(0.1)) / growth * 100.0;
    let stated = [730.0, 1680.0, 3140.0, 5900.0, 10_980.0];
    let pressures = STATED
        .iter()
        .zip(stated)
        .map(|((force_n, pressure_pa), stated)| {
            Row::new(
                "Section 6.4.2",
                format!("pressure of the model at {force_n} N"),
                "Pa",
                printed(stated, -1),
                *pressure_pa,
            )
        });
    let mut rows: Vec<Row> = pressures.collect();
    rows.extend([
        Row::new(
            "Section 6.4.2",
            "growth of the area from 0.1 to 2 N",
            "mm²",
            printed(50.0, -1),
            growth,
        ),
        Row::new(
            "Section 6.4.2",
            "part of it below 1 N",
            "%",
            printed(70.0, -1),
            below_1n,
        ),
    ]);
    rows
}

/// Figures 6-13 and 6-19: model falls within 10 s beside what the text says of model and measurement.
pub(super) fn falls() -> Vec<Row> {
    let [baf2, zns] = WINDOWS.map(sample);
    let firmest_pa = STATED[4].1;
    let fall = |window, pressure_pa| Case::validation(window, pressure_pa).drop_k(10.0);
    let mut rows = vec![Row::new(
        "Figure 6-13",
        "skin on BaF2 minus skin on ZnS at 10 s, 2 N",
        "K",
        Stated::About {
            value: 0.0,
            within: 0.5,
        },
        fall(&zns, firmest_pa) - fall(&baf2, firmest_pa),
    )];
    for window in [&baf2, &zns] {
        let falls = STATED.map(|(_, pressure_pa)| fall(window, pressure_pa));
        for ((_, pressure_pa), fall_k) in STATED.iter().zip(falls) {
            let (what, stated) = match pressure_pa * 1e-3 {
                // Underestimated: below all that was measured.
                kpa if kpa < 1.0 => ("model below the measured 3 to 5 K", Stated::Below(3.0)),
                // Underestimated: measured the same as at 5.90 kPa, where it is within 1 K of the model.
                kpa if kpa < 3.0 => (
                    "model below the measured",
                    Stated::Below(cut(falls[3] - 1.0, 2)),
                ),
                _ => (
                    "model within 1 K of 3 to 5 K",
                    Stated::Between {
                        low: 2.0,
                        high: 6.0,
                    },
                ),
            };
            rows.push(Row::new(
                "Figure 6-19",
                format!("{}, {:.2} kPa, {what}", window.name, pressure_pa * 1e-3),
                "K",
                stated,
                fall_k,
            ));
        }
        let slope =
            |from: usize, to: usize| (falls[to] - falls[from]) / (STATED[to].1 - STATED[from].1);
        rows.push(Row::new(
            "Figure 6-19",
            format!(
                "{}, rise per kPa above 3.14 kPa over that below",
                window.name
            ),
            "",
            Stated::Below(0.5),
            slope(2, 4) / slope(0, 2),
        ));
    }
    rows
}

/// "The skin temperature approached a steady state value within 2 s of contact", "consistent with the thermal model
/// predictions": part of the fall within 10 s that the model has made by then.
pub(super) fn steadiness() -> Vec<Row> {
    let corrected = [
        [51.0, 58.0, 66.0, 75.0, 84.0],
        [51.0, 57.0, 65.0, 74.0, 83.0],
    ];
    let mut rows = Vec::new();
    for (window, corrected) in WINDOWS.map(sample).iter().zip(corrected) {
        for ((_, pressure_pa), corrected) in STATED.iter().zip(corrected) {
            let case = Case::validation(window, *pressure_pa);
            let row = Row::new(
                "Figure 6-20",
                format!(
                    "{}, {:.2} kPa, part of the 10 s fall made by 2 s",
                    window.name,
                    pressure_pa * 1e-3
                ),
                "%",
                Stated::About {
                    value: 100.0,
                    within: STEADY_PERCENT,
                },
                case.drop_k(2.0) / case.drop_k(10.0) * 100.0,
            );
            rows.push(row.wrong(
                "said of measurement and model alike",
                Correction::Reads(printed(corrected, 0)),
            ));
        }
    }
    rows
}
