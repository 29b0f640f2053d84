//! Courses: interpolation, reduction, limits of rate, and the lines of an upload.

use thermal_client::course::{Course, CourseError, CoursePoint, reduce};
use thermal_settings::CRC_32;

fn course(points: &[(f64, f64)]) -> Course {
    let points = points.iter().map(|&(t_s, celsius)| CoursePoint { t_s, celsius });
    Course::new(points.collect()).expect("a course")
}

/// Numbers from 0 to 1 of a linear congruential generator.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The line through chosen points at the time of another, by the definition of interpolation.
fn line_through(points: &[(f64, f64)], chosen: &[usize], i: usize) -> f64 {
    let after = chosen.iter().position(|c| *c >= i).expect("the last is chosen");
    let (b, a) = (points[chosen[after]], points[chosen[after.saturating_sub(1)]]);
    if chosen[after] == i {
        return b.1;
    }
    (a.1 * (b.0 - points[i].0) + b.1 * (points[i].0 - a.0)) / (b.0 - a.0)
}

/// The least largest error of all choices of at most `most` points with the first and the last.
fn brute_force(points: &[(f64, f64)], most: usize) -> f64 {
    let inner = points.len() - 2;
    let mut least = f64::INFINITY;
    for set in 0..1_u32 << inner {
        if set.count_ones() as usize + 2 > most {
            continue;
        }
        let inner = (1..points.len() - 1).filter(|i| set >> (i - 1) & 1 == 1);
        let chosen: Vec<_> = [0].into_iter().chain(inner).chain([points.len() - 1]).collect();
        let errors =
            (0..points.len()).map(|i| (line_through(points, &chosen, i) - points[i].1).abs());
        least = least.min(errors.fold(0.0, f64::max));
    }
    least
}

#[test]
fn a_reduction_has_the_least_error_of_all_choices_of_points() {
    for seed in 0..60 {
        let mut random = random(seed);
        let mut t_s = 0.0;
        let points: Vec<_> = (0..13)
            .map(|_| {
                let point = (t_s, 20.0 + 10.0 * random());
                t_s += 0.001 + random();
                point
            })
            .collect();
        for most in 2..12 {
            let reduced = reduce(&course(&points), most);
            assert!(reduced.course.points().len() <= most, "seed {seed}");
            let least = brute_force(&points, most);
            assert!(
                (reduced.error_k - least).abs() < 2e-7,
                "seed {seed}, {most} points: {} K, least {least} K",
                reduced.error_k
            );
        }
    }
}

#[test]
fn the_error_of_a_reduction_bounds_the_difference_at_every_time() {
    // 60 s of a decaying oscillation at 1 kHz: more points than are searched.
    let of = |t_s: f64| 30.0 + 3.0 * (-t_s / 20.0).exp() * (0.9 * t_s).sin();
    let points: Vec<_> =
        (0..=60_000).map(|ms| f64::from(ms) / 1e3).map(|t_s| (t_s, of(t_s))).collect();
    let whole = course(&points);
    let reduced = reduce(&whole, 128);
    assert!(reduced.course.points().len() <= 128);
    let mut largest: f64 = 0.0;
    for (t_s, celsius) in points {
        largest = largest.max((reduced.course.at(t_s) - celsius).abs());
    }
    assert!((largest - reduced.error_k).abs() < 1e-12, "{largest} {}", reduced.error_k);
    // A smooth function through n equal segments has an error of h²/8 times its second derivative, here 2.43 K/s² or less;
    // the best choice is better than equal segments.
    let equal_segments_k = (60.0_f64 / 127.0).powi(2) / 8.0 * 2.43;
    assert!(reduced.error_k < 0.6 * equal_segments_k, "{}", reduced.error_k);
    assert_eq!(reduced.course.points().first(), whole.points().first());
    assert_eq!(reduced.course.points().last(), whole.points().last());
}

#[test]
fn a_course_of_few_points_is_not_reduced() {
    let whole = course(&[(0.0, 30.0), (1.0, 25.0), (2.0, 26.0)]);
    let reduced = reduce(&whole, 3);
    assert_eq!((reduced.course, reduced.error_k), (whole, 0.0));
}

#[test]
fn points_on_a_few_lines_are_found_without_error() {
    let of = |t_s: f64| 34.0 - 4.0 * t_s.min(1.5) + 0.25 * (t_s - 1.5).max(0.0);
    let points: Vec<_> =
        (0..1000).map(|i| f64::from(i) / 128.0).map(|t_s| (t_s, of(t_s))).collect();
    let reduced = reduce(&course(&points), 3);
    assert!(reduced.error_k < 1e-12, "{}", reduced.error_k);
    assert_eq!(reduced.course.points()[1].t_s, 1.5);
}

#[test]
fn a_course_is_linear_between_its_points_and_constant_outside() {
    let course = course(&[(1.0, 30.0), (3.0, 26.0)]);
    for (t_s, celsius) in [(0.0, 30.0), (1.0, 30.0), (1.5, 29.0), (3.0, 26.0), (9.0, 26.0)] {
        assert_eq!(course.at(t_s), celsius, "{t_s} s");
    }
    assert_eq!(course.rate_max_k_s(), 2.0);
}

#[test]
fn points_in_disorder_are_no_course() {
    let new = |points: &[(f64, f64)]| {
        Course::new(points.iter().map(|&(t_s, celsius)| CoursePoint { t_s, celsius }).collect())
    };
    assert_eq!(new(&[]), Err(CourseError::Empty));
    assert_eq!(new(&[(0.0, 30.0), (1.0, f64::NAN)]), Err(CourseError::NotFinite { index: 1 }));
    let back = CourseError::Time { index: 1, t_s: 1.0, after_s: 1.0 };
    assert_eq!(new(&[(1.0, 30.0), (1.0, 29.0)]), Err(back));
    let before = CourseError::Time { index: 0, t_s: -0.1, after_s: 0.0 };
    assert_eq!(new(&[(-0.1, 30.0)]), Err(before));
}

#[test]
fn a_rate_limit_follows_the_course_as_soon_as_it_can() {
    let fast = course(&[(0.0, 34.0), (0.001, 24.0), (4.0, 24.0)]);
    let limited = fast.rate_limited(5.0);
    // A fall of 10 K at 5 K/s takes 2 s from the first point on.
    for (t_s, celsius) in [(0.0, 34.0), (1.0, 29.0), (2.0, 24.0), (4.0, 24.0)] {
        assert!((limited.at(t_s) - celsius).abs() < 1e-9, "{t_s} s: {}", limited.at(t_s));
    }
    assert!(limited.rate_max_k_s() < 5.0 + 1e-9);
    // It reaches the last temperature even after the course's end.
    let short = course(&[(0.0, 34.0), (1.0, 24.0)]).rate_limited(5.0);
    assert_eq!((short.duration_s(), short.at(2.0)), (2.0, 24.0));
    // It catches up in the middle of a segment that rises.
    let hook = course(&[(0.0, 30.0), (1.0, 20.0), (3.0, 26.0)]).rate_limited(5.0);
    assert!((hook.at(1.0) - 25.0).abs() < 1e-9);
    // Behind by 5 K at 1 s; it falls by 5 K/s and the course rises by 3 K/s.
    assert!((hook.at(1.625) - 21.875).abs() < 1e-9);
    assert!((hook.at(3.0) - 26.0).abs() < 1e-9);
    // And mirrored, in one that falls.
    let hook = course(&[(0.0, 20.0), (1.0, 30.0), (3.0, 24.0)]).rate_limited(5.0);
    assert!((hook.at(1.625) - 28.125).abs() < 1e-9);
    assert!((hook.at(3.0) - 24.0).abs() < 1e-9);
    let slow = course(&[(0.0, 30.0), (1.0, 27.0), (2.0, 28.0)]);
    assert_eq!(slow.rate_limited(5.0), slow);
}

#[test]
fn an_upload_ends_with_the_checksum_of_its_lines() {
    let course = course(&[(0.0, 30.0), (1.2344, 26.00004), (1.2346, 26.1), (2.0, 25.123_46)]);
    let commands = course.rounded().upload_lines();
    let lines: Vec<_> = commands.iter().map(ToString::to_string).collect();
    let rows = [
        "upload begin course 4 absolute",
        "upload row 0 0.000 30.000000",
        "upload row 1 1.234 26.000000",
    ];
    assert_eq!(lines[..3], rows);
    assert_eq!(lines[3..5], ["upload row 2 1.235 26.100000", "upload row 3 2.000 25.123500"]);
    let sent = lines[..5].join("\n") + "\n";
    assert_eq!(lines[5], format!("upload commit {:08x}", CRC_32.checksum(sent.as_bytes())));
}

#[test]
fn points_in_the_same_millisecond_become_one() {
    let course = course(&[(0.0, 30.0), (0.0002, 29.0), (0.0009, 28.0), (0.001_2, 27.0)]).rounded();
    let points: Vec<_> = course.points().iter().map(|point| (point.t_s, point.celsius)).collect();
    assert_eq!(points, [(0.0, 29.0), (0.001, 27.0)]);
}
