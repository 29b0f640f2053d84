//! A tile that answers as one of its class does, so that a device on it passes its self-test and stays armed.

use thermal_display::device::drive::{Drive, Outputs};
use thermal_display::device::sense::Samples;

/// What the sensors of one finger see. Not the plant: a first-order tile, to keep a tick short.
#[derive(Clone, Copy, Debug)]
pub struct Tile {
    plate_c: f64,
    /// The plate, as its thermistors have it, 0.1 s late.
    display_c: f64,
    /// Sums of sink, skin and room.
    others: [u16; 3],
    sink_c: f64,
    force: u16,
    current: u16,
    cut: bool,
    /// Keeps sums from repeating themselves.
    noise: u16,
}

/// Largest sum of 16 conversions of 12 bits.
pub const FULL_SCALE: u16 = 16 * 4095;

/// The sum of a 10 k thermistor of beta 3950 K under 10 k.
pub fn sum_at(celsius: f64) -> u16 {
    let ratio = (3950.0 * (1.0 / (celsius + 273.15) - 1.0 / 298.15)).exp();
    (65536.0 * ratio / (1.0 + ratio)) as u16
}

/// The temperature of a sum, its inverse, °C.
pub fn celsius_at(sum: u16) -> f64 {
    let sum = f64::from(sum);
    1.0 / (1.0 / 298.15 + (sum / (65536.0 - sum)).ln() / 3950.0) - 273.15
}

impl Default for Tile {
    fn default() -> Self {
        Self {
            plate_c: 26.0,
            display_c: 26.0,
            others: [25.0, 34.0, 24.0].map(sum_at),
            sink_c: 25.0,
            force: Self::force(0.0),
            current: 0,
            cut: false,
            noise: 1,
        }
    }
}

impl Tile {
    fn force(newton: f64) -> u16 {
        (16.0 * (410.0 + 300.0 * newton)).min(f64::from(FULL_SCALE)) as u16
    }

    /// A finger presses.
    pub fn press(&mut self, newton: f64) {
        self.force = Self::force(newton);
    }

    /// Sink, skin and room are of these temperatures from now on, °C.
    pub fn surround(&mut self, sink_c: f64, skin_c: f64, room_c: f64) {
        self.sink_c = sink_c;
        self.others = [sink_c, skin_c, room_c].map(sum_at);
    }

    /// What the sensors say.
    pub fn samples(&mut self) -> Samples {
        // Xorshift: zero never comes.
        self.noise ^= self.noise << 7;
        self.noise ^= self.noise >> 9;
        self.noise ^= self.noise << 8;
        let noise = |shift: u16| self.noise >> shift & 3;
        let display = sum_at(self.display_c);
        let [sink, skin, room] = self.others;
        Samples {
            display: display + noise(0),
            display_check: display + noise(2),
            sink: sink + noise(4),
            skin: skin + noise(6),
            room: room + noise(8),
            force: self.force + noise(10),
            current: self.current + noise(12),
            bridge_fault: self.cut,
        }
    }

    /// A millisecond under these outputs.
    pub fn drive(&mut self, outputs: Outputs) {
        let current_a = match outputs.drive {
            Drive::Off => 0.0,
            Drive::On(duty) => {
                let duty: f64 = duty.fraction().to_num();
                (12.0 * duty - 0.0273 * (self.sink_c - self.plate_c)) / 1.251
            }
        };
        // Beyond 0.5 A the dead times take 0.4 V.
        let current_a =
            current_a.signum() * (current_a.abs() - 0.32 * (current_a.abs() / 0.5).min(1.0));
        let slope_k_s =
            -2.91 * current_a * (1.0 - 0.0585 * current_a) - 0.103 * (self.plate_c - self.sink_c);
        self.plate_c = (self.plate_c + 1e-3 * slope_k_s).clamp(-20.0, 80.0);
        self.display_c += 1e-3 / 0.1 * (self.plate_c - self.display_c);
        self.current = (6400.0 * current_a.abs()).min(f64::from(FULL_SCALE)) as u16 & !3;
        self.cut = outputs.comparator_test;
    }
}
