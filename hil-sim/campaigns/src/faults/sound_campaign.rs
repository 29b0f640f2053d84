//! Campaigns without a fault: drawn commands, fingers and devices, tuned and untuned, under which the true surface of the display
//! must stay within narrower limits than with a fault.

use std::collections::BTreeMap;
use std::fmt::Write;

use contact_model::material::THESIS_MATERIALS;
use rand::rngs::Xoshiro256PlusPlus;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use serde::Serialize;
use thermal_device::control::Law;
use thermal_plant::parameters::stream_seed;
use thermal_sim::SceneRunner;
use thermal_sim::metrics::Extremes;
use thermal_sim::scene::Scene;

use super::DrawnDevice;
use super::drawn_course::course_tables;
use super::normal_use::press;
use super::scene_text::host_line;
use super::touch::{FORCE_N, SKINS_C, log_uniform};
use thermal_device::Vocabulary as _;

/// True surface of the display without a fault, °C.
const SURFACE_C: (f64, f64) = (14.0, 43.0);
/// Skin without a fault, °C.
const SKIN_C: (f64, f64) = (14.0, 42.5);
/// Length of a campaign, s.
const DURATION_S: f64 = 30.0;

/// A drawn device, finger and sequence of commands, without a fault.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundCampaign {
    /// Number of the campaign, from 0.
    pub number: u64,
    /// Text of its scene.
    pub text: String,
    group: Group,
}

/// What the summary has a line for: whether the tile was tuned, the law at the start, and the lag of the display's thermistors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
struct Group {
    tuned: bool,
    law: &'static str,
    lag: &'static str,
}

/// Longest lag of each band, s, and how the band is printed.
const LAG_BANDS: [(f64, &str); 3] = [(0.15, "to 0.15 s"), (0.3, "to 0.3 s"), (0.5, "to 0.5 s")];

fn lag_band(lag_s: f64) -> &'static str {
    let band = LAG_BANDS.into_iter().find(|(longest_s, _)| lag_s <= *longest_s);
    band.map_or("longer", |(_, name)| name)
}

impl SoundCampaign {
    /// Draws a campaign; it depends only on seed and number.
    pub fn new(seed: u64, number: u64) -> Self {
        let device = DrawnDevice::new(seed, number / DrawnDevice::CAMPAIGNS);
        let own = stream_seed(seed, &format!("sound campaign {number}"));
        let mut draw = Xoshiro256PlusPlus::seed_from_u64(own);
        let law = Law::WORDS.words[draw.random_range(0..Law::WORDS.words.len())];
        let material = THESIS_MATERIALS[draw.random_range(0..THESIS_MATERIALS.len())];
        let appears_s = [0.0, DURATION_S][usize::from(draw.random_bool(0.5))];
        let mut text = format!(
            "duration_s = {DURATION_S:?}\nskin_c = {:?}\nlaw = \"{law}\"\n{}[object]\nmaterial = \"{material}\"\n\
             start_c = {:?}\nappears_t_s = {appears_s:?}\n",
            draw.random_range(SKINS_C),
            device.keys(),
            draw.random_range(18.0..=41.0),
        );
        text += &forces(&mut draw);
        let mut t_s = draw.random_range(0.05..=1.0);
        while t_s < DURATION_S - 0.5 {
            text += &commands(&mut draw, t_s);
            t_s += log_uniform(&mut draw, (0.02, 12.0));
        }
        text += "[plant]\n";
        text += &device.plant_keys();
        Self {
            number,
            text,
            group: Group {
                tuned: device.tuned,
                law,
                lag: lag_band(device.lag_s().unwrap_or_default()),
            },
        }
    }

    /// Runs the campaign.
    pub fn run(&self, device: &dyn SceneRunner) -> SoundResult {
        let run = || -> anyhow::Result<_> {
            let scene = Scene::parse(&self.text, "campaign".as_ref())?;
            Ok(device.run(&scene)?.1)
        };
        let (extremes, failures) = match run() {
            Ok(figures) => (Some((figures.display_c, figures.skin_c)), figures.trips_and_resets()),
            Err(error) => (None, vec![format!("{error:#}")]),
        };
        SoundResult {
            number: self.number,
            group: self.group,
            surface_c: extremes.map(|(surface_c, _)| surface_c),
            skin_c: extremes.map(|(_, skin_c)| skin_c),
            failures,
        }
    }
}

/// Landings and lifts of the finger.
fn forces(draw: &mut Xoshiro256PlusPlus) -> String {
    let mut text = String::new();
    let mut t_s = draw.random_range(0.1..=4.0);
    while t_s < DURATION_S - 1.0 {
        let ramp_s = log_uniform(draw, (0.001, 0.3));
        text += &press(t_s, log_uniform(draw, FORCE_N), ramp_s);
        t_s += ramp_s + log_uniform(draw, (0.3, 10.0));
        if draw.random_bool(0.7) && t_s < DURATION_S - 1.0 {
            text += &press(t_s, 0.0, log_uniform(draw, (0.001, 0.05)));
            t_s += 0.05 + log_uniform(draw, (0.3, 5.0));
        }
    }
    text
}

/// A command, or some that belong together; the device may refuse them.
fn commands(draw: &mut Xoshiro256PlusPlus, t_s: f64) -> String {
    // Temperatures at the ends of the range are the ones that matter.
    let temperature_c = |draw: &mut Xoshiro256PlusPlus| {
        *[15.0, 15.0, 20.0, 38.0, 42.0, 42.0, draw.random_range(15.0..=42.0)]
            .choose(draw)
            .unwrap_or(&30.0)
    };
    let line = match draw.random_range(0..9) {
        0 | 1 => {
            let rate_k_s = log_uniform(draw, (0.3, 100.0));
            format!("hold {:.3} {rate_k_s:.3}", temperature_c(draw))
        }
        2 => format!("hold {:.3}", temperature_c(draw)),
        3 => {
            let rate_k_s = log_uniform(draw, (1.0, 100.0));
            let hold_s = log_uniform(draw, (0.1, 3.0));
            let (base_c, peak_c) = (temperature_c(draw), temperature_c(draw));
            format!("pulse {base_c:.3} {peak_c:.3} {rate_k_s:.3} {hold_s:.3} {hold_s:.3}")
        }
        4 => {
            let object_c =
                *[-20.0, 60.0, draw.random_range(10.0..=45.0)].choose(draw).unwrap_or(&30.0);
            let start = host_line("start", t_s);
            return host_line(&format!("object {object_c:.3}"), t_s) + &start;
        }
        5 => {
            let law = Law::WORDS.words[draw.random_range(0..Law::WORDS.words.len())];
            format!("law {law}")
        }
        6 => return course_tables(draw.random(), t_s, DURATION_S),
        7 => return host_line("abort", t_s) + &host_line("arm", t_s),
        _ => "arm".into(),
    };
    host_line(&line, t_s)
}

/// Result of a campaign without a fault.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SoundResult {
    /// Number of the campaign.
    pub number: u64,
    #[serde(flatten)]
    group: Group,
    /// True surface of the display, °C; null if the campaign did not come to its end.
    pub surface_c: Option<Extremes>,
    /// Skin, °C; null if the campaign did not come to its end.
    pub skin_c: Option<Extremes>,
    /// Faults by which the device tripped, and resets; or why the campaign or the commissioning of its device ended.
    pub failures: Vec<String>,
}

impl SoundResult {
    /// Whether surface and skin stayed within their limits, and nothing failed.
    pub fn holds(&self) -> bool {
        let within = |found: Option<Extremes>, (least, most): (f64, f64)| {
            found.is_some_and(|found| found.min >= least && found.max <= most)
        };
        within(self.surface_c, SURFACE_C) && within(self.skin_c, SKIN_C) && self.failures.is_empty()
    }
}

/// Table of the extreme temperatures by tuning and law, followed by every campaign that broke a limit.
pub fn sound_table(runs: &[SoundResult]) -> String {
    let mut groups: BTreeMap<Group, Vec<&SoundResult>> = BTreeMap::new();
    for run in runs {
        groups.entry(run.group).or_default().push(run);
    }
    let mut text = format!(
        "{:<10}{:<10}{:<12}{:>8}{:>24}{:>24}{:>8}\n",
        "tile", "law first", "lag", "runs", "surface, C", "skin, C", "broken"
    );
    for (group, runs) in groups {
        let range = |of: fn(&SoundResult) -> Option<Extremes>| {
            let known = || runs.iter().filter_map(|run| of(run));
            let least = known().map(|one| one.min).fold(f64::INFINITY, f64::min);
            let most = known().map(|one| one.max).fold(f64::NEG_INFINITY, f64::max);
            format!("{least:.2} to {most:.2}")
        };
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:<10}{:<10}{:<12}{:>8}{:>24}{:>24}{:>8}",
            if group.tuned { "tuned" } else { "untuned" },
            group.law,
            group.lag,
            runs.len(),
            range(|run| run.surface_c),
            range(|run| run.skin_c),
            runs.iter().filter(|run| !run.holds()).count(),
        );
    }
    for run in runs.iter().filter(|run| !run.holds()) {
        let of = |what, found: Option<Extremes>| {
            found.map(|found| format!("{what} {:.2} to {:.2} C", found.min, found.max))
        };
        let ranges = [of("surface", run.surface_c), of("skin", run.skin_c)].into_iter().flatten();
        let parts: Vec<_> = ranges.chain(run.failures.iter().cloned()).collect();
        let _ = writeln!(text, "number {}: {}", run.number, parts.join(", "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_campaign_is_a_scene_without_faults_and_half_of_them_untuned() {
        let scene = |number| {
            let campaign = SoundCampaign::new(5, number);
            Scene::parse(&campaign.text, "campaign".as_ref()).expect("a scene")
        };
        let scenes: Vec<_> = (0..160).map(scene).collect();
        assert!(scenes.iter().all(|scene| scene.faults.is_empty() && scene.injections.is_empty()));
        assert_eq!(scenes.iter().filter(|scene| scene.commissioned).count(), 80);
        for part in ["hold ", "pulse ", "object ", "law ", "upload ", "abort", "arm"] {
            let with = |scene: &&Scene| scene.host.iter().any(|host| host.line.starts_with(part));
            assert!(scenes.iter().filter(with).count() > 20, "{part}");
        }
    }

    #[test]
    fn campaigns_repeat_by_seed_and_number_and_differ_between_them() {
        assert_eq!(SoundCampaign::new(5, 3), SoundCampaign::new(5, 3));
        assert_ne!(SoundCampaign::new(5, 3).text, SoundCampaign::new(5, 4).text);
        assert_ne!(SoundCampaign::new(5, 3).text, SoundCampaign::new(6, 3).text);
    }

    #[test]
    fn a_surface_or_skin_beyond_its_limits_and_a_trip_break_the_claim() {
        let within = SoundResult {
            number: 0,
            group: Group { tuned: true, law: "model", lag: lag_band(0.2) },
            surface_c: Some(Extremes { min: 14.0, max: 43.0 }),
            skin_c: Some(Extremes { min: 14.0, max: 42.5 }),
            failures: Vec::new(),
        };
        assert!(within.holds());
        let range = |min, max| Some(Extremes { min, max });
        for broken in [
            SoundResult { surface_c: range(13.99, 30.0), ..within.clone() },
            SoundResult { surface_c: range(20.0, 43.01), ..within.clone() },
            SoundResult { skin_c: range(20.0, 42.51), ..within.clone() },
            SoundResult { surface_c: None, ..within.clone() },
            SoundResult { failures: vec!["dose".into()], ..within.clone() },
        ] {
            assert!(!broken.holds());
            assert!(sound_table(&[within.clone(), broken]).contains("number 0: "));
        }
    }
}
