//! Tables 3-1 and 3-4: properties, contact coefficient, interface temperature, Fourier number.

use contact_model::material::SKIN;
use contact_model::reference::{fourier_number, interface_temperature};

use crate::case::{Sample, five, sample};
use crate::row::{Correction, Remark, Row};
use crate::stated::{Stated, printed};

const CONDUCTIVITY: &str = "W/(m K)";
const DENSITY: &str = "kg/m³";
const SPECIFIC_HEAT: &str = "J/(kg K)";
pub(crate) const EFFUSIVITY: &str = "J/(m² s^½ K)";

/// Skin and material of Tables 3-1 and 3-4 before contact, °C.
const BEFORE_C: (f64, f64) = (33.0, 24.0);

/// Characteristic length of Table 3-1, m. The thesis does not print it; all six numbers need 12.706 to 12.723 mm,
/// which none of the stated dimensions is.
const LENGTH_3_1_M: f64 = 12.71e-3;
/// Thickness of the samples of sections 3.3 and 4.3, m.
const THICKNESS_M: f64 = 38e-3;
/// What Table 3-4's numbers need instead of the stated thickness, m: 149.2 to 153.8 mm.
const LENGTH_3_4_M: f64 = 151.4e-3;

/// One column of a table of materials as printed.
struct Printed {
    key: &'static str,
    conductivity: (f64, i32),
    density: f64,
    specific_heat: f64,
    effusivity: f64,
    interface_c: f64,
    fourier: Stated,
}

fn column(
    key: &'static str,
    conductivity: (f64, i32),
    density: f64,
    specific_heat: f64,
    effusivity: f64,
    interface_c: f64,
    fourier: Stated,
) -> Printed {
    Printed {
        key,
        conductivity,
        density,
        specific_heat,
        effusivity,
        interface_c,
        fourier,
    }
}

pub(super) fn table_3_1() -> Vec<Row> {
    let columns = [
        column(
            "copper",
            (398.0, 0),
            8954.0,
            384.0,
            36992.0,
            24.3,
            printed(3.58, 2),
        ),
        column(
            "bronze",
            (54.0, 0),
            8780.0,
            355.0,
            12973.0,
            24.7,
            printed(0.54, 2),
        ),
        column(
            "stainless-steel",
            (13.5, 1),
            8000.0,
            460.0,
            7048.0,
            25.3,
            printed(0.11, 2),
        ),
        column(
            "g10",
            (0.29, 2),
            1800.0,
            1600.0,
            910.0,
            29.0,
            printed(0.003, 3),
        ),
        column(
            "abs",
            (0.18, 2),
            1010.0,
            1386.0,
            501.0,
            30.3,
            printed(0.004, 3),
        ),
        column(
            "foam",
            (0.029, 3),
            24.0,
            1210.0,
            29.0,
            32.8,
            printed(0.03, 2),
        ),
    ];
    let mut rows = Vec::new();
    for printed_column in &columns {
        let sample = sample(printed_column.key);
        rows.extend(properties("Table 3-1", &sample, printed_column));
        let row = Row::new(
            "Table 3-1",
            format!("{}, Fourier number, 5 s", sample.name),
            "",
            printed_column.fourier,
            fourier_number(&sample.material, LENGTH_3_1_M, 5.0),
        );
        rows.push(
            row.note("with L_c = 12.71 mm, which the row needs and the thesis does not state"),
        );
    }
    rows
}

pub(super) fn table_3_4() -> Vec<Row> {
    let columns = [
        column(
            "copper",
            (398.0, 0),
            8954.0,
            384.0,
            36992.0,
            24.3,
            printed(0.05, 2),
        ),
        column(
            "stainless-steel",
            (13.5, 1),
            8000.0,
            460.0,
            7048.0,
            25.3,
            printed(0.0016, 4),
        ),
        column(
            "granite",
            (2.79, 2),
            2630.0,
            775.0,
            2384.0,
            27.0,
            Stated::Below(0.001),
        ),
        column(
            "abs",
            (0.18, 2),
            1010.0,
            1386.0,
            501.0,
            30.3,
            Stated::Below(0.001),
        ),
        column(
            "foam",
            (0.029, 3),
            24.0,
            1210.0,
            29.0,
            32.8,
            Stated::Below(0.001),
        ),
    ];
    let mut rows = Vec::new();
    for printed_column in &columns {
        let sample = sample(printed_column.key);
        rows.extend(properties("Table 3-4", &sample, printed_column));
        let row = Row::new(
            "Table 3-4",
            format!("{}, Fourier number, 10 s, L_c = 38 mm", sample.name),
            "",
            printed_column.fourier,
            fourier_number(&sample.material, THICKNESS_M, 10.0),
        );
        rows.push(row.wrong(
            "not of samples 38 mm thick, as stated; the row needs L_c = 151.4 mm",
            Correction::Is(fourier_number(&sample.material, LENGTH_3_4_M, 10.0)),
        ));
    }
    rows
}

fn properties(place: &'static str, sample: &Sample, stated: &Printed) -> [Row; 5] {
    let Sample { name, material } = sample;
    let row = |what: &str, unit, printed, computed| {
        Row::new(place, format!("{name}, {what}"), unit, printed, computed)
    };
    let (skin_c, object_c) = BEFORE_C;
    let effusivity = row(
        "contact coefficient",
        EFFUSIVITY,
        printed(stated.effusivity, 0),
        material.effusivity(),
    );
    let interface = row(
        "interface",
        "°C",
        printed(stated.interface_c, 1),
        interface_temperature(&SKIN, skin_c, material, object_c),
    );
    let is_g10 = stated.key == "g10";
    [
        row(
            "conductivity",
            CONDUCTIVITY,
            printed(stated.conductivity.0, stated.conductivity.1),
            material.surface.conductivity_w_mk,
        ),
        row(
            "density",
            DENSITY,
            printed(stated.density, 0),
            material.density_kg_m3,
        ),
        row(
            "specific heat",
            SPECIFIC_HEAT,
            printed(stated.specific_heat, 0),
            material.specific_heat_j_kgk,
        ),
        if is_g10 {
            effusivity.wrong(
                "does not follow from the properties above it",
                Correction::Reads(printed(914.0, 0)),
            )
        } else {
            effusivity.remark(Remark::Cut)
        },
        if is_g10 {
            interface.wrong(
                "not what Eq. 3-1 gives",
                Correction::Reads(printed(29.1, 1)),
            )
        } else {
            interface
        },
    ]
}

/// "These sample dimensions were chosen to make the Fourier numbers of all the materials smaller than 0.05."
pub(super) fn fourier_claims() -> Vec<Row> {
    let claim = |place, sample: &Sample| {
        let row = Row::new(
            place,
            format!("{}, Fourier number, 10 s, 38 mm thick", sample.name),
            "",
            Stated::Below(0.05),
            fourier_number(&sample.material, THICKNESS_M, 10.0),
        );
        if sample.name == "copper" {
            row.wrong(
                "copper is not a half-space here",
                Correction::Reads(printed(0.80, 2)),
            )
        } else {
            row
        }
    };
    let five = five();
    let four = five.iter().filter(|sample| sample.name != "foam");
    (five.iter().map(|sample| claim("Section 3.3.1", sample)))
        .chain(four.map(|sample| claim("Section 4.3.1", sample)))
        .collect()
}
