//! Roughness of a measured profile (the thesis's Appendix A, after ISO 4287): what a user's own material needs
//! to enter a scene besides its thermal constants.
//!
//! All parameters are of the levelled profile: its least-squares line is removed. Nothing else is: waviness and
//! noise count as roughness unless the instrument has filtered them (the thesis: `lambda_c` 2.5 mm, `lambda_s`
//! 25 µm, section 6.2.1).
//!
//! Points may lie unevenly, the longest step at most [`MOST_UNEVEN`] times the shortest. Means are over length:
//! a point weighs half of the two steps beside it, so a sine over whole periods has its exact `Rq` wherever the
//! points lie. With even steps this is the mean over points of Eq. but for the two end points.

mod parameters;
mod read;
mod spacing;

pub use read::{LEAST_POINTS, MOST_UNEVEN, ProfileError};

/// A profile as measured: points along a straight line on the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Places, m; rising.
    x_m: Vec<f64>,
    /// Heights, m; as many.
    z_m: Vec<f64>,
}

/// What the contact model and its user want to know of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// RMS roughness `Rq`, m (Eq. A-1). [`contact_model::material::Surface`] wants µm.
    pub rq_m: f64,
    /// RMS slope `RΔq`, m/m (Eq. A-2). The local slope is that of the polynomial through a point, the three
    /// before and the three behind it; with even steps `s` that is ISO 4287's
    /// `(z[i+3] - 9 z[i+2] + 45 z[i+1] - 45 z[i-1] + 9 z[i-2] - z[i-3]) / 60 s`. Towards the ends it is two and
    /// one on either side, and at the ends the step's own slope.
    pub rdq: f64,
    /// Mean slope `Δa`, rad (Eq. A-3): mean of `atan |Δz / Δx|` over the steps of the profile. This is the
    /// `slope_rad` of a [`contact_model::material::Surface`]. Where only `RΔq` is known, Eq. 6-13
    /// ([`contact_model::material::average_slope_rad`]) estimates it, for Gaussian surfaces.
    pub slope_rad: f64,
    /// Mean spacing of profile elements `RSm`, m (Eq. A-4); none if the profile holds no complete element.
    ///
    /// A peak counts if it rises above the mean line by 10 % of `Rz` (the mean over five equal lengths of
    /// highest minus lowest point), a valley if it falls below as much, and either if it is at least 1 % of a
    /// sampling length wide. That length is taken as five spacings as counted without this rule: ISO 4288
    /// chooses two to six. An element is a peak and the valley behind it, or a valley and the peak; each ends
    /// where the profile last crosses the mean line. What is cut off at the ends of the profile is no element
    /// (ISO 4287 would count it, and shorten the mean).
    pub rsm_m: Option<f64>,
}

impl Profile {
    /// The parameters.
    #[must_use]
    pub fn roughness(&self) -> Roughness {
        let x_m = &self.x_m;
        let y_m = parameters::levelled(x_m, &self.z_m);
        Roughness {
            rq_m: parameters::rms(x_m, &y_m),
            rdq: parameters::rms_slope(x_m, &y_m),
            slope_rad: parameters::mean_slope_rad(x_m, &y_m),
            rsm_m: spacing::mean_m(x_m, &y_m),
        }
    }
}
