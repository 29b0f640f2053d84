//! A drawn device in its room, as it is assembled: tuned or not, with slow thermistors as often as with quick ones, and on a load cell
//! that rings, shakes and drifts.

use std::collections::BTreeMap;
use std::fmt::Write;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_plant::parameters::stream_seed;

use super::touch::log_uniform;
use crate::fidelity::PlantDraw;

/// Time constant of both thermistors of the display, s, drawn uniformly, so that slow ones are not rare.
const LAG_S: std::ops::RangeInclusive<f64> = 0.02..=0.5;
const LAGS: [&str; 2] = ["sensors.display.lag_s", "sensors.check.lag_s"];
/// Range of the coolant, °C, which the box draws relative to the room. A colder one leaves a display at rest below its limit.
const COOLANT_C: (f64, f64) = (16.0, 40.0);
const COOLANT: &str = "tile.coolant_k";
/// Compliances of the load cell, m/N, drawn with a uniform logarithm: resonance at 1000 to 41 Hz under 0.5 kg.
const COMPLIANCE_M_N: (f64, f64) = (5e-8, 3e-5);
/// Vibration of the fan in the cell's force, N, and its frequency, Hz.
const VIBRATION_N: (f64, f64) = (1e-3, 0.05);
const VIBRATION_HZ: (f64, f64) = (30.0, 200.0);
/// Drift of the cell's zero, N/s, either way.
const DRIFT_N_S: f64 = 2e-3;
const ROOMS_C: std::ops::RangeInclusive<f64> = 15.0..=30.0;
/// Room of the nominal device, °C.
const NOMINAL_ROOM_C: f64 = 24.0;

/// A device in its room.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnDevice {
    /// Seed of the converter's profile and noise.
    pub(super) seed: u64,
    /// Whether it was commissioned; else it has the settings of the factory.
    pub(super) tuned: bool,
    pub(super) room_c: f64,
    /// Plant parameters that are not nominal.
    pub(super) plant: BTreeMap<String, f64>,
}

impl DrawnDevice {
    /// Consecutive campaigns on one device, because commissioning it takes longer than a campaign.
    pub(super) const CAMPAIGNS: u64 = 8;

    /// The nominal device with this seed of its converter, commissioned, in a room of 24 °C.
    pub(super) fn nominal(seed: u64) -> Self {
        Self { seed, tuned: true, room_c: NOMINAL_ROOM_C, plant: BTreeMap::new() }
    }

    /// A device by seed and number. Those of odd numbers are untuned.
    pub(super) fn new(seed: u64, number: u64) -> Self {
        let own = stream_seed(seed, &format!("device {number}"));
        let mut draw = Xoshiro256PlusPlus::seed_from_u64(own);
        let PlantDraw { seed, plant, .. } = PlantDraw::in_use(seed, number);
        let mut plant: BTreeMap<_, _> = plant.into_iter().collect();
        let room_c = draw.random_range(ROOMS_C);
        let lag_s = draw.random_range(LAG_S);
        for key in LAGS {
            plant.insert(key.into(), lag_s);
        }
        for (key, value) in [
            ("compliance_m_n", log_uniform(&mut draw, COMPLIANCE_M_N)),
            ("vibration_n", log_uniform(&mut draw, VIBRATION_N)),
            ("vibration_hz", log_uniform(&mut draw, VIBRATION_HZ)),
            ("drift_n_s", draw.random_range(-DRIFT_N_S..=DRIFT_N_S)),
        ] {
            plant.insert(format!("sensors.force.cell.{key}"), value);
        }
        if let Some(coolant_k) = plant.get_mut(COOLANT) {
            *coolant_k = coolant_k.clamp(COOLANT_C.0 - room_c, COOLANT_C.1 - room_c);
        }
        Self { seed, tuned: number.is_multiple_of(2), room_c, plant }
    }

    /// Time constant of both thermistors of the display, s, if it was drawn.
    pub(super) fn lag_s(&self) -> Option<f64> {
        self.plant.get(LAGS[0]).copied()
    }

    /// Keys of a scene outside its tables, and those of `[device]`, with which they end.
    pub(super) fn keys(&self) -> String {
        self.keys_if_tuned(self.tuned)
    }

    /// The same, but tuned or not as given.
    pub(super) fn keys_if_tuned(&self, tuned: bool) -> String {
        let Self { room_c, seed, .. } = self;
        format!("room_c = {room_c:?}\nseed = {seed}\n[device]\ncommissioned = {tuned}\n")
    }

    /// Keys of `[plant]`.
    pub(super) fn plant_keys(&self) -> String {
        let mut text = String::new();
        for (key, value) in &self.plant {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{key} = {value:?}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_devices_are_untuned_and_their_thermistors_slow_and_quick() {
        let devices: Vec<_> = (0..100).map(|number| DrawnDevice::new(7, number)).collect();
        assert_eq!(devices.iter().filter(|device| device.tuned).count(), 50);
        let lag_s = |device: &DrawnDevice| device.lag_s().expect("a drawn lag");
        for slow in [false, true] {
            let count = devices.iter().filter(|device| (lag_s(device) > 0.26) == slow).count();
            assert!((30..70).contains(&count), "{count}");
        }
        for device in devices {
            let coolant_c = device.room_c + device.plant[COOLANT];
            assert!((16.0 - 1e-9..=40.0 + 1e-9).contains(&coolant_c), "{coolant_c} °C");
        }
    }
}
