//! Table 5-3, the limits of Eq. 5-1 and 5-2, and the way there and back of Eq. 5-3 and 5-4.

use thermal_plant::infrared::{
    BAND_M, BEAMSPLITTER, LineOfSight, Optic, SKIN_EMISSIVITY, SelfReflection, Surroundings,
    radiance, temperature_c,
};

use crate::row::{Correction, Row};
use crate::stated::{Stated, printed};

/// Room and optics, °C (section 5.2.2).
const AMBIENT_C: f64 = 24.0;
/// "Approximately 30 °C": the camera that sees itself in the window (section 5.2.5).
const CAMERA_C: f64 = 30.0;
/// How far from 1 a slope "very close to 1" may be.
const CLOSE: f64 = 0.01;

pub(super) fn table_5_3() -> Vec<Row> {
    let windows = [("BaF2", Optic::Baf2.window()), ("ZnS", Optic::Zns.window())];
    let windows = windows
        .into_iter()
        .filter_map(|(name, window)| Some((name, window?)));
    let stated = [(0.77, 0.04, 0.19), (0.65, 0.22, 0.13), (0.54, 0.42, 0.04)];
    let mut rows = Vec::new();
    for ((name, optic), (transmissivity, reflectivity, emissivity)) in
        windows.chain([("germanium", BEAMSPLITTER)]).zip(stated)
    {
        let row = |what: &str, stated, computed| {
            Row::new(
                "Table 5-3",
                format!("{name}, {what}"),
                "",
                printed(stated, 2),
                computed,
            )
        };
        rows.extend([
            row("transmissivity", transmissivity, optic.transmissivity),
            row("reflectivity", reflectivity, optic.reflectivity),
            row(
                "emissivity, from the other two",
                emissivity,
                optic.emissivity(),
            ),
        ]);
    }
    rows
}

/// Limits of the integrals beside the camera's band.
pub(super) fn limits() -> Vec<Row> {
    let [shortest_um, longest_um] = BAND_M.map(|limit_m| limit_m * 1e6);
    let upper = |place, what: &str| {
        Row::new(
            place,
            format!("upper limit, {what}"),
            "µm",
            printed(3.0, 0),
            longest_um,
        )
        .damaged(
            "lost its first digit: the camera's band ends at 13 µm",
            Correction::Reads(printed(13.0, 0)),
        )
    };
    vec![
        Row::new(
            "Eq. 5-1",
            "lower limits",
            "µm",
            printed(7.5, 1),
            shortest_um,
        ),
        upper("Eq. 5-1", "numerator"),
        upper("Eq. 5-1", "denominator"),
        Row::new(
            "Eq. 5-2",
            "lower limits",
            "µm",
            printed(7.5, 1),
            shortest_um,
        ),
        upper("Eq. 5-2", "numerator"),
        Row::new(
            "Eq. 5-2",
            "upper limit, denominator",
            "µm",
            printed(13.0, 0),
            longest_um,
        ),
    ]
}

/// Slopes of the regression lines through the origin, recovered over true temperature, of sections 5.2.5's targets.
pub(super) fn round_trips() -> Vec<Row> {
    let check = [28.0, 30.0, 32.0, 34.0, 36.0];
    let targets = [27.0, 28.0, 29.0, 30.0, 31.0, 32.0];
    let close = Stated::About {
        value: 1.0,
        within: CLOSE,
    };
    let camera = Some(SelfReflection {
        camera_c: CAMERA_C,
        share: 1.0,
    });
    let row = |place, what: &str, stated, slope| Row::new(place, what, "", stated, slope);
    vec![
        row(
            "Figure 5-8",
            "no optics, slope recovered / true",
            close,
            slope(Optic::None, &check, None),
        ),
        row(
            "Figure 5-10",
            "BaF2, slope recovered / true",
            close,
            slope(Optic::Baf2, &targets, None),
        ),
        row(
            "Figure 5-10",
            "ZnS, slope recovered / true",
            close,
            slope(Optic::Zns, &targets, None),
        ),
        row(
            "Section 5.2.5",
            "ZnS, slope if the camera sees itself",
            Stated::Above(1.0),
            slope(Optic::Zns, &targets, camera),
        ),
        row(
            "Section 5.2.5",
            "BaF2, slope if the camera sees itself",
            Stated::Below(1.0),
            slope(Optic::Baf2, &targets, camera),
        )
        .note("measured too low through BaF2; that the camera sees itself explains ZnS alone"),
    ]
}

/// Slope through the origin of recovered over true temperature.
fn slope(optic: Optic, targets_c: &[f64], camera: Option<SelfReflection>) -> f64 {
    let assumed = LineOfSight::new(optic, SKIN_EMISSIVITY, &Surroundings::at(AMBIENT_C));
    let sight = camera.map_or(assumed, |camera| {
        assumed.with_self_reflection(optic, &camera, AMBIENT_C)
    });
    let recovered = |target_c: f64| temperature_c(assumed.target(sight.total(radiance(target_c))));
    let products: f64 = targets_c
        .iter()
        .map(|&target_c| target_c * recovered(target_c))
        .sum();
    let squares: f64 = targets_c.iter().map(|target_c| target_c * target_c).sum();
    products / squares
}
