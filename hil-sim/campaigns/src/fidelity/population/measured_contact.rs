//! A contact law as `thermal-lab contact` measures it: at a device with the designed sensor of the heat flux, whose errors are drawn.

use std::path::Path;
use std::time::Duration;

use anyhow::Context;
use contact_law_fit::{MeasurementOptions, fit, measure};
use contact_model::contact_law::ContactLaw;
use thermal_client::client::Client;
use thermal_plant::Params;
use thermal_plant::parameters;
use thermal_plant::sensors::FluxParams;
use thermal_sim::World;
use thermal_sim::commissioning::settings_for_scene;
use thermal_sim::engine::NativeEngine;
use thermal_sim::scene::Scene;
use thermal_sim::simulated_link::SimulatedLink;

use super::super::case::ROOM_C;
use super::drawn_contact;

/// Time after power-up before the first line.
const START: Duration = Duration::from_millis(10);

/// The law of the nominal layered finger with the contact of this seed.
///
/// # Errors
/// The device cannot be commissioned, or the measurement fails.
pub fn measured_contact(seed: u64) -> anyhow::Result<ContactLaw> {
    let scene = scene(seed)?;
    let mut engine = NativeEngine::new(World::new(&scene)?);
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    client.wait(START)?;
    for line in &settings_for_scene(&scene)? {
        client.command(line)?;
    }
    let options = MeasurementOptions { finger: None, takes_zero: false };
    let measurement = measure(&mut client, &options, &mut |client, step| {
        let world = client.link().world();
        world.set_force_and_faults(step.target_n(), std::iter::empty());
    })
    .with_context(|| format!("measured contact.draw = {seed}"))?;
    let fit = fit(&measurement.recording);
    Ok(fit.with_context(|| format!("fitted contact.draw = {seed}"))?.law)
}

/// The finger at the device on which it is measured.
fn scene(seed: u64) -> anyhow::Result<Scene> {
    let tables = drawn_contact(seed);
    let text = format!(
        "duration_s = 60.0\nskin_c = 34.0\nroom_c = {ROOM_C:?}\nseed = {seed}\n[object]\nmaterial = \"granite\"\n\
         start_c = {ROOM_C:?}\n[device]\nflux_sensor = true\n{tables}"
    );
    let mut scene = Scene::parse(&text, Path::new("measured contact law"))?;
    let mut drawn = Params { flux: Some(FluxParams::NOMINAL), ..Params::nominal() };
    parameters::draw(&mut drawn, seed);
    scene.params.flux = drawn.flux;
    Ok(scene)
}
