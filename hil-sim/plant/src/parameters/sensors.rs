//! Parameters of sensors and converter.

use super::Source::{
    ClassValue, DataSheet, Design, Estimate, Literature, Netlist, Recalled, Thesis,
};
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{FIXED, Tolerance, absolute, between, factor, relative};
use crate::sensors::{
    ConverterParams, Delay, ForceCellParams, ForceParams, MirrorParams, ReferenceParams,
    SensorParams, ThermistorParams,
};

/// Time constant of a thermistor on the display: range in the literature for such thermistors.
const DISPLAY_LAG: Tolerance = between(0.02, 0.5).logarithmic();
/// Share of the contact at the skin thermistor: from a few millimetres beside the contact (section 6.4.3) to its perimeter
/// (sections 3.2 and 4.4).
const SEES_CONTACT: Tolerance = between(0.002, 0.35).logarithmic();
/// Time constant of the other thermistors.
const LAG: Tolerance = factor(2.0);

pub fn entries(sensors: &mut SensorParams) -> Vec<Entry<'_>> {
    let SensorParams {
        thermistors,
        divider_lag_s,
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
        all.extend(prefixed(name, thermistor(one, lag)));
    }
    all.push(entry!(
        divider_lag_s,
        "s",
        "lag of the filters between the dividers and the converter",
        relative(0.15),
        (0.0, 1.0),
        Netlist,
    ));
    all.push(entry!(
        skin_sees_contact,
        "1",
        "share of the contact's skin in what the skin thermistor at its edge sees",
        SEES_CONTACT,
        (0.0, 1.0),
        Thesis("6.4.3; 3.2 and 4.4 on the perimeter, 0.22 to 0.32"),
    ));
    all.extend(prefixed("force", self::force(force)));
    all.extend(prefixed("mirror", self::mirror(mirror)));
    all.extend(prefixed("reference", self::reference(reference)));
    all.extend(prefixed("converter", self::converter(converter)));
    prefixed("sensors", all).collect()
}

fn thermistor(thermistor: &mut ThermistorParams, lag: Tolerance) -> [Entry<'_>; 6] {
    let ThermistorParams { at_25c_ohm, beta_k, pull_up_ohm, lag_s, dissipation_w_k, lead_share } =
        thermistor;
    [
        entry!(
            at_25c_ohm,
            "ohm",
            "resistance at 25 C",
            relative(0.01).normal(),
            (100.0, 1e6),
            ClassValue,
        ),
        entry!(beta_k, "K", "beta", relative(0.01).normal(), (1000.0, 6000.0), Recalled,),
        entry!(
            pull_up_ohm,
            "ohm",
            "resistor to the reference",
            relative(0.001).normal(),
            (100.0, 1e6),
            Design,
        ),
        entry!(lag_s, "s", "lag behind what it sits on", lag, (1e-3, 100.0), Literature,),
        entry!(
            dissipation_w_k,
            "W/K",
            "heat that it gives to what it sits on, per kelvin",
            factor(2.0),
            (1e-5, 1.0),
            ClassValue,
        ),
        entry!(
            lead_share,
            "1",
            "share of the room that its leads let in",
            relative(1.0),
            (0.0, 1.0),
            ClassValue,
        ),
    ]
}

fn force(force: &mut ForceParams) -> Vec<Entry<'_>> {
    let ForceParams { zero_counts, counts_per_n, lag_s, delay_s, cell } = force;
    let mut all = vec![
        entry!(zero_counts, "counts", "level without force", relative(0.02), (0.0, 4095.0), Design,),
        entry!(counts_per_n, "counts/N", "gain", relative(0.02), (1.0, 4095.0), Design,),
        entry!(
            lag_s,
            "s",
            "lag of the amplifier",
            between(0.2e-3, 5e-3).logarithmic(),
            (1e-5, 10.0),
            ClassValue,
        ),
        entry!(delay_s, "s", "dead time of its interface", FIXED, (0.0, Delay::MAX_S), Design,),
    ];
    all.extend(prefixed("cell", force_cell(cell)));
    all
}

fn force_cell(cell: &mut ForceCellParams) -> [Entry<'_>; 7] {
    let ForceCellParams {
        mass_kg,
        compliance_m_n,
        damping,
        vibration_n,
        vibration_hz,
        drift_n_s,
        drift_max_n,
    } = cell;
    [
        entry!(
            mass_kg,
            "kg",
            "mass of plate, module, sink and fan, which rest on the cell",
            relative(0.1),
            (0.01, 10.0),
            Estimate("sink and fan of the reference design"),
        ),
        entry!(
            compliance_m_n,
            "m/N",
            "deflection of the load cell; 0 is rigid. 1.27e-6 resonates at 200 Hz under 0.5 kg, 3e-5 at 41 Hz",
            between(0.0, 1.27e-6),
            (0.0, 1e-3),
            ClassValue,
        ),
        entry!(
            damping,
            "1",
            "damping of its resonance, relative to the critical one",
            factor(2.0),
            (1e-3, 0.9),
            Estimate("an undamped metal structure"),
        ),
        entry!(
            vibration_n,
            "N",
            "amplitude of the fan's vibration in the cell's force",
            between(0.0, 2e-3),
            (0.0, 1.0),
            Estimate(
                "a fan beside the stack; a rotor of 20 g of class G6.3 on it gives 0.04 N at 50 Hz"
            ),
        ),
        entry!(
            vibration_hz,
            "Hz",
            "frequency of that vibration",
            between(30.0, 200.0).logarithmic(),
            (1.0, 500.0),
            Estimate("fans of 1800 to 12000 revolutions a minute"),
        ),
        entry!(
            drift_n_s,
            "N/s",
            "drift of the cell's zero by warming and creep",
            between(-1e-4, 1e-4),
            (-0.1, 0.1),
            ClassValue,
        ),
        entry!(drift_max_n, "N", "where that drift ends", FIXED, (0.0, 10.0), ClassValue,),
    ]
}

fn mirror(mirror: &mut MirrorParams) -> [Entry<'_>; 6] {
    let MirrorParams { counts_per_a, gain_error, offset_a, lag_s, sampling_phase, phase_step } =
        mirror;
    [
        entry!(counts_per_a, "counts/A", "gain", relative(0.01), (1.0, 4095.0), Design,),
        entry!(
            gain_error,
            "1",
            "error of sense resistors and amplifiers",
            absolute(0.02),
            (-0.5, 0.5),
            Netlist,
        ),
        entry!(
            offset_a,
            "A",
            "current that it shows too much",
            absolute(0.05),
            (-1.0, 1.0),
            ClassValue,
        ),
        entry!(
            lag_s,
            "s",
            "lag of the current measurement's filters; 0 without them",
            relative(0.2),
            (0.0, 1.0),
            Netlist,
        ),
        entry!(
            sampling_phase,
            "1",
            "phase of the PWM period at which the first scan of a step samples the current",
            FIXED,
            (0.0, 1.0),
            Design,
        ),
        entry!(
            phase_step,
            "1",
            "change of that phase from scan to scan, periods",
            FIXED,
            (0.0, 1.0),
            Design,
        ),
    ]
}

fn reference(reference: &mut ReferenceParams) -> [Entry<'_>; 3] {
    let ReferenceParams { volt, error, excitation_duty } = reference;
    [
        entry!(volt, "V", "reference, which feeds the dividers", FIXED, (1.0, 5.0), Design,),
        entry!(
            error,
            "1",
            "error of the reference, seen by force and current only",
            absolute(0.02).normal(),
            (-0.5, 0.5),
            ClassValue,
        ),
        entry!(
            excitation_duty,
            "1",
            "part of the time for which the dividers are fed",
            FIXED,
            (0.0, 1.0),
            Design,
        ),
    ]
}

/// The total error of the data sheet, 2 counts typical and 5 at most, is divided among offset, gain and INL.
fn converter(converter: &mut ConverterParams) -> [Entry<'_>; 4] {
    let ConverterParams { offset_counts, gain_error, inl_counts, noise_counts } = converter;
    [
        entry!(
            offset_counts,
            "counts",
            "offset",
            absolute(2.0).normal(),
            (-100.0, 100.0),
            DataSheet,
        ),
        entry!(
            gain_error,
            "1",
            "gain error",
            absolute(2.0 / 4096.0).normal(),
            (-0.1, 0.1),
            DataSheet,
        ),
        entry!(
            inl_counts,
            "counts",
            "bound of the integral non-linearity",
            factor(2.0),
            (0.0, 3.0),
            DataSheet,
        ),
        entry!(
            noise_counts,
            "counts",
            "standard deviation of one conversion",
            between(0.4, 1.2),
            (0.0, 50.0),
            ClassValue,
        ),
    ]
}
