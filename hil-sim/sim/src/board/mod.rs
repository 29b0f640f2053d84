//! An emulated board on the bench: sound or with an error of assembly, with what is connected to it, and with what meters
//! show.
//!
//! ```text
//! Board: parameters and defects of the plant, state of the chip, wiring   <- drawn tolerances, broken by name
//!   + Connected: parts that hands have connected, buttons                 <- fit, remove, press, release
//!   = defects of the plant, and what an instrument shows                  -> meter
//! ```

mod broken;
mod connected;
mod lossy_line;
mod meter;
mod wiring;

use thermal_plant::sensors::ThermistorParams;
use thermal_plant::{Defects, Params, parameters};

use crate::commissioning::CommissioningSetup;
use crate::processor::ChipState;

pub use broken::{BROKEN_BOARDS, BrokenBoard};
pub use connected::BoardBench;
pub use lossy_line::LossyLine;
pub use wiring::Wiring;

/// Name of the board without an error.
pub const SOUND: &str = "sound";
/// Room of the bench, deg C.
const ROOM_C: f64 = 24.0;

/// A board as it was built.
#[derive(Clone, Debug)]
pub struct Board {
    /// Parameters of the plant.
    pub params: Params,
    /// Defects of the plant.
    pub defects: Defects,
    /// The microcontroller before its program starts.
    pub chip: ChipState,
    /// What the plant does not model.
    pub wiring: Wiring,
    /// Whether the emergency stop is not in the 12 V line.
    pub stop_is_bypassed: bool,
    /// Whether more force gives fewer counts.
    pub force_is_reversed: bool,
    /// Whether the microcontroller's reset line does not set the comparator's latch.
    pub reset_is_unconnected: bool,
    /// The serial line loses one of so many bytes from the device.
    pub lost_bytes_interval: Option<u64>,
    seed: u64,
}

impl Board {
    /// The board of this name; with a seed its parts are drawn from their tolerances.
    ///
    /// # Errors
    /// There is no such board; the error lists the names.
    pub fn named(name: &str, seed: Option<u64>) -> Result<Self, String> {
        let broken = BROKEN_BOARDS.iter().find(|broken| broken.name == name);
        if broken.is_none() && name != SOUND {
            let names: Vec<_> = BROKEN_BOARDS.iter().map(|broken| broken.name).collect();
            return Err(format!("board '{name}'; known: {SOUND} {}", names.join(" ")));
        }
        let mut board = Self::sound(seed);
        if let Some(broken) = broken {
            (broken.break_it)(&mut board);
        }
        board.set_thresholds();
        Ok(board)
    }

    fn sound(seed: Option<u64>) -> Self {
        let mut params = Params::nominal();
        let mut chip = ChipState::default();
        let wiring = match seed {
            Some(seed) => {
                parameters::draw(&mut params, seed);
                // Each drawn board has a chip of its own.
                [chip.unique_id[1], chip.unique_id[2]] = [(seed >> 32) as u32, seed as u32];
                Wiring::drawn(seed)
            }
            None => Wiring::NOMINAL,
        };
        Self {
            params,
            defects: Defects::default(),
            chip,
            wiring,
            stop_is_bypassed: false,
            force_is_reversed: false,
            reset_is_unconnected: false,
            lost_bytes_interval: None,
            seed: seed.unwrap_or_default(),
        }
    }

    /// Moves the comparator's thresholds by what the ladder's resistors differ from their nominal values.
    fn set_thresholds(&mut self) {
        let nominal = Wiring { ladder_ohm: Wiring::NOMINAL.ladder_ohm, ..self.wiring };
        let shift_k = |side: usize| {
            let at_c = |wiring: &Wiring| tap_c(wiring.taps_v()[side] / wiring.rail_3_v);
            at_c(&self.wiring) - at_c(&nominal)
        };
        let (cold_k, hot_k) = (shift_k(0), shift_k(1));
        self.params.comparator.cold_c += cold_k;
        self.params.comparator.hot_c += hot_k;
    }

    /// The board on its bench, where it is commissioned too.
    pub fn setup(&self) -> CommissioningSetup {
        CommissioningSetup::new(&self.params, ROOM_C, self.seed)
    }
}

/// Temperature at which a nominal thermistor in a nominal divider gives this ratio, deg C.
fn tap_c(ratio: f64) -> f64 {
    let ThermistorParams { at_25c_ohm, beta_k, pull_up_ohm, .. } =
        Params::nominal().sensors.thermistors[0];
    let ohm = pull_up_ohm * ratio / (1.0 - ratio);
    const ZERO_C_K: f64 = 273.15;
    ((25.0 + ZERO_C_K).recip() + (ohm / at_25c_ohm).ln() / beta_k).recip() - ZERO_C_K
}
