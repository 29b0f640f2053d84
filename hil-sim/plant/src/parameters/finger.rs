//! The finger's numbers. `skin` is its surface, `finger` the rest.

use super::Source::{ClassValue, Literature, Thesis};
use super::slot::{Slot, slot, under};
use super::spread::{FIXED, factor, relative};
use super::surface;
use crate::finger::{FingerParams, Vessels};
use crate::slab::{Layer, Medium};

pub fn slots(finger: &mut FingerParams) -> Vec<Slot<'_>> {
    let FingerParams {
        surface,
        layers,
        core_w_m2k,
        air_w_m2k,
        vessels,
    } = finger;
    let mut all: Vec<_> = surface::slots("skin", surface, surface::SKIN).collect();
    for (i, one) in layers.iter_mut().enumerate() {
        all.extend(under(&format!("finger.layer.{i}"), layer(one)));
    }
    let core = core_w_m2k.as_mut().map(|core_w_m2k| {
        slot(
            core_w_m2k,
            "core_w_m2k",
            "W/(m2 K)",
            "conductance from the deepest layer to the core; inf: it has the core's temperature",
            FIXED,
            (0.0, f64::INFINITY),
            ClassValue,
        )
    });
    let air = slot(
        air_w_m2k,
        "air_w_m2k",
        "W/(m2 K)",
        "film of air on lifted surfaces of finger and object, radiation included",
        relative(0.5),
        (0.0, 1000.0),
        ClassValue,
    );
    all.extend(under("finger", core.into_iter().chain([air])));
    if let Some(Vessels { open_n, shut_n }) = vessels {
        let force = |value, name, meaning| {
            slot(
                value,
                name,
                "N",
                meaning,
                relative(0.2),
                (0.0, 100.0),
                Thesis("6.4.3"),
            )
        };
        let both = [
            force(open_n, "open_n", "force up to which blood flows in full"),
            force(shut_n, "shut_n", "force from which no blood flows"),
        ];
        all.extend(under("finger.vessels", both));
    }
    all
}

/// Tolerances suit tissue in general: those of the nominal layers, rounded.
fn layer(layer: &mut Layer) -> [Slot<'_>; 5] {
    let Layer {
        thickness_m,
        medium:
            Medium {
                conductivity_w_mk,
                capacity_j_m3k,
                perfusion_w_m3k,
                metabolism_w_m3,
            },
    } = layer;
    [
        slot(
            thickness_m,
            "thickness_m",
            "m",
            "thickness; inf: endless, for the last layer",
            relative(0.23),
            (1e-5, 10.0),
            ClassValue,
        )
        .or_endless(),
        slot(
            conductivity_w_mk,
            "conductivity_w_mk",
            "W/(m K)",
            "conductivity",
            relative(0.1),
            (0.01, 500.0),
            Literature,
        ),
        slot(
            capacity_j_m3k,
            "capacity_j_m3k",
            "J/(m3 K)",
            "heat capacity of a volume",
            relative(0.1),
            (1e4, 1e7),
            Literature,
        ),
        slot(
            perfusion_w_m3k,
            "perfusion_w_m3k",
            "W/(m3 K)",
            "perfusion in 1/s times 4e6 J/(m3 K) of blood",
            factor(4.0),
            (0.0, 1e6),
            ClassValue,
        ),
        slot(
            metabolism_w_m3,
            "metabolism_w_m3",
            "W/m3",
            "heat of metabolism",
            relative(0.5),
            (0.0, 1e5),
            ClassValue,
        ),
    ]
}
