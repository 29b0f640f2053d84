//! Roughness of a measured profile (the thesis's Appendix A, after ISO 4287), which a scene with a user-defined material
//! needs besides its thermal properties.
//!
//! All parameters refer to the levelled profile, from which the least-squares line is removed. Waviness and noise count as
//! roughness unless the instrument has filtered them (thesis, section 6.2.1: `lambda_c` 2.5 mm, `lambda_s` 25 µm).
//!
//! The spacing of the points may vary, the longest step up to [`MOST_UNEVEN`] times the shortest. Means are integrals over
//! the length by the trapezoidal rule. With equal steps they are the means over points of Eq. except for the
//! weights of the two end points.

mod equal_steps;
mod parameters;
mod printed;
mod profile_csv;
mod spacing;

pub use equal_steps::EqualSteps;
pub use profile_csv::{LEAST_POINTS, MOST_UNEVEN, ProfileError};

/// A measured profile: points along a straight line on the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Positions, m, increasing.
    x_m: Vec<f64>,
    /// Heights, m, one for each position.
    z_m: Vec<f64>,
    /// Where the positions are not those of the file.
    equal_steps: Option<EqualSteps>,
}

/// Roughness parameters of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// RMS roughness `Rq`, m (Eq. A-1); in µm it is the `roughness_um` of a [`contact_model::material::Surface`].
    pub rq_m: f64,
    /// RMS slope `RΔq`, m/m (Eq. A-2). The local slope is that of the polynomial through the point, the three
    /// before and the three after it; with equal steps `s` this is the formula of ISO 4287,
    /// `(z[i+3] - 9 z[i+2] + 45 z[i+1] - 45 z[i-1] + 9 z[i-2] - z[i-3]) / 60 s`. Near the ends two points or
    /// one point on either side are used, and at the ends the slope of the step.
    pub rdq: f64,
    /// Mean slope `Δa`, rad (Eq. A-3): mean of `atan |Δz / Δx|` over the steps of the profile. This is the
    /// `slope_rad` of a [`contact_model::material::Surface`]. Where only `RΔq` is known, Eq. 6-13
    /// ([`contact_model::material::average_slope_rad`]) estimates it, for Gaussian surfaces.
    pub slope_rad: f64,
    /// Mean spacing of profile elements `RSm`, m (Eq. A-4); none if the profile holds no complete element.
    ///
    /// A peak counts if its height above the mean line is at least 10 % of `Rz` (the mean over five equal lengths of
    /// highest minus lowest point) and its width at least 1 % of a sampling length; likewise the depth and width of a
    /// valley. The sampling length is taken as five spacings without the width criterion (ISO 4288 chooses two to six).
    /// An element is a peak and the next valley, or a valley and the next peak; each ends where the profile last crosses
    /// the mean line. Incomplete elements at the ends of the profile are excluded (ISO 4287 includes them, which reduces
    /// the mean).
    pub rsm_m: Option<f64>,
}

impl Profile {
    /// The equal steps that stand in place of positions which are printed with too few digits; none where the printed
    /// positions are used.
    pub fn equal_steps(&self) -> Option<EqualSteps> {
        self.equal_steps
    }

    /// Computes the roughness parameters.
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
