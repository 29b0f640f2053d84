//! Courses of displays whose models have a closed form: half-spaces with and without contact resistance.

use contact_model::material::SKIN;
use contact_model::pressure::pressure_pa;
use contact_model::reference::{Contact, SemiInfinite, interface_temperature};
use thermal_client::course::{Course, CoursePoint};

use crate::touch::{SingleContact, course};

/// Contact temperature of two half-spaces without resistance, °C (Eq. 3-1).
pub fn contact_temperature_c(touch: &SingleContact) -> f64 {
    interface_temperature(&SKIN, touch.skin_c, &touch.object, touch.object_c)
}

/// That contact temperature, throughout.
pub fn constant(touch: &SingleContact) -> Course {
    let celsius = contact_temperature_c(touch);
    course(vec![CoursePoint { t_s: 0.0, celsius }])
}

/// The display temperature of Eq. 6-12.
pub fn with_resistance(touch: &SingleContact) -> Course {
    let contact = contact(touch);
    touch.sampled(|t_s| contact.at(t_s).display_c)
}

/// The thesis's contact of the touch.
pub fn contact(touch: &SingleContact) -> Contact<f64> {
    Contact::new(
        (&SKIN, touch.skin_c),
        (&touch.object, touch.object_c),
        &touch.display,
        pressure_pa(touch.force_n),
    )
}

/// The static temperature from which a half-space of the display's effusivity comes to the contact temperature when the skin
/// touches it, °C: `T_s + (T_s - T_skin) e_skin / e_display`.
pub fn static_temperature_c(touch: &SingleContact) -> f64 {
    let contact_c = contact_temperature_c(touch);
    contact_c + (contact_c - touch.skin_c) * SKIN.effusivity() / touch.display_effusivity
}

/// The static temperature until the landing, then the contact temperature from `ramp_s` on.
pub fn static_then_contact(touch: &SingleContact, ramp_s: f64) -> Course {
    course(vec![
        CoursePoint { t_s: 0.0, celsius: static_temperature_c(touch) },
        CoursePoint { t_s: ramp_s, celsius: contact_temperature_c(touch) },
    ])
}

/// The temperature of the skin at a depth, m, in contact without resistance (Eq. 3-2).
pub fn at_depth(touch: &SingleContact, depth_m: f64) -> Course {
    let contact = SemiInfinite::new((&SKIN, touch.skin_c), (&touch.object, touch.object_c));
    touch.sampled(|t_s| contact.skin_at_depth(depth_m, t_s))
}
