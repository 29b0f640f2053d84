//! What can be wrong, by name.

use crate::sense::SensorFault;

/// Declares [`Fault`] with the words of the protocol.
macro_rules! faults {
    ($($(#[$doc:meta])+ $fault:ident = $word:literal,)+) => {
        /// Why the bridge is off.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Fault { $($(#[$doc])+ $fault,)+ }

        impl Fault {
            /// All of them; the place of one is its number in a record.
            pub const ALL: &'static [Self] = &[$(Self::$fault,)+];

            /// The word for it in the protocol.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$fault => $word,)+ }
            }
        }
    };
}

faults! {
    /// Display thermistor: no current flows.
    DisplayOpen = "display-open",
    /// Display thermistor: no voltage drops.
    DisplayShort = "display-short",
    /// Second display thermistor.
    CheckOpen = "check-open",
    /// Second display thermistor.
    CheckShort = "check-short",
    /// Sink thermistor.
    SinkOpen = "sink-open",
    /// Sink thermistor.
    SinkShort = "sink-short",
    /// Skin thermistor.
    SkinOpen = "skin-open",
    /// Skin thermistor.
    SkinShort = "skin-short",
    /// Room thermistor.
    RoomOpen = "room-open",
    /// Room thermistor.
    RoomShort = "room-short",
    /// All thermistors are shorted at once: what feeds them is gone.
    Excitation = "excitation",
    /// The display's reading moves faster than a display can.
    DisplayJump = "display-jump",
    /// That of its second thermistor.
    CheckJump = "check-jump",
    /// That of the sink.
    SinkJump = "sink-jump",
    /// The display's samples repeat themselves.
    DisplayFrozen = "display-frozen",
    /// Those of its second thermistor.
    CheckFrozen = "check-frozen",
    /// Those of the sink.
    SinkFrozen = "sink-frozen",
    /// Those of the skin.
    SkinFrozen = "skin-frozen",
    /// Those of the room.
    RoomFrozen = "room-frozen",
    /// Those of the force sensor.
    ForceFrozen = "force-frozen",
    /// All do: the converter stands still.
    SamplesFrozen = "samples-frozen",
    /// The display's thermistors are apart.
    DisplaysApart = "displays-apart",
    /// The room is warmer than the skin: their thermistors are swapped, or one is not where it should be.
    RoomAboveSkin = "room-above-skin",
    /// Force sensor below its live zero or at the end of its range.
    ForceSensor = "force-sensor",
    /// A display thermistor above its limit.
    DisplayHot = "display-hot",
    /// A display thermistor below its limit.
    DisplayCold = "display-cold",
    /// Sink above its limit.
    SinkHot = "sink-hot",
    /// The display goes the wrong way, fast.
    Polarity = "polarity",
    /// The display goes the wrong way, slowly: current warms the sink more than it cools the display.
    Runaway = "runaway",
    /// The display does not do what the law's model of it says: the module or its contact with the plate is not what it was, or
    /// there is heat of which no sensor tells.
    UnlikeModel = "unlike-model",
    /// Measured current beyond what is ever asked for.
    OverCurrent = "over-current",
    /// More current than is asked for.
    CurrentHigh = "current-high",
    /// Less current than is asked for: a leg, a wire or the supply is gone.
    CurrentLow = "current-low",
    /// The bridge driver reports a fault, or the comparator has cut the supply.
    Bridge = "bridge",
    /// The skin has had its share of heat.
    Dose = "dose",
    /// The host is silent while telemetry streams.
    HostSilent = "host-silent",
    /// Self-test: the comparator does not cut the supply, or does not give it back.
    Comparator = "comparator",
    /// Self-test: the display does not answer to current.
    NoResponse = "no-response",
    /// Samples were lost: a tick took too long, or they could not be stored.
    Sampling = "sampling",
    /// The stack has grown into its guard.
    Stack = "stack",
    /// The program has panicked.
    Panic = "panic",
    /// The processor met something that it cannot execute, or an interrupt without a task.
    HardFault = "hard-fault",
    /// The board's clock has failed, or is missing since the start.
    Clock = "clock",
    /// The control tick did not come; the window watchdog has reset the device.
    TickLost = "tick-lost",
    /// A task did not check in; the independent watchdog has reset the device.
    Watchdog = "watchdog",
    /// The program was started anew by itself, and nobody had asked for that.
    UnaskedReset = "unasked-reset",
    /// The stored settings cannot be read; the device has those of its class.
    SettingsCorrupt = "settings-corrupt",
}

/// One of the five thermistors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Thermistor {
    /// Display surface.
    Display,
    /// Display surface, second.
    Check,
    /// Sink.
    Sink,
    /// Skin.
    Skin,
    /// Room.
    Room,
}

impl Fault {
    /// A thermistor that has no temperature.
    #[must_use]
    pub const fn of_sensor(which: Thermistor, fault: SensorFault) -> Self {
        match (which, fault) {
            (Thermistor::Display, SensorFault::Open) => Self::DisplayOpen,
            (Thermistor::Display, SensorFault::Short) => Self::DisplayShort,
            (Thermistor::Check, SensorFault::Open) => Self::CheckOpen,
            (Thermistor::Check, SensorFault::Short) => Self::CheckShort,
            (Thermistor::Sink, SensorFault::Open) => Self::SinkOpen,
            (Thermistor::Sink, SensorFault::Short) => Self::SinkShort,
            (Thermistor::Skin, SensorFault::Open) => Self::SkinOpen,
            (Thermistor::Skin, SensorFault::Short) => Self::SkinShort,
            (Thermistor::Room, SensorFault::Open) => Self::RoomOpen,
            (Thermistor::Room, SensorFault::Short) => Self::RoomShort,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Fault;

    #[test]
    fn a_number_belongs_to_one_fault_and_a_word_too() {
        for (number, fault) in Fault::ALL.iter().enumerate() {
            assert_eq!(*fault as usize, number);
            let same = Fault::ALL
                .iter()
                .filter(|other| other.name() == fault.name());
            assert_eq!(same.count(), 1, "{}", fault.name());
        }
    }
}
