//! Force to pressure, for a force that streams in.

use super::{Log2, log2};
use crate::pressure::STATED;

/// Force in N: 0 to 256 at a resolution of 6e-8.
pub type Force = fixed::types::U8F24;

/// Area is held in units of 2^-40 m².
const AREA_BITS: i32 = 40;
const POINTS: usize = STATED.len();

/// The stated forces, the contact areas there, and the slopes between them (24 fraction bits).
const FORCES: [Force; POINTS] = {
    let mut forces = [Force::ZERO; POINTS];
    let mut i = 0;
    while i < POINTS {
        forces[i] = Force::from_bits((STATED[i].0 * (1u64 << 24) as f64) as u32);
        i += 1;
    }
    forces
};
const AREAS: [u32; POINTS] = {
    let mut areas = [0; POINTS];
    let mut i = 0;
    while i < POINTS {
        areas[i] = (STATED[i].0 / STATED[i].1 * (1u64 << AREA_BITS) as f64) as u32;
        i += 1;
    }
    areas
};

const SLOPES: [u32; POINTS - 1] = {
    let mut slopes = [0; POINTS - 1];
    let mut i = 0;
    while i < POINTS - 1 {
        let rise = ((AREAS[i + 1] - AREAS[i]) as u64) << 24;
        slopes[i] = (rise / (FORCES[i + 1].to_bits() - FORCES[i].to_bits()) as u64) as u32;
        i += 1;
    }
    slopes
};

/// `log2(H)` of the skin's microhardness in Pa (Eq. 6-8).
const LOG2_MICROHARDNESS: Log2 = Log2::lit("16.902422223664658");

/// `log2(P / H)` under a force (section 6.4.2, as [`crate::pressure::pressure_pa`]); error below 2^-21.
///
/// A force of zero counts as the smallest force above it.
#[must_use]
pub fn log2_relative_pressure(force: Force) -> Log2 {
    let log2_force = log2(force.to_bits()).saturating_sub(Log2::const_from_int(24));
    let log2_area = log2(area(force)).saturating_sub(Log2::const_from_int(AREA_BITS));
    log2_force
        .saturating_sub(log2_area)
        .saturating_sub(LOG2_MICROHARDNESS)
}

/// Contact area in units of 2^-40 m².
fn area(force: Force) -> u32 {
    let mut area = AREAS[0];
    for ((&start, &from), &slope) in FORCES.iter().zip(&AREAS).zip(&SLOPES) {
        if force > start {
            let beyond = u64::from(force.to_bits() - start.to_bits());
            area = from + ((beyond * u64::from(slope)) >> 24) as u32;
        }
    }
    area.min(AREAS[POINTS - 1])
}
