//! What can be broken in the sensors, in front of the converter.

use super::THERMISTORS;

/// The wires of a thermistor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Circuit {
    /// Sound.
    #[default]
    Closed,
    /// Open: the pin is at the reference, as if it were very cold.
    Open,
    /// Shorted to ground, as if it were very hot; so is the pin when nothing feeds the divider.
    Short,
}

/// What is broken in one thermistor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermistorDefect {
    /// Its wires.
    pub circuit: Circuit,
    /// What it reads too much, K.
    pub offset_k: f64,
    /// By how much less heat goes between it and what it sits on and along its leads together, 1 or more; what goes
    /// along its leads stays. So lag, share of the room and self-heating grow by this factor.
    pub loose: f64,
}

impl ThermistorDefect {
    /// Nothing.
    pub const NONE: Self = Self {
        circuit: Circuit::Closed,
        offset_k: 0.0,
        loose: 1.0,
    };
}

/// What is broken in the force sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceDefect {
    /// Its wire is open; the pin is at ground.
    pub open: bool,
    /// It no longer moves; the converter's noise stays.
    pub stuck: bool,
    /// What it reads too much, N.
    pub offset_n: f64,
}

/// What is broken in the sensors of a finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorDefects {
    /// Each thermistor.
    pub thermistors: [ThermistorDefect; THERMISTORS],
    /// Which thermistor, pull-up included, is plugged in where each should be.
    pub plugged: [usize; THERMISTORS],
    /// Force sensor.
    pub force: ForceDefect,
    /// What the current mirror always sees, A.
    pub mirror_stuck_a: Option<f64>,
}

impl SensorDefects {
    /// Nothing.
    pub const NONE: Self = Self {
        thermistors: [ThermistorDefect::NONE; THERMISTORS],
        plugged: [0, 1, 2, 3, 4],
        force: ForceDefect {
            open: false,
            stuck: false,
            offset_n: 0.0,
        },
        mirror_stuck_a: None,
    };
}

impl Default for SensorDefects {
    fn default() -> Self {
        Self::NONE
    }
}
