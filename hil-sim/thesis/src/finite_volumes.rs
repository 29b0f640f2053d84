//! Contacts of the thesis solved by the finite volumes of the plant.

use contact_model::material::{REFERENCE_DISPLAY, SKIN};
use contact_model::reference::contact_resistance;
use thermal_plant::contact::SkinContact;
use thermal_plant::object::ObjectConfig;
use thermal_plant::reference::ReferenceSolution;

use super::contact_case::{Case, ContactSolver, Surfaces};

/// Finger and object of the plant with the mesh and the steps of every simulation.
#[derive(Clone, Copy, Debug)]
pub struct FiniteVolumes;

impl ContactSolver for FiniteVolumes {
    fn solve(&self, case: &Case, times_s: &[f64]) -> anyhow::Result<Vec<Surfaces>> {
        let end_s = times_s.last().copied().unwrap_or(0.0);
        let resistance = |other| contact_resistance(&SKIN.surface, other, case.pressure_pa);
        let display_m2k_w = resistance(&REFERENCE_DISPLAY);
        let touch = SkinContact {
            // Without effect: finger and object are modelled per square metre.
            area_m2: 1.0,
            resistance_m2k_w: resistance(&case.object.surface),
        };
        let object = ObjectConfig::half_space(case.object, case.object_c);
        let mut reference =
            ReferenceSolution::new(case.skin_c, &object, touch, end_s.max(f64::MIN_POSITIVE));
        let surfaces = |reference: &ReferenceSolution| Surfaces {
            skin_c: reference.skin_c(),
            object_c: reference.object_c(),
            // Eq. 6-12 with the flux of Eq. 6-7 through the contact resistance of the display.
            display_c: reference.skin_c() - display_m2k_w * reference.flux_w_m2(),
            flux_w_m2: reference.flux_w_m2(),
        };
        // At time zero the interpolated surface temperatures already differ from the initial ones.
        let initial =
            Surfaces { skin_c: case.skin_c, object_c: case.object_c, ..surfaces(&reference) };
        let mut before = (0.0, initial);
        let mut after = before;
        let mut solution = Vec::with_capacity(times_s.len());
        for &t_s in times_s {
            while after.0 < t_s {
                before = after;
                reference.sub_step();
                after = (reference.time_s(), surfaces(&reference));
            }
            solution.push(interpolate(&before, &after, t_s));
        }
        Ok(solution)
    }
}

/// Interpolates between two sub-steps, linearly in the square root of time.
fn interpolate((a_s, a): &(f64, Surfaces), (b_s, b): &(f64, Surfaces), t_s: f64) -> Surfaces {
    let part = if b_s > a_s { (t_s.sqrt() - a_s.sqrt()) / (b_s.sqrt() - a_s.sqrt()) } else { 1.0 };
    let mix = |a: f64, b: f64| a + part * (b - a);
    Surfaces {
        skin_c: mix(a.skin_c, b.skin_c),
        object_c: mix(a.object_c, b.object_c),
        display_c: mix(a.display_c, b.display_c),
        flux_w_m2: mix(a.flux_w_m2, b.flux_w_m2),
    }
}
