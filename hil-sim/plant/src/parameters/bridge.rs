//! Parameters of the power stage.

use super::Source::{ClassValue, Design, Netlist, Recalled};
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{FIXED, absolute, between, relative};
use crate::bridge::BridgeParams;

pub fn entries(bridge: &mut BridgeParams) -> impl Iterator<Item = Entry<'_>> {
    let BridgeParams {
        supply_v,
        pwm_hz,
        dead_time_s,
        diode_v,
        on_ohm,
        filter_h,
        filter_ohm,
        filter_f,
        filter_esr_ohm,
        trip_a,
        retry_s,
    } = bridge;
    let all = [
        entry!(supply_v, "V", "supply", relative(0.05), (1.0, 40.0), Design,),
        entry!(pwm_hz, "Hz", "PWM frequency", FIXED, (1e3, 1e6), Design,),
        entry!(
            dead_time_s,
            "s",
            "effective time for which both MOSFETs of a leg are off at an edge",
            between(0.1e-6, 0.3e-6),
            (0.0, 1e-5),
            Netlist,
        ),
        entry!(
            diode_v,
            "V",
            "forward voltage of the body diodes",
            absolute(0.2),
            (0.0, 2.0),
            Recalled,
        ),
        entry!(
            on_ohm,
            "ohm",
            "MOSFETs that conduct, sense resistor, leads to the tile",
            between(0.025, 0.08),
            (0.0, 10.0),
            Netlist,
        ),
        entry!(
            filter_h,
            "H",
            "filter inductors of both legs",
            relative(0.2),
            (1e-7, 1e-2),
            Netlist,
        ),
        entry!(
            filter_ohm,
            "ohm",
            "resistance of the inductors",
            relative(0.5),
            (0.0, 10.0),
            Netlist,
        ),
        entry!(
            filter_f,
            "F",
            "filter capacitor; low under bias",
            between(5e-6, 12e-6),
            (0.0, 1e-2),
            Design,
        ),
        entry!(
            filter_esr_ohm,
            "ohm",
            "series resistance of the capacitor",
            between(0.0, 0.02),
            (0.0, 10.0),
            ClassValue,
        ),
        entry!(
            trip_a,
            "A",
            "current at which a switch counts as overloaded",
            between(24.0, 50.0),
            (0.1, 100.0),
            Netlist,
        ),
        entry!(
            retry_s,
            "s",
            "time after which an overloaded driver tries again",
            relative(0.5),
            (0.0, 1.0),
            Recalled,
        ),
    ];
    prefixed("bridge", all)
}
