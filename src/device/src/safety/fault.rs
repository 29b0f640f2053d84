//! The faults that switch the bridge off.

use crate::sense::SensorFault;

/// Declares [`Fault`] with the words of the protocol.
macro_rules! faults {
    ($($(#[$doc:meta])+ $fault:ident = $word:literal,)+) => {
        /// A fault that switches the bridge off.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Fault { $($(#[$doc])+ $fault,)+ }

        impl Fault {
            /// All faults; a fault's place is its number in a record.
            pub const ALL: &'static [Self] = &[$(Self::$fault,)+];

            /// The fault's word in the protocol.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$fault => $word,)+ }
            }
        }
    };
}

faults! {
    /// Display thermistor open: no current flows.
    DisplayOpen = "display-open",
    /// Display thermistor shorted: no voltage drops.
    DisplayShort = "display-short",
    /// Second display thermistor open.
    CheckOpen = "check-open",
    /// Second display thermistor shorted.
    CheckShort = "check-short",
    /// Sink thermistor open.
    SinkOpen = "sink-open",
    /// Sink thermistor shorted.
    SinkShort = "sink-short",
    /// Skin thermistor open.
    SkinOpen = "skin-open",
    /// Skin thermistor shorted.
    SkinShort = "skin-short",
    /// Room thermistor open.
    RoomOpen = "room-open",
    /// Room thermistor shorted.
    RoomShort = "room-short",
    /// All thermistors read shorted at once: their supply has failed.
    Excitation = "excitation",
    /// The display reading changes faster than a display can.
    DisplayJump = "display-jump",
    /// The second display reading changes faster than a display can.
    CheckJump = "check-jump",
    /// The sink reading changes faster than a sink can.
    SinkJump = "sink-jump",
    /// Samples of the display thermistor repeat.
    DisplayFrozen = "display-frozen",
    /// Samples of the second display thermistor repeat.
    CheckFrozen = "check-frozen",
    /// Samples of the sink thermistor repeat.
    SinkFrozen = "sink-frozen",
    /// Samples of the skin thermistor repeat.
    SkinFrozen = "skin-frozen",
    /// Samples of the room thermistor repeat.
    RoomFrozen = "room-frozen",
    /// Samples of the force sensor repeat.
    ForceFrozen = "force-frozen",
    /// Samples of all channels repeat: the converter has stopped.
    SamplesFrozen = "samples-frozen",
    /// The two display thermistors disagree.
    DisplaysApart = "displays-apart",
    /// The room reads warmer than the skin: their thermistors are swapped, or one is misplaced.
    RoomAboveSkin = "room-above-skin",
    /// The force signal is below its live zero or at the end of its range.
    ForceSensor = "force-sensor",
    /// A display thermistor reads above its limit.
    DisplayHot = "display-hot",
    /// A display thermistor reads below its limit.
    DisplayCold = "display-cold",
    /// The sink reads above its limit.
    SinkHot = "sink-hot",
    /// The display moves against the current quickly: the polarity is wrong, or a thermistor is misplaced.
    Polarity = "polarity",
    /// The display moves against the current slowly: the current warms the sink more than it cools the display.
    Runaway = "runaway",
    /// The display does not follow its internal model: the module or its thermal contact has changed, or heat enters that
    /// no sensor measures.
    UnlikeModel = "unlike-model",
    /// The measured current exceeds the largest that is ever demanded.
    OverCurrent = "over-current",
    /// More current flows than is demanded.
    CurrentHigh = "current-high",
    /// Less current flows than is demanded: a leg, a wire or the supply has failed.
    CurrentLow = "current-low",
    /// The bridge driver reports a fault, or the comparator has cut the supply.
    Bridge = "bridge",
    /// The thermal dose has reached its limit.
    Dose = "dose",
    /// A host that has asked for telemetry is silent.
    HostSilent = "host-silent",
    /// Self-test: the comparator does not cut the supply, or does not release it.
    Comparator = "comparator",
    /// Self-test: the display does not respond to current.
    NoResponse = "no-response",
    /// Samples were lost: a tick took too long, or the samples could not be stored.
    Sampling = "sampling",
    /// The stack has grown into its guard.
    Stack = "stack",
    /// The program has panicked; found after the reset that ends a panic.
    Panic = "panic",
    /// The processor met an instruction that it cannot execute, or an interrupt without a handler.
    HardFault = "hard-fault",
    /// The external clock has failed, or was missing at the start.
    Clock = "clock",
    /// The control tick did not run; the window watchdog has reset the device.
    TickLost = "tick-lost",
    /// A task did not check in; the independent watchdog has reset the device.
    Watchdog = "watchdog",
    /// The program has reset the device without an order to do so.
    UnaskedReset = "unasked-reset",
    /// The stored settings cannot be read; the device uses those of its class.
    SettingsCorrupt = "settings-corrupt",
}

/// Names one of the five thermistors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThermistorId {
    /// Thermistor in the display surface, used for control.
    Display,
    /// Second thermistor of the display surface.
    Check,
    /// Thermistor on the sink.
    Sink,
    /// Thermistor on the skin, at the edge of the contact.
    Skin,
    /// Thermistor in the room air.
    Room,
}

impl Fault {
    /// The fault of a thermistor that is open or shorted.
    #[must_use]
    pub const fn of_thermistor(thermistor: ThermistorId, fault: SensorFault) -> Self {
        match (thermistor, fault) {
            (ThermistorId::Display, SensorFault::Open) => Self::DisplayOpen,
            (ThermistorId::Display, SensorFault::Short) => Self::DisplayShort,
            (ThermistorId::Check, SensorFault::Open) => Self::CheckOpen,
            (ThermistorId::Check, SensorFault::Short) => Self::CheckShort,
            (ThermistorId::Sink, SensorFault::Open) => Self::SinkOpen,
            (ThermistorId::Sink, SensorFault::Short) => Self::SinkShort,
            (ThermistorId::Skin, SensorFault::Open) => Self::SkinOpen,
            (ThermistorId::Skin, SensorFault::Short) => Self::SkinShort,
            (ThermistorId::Room, SensorFault::Open) => Self::RoomOpen,
            (ThermistorId::Room, SensorFault::Short) => Self::RoomShort,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Fault;

    #[test]
    fn every_fault_has_its_own_number_and_word() {
        for (number, fault) in Fault::ALL.iter().enumerate() {
            assert_eq!(*fault as usize, number);
            let same = Fault::ALL
                .iter()
                .filter(|other| other.name() == fault.name());
            assert_eq!(same.count(), 1, "{}", fault.name());
        }
    }
}
