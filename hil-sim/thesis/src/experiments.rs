//! The statistics of the thesis's experiments, and statements on them that contradict the model or each other.

use contact_model::material::{REFERENCE_DISPLAY, SKIN};
use contact_model::reference::{contact_resistance, erfcx, fourier_number, interface_temperature};
use experiment_statistics::distribution::{
    binomial_tail, chi_square_tail, correlation_tail, f_tail, t_tail,
};
use experiment_statistics::sensitivity::d_prime_oddity;
use experiment_statistics::studentized_range::studentized_range_tail;
use thermal_plant::finger::FingerParams;

use super::contact_case::{Case, SIMULATION_PRESSURE_PA};
use super::statement::Statement;

/// Thickness of the windows of section 5.2.1, m.
pub(super) const WINDOW_M: f64 = 10e-3;

pub(super) fn compute(statement: &Statement, quantity: &str) -> Option<f64> {
    if let Some(test) = quantity.strip_prefix("p of ") {
        return tail(test, statement.given());
    }
    Some(match quantity {
        "epidermis of the plant's layered finger" => {
            FingerParams::layered().layers.first()?.thickness_m * 1e3
        }
        "fall within 5 s, largest that Eq. 3-1 allows" => interface_fall_k(statement, (33.0, 24.0)),
        "fall within 10 s, largest that Eq. 3-1 allows" => {
            interface_fall_k(statement, (34.96, 23.0))
        }
        "d' of the different one of three from {} %" => {
            d_prime_oddity(statement.given() / 100.0).ok()?
        }
        // What other sections, or other sentences of the same section, say.
        "mean skin before contact, as section 4.2.1 has it" => 33.0,
        "room, as section 4.2.1 has it" => 24.0,
        "least correct of the simulated materials, as the range has it" => 40.0,
        "Caldwell and Gosney, correct, as section 1.2 has it" => 80.0,
        "skin before contact, as the gate of the same section has it" => 34.0,
        "pressure from which the model is within 1 K, as section 6.4.2 has it" => 5.90,
        "conditions of the factor with F(1,9) = {}" => 1.0 + 1.0,
        "skin on it below skin on a display at Eq. 3-1, most within 10 s" => {
            colder_than_simulated_k(statement)
        }
        "Fourier number of a window of 10 mm, 10 s" => {
            fourier_number(&statement.material(), WINDOW_M, 10.0)
        }
        _ => return None,
    })
}

/// Probability of the value of a statistic or a larger one, as `F(2,9) = {}` names it.
fn tail(test: &str, value: f64) -> Option<f64> {
    let degrees = |letter: &str| -> Option<Vec<f64>> {
        let (degrees, _) = test.strip_prefix(letter)?.strip_prefix('(')?.split_once(')')?;
        let numbers = degrees.split(',').map(str::parse);
        numbers.collect::<Result<_, _>>().ok()
    };
    if let Some(&[of_effect, of_error]) = degrees("F").as_deref() {
        return f_tail(value, of_effect, of_error).ok();
    }
    if let Some(&[means, of_error]) = degrees("q").as_deref() {
        return studentized_range_tail(value, means as u32, of_error).ok();
    }
    if let Some(&[of_error]) = degrees("t").as_deref() {
        return t_tail(value, of_error).ok();
    }
    // The value is a number of answers.
    let share = |percent: f64, chance| {
        let correct = (percent / 100.0 * value).round();
        binomial_tail(value as u32, correct as u32, chance)
    };
    let p = match test {
        "chi²(2) = {}" => chi_square_tail(value, 2.0),
        "r = {}, n = 5" => correlation_tail(value, 5),
        "r = {}, n = 5, r rounded up" => correlation_tail(value + 0.005, 5),
        "r = {}, n = 100" => correlation_tail(value, 100),
        "72 % or more of {} answers by chance" => share(72.0, 0.5),
        "70 % or more of {} answers by chance" => share(70.0, 0.5),
        "54 % or more of {} answers by chance of 1/3" => share(54.0, 1.0 / 3.0),
        "40 % or more of {} answers by chance of 1/5" => share(40.0, 0.2),
        _ => return None,
    };
    p.ok()
}

/// Fall of the skin to the interface temperature of a perfect contact, K.
fn interface_fall_k(statement: &Statement, (skin_c, object_c): (f64, f64)) -> f64 {
    skin_c - interface_temperature(&SKIN, skin_c, &statement.material(), object_c)
}

/// Largest difference within 10 s, K, of skin on a display whose surface has the interface temperature of Eq. 3-1, and
/// skin on the material. Skin and room are those of section 4.3.
fn colder_than_simulated_k(statement: &Statement) -> f64 {
    let case = Case {
        object: statement.material(),
        skin_c: 34.0,
        object_c: 21.4,
        pressure_pa: SIMULATION_PRESSURE_PA,
    };
    let display_c = case.perfect().interface_c;
    let display_m2k_w = contact_resistance(&SKIN.surface, &REFERENCE_DISPLAY, case.pressure_pa);
    let contact = case.contact();
    let times_s = (1..=1000).map(|i| 0.01 * f64::from(i));
    times_s
        .map(|t_s| {
            // A half-space behind a film at a constant temperature.
            let left: f64 = erfcx(t_s.sqrt() / (display_m2k_w * SKIN.effusivity()));
            let on_display_c = display_c + (case.skin_c - display_c) * left;
            on_display_c - contact.at(t_s).skin_c
        })
        .fold(f64::MIN, f64::max)
}
