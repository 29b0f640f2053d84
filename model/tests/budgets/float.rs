//! Errors of the floating-point reference against golden values.

use contact_model::material::{REFERENCE_DISPLAY, SKIN};
use contact_model::reference::{Contact, Real, contact_resistance, erfcx};

use super::sweep::{log_between, points, relative, worst};
use crate::golden::{Row, material, number, rows};

pub fn erfcx_f64() -> f64 {
    worst(rows("erfcx").iter().map(|row| relative(erfcx(number(row, "x")), number(row, "erfcx"))))
}

/// For arguments and results within the normal range of `f32`.
pub fn erfcx_f32() -> f64 {
    let error = |z: f32, truth: f64| {
        (truth > f64::from(f32::MIN_POSITIVE)).then(|| relative(f64::from(erfcx(z)), truth))
    };
    let golden = (rows("erfcx").into_iter().filter(|row| row["f32_exact"] == "1"))
        .filter_map(|row| error(number(&row, "x") as f32, number(&row, "erfcx")));
    let swept = points::<1>(100_000).filter_map(|[part]| {
        let z = log_between(part, 1e-8, 1e37) as f32;
        error(z, erfcx(f64::from(z)))
    });
    let around_the_change = (0..100_000).filter_map(|i| {
        let z = 1e-4 * i as f32;
        error(z, erfcx(f64::from(z)))
    });
    worst(golden.chain(swept).chain(around_the_change))
}

pub fn resistance() -> f64 {
    worst(rows("resistance").iter().map(|row| {
        let r = contact_resistance(&SKIN.surface, &material(row).surface, number(row, "P_Pa"));
        relative(r, number(row, "R_m2K_W"))
    }))
}

fn contact<F: Real>(row: &Row) -> Contact<F> {
    let f = |column| F::from_f64(number(row, column));
    Contact::new(
        (&SKIN, f("T_skin_i_C")),
        (material(row), f("T_object_i_C")),
        &REFERENCE_DISPLAY,
        f("P_Pa"),
    )
}

pub fn ratio() -> f64 {
    let rows = rows("contact");
    worst(
        rows.iter().map(|row| relative(contact::<f64>(row).ratio, number(row, "ratio_Rdisp_Robj"))),
    )
}

fn temperatures<F: Real>() -> f64 {
    worst(rows("contact").iter().flat_map(|row| {
        let at = contact::<F>(row).at(F::from_f64(number(row, "t_s")));
        [(at.skin_c, "T_skin_s_C"), (at.object_c, "T_object_s_C"), (at.display_c, "T_display_C")]
            .map(|(t, column)| 1e6 * (t.to_f64() - number(row, column)))
    }))
}

pub fn temperatures_f64() -> f64 {
    temperatures::<f64>()
}

pub fn temperatures_f32() -> f64 {
    temperatures::<f32>()
}

pub fn flux_f64() -> f64 {
    worst(rows("contact").iter().map(|row| {
        let flux = contact::<f64>(row).at(number(row, "t_s")).flux_w_m2;
        relative(flux, number(row, "q_W_m2"))
    }))
}

/// The rows state the resistance and not the pressure, so the rate is scaled.
pub fn contact_interior() -> f64 {
    worst(rows("contact_interior").iter().map(|row| {
        let mut contact = Contact::<f64>::new(
            (&SKIN, number(row, "T_skin_i_C")),
            (material(row), number(row, "T_object_i_C")),
            &REFERENCE_DISPLAY,
            1e4,
        );
        contact.rate_per_s *= (contact.resistance_m2k_w / number(row, "R_m2K_W")).powi(2);
        let t = contact.skin_at_depth(&SKIN, number(row, "x_m"), number(row, "t_s"));
        1e6 * (t - number(row, "T_skin_x_t_C"))
    }))
}
