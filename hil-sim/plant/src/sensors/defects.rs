//! Defects of the sensors, in front of the A/D converter.

use super::THERMISTORS;

/// Circuit of a thermistor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Circuit {
    /// Intact.
    #[default]
    Closed,
    /// Open: the pin is at the reference voltage, which reads very cold.
    Open,
    /// Shorted to ground, which reads very hot; also the state of the pin when the divider has no supply.
    Short,
    /// A resistor of so many ohm is in its place.
    Resistor(f64),
}

/// Defects of one thermistor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermistorDefect {
    /// Circuit.
    pub circuit: Circuit,
    /// Offset of its reading, K.
    pub offset_k: f64,
    /// Factor on the thermal resistance from the thermistor to its surroundings, 1 or more; the conductance of the leads
    /// is unchanged. Time constant, lead error and self-heating increase by this factor.
    pub resistance_factor: f64,
}

impl ThermistorDefect {
    /// No defect.
    pub const NONE: Self = Self { circuit: Circuit::Closed, offset_k: 0.0, resistance_factor: 1.0 };
}

/// Defects of the force sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceDefect {
    /// Its wire is open; the pin is at ground.
    pub open: bool,
    /// Its signal is frozen; the noise of the converter remains.
    pub stuck: bool,
    /// Offset of its reading, N.
    pub offset_n: f64,
}

/// Defects of the sensors of a finger; none by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorDefects {
    /// Defects of each thermistor.
    pub thermistors: [ThermistorDefect; THERMISTORS],
    /// Index of the thermistor, with its pull-up, that is connected to each thermistor channel.
    pub connected: [usize; THERMISTORS],
    /// The skin thermistor sits on the display's plate instead of on the finger.
    pub skin_on_plate: bool,
    /// Force sensor.
    pub force: ForceDefect,
    /// Current at which the output of the current mirror is frozen, A.
    pub mirror_stuck_a: Option<f64>,
}

impl SensorDefects {
    /// No defect.
    pub const NONE: Self = Self {
        thermistors: [ThermistorDefect::NONE; THERMISTORS],
        connected: [0, 1, 2, 3, 4],
        skin_on_plate: false,
        force: ForceDefect { open: false, stuck: false, offset_n: 0.0 },
        mirror_stuck_a: None,
    };
}

impl Default for SensorDefects {
    fn default() -> Self {
        Self::NONE
    }
}
