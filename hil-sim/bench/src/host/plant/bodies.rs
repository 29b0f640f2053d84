//! The bodies of a finger on other meshes and in other steps: their errors against Eq. 6-5 to 6-7.
use anyhow::Context;
use contact_model::material::{Material, REFERENCE_DISPLAY, SKIN, find};
use contact_model::pressure::pressure_pa;
use contact_model::reference::Contact;
use hil_sim::plant::STEP_S;
use hil_sim::plant::object::ObjectConfig;
use hil_sim::plant::slab::{Back, Grading, Layer, Medium, Slab};
use hil_sim::plant::touch::Touch;
use hil_sim::plant::truth::Truth;
use serde::Serialize;

/// Objects and forces of the contacts whose errors are taken.
pub const OBJECTS: [&str; 4] = ["copper", "granite", "abs", "foam"];
/// Forces, N.
pub const FORCES_N: [f64; 2] = [0.1, 2.0];
/// Length of a contact, s.
pub const CONTACT_S: f64 = 10.0;
/// Skin and object before it, deg C.
const START_C: (f64, f64) = (34.0, 24.0);
/// From when on errors count, and from when on those before are told, s.
pub const COUNTS_FROM_S: f64 = 0.02;
pub const TOLD_FROM_S: f64 = 0.001;

/// How the bodies are cut and stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// The mesh.
    pub grading: Grading,
    /// The step, s.
    pub step_s: f64,
}

impl Cut {
    /// As every run has it.
    pub const RUN: Self = Self {
        grading: Grading::RUN,
        step_s: STEP_S,
    };

    /// Cells of a half-space.
    #[must_use]
    pub fn cells(&self) -> usize {
        let skin = Layer {
            thickness_m: f64::INFINITY,
            medium: Medium::dead(&SKIN),
        };
        Slab::new(&[skin], Back::Insulated, CONTACT_S, &self.grading).cells()
    }

    /// A finger that lands on an object now.
    fn landing(&self, object: &Material, touch: Touch) -> Truth {
        let (skin_c, object_c) = START_C;
        let object = ObjectConfig::half_space(*object, object_c);
        Truth::cut(skin_c, &object, touch, CONTACT_S, (&self.grading, self.step_s))
    }

    /// A finger in contact, past its first steps.
    ///
    /// # Errors
    /// None for these materials.
    pub fn in_contact(&self, object: &str, force_n: f64) -> anyhow::Result<Truth> {
        let (object, touch) = touch(object, force_n)?;
        let mut truth = self.landing(object, touch);
        while truth.time_s() < 50.0 * self.step_s {
            truth.sub_step();
        }
        Ok(truth)
    }

    /// The largest errors over all contacts.
    ///
    /// # Errors
    /// None for these materials.
    pub fn errors(&self) -> anyhow::Result<Errors> {
        let mut errors = Errors::default();
        for name in OBJECTS {
            for force_n in FORCES_N {
                let (object, touch) = touch(name, force_n)?;
                let exact = Contact::new(
                    (&SKIN, START_C.0),
                    (object, START_C.1),
                    &REFERENCE_DISPLAY,
                    pressure_pa(force_n),
                );
                let first_flux_w_m2 = (START_C.0 - START_C.1) / touch.resistance_m2k_w;
                let mut truth = self.landing(object, touch);
                while truth.time_s() < CONTACT_S - 0.5 * self.step_s {
                    truth.sub_step();
                    let want = exact.at(truth.time_s());
                    let skin_k = (truth.skin_c() - want.skin_c).abs();
                    let object_k = (truth.object_c() - want.object_c).abs();
                    let flux = (truth.flux_w_m2() - want.flux_w_m2).abs() / first_flux_w_m2;
                    errors.take(truth.time_s(), 1e3 * skin_k.max(object_k), flux);
                }
            }
        }
        Ok(errors)
    }
}

fn touch(object: &str, force_n: f64) -> anyhow::Result<(&'static Material, Touch)> {
    let object: &Material = find(object).with_context(|| format!("no material {object}"))?;
    let touch = Touch::under(force_n, &SKIN.surface, &object.surface)
        .with_context(|| format!("{force_n} N is no contact"))?;
    Ok((object, touch))
}

/// Largest errors at the ends of steps and sub-steps; not a number if one was not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Errors {
    /// Of the surfaces of skin and object from [`COUNTS_FROM_S`] on, mK.
    pub surface_mk: f64,
    /// Of the flux, as part of `dT/R`.
    pub flux: f64,
    /// Of the surfaces before, from [`TOLD_FROM_S`] on, mK.
    pub surface_before_mk: f64,
    /// Of the flux then.
    pub flux_before: f64,
}

impl Errors {
    fn take(&mut self, t_s: f64, surface_mk: f64, flux: f64) {
        // Sums of steps are not exact.
        let by = |time_s: f64| t_s > time_s - 1e-9;
        if by(COUNTS_FROM_S) {
            raise(&mut self.surface_mk, surface_mk);
            raise(&mut self.flux, flux);
        } else if by(TOLD_FROM_S) {
            raise(&mut self.surface_before_mk, surface_mk);
            raise(&mut self.flux_before, flux);
        }
    }
}

fn raise(worst: &mut f64, new: f64) {
    if new.is_nan() || new > *worst {
        *worst = new;
    }
}
