//! The kinds of faults, and what a scene says of each.

/// What can break.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// A thermistor's wire is open: its pin is at the reference and reads cold.
    ThermistorOpen,
    /// A thermistor is shorted: its pin is at ground and reads hot.
    ThermistorShort,
    /// A thermistor reads more and more too much, by [`DRIFT_K_S`](super::DRIFT_K_S) up to the value.
    ThermistorDrift,
    /// A thermistor reads too much by the value at once.
    ThermistorOffset,
    /// A thermistor hangs by its leads: the value is by how much it lags more, sees more of the room and warms itself
    /// more.
    ThermistorDetached,
    /// The converter repeats its last code of a thermistor's channel. The pin is sound, so the comparator is too.
    ThermistorStuck,
    /// Two thermistors are plugged in where the other one should be.
    SensorsSwapped,
    /// Nothing feeds the thermistors' dividers: all five read as shorted.
    ReferenceOff,
    /// Every channel repeats its last code.
    AdcStuck,
    /// The force sensor's wire is open: its pin is at ground.
    ForceOpen,
    /// The force sensor no longer moves; the converter's noise stays.
    ForceStuck,
    /// The force sensor reads too much by the value.
    ForceOffset,
    /// Leg a of the bridge stays at the supply; the enable line still takes both legs off.
    BridgeStuckHigh,
    /// Leg b stays at the supply; the enable line still takes both legs off.
    BridgeBStuckHigh,
    /// Leg a stays at ground, so what should cool heats; the enable line still takes both legs off.
    BridgeStuckLow,
    /// Leg a is high-impedance.
    LegOpen,
    /// Output a is shorted to ground: the driver trips when it is driven high.
    BridgeShorted,
    /// The driver stays enabled: it drives whatever its PWM says. Latent, as PWM ends with enable.
    BridgeEnableStuck,
    /// The module's wires are swapped.
    PolaritySwapped,
    /// The module keeps the value's share of its Seebeck effect: legs that have aged, or that solder bridges.
    ModuleWeak,
    /// nFAULT never goes low. Latent; the comparator's test shows it.
    FaultPinDead,
    /// The current mirror always reads the value.
    MirrorStuck,
    /// The comparator never cuts the supply. Latent; its test shows it.
    ComparatorDead,
    /// The comparator has cut the supply and stays so.
    ComparatorStuck,
    /// The bridge supply falls to the value.
    SupplyLow,
    /// The bridge supply rises to the value.
    SupplyHigh,
    /// The sink gives less heat to what cools it, by a factor.
    FanOff,
    /// What cools the sink has the value for its temperature.
    ChillerOff,
    /// Something strong holds the sink at the value.
    SinkHot,
    /// The host sends bytes that are no line, once.
    HostGarbage,
    /// The host sends nothing.
    HostSilent,
    /// The host sends as many lines as fit.
    HostFlood,
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
    /// All of them.
    pub const ALL: [Self; 32] = [
        Self::ThermistorOpen,
        Self::ThermistorShort,
        Self::ThermistorDrift,
        Self::ThermistorOffset,
        Self::ThermistorDetached,
        Self::ThermistorStuck,
        Self::SensorsSwapped,
        Self::ReferenceOff,
        Self::AdcStuck,
        Self::ForceOpen,
        Self::ForceStuck,
        Self::ForceOffset,
        Self::BridgeStuckHigh,
        Self::BridgeBStuckHigh,
        Self::BridgeStuckLow,
        Self::LegOpen,
        Self::BridgeShorted,
        Self::BridgeEnableStuck,
        Self::PolaritySwapped,
        Self::ModuleWeak,
        Self::FaultPinDead,
        Self::MirrorStuck,
        Self::ComparatorDead,
        Self::ComparatorStuck,
        Self::SupplyLow,
        Self::SupplyHigh,
        Self::FanOff,
        Self::ChillerOff,
        Self::SinkHot,
        Self::HostGarbage,
        Self::HostSilent,
        Self::HostFlood,
    ];

    /// Its name in a scene.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ThermistorOpen => "thermistor-open",
            Self::ThermistorShort => "thermistor-short",
            Self::ThermistorDrift => "thermistor-drift",
            Self::ThermistorOffset => "thermistor-offset",
            Self::ThermistorDetached => "thermistor-detached",
            Self::ThermistorStuck => "thermistor-stuck",
            Self::SensorsSwapped => "sensors-swapped",
            Self::ReferenceOff => "reference-off",
            Self::AdcStuck => "adc-stuck",
            Self::ForceOpen => "force-open",
            Self::ForceStuck => "force-stuck",
            Self::ForceOffset => "force-offset",
            Self::BridgeStuckHigh => "bridge-stuck-high",
            Self::BridgeBStuckHigh => "bridge-b-stuck-high",
            Self::BridgeStuckLow => "bridge-stuck-low",
            Self::LegOpen => "leg-open",
            Self::BridgeShorted => "bridge-shorted",
            Self::BridgeEnableStuck => "bridge-enable-stuck",
            Self::PolaritySwapped => "polarity-swapped",
            Self::ModuleWeak => "module-weak",
            Self::FaultPinDead => "fault-pin-dead",
            Self::MirrorStuck => "mirror-stuck",
            Self::ComparatorDead => "comparator-dead",
            Self::ComparatorStuck => "comparator-stuck",
            Self::SupplyLow => "supply-low",
            Self::SupplyHigh => "supply-high",
            Self::FanOff => "fan-off",
            Self::ChillerOff => "chiller-off",
            Self::SinkHot => "sink-hot",
            Self::HostGarbage => "host-garbage",
            Self::HostSilent => "host-silent",
            Self::HostFlood => "host-flood",
        }
    }

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
