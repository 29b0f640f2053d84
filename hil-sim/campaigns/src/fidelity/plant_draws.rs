//! Plants drawn at random from the parameter box.

use contact_model::material::THESIS_MATERIALS;
use contact_model::pressure::THESIS_PRESSURES;
use serde::Serialize;
use thermal_device::control::Law;
use thermal_plant::Params;
use thermal_plant::parameters::{self, Tolerance, absolute, all, between, relative, stream_seed};
use thermal_sim::SceneRunner;

use super::case::ROOM_C;
use super::{FidelityCase, Scenario};
use crate::percentile;

/// The drawn parameters and their distributions. All others stay nominal.
///
/// Contact detection is delayed by the dead time of the interface, up to 8 ms, and by about 2 ms that an amplifier lag of up
/// to 5 ms takes to bring 0.1 N above the threshold of the device: 10 ms in all. A lag that alone delayed 0.1 N as long
/// would distort 2 N for longer than the first 50 ms.
const BOX: [(&str, Tolerance); 12] = [
    ("tile.imax_a", relative(0.1)),
    ("tile.vmax_v", relative(0.1)),
    ("tile.dtmax_k", relative(0.1)),
    ("tile.ceramic_j_m3k", relative(0.1)),
    ("tile.legs_j_k", relative(0.1)),
    ("tile.tabs_j_k", relative(0.1)),
    ("tile.sink_j_k", relative(0.1)),
    ("tile.coolant_k", between(20.0 - ROOM_C, 40.0 - ROOM_C)),
    ("sensors.display.lag_s", between(0.02, 0.5).logarithmic()),
    ("sensors.force.lag_s", between(0.2e-3, 5e-3).logarithmic()),
    ("sensors.force.delay_s", between(0.0, 8e-3)),
    // Error of the reference thermometer of the calibration.
    ("host.reference_offset_k", absolute(0.02)),
];

/// Two parameters with the same value: both thermistors of the display are of one type and bonded alike.
pub(super) const SAME_VALUE: (&str, &str) = ("sensors.display.lag_s", "sensors.check.lag_s");

/// Parameters, or prefixes of their keys, that are also drawn for a device in use, within their own tolerances: those that a
/// builder cannot choose. Other sensor errors are calibrated, the finger belongs to the scene, and dead time and filter of
/// the bridge are design values known to the device.
const IN_USE: [&str; 11] = [
    "bridge.supply_v",
    "bridge.diode_v",
    "bridge.on_ohm",
    "bridge.trip_a",
    "comparator.",
    "sensors.mirror.",
    "sensors.reference.",
    "sensors.force.zero_counts",
    "sensors.force.counts_per_n",
    "tile.film_w_m2k",
    "tile.ceramic_w_mk",
];

/// A drawn plant and the case that is run on it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantDraw {
    /// Number of the draw, from 0.
    pub number: u64,
    /// Seed of the converter's profile and noise.
    pub seed: u64,
    /// Drawn plant parameters with their values.
    pub plant: Vec<(String, f64)>,
    /// The case; consecutive draws take the thesis's materials and forces in turn.
    pub case: FidelityCase,
}

impl PlantDraw {
    /// Draws a plant; it depends only on seed and number.
    pub fn new(seed: u64, number: u64) -> Self {
        let own = stream_seed(seed, &format!("draw {number}"));
        let nominal = all(&Params::nominal());
        let mut plant = Vec::with_capacity(BOX.len() + 1);
        for (key, tolerance) in BOX {
            let Some(parameter) = nominal.iter().find(|parameter| parameter.key == key) else {
                continue;
            };
            let value = tolerance.draw(parameter.value, own, key);
            plant.push((key.to_owned(), value));
            if key == SAME_VALUE.0 {
                plant.push((SAME_VALUE.1.to_owned(), value));
            }
        }
        let pairs = (THESIS_MATERIALS.len() * THESIS_PRESSURES.len()) as u64;
        let mut cases = Scenario::A.cases();
        Self {
            number,
            // A scene file holds 63 bits.
            seed: own >> 1,
            plant,
            case: cases.swap_remove((number % pairs) as usize),
        }
    }

    /// The same draw for a device in use: its bridge and measuring circuits are drawn, too.
    pub fn in_use(seed: u64, number: u64) -> Self {
        let mut draw = Self::new(seed, number);
        let mut params = Params::nominal();
        parameters::draw(&mut params, draw.seed);
        let drawn = all(&params).into_iter();
        let beside = drawn.filter(|one| IN_USE.iter().any(|part| one.key.starts_with(part)));
        draw.plant.extend(beside.map(|parameter| (parameter.key, parameter.value)));
        draw
    }

    /// Runs the case on the plant.
    ///
    /// # Errors
    /// The device stopped, or refused the scene.
    pub fn run(&self, device: &dyn SceneRunner, law: Law) -> anyhow::Result<DrawResult> {
        let scene = self.case.scene(law, self.seed, &self.plant)?;
        let (_, figures) = device.run(&scene)?;
        let skin = figures.skin_error_mk.unwrap_or_default();
        Ok(DrawResult {
            number: self.number,
            material: self.case.name.clone(),
            force_n: self.case.force_n,
            law: law.name(),
            max_after_50ms_mk: skin.max_after_50ms.unwrap_or(f64::INFINITY),
            rms_mk: skin.rms,
            faults: figures.faults.into_iter().map(|tripped| tripped.fault).collect(),
            plant: self.plant.clone(),
        })
    }
}

/// Result of a draw.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrawResult {
    /// Number of the draw.
    pub number: u64,
    /// Material.
    pub material: String,
    /// Force, N.
    pub force_n: f64,
    /// Name of the law.
    pub law: &'static str,
    /// Largest skin error from 50 ms on, mK.
    pub max_after_50ms_mk: f64,
    /// Its root mean square over the contact, mK.
    pub rms_mk: f64,
    /// Faults that the device reported.
    pub faults: Vec<String>,
    /// Drawn plant parameters.
    #[serde(serialize_with = "as_map")]
    pub plant: Vec<(String, f64)>,
}

fn as_map<S: serde::Serializer>(plant: &[(String, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(plant.iter().map(|(key, value)| (key, value)))
}

/// Percentiles over all draws.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Percentiles {
    /// 50 %.
    pub p50: f64,
    /// 95 %.
    pub p95: f64,
    /// 99 %.
    pub p99: f64,
    /// Largest value.
    pub max: f64,
}

impl Percentiles {
    /// `None` without values.
    pub fn of(values: &[f64]) -> Option<Self> {
        let at = |percent| percentile(values, percent);
        Some(Self { p50: at(50.0)?, p95: at(95.0)?, p99: at(99.0)?, max: at(100.0)? })
    }
}

/// Statistics of one control law over all draws.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LawStatistics {
    /// Name of the law.
    pub law: &'static str,
    /// Largest skin error from 50 ms on, mK.
    pub max_after_50ms_mk: Percentiles,
    /// Its root mean square, mK.
    pub rms_mk: Percentiles,
    /// Bound of the 95th percentile of the largest skin error, mK.
    pub bound_mk: f64,
    /// Whether the bound holds.
    pub within: bool,
    /// Draws in which the device reported a fault.
    pub faulty: usize,
    /// The worst draws, worst first.
    pub worst: Vec<DrawResult>,
}

/// Statistics of all control laws.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoxReport {
    /// Name of the engine.
    pub engine: &'static str,
    /// Number of draws.
    pub draws: u64,
    /// Seed of the draws.
    pub seed: u64,
    /// Statistics by law.
    pub laws: Vec<LawStatistics>,
}

/// Bound of the 95th percentile, mK.
const BOUND_MK: f64 = 50.0;
/// Number of worst draws that are listed.
const WORST: usize = 5;

/// Statistics by law, in the order of first occurrence.
pub fn statistics_by_law(drawn: &[DrawResult]) -> Vec<LawStatistics> {
    let mut laws: Vec<&'static str> = Vec::new();
    for one in drawn {
        if !laws.contains(&one.law) {
            laws.push(one.law);
        }
    }
    laws.into_iter().filter_map(|law| law_box(law, drawn)).collect()
}

fn law_box(law: &'static str, drawn: &[DrawResult]) -> Option<LawStatistics> {
    let mut own: Vec<&DrawResult> = drawn.iter().filter(|one| one.law == law).collect();
    own.sort_by(|a, b| b.max_after_50ms_mk.total_cmp(&a.max_after_50ms_mk));
    let column =
        |value: fn(&DrawResult) -> f64| own.iter().map(|one| value(one)).collect::<Vec<_>>();
    let max_after_50ms_mk = Percentiles::of(&column(|one| one.max_after_50ms_mk))?;
    Some(LawStatistics {
        law,
        max_after_50ms_mk,
        rms_mk: Percentiles::of(&column(|one| one.rms_mk))?,
        bound_mk: BOUND_MK,
        within: max_after_50ms_mk.p95 <= BOUND_MK,
        faulty: own.iter().filter(|one| !one.faults.is_empty()).count(),
        worst: own.into_iter().take(WORST).cloned().collect(),
    })
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    fn value(draw: &PlantDraw, key: &str) -> f64 {
        draw.plant.iter().find(|(drawn, _)| drawn == key).expect(key).1
    }

    /// The ranges as the box is stated, in a room of 24 °C.
    #[test]
    fn draws_fill_the_stated_ranges_and_do_not_leave_them() {
        let stated = [
            ("tile.imax_a", 5.4, 6.6),
            ("tile.vmax_v", 7.38, 9.02),
            ("tile.dtmax_k", 60.3, 73.7),
            ("tile.ceramic_j_m3k", 2.745e6, 3.355e6),
            ("tile.legs_j_k", 0.459, 0.561),
            ("tile.tabs_j_k", 0.468, 0.572),
            ("tile.sink_j_k", 180.0, 220.0),
            ("tile.coolant_k", -4.0, 16.0),
            ("sensors.display.lag_s", 0.02, 0.5),
            ("sensors.force.lag_s", 0.2e-3, 5e-3),
            ("sensors.force.delay_s", 0.0, 8e-3),
        ];
        let draws: Vec<_> = (0..1000).map(|number| PlantDraw::new(7, number)).collect();
        for (key, low, high) in stated {
            let values: Vec<_> = draws.iter().map(|draw| value(draw, key)).collect();
            let (least, most) = (
                values.iter().copied().fold(f64::INFINITY, f64::min),
                values.iter().copied().fold(0.0, f64::max),
            );
            let slack = 1e-9 * high;
            assert!(least >= low - slack && most <= high + slack, "{key}: {least} to {most}");
            assert!(
                least < low + 0.05 * (high - low) && most > high - 0.05 * (high - low),
                "{key}"
            );
        }
        for draw in &draws {
            assert_eq!(value(draw, "sensors.display.lag_s"), value(draw, "sensors.check.lag_s"));
        }
        // The logarithm is uniform: half of the lags are below the geometric mean, 0.1 s.
        let quick = draws.iter().filter(|draw| value(draw, "sensors.display.lag_s") < 0.1).count();
        assert!((450..550).contains(&quick), "{quick}");
    }

    #[test]
    fn draws_repeat_by_seed_and_number_and_differ_between_them() {
        assert_eq!(PlantDraw::new(3, 17), PlantDraw::new(3, 17));
        let first = value(&PlantDraw::new(3, 17), "tile.imax_a");
        assert_ne!(first, value(&PlantDraw::new(3, 18), "tile.imax_a"));
        assert_ne!(first, value(&PlantDraw::new(4, 17), "tile.imax_a"));
        assert_ne!(PlantDraw::new(3, 17).seed, PlantDraw::new(3, 18).seed);
    }

    #[test]
    fn a_thousand_draws_take_every_pair_22_times_or_more() {
        let mut pairs: HashMap<(String, u64), u32> = HashMap::new();
        for number in 0..1000 {
            let case = PlantDraw::new(1, number).case;
            *pairs.entry((case.name, case.force_n.to_bits())).or_default() += 1;
        }
        assert_eq!(pairs.len(), 45);
        assert!(pairs.values().all(|times| (22..=23).contains(times)));
    }

    #[test]
    fn every_draw_is_a_scene() {
        for number in 0..90 {
            let draw = PlantDraw::new(2, number);
            let scene = draw.case.scene(Law::Pi, draw.seed, &draw.plant).expect("a scene");
            assert_eq!(scene.params.tile.imax_a, value(&draw, "tile.imax_a"));
            assert_eq!(scene.seed, draw.seed);
        }
    }

    /// 100 draws of 1 to 100 mK: numpy's percentiles of the same numbers.
    #[test]
    fn summary_counts_law_by_law_and_names_the_worst() {
        let drawn = |number: u64, law, max_after_50ms_mk| DrawResult {
            number,
            material: "abs".into(),
            force_n: 1.0,
            law,
            max_after_50ms_mk,
            rms_mk: 1.0,
            faults: Vec::new(),
            plant: Vec::new(),
        };
        let mut all: Vec<_> = (1..=100).map(|n| drawn(n, "pi", n as f64)).collect();
        all.extend((1..=100).map(|n| drawn(n, "other", 0.25 * n as f64)));
        let laws = statistics_by_law(&all);
        assert_eq!(laws.len(), 2);
        let pi = &laws[0].max_after_50ms_mk;
        assert!((pi.p50 - 50.5).abs() < 1e-9 && (pi.p95 - 95.05).abs() < 1e-9, "{pi:?}");
        assert!((pi.p99 - 99.01).abs() < 1e-9 && pi.max == 100.0, "{pi:?}");
        assert_eq!((laws[0].within, laws[1].within), (false, true));
        let worst: Vec<_> = laws[0].worst.iter().map(|one| one.number).collect();
        assert_eq!(worst, [100, 99, 98, 97, 96]);
    }
}
