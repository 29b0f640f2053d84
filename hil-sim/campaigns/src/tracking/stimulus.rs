//! Stimuli: courses of temperature, and steps.

use contact_model::material::{REFERENCE_DISPLAY, SKIN, find};
use contact_model::pressure::pressure_pa;
use contact_model::reference::Contact;
use thermal_client::course::{COURSE_POINTS_MAX, Course, CoursePoint, reduce};

use super::FORCE_N;

/// Ends of the ramps of 0.5 K/s and more, and of the steps, °C. The sink is between them, so that current and voltage cross zero.
const LOW_C: f64 = 22.0;
const HIGH_C: f64 = 32.0;
/// Slow ramps are shorter, up to this duration of one way, s.
const WAY_MAX_S: f64 = 30.0;
/// Pause between and after the ways of a stimulus, s.
const PAUSE_S: f64 = 2.0;
/// Rates of the ramps, K/s.
const RATES_K_S: [f64; 6] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0];
/// Heights of the steps, K.
const STEPS_K: [f64; 4] = [0.5, 2.0, 5.0, 10.0];
/// Duration of the recorded course, s, and the interval of its samples.
const RECORDED_S: f64 = 10.0;
const SAMPLE_S: f64 = 0.01;

/// What the display is to follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Stimulus {
    /// Name, as the table has it.
    pub name: String,
    /// Temperatures from its start on; a step is told as `hold`, and its course has a way of 1 ms.
    pub course: Course,
    /// Whether it is a step there and back, of which the overshoot counts.
    pub is_step: bool,
}

/// A course through points of time, s, and temperature, °C.
///
/// # Panics
/// Times do not rise.
fn course(points: &[(f64, f64)]) -> Course {
    let points = points.iter();
    let points = points.map(|&(t_s, celsius)| CoursePoint { t_s, celsius });
    Course::new(points.collect()).expect("rising times")
}

impl Stimulus {
    fn played(name: impl Into<String>, points: &[(f64, f64)]) -> Self {
        Self { name: name.into(), course: course(points), is_step: false }
    }

    /// A ramp up at this rate, K/s, through the temperature of the sink, and the same way down.
    pub fn ramp(rate_k_s: f64) -> Self {
        let span_k = (HIGH_C - LOW_C).min(rate_k_s * WAY_MAX_S);
        // Slow ones are near the temperature of the sink, 24 °C.
        let low_c = if span_k < HIGH_C - LOW_C { 24.0 - 0.25 * span_k } else { LOW_C };
        let (high_c, way_s) = (low_c + span_k, span_k / rate_k_s);
        let top_s = way_s + PAUSE_S;
        Self::played(
            format!("ramp of {rate_k_s} K/s"),
            &[
                (0.0, low_c),
                (way_s, high_c),
                (top_s, high_c),
                (top_s + way_s, low_c),
                (top_s + way_s + PAUSE_S, low_c),
            ],
        )
    }

    /// A step of so many kelvin up from 22 °C, and back.
    pub fn step(height_k: f64) -> Self {
        let high_c = LOW_C + height_k;
        let back_s = 2.0 * PAUSE_S;
        let points = [
            (0.0, LOW_C),
            (1e-3, high_c),
            (back_s, high_c),
            (back_s + 1e-3, LOW_C),
            (2.0 * back_s, LOW_C),
        ];
        Self { name: format!("step of {height_k} K"), course: course(&points), is_step: true }
    }

    /// A pulse from 32 °C: by so many kelvin, at a rate, K/s, for 1 s.
    pub fn pulse(height_k: f64, rate_k_s: f64) -> Self {
        let way_s = height_k.abs() / rate_k_s;
        let (from_c, to_c) = (HIGH_C, HIGH_C + height_k);
        let back_s = way_s + 1.0;
        Self::played(
            format!("pulse of {height_k:+} K at {rate_k_s} K/s"),
            &[
                (0.0, from_c),
                (way_s, to_c),
                (back_s, to_c),
                (back_s + way_s, from_c),
                (back_s + way_s + PAUSE_S, from_c),
            ],
        )
    }

    /// Ten triangles from 28 °C up, so many kelvin high, at a rate, K/s.
    pub fn triangles(height_k: f64, rate_k_s: f64) -> Self {
        let way_s = height_k / rate_k_s;
        let corner = |way: u32| {
            let height_k = if way.is_multiple_of(2) { 0.0 } else { height_k };
            (f64::from(way) * way_s, 28.0 + height_k)
        };
        let corners: Vec<_> = (0..=20).map(corner).collect();
        Self::played(format!("triangles of {height_k} K at {rate_k_s} K/s"), &corners)
    }

    /// The surface of a display that imitates copper of 24 °C under a skin of 34 °C, by Eq. 6-12, recorded every 10 ms and
    /// reduced to the points of a course.
    ///
    /// # Panics
    /// There is no copper.
    pub fn recorded() -> Self {
        let copper = find("copper").expect("copper");
        let contact =
            Contact::new((&SKIN, 34.0), (copper, 24.0), &REFERENCE_DISPLAY, pressure_pa(FORCE_N));
        let samples = (0..=(RECORDED_S / SAMPLE_S) as u32).map(|sample| {
            let t_s = f64::from(sample) * SAMPLE_S;
            (t_s, contact.at(t_s).display_c)
        });
        Self {
            name: "display of copper".into(),
            course: reduce(&course(&samples.collect::<Vec<_>>()), COURSE_POINTS_MAX)
                .course
                .rounded(),
            is_step: false,
        }
    }

    /// All stimuli of the table.
    pub fn all() -> Vec<Self> {
        let mut all: Vec<_> = STEPS_K.map(Self::step).into();
        all.extend(RATES_K_S.map(Self::ramp));
        all.extend([Self::pulse(2.0, 5.0), Self::pulse(-5.0, 4.0), Self::recorded()]);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_have_their_rates_and_pass_the_temperature_of_the_sink() {
        for rate_k_s in RATES_K_S {
            let ramp = Stimulus::ramp(rate_k_s).course;
            assert!((ramp.rate_max_k_s() / rate_k_s - 1.0).abs() < 1e-9);
            let celsius = ramp.points().iter().map(|point| point.celsius);
            let (low_c, high_c) =
                celsius.fold((99.0, 0.0), |(low, high): (f64, f64), c| (low.min(c), high.max(c)));
            assert!(low_c < 24.0 && high_c > 24.5, "{low_c} to {high_c}");
        }
    }

    /// Eq. 6-12 at the landing, where skin and object are at their temperatures: the display must take the contact's flux
    /// through its own resistance.
    #[test]
    fn the_recorded_course_is_within_its_reduction_of_the_model() {
        let recorded = Stimulus::recorded().course;
        assert!(recorded.points().len() <= COURSE_POINTS_MAX);
        let copper = find("copper").expect("copper");
        let contact =
            Contact::new((&SKIN, 34.0), (copper, 24.0), &REFERENCE_DISPLAY, pressure_pa(FORCE_N));
        for t_s in [0.5, 1.0, 3.0, 10.0] {
            let error_k: f64 = recorded.at(t_s) - contact.at(t_s).display_c;
            assert!(error_k.abs() < 5e-3, "{t_s} s: {error_k} K");
        }
    }
}
