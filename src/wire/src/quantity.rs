//! The numbers that a host sends: names, units and ranges.

use contact_model::contact_law::ContactLaw;
use contact_model::fixed_point::{FAST_MAX, SLOW_MAX};
use thermal_device::safety::limits::{SETPOINT_MAX_C, SETPOINT_MIN_C};
use thermal_device::stimulus::{COURSE_DURATION_MAX_MS, COURSE_POINTS_MAX, COURSE_RATE_MAX_K_S};

use crate::number::quantities;

/// Largest number of relaxations of an uploaded object.
pub const RELAXATIONS_MAX: usize = FAST_MAX + SLOW_MAX;

quantities! {
    /// Set-point, or point of a course, °C.
    Temperature = "temperature", "C", SETPOINT_MIN_C, SETPOINT_MAX_C;
    /// Skin before contact, °C.
    Skin = "skin", "C", SETPOINT_MIN_C, SETPOINT_MAX_C;
    /// Rate of a set-point, K/s.
    Rate = "rate", "K/s", 0.01, COURSE_RATE_MAX_K_S as f64;
    /// Time of a course, s.
    Seconds = "time", "s", 0.0, COURSE_DURATION_MAX_MS as f64 / 1e3;
    /// How often a course is played.
    Repeats = "repeats", "", 1.0, 1000.0;
    /// Time from one line of telemetry to the next, ms; 0 switches telemetry off.
    StreamInterval = "interval", "ms", 0.0, 60_000.0;

    /// Length of a pulse at the trigger output, ms.
    PulseLength = "pulse", "ms", 1.0, 200.0;

    /// Temperature of an object before contact, °C.
    ObjectTemperature = "object temperature", "C", -20.0, 60.0;
    /// Thickness of a slab, mm.
    Thickness = "thickness", "mm", 0.1, 1000.0;
    /// Film behind a slab, W/(m² K).
    Film = "film", "W/m2K", 0.1, 100_000.0;
    /// Thermal conductivity of a material, W/(m K).
    Conductivity = "conductivity", "W/mK", 0.001, 5000.0;
    /// Density of a material, kg/m³.
    Density = "density", "kg/m3", 1.0, 30_000.0;
    /// Specific heat of a material, J/(kg K).
    SpecificHeat = "specific heat", "J/kgK", 10.0, 10_000.0;
    /// RMS roughness of a material, µm.
    Roughness = "roughness", "um", 0.001, 1000.0;
    /// Mean slope of a material's asperities, rad.
    Slope = "slope", "rad", 0.0001, 1.5;

    /// Exponent of the contact law.
    Exponent = "exponent", "", *ContactLaw::EXPONENTS.start(), *ContactLaw::EXPONENTS.end(), 4 decimals;
    /// Microhardness of the skin in the contact law, Pa.
    Microhardness = "microhardness", "Pa", *ContactLaw::HARDNESSES_PA.start(), *ContactLaw::HARDNESSES_PA.end(), 0 decimals;
    /// Conductance of the gap in the contact law, W/(m² K).
    Gap = "gap", "W/(m2 K)", *ContactLaw::GAPS_W_M2K.start(), *ContactLaw::GAPS_W_M2K.end(), 1 decimals;

    /// Number of an object's relaxations.
    RelaxationCount = "number of rows", "", 0.0, RELAXATIONS_MAX as f64;
    /// Index of a relaxation.
    RelaxationIndex = "row", "", 0.0, (RELAXATIONS_MAX - 1) as f64;
    /// Direct term of an object's impedance, mm² K/W.
    Direct = "direct", "mm2K/W", 0.0, 27e3, 9 decimals;
    /// Rate of a relaxation, 1/s.
    RelaxationRate = "rate", "1/s", 0.0, 690.0, 9 decimals;
    /// Gain of a relaxation, mm² K/J.
    RelaxationGain = "gain", "mm2K/J", 1e-6, 1.3e7, 9 decimals;
    /// Number of points of a course.
    PointCount = "number of points", "", 2.0, COURSE_POINTS_MAX as f64;
    /// Index of a point of a course.
    PointIndex = "row", "", 0.0, (COURSE_POINTS_MAX - 1) as f64;
    /// Time of a point of a course, s.
    PointTime = "time", "s", 0.0, COURSE_DURATION_MAX_MS as f64 / 1e3, 3 decimals;
    /// Temperature of a point of a course, °C.
    PointTemperature = "temperature", "C", SETPOINT_MIN_C, SETPOINT_MAX_C, 6 decimals;
    /// Temperature of a point of a course above the skin, K.
    PointAboveSkin = "temperature", "K", SETPOINT_MIN_C - SETPOINT_MAX_C, SETPOINT_MAX_C - SETPOINT_MIN_C, 6 decimals;

    /// Reading of a reference thermometer, °C.
    Reference = "reference temperature", "C", 0.0, 60.0, 3 decimals;
}
