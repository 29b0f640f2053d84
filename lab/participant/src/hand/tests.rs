use super::*;

fn course(
    params: &HandParams,
    rule: ContactRule,
    target_n: Option<f64>,
    seed: u64,
) -> (Touches, ForceCourse) {
    let mut random = Stream::new(seed, "hand");
    let touches = Touches::new(params, rule, 20.0, &mut random);
    let course = ForceCourse::new(params, &touches, target_n, &mut random);
    (touches, course)
}

const NEVER: f64 = f64::INFINITY;

#[test]
fn free_exploration_has_touches_and_lifts_of_the_allowed_lengths() {
    let params = HandParams::TYPICAL;
    for seed in 0..50 {
        let (touches, course) = course(&params, ContactRule::Free, None, seed);
        let mut before_s: Option<f64> = None;
        for &(start_s, end_s) in &touches.0 {
            assert!((params.touch_s.0..=params.touch_s.1).contains(&(end_s - start_s)));
            if let Some(before_s) = before_s {
                let lifted_s = start_s - before_s;
                assert!(lifted_s > params.lift_s.0 - 1e-9 && lifted_s < params.lift_s.1 + 1e-9);
                assert_eq!(course.force_n(f64::midpoint(before_s, start_s), NEVER), 0.0);
            }
            before_s = Some(end_s);
        }
    }
}

#[test]
fn the_force_of_a_held_touch_rises_to_its_target_and_falls_at_the_lift() {
    let (_, course) = course(&HandParams::STEADY, ContactRule::Hold, None, 1);
    let median_n = HandParams::STEADY.force_median_n;
    let mut before_n = 0.0;
    for ms in 0..3000 {
        let force_n = course.force_n(f64::from(ms) * 1e-3, NEVER);
        assert!(force_n >= before_n && force_n > 0.0 && force_n <= median_n);
        before_n = force_n;
    }
    assert!(before_n > 0.99 * median_n);
    assert!(course.force_n(2.02, 2.0) < before_n);
    assert_eq!(course.force_n(2.1, 2.0), 0.0);
}

#[test]
fn large_forces_are_reached_later() {
    let reached_s = |target_n: f64| {
        let (_, course) = course(&HandParams::STEADY, ContactRule::Force, Some(target_n), 1);
        (0..5000)
            .map(|ms| f64::from(ms) * 1e-3)
            .find(|t_s| course.force_n(*t_s, NEVER) >= 0.9 * target_n)
    };
    assert!(reached_s(0.25) < reached_s(2.0));
}

#[test]
fn a_followed_force_settles_within_a_few_per_cent() {
    let params = HandParams::TYPICAL;
    for seed in 0..50 {
        let (_, course) = course(&params, ContactRule::Force, Some(1.0), seed);
        let samples = (8000..10_000).map(|ms| course.force_n(f64::from(ms) * 1e-3, NEVER));
        let mean_n = samples.sum::<f64>() / 2000.0;
        assert!((mean_n - 1.0).abs() < 4.0 * params.follow_sd, "{mean_n}");
    }
}

#[test]
fn forces_are_drawn_around_their_median() {
    let params = HandParams::TYPICAL;
    let mut ln: Vec<f64> = (0..400)
        .map(|seed| course(&params, ContactRule::Hold, None, seed).1.presses[0].target_n.ln())
        .collect();
    ln.sort_by(f64::total_cmp);
    assert!((ln[200] - params.force_median_n.ln()).abs() < 0.06);
    let (low, high) = (ln[64], ln[336]);
    assert!((0.5 * (high - low) / params.force_sigma_ln - 1.0).abs() < 0.2);
}
