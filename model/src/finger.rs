//! Fingers that the device may assume: surface impedance of the tissue, and film of air on the skin before contact.
//!
//! `cargo run -p relaxation-fit --example fingers` prints the constants and the errors of the fits.

use crate::impedance::{Impedance, Relaxation};

/// Thermal properties of a finger that the device may assume for the one that touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerProperties {
    /// Surface impedance of the tissue in contact.
    pub impedance: Impedance<'static>,
    /// Film coefficient of the air on the skin before contact, W/(m² K). In contact the air no longer cools the skin.
    pub air_w_m2k: f64,
}

const fn relaxation(rate_1_s: f64, gain_m2k_j: f64) -> Relaxation {
    Relaxation { rate_1_s, gain_m2k_j }
}

/// The thesis's finger: a half-space of skin (section 2.1), insulated before contact. Its impedance is within 1.2e-4 of the
/// exact one at Laplace variables from 0.01 to 600 1/s, which are times of 2 ms to 100 s.
pub const THESIS: FingerProperties = FingerProperties {
    impedance: Impedance {
        direct_m2k_w: 9.89256e-6,
        relaxations: &[
            relaxation(9.73317e-4, 3.49763e-5),
            relaxation(1.12358e-2, 4.94328e-5),
            relaxation(5.18639e-2, 8.82247e-5),
            relaxation(2.07559e-1, 1.69351e-4),
            relaxation(8.21858e-1, 3.44955e-4),
            relaxation(3.45121e0, 7.44708e-4),
            relaxation(1.57500e1, 1.69367e-3),
            relaxation(8.15410e1, 4.28802e-3),
            relaxation(6.00000e2, 1.62997e-2),
        ],
    },
    air_w_m2k: 0.0,
};

/// The mean finger: epidermis (0.65 mm), dermis (1.2 mm) and fat (4 mm) of literature values over a core that keeps its
/// temperature, in a film of air of 10 W/(m² K) before contact; without blood, which a touch of 1 N or more stops (section
/// 6.4.3). Its impedance has the accuracy of [`THESIS`].
pub const MEAN: FingerProperties = FingerProperties {
    impedance: Impedance {
        direct_m2k_w: 1.26345e-5,
        relaxations: &[
            relaxation(0.00000e0, 1.42326e-7),
            relaxation(3.87276e-3, 1.06410e-4),
            relaxation(5.33844e-2, 7.18475e-5),
            relaxation(2.20462e-1, 2.90762e-4),
            relaxation(8.33694e-1, 4.05721e-4),
            relaxation(3.46320e0, 9.57844e-4),
            relaxation(1.57930e1, 2.16226e-3),
            relaxation(8.15867e1, 5.47400e-3),
            relaxation(6.00000e2, 2.08197e-2),
        ],
    },
    air_w_m2k: 10.0,
};

/// The mean finger that rests on an insulating pad before contact: 0.5 to 3 W/(m² K) instead of a film of air.
pub const MEAN_ON_PAD: FingerProperties = FingerProperties { air_w_m2k: 1.75, ..MEAN };

/// How fingers differ: relative deviations of the weights of [`MEAN`] per unit of the two largest components of the
/// differences, whose standard deviations over the simulated fingers are 1. The weights are those of the relaxations from the
/// slowest to the fastest, without the integrator, then of the direct term.
///
/// Computed from the 600 fingers that the simulator draws from the seeds 0 to 599, whose impedances differ from that of
/// [`MEAN`] by 15.4 % rms at Laplace variables from 0.05 to 700 1/s; with the first component by 1.1 %, with both by 0.3 %. No
/// weight of these fingers is below 0.67 of that of [`MEAN`]. `cargo test --release -p system-tests finger_components --
/// --nocapture` prints all of this.
pub const COMPONENTS: [[f64; 9]; 2] = [
    [-0.1476, -0.0858, -0.1855, -0.1129, -0.1484, -0.1537, -0.1313, -0.1665, -0.1202],
    [-0.0417, -0.0329, -0.0374, 0.0403, 0.0341, -0.0079, 0.0067, 0.0094, 0.0026],
];

/// Mean of each of the [`COMPONENTS`] over the same fingers.
pub const COMPONENT_MEANS: [f64; 2] = [-0.3456, 0.2985];
