//! Camera: noise, apparent temperature and recovered temperature.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal};
use thiserror::Error;

use super::{
    Optic, OpticalPath, RANGE_C, SKIN_EMISSIVITY, SelfReflection, Surroundings, radiance,
    radiance_per_k, temperature_c,
};

/// Temperature of the black body at which the noise of a camera is specified, deg C.
const NETD_AT_C: f64 = 30.0;

/// Parameters of the instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraParams {
    /// Optics between target and camera.
    pub optic: Optic,
    /// Emissivity of the target, above 0 to 1; the inversion assumes the same value.
    pub emissivity: f64,
    /// Noise-equivalent temperature difference (NETD) of one pixel in one frame: standard deviation of the apparent
    /// temperature of a black body of 30 deg C, K. The noise of the signal is Gaussian and independent of its level.
    pub netd_k: f64,
    /// Number of pixels averaged into a reading; their noise is independent.
    pub pixels: u32,
    /// Reflection of the camera in the window, if any. The inversion neglects it.
    pub self_reflection: Option<SelfReflection>,
}

impl CameraParams {
    /// The thesis's instrument: skin, one pixel, no self-reflection. The thesis states no noise; 0.08 K is typical of
    /// its camera, an uncooled bolometer of 2006.
    pub fn thesis(optic: Optic) -> Self {
        Self { optic, emissivity: SKIN_EMISSIVITY, netd_k: 0.08, pixels: 1, self_reflection: None }
    }
}

/// A parameter out of range.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{name} {value}; allowed is {allowed}")]
pub struct ParameterError {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Allowed range, in words.
    pub allowed: &'static str,
}

/// One reading of a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Radiance at the camera, noise included, W/(m² sr).
    pub u_tot: f64,
    /// Apparent temperature: that of a black body of the same radiance, deg C.
    pub apparent_c: f64,
    /// Temperature of the target recovered with the thesis's inversion, deg C.
    pub recovered_c: f64,
}

/// A camera that measures one target. A reading allocates no memory.
#[derive(Clone, Debug)]
pub struct Camera {
    /// True optical path.
    path: OpticalPath,
    /// Optical path that the inversion assumes.
    assumed: OpticalPath,
    /// Standard deviation of a reading's signal, W/(m² sr).
    noise: f64,
    random: Xoshiro256PlusPlus,
}

impl Camera {
    /// A camera in constant surroundings; the seed determines its noise.
    ///
    /// # Errors
    /// Emissivity not in (0, 1], NETD negative or not finite, no pixels, share not in 0 to 1, or a temperature
    /// outside of [`RANGE_C`].
    pub fn new(
        params: &CameraParams,
        surroundings: &Surroundings,
        seed: u64,
    ) -> Result<Self, ParameterError> {
        check(params, surroundings)?;
        let assumed = OpticalPath::new(params.optic, params.emissivity, surroundings);
        let path = params.self_reflection.map_or(assumed, |camera| {
            assumed.with_self_reflection(params.optic, &camera, surroundings.ambient_c)
        });
        Ok(Self {
            path,
            assumed,
            noise: params.netd_k * radiance_per_k(NETD_AT_C) / f64::from(params.pixels).sqrt(),
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
        })
    }

    /// Measures a target of a true temperature, deg C, within [`RANGE_C`]. Each reading has its own noise.
    pub fn read(&mut self, target_c: f64) -> Reading {
        let normal: f64 = StandardNormal.sample(&mut self.random);
        let u_tot = self.path.total_radiance(radiance(target_c)) + self.noise * normal;
        let apparent_c = temperature_c(u_tot);
        Reading { u_tot, apparent_c, recovered_c: self.recovered_c(apparent_c) }
    }

    /// Temperature of the target, deg C, from the apparent temperature, deg C: Eq. 5-3 or 5-4 solved for the target.
    /// Limited to [`RANGE_C`].
    pub fn recovered_c(&self, apparent_c: f64) -> f64 {
        temperature_c(self.assumed.target_radiance(radiance(apparent_c)))
    }
}

fn check(params: &CameraParams, surroundings: &Surroundings) -> Result<(), ParameterError> {
    let ensure = |holds: bool, name, value, allowed| {
        if holds { Ok(()) } else { Err(ParameterError { name, value, allowed }) }
    };
    let temperature =
        |name, value: f64| ensure(RANGE_C.contains(&value), name, value, "-100 to 200");
    let emissivity = params.emissivity;
    ensure(emissivity > 0.0 && emissivity <= 1.0, "emissivity", emissivity, "above 0 to 1")?;
    ensure(
        params.netd_k >= 0.0 && params.netd_k.is_finite(),
        "netd_k",
        params.netd_k,
        "a finite number from 0 on",
    )?;
    ensure(params.pixels > 0, "pixels", f64::from(params.pixels), "1 or more")?;
    temperature("ambient_c", surroundings.ambient_c)?;
    temperature("window_c", surroundings.window_c)?;
    temperature("splitter_c", surroundings.splitter_c)?;
    if let Some(SelfReflection { camera_c, share }) = params.self_reflection {
        temperature("camera_c", camera_c)?;
        ensure((0.0..=1.0).contains(&share), "camera_share", share, "0 to 1")?;
    }
    Ok(())
}
