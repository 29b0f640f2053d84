//! Boards with one error of assembly, by name.

use thermal_plant::comparator::LatchDefect;
use thermal_plant::supply::SwitchDefect;

use super::Board;

/// A board with one error.
#[derive(Clone, Copy, Debug)]
pub struct BrokenBoard {
    /// Its name.
    pub name: &'static str,
    /// What is wrong.
    pub what: &'static str,
    /// Makes a sound board such a one.
    pub break_it: fn(&mut Board),
}

/// Index of the thermistors in the order of the converter's channels.
const CHECK: usize = 1;
const SINK: usize = 2;
const ROOM: usize = 4;

/// All broken boards.
pub const BROKEN_BOARDS: &[BrokenBoard] = &[
    BrokenBoard {
        name: "swapped-wires",
        what: "the wires of the sink's and the room's thermistor are swapped",
        break_it: |board| board.defects.sensors.connected.swap(SINK, ROOM),
    },
    BrokenBoard {
        name: "ladder-resistor",
        what: "the top resistor of the comparator's ladder is 3.9 kohm in place of 3.4 kohm",
        break_it: |board| board.wiring.ladder_ohm[0] = 3900.0,
    },
    BrokenBoard {
        name: "divider-resistor",
        what: "the pull-up of the sink's thermistor is 12 kohm in place of 10 kohm",
        break_it: |board| board.params.sensors.thermistors[SINK].pull_up_ohm = 12e3,
    },
    BrokenBoard {
        name: "missing-pull-down",
        what: "the pull-down of bridge enable is missing",
        break_it: |board| board.wiring.enable_ohm = f64::INFINITY,
    },
    BrokenBoard {
        name: "dead-comparator",
        what: "both sides of the comparator never conduct",
        break_it: |board| {
            let comparator = &mut board.defects.comparator;
            (comparator.hot_dead, comparator.cold_dead) = (true, true);
        },
    },
    BrokenBoard {
        name: "dead-cold-side",
        what: "the cold side of the comparator never conducts",
        break_it: |board| board.defects.comparator.cold_dead = true,
    },
    BrokenBoard {
        name: "side-stuck",
        what: "PB2, which selects the side of the comparator's test, stays low: the output of the microcontroller is destroyed",
        break_it: |board| board.defects.comparator.side_stuck = Some(false),
    },
    BrokenBoard {
        name: "latch-not-set",
        what: "the latch of the comparator is never set",
        break_it: |board| board.defects.comparator.latch = LatchDefect::StuckClear,
    },
    BrokenBoard {
        name: "reset-not-latched",
        what: "the microcontroller's reset line does not set the comparator's latch",
        break_it: |board| board.reset_is_unconnected = true,
    },
    BrokenBoard {
        name: "shorted-switch",
        what: "the high-side switch of the bridge supply is shorted",
        break_it: |board| board.defects.supply.switch = SwitchDefect::Shorted,
    },
    BrokenBoard {
        name: "open-switch",
        what: "the high-side switch of the bridge supply never closes",
        break_it: |board| board.defects.supply.switch = SwitchDefect::Open,
    },
    BrokenBoard {
        name: "missing-bleeder",
        what: "the bleeder of the bridge supply is missing",
        break_it: |board| board.params.supply.bleeder_ohm = 1e6,
    },
    BrokenBoard {
        name: "wrong-inductors",
        what: "the filter has inductors of 0.47 uH in place of 4.7 uH",
        break_it: |board| board.params.bridge.filter_h /= 10.0,
    },
    BrokenBoard {
        name: "reversed-tile",
        what: "the tile's wires are swapped",
        break_it: |board| board.defects.bridge.swapped = true,
    },
    BrokenBoard {
        name: "brown-out-not-set",
        what: "the option bytes are those of the factory: no brown-out level",
        break_it: |board| board.chip.brown_out_code = 3,
    },
    BrokenBoard {
        name: "mirror-without-rc",
        what: "the filters of the current measurement are missing",
        break_it: |board| board.params.sensors.mirror.lag_s = 0.0,
    },
    BrokenBoard {
        name: "other-thermistor",
        what: "the second display thermistor has a beta of 3435 K in place of 3950 K",
        break_it: |board| board.params.sensors.thermistors[CHECK].beta_k = 3435.0,
    },
    BrokenBoard {
        name: "stop-bypassed",
        what: "the emergency stop is not in the 12 V line",
        break_it: |board| board.stop_is_bypassed = true,
    },
    BrokenBoard {
        name: "stop-sense-open",
        what: "the sense wire of the emergency stop is not connected",
        break_it: |board| board.defects.supply.stop_sense_open = true,
    },
    BrokenBoard {
        name: "no-usb-clock",
        what: "the probe's clock does not reach the microcontroller (SB50 open)",
        break_it: |board| board.chip.external_clock = false,
    },
    BrokenBoard {
        name: "force-wires-swapped",
        what: "the signal wires of the load cell are swapped",
        break_it: |board| board.force_is_reversed = true,
    },
    BrokenBoard {
        name: "sense-resistors",
        what: "the sense resistors of the bridge are 10 mohm in place of 5 mohm",
        break_it: |board| board.params.sensors.mirror.counts_per_a *= 2.0,
    },
    BrokenBoard {
        name: "lossy-line",
        what: "the serial line loses one byte in 5000",
        break_it: |board| board.lost_bytes_interval = Some(5000),
    },
    BrokenBoard {
        name: "plate-not-bonded",
        what: "the plate is not connected to analog ground",
        break_it: |board| board.wiring.plate_ohm = f64::INFINITY,
    },
];
