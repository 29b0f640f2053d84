//! Where and when a fault happens: scenes, and moments in them.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use serde::Serialize;
use thermal_device::control::Law;
use thermal_device::safety::Fault;
use thermal_sim::named_enum;

use super::scene_text;

named_enum! {
    /// A scene, and what goes on in it when the fault comes. In every one the finger rests on the display in the end.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum FaultScene {
        /// The object appears under a resting finger: as much current as there is, copper.
        Slew = "slew",
        /// The same, with the plain loop.
        Pi = "pi",
        /// With that of the thesis's display.
        Pi10Hz = "pi-10hz",
        /// With a model of the class, of a device that was never commissioned.
        Untuned = "untuned",
        /// A finger lands on copper.
        Copper = "copper",
        /// On granite.
        Granite = "granite",
        /// On foam.
        Foam = "foam",
        /// On copper of 41 °C.
        Warm = "warm",
        /// On copper of 15 °C.
        Cold = "cold",
        /// Armed, the finger on the neutral display.
        Touched = "touched",
        /// Held at 42 °C under a finger.
        HeldWarm = "held-warm",
        /// At 15 °C.
        HeldCold = "held-cold",
        /// Tuned; the finger comes later.
        Tuning = "tuning",
        /// A finger lands on copper of a constant temperature, as on the thesis's first display.
        SemiInfinite = "semi-infinite",
        /// Armed, the finger comes later.
        Neutral = "neutral",
        /// The object is presented, the finger comes later.
        Preset = "preset",
        /// Lifted and replaced, a second each.
        Replace = "replace",
        /// The self-test, under a finger: for its sake it waits for a second after the comparator's part.
        SelfTest = "self-test",
        /// Off, after a fault that was cleared; the self-test follows.
        Off = "off",
    }
}

/// Forces: time in s, N.
type Forces = &'static [(f64, f64)];

const LANDING: Forces = &[(1.0, 2.0)];
const RESTING: Forces = &[(0.2, 2.0)];
const LATE: Forces = &[(6.0, 2.0)];
const LATER: Forces = &[(15.0, 2.0)];
const REPLACING: Forces = &[
    (0.5, 2.0),
    (1.5, 0.0),
    (2.5, 2.0),
    (3.5, 0.0),
    (4.5, 2.0),
    (5.5, 0.0),
    (6.5, 2.0),
];

/// Milliseconds from an edge at which faults come.
const AROUND_MS: [i32; 12] = [-20, -3, -2, -1, 0, 1, 2, 3, 5, 10, 25, 60];
/// Time of a scene after its last edge, s: the finger rests for some 20 s after a trip.
const SHORTEST_S: f64 = 7.0;
/// When the device is armed again where it has tripped before, s.
const TESTED_FROM_S: f64 = 4.0;
/// When the host gives an order, s.
const ORDERED_S: f64 = 0.05;
/// What tripped before.
const BEFORE: Fault = Fault::HostSilent;

/// A scene with the time at which the fault comes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InjectionPoint {
    /// Where.
    pub place: FaultScene,
    /// When, s.
    pub t_s: f64,
}

impl FaultScene {
    /// Where a self-test is, or follows.
    pub(super) const TESTED: &'static [Self] = &[Self::SelfTest, Self::Off];

    const fn object(self) -> (&'static str, f64) {
        match self {
            Self::Granite => ("granite", 24.0),
            Self::Foam => ("foam", 24.0),
            Self::Warm => ("copper", 41.0),
            Self::Cold => ("copper", 15.0),
            _ => ("copper", 24.0),
        }
    }

    /// Forces, the time range of the faults, s, and the times, s, around which every other fault comes.
    const fn timing(self) -> (Forces, (f64, f64), &'static [f64]) {
        match self {
            Self::Slew | Self::Pi | Self::Pi10Hz | Self::Untuned => (RESTING, (0.5, 4.0), &[1.0]),
            Self::Copper
            | Self::Granite
            | Self::Foam
            | Self::Warm
            | Self::Cold
            | Self::SemiInfinite => (LANDING, (0.3, 4.0), &[1.0]),
            Self::Touched => (RESTING, (0.1, 4.0), &[0.2]),
            // The set-point moves by 1 K/s.
            Self::HeldWarm => (RESTING, (0.3, 12.0), &[8.1]),
            Self::HeldCold => (RESTING, (0.3, 22.0), &[19.1]),
            Self::Tuning => (LATER, (0.3, 15.5), &[15.0]),
            Self::Neutral | Self::Preset => (LATE, (0.1, 6.5), &[6.0]),
            Self::Replace => (REPLACING, (0.3, 7.0), &[1.5, 2.5, 3.5, 4.5]),
            Self::SelfTest => (
                RESTING,
                (4.0, 5.75),
                &[4.0, 4.02, 5.04, 5.104, 5.304, 5.504],
            ),
            Self::Off => (RESTING, (2.9, 3.99), &[]),
        }
    }

    const fn law(self) -> Law {
        match self {
            Self::Pi => Law::Pi,
            Self::Pi10Hz => Law::Pi10Hz,
            _ => Law::Model,
        }
    }

    const fn mode(self) -> &'static str {
        match self {
            Self::SemiInfinite => "semi-infinite",
            _ => "contact",
        }
    }

    const fn is_commissioned(self) -> bool {
        !matches!(self, Self::Untuned)
    }

    /// What the host has the armed device do, from the beginning on.
    const fn order(self) -> Option<&'static str> {
        match self {
            Self::HeldWarm => Some("hold 42"),
            Self::HeldCold => Some("hold 15"),
            Self::Tuning => Some("tune"),
            _ => None,
        }
    }

    /// The law goes by a model of the tile, which was tuned: what a display should do is known, and done as far as can be.
    pub(super) const fn has_tuned_model(self) -> bool {
        matches!(self.law(), Law::Model) && self.is_commissioned() && !matches!(self, Self::Tuning)
    }

    /// When the device is told to test itself, s.
    pub(super) fn tested_from_s(self) -> Option<f64> {
        self.has_tripped_before().map(|_| TESTED_FROM_S)
    }

    /// From when to when faults come, s.
    pub(super) const fn span(self) -> (f64, f64) {
        self.timing().1
    }

    /// The host falls silent for two seconds at the beginning, and the device trips; the host clears that, arms and
    /// starts anew.
    #[must_use]
    pub const fn has_tripped_before(self) -> Option<Fault> {
        match self {
            Self::SelfTest | Self::Off => Some(BEFORE),
            _ => None,
        }
    }

    /// Draws a moment; every other one is at an edge.
    #[must_use]
    pub fn moment(self, seed: u64, at_edge: bool) -> InjectionPoint {
        let mut draw = Xoshiro256PlusPlus::seed_from_u64(seed);
        let (_, (from_s, to_s), edges) = self.timing();
        let ms = |t_s: f64| (t_s * 1e3).round() as i32;
        let t_ms = if at_edge && !edges.is_empty() {
            let edge_s = edges[draw.random_range(0..edges.len())];
            ms(edge_s) + AROUND_MS[draw.random_range(0..AROUND_MS.len())]
        } else {
            draw.random_range(ms(from_s)..=ms(to_s))
        };
        InjectionPoint {
            place: self,
            t_s: f64::from(t_ms) / 1e3,
        }
    }

    /// The scene as a file has it, in which a fault at a time is watched for so long, s; and its end, s.
    #[must_use]
    pub fn text(self, seed: u64, t_s: f64, after_s: f64) -> (String, f64) {
        let duration_s = (t_s + after_s).max(SHORTEST_S);
        let (material, object_c) = self.object();
        let appears_s = match self {
            Self::Slew | Self::Pi | Self::Pi10Hz | Self::Untuned => 1.0,
            Self::Touched | Self::Neutral | Self::HeldWarm | Self::HeldCold | Self::Tuning => {
                duration_s
            }
            _ => 0.0,
        };
        let mut text = format!(
            "duration_s = {duration_s:?}\nskin_c = 34\nroom_c = 24\nseed = {seed}\nlaw = \"{}\"\nmode = \"{}\"\n[device]\n\
             commissioned = {}\n[object]\nmaterial = \"{material}\"\nstart_c = {object_c:?}\n\
             appears_t_s = {appears_s:?}\n",
            self.law().name(),
            self.mode(),
            self.is_commissioned(),
        );
        for (t_s, force_n) in self.timing().0 {
            text += &format!("[[force]]\nt_s = {t_s:?}\nforce_n = {force_n:?}\n");
        }
        if self.has_tripped_before().is_some() {
            text += "[[fault]]\nkind = \"host-silent\"\nt_s = 0.1\nuntil_s = 2.4\n";
            for (t_s, line) in [(2.8, "clear"), (TESTED_FROM_S, "arm"), (6.0, "start")] {
                text += &format!("[[host]]\nt_s = {t_s:?}\nline = \"{line}\"\n");
            }
        }
        if let Some(line) = self.order() {
            text += &scene_text::host_line(line, ORDERED_S);
        }
        (text, duration_s)
    }
}
