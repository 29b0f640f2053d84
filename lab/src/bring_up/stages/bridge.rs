//! The first current, through a resistor; the serial line.

use super::super::check::{ManualStep, Reading, Routine, Stage, StageId, Value};
use super::super::unit::Unit::{Ampere, Piece, Ratio, Volt};
use super::{manual, meter, read, routine};

/// The resistor in place of the tile, ohm.
const LOAD_OHM: f64 = 1.5;

pub const LOAD: Stage = Stage {
    id: StageId::Load,
    name: "load",
    title: "First current: 1.5 Ω 50 W in place of the tile",
    needs: ManualStep { say: "USB plugged in, then 12 V with a limit of 0.5 A, emergency stop released, load cell \
                 connected, 10 kΩ in place of each thermistor, nothing at the tile terminals.", lines: super::needs::ON },
    steps: &[
        manual(
            "Press the emergency stop. Connect 1.5 Ω 50 W to the tile terminals P and N, and an oscilloscope across it (two \
             probes, difference; single shot, 50 ms/div). Set the current limit to 3 A. Release the emergency stop.",
            &["press stop", "fit load 1.5", "release stop"],
        ),
        routine(Routine::Wait(500)),
        routine(Routine::SelfTest),
        meter(
            "load-voltage",
            "voltage across the load in the pulse of 200 ms",
            "scope load-volt",
            "mean of the flat part of the pulse, without its sign",
        )
            .range(0.75, 1.4, Volt)
            .basis("1.08 V for 1 A through the tile that the firmware assumes; 0.14 V for each 0.1 µs \
                 of dead time, 0.1 to 0.3 µs; 1 % of 12 V, 3 % of load and oscilloscope")
            .low("the bridge drives too little current: gate driver X3, MOSFETs M1 to M4, AND gates \
                 X1, X2 of block bridge; scope IN1, IN2 and the two legs")
            .high("the bridge drives too much current: a leg of block bridge does not switch; scope \
                 both legs")
            .blocks(StageId::Tile)
            .step(),
        meter(
            "load-ripple",
            "ripple across the load in the pulse",
            "scope load-ripple",
            "AC coupling, 97 kHz, RMS, in the flat part of the pulse",
        )
            .range(0.0, 0.2, Volt)
            .basis("bench `edges`: 0.42 A peak to peak at half duty, 0.15 A RMS; capacitors down to 5 \
                 µF each, inductors - 20 %")
            .high("the filter does not smooth the current: inductors L1, L2 (4.7 µH, XAL1010-472) or \
                 capacitors C1 (2 x 10 µF X7R) of block bridge are wrong or missing")
            .blocks(StageId::Tile)
            .step(),
        meter(
            "mirror-ripple",
            "ripple at the current input, PC2 (CN7-35)",
            "scope mirror-ripple",
            "AC coupling, 97 kHz, RMS, in the flat part of the pulse",
        )
            .range(0.0, 0.03, Volt)
            .basis("bench `current`: 0.0002 A by the phase of sampling; 0.03 A, 10 mV, are allowed; \
                 noise of the oscilloscope")
            .high("the current measurement has no filter: C1 (68 nF) with R1, R2 (10 kΩ), or C2, C3 \
                 (4.7 µF) of block mirror missing")
            .blocks(StageId::Tile)
            .step(),
        read(
            "load-result",
            "what ends the self-test with a resistor",
            Reading::SelfTest(|report| Some(Value::Word(report.result.name().into()))),
        )
            .words(&["no-response", "polarity"])
            .basis("a resistor does not cool the display; noise decides on the word")
            .low("")
            .blocks(StageId::Tile)
            .step(),
        read(
            "load-current",
            "current by the device",
            Reading::SelfTest(|report| report.cool_a.map(Value::Number)),
        )
            .range(0.43, 1.05, Ampere)
            .basis("the voltage above over 1.5 Ω; 0.05 A and 2 % of the measurement")
            .low("the measured current is too low: sense resistors R5, R6 (5 mΩ, block bridge) \
                 smaller or bridged, amplifiers X1, X2 (INA240A2, block mirror) dead, PC2 (CN7-35), \
                 or the filter of the measurement missing")
            .high("the measured current is too high: sense resistors R5, R6 (5 mΩ, block bridge) \
                 larger, or R3, R4 of block mirror wrong")
            .blocks(StageId::Tile)
            .step(),
        read(
            "mirror-ratio",
            "current by the device as a part of that through the load",
            Reading::Derived(|kept| Some(kept.get("load-current")? / (kept.get("load-voltage")? / LOAD_OHM))),
        )
        .range(0.87, 1.13, Ratio)
        .basis("bench `current`: 0.05 A and 2 % of 0.8 A, 8 %; 2 % of the load, 3 % of the \
                 oscilloscope")
        .low("the current measurement shows too little: sense resistors R5, R6 (5 mΩ, block \
                 bridge) smaller than that, R3 (15.8 kΩ) or R4 (10 kΩ) of block mirror, or its \
                 filter (C1 68 nF, C2, C3 4.7 µF) is missing")
        .high("the current measurement shows too much: sense resistors R5, R6 (5 mΩ, block bridge) \
                 larger than that, R3 (15.8 kΩ) or R4 (10 kΩ) of block mirror, or its filter (C1 68 \
                 nF, C2, C3 4.7 µF) is missing")
        .blocks(StageId::Tile)
        .step(),
    ],
};

pub const LINE: Stage = Stage {
    id: StageId::Line,
    name: "line",
    title: "Losses of the serial line",
    needs: ManualStep {
        say: "USB plugged in, then 12 V with a limit of 0.2 A, emergency stop pressed.",
        lines: &["press stop", "fit usb", "fit supply"],
    },
    steps: &[
        routine(Routine::SerialLine(10_000)),
        read("lines", "telemetry lines in 10 s", Reading::Kept)
            .range(9900.0, 10_100.0, Piece)
            .basis("one a millisecond")
            .finding("not all telemetry arrives: the virtual COM port or the USB isolator loses data; try \
                 another USB port, a shorter cable, or `stream 10`")
            .step(),
        read("lines-lost", "telemetry lines lost, by their ticks", Reading::Kept)
            .range(0.0, 0.0, Piece)
            .basis("none")
            .high("the serial line loses lines: the virtual COM port or the USB isolator does not \
                 carry 1 Mbaud; try another USB port, a shorter cable, or `stream 10`")
            .step(),
        read("lines-damaged", "lines damaged, by their checksums", Reading::Kept)
            .range(0.0, 0.0, Piece)
            .basis("none")
            .high("the serial line damages lines: the virtual COM port or the USB isolator does not \
                 carry 1 Mbaud, or ground is missing between probe and board")
            .step(),
        read(
            "receive-errors",
            "bytes that the device has received with errors",
            Reading::Board(|board| Value::Number(f64::from(board.rx_overruns + board.rx_framing + board.rx_noise))),
        )
            .range(0.0, 0.0, Piece)
            .basis("none since its reset")
            .high("the device has received damaged bytes: PA3 between probe and microcontroller (SB13, \
                 SB14 closed, SB62, SB63 open), or the clock is not 8 MHz")
            .step(),
        read(
            "transmit-drops",
            "lines that the device has dropped",
            Reading::Board(|board| Value::Number(f64::from(board.tx_dropped))),
        )
            .range(0.0, 0.0, Piece)
            .basis("none since its reset")
            .high("the device has dropped lines because its line was full: not the firmware of this \
                 repository, or a baud rate below 1 Mbaud")
            .step(),
    ],
};
