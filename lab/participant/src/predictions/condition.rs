//! Who touches what, and the falls of the skin that follow.

use contact_model::material::{Material, find};
use serde::Serialize;
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_plant::Params;
use thermal_plant::finger::FingerParams;
use thermal_session::ContactRule;

use super::PredictionError;
use crate::device::PreparedDevice;
use crate::falls::{Exploration, TouchSetup};
use crate::{BenchError, HandParams, ObserverParams};

/// Explorations over which falls on displays, and those on samples beside them, are averaged.
const EXPLORATIONS: u32 = 12;

/// Seed of the device's parts.
pub(super) const DEVICE_SEED: u64 = 1;

/// A display mode of section 4.3's experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DisplayMode {
    /// The thesis's display: Eq. 3-1 and a loop of 10 Hz.
    SemiInfinitePi10Hz,
    /// This display: contact resistance and the model's law.
    ContactModel,
}

impl DisplayMode {
    /// Both, the thesis's first.
    pub const ALL: [Self; 2] = [Self::SemiInfinitePi10Hz, Self::ContactModel];

    /// Its words on the line.
    pub const fn words(self) -> &'static str {
        match self {
            Self::SemiInfinitePi10Hz => "semi-infinite/pi-10hz",
            Self::ContactModel => "contact/model",
        }
    }

    pub(super) const fn setting(self) -> (ContactModel, Law) {
        match self {
            Self::SemiInfinitePi10Hz => (ContactModel::SemiInfinite, Law::Pi10Hz),
            Self::ContactModel => (ContactModel::ContactResistance, Law::Model),
        }
    }
}

/// Who touches, and how.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// Skin and room, °C.
    pub skin_room_c: (f64, f64),
    /// Whether the participants lift and replace their fingers, as in the thesis, or touch once.
    pub lifts: bool,
    /// Whether their fingers are layered tissue with blood, or the thesis's half-spaces; displays assume what they are.
    pub is_layered: bool,
}

impl Condition {
    /// The thesis's finger, which is lifted and replaced.
    pub(super) const fn of_thesis(skin_room_c: (f64, f64)) -> Self {
        Self { skin_room_c, lifts: true, is_layered: false }
    }

    pub(super) fn setup(&self) -> TouchSetup {
        let (skin_c, room_c) = self.skin_room_c;
        let mut params = Params::nominal();
        let assumed_finger = if self.is_layered {
            params.finger = FingerParams::layered();
            AssumedFinger::Mean
        } else {
            AssumedFinger::Thesis
        };
        TouchSetup {
            params,
            skin_c,
            room_c,
            hand: HandParams::TYPICAL,
            contact: if self.lifts { ContactRule::Free } else { ContactRule::Hold },
            assumed_finger,
            decision_median_s: ObserverParams::TOUCH.decision_median_s,
            decision_sigma_ln: ObserverParams::TOUCH.decision_sigma_ln,
        }
    }
}

pub(super) fn material(name: &str) -> Result<&'static Material, BenchError> {
    find(name).ok_or_else(|| BenchError::Material(name.into()))
}

/// Mean falls of explorations on samples, and on the display in each of `modes`, K: a row for each material.
pub(super) fn falls_on_samples_and_displays(
    condition: Condition,
    materials: &[&str],
    modes: &[DisplayMode],
) -> Result<Vec<Vec<f64>>, PredictionError> {
    let setup = condition.setup();
    let device = PreparedDevice::new(&setup.params, setup.room_c, DEVICE_SEED, 1)?;
    let explorations: Vec<Exploration> =
        (0..EXPLORATIONS).map(|number| Exploration::new(&setup, number)).collect();
    let of_material = |name: &&str| {
        let material = material(name)?;
        let mut means_k = vec![0.0; 1 + modes.len()];
        for exploration in &explorations {
            means_k[0] += exploration.on_sample(&setup, material)?;
            for (sum_k, mode) in means_k[1..].iter_mut().zip(modes) {
                *sum_k += exploration.on_display(&setup, &device, mode.setting(), name)?;
            }
        }
        Ok(means_k.iter().map(|sum_k| sum_k / f64::from(EXPLORATIONS)).collect())
    };
    materials.iter().map(of_material).collect()
}
