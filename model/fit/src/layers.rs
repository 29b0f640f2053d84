//! Exact surface impedance of layers in one dimension.

use contact_model::slab::Back;

/// A layer of a body. Heat is conducted across its thickness only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Thickness, m; the last layer may be infinitely thick.
    pub thickness_m: f64,
    /// Conductivity, W/(m K).
    pub conductivity_w_mk: f64,
    /// Heat capacity per volume, J/(m³ K).
    pub capacity_j_m3k: f64,
    /// Perfusion times heat capacity of the blood, W/(m³ K), as in Pennes' equation; 0 for an object.
    pub perfusion_w_m3k: f64,
}

/// Exact surface impedance, m² K/W, of layers from the touched face down, at the real Laplace variable `s_1_s`, 1/s, which
/// must be above 0. Each layer is a transmission line.
pub fn impedance(layers: &[Layer], back: Back, s_1_s: f64) -> f64 {
    let behind = match back {
        Back::Insulated => f64::INFINITY,
        Back::Held => 0.0,
        Back::Film(film_w_m2k) => 1.0 / film_w_m2k,
    };
    layers.iter().rev().fold(behind, |behind, layer| {
        let decay_1_m = ((s_1_s * layer.capacity_j_m3k + layer.perfusion_w_m3k)
            / layer.conductivity_w_mk)
            .sqrt();
        let own = 1.0 / (layer.conductivity_w_mk * decay_1_m);
        let tanh = (layer.thickness_m * decay_1_m).tanh();
        if behind.is_infinite() {
            own / tanh
        } else {
            own * (behind + own * tanh) / (own + behind * tanh)
        }
    })
}
