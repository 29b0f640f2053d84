//! Sensor inputs with known resistors in place of the thermistors; force sensor.

use super::super::check::{ManualStep, Reading, Routine, Stage, StageId, Value};
use super::super::unit::Unit::{Count, CountPerNewton};
use super::{manual, read, routine};

/// The known resistors, ohm, in the order of the converter's channels: all different, so that swapped wires show.
pub const KNOWN_OHM: [f64; 5] = [8200.0, 10e3, 12e3, 15e3, 18e3];

/// Weight of 200 g, N.
const WEIGHT_N: f64 = 0.2 * 9.80665;

pub const STAGE: Stage = Stage {
    id: StageId::Sensors,
    name: "sensors",
    title: "Sensor inputs: known resistors in place of the thermistors, load cell with a weight",
    needs: ManualStep {
        say: "USB plugged in, then 12 V with a limit of 0.2 A, emergency stop pressed.",
        lines: &["press stop", "fit usb", "fit supply"],
    },
    steps: &[
        manual(
            "Connect resistors of 1 % or better in place of the thermistors: display 8.2 kΩ, second display 10 kΩ, sink 12 kΩ, \
             skin 15 kΩ, room 18 kΩ.",
            &[
                "fit resistor display 8200",
                "fit resistor check 10000",
                "fit resistor sink 12000",
                "fit resistor skin 15000",
                "fit resistor room 18000",
            ],
        ),
        routine(Routine::Wait(100)),
        routine(Routine::KnownResistors),
        manual(
            "Connect the load cell, plate mounted, nothing on it. Connect 10 kΩ in place of each \
                 of the five thermistors.",
            &[
                "fit load-cell",
                "fit resistor display 10000",
                "fit resistor check 10000",
                "fit resistor sink 10000",
                "fit resistor skin 10000",
                "fit resistor room 10000",
            ],
        ),
        routine(Routine::Wait(500)),
        read(
            "force-zero",
            "force sensor without force",
            Reading::Raw(|raw| Value::Number(raw.force)),
        )
            .range(394.0, 426.0, Count)
            .basis("bench `force`: 410 counts ± 2 %; 2 % of the 3.3 V")
            .low("the live zero of the force sensor is too low: a broken or swapped wire of the load \
                 cell (six wires), R3 (97.6 kΩ) or R4 (10 kΩ) of block force")
            .high("the live zero of the force sensor is too high: preload on the plate, swapped signal \
                 wires P and N of the load cell under preload, R3 (97.6 kΩ) or R4 (10 kΩ) of block \
                 force")
            .step(),
        manual(
            "Put a weight of 200 g (± 1 g) onto the middle of the plate.",
            &["fit weight 1.96133"],
        ),
        routine(Routine::Wait(500)),
        read(
            "force-weight",
            "force sensor with 200 g",
            Reading::Raw(|raw| Value::Number(raw.force)),
        )
            .range(450.0, 4050.0, Count)
            .basis("more than without, and within the converter's range")
            .low("the force sensor falls or stays when force is added: the signal wires P and N of \
                 the load cell are swapped, or its gain resistor RG (137 Ω, block force) is missing")
            .high("the force sensor is at the end of its range with 200 g: gain resistor RG (137 Ω, \
                 block force) too small")
            .blocks(StageId::Tile)
            .step(),
        read(
            "force-gain",
            "gain of the force sensor",
            Reading::Derived(|kept| Some((kept.get("force-weight")? - kept.get("force-zero")?) / WEIGHT_N)),
        )
            .range(285.0, 315.0, CountPerNewton)
            .basis("bench `force`: 300 counts/N ± 2 %; 2 % of the 3.3 V, 0.5 % of the weight")
            .low("the gain of the force sensor is too low or negative: the signal wires P and N of \
                 the load cell are swapped, its excitation is missing, or RG (137 Ω, block force) is \
                 larger")
            .high("the gain of the force sensor is too high: RG (137 Ω, block force) is smaller, or \
                 the load cell is not one of 10 N with 1 mV/V or 20 N with 2 mV/V")
            .blocks(StageId::Tile)
            .step(),
        manual("Take the weight away.", &["remove weight"]),
        routine(Routine::Wait(500)),
    ],
};
