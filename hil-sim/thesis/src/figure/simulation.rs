//! Figure 3-2 and the simulations of section 6.3.

use contact_model::pressure::{THESIS_PRESSURES, pressure_pa};

use super::{Curve, END_S, FLUX, Figure, Kind, TEMPERATURE, TIME, over_time, times_s};
use crate::contact_case::{Case, ContactSolver, Surfaces, five_materials, material, sample};

const SIMULATION: &str = "34 and 24 °C, 14.81 kPa";
/// First time of figure 3-2 (B), s; Eq. 3-3 is singular at time zero.
const FIRST_FLUX_S: f64 = 0.05;

/// Perfect contact, Eq. 3-1 and 3-3.
pub(super) fn figure_3_2() -> Vec<Figure> {
    let materials = ["copper", "bronze", "stainless steel", "granite", "G10", "ABS", "foam"];
    let figure = |number, y, title: &str, value: &dyn Fn(&Case, f64) -> Option<f64>| Figure {
        number,
        title: format!("{title} at perfect contact, 33 and 24 °C"),
        x: TIME,
        y,
        curves: materials
            .map(sample)
            .iter()
            .enumerate()
            .map(|(group, sample)| {
                let case = Case { skin_c: 33.0, ..Case::simulation(sample.material) };
                let points = times_s().into_iter();
                Curve {
                    label: sample.name.into(),
                    kind: Kind::Line,
                    group,
                    points: points.filter_map(|t_s| Some((t_s, value(&case, t_s)?))).collect(),
                }
            })
            .collect(),
    };
    vec![
        figure("3-2 A", TEMPERATURE, "Skin surface", &|case, t_s| {
            Some(case.perfect().skin_at_depth(0.0, t_s))
        }),
        figure("3-2 B", FLUX, "Heat flux from 0.05 s on", &|case, t_s| {
            let late = t_s >= FIRST_FLUX_S;
            // Eq. 3-3 gives the flux into the skin.
            case.perfect().flux_w_m2(t_s).filter(|_| late).map(|flux| -flux)
        }),
    ]
}

pub(super) fn figures_6_6_to_6_9(solver: &dyn ContactSolver) -> anyhow::Result<Vec<Figure>> {
    type Value = fn(&Surfaces) -> f64;
    let parts: [(_, _, _, Value); 4] = [
        ("6-6", "Skin surface", TEMPERATURE, |at| at.skin_c),
        ("6-7", "Material surface", TEMPERATURE, |at| at.object_c),
        ("6-8", "Heat flux exchanged", FLUX, |at| at.flux_w_m2),
        ("6-9", "Thermal display that simulates the material", TEMPERATURE, |at| at.display_c),
    ];
    let figure = |(number, title, y, value): (_, &str, _, _)| {
        let curves = five_materials().into_iter().enumerate().map(|(group, sample)| {
            let case = Case::simulation(sample.material);
            over_time(solver, &case, value, (sample.name.into(), Kind::Line, group))
        });
        Ok(Figure {
            number,
            title: format!("{title}, {SIMULATION}"),
            x: TIME,
            y,
            curves: curves.collect::<anyhow::Result<_>>()?,
        })
    };
    parts.into_iter().map(figure).collect()
}

/// The model with contact resistance and the interface temperature of perfect contact.
pub(super) fn figure_6_10(solver: &dyn ContactSolver) -> anyhow::Result<Figure> {
    let mut curves = Vec::new();
    for (group, sample) in five_materials().into_iter().enumerate() {
        let case = Case::simulation(sample.material);
        let label = |what| format!("{}, {what}", sample.name);
        let interface_c = case.perfect().interface_c;
        curves.extend([
            over_time(solver, &case, |at| at.skin_c, (label("skin"), Kind::Line, group))?,
            over_time(solver, &case, |at| at.object_c, (label("surface"), Kind::Dashed, group))?,
            Curve {
                label: label("perfect contact"),
                kind: Kind::Dots,
                group,
                points: (1..=9u8).map(|t_s| (f64::from(t_s) * END_S / 10.0, interface_c)).collect(),
            },
        ]);
    }
    Ok(Figure {
        number: "6-10",
        title: format!("Skin and material surface beside perfect contact, {SIMULATION}"),
        x: TIME,
        y: TEMPERATURE,
        curves,
    })
}

/// Heat flux into copper for three roughnesses and three pressures.
pub(super) fn figures_6_11_and_6_12(solver: &dyn ContactSolver) -> anyhow::Result<[Figure; 2]> {
    let copper = Case::simulation(material("copper"));
    let flux = |case: &Case, label: String, group| {
        over_time(solver, case, |at| at.flux_w_m2, (label, Kind::Line, group))
    };
    let finishes =
        [(copper.object.surface.roughness_um, "as in Table 4-1"), (8.0, "milled"), (30.0, "sawn")];
    let rough = finishes.into_iter().enumerate().map(|(group, (roughness_um, finish))| {
        let mut case = copper;
        case.object.surface.roughness_um = roughness_um;
        flux(&case, format!("Rq {roughness_um} µm, {finish}"), group)
    });
    let pressed = THESIS_PRESSURES[2..].iter().enumerate().map(|(group, (force_n, stated_pa))| {
        let case = Case { pressure_pa: pressure_pa(*force_n), ..copper };
        flux(&case, format!("{:.2} kPa ({force_n} N)", stated_pa * 1e-3), group)
    });
    let figure = |number, title: &str, curves| Figure {
        number,
        title: title.into(),
        x: TIME,
        y: FLUX,
        curves,
    };
    Ok([
        figure(
            "6-11",
            "Copper of three finishes, 34 and 24 °C, 14.81 kPa",
            rough.collect::<anyhow::Result<_>>()?,
        ),
        figure(
            "6-12",
            "Copper at three pressures, 34 and 24 °C",
            pressed.collect::<anyhow::Result<_>>()?,
        ),
    ])
}
