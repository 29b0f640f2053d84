use super::*;

fn streams() -> (Stream, Stream) {
    (Stream::new(1, "noise"), Stream::new(1, "lapse"))
}

fn judge(task: &Task, falls_k: &[f64], params: &ObserverParams) -> Option<Judgement> {
    let falls_k: Vec<Option<f64>> = falls_k.iter().copied().map(Some).collect();
    let (mut noise, mut lapses) = streams();
    task.judge(&falls_k, params, &mut noise, &mut lapses)
}

#[test]
fn each_task_has_its_rule() {
    let clear = &ObserverParams::NOISE_FREE;
    for (task, falls_k, choice) in [
        (Task::Colder(vec![0, 1]), vec![1.0, 1.1], 1),
        // The answers may be in another order than the stations.
        (Task::Colder(vec![1, 0]), vec![1.0, 1.1], 0),
        (Task::Different(vec![0, 1, 2]), vec![1.0, 1.0, 0.9], 2),
        (Task::Different(vec![0, 1, 2]), vec![1.3, 1.0, 1.0], 0),
        (Task::Identify(vec![3.0, 1.0]), vec![1.8], 1),
        (Task::Same(0, 1), vec![1.0, 1.0], 0),
        (Task::Same(0, 1), vec![1.0, 1.01], 1),
        (Task::Interval(Some(1.0)), vec![0.2, -0.5], 0),
        (Task::Interval(Some(-1.0)), vec![0.2, -0.5], 1),
        (Task::Interval(None), vec![0.2, -0.5], 1),
    ] {
        assert_eq!(
            judge(&task, &falls_k, clear),
            Some(Judgement::Choice(choice)),
            "{task:?} {falls_k:?}"
        );
    }
    assert_eq!(
        judge(&Task::Magnitude(0.0, 100.0), &[0.0, 4.0, 9.0, -1.0], clear),
        Some(Judgement::Numbers(vec![0.0, 50.0, 100.0, 0.0]))
    );
}

#[test]
fn what_was_not_felt_is_not_judged() {
    let (mut noise, mut lapses) = streams();
    let params = &ObserverParams::NOISE_FREE;
    let task = Task::Colder(vec![0, 1]);
    assert_eq!(
        task.judge(&[None, Some(1.0)], params, &mut noise, &mut lapses),
        None
    );
    let random = &ObserverParams::RANDOM;
    assert_eq!(
        task.judge(&[None, None], random, &mut noise, &mut lapses),
        None
    );
}

#[test]
fn noise_grows_with_the_fall() {
    let touch = ObserverParams::TOUCH;
    assert_eq!(touch.sigma_k(0.0), touch.s0_k);
    assert!((touch.sigma_k(100.0) / 100.0 - touch.w).abs() < 1e-3);
}

#[test]
fn draws_agree_with_the_closed_form() {
    const DRAWS: u32 = 20_000;
    let (mut noise, mut lapses) = streams();
    let params = &ObserverParams::TOUCH;
    let mut share = |task: &Task, falls_k: &[Option<f64>]| {
        let is_first = |_: &u32| {
            task.judge(falls_k, params, &mut noise, &mut lapses) == Some(Judgement::Choice(0))
        };
        f64::from((0..DRAWS).filter(is_first).count() as u32) / f64::from(DRAWS)
    };
    let colder = share(&Task::Colder(vec![0, 1]), &[Some(4.0), Some(3.0)]);
    let different = share(
        &Task::Different(vec![0, 1, 2]),
        &[Some(4.0), Some(1.0), Some(1.0)],
    );
    let expected_k = vec![4.0, 1.0, 0.2];
    let identified = share(&Task::Identify(expected_k.clone()), &[Some(4.0)]);
    use crate::predictions::closed_form;
    for (drawn, exact) in [
        (colder, closed_form::colder(params, [4.0, 3.0])),
        (different, closed_form::different(params, 4.0, 1.0)),
        (
            identified,
            closed_form::identified(params, 4.0, &expected_k)[0],
        ),
    ] {
        // Three and a half standard deviations of this many draws.
        assert!((drawn - exact).abs() < 0.0125, "{drawn}, {exact}");
    }
}

#[test]
fn a_fall_is_the_largest_one_since_the_landing() {
    let mut meter = FallMeter::default();
    for _ in 0..1000 {
        meter.push([33.0, 33.5]);
    }
    assert_eq!(meter.fall_k(), None);
    meter.begin();
    for (cold_c, ms) in [(31.0, 400), (32.5, 400)] {
        for _ in 0..ms {
            meter.push([cold_c, 33.0]);
        }
    }
    let fall_k = meter.fall_k().expect("a fall");
    assert!((fall_k - 2.0).abs() < 1e-9, "{fall_k}");
}

#[test]
fn a_short_dip_is_averaged() {
    let mut meter = FallMeter::default();
    for _ in 0..1000 {
        meter.push([33.0, 33.0]);
    }
    meter.begin();
    for ms in 0..1000 {
        meter.push([if ms < 100 { 31.0 } else { 33.0 }, 33.0]);
    }
    let fall_k = meter.fall_k().expect("a fall");
    assert!((fall_k - 1.0).abs() < 1e-9, "{fall_k}");
}

#[test]
fn warming_is_a_negative_fall_at_the_warm_receptors() {
    let mut meter = FallMeter::default();
    for _ in 0..1000 {
        meter.push([33.0, 33.2]);
    }
    meter.begin();
    for _ in 0..1000 {
        meter.push([34.0, 33.9]);
    }
    let fall_k = meter.fall_k().expect("a fall");
    assert!((fall_k + 0.7).abs() < 1e-9, "{fall_k}");
}
