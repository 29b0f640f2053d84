//! A slab at rest.

use super::Slab;

/// Temperatures of a slab that changes no more.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Of the blood and of what lies behind the slab, deg C.
    pub core_c: f64,
    /// Of every node, the nearest to the surface first, deg C.
    pub node_c: Vec<f64>,
}

/// The slab whose surface has the given temperature, deg C, and gives the given flux to what surrounds it, W/m2.
/// What keeps it warm is its core: blood at full flow, and what lies behind it. None if nothing does and it
/// would have to be kept warm.
#[must_use]
pub fn equilibrium(slab: &Slab, surface_c: f64, loss_w_m2: f64) -> Option<Equilibrium> {
    let n = slab.cells();
    let metabolism: f64 = slab.metabolism_w_m2.iter().sum();
    let mut exchange = slab.blood_w_m2k.clone();
    exchange[n - 1] += slab.back.0;
    if exchange.iter().sum::<f64>() <= 0.0 {
        return (loss_w_m2 == 0.0 && metabolism == 0.0).then(|| Equilibrium {
            core_c: surface_c,
            node_c: vec![surface_c; n],
        });
    }
    // Above the core: elimination from the depth, where every pivot is a sum of positive terms.
    let (mut conductance, mut heat) = (vec![0.0; n], vec![0.0; n]);
    for i in (0..n).rev() {
        conductance[i] = exchange[i];
        heat[i] = slab.metabolism_w_m2[i];
        if i + 1 < n {
            // The deeper cells as seen over the link: in series with it.
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
    Some(Equilibrium {
        core_c,
        node_c: above_c.iter().map(|t| core_c + t).collect(),
    })
}
