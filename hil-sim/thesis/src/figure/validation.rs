//! Figures of the validation with BaF2 and ZnS windows (section 6.4).

use contact_model::pressure::THESIS_PRESSURES;

use super::{Curve, END_S, FLUX, Figure, Kind, TEMPERATURE, TIME, over_time};
use crate::contact_case::{Case, ContactSolver, Sample, sample};

/// The two windows and their parts of figures 6-19 and 6-20.
const WINDOWS: [(&str, &str, &str); 2] =
    [("BaF2", "6-19 A", "6-20 A"), ("ZnS", "6-19 B", "6-20 B")];
/// Number of pressures of the curve in figure 6-19, and the largest, Pa.
const PRESSURES: (u32, f64) = (60, 12e3);

/// At 2 N; the thesis does not state the pressure of this figure.
pub(super) fn figure_6_13(solver: &dyn ContactSolver) -> anyhow::Result<[Figure; 2]> {
    let (mut temperatures, mut fluxes) = (Vec::new(), Vec::new());
    let pressure_pa = THESIS_PRESSURES[4].1;
    for (group, (key, ..)) in WINDOWS.iter().enumerate() {
        let window = sample(key);
        let case = Case::validation(window.material, pressure_pa);
        let label = |what| format!("{}, {what}", window.name);
        temperatures.push(over_time(
            solver,
            &case,
            |at| at.skin_c,
            (label("skin"), Kind::Line, group),
        )?);
        temperatures.push(over_time(
            solver,
            &case,
            |at| at.object_c,
            (label("surface"), Kind::Dashed, group),
        )?);
        fluxes.push(over_time(
            solver,
            &case,
            |at| at.flux_w_m2,
            (window.name.into(), Kind::Line, group),
        )?);
    }
    let figure = |number, title, y, curves| Figure {
        number,
        title: format!("{title}, 34 and 26 °C, {:.2} kPa", pressure_pa * 1e-3),
        x: TIME,
        y,
        curves,
    };
    Ok([
        figure("6-13 A", "Skin and material surface", TEMPERATURE, temperatures),
        figure("6-13 B", "Heat flux exchanged", FLUX, fluxes),
    ])
}

/// Drop of the skin temperature within 10 s over pressure.
pub(super) fn figure_6_19(solver: &dyn ContactSolver) -> anyhow::Result<Vec<Figure>> {
    let figure = |(key, number, _): (&'static str, _, _)| {
        let window = sample(key);
        let (steps, highest_pa) = PRESSURES;
        let any = (1..=steps).map(|i| highest_pa * f64::from(i) / f64::from(steps));
        let measured = THESIS_PRESSURES.map(|(_, pressure_pa)| pressure_pa);
        Ok(Figure {
            number,
            title: format!(
                "Fall of the skin's temperature within 10 s on {}, 34 and 26 °C",
                window.name
            ),
            x: "contact pressure / kPa",
            y: "fall / K",
            curves: vec![
                falls(solver, &window, any, "model", Kind::Dashed)?,
                falls(solver, &window, measured, "at the five pressures", Kind::Dots)?,
            ],
        })
    };
    WINDOWS.into_iter().map(figure).collect()
}

fn falls(
    solver: &dyn ContactSolver,
    window: &Sample,
    pressures_pa: impl IntoIterator<Item = f64>,
    label: &str,
    kind: Kind,
) -> anyhow::Result<Curve> {
    let fall = |pressure_pa: f64| {
        let case = Case::validation(window.material, pressure_pa);
        let surfaces = solver.solve(&case, &[0.0, END_S])?;
        Ok((pressure_pa * 1e-3, surfaces[0].skin_c - surfaces[1].skin_c))
    };
    Ok(Curve {
        label: label.into(),
        kind,
        group: 0,
        points: pressures_pa.into_iter().map(fall).collect::<anyhow::Result<_>>()?,
    })
}

pub(super) fn figure_6_20(solver: &dyn ContactSolver) -> anyhow::Result<Vec<Figure>> {
    let figure = |(key, _, number): (&'static str, _, _)| {
        let window = sample(key);
        let curves = THESIS_PRESSURES.iter().enumerate().map(|(group, (force_n, pressure_pa))| {
            let label = format!("{:.2} kPa ({force_n} N)", pressure_pa * 1e-3);
            let case = Case::validation(window.material, *pressure_pa);
            over_time(solver, &case, |at| at.skin_c, (label, Kind::Line, group))
        });
        Ok(Figure {
            number,
            title: format!("Skin surface on {}, 34 and 26 °C", window.name),
            x: TIME,
            y: TEMPERATURE,
            curves: curves.collect::<anyhow::Result<_>>()?,
        })
    };
    WINDOWS.into_iter().map(figure).collect()
}
