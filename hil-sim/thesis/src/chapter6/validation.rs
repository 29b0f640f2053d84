//! Section 6.4: pressures, drop of the skin temperature on BaF2 and ZnS, and time to the steady state.
//!
//! A temperature counts as steady if at most 5 % of its drop remain.

use contact_model::pressure::{THESIS_PRESSURES, contact_area_m2};

use crate::contact_case::{Case, material};
use crate::statement::Statement;

pub(super) fn compute(statement: &Statement, quantity: &str) -> Option<f64> {
    let area_mm2 = |force_n| contact_area_m2(force_n) * 1e6;
    let growth_mm2 = area_mm2(2.0) - area_mm2(0.1);
    let given_pa = || statement.given() * 1e3;
    let fall_k = |pressure_pa| fall_k(&statement.of, pressure_pa);
    Some(match quantity {
        // "They are the average skin and contact material temperatures in this experiment", of which the procedure
        // of the same section gives other values.
        "mean skin before contact, as the procedure has it" => 34.6,
        "mean window before contact, as the procedure has it" => 25.9,
        "pressure of the model at {} N" => {
            let mut pressures = THESIS_PRESSURES.iter();
            pressures.find(|(force_n, _)| *force_n == statement.given())?.1
        }
        "growth of the area from 0.1 to 2 N" => growth_mm2,
        "part of it below 1 N" => (area_mm2(1.0) - area_mm2(0.1)) / growth_mm2 * 100.0,
        "skin on BaF2 minus skin on ZnS at 10 s, 2 N" => {
            let [.., (_, firmest_pa)] = THESIS_PRESSURES;
            self::fall_k("ZnS", firmest_pa) - self::fall_k("BaF2", firmest_pa)
        }
        // Measured were 3 to 5 K at every pressure, at 1.68 kPa the same as at 5.90 kPa. The model underestimates the
        // falls at the two lowest pressures, and is within 1 K of the others.
        "{} kPa, model below the measured 3 to 5 K"
        | "{} kPa, model below the measured"
        | "{} kPa, model within 1 K of 3 to 5 K" => fall_k(given_pa()),
        "rise per kPa above 3.14 kPa over that below" => {
            let [(_, low_pa), _, (_, middle_pa), _, (_, high_pa)] = THESIS_PRESSURES;
            let slope = |from_pa, to_pa| (fall_k(to_pa) - fall_k(from_pa)) / (to_pa - from_pa);
            slope(middle_pa, high_pa) / slope(low_pa, middle_pa)
        }
        // "The skin temperature approached a steady state value within 2 s of contact", "consistent with the thermal
        // model predictions".
        "{} kPa, part of the 10 s fall made by 2 s" => {
            let case = Case::validation(statement.material(), given_pa());
            case.drop_k(2.0) / case.drop_k(10.0) * 100.0
        }
        _ => return None,
    })
}

/// Drop of the skin temperature on a window within 10 s, K.
fn fall_k(window: &str, pressure_pa: f64) -> f64 {
    Case::validation(material(window), pressure_pa).drop_k(10.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stated_value::{Stated, cut};
    use crate::statement::{STATEMENTS, rows};

    #[test]
    fn limit_at_1680_pa_is_1_k_below_the_model_at_5900_pa() {
        for window in ["BaF2", "ZnS"] {
            let quantity = format!("{window}, 1.68 kPa, model below the measured");
            let row = rows(&STATEMENTS, 6).into_iter().find(|row| row.quantity == quantity);
            let limit = Stated::Below(cut(fall_k(window, 5900.0) - 1.0, 2));
            assert_eq!(row.expect("the statement").stated, limit);
        }
    }
}
