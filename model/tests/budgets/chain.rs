//! Errors from material and force to the outputs, against golden values and the `f64` reference.

use contact_model::fixed_point::{
    Celsius, ContactPair, Flux, Force, Log2, Ratio, Response, Ticks, log2_relative_pressure,
};
use contact_model::material::{
    Material, REFERENCE_DISPLAY, SKIN, SKIN_MICROHARDNESS_PA, THESIS_MATERIALS, find,
};
use contact_model::pressure::pressure_pa;
use contact_model::reference;

use super::sweep::{UNIT, log_between, points, relative, skin_and_object, worst};
use crate::golden::{material, number, rows};

/// Forces of the whole range: logarithmic, near zero, and around the five points where the slope of the area changes.
fn forces() -> impl Iterator<Item = Force> {
    let points_of_thesis = [0.1, 0.25, 0.5, 1.0, 2.0].map(|n| Force::from_num(n).to_bits());
    let around = points_of_thesis.into_iter().flat_map(|bits| bits - 4..=bits + 4);
    let wide = points::<1>(20_000).map(|[part]| log_between(part, 1.0, f64::from(u32::MAX)) as u32);
    around.chain(1..1000).chain(wide).map(Force::from_bits)
}

pub fn log2_pressure() -> f64 {
    worst(forces().map(|force| {
        let expected = (pressure_pa(force.to_num()) / SKIN_MICROHARDNESS_PA).log2();
        (log2_relative_pressure(force).to_num::<f64>() - expected) / UNIT
    }))
}

pub(super) fn contact_pair(object: &Material, tick_s: f64) -> ContactPair {
    ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, tick_s).expect("ordinary material")
}

fn float(object: &Material, pressure_pa: f64) -> reference::Contact<f64> {
    reference::Contact::new((&SKIN, 0.0), (object, 0.0), &REFERENCE_DISPLAY, pressure_pa)
}

fn log2_of_pressure(pressure_pa: f64) -> Log2 {
    Log2::from_num((pressure_pa / SKIN_MICROHARDNESS_PA).log2())
}

/// A material of the thesis by its position.
pub fn of_thesis(index: usize) -> &'static Material {
    find(THESIS_MATERIALS[index]).expect("a material of the thesis")
}

/// Every force, with the materials of the thesis in turn.
fn each_force() -> impl Iterator<Item = (&'static Material, Force)> {
    forces()
        .zip((0..THESIS_MATERIALS.len()).cycle())
        .map(|(force, index)| (of_thesis(index), force))
}

pub fn resistance() -> f64 {
    let golden = rows("resistance").into_iter().map(|row| {
        let contact =
            contact_pair(material(&row), 1e-3).at_pressure(log2_of_pressure(number(&row, "P_Pa")));
        (contact, number(&row, "R_m2K_W"))
    });
    let swept = each_force().map(|(object, force)| {
        let contact = contact_pair(object, 1e-3).at_pressure(log2_relative_pressure(force));
        (contact, float(object, pressure_pa(force.to_num())).resistance_m2k_w)
    });
    worst(
        (golden.chain(swept))
            .map(|(contact, r)| 1e9 * relative(1.0 / contact.conductance_w_m2k.to_f64(), r)),
    )
}

pub fn per_tick() -> f64 {
    let golden = rows("resistance").into_iter().map(|row| {
        let contact =
            contact_pair(material(&row), 1e-3).at_pressure(log2_of_pressure(number(&row, "P_Pa")));
        (contact, number(&row, "b_per_sqrt_s").powi(2) * 1e-3)
    });
    let swept = [1e-5, 1e-3, 0.1].into_iter().flat_map(|tick_s| {
        each_force().map(move |(object, force)| {
            let contact = contact_pair(object, tick_s).at_pressure(log2_relative_pressure(force));
            (contact, float(object, pressure_pa(force.to_num())).rate_per_s * tick_s)
        })
    });
    worst(
        (golden.chain(swept)).map(|(contact, k)| 1e9 * relative(contact.rate_per_tick.to_f64(), k)),
    )
}

/// Materials from insulators to conductors beyond diamond; slopes from mirrors to those that make `r` nearly 16.
fn own_materials() -> impl Iterator<Item = Material> {
    points::<4>(5000).map(|[k, rho, c, slope]| {
        let mut own = *of_thesis(0);
        own.surface.conductivity_w_mk = log_between(k, 0.01, 3000.0);
        own.surface.slope_rad = log_between(slope, 1e-3, 4.5);
        own.density_kg_m3 = log_between(rho, 1.0, 22_000.0);
        own.specific_heat_j_kgk = log_between(c, 100.0, 14_000.0);
        own
    })
}

pub fn ratio() -> f64 {
    let golden = rows("resistance").into_iter().map(|row| {
        contact_pair(material(&row), 1e-3).ratio().to_num::<f64>() - number(&row, "ratio")
    });
    let own = own_materials()
        .map(|own| contact_pair(&own, 1e-3).ratio().to_num::<f64>() - float(&own, 1e4).ratio);
    worst(golden.chain(own)) * 1e9
}

pub fn weight() -> f64 {
    let golden = rows("semi_infinite").into_iter().map(|row| {
        let (skin, object) = (number(&row, "T_skin_i_C"), number(&row, "T_material_i_C"));
        let truth = (skin - number(&row, "T_s_C")) / (skin - object);
        contact_pair(material(&row), 1e-3).weight().to_num::<f64>() - truth
    });
    let own = own_materials()
        .map(|own| contact_pair(&own, 1e-3).weight().to_num::<f64>() - float(&own, 1e4).weight);
    worst(golden.chain(own)) * 1e9
}

/// Response in fixed point, exact response, and the heat flux at landing, `dT / R`.
struct Compared {
    fixed: Response,
    truth: reference::Response<f64>,
    landing_flux: f64,
}

/// Golden contacts. The time of each is one tick.
fn golden() -> impl Iterator<Item = Compared> {
    rows("contact").into_iter().map(|row| {
        let t_s = number(&row, "t_s");
        let (elapsed, tick_s) = if t_s == 0.0 { (0, 1.0) } else { (1, t_s) };
        let contact = contact_pair(material(&row), tick_s)
            .at_pressure(log2_of_pressure(number(&row, "P_Pa")));
        let (skin_c, object_c) = (number(&row, "T_skin_i_C"), number(&row, "T_object_i_C"));
        Compared {
            fixed: contact.at(elapsed, Celsius::from_num(skin_c), Celsius::from_num(object_c)),
            truth: reference::Response {
                erfcx: number(&row, "erfcx_z"),
                skin_c: number(&row, "T_skin_s_C"),
                object_c: number(&row, "T_object_s_C"),
                flux_w_m2: number(&row, "q_W_m2"),
                display_c: number(&row, "T_display_C"),
            },
            landing_flux: (skin_c - object_c).abs() / number(&row, "R_skin_object_m2K_W"),
        }
    })
}

/// Contacts of the stated domain: materials, resistances, ticks, times and temperatures. `ratio` replaces that of the
/// display.
fn swept(ratio: Option<f64>) -> impl Iterator<Item = Compared> {
    points::<6>(40_000).map(move |[index, r, tick, elapsed, skin, step]| {
        let object = of_thesis((index * 8.0) as usize);
        let r_m2k_w = log_between(r, 1e-7, 10.0);
        let tick_s = log_between(tick, 1e-5, 0.1);
        let elapsed = log_between(elapsed, 1.0, f64::from(Ticks::MAX.get())) as u32;
        let (skin_c, object_c) = skin_and_object(skin, step);

        // Eq. 6-8 solved for the pressure.
        let mean = reference::conductance_at_hardness::<f64>(&SKIN.surface, &object.surface);
        let log2_pressure = Log2::from_num(-(mean * r_m2k_w).log2() / 0.95);
        let pressure_pa = log2_pressure.to_num::<f64>().exp2() * SKIN_MICROHARDNESS_PA;
        let mut fixed = contact_pair(object, tick_s).at_pressure(log2_pressure);
        let mut truth = reference::Contact::<f64>::new(
            (&SKIN, skin_c.to_num()),
            (object, object_c.to_num()),
            &REFERENCE_DISPLAY,
            pressure_pa,
        );
        if let Some(ratio) = ratio {
            fixed.ratio = Ratio::from_num(ratio);
            truth.ratio = fixed.ratio.to_num();
        }
        Compared {
            fixed: fixed.at(elapsed, skin_c, object_c),
            truth: truth.at(tick_s * f64::from(elapsed)),
            landing_flux: (truth.skin_c - truth.object_c).abs() / truth.resistance_m2k_w,
        }
    })
}

fn both() -> impl Iterator<Item = Compared> {
    golden().chain(swept(None))
}

fn micro_kelvin(fixed: Celsius, truth: f64) -> f64 {
    1e6 * (fixed.to_num::<f64>() - truth)
}

pub fn skin() -> f64 {
    worst(both().map(|c| micro_kelvin(c.fixed.skin(), c.truth.skin_c)))
}

pub fn object() -> f64 {
    worst(both().map(|c| micro_kelvin(c.fixed.object(), c.truth.object_c)))
}

pub fn display() -> f64 {
    worst(
        (both().chain(swept(Some(2.0))))
            .map(|c| micro_kelvin(c.fixed.display(), c.truth.display_c)),
    )
}

/// Within the range of [`Celsius`].
pub fn display_steep() -> f64 {
    worst(
        (swept(Some(15.99)).filter(|c| c.truth.display_c.abs() < 511.0))
            .map(|c| micro_kelvin(c.fixed.display(), c.truth.display_c)),
    )
}

/// Relative error beyond the resolution of the flux.
pub fn flux() -> f64 {
    worst(both().map(|c| {
        let error = (c.fixed.flux_w_m2().to_num::<f64>() - c.truth.flux_w_m2).abs();
        let beyond = (error - Flux::DELTA.to_num::<f64>()).max(0.0);
        if beyond == 0.0 { 0.0 } else { 1e9 * beyond / c.landing_flux }
    }))
}

pub fn preset() -> f64 {
    let golden = rows("contact").into_iter().filter(|row| number(row, "t_s") == 0.0).map(|row| {
        let before = |column| Celsius::from_num(number(&row, column));
        let t =
            contact_pair(material(&row), 1e-3).preset(before("T_skin_i_C"), before("T_object_i_C"));
        micro_kelvin(t, number(&row, "T_display_C"))
    });
    let swept = points::<3>(20_000).map(|[index, skin, step]| {
        let object = of_thesis((index * 8.0) as usize);
        let (skin_c, object_c) = skin_and_object(skin, step);
        let step = (skin_c - object_c).to_num::<f64>();
        let truth = skin_c.to_num::<f64>() - float(object, 1e4).ratio * step;
        micro_kelvin(contact_pair(object, 1e-3).preset(skin_c, object_c), truth)
    });
    worst(golden.chain(swept))
}
