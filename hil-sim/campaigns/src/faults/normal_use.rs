//! Normal use: sessions without a fault on randomly drawn plants, in which the device must not trip.

use std::fmt::Write;

use contact_model::material::THESIS_MATERIALS;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use serde::Serialize;
use thermal_device::control::Law;
use thermal_plant::parameters::stream_seed;
use thermal_sim::SceneRunner;
use thermal_sim::metrics::Extremes;
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;

use super::drawn_course::course_tables;
use super::touch::{FORCE_N, LAYERED_SKIN_MAX_C, SKINS_C, log_uniform};
use super::{DrawnDevice, Touch, scene_text};
use thermal_device::Vocabulary as _;

/// Length of a session, s, after the time in which the device is armed and settles.
const SESSION_S: f64 = 120.0;
/// Length including that time, s.
const WHOLE_S: f64 = 128.0;
/// Fraction of sessions in which the display is held at a temperature, as for calibration.
const HELD: f64 = 0.125;
/// Fraction of sessions in which the host plays courses, one after the other, in place of an object.
const PLAYED: f64 = 0.125;
/// Time from one course to the next, s.
const PLAYED_EVERY_S: f64 = 20.0;
/// Time from one question about the finger to the next, s: less than from a landing to the next.
const ASKED_EVERY_S: f64 = 0.25;
/// Noise of a conversion, counts: the whole range of the parameter, which is not among the drawn ones.
const NOISE_COUNTS: std::ops::RangeInclusive<f64> = 0.4..=1.2;

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
    pub fn in_hours(hours: u64) -> u64 {
        (hours as f64 * 3600.0 / WHOLE_S).ceil() as u64
    }

    /// Draws a session; it depends only on seed and number. With a heat-flux sensor every finger is drawn, and the device is asked
    /// what it knows of it.
    pub fn new(seed: u64, number: u64, with_flux_sensor: bool) -> Self {
        let mut draw =
            Xoshiro256PlusPlus::seed_from_u64(stream_seed(seed, &format!("session {number}")));
        let mut device = DrawnDevice::new(seed, number / DrawnDevice::CAMPAIGNS);
        let material = THESIS_MATERIALS[draw.random_range(0..THESIS_MATERIALS.len())];
        let law = Law::WORDS.words[draw.random_range(0..Law::WORDS.words.len())];
        let object_c = draw.random_range(17.0..=41.0);
        let held_c = draw.random_bool(HELD).then(|| draw.random_range(15.0..=42.0));
        let course_seed = stream_seed(seed, &format!("session {number} course"));
        let plays =
            held_c.is_none() && Xoshiro256PlusPlus::seed_from_u64(course_seed).random_bool(PLAYED);
        let appears_s = match held_c {
            _ if plays => SESSION_S,
            Some(_) => SESSION_S,
            None if draw.random_bool(0.25) => draw.random_range(0.0..=20.0),
            None => 0.0,
        };
        let touch_seed = stream_seed(seed, &format!("session {number} touch"));
        let touch = if with_flux_sensor {
            let skin_c = draw.random_range(*SKINS_C.start()..=LAYERED_SKIN_MAX_C);
            let mut touch = Touch { skin_c, ..Touch::learnt(touch_seed) };
            touch.draw_flux_errors(device.seed);
            touch
        } else {
            Touch::new(touch_seed, material)
        };
        let mut text = format!(
            "duration_s = {SESSION_S:?}\nskin_c = {:?}\nlaw = \"{law}\"\n{}{}\
             [object]\nmaterial = \"{material}\"\nstart_c = {object_c:?}\nappears_t_s = {appears_s:?}\n{}{}",
            touch.skin_c,
            device.keys(),
            touch.device,
            touch.object,
            touch.tables
        );
        let mut t_s = draw.random_range(0.1..=3.0);
        while t_s < SESSION_S - 1.0 {
            let force_n = log_uniform(&mut draw, FORCE_N);
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
        if with_flux_sensor {
            for part in 1..(SESSION_S / ASKED_EVERY_S) as u32 {
                text += &scene_text::host_line("flux", f64::from(part) * ASKED_EVERY_S);
            }
        }
        let mut device_draw = Xoshiro256PlusPlus::seed_from_u64(stream_seed(device.seed, "noise"));
        let noise_counts = device_draw.random_range(NOISE_COUNTS);
        device.plant.insert("sensors.converter.noise_counts".into(), noise_counts);
        text += "[plant]\n";
        text += &touch.plant;
        text += &device.plant_keys();
        Self { number, text }
    }

    /// Runs the session.
    pub fn run(&self, device: &dyn SceneRunner) -> SessionResult {
        let run = || -> anyhow::Result<_> {
            let scene = Scene::parse(&self.text, "session".as_ref())?;
            device.run(&scene)
        };
        match run() {
            Err(error) => SessionResult {
                number: self.number,
                skin_c: None,
                cem43_min: None,
                distrusts: Vec::new(),
                failure: Some(format!("{error:#}")),
            },
            Ok((outcome, figures)) => {
                let trips = figures.trips_and_resets();
                SessionResult {
                    number: self.number,
                    skin_c: Some(figures.skin_c),
                    cem43_min: Some(figures.cem43_min),
                    distrusts: distrusts(&outcome),
                    failure: (!trips.is_empty()).then(|| trips.join(", ")),
                }
            }
        }
    }
}

/// Words for which the finger was not learnt, and when they were first heard, s.
fn distrusts(outcome: &Outcome) -> Vec<(f64, String)> {
    let mut last = "";
    let mut distrusts = Vec::new();
    for (t_s, line) in &outcome.answers {
        let Some((_, word)) = line.split_once(" finger=") else {
            continue;
        };
        if word != last && !["learning", "trusted"].contains(&word) {
            distrusts.push((*t_s, word.into()));
        }
        last = word;
    }
    distrusts
}

pub(super) fn press(t_s: f64, force_n: f64, ramp_s: f64) -> String {
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
    /// Words for which a finger was not learnt in spite of a heat-flux sensor, and when each was first heard, s.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub distrusts: Vec<(f64, String)>,
    /// Trips and resets, or why the session or the commissioning of its device failed.
    pub failure: Option<String>,
}

/// Table of time, failures and skin temperatures, followed by every failed session.
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
        skins().map(|skin| skin.max).fold(f64::NEG_INFINITY, f64::max),
        used.iter().filter_map(|one| one.cem43_min).fold(0.0, f64::max),
    );
    let distrusted = used.iter().filter(|one| !one.distrusts.is_empty());
    let count: usize = distrusted.clone().map(|one| one.distrusts.len()).sum();
    let _ = writeln!(text, "distrusts      {count:>9}");
    for one in distrusted {
        let words = one.distrusts.iter();
        let words: Vec<_> = words.map(|(t_s, word)| format!("{word} at {t_s:.2} s")).collect();
        let _ = writeln!(text, "number {}: {}", one.number, words.join(", "));
    }
    for one in failed() {
        // Writing to a String cannot fail.
        let _ =
            writeln!(text, "number {}: {}", one.number, one.failure.as_deref().unwrap_or_default());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_session_is_a_scene_without_faults() {
        for number in 0..300 {
            let session = UseSession::new(5, number, number % 2 == 0);
            let scene = Scene::parse(&session.text, "session".as_ref()).expect("a scene");
            assert!(scene.faults.is_empty() && scene.injections.is_empty());
            assert!(scene.forces.iter().any(|force| force.force_n >= 0.1));
            assert_eq!(scene.duration_s + scene.settle_s, WHOLE_S);
        }
    }

    #[test]
    fn sessions_repeat_by_seed_and_number_and_differ_between_them() {
        assert_eq!(UseSession::new(5, 3, false), UseSession::new(5, 3, false));
        assert_ne!(UseSession::new(5, 3, false).text, UseSession::new(5, 4, false).text);
        assert_ne!(UseSession::new(5, 3, false).text, UseSession::new(6, 3, false).text);
    }
}
