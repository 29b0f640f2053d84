//! Microhardness, and the slope of Eq. 6-13.

use std::f64::consts::PI;

use contact_model::material::{SKIN_MICROHARDNESS_PA, average_slope_rad};

use crate::row::{Correction, Row};
use crate::stated::printed;

/// Weight of a gram, N.
const GRAM_N: f64 = 9.806_65e-3;

pub(super) fn rows() -> Vec<Row> {
    let hardness_mpa = 12.5 * GRAM_N;
    let factor = 1.0 / average_slope_rad(1.0);
    vec![
        Row::new(
            "Section 6.1",
            "microhardness of 12.5 gm/mm²",
            "MPa",
            printed(0.1225, 4),
            hardness_mpa,
        )
        .wrong("that is with 9.8 m/s²", Correction::Is(12.5e-3 * 9.8)),
        Row::new(
            "Section 6.1",
            "microhardness of the model",
            "MPa",
            printed(0.1225, 4),
            SKIN_MICROHARDNESS_PA * 1e-6,
        ),
        Row::new(
            "Eq. 6-13",
            "factor of the model",
            "",
            printed(1.25, 2),
            factor,
        ),
        Row::new(
            "Eq. 6-13",
            "RMS over mean slope, Gaussian surface",
            "",
            printed(1.25, 2),
            (PI / 2.0).sqrt(),
        ),
        Row::new(
            "Eq. 6-13",
            "RMS over mean slope, sine profile",
            "",
            printed(1.25, 2),
            PI / 8f64.sqrt(),
        )
        .wrong(
            "1.25 is of Gaussian surfaces, and section 6.2.3 expects ridges to be periodic",
            Correction::Reads(printed(1.11, 2)),
        ),
    ]
}
