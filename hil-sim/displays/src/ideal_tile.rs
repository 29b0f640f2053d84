//! The finger on a tile that follows its course exactly.

use thermal_client::course::Course;
use thermal_plant::ConfigError;
use thermal_plant::lone_finger::LoneFinger;

use crate::touch::SingleContact;

/// Surface temperature of the skin, °C, at the landing and after each step of 1 ms: the scene's finger, touching with the
/// plant's contact resistance a surface whose temperature is the course. Temperatures are as in the plant; the surface has its
/// mean temperature of each step.
///
/// # Errors
/// The scene's plant does not accept a value.
pub fn skin_on_ideal_tile(touch: &SingleContact, course: &Course) -> Result<Vec<f64>, ConfigError> {
    touch.plant.check()?;
    let params = &touch.plant.params;
    let contact = (params.contact).at_force(touch.force_n, &params.finger.surface, &params.display);
    let contact_m2k_w = contact.map_or(f64::INFINITY, |contact| {
        params.finger.resistance_factor * contact.resistance_m2k_w
    });
    let vessels = params.finger.vessels;
    let finger = LoneFinger {
        params: params.finger.clone(),
        flow: vessels.map_or(1.0, |vessels| vessels.flow(touch.force_n)),
        skin_c: touch.skin_c,
        room_c: touch.plant.room_c,
    };
    let touched = finger.on_surface(contact_m2k_w, touch.steps(), &|t_s| course.at(t_s));
    Ok(touched.skin_c)
}
