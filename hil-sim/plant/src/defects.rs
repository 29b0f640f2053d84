//! Defects of a plant.

use super::bridge::BridgeDefects;
use super::comparator::ComparatorDefects;
use super::sensors::{FluxDefect, SensorDefects};
use super::supply::SupplyDefects;
use super::tile::{CoolingDefects, ModuleDefect};

/// Simulated hardware defects of one finger's plant; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defects {
    /// Sensors in front of the converter.
    pub sensors: SensorDefects,
    /// Heat-flux sensor, where one is fitted.
    pub flux: FluxDefect,
    /// Power stage.
    pub bridge: BridgeDefects,
    /// Comparator.
    pub comparator: ComparatorDefects,
    /// Supply of the bridge and its switch.
    pub supply: SupplyDefects,
    /// Cooling of the sink.
    pub cooling: CoolingDefects,
    /// Thermoelectric module.
    pub module: ModuleDefect,
}
