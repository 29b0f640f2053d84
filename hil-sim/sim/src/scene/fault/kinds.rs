//! Kinds of faults and the keys that a scene may give for each.

named_enum! {
    /// Kind of a fault of plant, converter or host.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum FaultKind {
        /// A thermistor's wire is open: its pin is at the reference and reads cold.
        ThermistorOpen = "thermistor-open",
        /// A thermistor is shorted: its pin is at ground and reads hot.
        ThermistorShort = "thermistor-short",
        /// The reading of a thermistor drifts by [`DRIFT_K_S`](super::DRIFT_K_S) up to the value.
        ThermistorDrift = "thermistor-drift",
        /// The reading of a thermistor is too high by the value, at once.
        ThermistorOffset = "thermistor-offset",
        /// A thermistor hangs by its leads: its lag, its coupling to the room and its self-heating grow by the value.
        ThermistorDetached = "thermistor-detached",
        /// The converter repeats its last code of a thermistor's channel. The pin itself is unaffected, and so is the comparator.
        ThermistorStuck = "thermistor-stuck",
        /// Two thermistors are exchanged.
        SensorsSwapped = "sensors-swapped",
        /// The dividers of the thermistors have no supply: all five read as shorted.
        ReferenceOff = "reference-off",
        /// Every channel repeats its last code.
        AdcStuck = "adc-stuck",
        /// The skin thermistor sits on the display's plate instead of on the finger, and follows the plate.
        SkinOnPlate = "skin-on-plate",
        /// The force sensor's wire is open: its pin is at ground.
        ForceOpen = "force-open",
        /// The force sensor no longer moves; the converter's noise stays.
        ForceStuck = "force-stuck",
        /// The reading of the force sensor is too high by the value.
        ForceOffset = "force-offset",
        /// A wire of the heat-flux sensor is broken: its converter reads the upper rail.
        FluxOpen = "flux-open",
        /// The wires of the heat-flux sensor are shorted: it reads no flux.
        FluxShort = "flux-short",
        /// The converter of the heat-flux sensor repeats its last code.
        FluxStuck = "flux-stuck",
        /// The wires of the heat-flux sensor are swapped.
        FluxReversed = "flux-reversed",
        /// The gain of the heat-flux sensor changes by the factor.
        FluxGain = "flux-gain",
        /// The heat-flux sensor reads too much by the value.
        FluxZero = "flux-zero",
        /// The noise of the heat-flux sensor grows by the factor.
        FluxNoise = "flux-noise",
        /// Leg a of the bridge stays at the supply; the enable line still takes both legs off.
        BridgeStuckHigh = "bridge-stuck-high",
        /// Leg b stays at the supply; the enable line still takes both legs off.
        BridgeBStuckHigh = "bridge-b-stuck-high",
        /// Leg a stays at ground, so nothing cools; the enable line still takes both legs off.
        BridgeStuckLow = "bridge-stuck-low",
        /// Leg a is high-impedance.
        LegOpen = "leg-open",
        /// Output a is shorted to ground: the driver trips when it is driven high, in the pulses that cool.
        BridgeShorted = "bridge-shorted",
        /// The driver stays enabled and follows its PWM inputs. Latent, as PWM ends with enable.
        BridgeEnableStuck = "bridge-enable-stuck",
        /// The module's wires are swapped.
        PolaritySwapped = "polarity-swapped",
        /// The Seebeck coefficient of the module falls to the value times the nominal one: legs aged or bridged by solder.
        ModuleWeak = "module-weak",
        /// nFAULT never goes low. Latent; the comparator's tests show it.
        FaultPinDead = "fault-pin-dead",
        /// The current mirror always reads the value.
        MirrorStuck = "mirror-stuck",
        /// The comparator never cuts the supply. Latent; its test shows it.
        ComparatorDead = "comparator-dead",
        /// The comparator has cut the supply and stays so.
        ComparatorStuck = "comparator-stuck",
        /// Both sides of the comparator's window never trip. Latent; the comparator's tests show it.
        WindowDead = "window-dead",
        /// The hot side of the comparator's window never trips. Latent; its test shows it.
        WindowHotDead = "window-hot-dead",
        /// The cold side of the comparator's window never trips. Latent; its test shows it.
        WindowColdDead = "window-cold-dead",
        /// The comparator's latch is set and stays so: the same as `comparator-stuck`.
        LatchStuckSet = "latch-stuck-set",
        /// The comparator's latch is never set: the same as `comparator-dead`.
        LatchStuckClear = "latch-stuck-clear",
        /// The line that selects the side of the comparator's tests is stuck, low below 0.5 and high from there on: one side
        /// is tested twice and the other never. Latent; the next self-test reads the line back. One line for all fingers.
        SideStuck = "side-stuck",
        /// Both thresholds of the comparator are too high by the value. Latent; its tests show what is more than 3 K too high
        /// or 5 K too low.
        LadderShift = "ladder-shift",
        /// The switch of the bridge supply never opens. Latent; the comparator's tests show it by the sensed supply.
        SwitchShorted = "switch-shorted",
        /// The switch of the bridge supply is open.
        SwitchOpen = "switch-open",
        /// The emergency stop is pressed: it disconnects the bridge supply, and the device sees it.
        EmergencyStop = "emergency-stop",
        /// The wire of the sensed bridge supply is open: its pin is at ground.
        SupplySenseOpen = "supply-sense-open",
        /// The bridge supply falls to the value.
        SupplyLow = "supply-low",
        /// The bridge supply rises to the value.
        SupplyHigh = "supply-high",
        /// The thermal resistance between sink and coolant rises by the factor.
        FanOff = "fan-off",
        /// The coolant of the sink has the temperature of the value.
        ChillerOff = "chiller-off",
        /// The sink is held at the value.
        SinkHot = "sink-hot",
        /// The host sends invalid bytes once.
        HostGarbage = "host-garbage",
        /// The host sends nothing.
        HostSilent = "host-silent",
        /// The host sends as many lines as the serial line carries.
        HostFlood = "host-flood",
        /// The host uploads courses and plays them without pause: in turn one that begins at 42 °C and one at 15 °C.
        HostPlays = "host-plays",
        /// The trigger input stays low below 0.5 and high from there on, which is a rising edge when it comes.
        TriggerStuck = "trigger-stuck",
        /// The trigger input has rising edges at a rate.
        TriggerChatter = "trigger-chatter",
    }
}

/// Unit, range and default of a kind's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// Unit; 1 for a pure number.
    pub unit: &'static str,
    /// Smallest allowed value.
    pub min: f64,
    /// Largest allowed value.
    pub max: f64,
    /// Default; without one, the scene must give a value.
    pub default: Option<f64>,
}

/// A value that the scene must give.
const fn required(unit: &'static str, min: f64, max: f64) -> Option<ValueRange> {
    Some(ValueRange { unit, min, max, default: None })
}

/// A factor from 1 to 1000 with a default.
const fn factor(default: f64) -> Option<ValueRange> {
    Some(ValueRange { unit: "1", min: 1.0, max: 1000.0, default: Some(default) })
}

impl FaultKind {
    /// The value of the kind, if it has one. The supply range is that of this class of drivers, 4.5 to 38 V.
    pub const fn value(self) -> Option<ValueRange> {
        match self {
            Self::ThermistorDrift | Self::ThermistorOffset => required("K", -60.0, 60.0),
            Self::ThermistorDetached => factor(20.0),
            Self::ModuleWeak => required("1", 0.0, 1.0),
            Self::ForceOffset => required("N", -10.0, 10.0),
            Self::FluxGain => required("1", 0.0, 10.0),
            Self::FluxZero => required("W/m²", -5000.0, 5000.0),
            Self::FluxNoise => factor(50.0),
            Self::MirrorStuck => required("A", 0.0, 10.0),
            Self::SideStuck => required("level", 0.0, 1.0),
            Self::LadderShift => required("K", -30.0, 30.0),
            Self::SupplyLow => required("V", 4.5, 12.0),
            Self::SupplyHigh => required("V", 12.0, 38.0),
            Self::FanOff => factor(10.0),
            Self::ChillerOff => required("°C", 5.0, 60.0),
            Self::SinkHot => required("°C", 0.0, 90.0),
            Self::TriggerStuck => required("level", 0.0, 1.0),
            Self::TriggerChatter => required("Hz", 1.0, 200e3),
            _ => None,
        }
    }

    /// Whether it affects one thermistor, which the scene may name.
    pub const fn has_sensor(self) -> bool {
        matches!(
            self,
            Self::ThermistorOpen
                | Self::ThermistorShort
                | Self::ThermistorDrift
                | Self::ThermistorOffset
                | Self::ThermistorDetached
                | Self::ThermistorStuck
                | Self::SensorsSwapped
        )
    }

    /// Whether it affects the heat-flux sensor, which the scene must have.
    pub const fn needs_flux_sensor(self) -> bool {
        matches!(
            self,
            Self::FluxOpen
                | Self::FluxShort
                | Self::FluxStuck
                | Self::FluxReversed
                | Self::FluxGain
                | Self::FluxZero
                | Self::FluxNoise
        )
    }

    /// Whether it exchanges two thermistors, of which the scene must name the second.
    pub const fn needs_second_sensor(self) -> bool {
        matches!(self, Self::SensorsSwapped)
    }

    /// Whether it has a duration, so that the scene may give its end.
    pub const fn has_duration(self) -> bool {
        !matches!(self, Self::HostGarbage)
    }
}
