//! Conditions and results of Ho's experiments (H.-N. Ho, *Development and Evaluation of a Thermal Model for Haptic
//! Interfaces*, Ph.D. thesis, MIT, 2006) beside those of [`thermal_thesis::published`].

/// Materials of Table 3-3 (section 3.2), the coldest first.
pub const TABLE_3_3_MATERIALS: [&str; 6] =
    ["copper", "bronze", "stainless-steel", "g10", "abs", "foam"];

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
