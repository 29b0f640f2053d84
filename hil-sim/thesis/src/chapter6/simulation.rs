//! Section 6.3: what the text says of the simulations and of figures 6-6 to 6-12.

use contact_model::pressure::pressure_pa;

use crate::case::{Case, SIMULATION_PRESSURE_PA, five, sample};
use crate::row::{Correction, Row};
use crate::stated::{Stated, printed};

/// End of every simulation, s.
const END_S: f64 = 10.0;
/// Movement over the last second that a figure over 10 K would show as steady, K.
const STEADY_K: f64 = 0.1;
/// Roughness of milled copper in figure 6-11, µm.
const MILLED_UM: f64 = 8.0;
/// Roughness of sawn copper in figure 6-11, µm.
const SAWN_UM: f64 = 30.0;

/// R_display / R_object.
pub(super) fn ratios() -> Vec<Row> {
    let stated = [0.93, 0.90, 0.82, 0.30, 0.07];
    let rows = five().into_iter().zip(stated).map(|(sample, stated)| {
        Row::new(
            "Section 6.3",
            format!("{}, ratio of resistances display / object", sample.name),
            "",
            printed(stated, 2),
            Case::simulation(&sample).contact().ratio,
        )
        .note("on the reference display, whose one free number was solved from these five")
    });
    rows.collect()
}

/// How many neighbours of a list fall.
fn falling(values: &[f64]) -> usize {
    values.windows(2).filter(|pair| pair[0] > pair[1]).count()
}

pub(super) fn figures_6_6_to_6_9() -> Vec<Row> {
    let cases = five().map(|sample| (sample, Case::simulation(&sample)));
    let mut rows = Vec::new();
    for (sample, case) in &cases {
        let contact = case.contact();
        let (start, before, end) = (contact.at(0.0), contact.at(END_S - 1.0), contact.at(END_S));
        let steady = Stated::About {
            value: 0.0,
            within: STEADY_K,
        };
        let row = |place, what: &str, unit, stated, computed| {
            Row::new(
                place,
                format!("{}, {what}", sample.name),
                unit,
                stated,
                computed,
            )
        };
        rows.extend([
            row(
                "Figure 6-6",
                "skin at landing",
                "°C",
                printed(34.0, 0),
                start.skin_c,
            ),
            row(
                "Figure 6-7",
                "surface at landing",
                "°C",
                printed(24.0, 0),
                start.object_c,
            ),
            row(
                "Figure 6-6",
                "skin, movement in the last second",
                "K",
                steady,
                end.skin_c - before.skin_c,
            ),
            row(
                "Figure 6-7",
                "surface, movement in the last second",
                "K",
                steady,
                end.object_c - before.object_c,
            ),
            row(
                "Figure 6-9",
                "display at 10 s, way from surface to skin",
                "",
                // "Similar to their corresponding material surface temperatures", or "closer to" the skin's.
                match sample.name {
                    "ABS" | "foam" => Stated::Between {
                        low: 0.5,
                        high: 1.0,
                    },
                    _ => Stated::Between {
                        low: 0.0,
                        high: 0.5,
                    },
                },
                (end.display_c - end.object_c) / (end.skin_c - end.object_c),
            ),
        ]);
    }
    let at_end = |value: fn(&Case) -> f64| cases.map(|(_, case)| value(&case));
    let ordered = |place, what, values: [f64; 5]| {
        Row::new(place, what, "", printed(4.0, 0), falling(&values) as f64)
    };
    rows.extend([
        ordered(
            "Figure 6-6",
            "neighbours, of 4, whose higher coefficient cools the skin more",
            at_end(|case| case.drop_k(END_S)),
        ),
        ordered(
            "Figure 6-7",
            "neighbours, of 4, whose higher coefficient warms itself less",
            at_end(|case| case.object_c - case.contact().at(END_S).object_c),
        ),
        ordered(
            "Figure 6-8",
            "neighbours, of 4, whose higher coefficient takes more flux",
            at_end(|case| case.contact().at(END_S).flux_w_m2),
        ),
    ]);
    rows
}

/// The revised model against perfect contact, at 10 s.
pub(super) fn figure_6_10() -> Vec<Row> {
    let cases = five().map(|sample| Case::simulation(&sample));
    let skin = cases.map(|case| case.contact().at(END_S).skin_c - case.perfect().interface_c);
    let surface = cases.map(|case| case.perfect().interface_c - case.contact().at(END_S).object_c);
    let positive = |values: &[f64]| values.iter().filter(|value| **value > 0.0).count() as f64;
    let row =
        |what: &str, unit, stated, computed| Row::new("Figure 6-10", what, unit, stated, computed);
    let none = Stated::About {
        value: 0.0,
        within: STEADY_K,
    };
    let rising: Vec<f64> = surface.iter().rev().copied().collect();
    vec![
        row(
            "materials, of 5, whose skin is warmer than at perfect contact",
            "",
            printed(5.0, 0),
            positive(&skin),
        ),
        row(
            "materials, of 5, colder than at perfect contact",
            "",
            printed(5.0, 0),
            positive(&surface),
        ),
        row(
            "neighbours, of 4, whose higher coefficient differs more, skin",
            "",
            printed(4.0, 0),
            falling(&skin) as f64,
        ),
        row(
            "neighbours, of 4, whose higher coefficient differs less, surface",
            "",
            printed(4.0, 0),
            falling(&rising) as f64,
        )
        .wrong(
            "foam's difference is smaller than that of ABS, not larger: its E has fallen further by 10 s",
            Correction::Reads(printed(3.0, 0)),
        ),
        row("foam, difference of skin", "K", none, skin[4]),
        row("copper, difference of surface", "K", none, surface[0]),
    ]
}

/// Coldness of copper over roughness and over pressure.
pub(super) fn figures_6_11_and_6_12() -> Vec<Row> {
    let copper = sample("copper");
    let smooth = Case::simulation(&copper);
    let rough = |roughness_um| {
        let mut case = smooth;
        case.object.surface.roughness_um = roughness_um;
        case
    };
    let pressed = |force_n| Case {
        pressure_pa: pressure_pa(force_n),
        ..smooth
    };
    let flux = |case: &Case, t_s| case.contact().at(t_s).flux_w_m2;
    let sawn = rough(SAWN_UM);
    let difference = |t_s| flux(&smooth, t_s) - flux(&sawn, t_s);
    let seconds_in_order = |cases: &[Case; 3]| {
        let in_order = |t_s: &f64| falling(&cases.map(|case| flux(&case, *t_s))) == 2;
        (0..=10u8).map(f64::from).filter(in_order).count() as f64
    };
    let (light, firm) = (pressed(0.5), pressed(2.0));
    vec![
        Row::new(
            "Figure 6-11",
            "seconds, of 0 to 10, with flux smooth > milled > sawn",
            "",
            printed(11.0, 0),
            seconds_in_order(&[smooth, rough(MILLED_UM), sawn]),
        ),
        Row::new(
            "Figure 6-11",
            "flux smooth - sawn after 1 s, part of that at landing",
            "",
            Stated::Below(0.5),
            difference(1.0) / difference(0.0),
        ),
        Row::new(
            "Figure 6-12",
            "seconds, of 0 to 10, with more flux for more pressure",
            "",
            printed(11.0, 0),
            seconds_in_order(&[firm, pressed(1.0), light]),
        ),
        Row::new(
            "Figure 6-12",
            "influence on the first flux, pressure over roughness",
            "",
            Stated::Above(1.0),
            (flux(&firm, 0.0) / flux(&light, 0.0)) / (flux(&smooth, 0.0) / flux(&sawn, 0.0)),
        ),
        Row::new(
            "Section 6.4.3",
            "largest pressure computed with; Eq. 6-8: 35 to 350 kPa",
            "kPa",
            Stated::Below(35.0),
            SIMULATION_PRESSURE_PA * 1e-3,
        )
        .note("the thesis says itself that Eq. 6-8 is extrapolated"),
    ]
}
