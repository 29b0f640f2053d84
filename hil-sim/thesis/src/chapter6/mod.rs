//! Chapter 6: contact resistance, the display ratios, the simulations and the validation.

mod finish;
mod simulation;
mod validation;

use super::row::Row;

pub(super) fn rows() -> Vec<Row> {
    [
        finish::rows(),
        simulation::ratios(),
        simulation::figures_6_6_to_6_9(),
        simulation::figure_6_10(),
        simulation::figures_6_11_and_6_12(),
        validation::conditions(),
        validation::pressures(),
        validation::falls(),
        validation::steadiness(),
    ]
    .concat()
}
