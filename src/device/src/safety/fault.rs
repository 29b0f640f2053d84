//! The faults that switch the bridge off.

use thermal_settings::vocabulary;

use crate::sense::ThermistorFault;

vocabulary! {
    /// The reason of a trip. A station with a fault switches its bridge off and keeps it off until the host sends
    /// `clear`. A trip cause that is kept in RAM through a reset holds its fault as its number, from 0 on in the order of
    /// [`Fault::ALL`]. [`TripCause::LAYOUT_HASH`](super::TripCause::LAYOUT_HASH) includes names and order of the faults, so
    /// that firmware with other faults rejects the kept cause.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u8)]
    pub enum Fault: "fault" {
        /// The display's first thermistor, whose reading the control uses, is an open circuit: thermistor or wire broken.
        DisplayOpen = "display-open",
        /// The display's first thermistor, whose reading the control uses, or its wires are shorted.
        DisplayShort = "display-short",
        /// The display's second thermistor, which cross-checks the first, is an open circuit: thermistor or wire broken.
        CheckOpen = "check-open",
        /// The display's second thermistor, which cross-checks the first, or its wires are shorted.
        CheckShort = "check-short",
        /// The heat sink's thermistor is an open circuit: the thermistor or its wire is broken.
        SinkOpen = "sink-open",
        /// The heat sink's thermistor or its wires are shorted.
        SinkShort = "sink-short",
        /// The skin's thermistor, at the edge of the contact, is an open circuit: thermistor or wire broken.
        SkinOpen = "skin-open",
        /// The skin's thermistor, at the edge of the contact, or its wires are shorted.
        SkinShort = "skin-short",
        /// The room's thermistor is an open circuit: thermistor or wire broken.
        RoomOpen = "room-open",
        /// The room's thermistor or its wires are shorted.
        RoomShort = "room-short",
        /// All five thermistors read as shorted in one tick: the supply that they share has failed.
        Excitation = "excitation",
        /// The reading of the display's first thermistor has changed by more than 0.5 K in 4 ms, faster than the display
        /// can.
        DisplayJump = "display-jump",
        /// The reading of the display's second thermistor has changed by more than 0.5 K in 4 ms, faster than the display
        /// can.
        CheckJump = "check-jump",
        /// The reading of the heat sink's thermistor has changed by more than 0.5 K in 4 ms, faster than the sink can.
        SinkJump = "sink-jump",
        /// The sum of 16 conversions of the display's first thermistor has not changed for 46 ticks (46 ms), while the
        /// conversions of other thermistors scattered. That noise would change a live signal, so the wire or the converter
        /// delivers a constant. Not found on a converter without such noise.
        DisplayFrozen = "display-frozen",
        /// The sum of 16 conversions of the display's second thermistor has not changed for 46 ticks (46 ms), while the
        /// conversions of other thermistors scattered. That noise would change a live signal, so the wire or the converter
        /// delivers a constant. Not found on a converter without such noise.
        CheckFrozen = "check-frozen",
        /// The sum of 16 conversions of the heat sink's thermistor has not changed for 46 ticks (46 ms), while the
        /// conversions of other thermistors scattered. That noise would change a live signal, so the wire or the converter
        /// delivers a constant. Not found on a converter without such noise.
        SinkFrozen = "sink-frozen",
        /// The sum of 16 conversions of the skin's thermistor has not changed for 46 ticks (46 ms), while the conversions
        /// of other thermistors scattered. That noise would change a live signal, so the wire or the converter delivers a
        /// constant. Not found on a converter without such noise.
        SkinFrozen = "skin-frozen",
        /// The sum of 16 conversions of the room's thermistor has not changed for 46 ticks (46 ms), while the conversions
        /// of other thermistors scattered. That noise would change a live signal, so the wire or the converter delivers a
        /// constant. Not found on a converter without such noise.
        RoomFrozen = "room-frozen",
        /// The sum of 16 conversions of the force sensor has not changed for 46 ticks (46 ms), while the conversions of
        /// thermistors scattered. That noise would change a live signal, so the wire or the converter delivers a constant.
        /// Not found on a converter without such noise.
        ForceFrozen = "force-frozen",
        /// The analogue-to-digital converter has stopped: the sum of one channel has not changed for 46 ticks (46 ms), and
        /// those of all five thermistors and the force sensor either began to repeat together, after noise had changed most
        /// of them in most ticks, or have not changed for 30 ticks, after conversions of thermistors scattered. Not found
        /// on a converter without such noise.
        SamplesFrozen = "samples-frozen",
        /// The readings of the two display thermistors have differed by more than 3 K for 40 ms (debounced), so one of them
        /// is wrong.
        DisplaysApart = "displays-apart",
        /// The room's thermistor has read more than 8 K above the skin's thermistor for 40 ms (debounced): the two are
        /// swapped, or one is misplaced.
        RoomAboveSkin = "room-above-skin",
        /// The force signal is below half of its live zero (the signal at no force), or at the upper end of the converter's
        /// range: the sensor's wire is broken or shorted.
        ForceSensor = "force-sensor",
        /// A display thermistor, the first or the second, reads above 43 °C in one tick.
        DisplayHot = "display-hot",
        /// A display thermistor, the first or the second, reads below 13.5 °C in one tick.
        DisplayCold = "display-cold",
        /// The heat sink's thermistor reads above 42 °C in one tick.
        SinkHot = "sink-hot",
        /// The display has moved by 2.5 K against the current from its best reading (the lowest while cooled, the highest
        /// while warmed), less than 2 s after that reading, or has warmed by more than 0.05 K by the self-test's cooling
        /// pulse: the module's polarity is wrong, or a thermistor is misplaced.
        Polarity = "polarity",
        /// The display has moved by 2.5 K against the current from its best reading (the lowest while cooled, the highest
        /// while warmed), 2 s or more after that reading: typically, the current warms the sink more than it cools the
        /// display.
        Runaway = "runaway",
        /// For 30 ms (debounced), while the display followed a set-point, its reading has differed too much from what its
        /// internal model predicts: the residual (prediction error, K, plus 0.5 K for each ampere by which the observer
        /// corrects the model) exceeded 3.75 K, or 8 K on a tile that was never identified. The module or its thermal
        /// contact has changed, or heat enters that no sensor measures.
        UnlikeModel = "unlike-model",
        /// The measured current is more than 3 A above the controller's limit of 6 A in one tick.
        OverCurrent = "over-current",
        /// For 30 ms (debounced) the measured current has differed from the demanded one, in magnitude, by more than 1 A
        /// plus a quarter of the demanded one, and was the larger one in the last tick; or its mean in a self-test pulse of
        /// 1 A was more than 2 A.
        CurrentHigh = "current-high",
        /// For 30 ms (debounced) the measured current has differed from the demanded one, in magnitude, by more than 1 A
        /// plus a quarter of the demanded one, and was the smaller one in the last tick; or its mean in a self-test pulse
        /// of 1 A was less than 0.4 A. A bridge leg, a wire or the supply has failed.
        CurrentLow = "current-low",
        /// The bridge's fault line is pulled: the bridge driver reports a fault, or the comparator has cut the supply
        /// because the second display thermistor was outside of 10 to 45 °C. Ignored while the station is off or tripped,
        /// and while the self-test tests the comparator.
        Bridge = "bridge",
        /// The thermal dose that skin would have received from the display has reached the equivalent of 30 s at 43 °C.
        Dose = "dose",
        /// The host has sent no line for 2 s while telemetry streams to it and the display follows a set-point.
        HostSilent = "host-silent",
        /// In the self-test, the comparator has not pulled the bridge's fault line within 10 ms after its input was
        /// connected to a level above or below its window, or not released the line within 10 ms after the test.
        Comparator = "comparator",
        /// In the self-test, a display thermistor's reading has not fallen by 0.05 to 1.5 K under the cooling pulse, or
        /// fingers that landed and lifted have delayed the baseline by 20 s in all.
        NoResponse = "no-response",
        /// Samples were lost, because a tick took too long or the DMA controller failed, or a tick was early or late by
        /// more than a quarter of its period. The board then stops sampling for good and a watchdog resets the device.
        Sampling = "sampling",
        /// The stack has overflowed: the guard words at its end were overwritten. Checked in every tick and at the start.
        Stack = "stack",
        /// The program has panicked. The panic handler turns the bridges off and stores this fault, unless the cause of an
        /// earlier trip is stored; the device starts tripped by the stored fault after the watchdog's reset.
        Panic = "panic",
        /// The processor met an instruction or a memory access that it cannot execute, or an interrupt that no handler
        /// serves. The exception handler turns the bridges off and stores this fault, unless the cause of an earlier trip
        /// is stored; the device starts tripped by the stored fault after the watchdog's reset.
        HardFault = "hard-fault",
        /// The external 8 MHz clock has failed or was missing at the start, or the clock configuration register has
        /// changed.
        Clock = "clock",
        /// A debugger has selected that a watchdog or a PWM timer stands still while it halts the core, so that a halted
        /// core would drive the bridges without end. Checked in every tick; the next start clears the selection.
        WatchdogsFrozen = "watchdogs-frozen",
        /// The brown-out level of the microcontroller's option bytes is not the highest, so that the program could run at a
        /// supply below that of its flash. Present from the start on until the option bytes are set.
        BrownOutLevel = "brown-out-level",
        /// The settings of a PWM timer that switch its outputs off after a fault (break, idle level, lock) are not as they
        /// were set. Checked in every tick.
        PwmSettings = "pwm-settings",
        /// The window watchdog has reset the device, because the control tick did not run for 47 ms; detected at the start
        /// after that reset.
        TickLost = "tick-lost",
        /// The independent watchdog has reset the device, because a task did not report to it for 68 to 188 ms (the time
        /// varies with the watchdog's oscillator); detected at the start after that reset.
        Watchdog = "watchdog",
        /// A reset by the program (or on entry to a low-power mode) that neither the host has ordered by `save` or
        /// `forget`, nor the device itself because its external clock has come; detected at the start after that reset.
        UnaskedReset = "unasked-reset",
        /// The settings stored in flash are invalid, which is detected at the start; the device then uses the factory
        /// defaults.
        SettingsCorrupt = "settings-corrupt",
        /// The emergency stop is pressed in one tick, in any state. It also disconnects the bridge's supply.
        EmergencyStop = "emergency-stop",
        /// For 10 ms (debounced) the bridge's supply has been outside of 10.8 to 13.2 V although it should be on: since the
        /// comparator's tests of the self-test have passed. Or it was outside at the end of one of these tests.
        Supply = "supply",
        /// In the self-test, the bridge's supply was still above 6 V 19 ms after the comparator was told to cut it: the
        /// switch of the supply is shorted.
        SupplySwitch = "supply-switch",
        /// With five fingers: the multiplexers did not select the finger whose samples were taken, because one of their
        /// select lines is broken or shorted.
        SelectLines = "select-lines",
        /// The self-test has moved the skin's thermistor together with the display: it sits on the plate instead of on the finger, so
        /// that an armed display would follow itself.
        SkinOnPlate = "skin-on-plate",
    }
}

vocabulary! {
    /// One of the five thermistors of a finger's station, by the place where it measures; selects the fault that
    /// [`Fault::of_open_or_shorted_thermistor`] returns.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ThermistorId: "sensor" {
        /// First thermistor in the display surface, whose reading the control uses.
        Display = "display",
        /// Second thermistor in the display surface, which checks the first and is also read by the independent comparator
        /// that cuts the bridge's supply.
        Check = "check",
        /// Thermistor on the Peltier module's heat sink.
        Sink = "sink",
        /// Thermistor on the finger's skin, at the edge of the contact.
        Skin = "skin",
        /// Thermistor in the room's air.
        Room = "room",
    }
}

impl Fault {
    /// The fault that names both which thermistor fails and whether it is open or shorted.
    pub const fn of_open_or_shorted_thermistor(
        thermistor: ThermistorId,
        fault: ThermistorFault,
    ) -> Self {
        match (thermistor, fault) {
            (ThermistorId::Display, ThermistorFault::Open) => Self::DisplayOpen,
            (ThermistorId::Display, ThermistorFault::Short) => Self::DisplayShort,
            (ThermistorId::Check, ThermistorFault::Open) => Self::CheckOpen,
            (ThermistorId::Check, ThermistorFault::Short) => Self::CheckShort,
            (ThermistorId::Sink, ThermistorFault::Open) => Self::SinkOpen,
            (ThermistorId::Sink, ThermistorFault::Short) => Self::SinkShort,
            (ThermistorId::Skin, ThermistorFault::Open) => Self::SkinOpen,
            (ThermistorId::Skin, ThermistorFault::Short) => Self::SkinShort,
            (ThermistorId::Room, ThermistorFault::Open) => Self::RoomOpen,
            (ThermistorId::Room, ThermistorFault::Short) => Self::RoomShort,
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
            let same = Fault::ALL.iter().filter(|other| other.name() == fault.name());
            assert_eq!(same.count(), 1, "{}", fault.name());
        }
    }
}
