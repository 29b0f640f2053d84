//! Perfect contact of two half-spaces (Eq. 3-1 to 3-4).

use super::Real;
use crate::material::Material;

/// Temperature of both surfaces in perfect contact, °C, constant over time (Eq. 3-1); error at most 1e-7 µK in
/// `f64`.
pub fn interface_temperature<F: Real>(
    skin: &Material,
    skin_c: F,
    object: &Material,
    object_c: F,
) -> F {
    let (es, eo) = (F::from_f64(skin.effusivity()), F::from_f64(object.effusivity()));
    (object_c * eo + skin_c * es) / (eo + es)
}

/// Fourier number `alpha t / L²`, dimensionless (Eq. 3-4), of a body whose volume over contact area is `length_m`;
/// relative error of a few roundings of `F`. Bodies are approximated by half-spaces where it is below 0.05.
pub fn fourier_number<F: Real>(material: &Material, length_m: F, t_s: F) -> F {
    F::from_f64(material.diffusivity_m2_s()) * t_s / (length_m * length_m)
}

/// A finger in perfect contact with an object: the limit of [`super::Contact`] for zero contact resistance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SemiInfinite<F> {
    /// Skin temperature before contact, °C.
    pub skin_c: F,
    /// Temperature of both surfaces during contact, °C (Eq. 3-1).
    pub interface_c: F,
    /// Conductivity of the skin, W/(m K).
    pub conductivity_w_mk: F,
    /// Diffusivity of the skin, m²/s.
    pub diffusivity_m2_s: F,
}

impl<F: Real> SemiInfinite<F> {
    /// Perfect contact of `skin` at `skin_c` with `object` at `object_c`.
    pub fn new((skin, skin_c): (&Material, F), (object, object_c): (&Material, F)) -> Self {
        Self {
            skin_c,
            interface_c: interface_temperature(skin, skin_c, object, object_c),
            conductivity_w_mk: F::from_f64(skin.surface.conductivity_w_mk),
            diffusivity_m2_s: F::from_f64(skin.diffusivity_m2_s()),
        }
    }

    /// Skin temperature `depth_m` below the surface, `t_s` seconds after landing (both at least 0), °C (Eq. 3-2);
    /// error at most 1e-7 µK in `f64`. At time zero it is the temperature before contact, except at the surface.
    pub fn skin_at_depth(&self, depth_m: F, t_s: F) -> F {
        if depth_m <= F::from_f64(0.0) {
            return self.interface_c;
        }
        let argument = depth_m / (F::from_f64(2.0) * (self.diffusivity_m2_s * t_s).sqrt());
        self.interface_c + (self.skin_c - self.interface_c) * argument.erf()
    }

    /// Heat flux in the skin at its surface, W/m², with the sign of Eq. 3-3: negative for a cold object, where
    /// [`super::Response::flux_w_m2`] is positive; relative error below 1e-13 in `f64`. `None` for `t_s` of 0 or less,
    /// because it is infinite at landing.
    pub fn flux_w_m2(&self, t_s: F) -> Option<F> {
        if t_s <= F::from_f64(0.0) {
            return None;
        }
        let diffusion_m = (F::from_f64(core::f64::consts::PI) * self.diffusivity_m2_s * t_s).sqrt();
        Some(self.conductivity_w_mk * (self.interface_c - self.skin_c) / diffusion_m)
    }
}
