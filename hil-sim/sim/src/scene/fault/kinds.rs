//! The kinds of faults of plant, converter and host: a row for each.
//!
//! A row has the name in a scene; what fails, with its effect on the defects `d` of a fault `f`; unit and range of the value, if it
//! has one; and the effect in words, as in `docs/scenes.md`. A row of [`plant`] is of one finger unless it is `shared`.

use thermal_plant::bridge::LegDefect;
use thermal_plant::comparator::LatchDefect;
use thermal_plant::sensors::{Channel, Circuit, FluxCircuit};
use thermal_plant::supply::SwitchDefect;

use super::row::{Part, Row, ValueRange};
use super::row::{flux_sensor, host, plant, thermistor, trigger, two_thermistors};

fault_kinds! {
    ThermistorOpen = "thermistor-open", thermistor(|d, f| d.thermistor(f).circuit = Circuit::Open),
        "the wire is open: the pin is at the reference voltage and reads cold";
    ThermistorShort = "thermistor-short", thermistor(|d, f| d.thermistor(f).circuit = Circuit::Short),
        "the thermistor is shorted: the pin is at ground and reads hot";
    ThermistorDrift = "thermistor-drift", thermistor(|d, f| d.thermistor(f).offset_k += f.value).value("K", -60.0, 60.0),
        "the reading drifts upwards (or downwards) by 1 K/s until the offset reaches the value";
    ThermistorOffset = "thermistor-offset", thermistor(|d, f| d.thermistor(f).offset_k += f.value).value("K", -60.0, 60.0),
        "the reading is off by the value at once";
    ThermistorDetached = "thermistor-detached", thermistor(|d, f| d.thermistor(f).resistance_factor *= f.value).factor(20.0),
        "the thermistor hangs by its leads: its lag, the room's share in its temperature (at most to 1) and its self-heating grow by this factor";
    ThermistorStuck = "thermistor-stuck", thermistor(|d, f| d.frozen[f.sensor as usize] = true),
        "the converter repeats its last code of this channel; the pin, and so the comparator, is sound";
    SensorsSwapped = "sensors-swapped",
        two_thermistors(|d, f| d.plant.sensors.connected.swap(f.sensor as usize, f.with as usize)),
        "`sensor` and `with` are plugged into each other's place";
    ReferenceOff = "reference-off",
        plant(|d, _| d.plant.sensors.thermistors.iter_mut().for_each(|one| one.circuit = Circuit::Short)).shared(),
        "the dividers have no supply: all five thermistors read as shorted";
    AdcStuck = "adc-stuck", plant(|d, _| d.frozen = [true; Channel::ALL.len()]).shared(),
        "every channel but the heat-flux sensor's repeats its last code";
    SkinOnPlate = "skin-on-plate", plant(|d, _| d.plant.sensors.skin_on_plate = true),
        "the skin thermistor sits on the plate instead of on the finger, and follows the plate";

    ForceOpen = "force-open", plant(|d, _| d.plant.sensors.force.open = true),
        "the force sensor's pin is at ground";
    ForceStuck = "force-stuck", plant(|d, _| d.plant.sensors.force.stuck = true),
        "the force signal stands still; the converter's noise remains";
    ForceOffset = "force-offset", plant(|d, f| d.plant.sensors.force.offset_n += f.value).value("N", -10.0, 10.0),
        "the force reads too high by the value";

    FluxOpen = "flux-open", flux_sensor(|d, _| d.plant.flux.circuit = FluxCircuit::Open),
        "a wire of the [heat-flux sensor](flux.md) is broken: it reads the upper rail";
    FluxShort = "flux-short", flux_sensor(|d, _| d.plant.flux.circuit = FluxCircuit::Short),
        "its wires are shorted: it reads no flux";
    FluxStuck = "flux-stuck", flux_sensor(|d, _| d.plant.flux.stuck = true),
        "its converter repeats its last code";
    FluxReversed = "flux-reversed", flux_sensor(|d, _| d.plant.flux.circuit = FluxCircuit::Reversed),
        "its wires are swapped";
    FluxGain = "flux-gain", flux_sensor(|d, f| d.plant.flux.gain *= f.value).value("1", 0.0, 10.0),
        "factor on its gain";
    FluxZero = "flux-zero", flux_sensor(|d, f| d.plant.flux.zero_w_m2 += f.value).value("W/m²", -5000.0, 5000.0),
        "it reads too much by the value";
    FluxNoise = "flux-noise", flux_sensor(|d, f| d.plant.flux.noise *= f.value).factor(50.0),
        "factor on its noise";

    BridgeStuckHigh = "bridge-stuck-high", plant(|d, _| d.plant.bridge.a = LegDefect::High),
        "leg A stays at the supply, so that cooling pulses never end; the enable line still turns both legs off";
    BridgeBStuckHigh = "bridge-b-stuck-high", plant(|d, _| d.plant.bridge.b = LegDefect::High),
        "leg B stays at the supply; the enable line still turns both legs off";
    BridgeStuckLow = "bridge-stuck-low", plant(|d, _| d.plant.bridge.a = LegDefect::Low),
        "leg A stays at ground, so that nothing cools; the enable line still turns both legs off";
    LegOpen = "leg-open", plant(|d, _| d.plant.bridge.a = LegDefect::Open),
        "leg A is high-impedance: no current flows";
    BridgeShorted = "bridge-shorted", plant(|d, _| d.plant.bridge.a = LegDefect::Shorted),
        "output A is shorted to ground: the driver trips in the pulses that cool, and pulls nFAULT low";
    BridgeEnableStuck = "bridge-enable-stuck", plant(|d, _| d.plant.bridge.enable_stuck = true),
        "the driver stays enabled and follows its PWM inputs; latent";
    PolaritySwapped = "polarity-swapped", plant(|d, _| d.plant.bridge.swapped = true),
        "the module's wires are swapped";
    ModuleWeak = "module-weak", plant(|d, f| d.plant.module.seebeck = f.value).value("1", 0.0, 1.0),
        "the part of its Seebeck effect that the module keeps";
    FaultPinDead = "fault-pin-dead", plant(|d, _| d.plant.bridge.fault_pin_dead = true),
        "nFAULT never goes low; latent until the comparator is tested";
    MirrorStuck = "mirror-stuck", plant(|d, f| d.plant.sensors.mirror_stuck_a = Some(f.value)).value("A", 0.0, 10.0),
        "the current mirror always reads this value";

    ComparatorDead = "comparator-dead", plant(|d, _| d.plant.comparator.latch = LatchDefect::StuckClear),
        "the comparator never cuts the supply; latent until it is tested";
    ComparatorStuck = "comparator-stuck", plant(|d, _| d.plant.comparator.latch = LatchDefect::StuckSet),
        "the comparator has cut the supply and keeps it cut";
    WindowDead = "window-dead",
        plant(|d, _| (d.plant.comparator.hot_dead, d.plant.comparator.cold_dead) = (true, true)),
        "both sides of the comparator's window never trip; latent until they are tested";
    WindowHotDead = "window-hot-dead", plant(|d, _| d.plant.comparator.hot_dead = true),
        "the hot side never trips; latent until it is tested";
    WindowColdDead = "window-cold-dead", plant(|d, _| d.plant.comparator.cold_dead = true),
        "the cold side never trips; latent until it is tested";
    LatchStuckSet = "latch-stuck-set", plant(|d, _| d.plant.comparator.latch = LatchDefect::StuckSet),
        "the comparator's latch is set and stays so: the same as `comparator-stuck`";
    LatchStuckClear = "latch-stuck-clear", plant(|d, _| d.plant.comparator.latch = LatchDefect::StuckClear),
        "the comparator's latch is never set: the same as `comparator-dead`";
    SideStuck = "side-stuck",
        plant(|d, f| d.plant.comparator.side_stuck = Some(f.value >= 0.5)).value("level", 0.0, 1.0).shared(),
        "the line that selects the side of the comparator's tests stays low (0) or high (1), so that one side would be tested \
         twice and the other never; latent until the next self-test; one line for all fingers";
    LadderShift = "ladder-shift", plant(|d, f| d.plant.comparator.ladder_shift_k += f.value).value("K", -30.0, 30.0),
        "both thresholds of the comparator are too high by this value; its tests show more than 3 K too high or 5 K too low";

    SwitchShorted = "switch-shorted", plant(|d, _| d.plant.supply.switch = SwitchDefect::Shorted),
        "the switch of the bridge supply never opens; latent until the comparator is tested";
    SwitchOpen = "switch-open", plant(|d, _| d.plant.supply.switch = SwitchDefect::Open),
        "the switch of the bridge supply is open";
    EmergencyStop = "emergency-stop", plant(|d, _| d.plant.supply.emergency_stop = true).shared(),
        "the emergency stop is pressed: it disconnects the bridge supply, and the device sees it";
    SupplySenseOpen = "supply-sense-open", plant(|d, _| d.plant.supply.sense_open = true),
        "the wire of the sensed bridge supply is open; it reads 0 V";
    // The range of this class of drivers is 4.5 to 38 V.
    SupplyLow = "supply-low", plant(|d, f| d.plant.bridge.supply_v = Some(f.value)).value("V", 4.5, 12.0),
        "the bridge supply drops to the value";
    SupplyHigh = "supply-high", plant(|d, f| d.plant.bridge.supply_v = Some(f.value)).value("V", 12.0, 38.0),
        "the bridge supply rises to the value";
    SupplyResistance = "supply-resistance", plant(|d, f| d.plant.supply.contact_ohm += f.value).value("Ω", 0.0, 1.0),
        "a loose contact in the wires of the bridge supply has this resistance, so that the voltage falls with the current";

    FanOff = "fan-off", plant(|d, f| d.plant.cooling.resistance_factor *= f.value).factor(10.0),
        "factor on the thermal resistance between the sink and its coolant";
    ChillerOff = "chiller-off", plant(|d, f| d.plant.cooling.coolant_c = Some(f.value)).value("°C", 5.0, 60.0),
        "temperature of the coolant";
    SinkHot = "sink-hot", plant(|d, f| d.plant.cooling.held_c = Some(f.value)).value("°C", 0.0, 90.0),
        "an external heat source holds the sink at the value";

    HostGarbage = "host-garbage", host().once(),
        "the host sends bytes that are no valid lines, once";
    HostSilent = "host-silent", host(),
        "the host sends nothing";
    HostFlood = "host-flood", host(),
        "the host sends `state` as often as the line carries it";
    HostPlays = "host-plays", host(),
        "the host uploads courses and plays them without pause, a line every 2 ms: in turn one that begins at 42 °C and one at 15 °C";
    TriggerStuck = "trigger-stuck", trigger().value("level", 0.0, 1.0),
        "the trigger input stays low (below 0.5), or high, which is a rising edge when it comes";
    TriggerChatter = "trigger-chatter", trigger().value("Hz", 1.0, 200e3),
        "the trigger input has rising edges at this rate";
}

impl FaultKind {
    /// The value of the kind, if it has one.
    pub const fn value(self) -> Option<ValueRange> {
        self.row().value
    }

    /// Whether it affects one thermistor, which the scene may name.
    pub const fn has_sensor(self) -> bool {
        matches!(self.row().part, Part::Thermistor | Part::TwoThermistors)
    }

    /// Whether it affects the heat-flux sensor, which the scene must have.
    pub const fn needs_flux_sensor(self) -> bool {
        matches!(self.row().part, Part::FluxSensor)
    }

    /// Whether it exchanges two thermistors, of which the scene must name the second.
    pub const fn needs_second_sensor(self) -> bool {
        matches!(self.row().part, Part::TwoThermistors)
    }

    /// Whether it has a duration, so that the scene may give its end.
    pub const fn has_duration(self) -> bool {
        !self.row().once
    }

    /// Whether the simulated host has it, which another program may replace.
    pub const fn is_of_host(self) -> bool {
        matches!(self.row().part, Part::Host)
    }

    /// Whether it is of what the fingers of a device for five share.
    pub const fn is_shared(self) -> bool {
        self.row().shared
    }
}
