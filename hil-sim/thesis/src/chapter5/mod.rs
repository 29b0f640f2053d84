//! Chapter 5: the infrared windows, the skin on them, and the instrument.

mod infrared;

use crate::case::{Case, sample};
use crate::chapter4::opening;
use crate::row::{Remark, Row};
use crate::stated::{Stated, printed};

pub(super) fn rows() -> Vec<Row> {
    let opening = opening("Section 5.2.1", 7.5, 10.0, printed(240.0, -1));
    [
        table_5_1(),
        vec![opening],
        skin_on_window(),
        infrared::table_5_3(),
        infrared::limits(),
        sampling(),
        infrared::round_trips(),
    ]
    .concat()
}

fn table_5_1() -> Vec<Row> {
    let windows = [
        ("baf2", (11.7, 4890.0, 410.0, 4843.0, 0.008, 0.009)),
        ("zns", (27.2, 4090.0, 515.0, 7569.0, 0.006, 0.006)),
    ];
    let mut rows = Vec::new();
    for (key, (conductivity, density, specific_heat, effusivity, roughness, slope)) in windows {
        let sample = sample(key);
        let row = |what: &str, unit, stated, computed| {
            Row::new(
                "Table 5-1",
                format!("{}, {what}", sample.name),
                unit,
                stated,
                computed,
            )
        };
        let surface = sample.material.surface;
        rows.extend([
            row(
                "conductivity",
                "W/(m K)",
                printed(conductivity, 1),
                surface.conductivity_w_mk,
            ),
            row(
                "density",
                "kg/m³",
                printed(density, 0),
                sample.material.density_kg_m3,
            ),
            row(
                "specific heat",
                "J/(kg K)",
                printed(specific_heat, 0),
                sample.material.specific_heat_j_kgk,
            ),
            row(
                "contact coefficient",
                "J/(m² s^½ K)",
                printed(effusivity, 0),
                sample.material.effusivity(),
            )
            .remark(Remark::Cut),
            row("Rq", "µm", printed(roughness, 3), surface.roughness_um),
            row(
                "asperity slope",
                "rad",
                printed(slope, 3),
                surface.slope_rad,
            ),
        ]);
    }
    rows
}

/// "The skin surface temperature for 10 s of contact should be around 27 °C" from 34 and 24 °C.
fn skin_on_window() -> Vec<Row> {
    let rows = ["baf2", "zns"].map(|key| {
        let sample = sample(key);
        let case = Case {
            object_c: 24.0,
            ..Case::validation(&sample, contact_model::pressure::pressure_pa(2.0))
        };
        let stated = Stated::About {
            value: 27.0,
            within: 0.5,
        };
        let skin_c = case.contact().at(10.0).skin_c;
        Row::new(
            "Section 5.2.2",
            format!("{}, skin at 10 s, 2 N", sample.name),
            "°C",
            stated,
            skin_c,
        )
    });
    rows.into()
}

/// Section 5.2.4: what the camera must resolve for detail of 1.25 per millimetre.
fn sampling() -> Vec<Row> {
    let detail_per_mm = 1.25;
    let sampling_per_mm = 2.0 * detail_per_mm;
    vec![
        Row::new(
            "Section 5.2.4",
            "sampling for detail of 1.25/mm",
            "1/mm",
            printed(2.5, 1),
            sampling_per_mm,
        ),
        Row::new(
            "Section 5.2.4",
            "its pitch",
            "µm",
            printed(400.0, 0),
            1e3 / sampling_per_mm,
        ),
    ]
}
