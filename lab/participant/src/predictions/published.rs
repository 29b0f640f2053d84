//! Results that Ho published, as data (H.-N. Ho, *Material Recognition Based on Thermal Cues: Mechanisms and Applications*,
//! Ph.D. thesis, MIT, 2006).

/// Materials of Table 3-3 (section 3.2), the coldest first.
pub const TABLE_3_3_MATERIALS: [&str; 6] =
    ["copper", "bronze", "stainless-steel", "g10", "abs", "foam"];

/// Number of trials behind each cell of Table 3-3: ten participants, four repetitions.
pub const TABLE_3_3_TRIALS: u32 = 40;

/// Table 3-3: colder and warmer material, and percentage of trials in which the colder one was said to be colder.
pub const TABLE_3_3: [(&str, &str, f64); 15] = [
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

/// Number of trials behind each cell of Table 3-5: ten participants, three positions, three repetitions.
pub const TABLE_3_5_TRIALS: u32 = 90;

/// Table 3-5 (section 3.3): colder and warmer material, and percentages of trials in which the target was found when it was
/// the colder one ("high/low") and when it was the warmer one ("low/high").
pub const TABLE_3_5: [(&str, &str, f64, f64); 10] = [
    ("stainless-steel", "granite", 30.0, 43.0),
    ("granite", "abs", 53.0, 44.0),
    ("copper", "stainless-steel", 38.0, 39.0),
    ("stainless-steel", "abs", 72.0, 59.0),
    ("copper", "granite", 56.0, 44.0),
    ("abs", "foam", 68.0, 46.0),
    ("copper", "abs", 69.0, 51.0),
    ("granite", "foam", 68.0, 61.0),
    ("stainless-steel", "foam", 79.0, 62.0),
    ("copper", "foam", 82.0, 66.0),
];

/// Skin and room of sections 3.2 and 3.3, °C.
pub const SECTION_3: (f64, f64) = (33.0, 24.0);

/// Materials of section 4.2.
pub const SECTION_4_2_MATERIALS: [&str; 5] =
    ["copper", "stainless-steel", "granite", "abs", "foam"];

/// Percentages of real and simulated materials that were identified in section 4.2, and the numbers of trials behind them: ten
/// participants, five materials, three and nine repetitions.
pub const SECTION_4_2: [(f64, u32); 2] = [(55.0, 150), (49.0, 450)];

/// Correlation between the 25 cells of the confusion matrices of real and of simulated materials in section 4.2.
pub const SECTION_4_2_CORRELATION: f64 = 0.78;

/// Skin and room of section 4.2, °C.
pub const SECTION_4_2_C: (f64, f64) = (34.0, 24.0);

/// Materials of section 4.3.
pub const SECTION_4_3_MATERIALS: [&str; 4] = ["copper", "stainless-steel", "granite", "abs"];

/// Skin at the gate and room of section 4.3, °C. The section also says that the skin was 24.5 to 32 °C before contact, with a
/// mean of 28.6 °C, which its own gate excludes.
pub const SECTION_4_3_C: (f64, f64) = (34.0, 21.6);

/// The same with the skin that the section reports.
pub const SECTION_4_3_REPORTED_C: (f64, f64) = (28.6, 21.2);

/// Threshold of discrimination in sections 3.2 and 4.3, per cent.
pub const THRESHOLD_PERCENT: f64 = 72.0;

/// Pairs of section 4.3 below the threshold, as real and simulated material: copper with stainless steel in both modes,
/// stainless steel with granite and granite with ABS where the simulated one is the colder.
pub const SECTION_4_3_BELOW: [(&str, &str); 4] = [
    ("copper", "stainless-steel"),
    ("stainless-steel", "copper"),
    ("granite", "stainless-steel"),
    ("abs", "granite"),
];
