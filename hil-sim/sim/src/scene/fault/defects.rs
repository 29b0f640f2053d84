//! Defects that the present faults cause.

use thermal_plant::Defects;
use thermal_plant::sensors::{Channel, ThermistorDefect};

use super::ActiveFault;

/// Present defects of plant and converter.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ActiveDefects {
    /// Defects of the plant.
    pub plant: Defects,
    /// Channels whose code is frozen.
    pub frozen: [bool; Channel::ALL.len()],
}

impl ActiveDefects {
    /// Adds a fault to the present ones.
    pub fn add(&mut self, fault: &ActiveFault) {
        (fault.kind.row().effect)(self, fault);
    }

    /// Defects of the thermistor of a fault.
    pub(super) const fn thermistor(&mut self, fault: &ActiveFault) -> &mut ThermistorDefect {
        &mut self.plant.sensors.thermistors[fault.sensor as usize]
    }
}
