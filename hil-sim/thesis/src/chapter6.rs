//! Chapter 6: contact resistance, the display ratios, the simulations and the validation.

mod simulation;
mod validation;

use std::f64::consts::PI;

use contact_model::material::{SKIN_MICROHARDNESS_PA, average_slope_rad};

use super::statement::Statement;

pub(super) fn compute(statement: &Statement, quantity: &str) -> Option<f64> {
    Some(match quantity {
        // The weight of a gram is 9.80665 mN.
        "microhardness of 12.5 gm/mm²" => 12.5 * 9.806_65e-3,
        "microhardness of 12.5 gm/mm² with 9.8 m/s²" => 12.5e-3 * 9.8,
        "microhardness of the model" => SKIN_MICROHARDNESS_PA * 1e-6,
        "factor of the model" => 1.0 / average_slope_rad(1.0),
        "RMS over mean slope, Gaussian surface" => (PI / 2.0).sqrt(),
        "RMS over mean slope, sine profile" => PI / 8f64.sqrt(),
        _ => {
            return simulation::compute(statement, quantity)
                .or_else(|| validation::compute(statement, quantity));
        }
    })
}
