//! The finger: its tissue and its blood.

use contact_model::material::{SKIN, Surface};

use super::slab::{Back, Layer, Medium};

/// What a finger is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct FingerParams {
    /// Its surface.
    pub surface: Surface,
    /// Its tissue, the outermost layer first.
    pub layers: Vec<Layer>,
    /// Conductance from the deepest layer to the core, W/(m2 K); none if nothing lies behind it.
    pub core_w_m2k: Option<f64>,
    /// Film of air on lifted surfaces, of finger and object, radiation included, W/(m2 K).
    pub air_w_m2k: f64,
    /// How force closes the vessels; none if it does not.
    pub vessels: Option<Vessels>,
}

/// Blood flow under force, as section 6.4.3 has it: full up to one force, none from another on, linear between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vessels {
    /// Up to this force the flow is full, N.
    pub open_n: f64,
    /// From this force on there is none, N.
    pub shut_n: f64,
}

impl Vessels {
    /// The forces of section 6.4.3.
    pub const THESIS: Self = Self {
        open_n: 0.3,
        shut_n: 1.0,
    };

    /// Share of the full flow under a force, N.
    #[must_use]
    pub fn flow(&self, force_n: f64) -> f64 {
        ((self.shut_n - force_n) / (self.shut_n - self.open_n)).clamp(0.0, 1.0)
    }
}

/// Heat capacity of blood, J/(m3 K): density 1060 kg/m3 times 3770 J/(kg K), literature.
pub const BLOOD_J_M3K: f64 = 4.0e6;

impl FingerParams {
    /// The thesis's finger: one homogeneous half-space without blood, insulated where it touches nothing.
    #[must_use]
    pub fn homogeneous() -> Self {
        Self {
            surface: SKIN.surface,
            layers: vec![Layer {
                thickness_m: f64::INFINITY,
                medium: Medium::dead(&SKIN),
            }],
            core_w_m2k: None,
            air_w_m2k: 0.0,
            vessels: None,
        }
    }

    /// A fingertip of epidermis, dermis and fat over a core, with blood and metabolism. Conductivities and heat
    /// capacities are literature values; thicknesses, perfusion and the film are class values.
    #[must_use]
    pub fn layered() -> Self {
        let layer =
            |thickness_m, conductivity_w_mk, capacity_j_m3k, perfusion_1_s, metabolism_w_m3| {
                Layer {
                    thickness_m,
                    medium: Medium {
                        conductivity_w_mk,
                        capacity_j_m3k,
                        perfusion_w_m3k: perfusion_1_s * BLOOD_J_M3K,
                        metabolism_w_m3,
                    },
                }
            };
        Self {
            surface: SKIN.surface,
            layers: vec![
                layer(0.65e-3, 0.21, 1110.0 * 3600.0, 0.0, 0.0),
                layer(1.2e-3, 0.37, 1116.0 * 3224.0, 5e-3, 370.0),
                layer(4.0e-3, 0.16, 970.0 * 2303.0, 1e-3, 370.0),
            ],
            core_w_m2k: Some(f64::INFINITY),
            air_w_m2k: 10.0,
            vessels: Some(Vessels::THESIS),
        }
    }

    /// What lies behind the tissue; its temperature follows from the skin's.
    #[must_use]
    pub fn back(&self) -> Back {
        self.core_w_m2k
            .map_or(Back::Insulated, |film_w_m2k| Back::Film {
                film_w_m2k,
                temperature_c: 0.0,
            })
    }
}
