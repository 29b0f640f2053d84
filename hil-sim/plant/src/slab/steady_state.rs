//! Steady state of a slab.

use super::Slab;

/// Temperatures of a slab in steady state.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyState {
    /// Core temperature: that of the blood and behind the slab, deg C.
    pub core_c: f64,
    /// Node temperatures from the surface on, deg C.
    pub node_c: Vec<f64>,
}

/// Steady state with a given surface temperature, deg C, and a given heat flux from the surface to the surroundings,
/// W/m2. The core (blood at full flow, and the back boundary) supplies the heat; none if there is no core and the slab
/// does not balance without one.
pub fn steady_state(slab: &Slab, surface_c: f64, loss_w_m2: f64) -> Option<SteadyState> {
    let n = slab.cells();
    let metabolism: f64 = slab.metabolism_w_m2.iter().sum();
    let mut exchange = slab.blood_w_m2k.clone();
    exchange[n - 1] += slab.back.0;
    if exchange.iter().sum::<f64>() <= 0.0 {
        return (loss_w_m2 == 0.0 && metabolism == 0.0)
            .then(|| SteadyState { core_c: surface_c, node_c: vec![surface_c; n] });
    }
    // Temperatures above the core, eliminated from the depth; every pivot is a sum of positive terms.
    let (mut conductance, mut heat) = (vec![0.0; n], vec![0.0; n]);
    for i in (0..n).rev() {
        conductance[i] = exchange[i];
        heat[i] = slab.metabolism_w_m2[i];
        if i + 1 < n {
            // The deeper cells in series with the link.
            let link = slab.link_w_m2k[i];
            let part = link / (link + conductance[i + 1]);
            conductance[i] += part * conductance[i + 1];
            heat[i] += part * heat[i + 1];
        }
    }
    let mut above_c = vec![(heat[0] - loss_w_m2) / conductance[0]; n];
    for i in 1..n {
        let link = slab.link_w_m2k[i - 1];
        above_c[i] = (link * above_c[i - 1] + heat[i]) / (link + conductance[i]);
    }
    let core_c = surface_c + loss_w_m2 * slab.surface_m2k_w - above_c[0];
    Some(SteadyState { core_c, node_c: above_c.iter().map(|t| core_c + t).collect() })
}
