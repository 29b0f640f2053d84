//! The power stage's numbers.

use super::Source::{ClassValue, DataSheet, Design, Recalled};
use super::slot::{Slot, slot, under};
use super::spread::{FIXED, absolute, between, relative};
use crate::bridge::BridgeParams;

pub fn slots(bridge: &mut BridgeParams) -> impl Iterator<Item = Slot<'_>> {
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
        slot(
            supply_v,
            "supply_v",
            "V",
            "supply",
            relative(0.05),
            (1.0, 40.0),
            Design,
        ),
        slot(
            pwm_hz,
            "pwm_hz",
            "Hz",
            "PWM frequency",
            FIXED,
            (1e3, 1e6),
            Design,
        ),
        slot(
            dead_time_s,
            "dead_time_s",
            "s",
            "time for which both switches of a leg are off at an edge",
            between(0.1e-6, 0.6e-6),
            (0.0, 1e-5),
            Recalled,
        ),
        slot(
            diode_v,
            "diode_v",
            "V",
            "forward voltage of the body diodes",
            absolute(0.2),
            (0.0, 2.0),
            Recalled,
        ),
        slot(
            on_ohm,
            "on_ohm",
            "ohm",
            "both switches that conduct, and the leads to the tile",
            between(0.12, 0.30),
            (0.0, 10.0),
            Recalled,
        ),
        slot(
            filter_h,
            "filter_h",
            "H",
            "filter inductor",
            relative(0.2),
            (1e-7, 1e-2),
            Design,
        ),
        slot(
            filter_ohm,
            "filter_ohm",
            "ohm",
            "resistance of the inductor",
            relative(0.5),
            (0.0, 10.0),
            ClassValue,
        ),
        slot(
            filter_f,
            "filter_f",
            "F",
            "filter capacitor; low under bias",
            between(5e-6, 12e-6),
            (0.0, 1e-2),
            Design,
        ),
        slot(
            filter_esr_ohm,
            "filter_esr_ohm",
            "ohm",
            "series resistance of the capacitor",
            between(0.0, 0.02),
            (0.0, 10.0),
            ClassValue,
        ),
        slot(
            trip_a,
            "trip_a",
            "A",
            "current at which a switch counts as overloaded",
            between(10.0, 16.0),
            (0.1, 100.0),
            DataSheet,
        ),
        slot(
            retry_s,
            "retry_s",
            "s",
            "time after which an overloaded driver tries again",
            relative(0.5),
            (0.0, 1.0),
            Recalled,
        ),
    ];
    under("bridge", all)
}
