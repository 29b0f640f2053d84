//! Everything unpowered and unplugged: continuity, pull-downs, short circuits.

use super::super::check::{ManualStep, Stage, StageId, Step};
use super::super::unit::Unit::Ohm;
use super::{manual, meter};

const GROUND: &str =
    "ohm meter from the point to analog ground (CN7-20); wait until the value stands still";

/// A pull-down of 4.7 kΩ: 1 % of the resistor and 4 % for a hand-held meter.
const fn pull_down_4k7(
    name: &'static str,
    what: &'static str,
    point: &'static str,
    finding: &'static str,
) -> Step {
    meter(name, what, point, GROUND)
        .range(4465.0, 4935.0, Ohm)
        .basis("4.7 kΩ, 1 % and 4 % of a hand-held meter")
        .finding(finding)
        .blocks(StageId::Supply)
        .step()
}

pub const STAGE: Stage = Stage {
    id: StageId::BareBoard,
    name: "bare-board",
    title: "Bare board: continuity, pull-downs, short circuits",
    needs: ManualStep {
        say: "Everything off and unplugged.",
        lines: &[],
    },
    steps: &[
        manual(
            "Everything off. Unplug the Nucleo's USB, the 12 V supply, the tile, all thermistors and the load cell; the \
             Nucleo stays on the boards. Release the emergency stop. Wait a minute, until the capacitors are empty.",
            &[],
        ),
        meter(
            "plate",
            "touched plate to analog ground",
            "ohm plate",
            GROUND,
        )
        .range(940.0, 1060.0, Ohm)
        .basis("leakage.cir R1, 1 kΩ; 5 % resistor, 1 % meter")
        .low(
            "the plate has a short to ground past R1 (1 kΩ, block leakage): a fault current \
                 through a person would not be limited",
        )
        .high(
            "the plate is not bonded: R1 (1 kΩ, block leakage) or its wire to analog ground is \
                 missing",
        )
        .step(),
        meter(
            "supply-to-ground",
            "12 V terminals of the power board",
            "ohm supply",
            "ohm meter from plus to minus of the 12 V connector; wait until the capacitor C1 \
                 (470 µF) is charged",
        )
        .range(1000.0, f64::INFINITY, Ohm)
        .basis("only the 5 V regulator and the driver's divider are connected")
        .low(
            "12 V is shorted to ground: look at C1 (470 µF, polarity), the TVS diode and the 5 V \
                 regulator X1 of block supply",
        )
        .blocks(StageId::Rails)
        .step(),
        meter(
            "bridge-supply-to-ground",
            "bridge supply (behind the switch M1) to ground",
            "ohm bridge-supply",
            GROUND,
        )
        .range(5000.0, 45_000.0, Ohm)
        .basis("switch.cir R9 + R10 = 43 kΩ, and what the driver takes without supply")
        .low(
            "the bridge supply is shorted: look at the MOSFETs M1 to M4 and capacitors C2, C3 of \
                 block bridge and switch",
        )
        .high("the divider of the sensed supply is open: R9 (33 kΩ) or R10 (10 kΩ) of block switch")
        .blocks(StageId::Supply)
        .step(),
        meter(
            "tile-terminals",
            "the two tile terminals P and N, without tile",
            "ohm tile",
            "ohm meter from P to N",
        )
        .range(500.0, f64::INFINITY, Ohm)
        .basis("only the capacitors C1 (2 x 10 µF) lie across them")
        .low(
            "the tile terminals P and N are shorted: look at the capacitors C1 and inductors L1, \
                 L2 of block bridge",
        )
        .blocks(StageId::Supply)
        .step(),
        pull_down_4k7(
            "in1-pull-down",
            "bridge IN1, PA8 (D7)",
            "ohm in1",
            "the pull-down R1 (4.7 kΩ, block bridge) at bridge IN1, PA8 (D7), is missing or \
                 wrong, or the pin is shorted",
        ),
        pull_down_4k7(
            "in2-pull-down",
            "bridge IN2, PA9 (D8)",
            "ohm in2",
            "the pull-down R2 (4.7 kΩ, block bridge) at bridge IN2, PA9 (D8), is missing or \
                 wrong, or the pin is shorted",
        ),
        pull_down_4k7(
            "enable-pull-down",
            "bridge enable, PB10 (D6)",
            "ohm enable",
            "the pull-down R3 (4.7 kΩ, block bridge) at bridge enable, PB10 (D6), is missing or wrong, or the pin is shorted; \
             without it the bridge can be enabled during reset",
        ),
        pull_down_4k7(
            "boot0-pull-down",
            "BOOT0, CN7-7",
            "ohm boot0",
            "the pull-down (4.7 kΩ, board preparation) at BOOT0, CN7-7, is missing or wrong; without it the ROM boot loader may \
             start, which drives PB10, PA9 and PA8",
        ),
        pull_down_4k7(
            "test-pull-down",
            "comparator test, PC3 (CN7-37)",
            "ohm test",
            "the pull-down R8 (4.7 kΩ, block comparator) at the comparator test, PC3 (CN7-37), \
                 is missing or wrong",
        ),
        meter(
            "side-pull-down",
            "side of the test, PB2 (CN10-22)",
            "ohm side",
            GROUND,
        )
        .range(3050.0, 3700.0, Ohm)
        .basis(
            "comparator.cir R9 (4.7 kΩ) beside R7 (6.34 kΩ) and R5, R6 (10 kΩ each): 3.3 to 3.4 \
                 kΩ; 1 % and 4 % of a hand-held meter",
        )
        .low("PB2 (CN10-22) is shorted, or R7 (6.34 kΩ) of block comparator is smaller")
        .high(
            "R9 (4.7 kΩ) or R7 (6.34 kΩ) of block comparator at PB2 (CN10-22) is missing or \
                 wrong",
        )
        .blocks(StageId::Supply)
        .step(),
        meter(
            "nfault-pull-up",
            "nFAULT to 3.3 V",
            "ohm nfault",
            "ohm meter from the nFAULT line (before R12 of block bridge) to 3.3 V (CN7-16)",
        )
        .range(4465.0, 4935.0, Ohm)
        .basis("bridge.cir R4, 4.7 kΩ; 1 % and 4 % of a hand-held meter")
        .finding("the pull-up R4 (4.7 kΩ, block bridge) at nFAULT is missing or wrong")
        .blocks(StageId::Supply)
        .step(),
        meter(
            "fuse",
            "fuse F1",
            "ohm fuse",
            "ohm meter across the fuse; subtract the resistance of the leads",
        )
        .range(0.0, 0.2, Ohm)
        .basis("supply.cir R2, 8 mΩ; resolution of a hand-held meter")
        .high("fuse F1 (7.5 A) is blown or not seated")
        .blocks(StageId::Rails)
        .step(),
        meter(
            "stop-released",
            "emergency stop in the 12 V line, released",
            "ohm stop",
            "ohm meter across the first contact of the emergency stop; subtract the resistance \
                 of the leads",
        )
        .range(0.0, 0.3, Ohm)
        .basis("supply.cir R4, 10 mΩ; resolution of a hand-held meter")
        .high(
            "the first contact S1 of the emergency stop does not close: button pressed, contact \
                 or wire broken",
        )
        .blocks(StageId::Supply)
        .step(),
        manual("Press the emergency stop.", &["press stop"]),
        meter(
            "stop-pressed",
            "emergency stop in the 12 V line, pressed",
            "ohm stop",
            "ohm meter across the first contact of the emergency stop",
        )
        .range(10e3, f64::INFINITY, Ohm)
        .basis("the contact is open; what lies behind it is at least the bridge supply's divider")
        .low(
            "the emergency stop does not open the 12 V line: its first contact S1 is not wired \
                 into the line, or bridged",
        )
        .blocks(StageId::Supply)
        .step(),
    ],
};
