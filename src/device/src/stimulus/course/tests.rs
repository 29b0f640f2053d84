use super::*;

fn point(time_ms: u32, celsius: f64) -> CoursePoint {
    CoursePoint { time_ms, temperature: Celsius::from_num(celsius) }
}

fn course(temperatures: TemperatureKind, points: &[(u32, f64)]) -> Result<Course, CourseError> {
    let mut course = Course::new(temperatures);
    for &(time_ms, celsius) in points {
        course.push(point(time_ms, celsius))?;
    }
    course.check_whole()?;
    Ok(course)
}

#[test]
fn points_that_do_not_fit_are_refused_and_leave_the_course_as_it_was() {
    let mut course = Course::new(TemperatureKind::Absolute);
    course.push(point(0, 30.0)).expect("fits");
    course.push(point(100, 31.0)).expect("fits");
    let before = course.clone();
    for (wrong, error) in [
        (point(100, 31.0), CourseError::TimeGoesBack(100, 100)),
        (point(99, 31.0), CourseError::TimeGoesBack(99, 100)),
        (point(3_600_001, 31.0), CourseError::TooLong(3_600_001)),
        (point(200, 42.01), CourseError::OutOfRange),
        (point(200, 14.99), CourseError::OutOfRange),
        (point(101, 32.0), CourseError::TooFast(1000)),
        (point(110, 32.5), CourseError::TooFast(150)),
        (point(110, 29.9), CourseError::TooFast(110)),
    ] {
        assert_eq!(course.push(wrong), Err(error), "{wrong:?}");
        assert_eq!(course, before);
    }
    assert_eq!(course.push(point(110, 32.0)), Ok(()));
    assert_eq!(course.extremes(), (Celsius::lit("30"), Celsius::lit("32")));
}

#[test]
fn a_course_has_2_to_128_points() {
    let of = |count: u32| {
        let points: std::vec::Vec<_> = (0..count).map(|n| (n * 10, 30.0)).collect();
        course(TemperatureKind::Absolute, &points).map(|course| course.points().len())
    };
    assert_eq!(of(0), Err(CourseError::TooFewPoints));
    assert_eq!(of(1), Err(CourseError::TooFewPoints));
    assert_eq!(of(2), Ok(2));
    assert_eq!(of(128), Ok(128));
    assert_eq!(of(129), Err(CourseError::TooManyPoints));
}

/// 42 °C counts a quarter: 120 s are the limit of 30 s.
#[test]
fn a_course_that_alone_trips_by_its_dose_is_refused_with_the_dose() {
    let warm = |hold_ms| course(TemperatureKind::Absolute, &[(0, 42.0), (hold_ms, 42.0)]);
    assert!(warm(119_900).is_ok());
    let Err(CourseError::TooHotForTooLong(dose_ms)) = warm(160_000) else {
        panic!("accepted");
    };
    assert!((39_990..40_010).contains(&dose_ms), "{dose_ms}");
}

#[test]
fn the_dose_of_a_relative_course_depends_on_the_skin() {
    let relative = [(0, 0.0), (8000, 8.0), (248_000, 8.0), (256_000, 0.0)];
    let course = course(TemperatureKind::AboveSkin, &relative).expect("fits");
    // 240 s at 8 K above the skin, and the ramps.
    for (skin_c, hold_dose_s) in [(34.0, 60.0), (33.0, 15.0), (32.0, 3.75)] {
        let dose_s = f64::from(course.dose(Celsius::from_num(skin_c)).milliseconds_at_43()) / 1e3;
        // Each ramp of 1 K/s gives 1 s / ln 4 at the top, of which 1 - 4^-3 counts.
        let exact_s = hold_dose_s * (1.0 + 2.0 * (1.0 - 1.0 / 64.0) / libm::log(4.0) / 240.0);
        assert!((dose_s / exact_s - 1.0).abs() < 0.002, "{skin_c}: {dose_s}, {exact_s}");
    }
}
