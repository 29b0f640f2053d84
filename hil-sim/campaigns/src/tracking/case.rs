//! One stimulus on one display.

use std::path::Path;

use serde::Serialize;
use thermal_client::client::upload_course;
use thermal_device::stimulus::TemperatureKind;
use thermal_sim::SceneRunner;
use thermal_sim::scene::{HostLine, Scene};

use super::{FORCE_N, ROOM_C, Stimulus};

/// Times in the scene, s: the host moves the display to the first temperature, a finger lands, and the stimulus starts.
const PREPARE_S: f64 = 0.02;
const LANDING_S: f64 = 1.0;
const PLAY_LINE_S: f64 = 6.0;
const START_S: f64 = 8.0;
/// Time since the start from which errors count, s.
const COUNTED_FROM_S: f64 = 0.05;
/// Interval of the host's lines, s.
const LINE_INTERVAL_S: f64 = 0.01;

/// What touches the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum TouchingFinger {
    /// Nothing.
    Bare,
    /// The thesis's homogeneous finger, which the device assumes.
    Thesis,
    /// A finger of epidermis, dermis and fat; the device assumes the mean finger.
    Layered,
}

impl TouchingFinger {
    /// All, in the order of the table.
    pub const ALL: [Self; 3] = [Self::Bare, Self::Thesis, Self::Layered];

    /// Name, as the table has it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bare => "bare",
            Self::Thesis => "thesis's finger",
            Self::Layered => "layered finger",
        }
    }

    /// Tables of a scene, with a finger that lands at a time, s.
    pub(super) fn tables(self, landing_s: f64) -> String {
        let tissue = match self {
            Self::Layered => "[finger]\ntissue = \"layered\"\n",
            _ => "",
        };
        match self {
            Self::Bare => String::new(),
            _ => format!("{tissue}[[force]]\nt_s = {landing_s:?}\nforce_n = {FORCE_N:?}\n"),
        }
    }
}

/// A stimulus on a display of a drawn or the nominal plant.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackingCase {
    /// What the display follows.
    pub stimulus: Stimulus,
    /// What touches it.
    pub touch: TouchingFinger,
    /// Plant parameters that are not nominal, by key.
    pub plant: Vec<(String, f64)>,
    /// Seed of the converter.
    pub seed: u64,
}

/// The text of a scene of so many seconds for a plant.
pub(super) fn scene_text(
    duration_s: f64,
    seed: u64,
    tables: &str,
    plant: &[(String, f64)],
) -> String {
    let mut text = format!(
        "duration_s = {duration_s:?}\nskin_c = 34.0\nroom_c = {ROOM_C:?}\nseed = {seed}\n[object]\nmaterial = \"granite\"\n\
         start_c = 24.0\n{tables}"
    );
    if !plant.is_empty() {
        text += "[plant]\n";
    }
    for (key, value) in plant {
        text += &format!("{key} = {value:?}\n");
    }
    text
}

impl TrackingCase {
    /// On the nominal plant with display thermistors of a lag, s.
    pub fn nominal(stimulus: &Stimulus, touch: TouchingFinger, sensor_lag_s: f64) -> Self {
        let keys = ["sensors.display.lag_s", "sensors.check.lag_s"];
        Self {
            stimulus: stimulus.clone(),
            touch,
            plant: keys.map(|key| (key.to_owned(), sensor_lag_s)).into(),
            seed: 1,
        }
    }

    /// The scene: a course is uploaded and started by an edge at the trigger input; a step is two lines `hold`.
    fn scene(&self) -> anyhow::Result<Scene> {
        let course = &self.stimulus.course;
        let duration_s = START_S + course.duration_s();
        let trigger = format!("[[trigger]]\nt_s = {START_S:?}\n");
        let tables = trigger + &self.touch.tables(LANDING_S);
        let text = scene_text(duration_s, self.seed, &tables, &self.plant);
        let mut scene = Scene::parse(&text, Path::new("tracking"))?;
        let mut at = |t_s: f64, line: String| scene.host.push(HostLine { t_s, line });
        let points = course.points();
        at(PREPARE_S, format!("hold {} 5", points[0].celsius));
        if self.stimulus.is_step {
            for (from, to) in points.iter().zip(&points[1..]) {
                if from.celsius != to.celsius {
                    at(START_S + from.t_s, format!("hold {} 100", to.celsius));
                }
            }
        } else {
            let points: Vec<_> = (points.iter()).map(|point| (point.t_s, point.celsius)).collect();
            let lines = upload_course(TemperatureKind::Absolute, &points);
            for (line, number) in lines.iter().zip(1..) {
                at(PREPARE_S + LINE_INTERVAL_S * f64::from(number), line.to_string());
            }
            at(PLAY_LINE_S, "play trigger".into());
        }
        Ok(scene)
    }

    /// Runs it.
    ///
    /// # Errors
    /// The device stopped, or refused a line.
    pub fn run(&self, device: &dyn SceneRunner) -> anyhow::Result<TrackingResult> {
        let scene = self.scene()?;
        let (outcome, figures) = device.run(&scene)?;
        if let Some(refused) = figures.refused_lines.first() {
            anyhow::bail!("refused: {}", refused.answer);
        }
        let course = &self.stimulus.course;
        let mut result = TrackingResult {
            worst_mk: 0.0,
            worst_t_s: 0.0,
            limited: false,
            faults: (figures.faults.iter()).map(|trip| trip.fault.clone()).collect(),
            curve: Vec::new(),
        };
        for row in outcome.trace.rows() {
            let since_s = row.t_s - START_S;
            if since_s < 0.0 {
                continue;
            }
            let wanted_c = course.at(since_s);
            result.curve.push((since_s, wanted_c, row.display_c));
            if since_s < COUNTED_FROM_S {
                continue;
            }
            result.limited |= row.device.as_ref().is_some_and(|device| device.limited);
            let error_k = row.display_c - wanted_c;
            let counted_k = if self.stimulus.is_step {
                // Beyond the target: above the upper one, or below the lower one.
                let [from, to, ..] = course.points() else {
                    anyhow::bail!("a step has two temperatures");
                };
                let up = wanted_c > 0.5 * (from.celsius + to.celsius);
                if up { error_k.max(0.0) } else { (-error_k).max(0.0) }
            } else {
                error_k.abs()
            };
            if 1e3 * counted_k > result.worst_mk {
                (result.worst_mk, result.worst_t_s) = (1e3 * counted_k, since_s);
            }
        }
        if !result.faults.is_empty() {
            result.worst_mk = f64::INFINITY;
        }
        Ok(result)
    }
}

/// How closely a stimulus was followed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrackingResult {
    /// Largest difference of the display's surface to the course from 50 ms after its start on, mK; of a step the overshoot.
    /// Infinite if the device has tripped.
    pub worst_mk: f64,
    /// When that was, s after the start.
    pub worst_t_s: f64,
    /// Whether the device has reported the set-point as limited: the display was more than 0.1 K off it.
    pub limited: bool,
    /// Faults that the device reported.
    pub faults: Vec<String>,
    /// Time since the start, s, course and display, °C, every millisecond.
    #[serde(skip)]
    pub curve: Vec<(f64, f64, f64)>,
}
