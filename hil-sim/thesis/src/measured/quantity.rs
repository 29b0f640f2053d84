//! The quantities of `data/measured.csv`, by name.

use contact_model::material::SKIN;
use contact_model::pressure::contact_area_m2;
use contact_model::reference::interface_temperature;
use thermal_plant::Params;
use thermal_plant::parameters::draw_contact;
use thermal_plant::sensors::SensorParams;

use super::Line;
use super::course::{Before, Courses, Touched};
use crate::contact_case::{five_materials, material};

/// Force of the experiments of chapters 3 and 4, N: "between 1.5-2 N" (section 3.2.3).
const TOUCH_N: f64 = 1.75;
/// Forces of section 6.4, N.
const FORCES_N: [f64; 5] = [0.1, 0.25, 0.5, 1.0, 2.0];
/// Contact laws that are drawn for the spread of the area.
const DRAWS: u64 = 1000;

/// What a plant gives; none if it has no such quantity.
pub(super) fn of_plant(line: &Line, courses: &mut Courses) -> anyhow::Result<Option<f64>> {
    let of = line.of.as_str();
    Ok(Some(match line.quantity.as_str() {
        "share of the fall within 5 s that an edge at {} K sees" => {
            line.given() / discrimination(courses, of)?
        }
        "fall within 5 s, measured at the edge" => discrimination(courses, of)?,
        "share of the mean fall within 10 s that an edge at {} K sees, real" => {
            line.given() / mean(&five(courses, Touched::Real)?)
        }
        "share of the mean fall within 10 s that an edge at {} K sees, simulated" => {
            line.given() / mean(&five(courses, Touched::Simulated)?)
        }
        "fall within 10 s, measured at the edge" => display(courses, Touched::Real, of)?,
        "mean fall, real less simulated, at the share of the edge that gives {} K" => {
            let real_k = mean(&five(courses, Touched::Real)?);
            let simulated_k = mean(&five(courses, Touched::Simulated)?);
            line.given() / real_k * (real_k - simulated_k)
        }
        "fall, real less simulated" => {
            display(courses, Touched::Real, of)? - display(courses, Touched::Simulated, of)?
        }
        "correlation of the falls with Eq. 3-1, real" => {
            correlation(&five(courses, Touched::Real)?, &by_equation_3_1())
        }
        "correlation of the falls with Eq. 3-1, simulated" => {
            correlation(&five(courses, Touched::Simulated)?, &by_equation_3_1())
        }
        "time constant, simulated over real" => {
            let mut tau_s = |touched| -> anyhow::Result<f64> {
                let course = courses.contact(touched, of, Before::DISPLAY, TOUCH_N)?;
                Ok(course.time_constant_s())
            };
            tau_s(Touched::Simulated)? / tau_s(Touched::Real)?
        }
        "mean rate of the first 3.5 s over that of the next 5 s" => {
            let (mut first_k, mut next_k) = (0.0, 0.0);
            for sample in five_materials() {
                let course =
                    courses.contact(Touched::Real, sample.name, Before::DISPLAY, TOUCH_N)?;
                first_k += course.fall_k(3.5);
                next_k += course.fall_k(8.5) - course.fall_k(3.5);
            }
            (first_k / 3.5) / (next_k / 5.0)
        }
        "factor on the plant's area at 2 N that gives {} mm²" => {
            line.given() * 1e-6 / contact_area_m2(2.0)
        }
        "standard deviation of the contact area over its mean" => spread_of_area(),
        "fall within 10 s at {} N" => window(courses, of, line.given())?,
        "fall above the measured 5 K at {} N" => window(courses, of, line.given())? - 5.0,
        "force of the largest fall" => {
            let (mut largest_k, mut at_n) = (0.0, 0.0);
            for force_n in FORCES_N {
                let fall_k = window(courses, of, force_n)?;
                if fall_k > largest_k {
                    (largest_k, at_n) = (fall_k, force_n);
                }
            }
            at_n
        }
        "fall at 1 N over that at 0.25 N" => window(courses, of, 1.0)? / window(courses, of, 0.25)?,
        "part of the fall within 10 s made by 2 s, at {} N" => {
            let (touched, before) = (Touched::Window, Before::VALIDATION);
            let course = courses.contact(touched, of, before, line.given())?;
            course.fall_k(2.0) / course.end_k() * 100.0
        }
        "mean fall that a thermistor 2 to 3 mm away sees" => {
            let mut falls_k = Vec::new();
            for name in ["BaF2", "ZnS"] {
                for force_n in FORCES_N {
                    falls_k.push(window(courses, name, force_n)?);
                }
            }
            SensorParams::NOMINAL.skin_sees_contact * mean(&falls_k)
        }
        "fall that a thermistor 2 to 3 mm away sees at {} N" => {
            SensorParams::NOMINAL.skin_sees_contact * window(courses, "BaF2", line.given())?
        }
        "fall within 10 s that stopped blood adds at {} N" => {
            let (touched, before) = (Touched::Window, Before::VALIDATION);
            let open = courses.with_blood(touched, of, before, line.given(), false)?;
            window(courses, of, line.given())? - open.end_k()
        }
        "fall within 2 s, after Ino et al." => {
            let (touched, before) = (Touched::Real, Before::DISCRIMINATION);
            courses.contact(touched, of, before, TOUCH_N)?.fall_k(2.0)
        }
        _ => return Ok(None),
    }))
}

/// Fall within 5 s on a material of section 3.2, K.
fn discrimination(courses: &mut Courses, of: &str) -> anyhow::Result<f64> {
    let course = courses.contact(Touched::Real, of, Before::DISCRIMINATION, TOUCH_N)?;
    Ok(course.fall_k(5.0))
}

/// Fall within 10 s in section 4.4, K.
fn display(courses: &mut Courses, touched: Touched, of: &str) -> anyhow::Result<f64> {
    Ok(courses.contact(touched, of, Before::DISPLAY, TOUCH_N)?.end_k())
}

/// The same of the five materials.
fn five(courses: &mut Courses, touched: Touched) -> anyhow::Result<Vec<f64>> {
    let materials = five_materials().into_iter();
    materials.map(|sample| display(courses, touched, sample.name)).collect()
}

/// The same by Eq. 3-1.
fn by_equation_3_1() -> Vec<f64> {
    let Before { skin_c, object_c, .. } = Before::DISPLAY;
    let materials = five_materials().into_iter();
    materials
        .map(|sample| {
            skin_c - interface_temperature(&SKIN, skin_c, &material(sample.name), object_c)
        })
        .collect()
}

/// Fall within 10 s on a window of section 6.4, K.
fn window(courses: &mut Courses, of: &str, force_n: f64) -> anyhow::Result<f64> {
    let (touched, before) = (Touched::Window, Before::VALIDATION);
    Ok(courses.contact(touched, of, before, force_n)?.end_k())
}

fn spread_of_area() -> f64 {
    let factors: Vec<f64> = (0..DRAWS)
        .map(|seed| {
            let mut params = Params::nominal();
            draw_contact(&mut params, seed);
            params.contact.area_factor
        })
        .collect();
    let mean_factor = mean(&factors);
    let squares: Vec<f64> = factors.iter().map(|f| (f - mean_factor).powi(2)).collect();
    mean(&squares).sqrt() / mean_factor
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Pearson's correlation.
fn correlation(x: &[f64], y: &[f64]) -> f64 {
    let (mean_x, mean_y) = (mean(x), mean(y));
    let pairs = || x.iter().map(|x| x - mean_x).zip(y.iter().map(|y| y - mean_y));
    let sum = |product: fn((f64, f64)) -> f64| pairs().map(product).sum::<f64>();
    sum(|(x, y)| x * y) / (sum(|(x, _)| x * x) * sum(|(_, y)| y * y)).sqrt()
}
