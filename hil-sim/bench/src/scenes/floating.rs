//! A finger in floating point.
use contact_model::material::{Material, REFERENCE_DISPLAY, SKIN, SKIN_MICROHARDNESS_PA};
use contact_model::pressure::{THESIS_PRESSURES, pressure_pa};
use contact_model::reference::{Contact, Real};

use super::{FORCE_N, OBJECT_C, SKIN_C, TICK_S};

/// Conversion from integers in the type's own precision; [`Real`] converts by way of `f64`, in software.
pub(super) trait Native: Real {
    /// Converts with rounding.
    fn of(count: u32) -> Self;
}

impl Native for f32 {
    fn of(count: u32) -> Self {
        count as f32
    }
}

impl Native for f64 {
    fn of(count: u32) -> Self {
        f64::from(count)
    }
}

/// A finger on an object and the constants of its formulas.
#[derive(Clone, Copy)]
pub(super) struct Finger<F> {
    skin_c: F,
    object_c: F,
    /// `e_object / (e_object + e_skin)`.
    weight: F,
    /// `R_display / R_object`.
    ratio: F,
    /// `b² dt` under the constant force.
    per_tick: F,
    /// `b² dt` at `P = H`.
    per_tick_at_hardness: F,
    /// Stated forces (N) and contact areas (m²).
    areas: [(F, F); THESIS_PRESSURES.len()],
    /// Set-point of the last step.
    pub(super) set_point_c: F,
}

impl<F: Native> Finger<F> {
    /// Derives the constants, in `f64`.
    pub(super) fn new(object: &Material) -> Self {
        let under = |pressure_pa: f64| {
            Contact::<f64>::new(
                (&SKIN, SKIN_C),
                (object, OBJECT_C),
                &REFERENCE_DISPLAY,
                pressure_pa,
            )
        };
        let contact = under(pressure_pa(FORCE_N));
        Self {
            skin_c: F::from_f64(SKIN_C),
            object_c: F::from_f64(OBJECT_C),
            weight: F::from_f64(contact.weight),
            ratio: F::from_f64(contact.ratio),
            per_tick: F::from_f64(contact.rate_per_s * TICK_S),
            per_tick_at_hardness: F::from_f64(under(SKIN_MICROHARDNESS_PA).rate_per_s * TICK_S),
            areas: THESIS_PRESSURES
                .map(|(force, pressure)| (F::from_f64(force), F::from_f64(force / pressure))),
            set_point_c: F::from_f64(0.0),
        }
    }

    /// Eq. 6-12 at `t = 0`.
    pub(super) fn idle(&mut self) {
        self.set_point_c = self.skin_c - self.ratio * (self.skin_c - self.object_c);
    }

    /// Eq. 3-1.
    pub(super) fn semi_infinite(&mut self) {
        self.set_point_c = self.skin_c - self.weight * (self.skin_c - self.object_c);
    }

    /// Eq. 6-5 and 6-12 for a value of `E`.
    #[inline]
    fn display(&mut self, erfcx: F) {
        let step = self.skin_c - self.object_c;
        self.set_point_c =
            self.skin_c - step * (self.weight * (F::from_f64(1.0) - erfcx) + self.ratio * erfcx);
    }

    #[inline]
    pub(super) fn constant_force(&mut self, tick: u32, kernel: impl Fn(u32, F) -> F) {
        self.display(kernel(tick, self.per_tick));
    }

    /// `force` in units of 2^-12 N above 1 N.
    #[inline]
    pub(super) fn streaming_force(&mut self, force: u32, tick: u32, kernel: impl Fn(u32, F) -> F) {
        let one = F::from_f64(1.0);
        let force_n = one + F::of(force) * F::from_f64(1.0 / 4096.0);
        let relative = force_n / (self.area_m2(force_n) * F::from_f64(SKIN_MICROHARDNESS_PA));
        let per_tick = self.per_tick_at_hardness * relative.powf(F::from_f64(1.9));
        self.display(kernel(tick, per_tick));
    }

    /// Contact area, linear between the stated points.
    fn area_m2(&self, force_n: F) -> F {
        let mut below = self.areas[0];
        for point in self.areas {
            if force_n < point.0 {
                return below.1 + (force_n - below.0) * (point.1 - below.1) / (point.0 - below.0);
            }
            below = point;
        }
        below.1
    }
}
