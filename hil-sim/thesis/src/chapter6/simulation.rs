//! Section 6.3: statements of the text on the simulations and on figures 6-6 to 6-12.
//!
//! A temperature counts as steady if it changes by 0.1 K or less, which is not visible in a figure of 10 K.

use contact_model::pressure::pressure_pa;

use crate::contact_case::{Case, SIMULATION_PRESSURE_PA, five_materials, material};
use crate::statement::Statement;

/// End of every simulation, s.
const END_S: f64 = 10.0;
/// Roughness of milled copper in figure 6-11, µm.
const MILLED_UM: f64 = 8.0;
/// Roughness of sawn copper in figure 6-11, µm.
const SAWN_UM: f64 = 30.0;

pub(super) fn compute(statement: &Statement, quantity: &str) -> Option<f64> {
    let case = || Case::simulation(statement.material());
    let at = |t_s| case().contact().at(t_s);
    let five = |value: fn(&Case) -> f64| {
        five_materials().map(|sample| value(&Case::simulation(sample.material)))
    };
    let (smooth, milled, sawn) = (copper(), rough(MILLED_UM), rough(SAWN_UM));
    let (light, firm) = (pressed(0.5), pressed(2.0));
    let difference = |t_s| flux(&smooth, t_s) - flux(&sawn, t_s);
    Some(match quantity {
        "ratio of resistances display / object" => case().contact().ratio,
        "skin at landing" => at(0.0).skin_c,
        "surface at landing" => at(0.0).object_c,
        "skin, movement in the last second" => at(END_S).skin_c - at(END_S - 1.0).skin_c,
        "surface, movement in the last second" => at(END_S).object_c - at(END_S - 1.0).object_c,
        // "Similar to their corresponding material surface temperatures", or, of ABS and foam, "closer to" the skin's.
        "display at 10 s, way from surface to skin" => {
            let end = at(END_S);
            (end.display_c - end.object_c) / (end.skin_c - end.object_c)
        }
        "neighbours, of 4, whose higher coefficient cools the skin more" => {
            falling(&five(|case| case.drop_k(END_S)))
        }
        "neighbours, of 4, whose higher coefficient warms itself less" => {
            falling(&five(|case| case.object_c - case.contact().at(END_S).object_c))
        }
        "neighbours, of 4, whose higher coefficient takes more flux" => {
            falling(&five(|case| flux(case, END_S)))
        }
        "materials, of 5, whose skin is warmer than at perfect contact" => {
            positive(&five(skin_above_perfect))
        }
        "materials, of 5, colder than at perfect contact" => positive(&five(surface_below_perfect)),
        "neighbours, of 4, whose higher coefficient differs more, skin" => {
            falling(&five(skin_above_perfect))
        }
        "neighbours, of 4, whose higher coefficient differs less, surface" => {
            let mut differences = five(surface_below_perfect);
            differences.reverse();
            falling(&differences)
        }
        "difference of skin" => skin_above_perfect(&case()),
        "difference of surface" => surface_below_perfect(&case()),
        "seconds, of 0 to 10, with flux smooth > milled > sawn" => {
            seconds_in_order(&[smooth, milled, sawn])
        }
        "flux smooth - sawn after 1 s, part of that at landing" => {
            difference(1.0) / difference(0.0)
        }
        "seconds, of 0 to 10, with more flux for more pressure" => {
            seconds_in_order(&[firm, pressed(1.0), light])
        }
        "influence on the first flux, pressure over roughness" => {
            (flux(&firm, 0.0) / flux(&light, 0.0)) / (flux(&smooth, 0.0) / flux(&sawn, 0.0))
        }
        "largest pressure computed with; Eq. 6-8: 35 to 350 kPa" => SIMULATION_PRESSURE_PA * 1e-3,
        _ => return None,
    })
}

fn copper() -> Case {
    Case::simulation(material("copper"))
}

fn rough(roughness_um: f64) -> Case {
    let mut case = copper();
    case.object.surface.roughness_um = roughness_um;
    case
}

fn pressed(force_n: f64) -> Case {
    Case { pressure_pa: pressure_pa(force_n), ..copper() }
}

fn flux(case: &Case, t_s: f64) -> f64 {
    case.contact().at(t_s).flux_w_m2
}

/// Skin temperature minus that at perfect contact, K.
fn skin_above_perfect(case: &Case) -> f64 {
    case.contact().at(END_S).skin_c - case.perfect().interface_c
}

/// Object surface temperature at perfect contact minus that with contact resistance, K.
fn surface_below_perfect(case: &Case) -> f64 {
    case.perfect().interface_c - case.contact().at(END_S).object_c
}

fn positive(values: &[f64]) -> f64 {
    values.iter().filter(|value| **value > 0.0).count() as f64
}

/// Number of neighbours in a list of which the second is smaller.
fn falling(values: &[f64]) -> f64 {
    values.windows(2).filter(|pair| pair[0] > pair[1]).count() as f64
}

/// Number of the seconds 0 to 10 at which each case has less flux than the one before it.
fn seconds_in_order(cases: &[Case; 3]) -> f64 {
    let in_order = |t_s: &f64| falling(&cases.map(|case| flux(&case, *t_s))) == 2.0;
    (0..=10u8).map(f64::from).filter(in_order).count() as f64
}
