//! Contact area and pressure from a measured force.

use super::{Log2, log2};
use crate::pressure::THESIS_PRESSURES;

/// Force, N: 0 to 256, resolution 6e-8.
pub type Force = fixed::types::U8F24;

/// Binary places of an area in m².
const AREA_BITS: i32 = 44;
/// Additional binary places of a slope.
const SLOPE_BITS: i32 = 25;

/// One linear segment of area over force: `intercept + slope * force`.
#[derive(Clone, Copy)]
struct Segment {
    /// Force at which the segment begins, rounded down to the resolution of [`Force`].
    above: Force,
    /// Area at zero force, units of 2^-69 m².
    intercept: u64,
    /// Area per 2^-24 N, units of 2^-69 m².
    slope: u32,
}

/// Segments between the five points of section 6.4.2, and a constant one after them. They are computed from the
/// points themselves: from forces rounded to [`Force`] the area would have a relative error of 2e-8.
const SEGMENTS: [Segment; THESIS_PRESSURES.len()] = {
    const fn scaled(value: f64, bits: i32) -> u64 {
        (value * (1u128 << bits) as f64 + 0.5) as u64
    }
    let mut segments =
        [Segment { above: Force::ZERO, intercept: 0, slope: 0 }; THESIS_PRESSURES.len()];
    let mut i = 0;
    while i < THESIS_PRESSURES.len() {
        let (force, area) = (THESIS_PRESSURES[i].0, THESIS_PRESSURES[i].0 / THESIS_PRESSURES[i].1);
        let slope = if i + 1 < THESIS_PRESSURES.len() {
            (THESIS_PRESSURES[i + 1].0 / THESIS_PRESSURES[i + 1].1 - area)
                / (THESIS_PRESSURES[i + 1].0 - force)
        } else {
            0.0
        };
        segments[i] = Segment {
            above: Force::from_bits((force * (1u64 << Force::FRAC_NBITS) as f64) as u32),
            intercept: scaled(area - slope * force, AREA_BITS + SLOPE_BITS),
            slope: scaled(slope, AREA_BITS + SLOPE_BITS - Force::FRAC_NBITS as i32) as u32,
        };
        i += 1;
    }
    segments
};

/// Area up to the first of the five forces.
const FIRST_AREA: u32 =
    (THESIS_PRESSURES[0].0 / THESIS_PRESSURES[0].1 * (1u64 << AREA_BITS) as f64 + 0.5) as u32;

/// `log2(H)` of the skin's microhardness in Pa (Eq. 6-8).
pub(super) const LOG2_MICROHARDNESS: Log2 = Log2::lit("16.902422223664658");

/// `log2(P / H)` under a force (section 6.4.2, as [`crate::pressure::pressure_pa`]), input of
/// [`super::ContactPair::at_pressure`]; error below 6 * 2^-32 for every force.
///
/// Zero is treated as half of the smallest positive [`Force`].
pub fn log2_relative_pressure(force: Force) -> Log2 {
    const PLACES: Log2 = Log2::const_from_int(AREA_BITS as i64 - Force::FRAC_NBITS as i64);
    log2(force.to_bits())
        .saturating_sub(log2(area(force)))
        .saturating_add(PLACES.saturating_sub(LOG2_MICROHARDNESS))
}

/// Area, mm²: 0 to 65536, resolution 15e-6.
pub type Area = fixed::types::U16F16;

/// Contact area under a force (section 6.4.2, as [`crate::pressure::contact_area_m2`]); error below 4e-5 mm².
pub fn contact_area(force: Force) -> Area {
    const MM2: u64 = 1_000_000;
    Area::from_bits(
        ((u64::from(area(force)) * MM2) >> (AREA_BITS - Area::FRAC_NBITS as i32)) as u32,
    )
}

/// Contact area in units of 2^-44 m².
fn area(force: Force) -> u32 {
    let mut area = FIRST_AREA;
    for segment in &SEGMENTS {
        if force > segment.above {
            let rise = u64::from(force.to_bits()) * u64::from(segment.slope);
            area = ((segment.intercept + rise + (1 << SLOPE_BITS >> 1)) >> SLOPE_BITS) as u32;
        }
    }
    area
}
