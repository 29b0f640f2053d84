//! Parameters of the finger. `skin` is its surface, `finger` the rest.

use super::Source::{ClassValue, Estimate, Literature, Thesis};
use super::entry::{Entry, entry, prefixed};
use super::surface;
use super::tolerance::{FIXED, factor, relative};
use crate::finger::{FingerParams, Vessels};
use crate::slab::{Layer, Medium};

/// Name of the finger's surface.
pub const SKIN: &str = "skin";

pub fn entries(finger: &mut FingerParams) -> Vec<Entry<'_>> {
    let FingerParams { surface, resistance_factor, layers, core_w_m2k, air_w_m2k, vessels } =
        finger;
    let mut all: Vec<_> = surface::entries(SKIN, surface, surface::SKIN).collect();
    let resistance = entry!(
        resistance_factor,
        "1",
        "factor on its contact resistance, on display and object alike; finger.draw draws it",
        FIXED,
        (0.01, 100.0),
        Estimate("0.5 to 2 between people and moist and dry skin"),
    );
    all.extend(prefixed("finger", [resistance]));
    for (i, one) in layers.iter_mut().enumerate() {
        all.extend(prefixed(&format!("finger.layer.{i}"), layer(one)));
    }
    let core = core_w_m2k.as_mut().map(|core_w_m2k| {
        entry!(
            core_w_m2k,
            "W/(m2 K)",
            "conductance from the deepest layer to the core; inf: it has the core's temperature",
            FIXED,
            (0.0, f64::INFINITY),
            ClassValue,
        )
    });
    let air = entry!(
        air_w_m2k,
        "W/(m2 K)",
        "film of air on lifted surfaces of finger and object, radiation included",
        relative(0.5),
        (0.0, 1000.0),
        ClassValue,
    );
    all.extend(prefixed("finger", core.into_iter().chain([air])));
    if let Some(Vessels { open_n, shut_n }) = vessels {
        let forces = [
            entry!(
                open_n,
                "N",
                "force up to which blood flows in full",
                relative(0.2),
                (0.0, 100.0),
                Thesis("6.4.3"),
            ),
            entry!(
                shut_n,
                "N",
                "force from which no blood flows",
                relative(0.2),
                (0.0, 100.0),
                Thesis("6.4.3"),
            ),
        ];
        all.extend(prefixed("finger.vessels", forces));
    }
    all
}

/// The tolerances are those of the nominal layers, rounded, and apply to any tissue.
fn layer(layer: &mut Layer) -> [Entry<'_>; 5] {
    let Layer {
        thickness_m,
        medium: Medium { conductivity_w_mk, capacity_j_m3k, perfusion_w_m3k, metabolism_w_m3 },
    } = layer;
    [
        entry!(
            thickness_m,
            "m",
            "thickness; inf: endless, for the last layer",
            relative(0.23),
            (1e-5, 10.0),
            ClassValue,
        )
        .or_infinite(),
        entry!(
            conductivity_w_mk,
            "W/(m K)",
            "conductivity",
            relative(0.1),
            (0.01, 500.0),
            Literature,
        ),
        entry!(
            capacity_j_m3k,
            "J/(m3 K)",
            "heat capacity of a volume",
            relative(0.1),
            (1e4, 1e7),
            Literature,
        ),
        entry!(
            perfusion_w_m3k,
            "W/(m3 K)",
            "perfusion in 1/s times 4e6 J/(m3 K) of blood",
            factor(4.0),
            (0.0, 1e6),
            ClassValue,
        ),
        entry!(
            metabolism_w_m3,
            "W/m3",
            "heat of metabolism",
            relative(0.5),
            (0.0, 1e5),
            ClassValue,
        ),
    ]
}
