//! What the device's fault words mean to a person at the bench.

/// What to look at when the device reports a fault; `None` for a word that is none.
#[must_use]
pub fn explanation(word: &str) -> Option<&'static str> {
    Some(match word {
        "comparator" => {
            "the comparator does not follow its test; see the first check of the self-test that \
                 has failed"
        }
        "supply-switch" => {
            "the bridge supply stays although the comparator has cut it: high-side switch M1 \
                 (block switch) shorted, or bleeder R7 missing"
        }
        "supply" => {
            "the bridge supply is outside of 10.8 to 13.2 V: emergency stop, fuse F1, high-side \
                 switch M1 and its gate drive, or its divider R9, R10 (block switch)"
        }
        "emergency-stop" => {
            "the emergency stop is pressed, or the wire from its contact S2 to PC13 is broken"
        }
        "bridge" => {
            "nFAULT is low: the gate driver X3 (block bridge) reports a fault, or the comparator \
                 has cut the supply"
        }
        "current-low" => {
            "hardly any current is measured: load not connected, MOSFETs M1 to M4, gate driver \
                 X3, inductors L1, L2 of block bridge, or the current measurement (block mirror, \
                 PC2)"
        }
        "current-high" => {
            "too much current is measured: load shorted, or sense resistors R5, R6 (5 mΩ, block \
                 bridge) larger than that"
        }
        "over-current" => {
            "more than 9 A are measured: load shorted, or sense resistors R5, R6 (5 mΩ) larger \
                 than that"
        }
        "polarity" => {
            "the display warms when it should cool: the tile's wires P and N are swapped \
                 (reversed tile)"
        }
        "no-response" => {
            "the display thermistors do not follow the tile: off the plate, or the tile does not \
                 pump"
        }
        "clock" => {
            "the 8 MHz clock of the probe is missing: USB not plugged in, or SB16, SB50 open"
        }
        "unasked-reset" => "a probe or a failure has restarted the program: send `clear`",
        "brown-out-level" => "BOR_LEV of the option bytes is not 00",
        "watchdogs-frozen" => {
            "a debugger has frozen the watchdogs: remove it, switch everything off, USB included"
        }
        "pwm-settings" => "the PWM timer's settings are not those of the firmware",
        "display-open" | "check-open" | "sink-open" | "skin-open" | "room-open" => {
            "this thermistor's input is open: its wire, or its connector"
        }
        "display-short" | "check-short" | "sink-short" | "skin-short" | "room-short" => {
            "this thermistor's input is shorted to ground"
        }
        "excitation" => "all thermistors read as shorted: the dividers have no 3.3 V",
        "force-sensor" => {
            "the force signal is out of its range: a broken wire of the load cell, or its amplifier"
        }
        "displays-apart" => {
            "the two display thermistors differ by 3 K: a wrong one, or one off the plate"
        }
        "room-above-skin" => {
            "the room reads 8 K more than the skin: swapped, or not where they should be"
        }
        "display-frozen" | "check-frozen" | "sink-frozen" | "skin-frozen" | "room-frozen"
        | "force-frozen" | "samples-frozen" => {
            "this input does not move at all: its follower, or the converter"
        }
        _ => return None,
    })
}
