//! Falls of temperature that were recorded on a real object.

use thermal_client::course::Course;
use thermal_plant::bridge::BridgeOutputs;
use thermal_plant::{ConfigError, Plant};

use crate::touch::SingleContact;

/// Surface of the scene's skin on the real object, °C, at the landing and after each step of 1 ms.
///
/// # Errors
/// The scene's plant does not accept a value.
pub fn skin_on_object(touch: &SingleContact) -> Result<Vec<f64>, ConfigError> {
    let mut skin_c = Vec::new();
    touch_object(&touch.plant, touch, |plant| skin_c.push(plant.skin_real_c()))?;
    Ok(skin_c)
}

/// Lets the finger of a plant touch its object, and observes it at the landing and after each step.
///
/// # Errors
/// The plant does not accept a value.
pub(crate) fn touch_object(
    config: &thermal_plant::PlantConfig,
    touch: &SingleContact,
    mut observe: impl FnMut(&Plant),
) -> Result<(), ConfigError> {
    let mut plant = Plant::new(config)?;
    plant.set_force(touch.force_n);
    observe(&plant);
    for _ in 0..touch.steps() {
        plant.step(&BridgeOutputs::default());
        observe(&plant);
    }
    Ok(())
}

/// The recording as it was measured: by a sensor of a time constant, s (0 for none).
pub(crate) fn through_sensor(touch: &SingleContact, skin_c: &[f64], lag_s: f64) -> Course {
    let share = if lag_s > 0.0 { 1.0 - (-crate::touch::STEP_S / lag_s).exp() } else { 1.0 };
    let mut samples = skin_c.iter();
    let mut sensor_c = skin_c.first().copied().unwrap_or(touch.skin_c);
    touch.sampled(|_| {
        if let Some(celsius) = samples.next() {
            sensor_c += share * (celsius - sensor_c);
        }
        sensor_c
    })
}
