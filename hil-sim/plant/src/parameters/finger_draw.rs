//! Fingers drawn from more than the parameter box: what differs between people, and where a finger was before its contact.

use serde::Serialize;

use super::table::{self, SKIN};
use super::tolerance::{Tolerance, between, factor, relative};
use crate::finger::FingerParams;

/// What was drawn of a finger besides the parameters of its tissue.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FingerDraw {
    /// Seed.
    pub seed: u64,
    /// Factor on the effusivity of every layer.
    pub effusivity_factor: f64,
    /// Factor on the contact resistance, on display and object alike.
    pub resistance_factor: f64,
    /// What was drawn of a layered finger.
    pub tissue: Option<TissueDraw>,
}

/// What was drawn of a layered finger.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TissueDraw {
    /// Epidermis.
    pub epidermis: Epidermis,
    /// Blood flow under force.
    pub blood: BloodUnderForce,
    /// Place before the contact.
    pub before: PlaceBeforeContact,
}

/// Shape of an epidermis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Epidermis {
    /// Of the parameter box.
    Box,
    /// Thick, of low conductivity.
    Callus,
    /// Thin.
    Thin,
}

/// Effect of the contact force on the flow of blood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BloodUnderForce {
    /// The flow stays full.
    Open,
    /// The force stops the flow, as in section 6.4.3.
    ShutByForce,
}

/// Where a finger was before its contact, and between contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlaceBeforeContact {
    /// In air.
    Air,
    /// On a pad that insulates it.
    Pad,
}

/// Factor on the effusivity of tissue: its spread between people.
const EFFUSIVITY: Tolerance = relative(0.2);
/// Factor on the contact resistance: its spread between people and with moisture.
const RESISTANCE: Tolerance = factor(2.0);
/// Thickness of a thin epidermis, m: below that of the box.
const THIN_EPIDERMIS_M: Tolerance = between(0.26e-3, 0.5e-3);
/// Thickness of a callus, m: above that of the box.
const CALLUS_THICKNESS_M: Tolerance = between(0.8e-3, 1.4e-3);
/// Conductivity of a callus, W/(m K), which is dry.
const CALLUS_W_MK: Tolerance = between(0.14, 0.19);
/// Film coefficient of a finger in still to moving air, W/(m2 K).
const AIR_W_M2K: Tolerance = between(5.0, 15.0);
/// Film coefficient of a finger on a pad of 10 to 60 mm of foam, W/(m2 K).
const PAD_W_M2K: Tolerance = between(0.5, 3.0);

/// Draws a finger around the given one. Of a homogeneous finger, and of one whose tissue is not to be drawn, that is one
/// factor on its effusivity, which leaves diffusivities and perfusion as they are, and one on its contact resistance. Of a
/// layered finger, whose first layer is the epidermis, the tissue is drawn first, from the box and from shapes outside of
/// it.
pub fn draw_finger(finger: &mut FingerParams, seed: u64, with_tissue: bool) -> FingerDraw {
    let drawn = |tolerance: Tolerance, nominal, name: &str| {
        tolerance.draw(nominal, seed, &format!("finger.draw.{name}"))
    };
    // Uniform from 0 to 1.
    let part = |name| drawn(between(0.0, 1.0), 0.0, name);
    let tissue = with_tissue.then(|| {
        for mut entry in table::finger(finger) {
            if !entry.is_of(SKIN) {
                entry.draw(seed);
            }
        }
        let epidermis = match part("epidermis") {
            part if part < 0.5 => Epidermis::Box,
            part if part < 0.75 => Epidermis::Callus,
            _ => Epidermis::Thin,
        };
        if let Some(layer) = finger.layers.first_mut() {
            match epidermis {
                Epidermis::Box => {}
                Epidermis::Callus => {
                    layer.thickness_m = drawn(CALLUS_THICKNESS_M, 0.0, "callus_m");
                    layer.medium.conductivity_w_mk = drawn(CALLUS_W_MK, 0.0, "callus_w_mk");
                }
                Epidermis::Thin => layer.thickness_m = drawn(THIN_EPIDERMIS_M, 0.0, "thin_m"),
            }
        }
        let blood = if part("blood") < 0.5 {
            finger.vessels = None;
            BloodUnderForce::Open
        } else {
            BloodUnderForce::ShutByForce
        };
        let (before, film) = if part("before") < 0.5 {
            (PlaceBeforeContact::Air, AIR_W_M2K)
        } else {
            (PlaceBeforeContact::Pad, PAD_W_M2K)
        };
        finger.air_w_m2k = drawn(film, 0.0, "film_w_m2k");
        TissueDraw { epidermis, blood, before }
    });
    let draw = FingerDraw {
        seed,
        effusivity_factor: drawn(EFFUSIVITY, 1.0, "effusivity"),
        resistance_factor: drawn(RESISTANCE, 1.0, "resistance"),
        tissue,
    };
    for layer in &mut finger.layers {
        layer.medium.conductivity_w_mk *= draw.effusivity_factor;
        layer.medium.capacity_j_m3k *= draw.effusivity_factor;
    }
    finger.resistance_factor *= draw.resistance_factor;
    draw
}

#[cfg(test)]
mod tests;
