//! What a meter finds on a board and the plant does not model: pulls, contacts, rails, ladder.
//!
//! Nominal values are those of the netlists in `hardware/`; a test compares them.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, Uniform};
use thermal_plant::parameters::stream_seed;

/// Resistors and voltages of a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wiring {
    /// Pull-down of bridge IN1, ohm.
    pub in1_ohm: f64,
    /// Pull-down of bridge IN2, ohm.
    pub in2_ohm: f64,
    /// Pull-down of bridge enable, ohm.
    pub enable_ohm: f64,
    /// Pull-down of BOOT0, ohm.
    pub boot0_ohm: f64,
    /// Pull-down of the comparator's test line, ohm.
    pub test_ohm: f64,
    /// Pull-down of the line that selects its side, ohm.
    pub side_ohm: f64,
    /// From that line to the test level, and each of the two resistors that make the level, ohm.
    pub side_to_level_ohm: f64,
    /// As before.
    pub level_ohm: f64,
    /// Pull-up of nFAULT, ohm.
    pub nfault_ohm: f64,
    /// Fuse, ohm.
    pub fuse_ohm: f64,
    /// First contact of the emergency stop, closed, ohm.
    pub stop_ohm: f64,
    /// Plate to analog ground, ohm.
    pub plate_ohm: f64,
    /// Divider of the sensed bridge supply, both resistors, ohm.
    pub sense_ohm: f64,
    /// Ladder of the comparator from the top, ohm.
    pub ladder_ohm: [f64; 3],
    /// 12 V of the laboratory supply, V.
    pub supply_v: f64,
    /// 5 V, V.
    pub rail_5_v: f64,
    /// 3.3 V, V.
    pub rail_3_v: f64,
    /// Current out of the 12 V supply with the bridge off, A.
    pub idle_a: f64,
}

/// Current into the ladder's taps that does not come from its resistors: pull-up of the hot tap to 5 V, ohm, and hysteresis
/// of the cold tap from the comparator's output, which is at 5 V inside of the window.
const BIAS_OHM: f64 = 360e3;
/// As before.
const HYSTERESIS_OHM: f64 = 1e6;
/// The comparator's output inside of the window, V.
const OUTPUT_V: f64 = 4.97;

impl Wiring {
    /// Values of the netlists.
    pub const NOMINAL: Self = Self {
        in1_ohm: 4700.0,
        in2_ohm: 4700.0,
        enable_ohm: 4700.0,
        boot0_ohm: 4700.0,
        test_ohm: 4700.0,
        side_ohm: 4700.0,
        side_to_level_ohm: 6340.0,
        level_ohm: 10e3,
        nfault_ohm: 4700.0,
        fuse_ohm: 8e-3,
        stop_ohm: 0.01,
        plate_ohm: 1000.0,
        sense_ohm: 43e3,
        ladder_ohm: [3400.0, 3700.0, 3010.0],
        supply_v: 12.0,
        rail_5_v: 5.0,
        rail_3_v: 3.3,
        idle_a: 0.06,
    };

    /// A board whose parts and instruments are drawn from their tolerances.
    pub fn drawn(seed: u64) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(stream_seed(seed, "wiring"));
        let mut draw = |nominal: f64, tolerance: f64| {
            let deviation = Uniform::new_inclusive(-tolerance, tolerance);
            // Both bounds are finite numbers of this file.
            nominal * (1.0 + deviation.map_or(0.0, |deviation| deviation.sample(&mut random)))
        };
        let n = Self::NOMINAL;
        // A resistor of 1 %, and a meter of 1 %.
        let mut resistor = |ohm: f64| draw(ohm, 0.02);
        let [in1_ohm, in2_ohm, enable_ohm, boot0_ohm, nfault_ohm] =
            [n.in1_ohm, n.in2_ohm, n.enable_ohm, n.boot0_ohm, n.nfault_ohm].map(&mut resistor);
        let [test_ohm, side_ohm, side_to_level_ohm, level_ohm, sense_ohm] =
            [n.test_ohm, n.side_ohm, n.side_to_level_ohm, n.level_ohm, n.sense_ohm]
                .map(&mut resistor);
        Self {
            in1_ohm,
            in2_ohm,
            enable_ohm,
            boot0_ohm,
            test_ohm,
            side_ohm,
            side_to_level_ohm,
            level_ohm,
            nfault_ohm,
            fuse_ohm: draw(n.fuse_ohm, 0.5) + 0.05,
            stop_ohm: draw(n.stop_ohm, 0.5) + 0.05,
            plate_ohm: draw(n.plate_ohm, 0.05),
            sense_ohm,
            ladder_ohm: n.ladder_ohm.map(|ohm| draw(ohm, 0.0016)),
            supply_v: draw(n.supply_v, 0.01),
            rail_5_v: draw(n.rail_5_v, 0.03),
            rail_3_v: draw(n.rail_3_v, 0.02),
            idle_a: draw(n.idle_a, 0.5),
        }
    }

    /// Voltages of the ladder's taps with these rails, V: of the cold and of the hot side.
    pub fn taps_v(&self) -> [f64; 2] {
        let [top, middle, bottom] = self.ladder_ohm.map(f64::recip);
        let cold_s = top + middle + HYSTERESIS_OHM.recip();
        let hot_s = middle + bottom + BIAS_OHM.recip();
        let cold_a = self.rail_3_v * top + OUTPUT_V * HYSTERESIS_OHM.recip();
        let hot_a = self.rail_5_v * BIAS_OHM.recip();
        let determinant = cold_s * hot_s - middle * middle;
        [
            (cold_a * hot_s + middle * hot_a) / determinant,
            (cold_s * hot_a + middle * cold_a) / determinant,
        ]
    }

    /// From the line that selects the side of the test to ground, without power: its pull-down beside the resistors of the
    /// level. `rail_ohm` is what the 3.3 V have to ground.
    pub fn side_to_ground_ohm(&self, rail_ohm: f64) -> f64 {
        let level = parallel(self.level_ohm, self.level_ohm + rail_ohm);
        parallel(self.side_ohm, self.side_to_level_ohm + level)
    }
}

/// Two resistors side by side, ohm.
fn parallel(a_ohm: f64, b_ohm: f64) -> f64 {
    (a_ohm.recip() + b_ohm.recip()).recip()
}
