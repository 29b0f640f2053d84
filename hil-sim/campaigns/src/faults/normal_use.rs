//! Normal use: sessions without a fault on randomly drawn plants, in which the device must not trip.

use std::fmt::Write;

use contact_model::material::MATERIALS;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use serde::Serialize;
use thermal_device::control::Law;
use thermal_plant::parameters::stream_seed;
use thermal_sim::SceneRunner;
use thermal_sim::metrics::Extremes;
use thermal_sim::scene::Scene;

use super::drawn_course::course_tables;
use super::{Touch, scene_text};
use crate::fidelity::PlantDraw;

/// Length of a session, s, after the time in which the device is armed and settles.
const SESSION_S: f64 = 120.0;
/// Length including that time, s.
const WHOLE_S: f64 = 128.0;
/// Consecutive sessions on one device, which is commissioned before the first.
const ON_ONE_DEVICE: u64 = 8;
/// Fraction of sessions in which the display is held at a temperature, as for calibration.
const HELD: f64 = 0.125;
/// Fraction of sessions in which the host plays courses, one after the other, in place of an object.
const PLAYED: f64 = 0.125;
/// Time from one course to the next, s.
const PLAYED_EVERY_S: f64 = 20.0;
/// Noise of a conversion, counts: the whole range of the parameter, which is not among the drawn ones.
const NOISE_COUNTS: std::ops::RangeInclusive<f64> = 0.4..=1.2;
/// Range of the forces, N, drawn with a uniform logarithm.
const FORCE_N: (f64, f64) = (0.1, 5.0);

/// A session with a fault-free device.
#[derive(Clone, Debug, PartialEq)]
pub struct UseSession {
    /// Number of the session, from 0.
    pub number: u64,
    /// Text of its scene.
    pub text: String,
}

impl UseSession {
    /// Number of sessions in some hours.
    #[must_use]
    pub fn in_hours(hours: u64) -> u64 {
        (hours as f64 * 3600.0 / WHOLE_S).ceil() as u64
    }

    /// Draws a session; it depends only on seed and number.
    #[must_use]
    pub fn new(seed: u64, number: u64) -> Self {
        let mut draw =
            Xoshiro256PlusPlus::seed_from_u64(stream_seed(seed, &format!("session {number}")));
        let device = PlantDraw::in_use(seed, number / ON_ONE_DEVICE);
        let (material, _) = MATERIALS[draw.random_range(0..MATERIALS.len())];
        let (law, _) = Law::PROTOCOL_WORDS[draw.random_range(0..Law::PROTOCOL_WORDS.len())];
        let skin_c = draw.random_range(30.0..=36.0);
        let object_c = draw.random_range(17.0..=41.0);
        let held_c = draw
            .random_bool(HELD)
            .then(|| draw.random_range(15.0..=42.0));
        let course_seed = stream_seed(seed, &format!("session {number} course"));
        let plays =
            held_c.is_none() && Xoshiro256PlusPlus::seed_from_u64(course_seed).random_bool(PLAYED);
        let appears_s = match held_c {
            _ if plays => SESSION_S,
            Some(_) => SESSION_S,
            None if draw.random_bool(0.25) => draw.random_range(0.0..=20.0),
            None => 0.0,
        };
        let touch = Touch::new(
            stream_seed(seed, &format!("session {number} touch")),
            material,
        );
        let mut text = format!(
            "duration_s = {SESSION_S:?}\nskin_c = {skin_c:?}\nroom_c = 24\nseed = {}\nlaw = \"{law}\"\n[device]\n{}\
             [object]\nmaterial = \"{material}\"\nstart_c = {object_c:?}\nappears_t_s = {appears_s:?}\n{}{}",
            device.seed, touch.device, touch.object, touch.tables
        );
        let mut t_s = draw.random_range(0.1..=3.0);
        while t_s < SESSION_S - 1.0 {
            let part: f64 = draw.random();
            let force_n = FORCE_N.0 * (FORCE_N.1 / FORCE_N.0).powf(part);
            let ramp_s = draw.random_range(0.001..=0.3);
            text += &press(t_s, force_n, ramp_s);
            t_s += ramp_s + draw.random_range(0.3..=15.0);
            if t_s < SESSION_S - 1.0 && draw.random_bool(0.7) {
                text += &press(t_s, 0.0, 0.02);
                t_s += 0.02 + draw.random_range(0.3..=5.0);
            }
        }
        if let Some(held_c) = held_c {
            text += &scene_text::host_line(&format!("hold {held_c:.3}"), 0.1);
        }
        if plays {
            for part in 0..(SESSION_S / PLAYED_EVERY_S) as u32 {
                let seed = stream_seed(course_seed, &format!("part {part}"));
                let t_s = 0.1 + f64::from(part) * PLAYED_EVERY_S;
                text += &course_tables(seed, t_s, SESSION_S);
            }
        }
        let mut device_draw = Xoshiro256PlusPlus::seed_from_u64(stream_seed(device.seed, "noise"));
        let noise_counts = device_draw.random_range(NOISE_COUNTS);
        text += "[plant]\n";
        text += &touch.plant;
        text += &format!("sensors.converter.noise_counts = {noise_counts:?}\n");
        for (key, value) in &device.plant {
            text += &format!("{key} = {value:?}\n");
        }
        Self { number, text }
    }

    /// Runs the session.
    #[must_use]
    pub fn run(&self, device: &dyn SceneRunner) -> SessionResult {
        let run = || -> anyhow::Result<_> {
            let scene = Scene::parse(&self.text, "session".as_ref())?;
            let (_, figures) = device.run(&scene)?;
            Ok(figures)
        };
        match run() {
            Err(error) => SessionResult {
                number: self.number,
                skin_c: None,
                cem43_min: None,
                failure: Some(format!("{error:#}")),
            },
            Ok(figures) => {
                let mut trips: Vec<_> = (figures.faults.into_iter())
                    .map(|tripped| tripped.fault)
                    .collect();
                trips.extend(figures.resets.iter().map(|_| "reset".into()));
                SessionResult {
                    number: self.number,
                    skin_c: Some(figures.skin_c),
                    cem43_min: Some(figures.cem43_min),
                    failure: (!trips.is_empty()).then(|| trips.join(", ")),
                }
            }
        }
    }
}

fn press(t_s: f64, force_n: f64, ramp_s: f64) -> String {
    format!("[[force]]\nt_s = {t_s:?}\nforce_n = {force_n:?}\nramp_s = {ramp_s:?}\n")
}

/// Result of a session.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SessionResult {
    /// Number of the session.
    pub number: u64,
    /// Skin on the display, °C.
    pub skin_c: Option<Extremes>,
    /// Dose of the skin, CEM43 in minutes.
    pub cem43_min: Option<f64>,
    /// Trips and resets, or why the session or the commissioning of its device failed.
    pub failure: Option<String>,
}

/// Table of time, failures and skin temperatures, followed by every failed session.
#[must_use]
pub fn session_table(used: &[SessionResult]) -> String {
    let skins = || used.iter().filter_map(|one| one.skin_c);
    let failed = || used.iter().filter(|one| one.failure.is_some());
    let mut text = format!(
        "sessions       {:>9}\nhours          {:>9.2}\nfailed         {:>9}\ncoldest skin C {:>9.2}\nwarmest skin C \
         {:>9.2}\nCEM43 min      {:>9.3}\n",
        used.len(),
        used.len() as f64 * WHOLE_S / 3600.0,
        failed().count(),
        skins().map(|skin| skin.min).fold(f64::INFINITY, f64::min),
        skins()
            .map(|skin| skin.max)
            .fold(f64::NEG_INFINITY, f64::max),
        used.iter()
            .filter_map(|one| one.cem43_min)
            .fold(0.0, f64::max),
    );
    for one in failed() {
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "number {}: {}",
            one.number,
            one.failure.as_deref().unwrap_or_default()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_session_is_a_scene_without_faults() {
        for number in 0..300 {
            let session = UseSession::new(5, number);
            let scene = Scene::parse(&session.text, "session".as_ref()).expect("a scene");
            assert!(scene.faults.is_empty() && scene.injections.is_empty() && scene.commissioned);
            assert!(scene.forces.iter().any(|force| force.force_n >= 0.1));
            assert_eq!(scene.duration_s + scene.settle_s, WHOLE_S);
        }
    }

    #[test]
    fn sessions_repeat_by_seed_and_number_and_differ_between_them() {
        assert_eq!(UseSession::new(5, 3), UseSession::new(5, 3));
        assert_ne!(UseSession::new(5, 3).text, UseSession::new(5, 4).text);
        assert_ne!(UseSession::new(5, 3).text, UseSession::new(6, 3).text);
    }
}
