//! Comparator, latch and switch: by the self-test, and by a resistor in place of the second display thermistor.

use thermal_client::client::SelfTestReport;

use super::super::check::{ManualStep, Reading, Routine, Stage, StageId, Step, Value};
use super::super::unit::Unit::{Millisecond, Ohm, Ratio, Volt};
use super::supply::line_word;
use super::{manual, meter, read, routine};

/// nFAULT after the test line has risen, ms.
const fn cut(
    name: &'static str,
    what: &'static str,
    reading: fn(&SelfTestReport) -> Option<Value>,
    missing: &'static str,
) -> Step {
    read(name, what, Reading::SelfTest(reading))
        .range(0.0, 10.0, Millisecond)
        .basis("bench `self-test`: 0.5 ms; the firmware allows 10 ms")
        .low(missing)
        .high("nFAULT falls late in the self-test: R10 (470 kΩ) or C1 (470 pF) of block comparator")
        .blocks(StageId::Edges)
        .step()
}

/// Sensed supply at the end of a test.
const fn cut_supply(
    name: &'static str,
    what: &'static str,
    reading: fn(&SelfTestReport) -> Option<Value>,
) -> Step {
    read(name, what, Reading::SelfTest(reading))
        .range(2.0, 6.0, Volt)
        .basis("bench `self-test`: 4.1 V after 20 ms; the firmware allows 6 V")
        .low(
            "the bridge supply is gone too quickly or not sensed: C2 (100 µF) of block switch \
                 missing, R9 (33 kΩ) or R10 (10 kΩ) open, PC4 (CN10-34)",
        )
        .high(
            "the bridge supply stays although the comparator has cut it: the high-side switch M1 \
                 (IPD90P03P4, block switch) is shorted, or the bleeder R7 (150 Ω, 2 W) with M3 is \
                 missing",
        )
        .blocks(StageId::Edges)
        .step()
}

/// nFAULT after the test line has fallen, ms.
const fn release(
    name: &'static str,
    what: &'static str,
    reading: fn(&SelfTestReport) -> Option<Value>,
) -> Step {
    read(name, what, Reading::SelfTest(reading))
        .range(1.0, 10.0, Millisecond)
        .basis("bench `self-test`: 2.8 to 6.9 ms; the firmware allows 10 ms")
        .low(
            "the latch is not cleared after the test: X6 (74HCT74), X5 (74HCT1G14), R16 (33 kΩ), \
                 C3 (100 nF) of block comparator, or the comparator X3, X4 (TLV1702) sees the \
                 thermistor outside of its window",
        )
        .high("the latch is cleared late: R16 (33 kΩ), C3 (100 nF) of block comparator")
        .blocks(StageId::Edges)
        .step()
}

pub const LATCH: Stage = Stage {
    id: StageId::Latch,
    name: "latch",
    title: "Latch, switch and sensed supply, by the self-test; nothing at the tile terminals",
    needs: ManualStep {
        say: "USB plugged in, then 12 V with a limit of 0.5 A, emergency stop released, load cell \
                 connected, 10 kΩ in place of each thermistor, nothing at the tile terminals.",
        lines: super::needs::ON,
    },
    steps: &[
        // The first self-test after power-on finds the supply off, so its first test says nothing about the switch.
        routine(Routine::SelfTest),
        routine(Routine::SelfTest),
        read(
            "side-line",
            "line that selects the side of the comparator's tests, read back",
            Reading::SelfTest(|report| report.side.map(|side| Value::Word(side.name().into()))),
        )
        .words(&["ok"])
        .basis("comparator.cir: PB2 alone drives it, against 3.3 kΩ")
        .low(
            "PB2 (CN10-22), the line that selects the side of the comparator's test, stays at this \
                 level whatever the microcontroller drives, so one side would be tested twice and \
                 the other never: PB2 is shorted (to ground if it is low, to 3.3 V if it is high), \
                 or its output in the microcontroller is destroyed",
        )
        .blocks(StageId::Edges)
        .step(),
        cut(
            "hot-cut",
            "comparator's test at its hot side until nFAULT falls",
            |report| report.hot_cut_ms.map(|ms| Value::Number(ms.into())),
            "the comparator does not cut when its hot side is tested: hot side X3 (half of the \
                 TLV1702, block comparator) dead or without 5 V, test switch X1 (74LVC1G3157), PC3 \
                 (CN7-37) or PB2 (CN10-22) not connected, latch X6 (74HCT74) dead",
        ),
        cut_supply("hot-supply", "bridge supply at the end of that test", |report| {
            report.hot_supply_v.map(Value::Number)
        }),
        release("hot-release", "end of that test until nFAULT rises", |report| {
            report.hot_release_ms.map(|ms| Value::Number(ms.into()))
        }),
        cut(
            "cold-cut",
            "comparator's test at its cold side until nFAULT falls",
            |report| report.cold_cut_ms.map(|ms| Value::Number(ms.into())),
            "the comparator does not cut when its cold side is tested: cold side X4 (half of the \
                 TLV1702, block comparator) dead, or PB2 (CN10-22) not connected to R7 (6.34 kΩ)",
        ),
        cut_supply("cold-supply", "bridge supply at the end of that test", |report| {
            report.cold_supply_v.map(Value::Number)
        }),
        release("cold-release", "end of that test until nFAULT rises", |report| {
            report.cold_release_ms.map(|ms| Value::Number(ms.into()))
        }),
        read(
            "supply",
            "sensed bridge supply after the tests",
            Reading::SelfTest(|report| report.supply_v.map(Value::Number)),
        )
        .range(11.0, 13.0, Volt)
        .basis("12 V of the laboratory supply; 1 % resistors, 2 % of the 3.3 V")
        .low(
            "the bridge supply does not come back: high-side switch M1, its gate drive M2, M4, \
                 Q1, R1 to R4, R11, R12 of block switch, or the laboratory supply is in its limit",
        )
        .high("the sensed supply is too high: R9 (33 kΩ) or R10 (10 kΩ) of block switch is wrong")
        .blocks(StageId::Edges)
        .step(),
        read(
            "result",
            "what ends the self-test without a load",
            Reading::SelfTest(|report| Some(Value::Word(report.result.name().into()))),
        )
        .words(&["current-low"])
        .basis("nothing is connected to the tile terminals, so no current flows")
        .low("")
        .blocks(StageId::Edges)
        .step(),
        meter(
            "bridge-supply-on",
            "bridge supply after the self-test",
            "volt bridge-supply",
            "volt meter from the bridge supply (drain of M1) to the power board's star point",
        )
        .range(11.5, 12.5, Volt)
        .basis("12 V of the laboratory supply, 1 % of the meter; the switch drops millivolts")
        .low(
            "the bridge supply does not come although the latch is clear: high-side switch M1, \
                 its gate drive M2, Q1 of block switch",
        )
        .high("the laboratory supply is above 12 V")
        .blocks(StageId::Edges)
        .step(),
        read(
            "supply-sense",
            "sensed bridge supply as a part of the meter's",
            Reading::Derived(|kept| Some(kept.get("supply")? / kept.get("bridge-supply-on")?)),
        )
        .range(0.94, 1.06, Ratio)
        .basis("switch.cir R9, R10: 1 % each; 2 % of the 3.3 V, 1 % of the meter")
        .low(
            "the sensed supply is too low: R9 (33 kΩ) of block switch is larger, or R10 (10 kΩ) \
                 smaller",
        )
        .high(
            "the sensed supply is too high: R9 (33 kΩ) of block switch is smaller, or R10 (10 \
                 kΩ) larger",
        )
        .blocks(StageId::Edges)
        .step(),
        manual(
            "Hold the Nucleo's reset button (B2), and wait until the meter stands still.",
            &["press reset"],
        ),
        routine(Routine::Wait(200)),
        meter(
            "bridge-supply-in-reset",
            "bridge supply while the microcontroller is in reset",
            "volt bridge-supply",
            "volt meter from the bridge supply (drain of M1) to the power board's star point",
        )
        .range(0.0, 0.5, Volt)
        .basis("comparator.cir: NRST sets the latch; bench `pins`")
        .high(
            "a reset does not cut the bridge supply, so the ROM boot loader could drive the \
                 bridge: D1 (BAT54), M2 (BSS138) of block comparator, wire to NRST (CN7-14)",
        )
        .blocks(StageId::Load)
        .step(),
        manual("Release the reset button.", &["release reset"]),
        routine(Routine::Wait(1500)),
    ],
};

/// Begin and end of the resistor's way to the hot edge, ohm: 41 to 49 °C.
const TO_HOT_OHM: (f64, f64) = (5000.0, 3700.0);
/// To the cold edge: 16 to 7 °C.
const TO_COLD_OHM: (f64, f64) = (15e3, 23.5e3);

pub const EDGES: Stage = Stage {
    id: StageId::Edges,
    name: "edges",
    title: "Comparator: each edge, with a variable resistor in place of the second display \
                 thermistor",
    needs: ManualStep { say: "USB plugged in, then 12 V with a limit of 0.5 A, emergency stop released, load cell \
                 connected, 10 kΩ in place of each thermistor, nothing at the tile terminals.", lines: super::needs::ON },
    steps: &[
        manual(
            "The second display thermistor's input is now turned up and down: use a resistance decade, or a 25 kΩ trimmer of \
             ten turns. Begin with 10 kΩ.",
            &["fit resistor check 10000"],
        ),
        routine(Routine::Edge { keep: "hot-edge", ohm: TO_HOT_OHM }),
        read("hot-edge", "resistance at which the hot side trips", Reading::Kept)
            .range(4210.0, 4490.0, Ohm)
            .basis("45 °C is 4348 Ω, 170 Ω/K; ± 0.5 K by bench `thresholds`, 1 % of the meter")
            .low("the comparator trips above 45.5 °C only, or never: hot side X3 (half of the \
                 TLV1702) dead, ladder R1 to R4 or pull-up R1 (10 kΩ) of the second display's divider \
                 wrong")
            .high("the comparator trips below 44.5 °C already: ladder R1 to R4 of block comparator, or \
                 pull-up R1 (10 kΩ) of the second display's divider wrong")
            .blocks(StageId::Load)
            .step(),
        routine(Routine::Edge { keep: "cold-edge", ohm: TO_COLD_OHM }),
        read("cold-edge", "resistance at which the cold side trips", Reading::Kept)
            .range(19_400.0, 20_950.0, Ohm)
            .basis("10 °C is 20.17 kΩ, 1 kΩ/K; ± 0.5 K by bench `thresholds`, 1 % of the meter")
            .low("the comparator trips above 10.5 °C already, or never: ladder R1 to R3 of block \
                 comparator, or pull-up R1 (10 kΩ) of the second display's divider wrong; cold side \
                 X4 (half of the TLV1702) dead if it never trips")
            .high("the comparator trips below 9.5 °C only: ladder R1 to R3 of block comparator, or \
                 pull-up R1 (10 kΩ) of the second display's divider wrong")
            .blocks(StageId::Load)
            .step(),
        manual("Connect 10 kΩ again.", &["fit resistor check 10000"]),
        routine(Routine::Wait(300)),
        routine(Routine::SelfTest),
        manual("Short the second display thermistor's input.", &["fit resistor check 0"]),
        routine(Routine::Wait(50)),
        read(
            "check-short",
            "nFAULT with the second display thermistor shorted",
            Reading::Raw(|raw| line_word(raw.fault_line)),
        )
            .words(&["low"])
            .basis("a short reads hot")
            .low("a shorted second display thermistor does not trip the comparator: hot side X3 of \
                 block comparator")
            .blocks(StageId::Load)
            .step(),
        manual("Connect 10 kΩ again.", &["fit resistor check 10000"]),
        routine(Routine::Wait(300)),
        routine(Routine::SelfTest),
        manual("Open the second display thermistor's input.", &["remove resistor check"]),
        routine(Routine::Wait(50)),
        read(
            "check-open",
            "nFAULT with the second display thermistor open",
            Reading::Raw(|raw| line_word(raw.fault_line)),
        )
            .words(&["low"])
            .basis("an open input reads cold")
            .low("an open second display thermistor does not trip the comparator: cold side X4 of \
                 block comparator")
            .blocks(StageId::Load)
            .step(),
        manual("Connect 10 kΩ again.", &["fit resistor check 10000"]),
        routine(Routine::Wait(300)),
    ],
};
