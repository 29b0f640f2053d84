//! The infrared camera of a scene.

use std::ops::Range;

use thermal_plant::infrared::{
    Camera, CameraParams, Optic, ParameterError, SelfReflection, Surroundings,
};
use thermal_plant::parameters::stream_seed;
use toml::Spanned;

use super::file::{self, Glass};
use super::source::{SceneError, Source};

/// Default frame rate, Hz: typical of uncooled cameras.
const RATE_HZ: f64 = 30.0;

/// The infrared camera that observes the skin on the real object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Infrared {
    /// Parameters of the camera.
    pub params: CameraParams,
    /// Temperatures around the camera.
    pub surroundings: Surroundings,
    /// Frame rate, Hz, above 0 and at most 1000. The first frame is at time zero.
    pub rate_hz: f64,
}

impl Infrared {
    /// The camera; its noise has its own random stream of the scene's seed.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn camera(&self, seed: u64) -> Result<Camera, ParameterError> {
        Camera::new(&self.params, &self.surroundings, stream_seed(seed, "infrared"))
    }

    /// Whether there is a frame in the millisecond that ends `ms` after time zero.
    pub fn has_frame(&self, ms: u64) -> bool {
        let frame = |ms: u64| (ms as f64 * self.rate_hz / 1e3 + SLACK).floor();
        ms.checked_sub(1).is_none_or(|before| frame(ms) > frame(before))
    }
}

/// Tolerance for rounding, frames.
const SLACK: f64 = 1e-9;

/// Checks the camera's table.
pub(super) fn infrared(
    source: &Source<'_>,
    file: &Spanned<file::Infrared>,
    room_c: f64,
) -> Result<Infrared, SceneError> {
    let table = file.get_ref();
    let optic = match table.optic.get_ref() {
        Glass::None => Optic::None,
        Glass::Baf2 => Optic::Baf2,
        Glass::Zns => Optic::Zns,
    };
    for (key, number) in [
        ("window_c", &table.window_c),
        ("splitter_c", &table.splitter_c),
        ("camera_c", &table.camera_c),
    ] {
        if let (Optic::None, Some(number)) = (optic, number) {
            let problem =
                format!("infrared.{key} beside optic = \"none\"; allowed is {key} beside a window");
            return Err(source.error(Some(number.span()), problem));
        }
    }
    if let (None, Some(share)) = (&table.camera_c, &table.camera_share) {
        let problem = "infrared.camera_share without infrared.camera_c; allowed is both";
        return Err(source.error(Some(share.span()), problem));
    }
    let usual = CameraParams::thesis(optic);
    let or =
        |number: &Option<file::Number>, usual: f64| number.as_ref().map_or(usual, |n| *n.get_ref());
    let infrared = Infrared {
        params: CameraParams {
            optic,
            emissivity: or(&table.emissivity, usual.emissivity),
            netd_k: or(&table.netd_k, usual.netd_k),
            pixels: table.pixels.as_ref().map_or(usual.pixels, |n| *n.get_ref()),
            self_reflection: table.camera_c.as_ref().map(|camera_c| SelfReflection {
                camera_c: *camera_c.get_ref(),
                share: or(&table.camera_share, 1.0),
            }),
        },
        surroundings: Surroundings {
            ambient_c: room_c,
            window_c: or(&table.window_c, room_c),
            splitter_c: or(&table.splitter_c, room_c),
        },
        rate_hz: source.within_or(RATE_HZ, "infrared.rate_hz", &table.rate_hz, 0.001, 1000.0)?,
    };
    match infrared.camera(0) {
        Ok(_) => Ok(infrared),
        Err(ParameterError { name, value, allowed }) => {
            let problem = format!("infrared.{name} = {value}; allowed is {allowed}");
            Err(source.error(Some(span(table, name).unwrap_or_else(|| file.span())), problem))
        }
    }
}

/// Position of the value of a camera parameter.
fn span(table: &file::Infrared, name: &str) -> Option<Range<usize>> {
    let number = match name {
        "pixels" => return table.pixels.as_ref().map(Spanned::span),
        "emissivity" => &table.emissivity,
        "netd_k" => &table.netd_k,
        "window_c" => &table.window_c,
        "splitter_c" => &table.splitter_c,
        "camera_c" => &table.camera_c,
        "camera_share" => &table.camera_share,
        _ => return None,
    };
    number.as_ref().map(Spanned::span)
}
