//! Maps active faults to defects of the plant and of the converter.

use thermal_plant::Defects;
use thermal_plant::bridge::LegDefect;
use thermal_plant::comparator::LatchDefect;
use thermal_plant::sensors::{Channel, Circuit, FluxCircuit};
use thermal_plant::supply::SwitchDefect;

use crate::scene::{ActiveFault, FaultKind};

/// Present defects of plant and converter.
#[derive(Clone, Copy, Debug, Default)]
pub struct ActiveDefects {
    /// Defects of the plant.
    pub plant: Defects,
    /// Channels whose code is frozen.
    pub frozen: [bool; Channel::ALL.len()],
}

impl ActiveDefects {
    /// Adds a fault to the present ones.
    pub fn add(&mut self, fault: &ActiveFault) {
        let Defects { sensors, flux, bridge, comparator, supply, cooling, module } =
            &mut self.plant;
        let (index, value) = (fault.sensor as usize, fault.value);
        let thermistor = &mut sensors.thermistors[index];
        match fault.kind {
            FaultKind::ThermistorOpen => thermistor.circuit = Circuit::Open,
            FaultKind::ThermistorShort => thermistor.circuit = Circuit::Short,
            FaultKind::ThermistorDrift | FaultKind::ThermistorOffset => {
                thermistor.offset_k += value
            }
            FaultKind::ThermistorDetached => thermistor.resistance_factor *= value,
            FaultKind::ThermistorStuck => self.frozen[index] = true,
            FaultKind::SensorsSwapped => sensors.connected.swap(index, fault.with as usize),
            FaultKind::ReferenceOff => {
                for thermistor in &mut sensors.thermistors {
                    thermistor.circuit = Circuit::Short;
                }
            }
            FaultKind::AdcStuck => self.frozen = [true; Channel::ALL.len()],
            FaultKind::SkinOnPlate => sensors.skin_on_plate = true,
            FaultKind::ForceOpen => sensors.force.open = true,
            FaultKind::ForceStuck => sensors.force.stuck = true,
            FaultKind::ForceOffset => sensors.force.offset_n += value,
            FaultKind::FluxOpen => flux.circuit = FluxCircuit::Open,
            FaultKind::FluxShort => flux.circuit = FluxCircuit::Short,
            FaultKind::FluxReversed => flux.circuit = FluxCircuit::Reversed,
            FaultKind::FluxStuck => flux.stuck = true,
            FaultKind::FluxGain => flux.gain *= value,
            FaultKind::FluxZero => flux.zero_w_m2 += value,
            FaultKind::FluxNoise => flux.noise *= value,
            FaultKind::BridgeStuckHigh => bridge.a = LegDefect::High,
            FaultKind::BridgeBStuckHigh => bridge.b = LegDefect::High,
            FaultKind::BridgeStuckLow => bridge.a = LegDefect::Low,
            FaultKind::LegOpen => bridge.a = LegDefect::Open,
            FaultKind::BridgeShorted => bridge.a = LegDefect::Shorted,
            FaultKind::BridgeEnableStuck => bridge.enable_stuck = true,
            FaultKind::PolaritySwapped => bridge.swapped = true,
            FaultKind::FaultPinDead => bridge.fault_pin_dead = true,
            FaultKind::MirrorStuck => sensors.mirror_stuck_a = Some(value),
            FaultKind::ComparatorDead | FaultKind::LatchStuckClear => {
                comparator.latch = LatchDefect::StuckClear;
            }
            FaultKind::ComparatorStuck | FaultKind::LatchStuckSet => {
                comparator.latch = LatchDefect::StuckSet;
            }
            FaultKind::WindowDead => (comparator.hot_dead, comparator.cold_dead) = (true, true),
            FaultKind::WindowHotDead => comparator.hot_dead = true,
            FaultKind::WindowColdDead => comparator.cold_dead = true,
            FaultKind::SideStuck => comparator.side_stuck = Some(value >= 0.5),
            FaultKind::LadderShift => comparator.ladder_shift_k += value,
            FaultKind::SwitchShorted => supply.switch = SwitchDefect::Shorted,
            FaultKind::SwitchOpen => supply.switch = SwitchDefect::Open,
            FaultKind::EmergencyStop => supply.emergency_stop = true,
            FaultKind::SupplySenseOpen => supply.sense_open = true,
            FaultKind::SupplyLow | FaultKind::SupplyHigh => bridge.supply_v = Some(value),
            FaultKind::ModuleWeak => module.seebeck = value,
            FaultKind::FanOff => cooling.resistance_factor *= value,
            FaultKind::ChillerOff => cooling.coolant_c = Some(value),
            FaultKind::SinkHot => cooling.held_c = Some(value),
            // These act in the host.
            FaultKind::HostGarbage
            | FaultKind::HostSilent
            | FaultKind::HostFlood
            | FaultKind::HostPlays => {}
            // These act at the trigger input.
            FaultKind::TriggerStuck | FaultKind::TriggerChatter => {}
        }
    }
}
