//! Contact resistance (Eq. 6-8 to 6-11); temperatures and heat flux during contact (Eq. 6-5 to 6-7 and 6-12).

use super::{Real, erfcx};
use crate::material::{Material, SKIN_MICROHARDNESS_PA, Surface};

/// Contact conductance `1.25 k_s da / R_q` of two surfaces where the pressure equals the microhardness, W/(m² K)
/// (Eq. 6-8 to 6-11), for positive properties; relative error of a few roundings of `F`.
pub fn conductance_at_hardness<F: Real>(a: &Surface, b: &Surface) -> F {
    let (ka, kb) = (F::from_f64(a.conductivity_w_mk), F::from_f64(b.conductivity_w_mk));
    let root_sum_square = |x: f64, y: f64| {
        let (x, y) = (F::from_f64(x), F::from_f64(y));
        (x * x + y * y).sqrt()
    };
    let harmonic_mean = F::from_f64(2.0) * ka * kb / (ka + kb);
    let roughness_m = root_sum_square(a.roughness_um, b.roughness_um) * F::from_f64(1e-6);
    let slope = root_sum_square(a.slope_rad, b.slope_rad);
    F::from_f64(1.25) * harmonic_mean * slope / roughness_m
}

/// Contact resistance between skin and another surface under `pressure_pa` (at least 0), m² K/W (Eq. 6-8);
/// relative error below 2e-15 in `f64`. Infinite at zero pressure.
pub fn contact_resistance<F: Real>(skin: &Surface, other: &Surface, pressure_pa: F) -> F {
    let relative = pressure_pa / F::from_f64(SKIN_MICROHARDNESS_PA);
    F::from_f64(1.0)
        / (conductance_at_hardness::<F>(skin, other) * relative.powf(F::from_f64(0.95)))
}

/// A finger in contact with an object, and the display that reproduces the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<F> {
    /// Skin temperature before contact, °C.
    pub skin_c: F,
    /// Object temperature before contact, °C.
    pub object_c: F,
    /// Contact resistance of skin and object, m² K/W.
    pub resistance_m2k_w: F,
    /// `R_skin-display / R_skin-object`; independent of pressure.
    pub ratio: F,
    /// Weight of the object's temperature in that of the interface, `w = e_object / (e_object + e_skin)`.
    pub weight: F,
    /// `b² = ((1/e_skin + 1/e_object) / R)²`, 1/s.
    pub rate_per_s: F,
}

/// The state of a contact at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response<F> {
    /// `E = erfcx(b sqrt(t))`: 1 at landing, 0 after a long time.
    pub erfcx: F,
    /// Surface temperature of the skin, °C (Eq. 6-5).
    pub skin_c: F,
    /// Surface temperature of the object, °C (Eq. 6-6).
    pub object_c: F,
    /// Heat flux out of the skin, W/m² (Eq. 6-7, positive for a cold object).
    pub flux_w_m2: F,
    /// Surface temperature of the display at which the skin has this temperature, °C (Eq. 6-12).
    pub display_c: F,
}

impl<F: Real> Contact<F> {
    /// Contact of `skin` at `skin_c` with `object` at `object_c` under `pressure_pa`, to be reproduced by a display
    /// with the surface `display`.
    ///
    /// At zero pressure no heat flows. At infinite pressure, without resistance, the flux is NaN; use
    /// [`super::SemiInfinite`].
    pub fn new(
        (skin, skin_c): (&Material, F),
        (object, object_c): (&Material, F),
        display: &Surface,
        pressure_pa: F,
    ) -> Self {
        let (es, eo) = (F::from_f64(skin.effusivity()), F::from_f64(object.effusivity()));
        let one = F::from_f64(1.0);
        let resistance_m2k_w = contact_resistance(&skin.surface, &object.surface, pressure_pa);
        let b = (one / es + one / eo) / resistance_m2k_w;
        Self {
            skin_c,
            object_c,
            resistance_m2k_w,
            ratio: conductance_at_hardness::<F>(&skin.surface, &object.surface)
                / conductance_at_hardness::<F>(&skin.surface, display),
            weight: eo / (eo + es),
            rate_per_s: b * b,
        }
    }

    /// State `t_s` seconds after landing (at least 0). For the conditions of the thesis the error of temperatures is
    /// at most 1e-7 µK in `f64` and 10 µK in `f32`; the relative error of the flux is at most 5e-15 in `f64`.
    pub fn at(&self, t_s: F) -> Response<F> {
        let erfcx = erfcx((self.rate_per_s * t_s).sqrt());
        let difference = self.skin_c - self.object_c;
        let progress = F::from_f64(1.0) - erfcx;
        let skin_c = self.skin_c - difference * self.weight * progress;
        Response {
            erfcx,
            skin_c,
            object_c: self.object_c + difference * (F::from_f64(1.0) - self.weight) * progress,
            flux_w_m2: difference / self.resistance_m2k_w * erfcx,
            display_c: skin_c - self.ratio * difference * erfcx,
        }
    }

    /// Skin temperature `depth_m` below the surface, `t_s` seconds after landing (both at least 0), °C; error at
    /// most 1e-7 µK in `f64` down to 10 mm.
    ///
    /// Eq. 6-5 extended below the surface: `T_i - dT w (erfc x - exp(-x²) erfcx(x + z))` with
    /// `x = depth / (2 sqrt(alpha t))` and `z = b sqrt(t)`.
    pub fn skin_at_depth(&self, skin: &Material, depth_m: F, t_s: F) -> F {
        let zero = F::from_f64(0.0);
        if t_s <= zero {
            return self.skin_c;
        }
        let diffusion_m = F::from_f64(2.0) * (F::from_f64(skin.diffusivity_m2_s()) * t_s).sqrt();
        let x = depth_m / diffusion_m;
        let z = (self.rate_per_s * t_s).sqrt();
        let fraction = x.erfc() - (-(x * x)).exp() * erfcx(x + z);
        self.skin_c - (self.skin_c - self.object_c) * self.weight * fraction
    }
}
