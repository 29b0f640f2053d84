//! Parameters of the plant: a row for each.
//!
//! A row has the field of its part, the unit, the tolerance, the least and the largest allowed value, what the parameter is, and the
//! source of nominal value and tolerance. The nominal value is that of the part. A row with `=>` is a field that has parameters of
//! its own. The order is that of the list which `hil-sim parameters` prints; draws do not depend on it.

use contact_model::material::Surface;

use super::Source::{
    ClassValue, DataSheet, Design, Estimate, Literature, Netlist, Recalled, Thesis,
};
use super::entry::{Entry, parameters};
use super::tolerance::{FIXED, Tolerance, absolute, between, factor, relative};
use crate::HostParams;
use crate::bridge::BridgeParams;
use crate::comparator::ComparatorParams;
use crate::contact::ContactLaw;
use crate::finger::{FingerParams, Vessels};
use crate::sensors::{
    ConverterParams, Delay, FluxParams, ForceCellParams, ForceParams, MirrorParams,
    ReferenceParams, SensorParams, THERMISTORS, ThermistorParams,
};
use crate::slab::{Layer, Medium};
use crate::supply::SupplyParams;
use crate::tile::TileParams;

/// Name of the contact, whose parameters are drawn apart from the others ([`draw_contact`](super::draw_contact)).
pub const CONTACT: &str = "contact";
/// Name of the finger's surface.
pub const SKIN: &str = "skin";

/// Time constant of a thermistor on the display: range in the literature for such thermistors.
const DISPLAY_LAG: Tolerance = between(0.02, 0.5).logarithmic();
/// Time constant of the other thermistors.
const LAG: Tolerance = factor(2.0);

/// Names of the thermistors, and tolerances of their lag.
const THERMISTOR_LAGS: [(&str, Tolerance); THERMISTORS] =
    [("display", DISPLAY_LAG), ("check", DISPLAY_LAG), ("sink", LAG), ("skin", LAG), ("room", LAG)];

parameters! {
    fn finger(FingerParams) named "finger" {
        surface => skin(surface);
        resistance_factor: "1",        FIXED,         (0.01, 100.0),        "factor on its contact resistance, on display and object alike; finger.draw draws it",
            Estimate("0.5 to 2 between people and moist and dry skin");
        layers => layers.iter_mut().enumerate().flat_map(|(i, one)| layer(one, &format!("finger.layer.{i}")));
        core_w_m2k:        "W/(m2 K)", FIXED,         (0.0, f64::INFINITY), "conductance from the deepest layer to the core; inf: it has the core's temperature", ClassValue;
        air_w_m2k:         "W/(m2 K)", relative(0.5), (0.0, 1000.0),        "film of air on lifted surfaces of finger and object, radiation included", ClassValue;
        vessels => vessels.iter_mut().flat_map(self::vessels);
    }
    /// Conductivity from the spread of its effusivity between people, roughness and slope between the sexes.
    fn skin(Surface) named SKIN {
        conductivity_w_mk: "W/(m K)", relative(0.1),         (0.01, 3000.0), "conductivity in the contact (Eq. 6-9)", Thesis("2.1 and Table 6-1");
        roughness_um:      "um",      between(20.23, 23.15), (1e-3, 200.0),  "RMS roughness", Thesis("2.1 and Table 6-1");
        slope_rad:         "rad",     between(0.28, 0.32),   (1e-3, 1.5),    "mean asperity slope", Thesis("2.1 and Table 6-1");
    }
    /// The tolerances are those of the nominal layers, rounded, and apply to any tissue.
    fn layer(Layer, name: &str) named name {
        thickness_m: "m", relative(0.23), (1e-5, 10.0) or_infinite, "thickness; inf: endless, for the last layer", ClassValue;
        medium => tissue(medium, name);
    }
    fn tissue(Medium, name: &str) named name {
        conductivity_w_mk: "W/(m K)",  relative(0.1), (0.01, 500.0), "conductivity", Literature;
        capacity_j_m3k:    "J/(m3 K)", relative(0.1), (1e4, 1e7),    "heat capacity of a volume", Literature;
        perfusion_w_m3k:   "W/(m3 K)", factor(4.0),   (0.0, 1e6),    "perfusion in 1/s times 4e6 J/(m3 K) of blood", ClassValue;
        metabolism_w_m3:   "W/m3",     relative(0.5), (0.0, 1e5),    "heat of metabolism", ClassValue;
    }
    fn vessels(Vessels) named "finger.vessels" {
        open_n: "N", relative(0.2), (0.0, 100.0), "force up to which blood flows in full", Thesis("6.4.3");
        shut_n: "N", relative(0.2), (0.0, 100.0), "force from which no blood flows", Thesis("6.4.3");
    }
    /// Section 6.3 gives only a combination of the three values.
    fn display(Surface) named "display" {
        conductivity_w_mk: "W/(m K)", relative(0.1), (0.01, 3000.0), "conductivity in the contact (Eq. 6-9)", ClassValue;
        roughness_um:      "um",      relative(0.1), (1e-3, 200.0),  "RMS roughness", ClassValue;
        slope_rad:         "rad",     relative(0.1), (1e-3, 1.5),    "mean asperity slope", ClassValue;
    }
    /// The thesis has one value of each and no spread; it finds that Eq. 6-8 underestimates the fall of the skin's temperature below
    /// 3 kPa.
    fn contact(ContactLaw) named CONTACT {
        gap_w_m2k:   "W/(m2 K)", between(0.0, 1000.0), (0.0, 1e5), "conductance of air and sweat in the gap, parallel to Eq. 6-8",
            Estimate("none in thesis 6.1; 26 um of air, or sweat in part of the 60 um of a ridge's depth, have 1000");
        hardness_pa: "Pa",       factor(2.0),          (1e3, 1e8), "microhardness of the skin in Eq. 6-8",
            Estimate("value of thesis 6.1; skin softens with moisture, and a factor of 2 is that of the resistance between people");
        exponent:    "1",        between(0.85, 1.0),   (0.3, 1.5), "exponent of pressure over microhardness in Eq. 6-8",
            Estimate("value of thesis 6.1, for metals that yield; 0.94 for elastic spots, and other correlations from 0.85 to 1, recalled");
        area_factor: "1",        relative(0.2),        (0.2, 5.0), "factor on the contact area of section 6.4.2, on which the pressure acts",
            Estimate("area of thesis 6.4.2; size of fingertips between people, and where the edge of a contact is drawn");
    }
    /// Module and heat capacities have tolerances of 10 %, since no data sheet of the thesis's module was found; the range of the coolant
    /// gives sink temperatures of 20 to 40 deg C in a room of 24 deg C.
    fn tile(TileParams) named "tile" {
        imax_a:        "A",        relative(0.1),       (0.5, 30.0),      "current of the largest temperature difference", ClassValue;
        vmax_v:        "V",        relative(0.1),       (0.5, 60.0),      "voltage at that current and difference", ClassValue;
        dtmax_k:       "K",        relative(0.1),       (20.0, 90.0),     "largest temperature difference", ClassValue;
        qmax_w:        "W",        FIXED,               (0.1, 500.0),     "largest heat pumped, as the data sheet has it; the plant follows from the other three", ClassValue;
        sheet_hot_c:   "C",        FIXED,               (0.0, 100.0),     "temperature of the hot side in the data sheet", ClassValue;
        variation:     "1",        FIXED,               (0.0, 1.0),       "variation of the legs' properties with temperature: 1 that of bismuth telluride, 0 none", Literature;
        legs_j_k:      "J/K",      relative(0.1),       (0.01, 100.0),    "heat capacity of the legs", ClassValue;
        tabs_j_k:      "J/K",      relative(0.1),       (0.01, 100.0),    "heat capacity of one side's copper tabs", ClassValue;
        plate_m:       "m",        relative(0.01),      (0.016, 0.2),     "edge of the square plates", ClassValue;
        ceramic_m:     "m",        relative(0.1),       (1e-4, 0.01),     "thickness of one plate", ClassValue;
        ceramic_w_mk:  "W/(m K)",  relative(0.15),      (0.5, 500.0),     "conductivity of the plates", ClassValue;
        ceramic_j_m3k: "J/(m3 K)", relative(0.1),       (5e5, 1e7),       "heat capacity of the plates", ClassValue;
        patch_m2:      "m2",       FIXED,               (182.1e-6, 0.01), "part of the display plate that a finger can touch", Thesis("6.4.2");
        film_w_m2k:    "W/(m2 K)", relative(0.5),       (0.0, 1000.0),    "film of air on the display plate, radiation included", ClassValue;
        paste_w_k:     "W/K",      factor(2.0),         (0.1, 1e4),       "conductance from the hot plate to the sink", ClassValue;
        sink_j_k:      "J/K",      relative(0.1),       (1.0, 1e5),       "heat capacity of the sink", ClassValue;
        sink_k_w:      "K/W",      factor(2.0),         (0.001, 100.0),   "from the sink to what cools it", ClassValue;
        coolant_k:     "K",        between(-4.0, 16.0), (-40.0, 60.0),    "coolant above the room: a fan has 0, a chiller less, a warm case more", ClassValue;
    }
    fn bridge(BridgeParams) named "bridge" {
        supply_v:       "V",   relative(0.05),          (1.0, 40.0),  "supply", Design;
        pwm_hz:         "Hz",  FIXED,                   (1e3, 1e6),   "PWM frequency", Design;
        dead_time_s:    "s",   between(0.1e-6, 0.3e-6), (0.0, 1e-5),  "effective time for which both MOSFETs of a leg are off at an edge", Netlist;
        diode_v:        "V",   absolute(0.2),           (0.0, 2.0),   "forward voltage of the body diodes", Recalled;
        on_ohm:         "ohm", between(0.025, 0.08),    (0.0, 10.0),  "MOSFETs that conduct, sense resistor, leads to the tile", Netlist;
        filter_h:       "H",   relative(0.2),           (1e-7, 1e-2), "filter inductors of both legs", Netlist;
        filter_ohm:     "ohm", relative(0.5),           (0.0, 10.0),  "resistance of the inductors", Netlist;
        filter_f:       "F",   between(5e-6, 12e-6),    (0.0, 1e-2),  "filter capacitor; low under bias", Design;
        filter_esr_ohm: "ohm", between(0.0, 0.02),      (0.0, 10.0),  "series resistance of the capacitor", ClassValue;
        trip_a:         "A",   between(24.0, 50.0),     (0.1, 100.0), "current at which a switch counts as overloaded", Netlist;
        retry_s:        "s",   relative(0.5),           (0.0, 1.0),   "time after which an overloaded driver tries again", Recalled;
    }
    /// The tolerances are those of the circuit, without the thermistor's.
    fn comparator(ComparatorParams) named "comparator" {
        cold_c:      "C", absolute(0.5),         (-40.0, 25.0), "below this, by a nominal thermistor, the comparator cuts the bridge supply", Netlist;
        hot_c:       "C", absolute(0.5),         (30.0, 100.0), "above this, by a nominal thermistor, it does so too", Netlist;
        cold_test_c: "C", absolute(0.5),         (-40.0, 25.0), "input in the test of the cold side, by a nominal thermistor", Design;
        hot_test_c:  "C", absolute(0.5),         (30.0, 100.0), "input in the test of the hot side", Design;
        release_s:   "s", between(2.7e-3, 7e-3), (0.0, 1.0),    "time from the end of a test until the latch is cleared", Netlist;
    }
    fn supply(SupplyParams) named "supply" {
        source_ohm:         "ohm",      between(0.03, 0.1), (0.0, 10.0),   "power supply, fuse, contacts, switch and leads", ClassValue;
        node_f:             "F",        relative(0.2),      (1e-7, 1e-1),  "capacitors behind the switch", Design;
        bleeder_ohm:        "ohm",      relative(0.05),     (1.0, 1e6),    "bleeder, connected while the latch is set", Design;
        driver_a:           "A",        relative(0.3),      (0.0, 1.0),    "current of the bridge's driver", Recalled;
        soft_start_v_s:     "V/s",      relative(0.3),      (1.0, 1e6),    "rise of the voltage when the switch closes", Netlist;
        driver_from_v:      "V",        between(5.0, 5.5),  (0.0, 12.0),   "voltage below which the driver turns its outputs off", Recalled;
        sense_counts_per_v: "counts/V", relative(0.002),    (1.0, 4095.0), "gain of the sense divider", Design;
    }
    /// The share of the contact at the skin thermistor goes from a few millimetres beside the contact (section 6.4.3) to its perimeter
    /// (sections 3.2 and 4.4).
    fn sensors(SensorParams) named "sensors" {
        thermistors => thermistors.iter_mut().zip(THERMISTOR_LAGS)
            .flat_map(|(one, (name, lag))| thermistor(one, &format!("sensors.{name}"), lag));
        divider_lag_s:     "s", relative(0.15),                     (0.0, 1.0), "lag of the filters between the dividers and the converter", Netlist;
        skin_sees_contact: "1", between(0.002, 0.35).logarithmic(), (0.0, 1.0), "share of the contact's skin in what the skin thermistor at its edge sees",
            Thesis("6.4.3; 3.2 and 4.4 on the perimeter, 0.22 to 0.32");
        force => self::force(force);
        mirror => self::mirror(mirror);
        reference => self::reference(reference);
        converter => self::converter(converter);
    }
    fn thermistor(ThermistorParams, name: &str, lag: Tolerance) named name {
        at_25c_ohm:      "ohm", relative(0.01).normal(),  (100.0, 1e6),     "resistance at 25 C", ClassValue;
        beta_k:          "K",   relative(0.01).normal(),  (1000.0, 6000.0), "beta", Recalled;
        pull_up_ohm:     "ohm", relative(0.001).normal(), (100.0, 1e6),     "resistor to the reference", Design;
        lag_s:           "s",   lag,                      (1e-3, 100.0),    "lag behind what it sits on", Literature;
        dissipation_w_k: "W/K", factor(2.0),              (1e-5, 1.0),      "heat that it gives to what it sits on, per kelvin", ClassValue;
        lead_share:      "1",   relative(1.0),            (0.0, 1.0),       "share of the room that its leads let in", ClassValue;
    }
    fn force(ForceParams) named "sensors.force" {
        zero_counts:  "counts",   relative(0.02),                      (0.0, 4095.0),       "level without force", Design;
        counts_per_n: "counts/N", relative(0.02),                      (1.0, 4095.0),       "gain", Design;
        lag_s:        "s",        between(0.2e-3, 5e-3).logarithmic(), (1e-5, 10.0),        "lag of the amplifier", ClassValue;
        delay_s:      "s",        FIXED,                               (0.0, Delay::MAX_S), "dead time of its interface", Design;
        cell => self::cell(cell);
    }
    fn cell(ForceCellParams) named "sensors.force.cell" {
        mass_kg:        "kg",  relative(0.1),                      (0.01, 10.0), "mass of plate, module, sink and fan, which rest on the cell",
            Estimate("sink and fan of the reference design");
        compliance_m_n: "m/N", between(0.0, 1.27e-6),              (0.0, 1e-3),  "deflection of the load cell; 0 is rigid. 1.27e-6 resonates at 200 Hz under 0.5 kg, 3e-5 at 41 Hz",
            ClassValue;
        damping:        "1",   factor(2.0),                        (1e-3, 0.9),  "damping of its resonance, relative to the critical one",
            Estimate("an undamped metal structure");
        vibration_n:    "N",   between(0.0, 2e-3),                 (0.0, 1.0),   "amplitude of the fan's vibration in the cell's force",
            Estimate("a fan beside the stack; a rotor of 20 g of class G6.3 on it gives 0.04 N at 50 Hz");
        vibration_hz:   "Hz",  between(30.0, 200.0).logarithmic(), (1.0, 500.0), "frequency of that vibration",
            Estimate("fans of 1800 to 12000 revolutions a minute");
        drift_n_s:      "N/s", between(-1e-4, 1e-4),               (-0.1, 0.1),  "drift of the cell's zero by warming and creep", ClassValue;
        drift_max_n:    "N",   FIXED,                              (0.0, 10.0),  "where that drift ends", ClassValue;
    }
    fn mirror(MirrorParams) named "sensors.mirror" {
        counts_per_a:   "counts/A", relative(0.01), (1.0, 4095.0), "gain", Design;
        gain_error:     "1",        absolute(0.02), (-0.5, 0.5),   "error of sense resistors and amplifiers", Netlist;
        offset_a:       "A",        absolute(0.05), (-1.0, 1.0),   "current that it shows too much", ClassValue;
        lag_s:          "s",        relative(0.2),  (0.0, 1.0),    "lag of the current measurement's filters; 0 without them", Netlist;
        sampling_phase: "1",        FIXED,          (0.0, 1.0),    "phase of the PWM period at which the first scan of a step samples the current", Design;
        phase_step:     "1",        FIXED,          (0.0, 1.0),    "change of that phase from scan to scan, periods", Design;
    }
    fn reference(ReferenceParams) named "sensors.reference" {
        volt:            "V", FIXED,                   (1.0, 5.0),  "reference, which feeds the dividers", Design;
        error:           "1", absolute(0.02).normal(), (-0.5, 0.5), "error of the reference, seen by force and current only", ClassValue;
        excitation_duty: "1", FIXED,                   (0.0, 1.0),  "part of the time for which the dividers are fed", Design;
    }
    /// The total error of the data sheet, 2 counts typical and 5 at most, is divided among offset, gain and INL.
    fn converter(ConverterParams) named "sensors.converter" {
        offset_counts: "counts", absolute(2.0).normal(),          (-100.0, 100.0), "offset", DataSheet;
        gain_error:    "1",      absolute(2.0 / 4096.0).normal(), (-0.1, 0.1),     "gain error", DataSheet;
        inl_counts:    "counts", factor(2.0),                     (0.0, 3.0),      "bound of the integral non-linearity", DataSheet;
        noise_counts:  "counts", between(0.4, 1.2),               (0.0, 50.0),     "standard deviation of one conversion", ClassValue;
    }
    /// The tolerances are those of the error budget in `docs/flux.md`.
    fn flux(FluxParams) named "flux" {
        gain_error:       "1",             absolute(0.03).normal(), (-0.5, 0.5),     "error of the gain after calibration on a phantom",
            Estimate("error budget; 1.5 % is one standard deviation");
        zero_w_m2:        "W/m2",          absolute(7.0).normal(),  (-500.0, 500.0), "flux that it reads without any, after its zero was taken",
            Estimate("error budget; 3.5 W/m2 is one standard deviation");
        noise_w_m2:       "W/m2",          relative(0.3),           (0.0, 1000.0),   "standard deviation of one conversion before quantisation", Netlist;
        lag_s:            "s",             relative(0.2).normal(),  (1e-4, 10.0),    "lag of its layer and its filter", Netlist;
        resistance_m2k_w: "m2 K/W",        relative(0.1).normal(),  (0.0, 1e-2),     "thermal resistance of its layer, between display and skin", Design;
        counts_per_w_m2:  "counts/(W/m2)", FIXED,                   (1e-4, 10.0),    "gain", Netlist;
    }
    /// A calibration to 20 mK and the noise of a good resistance bridge.
    fn host(HostParams) named "host" {
        reference_offset_k: "K", absolute(0.02),     (-5.0, 5.0), "what the host's reference thermometer shows too much", ClassValue;
        reference_noise_k:  "K", between(0.0, 1e-3), (0.0, 1.0),  "standard deviation of one of its readings", ClassValue;
    }
}
