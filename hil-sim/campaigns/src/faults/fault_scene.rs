//! Scenes into which faults are injected, and injection times.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use serde::Serialize;
use thermal_client::client::upload_course;
use thermal_device::control::Law;
use thermal_device::safety::Fault;
use thermal_device::stimulus::TemperatureKind;
use thermal_sim::named_enum;

use super::{DrawnDevice, Touch, scene_text};

named_enum! {
    /// A scene, named after its state when the fault comes. At the end of each, the finger rests on the display.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum FaultScene {
        /// Copper appears under a resting finger, which takes the full current.
        Slew = "slew",
        /// As `Slew`, with the PI law.
        Pi = "pi",
        /// As `Slew`, with the PI law of the thesis's display.
        Pi10Hz = "pi-10hz",
        /// As `Slew`, with a device that was never commissioned and uses the nominal model.
        Untuned = "untuned",
        /// A finger lands on copper.
        Copper = "copper",
        /// A finger lands on granite.
        Granite = "granite",
        /// A finger lands on foam.
        Foam = "foam",
        /// A finger lands on copper of 41 °C.
        Warm = "warm",
        /// A finger lands on copper of 15 °C.
        Cold = "cold",
        /// Armed, the finger on the neutral display.
        Touched = "touched",
        /// Held at 42 °C under a finger.
        HeldWarm = "held-warm",
        /// Held at 15 °C under a finger.
        HeldCold = "held-cold",
        /// A course is repeated under a finger.
        Course = "course",
        /// A course is repeated; the finger lands later.
        CourseBare = "course-bare",
        /// A course waits under a finger for an edge at the trigger input, which comes.
        CourseTrigger = "course-trigger",
        /// A course waits for the finger, which lands later.
        CourseLanding = "course-landing",
        /// Tuning; the finger lands later.
        Tuning = "tuning",
        /// A finger lands on copper of a constant temperature, as on the thesis's first display.
        SemiInfinite = "semi-infinite",
        /// Armed; the finger lands later.
        Neutral = "neutral",
        /// The object is presented; the finger lands later.
        Preset = "preset",
        /// The finger lifts and lands in turn, one second each.
        Replace = "replace",
        /// The self-test under a finger, which makes it wait for a second after the test of the comparator.
        SelfTest = "self-test",
        /// Off, after a fault that was cleared; the self-test follows.
        Off = "off",
    }
}

/// Times, s, and whether the finger is pressed from then on.
type Forces = &'static [(f64, bool)];

const LANDING: Forces = &[(1.0, true)];
const RESTING: Forces = &[(0.2, true)];
const LATE: Forces = &[(6.0, true)];
const LATER: Forces = &[(15.0, true)];
const REPLACING: Forces =
    &[(0.5, true), (1.5, false), (2.5, true), (3.5, false), (4.5, true), (5.5, false), (6.5, true)];

/// Times of faults relative to an edge, ms.
const AROUND_MS: [i32; 12] = [-20, -3, -2, -1, 0, 1, 2, 3, 5, 10, 25, 60];
/// Shortest duration of a scene, s.
const SHORTEST_S: f64 = 7.0;
/// Time at which a device that has tripped is armed again, s.
const TESTED_FROM_S: f64 = 4.0;
/// Time of the host's command, s.
const COMMAND_S: f64 = 0.05;
/// Time of the edge at the trigger input for which a course waits, s.
const EDGE_S: f64 = 3.0;
/// Course of the scenes with one: time, s, and temperature, °C. It rises and falls by 5 K/s.
const COURSE: [(f64, f64); 7] =
    [(0.0, 34.0), (1.0, 39.0), (2.0, 39.0), (4.0, 29.0), (5.0, 24.0), (6.0, 24.0), (8.0, 34.0)];
/// Cause of the trip before the fault.
const EARLIER_TRIP: Fault = Fault::HostSilent;

/// A scene and the time of the fault in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InjectionPoint {
    /// The scene.
    pub scene: FaultScene,
    /// Time of the fault, s.
    pub t_s: f64,
}

impl FaultScene {
    /// Material and temperature of the object, °C.
    pub(super) const fn object(self) -> (&'static str, f64) {
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
            Self::Course => (RESTING, (0.3, 12.0), &[1.1, 2.1, 8.1]),
            Self::CourseTrigger => (RESTING, (0.3, 6.0), &[EDGE_S]),
            Self::CourseBare | Self::CourseLanding => (LATE, (0.3, 6.5), &[6.0]),
            Self::Tuning => (LATER, (0.3, 15.5), &[15.0]),
            Self::Neutral | Self::Preset => (LATE, (0.1, 6.5), &[6.0]),
            Self::Replace => (REPLACING, (0.3, 7.0), &[1.5, 2.5, 3.5, 4.5]),
            Self::SelfTest => (RESTING, (4.0, 5.75), &[4.0, 4.02, 5.04, 5.104, 5.304, 5.504]),
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

    /// Whether the host plays a course.
    pub(super) const fn has_course(self) -> bool {
        matches!(self, Self::Course | Self::CourseBare | Self::CourseTrigger | Self::CourseLanding)
    }

    /// Whether an untuned device refuses what the host says.
    pub(super) const fn needs_tuned(self) -> bool {
        self.has_course() || matches!(self, Self::HeldWarm | Self::HeldCold)
    }

    /// Whether the host prescribes what an armed display does, instead of an object.
    pub(super) const fn is_commanded(self) -> bool {
        self.has_course() || matches!(self, Self::HeldWarm | Self::HeldCold | Self::Tuning)
    }

    /// Lines that the host sends to the armed device.
    fn commands(self) -> Vec<String> {
        let play = match self {
            Self::HeldWarm => return vec!["hold 42".into()],
            Self::HeldCold => return vec!["hold 15".into()],
            Self::Tuning => return vec!["tune".into()],
            Self::Course | Self::CourseBare => "play now 1000",
            Self::CourseTrigger => "play trigger 1000",
            Self::CourseLanding => "play landing 1000",
            _ => return Vec::new(),
        };
        let upload = upload_course(TemperatureKind::Absolute, &COURSE);
        let upload = upload.iter().map(ToString::to_string);
        upload.chain([play.into()]).collect()
    }

    /// Whether the control law uses the model of the tile, so that the display of a tuned one follows a fault-free run closely.
    pub(super) const fn has_tuned_model(self) -> bool {
        matches!(self.law(), Law::Model) && self.is_commissioned() && !matches!(self, Self::Tuning)
    }

    /// Time at which the self-test is requested, s.
    pub(super) fn tested_from_s(self) -> Option<f64> {
        self.has_tripped_before().map(|_| TESTED_FROM_S)
    }

    /// Time range of the faults, s.
    pub(super) const fn span(self) -> (f64, f64) {
        self.timing().1
    }

    /// Cause of a trip before the fault: the host is silent for two seconds at the beginning, then clears the trip, arms and
    /// starts again.
    pub const fn has_tripped_before(self) -> Option<Fault> {
        match self {
            Self::SelfTest | Self::Off => Some(EARLIER_TRIP),
            _ => None,
        }
    }

    /// Draws the time of a fault, near an edge of the scene if `at_edge`.
    pub fn injection_point(self, seed: u64, at_edge: bool) -> InjectionPoint {
        let mut draw = Xoshiro256PlusPlus::seed_from_u64(seed);
        let (_, (from_s, to_s), edges) = self.timing();
        let ms = |t_s: f64| (t_s * 1e3).round() as i32;
        let t_ms = if at_edge && !edges.is_empty() {
            let edge_s = edges[draw.random_range(0..edges.len())];
            ms(edge_s) + AROUND_MS[draw.random_range(0..AROUND_MS.len())]
        } else {
            draw.random_range(ms(from_s)..=ms(to_s))
        };
        InjectionPoint { scene: self, t_s: f64::from(t_ms) / 1e3 }
    }

    /// The text of the scene, with this device, finger and object, that continues for `after_s` after a fault at `t_s`, and the
    /// end of the scene, s.
    pub(super) fn text(
        self,
        device: &DrawnDevice,
        t_s: f64,
        after_s: f64,
        touch: &Touch,
    ) -> (String, f64) {
        let duration_s = (t_s + after_s).max(SHORTEST_S);
        let (material, object_c) = self.object();
        let appears_s = match self {
            Self::Slew | Self::Pi | Self::Pi10Hz | Self::Untuned => 1.0,
            Self::Touched | Self::Neutral => duration_s,
            commanded if commanded.is_commanded() => duration_s,
            _ => 0.0,
        };
        let mut text = format!(
            "duration_s = {duration_s:?}\nskin_c = {:?}\nlaw = \"{}\"\nmode = \"{}\"\n{}{}[object]\nmaterial = \"{material}\"\nstart_c = {object_c:?}\n\
             appears_t_s = {appears_s:?}\n{}{}",
            touch.skin_c,
            self.law().name(),
            self.mode(),
            device.keys_if_tuned(device.tuned && self.is_commissioned()),
            touch.device,
            touch.object,
            touch.tables,
        );
        for (t_s, is_pressed) in self.timing().0 {
            let force_n = if *is_pressed { touch.force_n } else { 0.0 };
            text += &format!("[[force]]\nt_s = {t_s:?}\nforce_n = {force_n:?}\n");
        }
        if self.has_tripped_before().is_some() {
            text += "[[fault]]\nkind = \"host-silent\"\nt_s = 0.1\nuntil_s = 2.4\n";
            for (t_s, line) in [(2.8, "clear"), (TESTED_FROM_S, "arm"), (6.0, "start")] {
                text += &format!("[[host]]\nt_s = {t_s:?}\nline = \"{line}\"\n");
            }
        }
        for line in self.commands() {
            text += &scene_text::host_line(&line, COMMAND_S);
        }
        if matches!(self, Self::CourseTrigger) {
            text += &format!("[[trigger]]\nt_s = {EDGE_S:?}\n");
        }
        (text, duration_s)
    }
}
