//! Rails, emergency stop and bridge supply.

use super::super::check::{ManualStep, Reading, Routine, Stage, StageId, Value};
use super::super::unit::Unit::{Ampere, Ratio, Volt};
use super::{manual, meter, read, routine};

const TO_GROUND: &str = "volt meter from the point to analog ground (CN7-20)";
const ON_POWER_BOARD: &str = "volt meter from the point to the power board's star point";
const LADDER: &str =
    "the comparator's ladder R1, R2, R3 (3.4, 3.7, 3.01 kΩ) has a wrong resistor: measure each";

pub const RAILS: Stage = Stage {
    id: StageId::Rails,
    name: "rails",
    title: "5 V and 3.3 V, from 12 V with a current limit, emergency stop pressed",
    needs: ManualStep {
        say: "Everything off and unplugged, emergency stop pressed.",
        lines: &["press stop"],
    },
    steps: &[
        manual(
            "The emergency stop stays pressed. Plug in the Nucleo's USB through the isolator (the probe gives the clock). Set a \
             laboratory supply to 12.0 V with a limit of 0.2 A, connect it to the power board, and switch it on.",
            &["press stop", "fit usb", "fit supply"],
        ),
        routine(Routine::Wait(1000)),
        meter("12v", "12 V behind the fuse", "volt supply", ON_POWER_BOARD)
            .range(11.6, 12.4, Volt)
            .basis("12 V, 1 % of the laboratory supply and 2 % of the meter")
            .finding("12 V is not behind the fuse, or the laboratory supply is in its current limit: look \
                 at fuse F1, C1 and X1 of block supply")
            .blocks(StageId::Chip)
            .step(),
        meter(
            "12v-current",
            "current out of the 12 V supply",
            "ampere supply",
            "read the laboratory supply's own display",
        )
            .range(0.015, 0.15, Ampere)
            .basis("estimated: the Nucleo's 60 to 150 mA at 5 V through the regulator; the driver is \
                 off")
            .low("hardly any current: the 5 V regulator X1 does not run, or JP5 of the Nucleo is not \
                 on E5V")
            .high("too much current with the bridge off: a part is the wrong way round or shorted; \
                 feel which one gets warm")
            .blocks(StageId::Chip)
            .step(),
        meter("5v", "5 V, CN7-6", "volt 5v", TO_GROUND)
            .range(4.8, 5.2, Volt)
            .basis("R-78E5.0: 3 % (recalled, check), 1 % of the meter")
            .finding("the 5 V regulator X1 (R-78E5.0-0.5, block supply) is wrong or overloaded")
            .blocks(StageId::Chip)
            .step(),
        meter("3v3", "3.3 V, CN7-16", "volt 3v3", TO_GROUND)
            .range(3.2, 3.4, Volt)
            .basis("the Nucleo's regulator: 2 % (recalled, check), 1 % of the meter")
            .finding("the Nucleo's 3.3 V are wrong: JP5 on E5V, JP6 closed, nothing shorted on the analog \
                 board?")
            .blocks(StageId::Chip)
            .step(),
        meter(
            "cold-threshold",
            "threshold of the comparator's cold side",
            "volt cold",
            "volt meter at the upper tap of the ladder, between R1 and R2 of block comparator",
        )
            .range(2.08, 2.33, Volt)
            .basis("0.669 of 3.3 V, which may be 3.2 to 3.4 V; judged as a ratio below")
            .finding(LADDER)
            .blocks(StageId::Latch)
            .step(),
        meter(
            "hot-threshold",
            "threshold of the comparator's hot side",
            "volt hot",
            "volt meter at the lower tap of the ladder, between R2 and R3 of block comparator",
        )
            .range(0.95, 1.07, Volt)
            .basis("0.306 of 3.3 V, which may be 3.2 to 3.4 V; judged as a ratio below")
            .finding(LADDER)
            .blocks(StageId::Latch)
            .step(),
        read(
            "cold-ratio",
            "cold threshold as a part of 3.3 V",
            Reading::Derived(|kept| Some(kept.get("cold-threshold")? / kept.get("3v3")?)),
        )
            .range(0.661, 0.677, Ratio)
            .basis("bench `thresholds`: 10 °C ± 0.5 K is 0.669 ± 0.0055; 0.3 % between two readings of \
                 one meter")
            .low("the cold threshold is too low: R1 (3.4 kΩ) of the ladder in block comparator is \
                 larger than that, or R2 or R3 smaller")
            .high("the cold threshold is too high: R1 (3.4 kΩ) of the ladder in block comparator is \
                 smaller than that, or R2 or R3 larger")
            .blocks(StageId::Latch)
            .step(),
        read(
            "hot-ratio",
            "hot threshold as a part of 3.3 V",
            Reading::Derived(|kept| Some(kept.get("hot-threshold")? / kept.get("3v3")?)),
        )
            .range(0.300, 0.311, Ratio)
            .basis("bench `thresholds`: 45 °C ± 0.5 K is 0.3057 ± 0.0042 with hysteresis; 0.3 % between \
                 two readings of one meter")
            .low("the hot threshold is too low, so the comparator would cut above 45 °C: R3 (3.01 kΩ) \
                 of the ladder in block comparator is smaller than that, R1 or R2 larger, or R4 (360 \
                 kΩ) missing")
            .high("the hot threshold is too high: R3 (3.01 kΩ) of the ladder in block comparator is \
                 larger than that, or R1 or R2 smaller")
            .blocks(StageId::Latch)
            .step(),
        meter(
            "bridge-supply-stopped",
            "bridge supply with the stop pressed",
            "volt bridge-supply",
            ON_POWER_BOARD,
        )
            .range(0.0, 0.5, Volt)
            .basis("the emergency stop is open")
            .high("the bridge has a supply although the emergency stop is pressed: the stop is not in \
                 the 12 V line, or bridged")
            .blocks(StageId::Supply)
            .step(),
    ],
};

pub const SUPPLY: Stage = Stage {
    id: StageId::Supply,
    name: "supply",
    title: "Emergency stop, its sense, and the bridge supply before the first self-test",
    needs: ManualStep { say: "USB plugged in, then 12 V with a limit of 0.5 A, emergency stop pressed, load cell \
                 connected, 10 kΩ in place of each thermistor, nothing at the tile terminals.", lines: super::needs::COLD },
    steps: &[
        read(
            "stop-sense-pressed",
            "emergency stop as the device sees it, pressed",
            Reading::Raw(|raw| stop_word(raw.stop)),
        )
            .words(&["pressed"])
            .basis("PC13 is low while pressed")
            .low("the device does not see the emergency stop: second contact S2, R5 (1 kΩ), R6 (10 \
                 kΩ) of block supply, PC13 (CN7-23), SB17 open?")
            .blocks(StageId::Load)
            .step(),
        manual("Set the current limit to 0.5 A. Release the emergency stop.", &["release stop"]),
        routine(Routine::Wait(500)),
        read(
            "stop-sense-released",
            "emergency stop as the device sees it, released",
            Reading::Raw(|raw| stop_word(raw.stop)),
        )
            .words(&["released"])
            .basis("PC13 is high while released")
            .low("the device sees the emergency stop pressed although it is released: the wire from \
                 its second contact S2 to PC13 (CN7-23) is missing or broken, or R5 (1 kΩ) of block \
                 supply")
            .blocks(StageId::Latch)
            .step(),
        read(
            "latch-at-power-on",
            "nFAULT before the first self-test",
            Reading::Raw(|raw| line_word(raw.fault_line)),
        )
            .words(&["low"])
            .basis("the latch is set at power-on and pulls nFAULT")
            .low("nFAULT is high before the first self-test: the latch X6 (74HCT74) is not set at \
                 power-on (R15, C2 of block comparator), or M1 (BSS138) does not pull nFAULT, or PA6 \
                 (D12) is not connected to it")
            .blocks(StageId::Load)
            .step(),
        meter(
            "bridge-supply-latched",
            "bridge supply before the first self-test",
            "volt bridge-supply",
            ON_POWER_BOARD,
        )
            .range(0.0, 0.5, Volt)
            .basis("bench `self-test`: below 0.5 V while the latch is set")
            .high("the bridge has a supply before the first self-test although the latch should keep \
                 it off: if nFAULT is high, mend the latch first; if it is low, the high-side switch \
                 M1 (IPD90P03P4, block switch) is shorted or in backwards, or its gate drive M2, Q1 \
                 is always on")
            .blocks(StageId::Load)
            .step(),
    ],
};

/// The emergency stop in a word.
pub fn stop_word(pressed: bool) -> Value {
    Value::Word(if pressed { "pressed" } else { "released" }.into())
}

/// Level of nFAULT in a word.
pub fn line_word(pulled: bool) -> Value {
    Value::Word(if pulled { "low" } else { "high" }.into())
}
