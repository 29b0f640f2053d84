//! Courses of fingers of layers, solved before the contact: with blood and without resistance, or as the device's mean finger.

use thermal_client::course::Course;
use thermal_plant::contact::ContactLaw;
use thermal_plant::finger::FingerParams;
use thermal_plant::{ConfigError, Params, PlantConfig};

use crate::closed_form;
use crate::recording::touch_object;
use crate::touch::SingleContact;

/// Contact law and factor on the contact resistance with which nearly none is left: 1e-7 m² K/W.
const NEARLY_PERFECT: ContactLaw = ContactLaw { gap_w_m2k: 1e5, ..ContactLaw::NOMINAL };
const RESISTANCE_FACTOR: f64 = 0.01;

/// The skin that touches the object without resistance: three layers with blood and metabolism (Eq. 1-1) that keep flowing.
///
/// # Errors
/// The scene's plant does not accept a value.
pub fn bio_heat(touch: &SingleContact) -> Result<Course, ConfigError> {
    let finger = FingerParams {
        vessels: None,
        resistance_factor: RESISTANCE_FACTOR,
        ..FingerParams::layered()
    };
    let config = with_finger(touch, finger, NEARLY_PERFECT);
    let mut skin_c = Vec::new();
    touch_object(&config, touch, |plant| skin_c.push(plant.skin_real_c()))?;
    // At the landing itself the skin begins to fall without delay.
    if let [first, second, ..] = skin_c.as_mut_slice() {
        *first = *second;
    }
    let mut samples = skin_c.into_iter();
    Ok(touch.sampled(|_| samples.next().unwrap_or(touch.skin_c)))
}

/// The display temperature at which the mean finger (layers without blood, in air before the contact) is as warm as it is on
/// the object: what the device computes with `finger mean`.
///
/// # Errors
/// The scene's plant does not accept a value.
pub fn mean_finger(touch: &SingleContact) -> Result<Course, ConfigError> {
    let mut finger = FingerParams { vessels: None, ..FingerParams::layered() };
    for layer in &mut finger.layers {
        layer.medium.perfusion_w_m3k = 0.0;
        layer.medium.metabolism_w_m3 = 0.0;
    }
    let config = with_finger(touch, finger, ContactLaw::NOMINAL);
    // At the landing tissue does not matter.
    let mut display_c = closed_form::contact(touch).at(0.0).display_c;
    let mut samples = Vec::new();
    touch_object(&config, touch, |plant| {
        display_c = plant.exact_display_c().unwrap_or(display_c);
        samples.push(display_c);
    })?;
    let mut samples = samples.into_iter();
    Ok(touch.sampled(|_| samples.next().unwrap_or(display_c)))
}

/// The touch's plant with a nominal device and another finger and contact.
fn with_finger(touch: &SingleContact, finger: FingerParams, contact: ContactLaw) -> PlantConfig {
    PlantConfig { params: Params { finger, contact, ..Params::nominal() }, ..touch.plant.clone() }
}
