//! The simulated device of a bench: with one finger or with five, commissioned, and switched on anew for each trial.

use std::time::Duration;

use contact_model::material::MATERIALS;
use thermal_client::client::Client;
use thermal_client::commissioning;
use thermal_client::link::{Link, LinkError, ReceivedLine};
use thermal_device::{PWM_PERIOD_STEPS_OF_FIVE_FINGERS, PWM_STEPS_PER_SECOND};
use thermal_plant::object::ObjectConfig;
use thermal_plant::parameters::stream_seed;
use thermal_plant::{Params, Plant, PlantConfig};
use thermal_settings::StoredSettings;
use thermal_sim::World;
use thermal_sim::commissioning::{flux_sensor_line, settings_for_device};
use thermal_sim::engine::{Engine, NativeEngine, NativeFiveFingers};
use thermal_sim::five_fingers::{FINGERS, FiveFingerEngine};
use thermal_sim::scene::ActiveFault;
use thermal_sim::simulated_link::{VirtualLine, run_1_ms};

use crate::BenchError;

/// Simulated time for which half-spaces are meshed, s: longer than a trial has contact.
pub const MESHED_S: f64 = 120.0;
/// Time after power-up before the first line.
const START: Duration = Duration::from_millis(10);

/// What a device is made of, and its settings.
#[derive(Debug)]
pub struct PreparedDevice {
    params: Params,
    room_c: f64,
    /// Seed of the device's parts.
    seed: u64,
    stored: Stored,
}

#[derive(Debug)]
enum Stored {
    One(Box<[StoredSettings; 1]>),
    Five(Box<[StoredSettings; FINGERS]>),
}

/// What a finger of a device meets in a millisecond.
#[derive(Clone, Copy, Debug, Default)]
pub struct FingerInput {
    /// Force on the display, N.
    pub force_n: f64,
    /// Surface temperature of the skin beside the skin thermistor, °C, if the finger is not at this display.
    pub skin_elsewhere_c: Option<f64>,
}

/// A device that runs.
#[derive(Debug)]
pub enum RunningDevice {
    /// With one finger.
    One(Box<NativeEngine>),
    /// With five.
    Five(Box<NativeFiveFingers>),
}

impl PreparedDevice {
    /// Commissions a device with one finger, or with five, and saves its settings.
    ///
    /// # Errors
    /// The device cannot be commissioned, or the plant does not accept a value.
    pub fn new(
        params: &Params,
        room_c: f64,
        seed: u64,
        fingers: usize,
    ) -> Result<Self, BenchError> {
        let mut params = params.clone();
        if fingers > 1 {
            params.bridge.pwm_hz =
                f64::from(PWM_STEPS_PER_SECOND) / f64::from(PWM_PERIOD_STEPS_OF_FIVE_FINGERS);
        }
        let lines = settings_for_device(&params, room_c, seed)
            .map_err(|error| BenchError::Commissioning(error.to_string()))?;
        let failed = |error: String| BenchError::Commissioning(error);
        let world = |finger| world(&params, room_c, room_c, (seed, seed, finger));
        let addresses: Vec<Option<u8>> =
            if fingers > 1 { (0..FINGERS as u8).map(Some).collect() } else { vec![None] };
        let device = if fingers > 1 {
            RunningDevice::five(world)?
        } else {
            RunningDevice::One(Box::new(NativeEngine::new(world(0)?)))
        };
        let mut client = Client::new(DeviceLink::new(device));
        client.wait(START).map_err(|error| failed(error.to_string()))?;
        for address in addresses {
            commissioning::restore(&mut client, address, &lines)
                .map_err(|error| failed(error.to_string()))?;
        }
        if let Some(line) = flux_sensor_line(&params) {
            client.command(&line).map_err(|error| failed(error.to_string()))?;
        }
        client.command("save").map_err(|error| failed(error.to_string()))?;
        let not_saved = || BenchError::Commissioning("the settings were not saved".into());
        let stored = match client.into_link().device {
            RunningDevice::One(engine) => {
                Stored::One(Box::new(*engine.stored_settings().ok_or_else(not_saved)?))
            }
            RunningDevice::Five(engine) => {
                Stored::Five(Box::new(*engine.stored_settings().ok_or_else(not_saved)?))
            }
        };
        Ok(Self { params, room_c, seed, stored })
    }

    /// The device just after power-up, with fingers at rest, deg C, and this seed of its noise.
    ///
    /// # Errors
    /// The plant does not accept the temperature.
    pub fn power_up(&self, skin_c: f64, noise_seed: u64) -> Result<RunningDevice, BenchError> {
        let world =
            |finger| world(&self.params, skin_c, self.room_c, (self.seed, noise_seed, finger));
        Ok(match &self.stored {
            Stored::One(stored) => RunningDevice::One(Box::new(
                NativeEngine::new(world(0)?).with_stored_settings(**stored),
            )),
            Stored::Five(stored) => match RunningDevice::five(world)? {
                RunningDevice::Five(engine) => {
                    RunningDevice::Five(Box::new(engine.with_stored_settings(**stored)))
                }
                one => one,
            },
        })
    }
}

/// The world of a finger: its display, and no real object.
fn world(
    params: &Params,
    skin_c: f64,
    room_c: f64,
    (seed, noise_seed, finger): (u64, u64, usize),
) -> Result<World, BenchError> {
    let [(_, any), ..] = MATERIALS;
    let config = PlantConfig {
        skin_c,
        room_c,
        object: ObjectConfig::half_space(any, room_c),
        start_s: 0.0,
        appears_s: MESHED_S,
        duration_s: MESHED_S,
        seed,
        params: params.clone(),
    };
    Ok(World::from_plant(&config, stream_seed(noise_seed, &format!("converter {finger}")))?)
}

impl RunningDevice {
    fn five(world: impl Fn(usize) -> Result<World, BenchError>) -> Result<Self, BenchError> {
        let worlds = [world(0)?, world(1)?, world(2)?, world(3)?, world(4)?];
        Ok(Self::Five(Box::new(NativeFiveFingers::new(worlds))))
    }

    /// This device with the thermal doses of the one before, which would keep them if it were the same.
    #[must_use]
    pub fn with_doses_of(self, before: &Self) -> Self {
        match (self, before) {
            (Self::One(engine), Self::One(before)) => {
                Self::One(Box::new(engine.with_doses_of(before)))
            }
            (Self::Five(engine), Self::Five(before)) => {
                Self::Five(Box::new(engine.with_doses_of(before)))
            }
            (other, _) => other,
        }
    }

    /// Runs it for a millisecond, in which `bytes` are sent to it, with what each finger meets, and with faults of the first
    /// finger's plant.
    pub fn run_1_ms(&mut self, bytes: &[u8], inputs: &[FingerInput], faults: &[ActiveFault]) {
        let set = |world: &mut World, finger: usize| {
            let input = inputs.get(finger).copied().unwrap_or_default();
            let faults = faults.iter().copied().filter(|_| finger == 0);
            world.set_force_and_faults(input.force_n, faults);
            world.set_skin_elsewhere(input.skin_elsewhere_c);
        };
        match self {
            Self::One(engine) => {
                set(engine.world(), 0);
                let Ok(()) = run_1_ms(&mut **engine, bytes);
            }
            Self::Five(engine) => {
                for finger in 0..FINGERS {
                    let Ok(()) = engine.run_to(finger);
                    // The tick of the last finger has ended.
                    if finger == 0 && !bytes.is_empty() {
                        engine.send(bytes);
                    }
                    let legs = engine.legs(finger);
                    let world = engine.world(finger);
                    set(world, finger);
                    world.step(legs);
                }
            }
        }
    }

    /// Appends the bytes received from the device.
    pub fn receive(&mut self, into: &mut Vec<u8>) {
        match self {
            Self::One(engine) => engine.receive(into),
            Self::Five(engine) => engine.receive(into),
        }
    }

    /// The plant of a finger.
    pub fn plant(&mut self, finger: usize) -> &Plant {
        match self {
            Self::One(engine) => engine.world().plant(),
            Self::Five(engine) => engine.world(finger).plant(),
        }
    }
}

/// The line to a device without a session.
#[derive(Debug)]
pub struct DeviceLink {
    device: RunningDevice,
    force_n: f64,
    line: VirtualLine,
}

impl DeviceLink {
    /// The line to a device that nobody touches.
    pub fn new(device: RunningDevice) -> Self {
        Self { device, force_n: 0.0, line: VirtualLine::default() }
    }

    /// Presses a finger on the first display, N.
    pub const fn press(&mut self, force_n: f64) {
        self.force_n = force_n;
    }

    /// The plant of the first display.
    pub fn plant(&mut self) -> &Plant {
        self.device.plant(0)
    }
}

impl Link for DeviceLink {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.line.send(bytes);
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let input = FingerInput { force_n: self.force_n, skin_elsewhere_c: None };
        let device = &mut self.device;
        self.line.receive(timeout, |bytes, received| {
            device.run_1_ms(bytes, &[input], &[]);
            device.receive(received);
            Ok(())
        })
    }

    fn now(&self) -> Duration {
        self.line.now()
    }
}
