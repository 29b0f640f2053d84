//! Chapter 5: infrared windows, skin on the windows, and the infrared instrument.

use thermal_plant::infrared::{
    BAND_M, BEAMSPLITTER, Bandpass, Optic, OpticalPath, SKIN_EMISSIVITY, SelfReflection,
    Surroundings, radiance, temperature_c,
};

use super::contact_case::Case;
use super::statement::Statement;

/// Temperature of room and optics, °C (section 5.2.2).
const AMBIENT_C: f64 = 24.0;
/// Temperature of the camera that is reflected in the window, "approximately 30 °C" (section 5.2.5).
const CAMERA: SelfReflection = SelfReflection { camera_c: 30.0, share: 1.0 };
/// Targets of section 5.2.5 without optics and behind a window, °C.
const CHECK_C: [f64; 5] = [28.0, 30.0, 32.0, 34.0, 36.0];
const TARGETS_C: [f64; 6] = [27.0, 28.0, 29.0, 30.0, 31.0, 32.0];
/// Spatial sampling rate for the detail of section 5.2.4, 1/mm.
const SAMPLING_PER_MM: f64 = 2.0 * 1.25;

pub(super) fn compute(statement: &Statement, quantity: &str) -> Option<f64> {
    let [shortest_um, longest_um] = BAND_M.map(|limit_m| limit_m * 1e6);
    Some(match quantity {
        "skin at 10 s, 2 N" => {
            let case = Case {
                object_c: 24.0,
                ..Case::validation(statement.material(), contact_model::pressure::pressure_pa(2.0))
            };
            case.contact().at(10.0).skin_c
        }
        "transmissivity" => window(&statement.of)?.transmissivity,
        "reflectivity" => window(&statement.of)?.reflectivity,
        "emissivity, from the other two" => window(&statement.of)?.emissivity(),
        "lower limits" => shortest_um,
        "upper limit, numerator" | "upper limit, denominator" => longest_um,
        "sampling for detail of 1.25/mm" => SAMPLING_PER_MM,
        "its pitch" => 1e3 / SAMPLING_PER_MM,
        // A slope of recovered over true temperature is "very close to 1".
        "slope recovered / true" => match optic(&statement.of) {
            Optic::None => slope(Optic::None, &CHECK_C, None),
            window => slope(window, &TARGETS_C, None),
        },
        "slope if the camera sees itself" => slope(optic(&statement.of), &TARGETS_C, Some(CAMERA)),
        _ => return None,
    })
}

fn optic(name: &str) -> Optic {
    match name {
        "BaF2" => Optic::Baf2,
        "ZnS" => Optic::Zns,
        _ => Optic::None,
    }
}

fn window(name: &str) -> Option<Bandpass> {
    match name {
        "germanium" => Some(BEAMSPLITTER),
        _ => optic(name).window(),
    }
}

/// Slope of the regression line through the origin of recovered over true temperature.
fn slope(optic: Optic, targets_c: &[f64], camera: Option<SelfReflection>) -> f64 {
    let assumed = OpticalPath::new(optic, SKIN_EMISSIVITY, &Surroundings::at(AMBIENT_C));
    let sight =
        camera.map_or(assumed, |camera| assumed.with_self_reflection(optic, &camera, AMBIENT_C));
    let recovered = |target_c: f64| {
        temperature_c(assumed.target_radiance(sight.total_radiance(radiance(target_c))))
    };
    let products: f64 = targets_c.iter().map(|&target_c| target_c * recovered(target_c)).sum();
    let squares: f64 = targets_c.iter().map(|target_c| target_c * target_c).sum();
    products / squares
}
