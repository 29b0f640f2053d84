//! The kinds of faults, and what a scene says of each.

named_enum! {
    /// What can break.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum FaultKind {
        /// A thermistor's wire is open: its pin is at the reference and reads cold.
        ThermistorOpen = "thermistor-open",
        /// A thermistor is shorted: its pin is at ground and reads hot.
        ThermistorShort = "thermistor-short",
        /// A thermistor reads more and more too much, by [`DRIFT_K_S`](super::DRIFT_K_S) up to the value.
        ThermistorDrift = "thermistor-drift",
        /// A thermistor reads too much by the value at once.
        ThermistorOffset = "thermistor-offset",
        /// A thermistor hangs by its leads: the value is by how much it lags more, sees more of the room and warms itself
        /// more.
        ThermistorDetached = "thermistor-detached",
        /// The converter repeats its last code of a thermistor's channel. The pin is sound, so the comparator is too.
        ThermistorStuck = "thermistor-stuck",
        /// Two thermistors are plugged in where the other one should be.
        SensorsSwapped = "sensors-swapped",
        /// Nothing feeds the thermistors' dividers: all five read as shorted.
        ReferenceOff = "reference-off",
        /// Every channel repeats its last code.
        AdcStuck = "adc-stuck",
        /// The force sensor's wire is open: its pin is at ground.
        ForceOpen = "force-open",
        /// The force sensor no longer moves; the converter's noise stays.
        ForceStuck = "force-stuck",
        /// The force sensor reads too much by the value.
        ForceOffset = "force-offset",
        /// Leg a of the bridge stays at the supply; the enable line still takes both legs off.
        BridgeStuckHigh = "bridge-stuck-high",
        /// Leg b stays at the supply; the enable line still takes both legs off.
        BridgeBStuckHigh = "bridge-b-stuck-high",
        /// Leg a stays at ground, so what should cool heats; the enable line still takes both legs off.
        BridgeStuckLow = "bridge-stuck-low",
        /// Leg a is high-impedance.
        LegOpen = "leg-open",
        /// Output a is shorted to ground: the driver trips when it is driven high.
        BridgeShorted = "bridge-shorted",
        /// The driver stays enabled: it drives whatever its PWM says. Latent, as PWM ends with enable.
        BridgeEnableStuck = "bridge-enable-stuck",
        /// The module's wires are swapped.
        PolaritySwapped = "polarity-swapped",
        /// The module keeps the value's share of its Seebeck effect: legs that have aged, or that solder bridges.
        ModuleWeak = "module-weak",
        /// nFAULT never goes low. Latent; the comparator's test shows it.
        FaultPinDead = "fault-pin-dead",
        /// The current mirror always reads the value.
        MirrorStuck = "mirror-stuck",
        /// The comparator never cuts the supply. Latent; its test shows it.
        ComparatorDead = "comparator-dead",
        /// The comparator has cut the supply and stays so.
        ComparatorStuck = "comparator-stuck",
        /// The bridge supply falls to the value.
        SupplyLow = "supply-low",
        /// The bridge supply rises to the value.
        SupplyHigh = "supply-high",
        /// The sink gives less heat to what cools it, by a factor.
        FanOff = "fan-off",
        /// What cools the sink has the value for its temperature.
        ChillerOff = "chiller-off",
        /// Something strong holds the sink at the value.
        SinkHot = "sink-hot",
        /// The host sends bytes that are no line, once.
        HostGarbage = "host-garbage",
        /// The host sends nothing.
        HostSilent = "host-silent",
        /// The host sends as many lines as fit.
        HostFlood = "host-flood",
    }
}

/// The number that a kind takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// Its unit; 1 is a pure number.
    pub unit: &'static str,
    /// Least that is allowed.
    pub min: f64,
    /// Most that is allowed.
    pub max: f64,
    /// What a scene means that gives none; it must give one if this is none.
    pub default: Option<f64>,
}

/// A value that a scene must give.
const fn given(unit: &'static str, min: f64, max: f64) -> Option<Value> {
    Some(Value {
        unit,
        min,
        max,
        default: None,
    })
}

/// A pure factor of 1 to 1000.
const fn factor(default: f64) -> Option<Value> {
    Some(Value {
        unit: "1",
        min: 1.0,
        max: 1000.0,
        default: Some(default),
    })
}

impl FaultKind {
    /// The value that it takes, if any. Supplies are those that the class of driver works on, 4.5 to 38 V.
    #[must_use]
    pub const fn value(self) -> Option<Value> {
        match self {
            Self::ThermistorDrift | Self::ThermistorOffset => given("K", -60.0, 60.0),
            Self::ThermistorDetached => factor(20.0),
            Self::ModuleWeak => given("1", 0.0, 1.0),
            Self::ForceOffset => given("N", -10.0, 10.0),
            Self::MirrorStuck => given("A", 0.0, 10.0),
            Self::SupplyLow => given("V", 4.5, 12.0),
            Self::SupplyHigh => given("V", 12.0, 38.0),
            Self::FanOff => factor(10.0),
            Self::ChillerOff => given("°C", 5.0, 60.0),
            Self::SinkHot => given("°C", 0.0, 90.0),
            _ => None,
        }
    }

    /// It breaks one thermistor, which a scene may name.
    #[must_use]
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

    /// It confuses two thermistors, of which a scene must name the second.
    #[must_use]
    pub const fn needs_second_sensor(self) -> bool {
        matches!(self, Self::SensorsSwapped)
    }

    /// It lasts, so that it can pass.
    #[must_use]
    pub const fn has_duration(self) -> bool {
        !matches!(self, Self::HostGarbage)
    }
}
