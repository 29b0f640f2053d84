//! A simulated tile with the class's nominal response, so that a device on it passes its self-test and stays armed.

use thermal_display::device::drive::{BoardOutputs, ComparatorTest, Drive};
use thermal_display::device::sense::Samples;

/// Tile and sensors of one finger. A first-order model instead of the plant of `hil-sim`, to keep a tick fast.
#[derive(Clone, Copy, Debug)]
pub struct Tile {
    plate_c: f64,
    /// Temperature of the plate's thermistors, which lag by 0.1 s.
    display_c: f64,
    /// Sums of sink, skin and room.
    others: [u16; 3],
    sink_c: f64,
    force: u16,
    current: u16,
    comparator_tripped: bool,
    /// State of the noise generator; without noise, the sums would count as frozen.
    noise: u16,
}

/// Sums of the bridge's supply: 12 V, and 4 V while the comparator cuts it.
const SUPPLY: u16 = 16 * 3464;
const CUT_SUPPLY: u16 = 16 * 1155;

/// Sum of 16 conversions of 12 bits at full scale.
pub const FULL_SCALE: u16 = 16 * 4095;

/// The sum of a thermistor of 10 kΩ at 25 °C and beta 3950 K with a pull-up of 10 kΩ.
pub fn sum_at(celsius: f64) -> u16 {
    let ratio = (3950.0 * (1.0 / (celsius + 273.15) - 1.0 / 298.15)).exp();
    (65536.0 * ratio / (1.0 + ratio)) as u16
}

/// The inverse of [`sum_at`], °C.
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
            force: Self::force_sum(0.0),
            current: 0,
            comparator_tripped: false,
            noise: 1,
        }
    }
}

impl Tile {
    fn force_sum(force_n: f64) -> u16 {
        (16.0 * (410.0 + 300.0 * force_n)).min(f64::from(FULL_SCALE)) as u16
    }

    /// Sets the force.
    pub fn press(&mut self, force_n: f64) {
        self.force = Self::force_sum(force_n);
    }

    /// Sets the temperatures of sink, skin and room.
    pub fn set_surroundings(&mut self, sink_c: f64, skin_c: f64, room_c: f64) {
        self.sink_c = sink_c;
        self.others = [sink_c, skin_c, room_c].map(sum_at);
    }

    /// Samples of one tick.
    pub fn samples(&mut self) -> Samples {
        // Xorshift, which never reaches zero.
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
            supply: if self.comparator_tripped { CUT_SUPPLY } else { SUPPLY },
            bridge_fault: self.comparator_tripped,
            emergency_stop: false,
            comparator_side_differs: false,
            scattering_thermistors: 0,
        }
    }

    /// Advances the model by one tick of 1 ms.
    pub fn drive(&mut self, outputs: BoardOutputs) {
        let current_a = match outputs.drive {
            Drive::Off => 0.0,
            Drive::On(duty) => {
                let duty: f64 = duty.fraction().to_num();
                (12.0 * duty - 0.0273 * (self.sink_c - self.plate_c)) / 1.111
            }
        };
        // From 0.5 A on the dead times of the bridge cost 0.21 V.
        let current_a =
            current_a.signum() * (current_a.abs() - 0.19 * (current_a.abs() / 0.5).min(1.0));
        let slope_k_s =
            -2.91 * current_a * (1.0 - 0.0585 * current_a) - 0.103 * (self.plate_c - self.sink_c);
        self.plate_c = (self.plate_c + 1e-3 * slope_k_s).clamp(-20.0, 80.0);
        self.display_c += 1e-3 / 0.1 * (self.plate_c - self.display_c);
        self.current = (6400.0 * current_a.abs()).min(f64::from(FULL_SCALE)) as u16 & !3;
        self.comparator_tripped = outputs.comparator_test != ComparatorTest::None;
    }
}
