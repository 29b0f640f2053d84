//! Tile, sink and thermistors; commissioning; a run without a finger.

use thermal_client::client::SelfTestReport;

use super::super::check::{ManualStep, Reading, Routine, Stage, StageId, Step, Value};
use super::super::unit::Unit::{Ampere, Celsius, Kelvin, Millisecond, Ratio, Volt};
use super::{manual, read, routine};

/// Current of a pulse of the self-test.
const fn pulse(
    name: &'static str,
    what: &'static str,
    reading: fn(&SelfTestReport) -> Option<Value>,
    low: &'static str,
) -> Step {
    read(name, what, Reading::SelfTest(reading))
        .range(0.6, 1.5, Ampere)
        .basis("1 A by class values: tile ± 20 %, dead time, 12 V ± 5 %, mirror 0.05 A and 2 %")
        .low(low)
        .high(
            "too much current: the tile is another one than the 6 A, 8.2 V class, partly \
                 shorted, or the mirror is wrong",
        )
        .blocks(StageId::Commissioning)
        .step()
}

/// Response of a display thermistor to the cooling pulse.
const fn response(
    name: &'static str,
    what: &'static str,
    reading: fn(&SelfTestReport) -> Option<Value>,
    finding: &'static str,
) -> Step {
    read(name, what, Reading::SelfTest(reading))
        .range(0.05, 1.5, Kelvin)
        .basis("the firmware's own limits; 0.54 K for the class")
        .low(finding)
        .high("the display cools too much: a lighter plate, or a thermistor off its place")
        .blocks(StageId::Commissioning)
        .step()
}

/// A thermistor, at this input, against the reference thermometer at rest.
macro_rules! at_rest {
    ($name:literal, $thermistor:literal, $input:literal) => {
        read($name, concat!($thermistor, " less reference"), Reading::Kept)
            .range(-1.2, 1.2, Kelvin)
            .basis("what calibration corrects: 1.2 K; 1 % of thermistor and beta are 0.4 K")
            .finding(concat!(
                "the ",
                $thermistor,
                " (",
                $input,
                ") reads another temperature than the reference thermometer at its place: a 10 kΩ \
             thermistor of beta 3950 K? In its place? Wires swapped?"
            ))
            .blocks(StageId::Commissioning)
            .step()
    };
}

/// A display thermistor against the reference thermometer away from 25 °C.
const fn held(name: &'static str, what: &'static str, finding: &'static str) -> Step {
    read(name, what, Reading::Kept)
        .range(-0.9, 0.9, Kelvin)
        .basis(
            "1 % of thermistor (0.25 K) and beta (0.15 K), 5 counts of the converter (0.1 K), \
                 lead errors (0.1 K), thermometer (0.3 K)",
        )
        .finding(finding)
        .blocks(StageId::Commissioning)
        .step()
}

pub const TILE: Stage = Stage {
    id: StageId::Tile,
    name: "tile",
    title: "Tile, sink and thermistors; no finger",
    needs: ManualStep {
        say: "USB plugged in, then 12 V, emergency stop pressed, load cell connected, 10 kΩ in \
                 place of each thermistor.",
        lines: super::needs::COLD,
    },
    steps: &[
        manual(
            "Press the emergency stop. Remove the load; connect the tile (P to its plus), on the sink with thermal paste, fan \
             on. Connect the five thermistors in place of the resistors: two in the display's plate, one on the sink, one for \
             the skin and one for the room in the air. Replace the laboratory supply by the 12 V supply of the device. Keep \
             your fingers off. Release the emergency stop.",
            &["press stop", "remove load", "fit tile", "fit thermistors", "release stop"],
        ),
        routine(Routine::Wait(3000)),
        routine(Routine::Thermistors),
        at_rest!("display-at-rest", "display thermistor", "PA0, A0"),
        at_rest!("check-at-rest", "second display thermistor", "PA1, A1"),
        at_rest!("sink-at-rest", "sink thermistor", "PA4, A2"),
        at_rest!("skin-at-rest", "skin thermistor", "PB0, A3"),
        at_rest!("room-at-rest", "room thermistor", "PC1, A4"),
        routine(Routine::SelfTest),
        pulse(
            "cool-current",
            "current of the cooling pulse",
            |report| report.cool_a.map(Value::Number),
            "too little current through the tile: its wires, its resistance (1.1 Ω), the 12 V \
                 supply",
        ),
        response(
            "display-response",
            "fall of the display thermistor by the cooling pulse",
            |report| report.display_k.map(Value::Number),
            "the display does not cool when it should: the tile's wires P and N are swapped \
                 (reversed tile), or the display thermistor is off the plate",
        ),
        response(
            "check-response",
            "fall of the second display thermistor by the cooling pulse",
            |report| report.check_k.map(Value::Number),
            "the second display thermistor does not cool when the tile cools: the tile's wires P \
                 and N are swapped (reversed tile), or this thermistor is off the plate",
        ),
        pulse(
            "warm-current",
            "current of the warming pulse",
            |report| report.warm_a.map(Value::Number),
            "too little current in the warming direction: leg 2 of block bridge, M3, M4, PA9 (D8)",
        ),
        read(
            "tile-result",
            "result of the self-test",
            Reading::SelfTest(|report| Some(Value::Word(report.result.name().into()))),
        )
        .words(&["passed"])
        .basis("a sound device")
        .low("")
        .blocks(StageId::Tile)
        .step(),
        routine(Routine::Hold { keep: "warm", celsius: 38.0 }),
        held(
            "warm-display",
            "display thermistor less reference, held at 38 °C",
            "the display thermistor (PA0, A0) is right at room temperature and wrong at 38 °C: a \
                 thermistor of another type (beta is not 3950 K)",
        ),
        held(
            "warm-check",
            "second display thermistor less reference, held at 38 °C",
            "the second display thermistor (PA1, A1) is right at room temperature and wrong at \
                 38 °C: a thermistor of another type (beta is not 3950 K)",
        ),
        routine(Routine::Hold { keep: "cold", celsius: 20.0 }),
        held(
            "cold-display",
            "display thermistor less reference, held at 20 °C",
            "the display thermistor (PA0, A0) is right at room temperature and wrong at 20 °C: a \
                 thermistor of another type (beta is not 3950 K)",
        ),
        held(
            "cold-check",
            "second display thermistor less reference, held at 20 °C",
            "the second display thermistor (PA1, A1) is right at room temperature and wrong at \
                 20 °C: a thermistor of another type (beta is not 3950 K)",
        ),
    ],
};

pub const COMMISSIONING: Stage = Stage {
    id: StageId::Commissioning,
    name: "commissioning",
    title: "Commissioning: calibration of the thermistors, identification of the tile",
    needs: ManualStep {
        say: "USB plugged in, then 12 V, emergency stop released, load cell, tile and thermistors \
                 connected.",
        lines: super::needs::TILE,
    },
    steps: &[
        routine(Routine::Commission),
        read(
            "calibration",
            "largest deviation at the calibration points",
            Reading::Kept,
        )
        .range(0.0, 0.02, Kelvin)
        .basis("the converter's steps and half of one at a border; 8 mK simulated")
        .high(
            "the calibration does not fit its points: a typing error, a thermometer that was not \
                 steady, or a loose thermistor; repeat it",
        )
        .blocks(StageId::Run)
        .step(),
        read(
            "phase-margin",
            "phase margin of the control loop, degrees",
            Reading::Kept,
        )
        .range(45.0, 90.0, Ratio)
        .basis("commissioning.md: 48.8 to 54.9 for nine in ten devices of the parameter box")
        .finding(
            "the tile is not like its class: plate, thermal paste, place of the display \
                 thermistor",
        )
        .blocks(StageId::Run)
        .step(),
        read(
            "gain-margin",
            "gain margin of the control loop, times",
            Reading::Kept,
        )
        .range(4.0, f64::INFINITY, Ratio)
        .basis("commissioning.md: 5.5 and more for nineteen in twenty devices of the parameter box")
        .finding(
            "the tile is not like its class: plate, thermal paste, place of the display \
                 thermistor",
        )
        .blocks(StageId::Run)
        .step(),
    ],
};

/// Distance of a held temperature from the reference.
const fn followed(name: &'static str, what: &'static str) -> Step {
    read(name, what, Reading::Kept)
        .range(-0.05, 0.05, Kelvin)
        .basis(
            "calibrated to 8.3 mK at worst (commissioning.md); 0.04 K for thermometer and \
                 draught",
        )
        .finding(
            "the display does not hold what it was told, after calibration: a loose thermistor, \
                 or a thermometer that was moved",
        )
        .step()
}

pub const RUN: Stage = Stage {
    id: StageId::Run,
    name: "run",
    title: "Warm and cold without a finger; emergency stop while driving",
    needs: ManualStep { say: "USB plugged in, then 12 V, emergency stop released, load cell, tile and thermistors \
                 connected.", lines: super::needs::TILE },
    steps: &[
        manual(
            "Put all thermistors back into their places: skin and room in the air. Let the sink come to the temperature of the \
             room.",
            &["fit thermistors"],
        ),
        routine(Routine::Wait(3000)),
        routine(Routine::SelfTest),
        routine(Routine::Hold { keep: "run-warm", celsius: 40.0 }),
        followed("run-warm-display", "display less reference, held at 40 °C"),
        routine(Routine::Hold { keep: "run-cold", celsius: 16.0 }),
        followed("run-cold-display", "display less reference, held at 16 °C"),
        read(
            "run-sink",
            "sink above the room while the display is held at 16 °C",
            Reading::Derived(|kept| kept.get("run-cold-sink").copied()),
        )
            .range(-6.0, 20.0, Kelvin)
            .basis("coolant up to 16 K above the room; 0.15 K/W, twice that at most")
            .high("the sink gets hot: fan, thermal paste, air flow")
            .step(),
        manual("Press the emergency stop now, while the display is driven.", &["press stop"]),
        routine(Routine::StopWhileDriving),
        read(
            "stop-driving",
            "time until the device has tripped by the emergency stop",
            Reading::Kept,
        )
            .range(0.0, 500.0, Millisecond)
            .basis("the device looks every millisecond; the rest is the line and this program")
            .finding("the device does not trip by the emergency stop while it drives")
            .step(),
        read("stop-current", "current after that", Reading::Kept)
            .range(0.0, 0.2, Ampere)
            .basis("none; offset of the mirror 0.05 A, bench `current`")
            .high("a current still flows after the emergency stop: switch everything off; the stop is \
                 not in the 12 V line")
            .step(),
        read(
            "stop-supply",
            "sensed bridge supply 0.3 s after that",
            Reading::Kept,
        )
        .range(0.0, 6.0, Volt)
        .basis("the driver's 7.5 mA discharge 120 µF by 60 V/s; 36 V/s with their tolerances")
        .high(
            "the bridge supply stays although the emergency stop is pressed: the stop is bridged, or its relay is welded; switch \
             everything off",
        )
        .step(),
        manual("Release the emergency stop.", &["release stop"]),
        manual(
            "This page covers what the device and a meter can show. Before a finger touches it, measure what \
             docs/before-a-finger.md lists, with a surface probe and a leakage tester, and keep the values with this page.",
            &[],
        ),
        read(
            "seen-hottest",
            "hottest reading of the display in this stage",
            Reading::Derived(|kept| kept.get("run-warm-highest").copied()),
        )
            .range(0.0, 42.0, Celsius)
            .basis("set-points end at 42 °C; the device trips at 43 °C")
            .high("the display overshoots")
            .step(),
    ],
};
