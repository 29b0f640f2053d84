//! The faults that switch the bridge off.

use crate::sense::SensorFault;

/// Declares [`Fault`] with the words of the protocol.
macro_rules! faults {
    ($($(#[$doc:meta])+ $fault:ident = $word:literal,)+) => {
        /// Why a station trips: its bridge is switched off, and stays off until the host sends `clear`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Fault { $($(#[$doc])+ $fault,)+ }

        impl Fault {
            /// All faults. Their order may not change: a fault's index is the number by which it is stored through a
            /// reset.
            pub const ALL: &'static [Self] = &[$(Self::$fault,)+];

            /// The word by which lines to the host name the fault, such as `display-open`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$fault => $word,)+ }
            }
        }
    };
}

faults! {
    /// The first display thermistor, which the control uses, is open: thermistor or wire broken.
    DisplayOpen = "display-open",
    /// The first display thermistor, which the control uses, or its wires are shorted.
    DisplayShort = "display-short",
    /// The second display thermistor, which checks the first, is open: thermistor or wire broken.
    CheckOpen = "check-open",
    /// The second display thermistor, which checks the first, or its wires are shorted.
    CheckShort = "check-short",
    /// The sink's thermistor is open: thermistor or wire broken.
    SinkOpen = "sink-open",
    /// The sink's thermistor or its wires are shorted.
    SinkShort = "sink-short",
    /// The skin's thermistor is open: thermistor or wire broken.
    SkinOpen = "skin-open",
    /// The skin's thermistor or its wires are shorted.
    SkinShort = "skin-short",
    /// The room's thermistor is open: thermistor or wire broken.
    RoomOpen = "room-open",
    /// The room's thermistor or its wires are shorted.
    RoomShort = "room-short",
    /// All five thermistors read as shorted in one tick: their common supply has failed.
    Excitation = "excitation",
    /// The first display thermistor's reading has changed by more than 0.5 K in 4 ms, faster than a display can.
    DisplayJump = "display-jump",
    /// The second display thermistor's reading has changed by more than 0.5 K in 4 ms, faster than a display can.
    CheckJump = "check-jump",
    /// The sink's reading has changed by more than 0.5 K in 4 ms, faster than a sink can.
    SinkJump = "sink-jump",
    /// The sample of the first display thermistor has repeated unchanged, without noise, for 46 ticks.
    DisplayFrozen = "display-frozen",
    /// The sample of the second display thermistor has repeated unchanged, without noise, for 46 ticks.
    CheckFrozen = "check-frozen",
    /// The sample of the sink's thermistor has repeated unchanged, without noise, for 46 ticks.
    SinkFrozen = "sink-frozen",
    /// The sample of the skin's thermistor has repeated unchanged, without noise, for 46 ticks.
    SkinFrozen = "skin-frozen",
    /// The sample of the room's thermistor has repeated unchanged, without noise, for 46 ticks.
    RoomFrozen = "room-frozen",
    /// The sample of the force sensor has repeated unchanged, without noise, for 46 ticks.
    ForceFrozen = "force-frozen",
    /// The samples of one channel have repeated for 46 ticks, and those of all thermistors and the force sensor for 30:
    /// the converter has stopped.
    SamplesFrozen = "samples-frozen",
    /// The two display thermistors have differed by more than 3 K for 40 ms, so one of them is wrong.
    DisplaysApart = "displays-apart",
    /// The room has read more than 8 K above the skin for 40 ms: their thermistors are swapped, or one is misplaced.
    RoomAboveSkin = "room-above-skin",
    /// The force signal is below half of its live zero, or at the end of its range: its wire is broken or shorted.
    ForceSensor = "force-sensor",
    /// One of the two display thermistors reads above 43 °C.
    DisplayHot = "display-hot",
    /// One of the two display thermistors reads below 13.5 °C.
    DisplayCold = "display-cold",
    /// The sink's thermistor reads above 42 °C.
    SinkHot = "sink-hot",
    /// The display has moved by 2.5 K against the current within 2 s, or against the cooling pulse of the self-test:
    /// the module's polarity is wrong, or a thermistor is misplaced.
    Polarity = "polarity",
    /// The display has moved by 2.5 K against the current in more than 2 s: the current warms the sink more than it
    /// cools the display.
    Runaway = "runaway",
    /// The display has been 3.75 K (8 K on a tile that was never identified) from what its internal model predicts for
    /// 30 ms, each ampere of the correction counted as 0.5 K: the module or its thermal contact has changed, or heat
    /// enters that no sensor measures.
    UnlikeModel = "unlike-model",
    /// The measured current is more than 3 A above the controller's limit of 6 A in one tick.
    OverCurrent = "over-current",
    /// The measured current has exceeded the demanded one by more than 1 A plus a quarter of it for 30 ms, or
    /// its mean has exceeded 2 A in a pulse of 1 A of the self-test.
    CurrentHigh = "current-high",
    /// The measured current has been less than the demanded one by more than 1 A plus a quarter of it for 30 ms, or
    /// below 0.4 A in a pulse of the self-test: a leg of the bridge, a wire or the supply has failed.
    CurrentLow = "current-low",
    /// The bridge's fault line is pulled: the driver reports a fault, or the comparator has cut the supply because the
    /// second display thermistor was outside of 10 to 45 °C. Ignored while the bridge is off before a self-test.
    Bridge = "bridge",
    /// The thermal dose that the display could have given to skin has reached half a minute at 43 °C.
    Dose = "dose",
    /// A host that has asked for telemetry has sent no line for 2 s while the display followed a set-point.
    HostSilent = "host-silent",
    /// In the self-test, the comparator has not cut the bridge's supply, or not released it, within 10 ms after it was
    /// told to.
    Comparator = "comparator",
    /// In the self-test, one of the display's readings has not fallen by 0.05 to 1.5 K under the cooling pulse, or
    /// fingers have disturbed the test for 20 s.
    NoResponse = "no-response",
    /// Samples were lost because a tick took too long or they could not be stored, or a tick was early or late by a
    /// quarter of its period; the device stops sampling, and the watchdogs reset it.
    Sampling = "sampling",
    /// The words that guard the end of the stack were overwritten: the stack has outgrown its memory.
    Stack = "stack",
    /// The program has panicked. The panic handler turns the bridges off and stores this fault; the device is tripped
    /// by it after the reset that follows.
    Panic = "panic",
    /// The processor met an instruction or an access that it cannot execute, or an interrupt without a handler. Stored
    /// by the handler; the device is tripped by it after the reset that follows.
    HardFault = "hard-fault",
    /// The external 8 MHz clock has failed or was missing at the start, or the registers of the clocks have changed.
    Clock = "clock",
    /// The window watchdog has reset the device, because the control tick did not run for 47 ms; found after that
    /// reset.
    TickLost = "tick-lost",
    /// The independent watchdog has reset the device, because a task did not check in for 68 to 188 ms; found after
    /// that reset.
    Watchdog = "watchdog",
    /// The program has reset the device though neither `save` nor `forget` was sent; found after that reset.
    UnaskedReset = "unasked-reset",
    /// The stored settings are invalid, found at the start; the device uses the default settings of its class instead.
    SettingsCorrupt = "settings-corrupt",
}

/// One of the five thermistors of a finger's station, by what it measures, as [`Fault::of_thermistor`] needs it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThermistorId {
    /// First thermistor in the display surface, whose reading the control uses.
    Display,
    /// Second thermistor in the display surface, which checks the first and feeds the comparator.
    Check,
    /// Thermistor on the heat sink.
    Sink,
    /// Thermistor on the finger's skin, at the edge of the contact.
    Skin,
    /// Thermistor in the room's air.
    Room,
}

impl Fault {
    /// The fault that names both which thermistor fails and whether it is open or shorted.
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
