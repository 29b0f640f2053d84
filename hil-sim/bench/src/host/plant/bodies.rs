//! Errors of the plant's bodies against Eq. 6-5 to 6-7, over meshes and time steps.
use anyhow::Context;
use contact_model::material::{Material, REFERENCE_DISPLAY, SKIN, find};
use contact_model::pressure::pressure_pa;
use contact_model::reference::Contact;
use serde::Serialize;
use thermal_plant::contact::{ContactLaw, SkinContact};
use thermal_plant::object::ObjectConfig;
use thermal_plant::reference::ReferenceSolution;
use thermal_plant::slab::{BackBoundary, Grading, Layer, Medium, Slab};
use thermal_plant::{RECEPTORS_M, STEP_S};

/// Objects of the contacts whose errors are evaluated.
pub const OBJECTS: [&str; 4] = ["copper", "granite", "abs", "foam"];
/// Forces, N.
pub const FORCES_N: [f64; 2] = [0.1, 2.0];
/// Length of a contact, s.
pub const CONTACT_S: f64 = 10.0;
/// Skin and object before it, deg C.
const START_C: (f64, f64) = (34.0, 24.0);
/// Errors count from this time on, s.
pub const COUNTS_FROM_S: f64 = 0.02;
/// Errors before that are reported separately, from this time on, s.
pub const REPORTED_FROM_S: f64 = 0.001;

/// Discretization of the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// The mesh.
    pub grading: Grading,
    /// Time step, s.
    pub step_s: f64,
}

impl Cut {
    /// The discretization of a simulated run.
    pub const RUN: Self = Self { grading: Grading::STANDARD, step_s: STEP_S };

    /// Number of cells of a half-space.
    pub fn cells(&self) -> usize {
        let skin = Layer { thickness_m: f64::INFINITY, medium: Medium::without_blood(&SKIN) };
        Slab::new(&[skin], BackBoundary::Insulated, CONTACT_S, &self.grading).cells()
    }

    /// A finger at the moment of landing on an object.
    fn landing(&self, object: &Material, touch: SkinContact) -> ReferenceSolution {
        let (skin_c, object_c) = START_C;
        let object = ObjectConfig::half_space(*object, object_c);
        ReferenceSolution::on_mesh(skin_c, &object, touch, CONTACT_S, (&self.grading, self.step_s))
    }

    /// A finger in contact, past its first steps.
    ///
    /// # Errors
    /// None for these materials.
    pub fn in_contact(&self, object: &str, force_n: f64) -> anyhow::Result<ReferenceSolution> {
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
    pub fn errors(&self) -> anyhow::Result<Worst> {
        let mut worst = Worst::default();
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
                    let t_s = truth.time_s();
                    let want = exact.at(t_s);
                    let skin_k = (truth.skin_c() - want.skin_c).abs();
                    let object_k = (truth.object_c() - want.object_c).abs();
                    let inside_k = truth
                        .receptors_c()
                        .iter()
                        .zip(RECEPTORS_M)
                        .map(|(found, depth_m)| {
                            let want_c = exact.skin_at_depth(&SKIN, depth_m, t_s);
                            found.map_or(f64::NAN, |found_c| (found_c - want_c).abs())
                        })
                        .fold(0.0, larger);
                    let now = Errors {
                        surface_mk: 1e3 * larger(skin_k, object_k),
                        inside_mk: 1e3 * inside_k,
                        flux: (truth.flux_w_m2() - want.flux_w_m2).abs() / first_flux_w_m2,
                    };
                    // Tolerance for the rounding of summed steps.
                    let by = |time_s: f64| t_s > time_s - 1e-9;
                    if by(COUNTS_FROM_S) {
                        worst.counted.raise(&now);
                    } else if by(REPORTED_FROM_S) {
                        worst.before.raise(&now);
                    }
                }
            }
        }
        Ok(worst)
    }
}

fn touch(object: &str, force_n: f64) -> anyhow::Result<(&'static Material, SkinContact)> {
    let object: &Material = find(object).with_context(|| format!("no material {object}"))?;
    let touch = ContactLaw::NOMINAL
        .at_force(force_n, &SKIN.surface, &object.surface)
        .with_context(|| format!("{force_n} N is no contact"))?;
    Ok((object, touch))
}

/// Largest errors over contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Worst {
    /// From [`COUNTS_FROM_S`] on.
    pub counted: Errors,
    /// From [`REPORTED_FROM_S`] to [`COUNTS_FROM_S`].
    pub before: Errors,
}

/// Largest errors at the ends of steps and sub-steps; not a number if one was not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Errors {
    /// Of the surfaces of skin and object, mK.
    pub surface_mk: f64,
    /// Of the skin at its receptors, mK.
    pub inside_mk: f64,
    /// Of the flux, as part of `dT/R`.
    pub flux: f64,
}

impl Errors {
    fn raise(&mut self, now: &Self) {
        self.surface_mk = larger(self.surface_mk, now.surface_mk);
        self.inside_mk = larger(self.inside_mk, now.inside_mk);
        self.flux = larger(self.flux, now.flux);
    }
}

/// The larger value; NaN if either is NaN.
fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}
