//! Errors of perfect contact (Eq. 3-1 to 3-4).

use contact_model::fixed_point::Celsius;
use contact_model::material::{SKIN, find};
use contact_model::reference::{SemiInfinite, fourier_number, interface_temperature};

use super::chain::{contact_pair, of_thesis};
use super::sweep::{points, relative, worst};
use crate::golden::{Row, material, number, rows};

fn temperatures(row: &Row) -> (f64, f64) {
    (number(row, "T_skin_i_C"), number(row, "T_material_i_C"))
}

fn golden_f64(row: &Row) -> SemiInfinite<f64> {
    let (skin_c, object_c) = temperatures(row);
    SemiInfinite::new((&SKIN, skin_c), (material(row), object_c))
}

pub fn interface_f64() -> f64 {
    worst(
        rows("semi_infinite")
            .iter()
            .map(|row| 1e6 * (golden_f64(row).interface_c - number(row, "T_s_C"))),
    )
}

pub fn depth_f64() -> f64 {
    worst(rows("semi_infinite_profile").iter().map(|row| {
        let t = golden_f64(row).skin_at_depth(number(row, "x_m"), number(row, "t_s"));
        1e6 * (t - number(row, "T_skin_x_t_C"))
    }))
}

pub fn flux_f64() -> f64 {
    worst(rows("semi_infinite_profile").iter().map(|row| {
        let flux = golden_f64(row).flux_w_m2(number(row, "t_s")).expect("after landing");
        relative(flux, number(row, "q_eq3_3_signed_W_m2"))
    }))
}

pub fn interface_fixed() -> f64 {
    let golden = rows("semi_infinite").into_iter().map(|row| {
        let (skin_c, object_c) = temperatures(&row);
        let t = contact_pair(material(&row), 1e-3)
            .interface_temperature(Celsius::from_num(skin_c), Celsius::from_num(object_c));
        1e6 * (t.to_num::<f64>() - number(&row, "T_s_C"))
    });
    let swept = points::<3>(20_000).map(|[index, skin, object]| {
        let object_material = of_thesis((index * 8.0) as usize);
        let [skin, object] = [skin, object].map(|part| Celsius::from_num(165.0 * part - 40.0));
        let t = contact_pair(object_material, 1e-3).interface_temperature(skin, object);
        1e6 * (t.to_num::<f64>()
            - interface_temperature::<f64>(&SKIN, skin.to_num(), object_material, object.to_num()))
    });
    worst(golden.chain(swept))
}

/// Table 3-1, to the digits printed. The length of the samples follows from the Fourier number of copper.
pub fn fourier_f64() -> f64 {
    let printed = [
        ("copper", 3.58, 0.01),
        ("bronze", 0.54, 0.01),
        ("stainless-steel", 0.11, 0.01),
        ("g10", 0.003, 0.001),
        ("abs", 0.004, 0.001),
        ("foam", 0.03, 0.01),
    ];
    worst(printed.into_iter().map(|(name, number, digit)| {
        let object = find(name).expect("material");
        (fourier_number(object, 12.71e-3, 5.0) - number) / digit
    }))
}
