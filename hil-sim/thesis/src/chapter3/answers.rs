//! Tables 3-3 and 3-5: contact coefficient ratios, proportions correct and sensitivities.

use contact_model::material::Material;

use crate::case::{sample, tabulated_effusivity};
use crate::row::{Correction, Row};
use crate::sensitivity::d_prime;
use crate::stated::{Stated, cut, printed};

/// Table 3-3: the two materials and the percentage of correct answers.
const TABLE_3_3: [(&str, &str, f64); 15] = [
    ("copper", "bronze", 70.0),
    ("copper", "stainless-steel", 75.0),
    ("copper", "g10", 95.0),
    ("copper", "abs", 98.0),
    ("copper", "foam", 100.0),
    ("bronze", "stainless-steel", 68.0),
    ("bronze", "g10", 98.0),
    ("bronze", "abs", 98.0),
    ("bronze", "foam", 100.0),
    ("stainless-steel", "g10", 98.0),
    ("stainless-steel", "abs", 100.0),
    ("stainless-steel", "foam", 95.0),
    ("g10", "abs", 78.0),
    ("g10", "foam", 90.0),
    ("abs", "foam", 85.0),
];
/// Percentage from which on a pair counts as told apart (section 3.2.2).
const THRESHOLD: f64 = 72.0;

/// A line of Table 3-5.
struct Pair {
    materials: (&'static str, &'static str),
    ratio: f64,
    /// Percentage correct and d' in each of [`MODES`].
    columns: [(f64, f64); 3],
}

const fn pair(
    one: &'static str,
    other: &'static str,
    ratio: f64,
    percent: [f64; 3],
    sensitivity: [f64; 3],
) -> Pair {
    let columns = [
        (percent[0], sensitivity[0]),
        (percent[1], sensitivity[1]),
        (percent[2], sensitivity[2]),
    ];
    Pair {
        materials: (one, other),
        ratio,
        columns,
    }
}

const TABLE_3_5: [Pair; 10] = [
    pair(
        "stainless-steel",
        "granite",
        2.96,
        [30.0, 43.0, 37.0],
        [-0.12, 0.33, 0.13],
    ),
    pair(
        "granite",
        "abs",
        4.76,
        [53.0, 44.0, 49.0],
        [0.65, 0.36, 0.52],
    ),
    pair(
        "copper",
        "stainless-steel",
        5.25,
        [38.0, 39.0, 38.0],
        [0.16, 0.20, 0.16],
    ),
    pair(
        "stainless-steel",
        "abs",
        14.07,
        [72.0, 59.0, 66.0],
        [1.31, 0.85, 1.09],
    ),
    pair(
        "copper",
        "granite",
        15.52,
        [56.0, 44.0, 50.0],
        [0.75, 0.36, 0.56],
    ),
    pair("abs", "foam", 17.28, [68.0, 46.0, 57.0], [1.16, 0.43, 0.78]),
    pair(
        "copper",
        "abs",
        73.83,
        [69.0, 51.0, 60.0],
        [1.20, 0.59, 0.89],
    ),
    pair(
        "granite",
        "foam",
        82.21,
        [68.0, 61.0, 64.0],
        [1.16, 0.92, 1.02],
    ),
    pair(
        "stainless-steel",
        "foam",
        243.03,
        [79.0, 62.0, 71.0],
        [1.61, 0.95, 1.28],
    ),
    pair(
        "copper",
        "foam",
        1275.59,
        [82.0, 66.0, 74.0],
        [1.75, 1.09, 1.39],
    ),
];
const MODES: [&str; 3] = ["high / low", "low / high", "total"];

/// Ratio of two contact coefficients, as `effusivity` has them.
fn ratio(one: &'static str, other: &'static str, effusivity: impl Fn(&Material) -> f64) -> f64 {
    effusivity(&sample(one).material) / effusivity(&sample(other).material)
}

/// "Subjects were able to discriminate reliably between two materials when the ratio of the contact coefficients
/// of the materials exceeded three", and the only two pairs that they did not.
pub(super) fn table_3_3() -> Vec<Row> {
    let exceeding = TABLE_3_3
        .iter()
        .filter(|(one, other, _)| ratio(one, other, Material::effusivity) > 3.0);
    let worst = exceeding.fold(f64::MAX, |worst, (.., percent)| worst.min(*percent));
    let failed = TABLE_3_3
        .iter()
        .filter(|(.., percent)| *percent < THRESHOLD);
    let failed = failed.map(|(one, other, _)| {
        Row::new(
            "Section 3.2.2",
            format!(
                "{} / {}, ratio of contact coefficients",
                sample(one).name,
                sample(other).name
            ),
            "",
            Stated::Below(3.0),
            ratio(one, other, Material::effusivity),
        )
    });
    let mut rows = vec![Row::new(
        "Table 3-3",
        "least correct of the pairs with a ratio above 3",
        "%",
        Stated::Above(THRESHOLD),
        worst,
    )];
    rows.extend(failed);
    rows
}

pub(super) fn ratios() -> Vec<Row> {
    let rows = TABLE_3_5.iter().map(|pair| {
        let (one, other) = pair.materials;
        let tabulated = ratio(one, other, tabulated_effusivity);
        let stated = printed(pair.ratio, 2);
        let (why, tabulated) = if stated.agrees(tabulated) {
            ("ratio of the cut coefficients of Table 3-4", tabulated)
        } else {
            (
                "ratio of the cut coefficients of Table 3-4, itself cut",
                cut(tabulated, 2),
            )
        };
        Row::new(
            "Table 3-5",
            format!(
                "{} / {}, ratio of contact coefficients",
                sample(one).name,
                sample(other).name
            ),
            "",
            stated,
            ratio(one, other, Material::effusivity),
        )
        .wrong(why, Correction::Is(tabulated))
    });
    rows.collect()
}

/// d' of the printed percentages.
pub(super) fn sensitivities() -> Vec<Row> {
    let mut rows = Vec::new();
    for pair in TABLE_3_5 {
        let (one, other) = pair.materials;
        for (mode, (percent, stated)) in MODES.iter().zip(pair.columns) {
            let row = Row::new(
                "Table 3-5",
                format!(
                    "{} / {}, {mode}, d' of {percent} %",
                    sample(one).name,
                    sample(other).name
                ),
                "",
                printed(stated, 2),
                d_prime(3, percent / 100.0),
            );
            rows.push(if percent == 57.0 {
                row.wrong(
                    "not rounded as its neighbours are",
                    Correction::Reads(printed(0.79, 2)),
                )
            } else {
                row
            });
        }
    }
    rows
}

/// Means that the text of section 3.3 states.
pub(super) fn means() -> Vec<Row> {
    let mean = |percents: &[f64]| percents.iter().sum::<f64>() / percents.len() as f64;
    let shared = |(one, other): (&str, &str)| {
        let both = ["copper", "stainless-steel", "abs", "foam"];
        both.contains(&one) && both.contains(&other)
    };
    let first: Vec<f64> = TABLE_3_3.iter().map(|row| row.2).collect();
    let second: Vec<f64> = TABLE_3_5.iter().map(|pair| pair.columns[2].0).collect();
    let of_shared = |column: usize| {
        let rows = TABLE_3_5.iter().filter(|pair| shared(pair.materials));
        mean(&rows.map(|pair| pair.columns[column].0).collect::<Vec<_>>())
    };
    let first_shared = TABLE_3_3.iter().filter(|row| shared((row.0, row.1)));
    let first_shared = mean(&first_shared.map(|row| row.2).collect::<Vec<_>>());
    vec![
        Row::new(
            "Section 3.3.2",
            "mean correct of Table 3-3",
            "%",
            printed(90.0, 0),
            mean(&first),
        ),
        Row::new(
            "Section 3.3.2",
            "mean correct of Table 3-5, total",
            "%",
            printed(57.0, 0),
            mean(&second),
        ),
        Row::new(
            "Section 3.3.3",
            "fall from Table 3-3 to 3-5, materials of both",
            "%",
            printed(26.0, 0),
            first_shared - of_shared(2),
        )
        .wrong(
            "only the fall to high / low alone, as a part of Table 3-3's mean, comes to that",
            Correction::Is((first_shared - of_shared(0)) / first_shared * 100.0),
        ),
    ]
}
