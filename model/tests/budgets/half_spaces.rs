//! Perfect contact, Eq. 3-1 to 3-4.

use std::collections::HashMap;

use contact_model::fixed_point::{self, Celsius, Depth, MantissaExponent, Ticks};
use contact_model::material::{MATERIALS, Material, SKIN, find};
use contact_model::reference::{SemiInfinite, fourier_number, interface_temperature};

use crate::golden::{number, rows};
use crate::sweep::{UNIT, log_between, pair, points, relative, worst};

type Row = HashMap<String, String>;

fn material(row: &Row) -> &'static Material {
    find(&row["material"]).expect("material")
}

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
        let flux = golden_f64(row)
            .flux_w_m2(number(row, "t_s"))
            .expect("after landing");
        relative(flux, number(row, "q_eq3_3_signed_W_m2"))
    }))
}

fn fixed(object: &Material, tick_s: f64) -> fixed_point::SemiInfinite {
    fixed_point::SemiInfinite::new(&SKIN, object, tick_s).expect("ordinary material")
}

fn celsius(row: &Row) -> (Celsius, Celsius) {
    let (skin_c, object_c) = temperatures(row);
    (Celsius::from_num(skin_c), Celsius::from_num(object_c))
}

pub fn interface_fixed() -> f64 {
    let golden = rows("semi_infinite").into_iter().map(|row| {
        let (skin, object) = celsius(&row);
        let t = fixed(material(&row), 1e-3).interface_temperature(skin, object);
        1e6 * (t.to_num::<f64>() - number(&row, "T_s_C"))
    });
    let swept = points::<3>(20_000).map(|[index, skin, object]| {
        let object_material = &MATERIALS[(index * 8.0) as usize].1;
        let [skin, object] = [skin, object].map(|part| Celsius::from_num(165.0 * part - 40.0));
        let t = fixed(object_material, 1e-3).interface_temperature(skin, object);
        1e6 * (t.to_num::<f64>()
            - interface_temperature::<f64>(&SKIN, skin.to_num(), object_material, object.to_num()))
    });
    worst(golden.chain(swept))
}

pub fn depth_fixed() -> f64 {
    let golden = rows("semi_infinite_profile").into_iter().map(|row| {
        let (skin, object) = celsius(&row);
        let depth = Depth::from_num(1e6 * number(&row, "x_m"));
        let t = fixed(material(&row), number(&row, "t_s")).skin_at_depth(
            depth,
            Ticks::ONE,
            skin,
            object,
        );
        1e6 * (t.to_num::<f64>() - number(&row, "T_skin_x_t_C"))
    });
    let swept = points::<6>(40_000).map(|[index, skin, step, depth, tick, elapsed]| {
        let object_material = &MATERIALS[(index * 8.0) as usize].1;
        let (skin, object) = pair(skin, step);
        let tick_s = log_between(tick, 1e-5, 0.1);
        let elapsed = log_between(elapsed, 1.0, f64::from(Ticks::MAX.get())) as u32;
        let depth = Depth::from_num(log_between(depth, 1.6e-5, 65535.9));
        let ticks = Ticks::new(elapsed).expect("in range");
        let t = fixed(object_material, tick_s).skin_at_depth(depth, ticks, skin, object);
        let truth =
            SemiInfinite::<f64>::new((&SKIN, skin.to_num()), (object_material, object.to_num()))
                .skin_at_depth(1e-6 * depth.to_num::<f64>(), tick_s * f64::from(elapsed));
        1e6 * (t.to_num::<f64>() - truth)
    });
    worst(golden.chain(swept))
}

/// Relative error, less the resolution of the flux.
pub fn flux_fixed() -> f64 {
    let error = |flux: fixed_point::Flux, truth: f64| {
        let beyond =
            (flux.to_num::<f64>() - truth).abs() - fixed_point::Flux::DELTA.to_num::<f64>();
        1e9 * beyond.max(0.0) / truth.abs()
    };
    let golden = rows("semi_infinite_profile").into_iter().map(|row| {
        let (skin, object) = celsius(&row);
        let flux = fixed(material(&row), number(&row, "t_s")).flux_w_m2(Ticks::ONE, skin, object);
        error(flux, number(&row, "q_eq3_3_signed_W_m2"))
    });
    let swept = points::<5>(40_000).filter_map(|[index, skin, step, tick, elapsed]| {
        let object_material = &MATERIALS[(index * 8.0) as usize].1;
        let (skin, object) = pair(skin, step);
        let tick_s = log_between(tick, 1e-5, 0.1);
        let elapsed = log_between(elapsed, 1.0, f64::from(Ticks::MAX.get())) as u32;
        let flux = fixed(object_material, tick_s).flux_w_m2(
            Ticks::new(elapsed).expect("in range"),
            skin,
            object,
        );
        let truth =
            SemiInfinite::<f64>::new((&SKIN, skin.to_num()), (object_material, object.to_num()))
                .flux_w_m2(tick_s * f64::from(elapsed))
                .expect("after landing");
        // For a smaller step the rounding of the temperatures in `f64` shows.
        (skin.abs_diff(object) >= 1).then(|| error(flux, truth))
    });
    worst(golden.chain(swept))
}

/// Table 3-1, whose samples' length follows from the copper's number; as many digits as are printed.
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

pub fn fourier_fixed() -> f64 {
    worst(points::<2>(40_000).map(|[number, elapsed]| {
        let elapsed = log_between(elapsed, 1.0, f64::from(Ticks::MAX.get())) as u32;
        let rate_per_tick = log_between(number, 1e-12, 1000.0) / f64::from(elapsed);
        let rate_per_tick = MantissaExponent::from_f64(rate_per_tick).expect("normal");
        let number =
            fixed_point::fourier_number(rate_per_tick, Ticks::new(elapsed).expect("in range"));
        (number.to_num::<f64>() - rate_per_tick.to_f64() * f64::from(elapsed)) / UNIT
    }))
}
