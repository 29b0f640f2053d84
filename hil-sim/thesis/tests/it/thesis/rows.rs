//! Computed values of the rows against golden values.

use contact_model::material::{THESIS_MATERIALS, average_slope_rad, find};
use contact_model::reference::fourier_number;
use serde::Deserialize;

use super::{NAMES, all_rows, computed, name, table};

#[test]
fn interface_temperatures_meet_golden_values() {
    #[derive(Deserialize)]
    struct Golden {
        material: String,
        #[serde(rename = "T_skin_i_C")]
        skin_before_c: f64,
        #[serde(rename = "T_material_i_C")]
        object_before_c: f64,
        #[serde(rename = "e_from_k_rho_c")]
        effusivity: f64,
        #[serde(rename = "T_s_C")]
        interface_c: f64,
    }
    let mut checked = 0;
    let golden = table::<Golden>(include_str!("../../../../../model/tests/data/semi_infinite.csv"));
    let of_thesis = |golden: &&Golden| THESIS_MATERIALS.contains(&golden.material.as_str());
    for golden in golden.iter().filter(of_thesis) {
        let name = name(&golden.material);
        let of = |place: &str, what: &str| computed(place, &format!("{name}, {what}"));
        let (computed_c, effusivity) = match (golden.skin_before_c, golden.object_before_c) {
            (33.0, 24.0) if name != "ZnS" => {
                (of("Table 3-1", "interface"), of("Table 3-1", "contact coefficient"))
            }
            (34.0, 23.5) if name == "copper" || name == "foam" => {
                (of("Section 4.2.3", "interface"), of("Table 3-4", "contact coefficient"))
            }
            _ => continue,
        };
        assert!((computed_c - golden.interface_c).abs() < 1e-9, "{name}: {computed_c}");
        assert!((effusivity / golden.effusivity - 1.0).abs() < 1e-12, "{name}: {effusivity}");
        checked += 1;
    }
    assert_eq!(checked, 6);
}

#[test]
fn display_ratios_meet_golden_values() {
    #[derive(Deserialize)]
    struct Golden {
        material: String,
        condition: String,
        ratio: f64,
    }
    let golden = table::<Golden>(include_str!("../../../../../model/tests/data/resistance.csv"));
    let five = ["copper", "stainless-steel", "granite", "abs", "foam"];
    let simulation = golden.iter().filter(|golden| {
        golden.condition == "sim_2N_135mm2" && five.contains(&golden.material.as_str())
    });
    let mut checked = 0;
    for golden in simulation {
        let quantity = format!("{}, ratio of resistances display / object", name(&golden.material));
        let error = computed("Section 6.3", &quantity) - golden.ratio;
        assert!(error.abs() < 1e-12, "{quantity}: off by {error:e}");
        checked += 1;
    }
    assert_eq!(checked, 5);
}

/// The factor of Eq. 6-13 is valid for Gaussian surfaces; for sines its error is the ratio of the two rows.
#[test]
fn slope_factors_meet_golden_sines() {
    #[derive(Deserialize)]
    struct Golden {
        #[serde(rename = "Rdq")]
        rms_slope: f64,
        mean_abs_slope: f64,
    }
    let sine = computed("Eq. 6-13", "RMS over mean slope, sine profile");
    let model = computed("Eq. 6-13", "factor of the model");
    for golden in
        table::<Golden>(include_str!("../../../../../model/tests/data/roughness_sinusoid.csv"))
    {
        assert!((golden.rms_slope / golden.mean_abs_slope - sine).abs() < 1e-12);
        let estimate = average_slope_rad(golden.rms_slope);
        assert!((estimate / golden.mean_abs_slope - sine / model).abs() < 1e-12);
    }
}

/// Characteristic lengths that the Fourier numbers require: every row of a table agrees within these limits only.
#[test]
fn fourier_numbers_bound_the_characteristic_lengths() {
    let agree = |place: &str, t_s: f64, length_m: f64| {
        let rows = all_rows().into_iter().filter(|row| row.place == place);
        let mut fourier = rows.filter(|row| row.quantity.contains("Fourier")).peekable();
        assert!(fourier.peek().is_some(), "no Fourier numbers in {place}");
        fourier.all(|row| {
            let known =
                NAMES.iter().find(|(_, name)| row.quantity.starts_with(&format!("{name},")));
            let material =
                find(known.expect("a known material").0).expect("a material of the model");
            row.stated.agrees(fourier_number(material, length_m, t_s))
        })
    };
    for (place, t_s, within, beyond) in [
        ("Table 3-1", 5.0, [12.706e-3, 12.71e-3, 12.723e-3], [12.705e-3, 12.725e-3]),
        ("Table 3-4", 10.0, [149.2e-3, 151.4e-3, 153.8e-3], [149.0e-3, 154.0e-3]),
    ] {
        for length_m in within {
            assert!(agree(place, t_s, length_m), "{place}: {length_m} m");
        }
        for length_m in beyond {
            assert!(!agree(place, t_s, length_m), "{place}: {length_m} m");
        }
    }
}
