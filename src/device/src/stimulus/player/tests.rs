use std::vec::Vec;

use proptest::prelude::*;

use super::*;

const fn order(times: u16, end: CourseEnd) -> PlayOrder {
    PlayOrder { start: CourseStart::Now, play_count: times, end }
}

/// The course after `ms` of one playing, by rational interpolation in 128 bits, rounded down to a step of 2^-22 K.
fn exact(points: &[CoursePoint], ms: u32) -> i128 {
    let bits = |point: &CoursePoint| i128::from(point.temperature.to_bits());
    let (first, last) = (points[0], points[points.len() - 1]);
    if ms <= first.time_ms {
        return bits(&first);
    }
    if ms >= last.time_ms {
        return bits(&last);
    }
    let end = points.iter().position(|point| point.time_ms > ms).expect("a later point");
    let (from, to) = (&points[end - 1], &points[end]);
    let (passed, whole) = (i128::from(ms - from.time_ms), i128::from(to.time_ms - from.time_ms));
    bits(from) + ((bits(to) - bits(from)) * passed).div_euclid(whole)
}

fn courses() -> impl Strategy<Value = Vec<CoursePoint>> {
    let points = proptest::collection::vec((1u32..400, 15i32 << 22..42 << 22), 2..20);
    (points, 0u32..50).prop_map(|(steps, first_ms)| {
        let mut time_ms = first_ms;
        let mut points = Vec::new();
        for (index, (duration_ms, bits)) in steps.into_iter().enumerate() {
            time_ms += if index == 0 { 0 } else { duration_ms };
            let temperature = Celsius::from_bits(bits);
            points.push(CoursePoint { time_ms, temperature });
        }
        points
    })
}

/// Plays a course to 100 ms after its end, which must be exact in each tick.
fn check_exact(
    points: &[CoursePoint],
    times: u16,
    elapsed: u32,
    base: Celsius,
) -> Result<(), TestCaseError> {
    let mut player = Player::new(points, base, &order(times, CourseEnd::Neutral), elapsed);
    let period_ms = points[points.len() - 1].time_ms;
    let total_ms = period_ms * u32::from(times);
    let at = |ms: u32| {
        // A course is at its last point when it ends, and goes on from its first one in the next tick.
        let ms = ms.min(total_ms);
        let in_period =
            if ms > 0 && ms.is_multiple_of(period_ms) { period_ms } else { ms % period_ms };
        exact(points, in_period) + i128::from(base.to_bits())
    };
    for ms in elapsed..total_ms + 100 {
        let (temperatures, ended) = player.next_temperatures(points);
        prop_assert_eq!(i128::from(temperatures.now.to_bits()), at(ms), "{} ms", ms);
        prop_assert_eq!(i128::from(temperatures.target.to_bits()), at(ms + 14), "{} ms", ms);
        prop_assert_eq!(ended, (ms >= total_ms).then_some(CourseEnd::Neutral), "{} ms", ms);
    }
    Ok(())
}

proptest! {
    #[test]
    fn each_tick_is_the_exact_interpolation_and_its_target_that_of_14_ms_later(
        points in courses(), times in 1u16..4, elapsed in 0u32..32, base in -5i32 << 22..5 << 22,
    ) {
        check_exact(&points, times, elapsed, Celsius::from_bits(base))?;
    }
}

#[test]
fn courses_of_points_1_ms_apart_are_played_exactly_whatever_has_elapsed_before_their_first_tick() {
    for (count, times) in [(2, 1), (2, 200), (3, 70), (48, 5), (128, 1), (128, 3)] {
        let points: Vec<_> = (0..count)
            .map(|point: u32| CoursePoint {
                time_ms: point,
                temperature: Celsius::from_bits((30 << 22) + (point * 7919 % 400_003) as i32),
            })
            .collect();
        for elapsed in 0..=40 {
            check_exact(&points, times, elapsed, Celsius::ZERO)
                .unwrap_or_else(|error| panic!("{count} points, {elapsed} ms: {error}"));
        }
    }
}
