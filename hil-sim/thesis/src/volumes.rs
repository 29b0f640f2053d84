//! The thesis's contacts on the plant: finite volumes instead of closed forms.

use contact_model::material::{REFERENCE_DISPLAY, SKIN};
use contact_model::reference::contact_resistance;
use thermal_plant::object::ObjectConfig;
use thermal_plant::touch::Touch;
use thermal_plant::truth::Truth;

use super::case::{Case, Source, Surfaces};

/// The plant's finger on the plant's object, with its own mesh, steps and sub-steps.
#[derive(Clone, Copy, Debug)]
pub struct FiniteVolumes;

impl Source for FiniteVolumes {
    fn course(&self, case: &Case, times_s: &[f64]) -> anyhow::Result<Vec<Surfaces>> {
        let end_s = times_s.last().copied().unwrap_or(0.0);
        let resistance = |other| contact_resistance(&SKIN.surface, other, case.pressure_pa);
        let display_m2k_w = resistance(&REFERENCE_DISPLAY);
        let touch = Touch {
            // Finger and object count per square metre.
            area_m2: 1.0,
            resistance_m2k_w: resistance(&case.object.surface),
        };
        let object = ObjectConfig::half_space(case.object, case.object_c);
        let mut truth = Truth::new(case.skin_c, &object, touch, end_s.max(f64::MIN_POSITIVE));
        let surfaces = |truth: &Truth| Surfaces {
            skin_c: truth.skin_c(),
            object_c: truth.object_c(),
            // Eq. 6-12 with the flux of Eq. 6-7: the display takes it over its own resistance.
            display_c: truth.skin_c() - display_m2k_w * truth.flux_w_m2(),
            flux_w_m2: truth.flux_w_m2(),
        };
        // The surface between two cells that already exchange heat is not yet what it was at the instant of landing.
        let landing = Surfaces {
            skin_c: case.skin_c,
            object_c: case.object_c,
            ..surfaces(&truth)
        };
        let mut before = (0.0, landing);
        let mut after = before;
        let mut course = Vec::with_capacity(times_s.len());
        for &t_s in times_s {
            while after.0 < t_s {
                before = after;
                truth.sub_step();
                after = (truth.time_s(), surfaces(&truth));
            }
            course.push(between(&before, &after, t_s));
        }
        Ok(course)
    }
}

/// Between two sub-steps, evenly in the root of time, with which a contact goes on.
fn between((a_s, a): &(f64, Surfaces), (b_s, b): &(f64, Surfaces), t_s: f64) -> Surfaces {
    let part = if b_s > a_s {
        (t_s.sqrt() - a_s.sqrt()) / (b_s.sqrt() - a_s.sqrt())
    } else {
        1.0
    };
    let mix = |a: f64, b: f64| a + part * (b - a);
    Surfaces {
        skin_c: mix(a.skin_c, b.skin_c),
        object_c: mix(a.object_c, b.object_c),
        display_c: mix(a.display_c, b.display_c),
        flux_w_m2: mix(a.flux_w_m2, b.flux_w_m2),
    }
}
