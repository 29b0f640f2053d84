//! The firmware's logic alone, on samples that were recorded.
use std::hint::black_box;

use anyhow::bail;
use thermal_display::Station;
use thermal_display::drive::Drive;
use thermal_display::protocol::Command;
use thermal_display::sense::{SCANS_PER_TICK, Samples, Scan};
use thermal_display::settings::Settings;
use thermal_plant::Plant;
use thermal_plant::sensors::Channel;

use super::finger::{Finger, LINES, READY_MS, force_n};

/// A station in contact, and what it is to sample.
pub struct Replay {
    start: Station,
    samples: Vec<Samples>,
}

impl Replay {
    /// Lets a second station look at a finger from switch-on, and records `ticks` of contact.
    ///
    /// # Errors
    /// The station refused a line or is not driven.
    pub fn record(seed: u64, ticks: usize) -> anyhow::Result<Self> {
        let settings = Settings::default();
        let mut station = Station::new(&settings);
        let mut finger = Finger::switched_on(seed)?;
        let mut look = |ms: u64| {
            finger.send_lines_of(ms);
            finger.step(force_n(ms));
            Samples::from_scans(&scans(&mut finger.plant()), finger.fault())
        };
        for ms in 0..READY_MS {
            for (_, line) in LINES.iter().filter(|(at, _)| *at == ms) {
                let done =
                    Command::parse(line, &settings).and_then(|command| station.execute(command));
                if let Err(error) = done {
                    bail!("the station refuses {line:?}: {error}");
                }
            }
            station.step(&look(ms));
        }
        let samples: Vec<_> = (READY_MS..).take(ticks).map(look).collect();
        let replay = Self {
            start: station,
            samples,
        };
        match replay.run() {
            Drive::On(_) => Ok(replay),
            Drive::Off => bail!("the recorded station has switched off"),
        }
    }

    /// All recorded ticks; the bridge command of the last.
    pub fn run(&self) -> Drive {
        let mut station = self.start.clone();
        let mut drive = Drive::Off;
        for samples in &self.samples {
            drive = black_box(station.step(black_box(samples))).drive;
        }
        drive
    }
}

/// All conversions of a tick.
pub fn scans(plant: &mut Plant) -> [Scan; SCANS_PER_TICK] {
    std::array::from_fn(|_| Channel::ALL.map(|channel| plant.convert(channel)))
}
