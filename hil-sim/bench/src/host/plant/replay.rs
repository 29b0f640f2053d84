//! The firmware's logic alone, on recorded samples.
use std::hint::black_box;

use anyhow::bail;
use thermal_display::device::drive::Drive;
use thermal_display::device::sense::{DigitalInputs, SCANS_PER_TICK, Samples, Scan};
use thermal_display::device::{Device, FingerIndex};
use thermal_display::protocol::CommandHandler;
use thermal_display::settings::Settings;
use thermal_plant::Plant;

use super::finger::{Finger, LINES, READY_MS, force_n};

/// A device in contact, and the samples of its following ticks.
pub struct Replay {
    start: Device<1>,
    samples: Vec<Samples>,
}

impl Replay {
    /// Runs a second device on the samples of a finger from switch-on, and records `ticks` of contact.
    ///
    /// # Errors
    /// The device refused a line, or its bridge is off.
    pub fn record(seed: u64, ticks: usize) -> anyhow::Result<Self> {
        let settings = Settings::default();
        let mut device = Device::new(&settings);
        let mut handler = CommandHandler::new(settings);
        let mut finger = Finger::switched_on(seed)?;
        let mut samples = |ms: u64| {
            finger.send_lines_of(ms);
            finger.step(force_n(ms));
            let inputs = DigitalInputs { bridge_fault: finger.fault(), ..DigitalInputs::default() };
            Samples::from_scans(&scans(&mut finger.plant()), inputs, false)
        };
        for ms in 0..READY_MS {
            for (_, line) in LINES.iter().filter(|(at, _)| *at == ms) {
                let answer =
                    handler.answer(line, |finger, command| device.execute(finger, command));
                if let Err(error) = answer {
                    bail!("the device refuses {line:?}: {error}");
                }
            }
            device.step_finger(FingerIndex::FIRST, &samples(ms));
        }
        let samples = (READY_MS..).take(ticks).map(samples).collect();
        let replay = Self { start: device, samples };
        match replay.run() {
            Drive::On(_) => Ok(replay),
            Drive::Off => bail!("the recorded device has switched its bridge off"),
        }
    }

    /// Runs all recorded ticks and returns the bridge command of the last one.
    pub fn run(&self) -> Drive {
        let mut device = self.start.clone();
        let mut drive = Drive::Off;
        for samples in &self.samples {
            drive = black_box(device.step_finger(FingerIndex::FIRST, black_box(samples))).drive;
        }
        drive
    }
}

/// All conversions of one tick.
pub fn scans(plant: &mut Plant) -> [Scan; SCANS_PER_TICK] {
    std::array::from_fn(|_| plant.convert_scan())
}
