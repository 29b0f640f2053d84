//! Chapter 3: perfect contact of two half-spaces, and discrimination of materials.

use contact_model::material::{Material, SKIN};
use contact_model::reference::{fourier_number, interface_temperature};
use experiment_statistics::sensitivity::d_prime;
use serde::Deserialize;

use super::contact_case::{
    SIMULATION_AREA_M2, SIMULATION_PRESSURE_PA, material, tabulated_effusivity,
};
use super::stated_value::cut;
use super::statement::{STATEMENTS, Statement, read};

/// Temperatures of skin and material before contact in Tables 3-1 and 3-4, °C.
const BEFORE_C: (f64, f64) = (33.0, 24.0);
/// Characteristic length of Table 3-1, m. The thesis does not state it; all six numbers require 12.706 to 12.723 mm,
/// which is none of the stated dimensions.
const LENGTH_3_1_M: f64 = 12.71e-3;
/// Thickness of the samples of sections 3.3 and 4.3, m.
const THICKNESS_M: f64 = 38e-3;
/// Length that the numbers of Table 3-4 require instead of the stated thickness, m: 149.2 to 153.8 mm.
const LENGTH_3_4_M: f64 = 151.4e-3;
/// Young's moduli of Table 3-2, GPa; that of granite is from Table 4-1.
pub(super) const MODULI_GPA: [(&str, f64); 7] = [
    ("copper", 110.0),
    ("bronze", 93.0),
    ("stainless-steel", 193.0),
    ("abs", 2.3),
    ("g10", 17.0),
    ("granite", GRANITE_GPA),
    ("foam", FOAM_GPA),
];
const GRANITE_GPA: f64 = 53.0;
const FOAM_GPA: f64 = 1.5e-3;

pub(super) fn compute(statement: &Statement, quantity: &str) -> Option<f64> {
    let (skin_c, object_c) = BEFORE_C;
    let fourier = |length_m, t_s| fourier_number(&statement.material(), length_m, t_s);
    let solids = MODULI_GPA.iter().filter(|(name, _)| *name != "foam");
    let strains = || solids.clone().map(|(_, modulus_gpa)| strain(*modulus_gpa));
    let ratio = |effusivity| ratio(&statement.of, effusivity);
    Some(match quantity {
        "interface" => interface_temperature(&SKIN, skin_c, &statement.material(), object_c),
        "Fourier number, 5 s" => fourier(LENGTH_3_1_M, 5.0),
        // "These sample dimensions were chosen to make the Fourier numbers of all the materials smaller than 0.05."
        "Fourier number, 10 s, L_c = 38 mm" | "Fourier number, 10 s, 38 mm thick" => {
            fourier(THICKNESS_M, 10.0)
        }
        "Fourier number, 10 s, L_c = 151.4 mm" => fourier(LENGTH_3_4_M, 10.0),
        "Young's modulus" => GRANITE_GPA,
        "strain" => strain(FOAM_GPA),
        "largest strain of the others, power of ten" => strains().fold(f64::MIN, f64::max).log10(),
        "smallest strain of the others, power of ten" => strains().fold(f64::MAX, f64::min).log10(),
        "contact area of three fingers" => 3.0 * SIMULATION_AREA_M2 * 1e6,
        // "Subjects were able to discriminate reliably between two materials when the ratio of the contact
        // coefficients of the materials exceeded three."
        "least correct of the pairs with a ratio above 3" => table_3_3()
            .iter()
            .filter(|answers| self::ratio(&answers.pair, Material::effusivity) > 3.0)
            .fold(f64::MAX, |worst, answers| worst.min(answers.percent)),
        "ratio of contact coefficients" => ratio(Material::effusivity),
        "ratio of cut contact coefficients" => ratio(tabulated_effusivity),
        "ratio of cut contact coefficients, itself cut" => cut(ratio(tabulated_effusivity), 2),
        HIGH_LOW | LOW_HIGH | TOTAL => d_prime(3, statement.given() / 100.0).ok()?,
        "mean correct of Table 3-3" => mean(&table_3_3()),
        "mean correct of Table 3-5, total" => mean(&table_3_5(TOTAL)),
        "fall from Table 3-3 to 3-5, materials of both" => {
            mean_of_shared(table_3_3()) - mean_of_shared(table_3_5(TOTAL))
        }
        "fall from Table 3-3 to 3-5 high / low, part of Table 3-3's mean" => {
            let first = mean_of_shared(table_3_3());
            (first - mean_of_shared(table_3_5(HIGH_LOW))) / first * 100.0
        }
        _ => return None,
    })
}

/// Strain under the pressure of 2 N on 135 mm².
fn strain(modulus_gpa: f64) -> f64 {
    SIMULATION_PRESSURE_PA / (modulus_gpa * 1e9)
}

/// Ratio of the contact coefficients of two materials, computed by `effusivity`.
fn ratio(pair: &str, effusivity: fn(&Material) -> f64) -> f64 {
    let (one, other) = pair.split_once(" / ").expect("a pair of materials");
    effusivity(&material(one)) / effusivity(&material(other))
}

/// Discrimination of a pair of materials.
#[derive(Clone, Deserialize)]
pub(super) struct Answers {
    pub(super) pair: String,
    /// Percentage of correct answers.
    pub(super) percent: f64,
}

pub(super) fn table_3_3() -> Vec<Answers> {
    read("table_3_3.csv", include_str!("../data/table_3_3.csv")).expect("a table of the program")
}

pub(super) const HIGH_LOW: &str = "high / low, d' of {} %";
pub(super) const LOW_HIGH: &str = "low / high, d' of {} %";
const TOTAL: &str = "total, d' of {} %";

/// Percentages correct for which a column of Table 3-5 states d'.
pub(super) fn table_3_5(column: &str) -> Vec<Answers> {
    let statements = STATEMENTS.iter().filter(|row| row.quantity == column);
    let answers = statements.map(|row| Answers { pair: row.of.clone(), percent: row.given() });
    answers.collect()
}

fn mean(answers: &[Answers]) -> f64 {
    answers.iter().map(|row| row.percent).sum::<f64>() / answers.len() as f64
}

/// Mean over the pairs of materials that are in both tables.
fn mean_of_shared(mut answers: Vec<Answers>) -> f64 {
    let both = ["copper", "stainless steel", "ABS", "foam"];
    answers.retain(|row| row.pair.split(" / ").all(|material| both.contains(&material)));
    mean(&answers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn section_3_2_2_has_exactly_the_pairs_that_are_not_told_apart() {
        // Percentage of correct answers above which a pair counts as discriminated.
        let failed = table_3_3().into_iter().filter(|row| row.percent < 72.0);
        let failed: Vec<_> = failed.map(|row| row.pair).collect();
        let section = STATEMENTS.iter().filter(|row| row.place == "Section 3.2.2");
        assert_eq!(failed, section.map(|row| row.of.as_str()).collect::<Vec<_>>());
    }
}
