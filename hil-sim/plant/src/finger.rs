//! The finger: tissue, blood flow and surface.

use contact_model::material::{SKIN, Surface};

use super::slab::{BackBoundary, Layer, Medium};

/// Parameters of a finger.
#[derive(Clone, Debug, PartialEq)]
pub struct FingerParams {
    /// Contact properties of the skin.
    pub surface: Surface,
    /// Factor on its contact resistance, on display and object alike.
    pub resistance_factor: f64,
    /// Layers of tissue, the outermost first.
    pub layers: Vec<Layer>,
    /// Conductance from the deepest layer to the core, W/(m2 K); none if the back is insulated.
    pub core_w_m2k: Option<f64>,
    /// Film coefficient of air on surfaces without contact, of finger and object, radiation included, W/(m2 K).
    pub air_w_m2k: f64,
    /// Reduction of blood flow by the contact force; none if the flow is constant.
    pub vessels: Option<Vessels>,
}

/// Blood flow as a function of the contact force (section 6.4.3): full below `open_n`, none above `shut_n`, linear between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vessels {
    /// Largest force with full flow, N.
    pub open_n: f64,
    /// Smallest force without flow, N.
    pub shut_n: f64,
}

impl Vessels {
    /// The forces of section 6.4.3.
    pub const THESIS: Self = Self { open_n: 0.3, shut_n: 1.0 };

    /// Fraction of the full flow at a force, N.
    pub fn flow(&self, force_n: f64) -> f64 {
        ((self.shut_n - force_n) / (self.shut_n - self.open_n)).clamp(0.0, 1.0)
    }
}

/// Volumetric heat capacity of blood, J/(m3 K): 1060 kg/m3 times 3770 J/(kg K), literature.
pub const BLOOD_J_M3K: f64 = 4.0e6;

impl FingerParams {
    /// The thesis's finger: a homogeneous half-space without blood, adiabatic where it has no contact.
    pub fn homogeneous() -> Self {
        Self {
            surface: SKIN.surface,
            resistance_factor: 1.0,
            layers: vec![Layer {
                thickness_m: f64::INFINITY,
                medium: Medium::without_blood(&SKIN),
            }],
            core_w_m2k: None,
            air_w_m2k: 0.0,
            vessels: None,
        }
    }

    /// A fingertip of epidermis, dermis and fat over a core, with blood perfusion and metabolic heat. Conductivities and
    /// heat capacities are literature values; thicknesses, perfusion and film coefficient are typical values.
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
            resistance_factor: 1.0,
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

    /// Whether it is a half-space of one tissue, as the thesis's.
    pub fn is_half_space(&self) -> bool {
        matches!(self.layers.as_slice(), [one] if one.thickness_m.is_infinite())
    }

    /// Boundary condition behind the tissue; the core temperature is set later by the steady state.
    pub fn back(&self) -> BackBoundary {
        self.core_w_m2k.map_or(BackBoundary::Insulated, |film_w_m2k| BackBoundary::Film {
            film_w_m2k,
            temperature_c: 0.0,
        })
    }
}
