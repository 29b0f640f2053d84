//! What the contact resistance sees of a surface.

use contact_model::material::Surface;

use super::Source::{self, ClassValue, Thesis};
use super::slot::{Slot, slot, under};
use super::spread::{Tolerance, between, relative};

/// Tolerances of a surface's conductivity, roughness and slope, and their source.
pub type Finish = ([Tolerance; 3], Source);

/// Skin: conductivity as its effusivity differs between people; roughness and slope from one sex to the other.
pub const SKIN: Finish = (
    [relative(0.1), between(20.23, 23.15), between(0.28, 0.32)],
    Thesis("2.1 and Table 6-1"),
);
/// The display: only the ratio of the three is known, from section 6.3.
pub const DISPLAY: Finish = ([relative(0.1), relative(0.1), relative(0.1)], ClassValue);

pub fn slots<'a>(
    part: &str,
    surface: &'a mut Surface,
    ([k, rq, slope], source): Finish,
) -> impl Iterator<Item = Slot<'a>> {
    let Surface {
        conductivity_w_mk,
        roughness_um,
        slope_rad,
    } = surface;
    let all = [
        slot(
            conductivity_w_mk,
            "conductivity_w_mk",
            "W/(m K)",
            "conductivity in the contact (Eq. 6-9)",
            k,
            (0.01, 3000.0),
            source,
        ),
        slot(
            roughness_um,
            "roughness_um",
            "um",
            "RMS roughness",
            rq,
            (1e-3, 200.0),
            source,
        ),
        slot(
            slope_rad,
            "slope_rad",
            "rad",
            "mean asperity slope",
            slope,
            (1e-3, 1.5),
            source,
        ),
    ];
    under(part, all)
}
