//! The sensors' and the converter's numbers.

use super::Source::{ClassValue, DataSheet, Design, Literature, Recalled, Thesis};
use super::slot::{Slot, slot, under};
use super::spread::{FIXED, Tolerance, absolute, between, factor, relative};
use crate::sensors::{
    ConverterParams, Delay, ForceParams, MirrorParams, ReferenceParams, SensorParams,
    ThermistorParams,
};

/// Lag of a thermistor on the display: literature's range for the class.
const DISPLAY_LAG: Tolerance = between(0.02, 0.5).logarithmic();
/// Of the others.
const LAG: Tolerance = factor(2.0);

pub fn slots(sensors: &mut SensorParams) -> Vec<Slot<'_>> {
    let SensorParams {
        thermistors,
        skin_sees_contact,
        force,
        mirror,
        reference,
        converter,
    } = sensors;
    let [display, check, sink, skin, room] = thermistors;
    let mut all = Vec::new();
    for (name, one, lag) in [
        ("display", display, DISPLAY_LAG),
        ("check", check, DISPLAY_LAG),
        ("sink", sink, LAG),
        ("skin", skin, LAG),
        ("room", room, LAG),
    ] {
        all.extend(under(name, thermistor(one, lag)));
    }
    all.push(slot(
        skin_sees_contact,
        "skin_sees_contact",
        "1",
        "share of the contact's skin in what the skin thermistor at its edge sees",
        between(0.0, 0.05),
        (0.0, 1.0),
        Thesis("6.4.3"),
    ));
    all.extend(under("force", self::force(force)));
    all.extend(under("mirror", self::mirror(mirror)));
    all.extend(under("reference", self::reference(reference)));
    all.extend(under("converter", self::converter(converter)));
    under("sensors", all).collect()
}

fn thermistor(thermistor: &mut ThermistorParams, lag: Tolerance) -> [Slot<'_>; 6] {
    let ThermistorParams {
        at_25c_ohm,
        beta_k,
        pull_up_ohm,
        lag_s,
        dissipation_w_k,
        lead_share,
    } = thermistor;
    [
        slot(
            at_25c_ohm,
            "at_25c_ohm",
            "ohm",
            "resistance at 25 C",
            relative(0.01).normal(),
            (100.0, 1e6),
            ClassValue,
        ),
        slot(
            beta_k,
            "beta_k",
            "K",
            "beta",
            relative(0.01).normal(),
            (1000.0, 6000.0),
            Recalled,
        ),
        slot(
            pull_up_ohm,
            "pull_up_ohm",
            "ohm",
            "resistor to the reference",
            relative(0.001).normal(),
            (100.0, 1e6),
            Design,
        ),
        slot(
            lag_s,
            "lag_s",
            "s",
            "lag behind what it sits on",
            lag,
            (1e-3, 100.0),
            Literature,
        ),
        slot(
            dissipation_w_k,
            "dissipation_w_k",
            "W/K",
            "heat that it gives to what it sits on, per kelvin",
            factor(2.0),
            (1e-5, 1.0),
            ClassValue,
        ),
        slot(
            lead_share,
            "lead_share",
            "1",
            "share of the room that its leads let in",
            relative(1.0),
            (0.0, 1.0),
            ClassValue,
        ),
    ]
}

fn force(force: &mut ForceParams) -> [Slot<'_>; 4] {
    let ForceParams {
        zero_counts,
        counts_per_n,
        lag_s,
        delay_s,
    } = force;
    [
        slot(
            zero_counts,
            "zero_counts",
            "counts",
            "level without force",
            relative(0.02),
            (0.0, 4095.0),
            Design,
        ),
        slot(
            counts_per_n,
            "counts_per_n",
            "counts/N",
            "gain",
            relative(0.02),
            (1.0, 4095.0),
            Design,
        ),
        slot(
            lag_s,
            "lag_s",
            "s",
            "lag of the amplifier",
            between(0.2e-3, 5e-3).logarithmic(),
            (1e-5, 10.0),
            ClassValue,
        ),
        slot(
            delay_s,
            "delay_s",
            "s",
            "dead time of its interface",
            FIXED,
            (0.0, Delay::LONGEST_S),
            Design,
        ),
    ]
}

fn mirror(mirror: &mut MirrorParams) -> [Slot<'_>; 3] {
    let MirrorParams {
        counts_per_a,
        gain_error,
        offset_a,
    } = mirror;
    [
        slot(
            counts_per_a,
            "counts_per_a",
            "counts/A",
            "gain",
            relative(0.01),
            (1.0, 4095.0),
            Design,
        ),
        slot(
            gain_error,
            "gain_error",
            "1",
            "error of the mirror's ratio",
            absolute(0.075),
            (-0.5, 0.5),
            Recalled,
        ),
        slot(
            offset_a,
            "offset_a",
            "A",
            "current that it shows too much",
            absolute(0.05),
            (-1.0, 1.0),
            ClassValue,
        ),
    ]
}

fn reference(reference: &mut ReferenceParams) -> [Slot<'_>; 3] {
    let ReferenceParams {
        volt,
        error,
        excitation_duty,
    } = reference;
    [
        slot(
            volt,
            "volt",
            "V",
            "reference, which feeds the dividers",
            FIXED,
            (1.0, 5.0),
            Design,
        ),
        slot(
            error,
            "error",
            "1",
            "error of the reference, seen by force and current only",
            absolute(0.02).normal(),
            (-0.5, 0.5),
            ClassValue,
        ),
        slot(
            excitation_duty,
            "excitation_duty",
            "1",
            "part of the time for which the dividers are fed",
            FIXED,
            (0.0, 1.0),
            Design,
        ),
    ]
}

/// The data sheet's total error of 2 counts typical, 5 at most, shared out.
fn converter(converter: &mut ConverterParams) -> [Slot<'_>; 4] {
    let ConverterParams {
        offset_counts,
        gain_error,
        inl_counts,
        noise_counts,
    } = converter;
    [
        slot(
            offset_counts,
            "offset_counts",
            "counts",
            "offset",
            absolute(2.0).normal(),
            (-100.0, 100.0),
            DataSheet,
        ),
        slot(
            gain_error,
            "gain_error",
            "1",
            "gain error",
            absolute(2.0 / 4096.0).normal(),
            (-0.1, 0.1),
            DataSheet,
        ),
        slot(
            inl_counts,
            "inl_counts",
            "counts",
            "bound of the integral non-linearity",
            factor(2.0),
            (0.0, 3.0),
            DataSheet,
        ),
        slot(
            noise_counts,
            "noise_counts",
            "counts",
            "standard deviation of one conversion",
            between(0.4, 1.2),
            (0.0, 50.0),
            ClassValue,
        ),
    ]
}
