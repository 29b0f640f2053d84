//! Courses that a host plays in place of an object, drawn by seed.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_client::client::upload_course;
use thermal_device::stimulus::{COURSE_RATE_MAX_K_S, TemperatureKind};

use super::scene_text;

/// Range of absolute temperatures, °C. A display that is held at the upper end does not reach the limit of the dose in the
/// longest scene.
const ABSOLUTE_C: (f64, f64) = (15.0, 41.0);
/// Range of relative temperatures, K above a skin of 34 °C.
const RELATIVE_K: (f64, f64) = (-19.0, 7.0);
/// Most points, so that a course is loaded within 60 ms.
const POINTS_MAX: usize = 12;
/// Range of the time between two points, s, drawn with a uniform logarithm.
const BETWEEN_S: (f64, f64) = (0.01, 5.0);
/// Most times that a course is played.
const TIMES_MAX: u32 = 20;
/// Range of the time from `play` to an edge at the trigger input, s.
const TRIGGER_AFTER_S: (f64, f64) = (0.1, 6.0);

/// Tables of a scene in which the host uploads and plays a drawn course from this time, s, on, with an edge at the trigger
/// input if the course waits for one before `end_s`.
pub(super) fn course_tables(seed: u64, t_s: f64, end_s: f64) -> String {
    let mut draw = Xoshiro256PlusPlus::seed_from_u64(seed);
    let is_absolute = draw.random_bool(0.5);
    let (temperatures, (low, high)) = if is_absolute {
        (TemperatureKind::Absolute, ABSOLUTE_C)
    } else {
        (TemperatureKind::AboveSkin, RELATIVE_K)
    };
    let mut points = vec![(0.0, draw.random_range(low..=high))];
    for _ in 1..draw.random_range(2..=POINTS_MAX) {
        let (before_s, before) = points[points.len() - 1];
        let part: f64 = draw.random();
        let between_s = BETWEEN_S.0 * (BETWEEN_S.1 / BETWEEN_S.0).powf(part);
        // Half of the largest rate leaves room for the rounding of times.
        let reach = between_s * 0.5 * f64::from(COURSE_RATE_MAX_K_S);
        let value: f64 = draw.random_range(low..=high);
        points.push((before_s + between_s, value.clamp(before - reach, before + reach)));
    }
    let start = ["now", "landing", "trigger"][draw.random_range(0..3)];
    let times = draw.random_range(1..=TIMES_MAX);
    let end = ["hold", "neutral"][draw.random_range(0..2)];
    let upload = upload_course(temperatures, &points).into_iter();
    let lines =
        upload.map(|command| command.to_string()).chain([format!("play {start} {times} {end}")]);
    let mut tables: String = lines.map(|line| scene_text::host_line(&line, t_s)).collect();
    let edge_s = t_s + draw.random_range(TRIGGER_AFTER_S.0..=TRIGGER_AFTER_S.1);
    if start == "trigger" && edge_s < end_s {
        tables += &format!("[[trigger]]\nt_s = {edge_s:?}\n");
    }
    tables
}

#[cfg(test)]
mod tests {
    use super::*;
    use thermal_sim::NativeRunner;
    use thermal_sim::SceneRunner;
    use thermal_sim::scene::Scene;

    /// 200 draws miss one of six shares of a third or more with a probability below 1e-30.
    #[test]
    fn every_kind_of_course_is_drawn() {
        let draws: Vec<_> = (0..200).map(|seed| course_tables(seed, 0.1, 9.0)).collect();
        for part in ["absolute", "relative", "now", "landing", "[[trigger]]", "neutral", "hold"] {
            let count = draws.iter().filter(|tables| tables.contains(part)).count();
            assert!(count > 30, "{part}: {count}");
        }
    }

    #[test]
    fn a_device_plays_drawn_courses() {
        for seed in 0..8 {
            let text = format!(
                "duration_s = 7\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\nappears_t_s = 7\n\
                 [[force]]\nt_s = 1\nforce_n = 2\n{}{}",
                course_tables(seed, 0.1, 7.0),
                scene_text::host_line("events on", 0.05),
            );
            let scene = Scene::parse(&text, "course".as_ref()).expect("a scene");
            let (outcome, figures) = NativeRunner.run(&scene).expect("runs");
            assert_eq!(figures.refused_lines, [], "{text}");
            assert!(figures.faults.is_empty(), "{text}");
            let states = (outcome.trace.rows().iter()).filter_map(|row| row.device.as_ref());
            let stimulus = states.filter(|device| device.state.name() == "stimulus");
            assert!(stimulus.count() > 100, "{text}");
        }
    }
}
