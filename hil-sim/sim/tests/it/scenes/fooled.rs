//! What a heat-flux sensor sees of no finger on the display: the device must go back to the finger that it assumes, and say so.

use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::run::{Outcome, run};

use super::flux::{setpoints, word};
use super::scene;

const DRAWN: &str = "[finger]\ntissue = \"layered\"\ndraw = 3\n";
/// The layers of `tissue = "layered"` under 1 mm of cotton.
const GLOVE: &str = "[finger]\nair_w_m2k = 10\ncore_w_m2k = inf\nvessels = true\n\
    [[finger.layer]]\nthickness_m = 1e-3\nk_w_mk = 0.05\nrho_kg_m3 = 150\nc_j_kgk = 1333\n\
    [[finger.layer]]\nthickness_m = 0.65e-3\nk_w_mk = 0.21\nrho_kg_m3 = 1110\nc_j_kgk = 3600\n\
    [[finger.layer]]\nthickness_m = 1.2e-3\nk_w_mk = 0.37\nrho_kg_m3 = 1116\nc_j_kgk = 3224\nperfusion_1_s = 5e-3\n\
    [[finger.layer]]\nthickness_m = 4e-3\nk_w_mk = 0.16\nrho_kg_m3 = 970\nc_j_kgk = 2303\nperfusion_1_s = 1e-3\n";

/// A way of being fooled, from a time on.
struct Case {
    name: &'static str,
    finger: &'static str,
    /// Keys of `[plant]`.
    plant: &'static str,
    /// Faults and forces.
    tables: &'static str,
    t_s: f64,
    words: &'static [&'static str],
}

/// Time after which the device must have said its last word, s. It is said at once, or when the sensor has been at a rail for long
/// enough.
const SAID_AFTER_S: f64 = 0.15;
/// Time from which set-points are those of the assumed finger, s, and how nearly, K: what the sensor measures goes on to count for the
/// plate, whose surface is estimated otherwise than without it.
const ASSUMED_AFTER_S: f64 = 0.2;
const ASSUMED_K: f64 = 0.26;

/// Landing at 1 s.
const LANDING_S: f64 = 1.0;

const CASES: &[Case] = &[
    Case {
        name: "lifted while the force signal stays",
        finger: DRAWN,
        plant: "",
        tables: "[[force]]\nt_s = 2.5\nforce_n = 0\n[[fault]]\nkind = \"force-stuck\"\nt_s = 2.5\n",
        t_s: 2.5,
        words: &["contact"],
    },
    Case {
        name: "rolled to its edge while the force signal stays",
        finger: DRAWN,
        plant: "",
        tables: "[[force]]\nt_s = 2.5\nforce_n = 0.02\n[[fault]]\nkind = \"force-stuck\"\nt_s = 2.5\n",
        t_s: 2.5,
        words: &["contact"],
    },
    Case {
        name: "glove",
        finger: GLOVE,
        plant: "",
        tables: "",
        t_s: LANDING_S,
        words: &["between", "unexplained"],
    },
    Case {
        name: "paper",
        finger: DRAWN,
        plant: "finger.resistance_factor = 4",
        tables: "",
        t_s: LANDING_S,
        words: &["between"],
    },
    Case {
        name: "wet",
        finger: DRAWN,
        plant: "finger.resistance_factor = 0.2",
        tables: "",
        t_s: LANDING_S,
        words: &["wet"],
    },
    Case {
        name: "sensor without its plug",
        finger: DRAWN,
        plant: "",
        tables: "[[fault]]\nkind = \"flux-open\"\nt_s = 2.5\n",
        t_s: 2.5,
        words: &["sensor-range"],
    },
];

impl Case {
    fn outcome(&self, material: &str, more: &str) -> Outcome {
        let Self { finger, plant, tables, t_s, .. } = self;
        let text = format!(
            "duration_s = {:?}\nskin_c = 34\nroom_c = 24\nseed = 1\n[device]\nflux_sensor = true\n{finger}\
             [object]\nmaterial = \"{material}\"\n[plant]\n{plant}\n\
             [[force]]\nt_s = {LANDING_S:?}\nforce_n = 2\n{tables}{more}\
             [[host]]\nt_s = 0.1\nline = \"events on\"\n[[host]]\nt_s = {:?}\nline = \"flux\"\n",
            t_s + 2.0,
            t_s + 1.9,
        );
        let scene = scene(&text);
        let mut engine = NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
        run(&scene, &mut engine, |_| ()).expect("the device takes the scene")
    }
}

#[test]
fn what_is_no_finger_ends_in_the_assumed_one_and_a_word() {
    for case in CASES {
        for material in ["copper", "granite", "abs"] {
            let what = format!("{} on {material}", case.name);
            let fooled = case.outcome(material, "");
            let assumed = case.outcome(material, "[[fault]]\nkind = \"flux-open\"\nt_s = 0\n");
            let said = word(&fooled).trim_start_matches("finger=");
            assert!(case.words.contains(&said), "{what}: {said}");
            let events = fooled.events.iter();
            let last_s =
                events.filter(|(_, line)| line.ends_with(" flux")).map(|(t_s, _)| *t_s).next_back();
            let last_s = last_s.expect("an event") - case.t_s;
            assert!((0.0..=SAID_AFTER_S).contains(&last_s), "{what}: {last_s} s");
            let (one, other) = (setpoints(&fooled), setpoints(&assumed));
            assert_eq!(one.len(), other.len());
            let from = ((case.t_s + ASSUMED_AFTER_S) * 1e3) as usize;
            let off_k = one.iter().zip(&other).skip(from);
            let off_k = off_k.map(|(one, other)| (one - other).abs());
            let off_k = off_k.fold(0.0, f64::max);
            println!("{what}: {said} after {last_s:.3} s, {off_k:.3} K off");
            assert!(off_k <= ASSUMED_K, "{what}: {off_k} K");
        }
    }
}
