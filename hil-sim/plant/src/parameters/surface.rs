//! Parameters of a surface that determine the contact resistance.

use contact_model::material::Surface;

use super::Source::{self, ClassValue, Thesis};
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{Tolerance, between, relative};

/// Tolerances of conductivity, roughness and slope of a surface, and their source.
pub type SurfaceTolerances = ([Tolerance; 3], Source);

/// Skin: conductivity from the spread of its effusivity between people, roughness and slope between the sexes.
pub const SKIN: SurfaceTolerances =
    ([relative(0.1), between(20.23, 23.15), between(0.28, 0.32)], Thesis("2.1 and Table 6-1"));
/// The display: section 6.3 gives only a combination of the three values.
pub const DISPLAY: SurfaceTolerances = ([relative(0.1), relative(0.1), relative(0.1)], ClassValue);

pub fn entries<'a>(
    part: &str,
    surface: &'a mut Surface,
    ([k, rq, slope], source): SurfaceTolerances,
) -> impl Iterator<Item = Entry<'a>> {
    let Surface { conductivity_w_mk, roughness_um, slope_rad } = surface;
    let all = [
        entry!(
            conductivity_w_mk,
            "W/(m K)",
            "conductivity in the contact (Eq. 6-9)",
            k,
            (0.01, 3000.0),
            source,
        ),
        entry!(roughness_um, "um", "RMS roughness", rq, (1e-3, 200.0), source,),
        entry!(slope_rad, "rad", "mean asperity slope", slope, (1e-3, 1.5), source,),
    ];
    prefixed(part, all)
}
