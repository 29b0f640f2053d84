//! What the device's faults mean to a person, and what to do.

use thermal_device::safety::Fault;

/// A fault in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultWords {
    /// What has happened.
    pub meaning: &'static str,
    /// What to look at, and what to do.
    pub remedy: &'static str,
}

/// What to do about a thermistor that is open, shorted or constant.
const WIRE: &str = "look at its connector and its wire; a thermistor that has failed is replaced and calibrated again";
const RESTART: &str = "clear it and go on; if it comes back, log telemetry and `thermal-lab info`, and do not use the device";

/// Meaning and remedy of a fault. `clear` is refused as long as the fault is present.
pub const fn fault_words(fault: Fault) -> FaultWords {
    let (meaning, remedy) = match fault {
        Fault::DisplayOpen => ("the display's first thermistor is an open circuit", WIRE),
        Fault::DisplayShort => ("the display's first thermistor is shorted to ground", WIRE),
        Fault::CheckOpen => ("the display's second thermistor is an open circuit", WIRE),
        Fault::CheckShort => ("the display's second thermistor is shorted to ground", WIRE),
        Fault::SinkOpen => ("the sink's thermistor is an open circuit", WIRE),
        Fault::SinkShort => ("the sink's thermistor is shorted to ground", WIRE),
        Fault::SkinOpen => ("the skin's thermistor is an open circuit", WIRE),
        Fault::SkinShort => ("the skin's thermistor is shorted to ground", WIRE),
        Fault::RoomOpen => ("the room's thermistor is an open circuit", WIRE),
        Fault::RoomShort => ("the room's thermistor is shorted to ground", WIRE),
        Fault::Excitation => (
            "all thermistors read as shorted: the dividers have no 3.3 V",
            "look at the 3.3 V of the sensor board and at its connector",
        ),
        Fault::DisplayJump => (
            "the display's first thermistor jumped by 0.5 K in 4 ms, faster than the display can",
            "a loose contact: look at its connector and its wire",
        ),
        Fault::CheckJump => (
            "the display's second thermistor jumped by 0.5 K in 4 ms, faster than the display can",
            "a loose contact: look at its connector and its wire",
        ),
        Fault::SinkJump => (
            "the sink's thermistor jumped by 0.5 K in 4 ms, faster than the sink can",
            "a loose contact: look at its connector and its wire",
        ),
        Fault::DisplayFrozen => ("the display's first thermistor does not move at all", FROZEN),
        Fault::CheckFrozen => ("the display's second thermistor does not move at all", FROZEN),
        Fault::SinkFrozen => ("the sink's thermistor does not move at all", FROZEN),
        Fault::SkinFrozen => ("the skin's thermistor does not move at all", FROZEN),
        Fault::RoomFrozen => ("the room's thermistor does not move at all", FROZEN),
        Fault::ForceFrozen => ("the force signal does not move at all", FROZEN),
        Fault::SamplesFrozen => (
            "no input moves at all: the converter has stopped",
            "switch the device off and on; if it comes back, the converter or its supply has failed",
        ),
        Fault::DisplaysApart => (
            "the two display thermistors differ by 3 K",
            "one of them is a wrong one, or off the plate: look at both",
        ),
        Fault::RoomAboveSkin => (
            "the room reads 8 K more than the skin",
            "the two thermistors are swapped, or one is not where it should be: the skin's belongs to the finger, the room's into the air",
        ),
        Fault::ForceSensor => (
            "the force signal is out of its range",
            "lift the finger; if it stays, a wire of the load cell is broken, or its amplifier has failed",
        ),
        Fault::DisplayHot => (
            "the display was above 43 °C",
            "lift the finger, let the display cool down; the sink's cooling may be too weak, or the room too warm",
        ),
        Fault::DisplayCold => (
            "the display was below 13.5 °C",
            "lift the finger, let the display warm up; if it comes back, tune and calibrate the device again",
        ),
        Fault::SinkHot => (
            "the heat sink was above 42 °C",
            "let it cool down; look at the fan, the coolant, and the air around the sink",
        ),
        Fault::Polarity => (
            "the display moves against its current",
            "the tile's wires P and N are swapped (reversed tile), or a thermistor is not at its place",
        ),
        Fault::Runaway => (
            "the display drifts against its current",
            "the sink is too warm: look at the fan, the coolant, and whether the tile sits flat on the sink",
        ),
        Fault::UnlikeModel => (
            "the display does not move as its model says",
            "look for something other than a finger on the display, and at the force sensor; if it comes back without, tune the device again",
        ),
        Fault::OverCurrent => (
            "more than 9 A were measured",
            "load shorted, or sense resistors R5, R6 (5 mΩ, block bridge) larger than that",
        ),
        Fault::CurrentHigh => (
            "more current was measured than demanded",
            "load shorted, or sense resistors R5, R6 (5 mΩ, block bridge) larger than that",
        ),
        Fault::CurrentLow => (
            "hardly any current was measured",
            "load not connected, MOSFETs M1 to M4, gate driver X3, inductors L1, L2 of block bridge, or the current measurement \
             (block mirror, PC2)",
        ),
        Fault::Bridge => (
            "nFAULT is low: the bridge's driver reports a fault, or the comparator has cut the supply because the display was outside \
             of 10 to 45 °C",
            "let the display come to room temperature and clear it; if it stays, look at gate driver X3 (block bridge)",
        ),
        Fault::Dose => (
            "the skin may have taken half a minute of dose (43 °C equivalent)",
            "end the session for this participant; the dose decays by a minute an hour below 39 °C",
        ),
        Fault::HostSilent => (
            "the computer sent nothing for 2 s while the display was driven",
            "look at the cable, and whether this computer was busy or asleep; then clear it",
        ),
        Fault::Comparator => (
            "the comparator does not follow its test",
            "see in `thermal-lab info` which check of the self-test failed first; do not use the device until it passes",
        ),
        Fault::NoResponse => (
            "the display thermistors do not follow the tile in the self-test",
            "keep the finger off during the self-test; thermistors off the plate, or a tile that does not pump",
        ),
        Fault::Sampling => ("samples were lost, or a tick was late", RESTART),
        Fault::Stack => ("the program's stack has overflowed", RESTART),
        Fault::Panic => ("the device's program has ended by an error of its own", RESTART),
        Fault::HardFault => ("the processor could not go on", RESTART),
        Fault::Clock => (
            "the 8 MHz clock of the probe is missing",
            "USB not plugged in, or SB16, SB50 open; the device restarts by itself when the clock has come",
        ),
        Fault::WatchdogsFrozen => (
            "a debugger has frozen the watchdogs",
            "remove it, switch everything off, USB included, and on again",
        ),
        Fault::BrownOutLevel => (
            "BOR_LEV of the option bytes is not 00",
            "set it as docs/hardware.md says; the device stays tripped until then",
        ),
        Fault::PwmSettings => (
            "the PWM timer's settings are not those of the firmware",
            "switch the device off and on; if it comes back, do not use it",
        ),
        Fault::TickLost => ("the window watchdog has reset the device", RESTART),
        Fault::Watchdog => ("the independent watchdog has reset the device", RESTART),
        Fault::UnaskedReset => (
            "a probe or a failure has restarted the program",
            "send `clear`; if no probe was used and it comes back, do not use the device",
        ),
        Fault::SettingsCorrupt => (
            "the stored settings are not valid, and the factory defaults are used",
            "send the settings that were kept at commissioning, or commission the device again",
        ),
        Fault::EmergencyStop => (
            "the emergency stop is pressed, or the wire from its contact S2 to PC13 is broken",
            "find out why, release the button, then clear it",
        ),
        Fault::Supply => (
            "the bridge supply is outside of 10.8 to 13.2 V",
            "emergency stop, fuse F1, high-side switch M1 and its gate drive, or its divider R9, R10 (block switch)",
        ),
        Fault::SupplySwitch => (
            "the bridge supply stays although the comparator has cut it",
            "high-side switch M1 (block switch) shorted, or bleeder R7 missing; do not use the device",
        ),
        Fault::SelectLines => (
            "the multiplexers did not select the finger whose turn it was",
            "a select line is broken or shorted: look at the connector between controller and sensor board",
        ),
        Fault::SkinOnPlate => (
            "the skin thermistor cools and warms with the display",
            "it sits on the plate: fix it to the finger, 2 to 3 mm beside the contact",
        ),
    };
    FaultWords { meaning, remedy }
}

/// What to do about an input that delivers a constant.
const FROZEN: &str =
    "look at its wire and its follower; if all is well, switch the device off and on";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_is_explained_with_what_to_do() {
        for &fault in Fault::ALL {
            let FaultWords { meaning, remedy } = fault_words(fault);
            assert!(meaning.len() > 10 && remedy.len() > 10, "{fault:?}");
            assert_ne!(meaning, remedy, "{fault:?}");
        }
    }
}
