//! Parameters of the power stage.

use super::Source::{ClassValue, DataSheet, Design, Recalled};
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
            "time for which both switches of a leg are off at an edge",
            between(0.1e-6, 0.6e-6),
            (0.0, 1e-5),
            Recalled,
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
            "both switches that conduct, and the leads to the tile",
            between(0.12, 0.30),
            (0.0, 10.0),
            Recalled,
        ),
        entry!(
            filter_h,
            "H",
            "filter inductor",
            relative(0.2),
            (1e-7, 1e-2),
            Design,
        ),
        entry!(
            filter_ohm,
            "ohm",
            "resistance of the inductor",
            relative(0.5),
            (0.0, 10.0),
            ClassValue,
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
            between(10.0, 16.0),
            (0.1, 100.0),
            DataSheet,
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
