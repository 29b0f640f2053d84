use std::vec::Vec;

use super::*;

fn limits(sensor_lag_s: f64) -> ReferenceLimits {
    ReferenceLimits::new(&Tile { sensor_lag_s, dead_time_s: 0.02, ..Tile::FACTORY_DEFAULT })
}

fn reference(celsius: f64) -> Reference {
    Reference::at(Celsius::from_num(celsius))
}

/// Set-points, °C, of so many ticks from a reading on the way to a wanted set-point.
fn way(limits: &ReferenceLimits, reading_c: f64, wanted_c: f64, ticks: usize) -> Vec<f64> {
    let mut last = None;
    let mut next = || {
        let next = limits.limit(Law::Pi, reference(wanted_c), last, Celsius::from_num(reading_c));
        last = Some(next);
        next.setpoint.celsius().to_num()
    };
    (0..ticks).map(|_| next()).collect()
}

/// `T = limit + (start - limit) e^(-t/tau)`: towards 43 °C with seven effective dead times, towards 14 °C with fourteen, from where
/// this is as slow as the display, 5 K/s: 5 tau before the limit. The reference jumps there.
#[test]
fn the_reference_approaches_the_limits_of_the_surface_exponentially() {
    for (lag_s, dead_time_s) in [(0.02, 0.09), (0.05, 0.12), (0.13, 0.2), (0.5, 0.57)] {
        let limits = limits(lag_s);
        for (wanted_c, limit_c, tau_s) in
            [(42.0, 43.0, 7.0 * dead_time_s), (15.0, 14.0, -14.0 * dead_time_s)]
        {
            let from_c = 27.0f64;
            let jumps_to_c = limit_c - 5.0 * tau_s;
            let start_c = if tau_s > 0.0 { from_c.max(jumps_to_c) } else { from_c.min(jumps_to_c) };
            let first_s = if start_c == from_c { 1e-3 } else { 0.0 };
            for (tick, celsius) in way(&limits, from_c, wanted_c, 1000).iter().enumerate() {
                let t_s = first_s + 1e-3 * tick as f64;
                let exact_c = limit_c + (start_c - limit_c) * libm::exp(-t_s / tau_s.abs());
                let exact_c = exact_c.clamp(17.0, 41.0);
                assert!((celsius - exact_c).abs() < 0.02, "{lag_s} s: {celsius}, not {exact_c} °C");
            }
        }
    }
}

/// Both ends by 4 K for each second of dead time beyond 0.2 s, and the cold one by 2 K, the warm one by 1 K.
#[test]
fn the_range_ends_where_a_finger_that_lifts_cannot_take_the_surface_beyond_its_limits() {
    for (lag_s, min_c, max_c) in [(0.1, 17.0, 41.0), (0.13, 17.0, 41.0), (0.5, 18.48, 39.52)] {
        let limits = limits(lag_s);
        for (wanted_c, end_c) in [(15.0, min_c), (42.0, max_c)] {
            let last = way(&limits, 27.0, wanted_c, 60_000).pop().expect("a tick");
            assert!((last - end_c).abs() < 1e-5, "{lag_s} s, {wanted_c} °C: {last} °C");
            let limited = limits.limit(Law::Pi, reference(wanted_c), None, Celsius::ZERO).limited;
            assert_eq!(limited, (wanted_c - end_c).abs() > 1e-9, "{lag_s} s, {wanted_c} °C");
        }
    }
}

#[test]
fn a_wanted_set_point_that_is_near_enough_is_taken_as_it_is() {
    let limits = limits(0.1);
    for wanted_c in [30.0, 30.001, 29.9995] {
        let wanted = reference(wanted_c);
        assert_eq!(limits.limit(Law::Pi, wanted, Some(reference(30.0)), Celsius::ZERO), wanted);
        assert_eq!(limits.limit(Law::Pi, wanted, None, Celsius::lit("30")), wanted);
    }
}

#[test]
fn only_the_plain_laws_of_a_quick_tile_that_was_identified_are_limited() {
    let others = [limits(0.2), limits(0.5), ReferenceLimits::new(&Tile::FACTORY_DEFAULT)];
    for (law, quick_is_limited) in [(Law::Model, false), (Law::Pi, true), (Law::Pi10Hz, true)] {
        assert_eq!(limits(0.13).apply_to(law), quick_is_limited, "{law:?}");
        assert!(others.iter().all(|limits| limits.apply_to(law)), "{law:?}");
    }
}

/// By 3 K at the cold end and 1 K at the warm one for each second of dead time beyond 0.2 s, and at once.
#[test]
fn under_the_law_model_a_slow_tile_has_a_smaller_range() {
    let limits = limits(0.5);
    for (wanted_c, allowed_c) in [(15.0, 16.11), (16.2, 16.2), (41.6, 41.6), (42.0, 41.63)] {
        for target_c in [15.0f64, 30.0, 42.0] {
            let wanted = Reference::limited_to_safe_range(
                Celsius::from_num(wanted_c),
                Celsius::from_num(target_c),
            );
            let found = limits.limit(Law::Model, wanted, None, Celsius::ZERO);
            let [setpoint_c, found_c] =
                [found.setpoint, found.target].map(|setpoint| setpoint.celsius().to_num::<f64>());
            assert!((setpoint_c - allowed_c).abs() < 1e-5, "{wanted_c} °C: {setpoint_c} °C");
            assert!((found_c - target_c.clamp(16.11, 41.63)).abs() < 1e-5, "{target_c} °C");
            assert_eq!(found.limited, wanted_c != allowed_c, "{wanted_c} °C");
        }
    }
}

/// 20 to 38 °C, 1 K/s.
#[test]
fn the_reference_of_a_tile_that_was_never_identified_moves_slowly_in_a_small_range() {
    let limits = ReferenceLimits::new(&Tile::FACTORY_DEFAULT);
    for (wanted_c, end_c, k_s) in [(42.0, 38.0, 1.0), (15.0, 20.0, -1.0)] {
        for (tick, celsius) in way(&limits, 27.0, wanted_c, 20_000).iter().enumerate() {
            let t_s = 1e-3 * (tick + 1) as f64;
            let exact_c = if k_s > 0.0 { (27.0 + t_s).min(end_c) } else { (27.0 - t_s).max(end_c) };
            assert!((celsius - exact_c).abs() < 5e-3, "{t_s} s: {celsius}, not {exact_c} °C");
        }
    }
    let arrived = limits.limit(Law::Pi, reference(30.0), Some(reference(30.0)), Celsius::ZERO);
    assert!(!arrived.limited);
    let on_the_way = limits.limit(Law::Pi, reference(30.0), Some(reference(29.0)), Celsius::ZERO);
    assert!(on_the_way.limited);
}

/// Else `hold` at the fastest ramp that it allows would report a limit on the whole way.
#[test]
fn a_ramp_of_1_k_s_is_not_limited_on_a_tile_that_was_never_identified() {
    let limits = ReferenceLimits::new(&Tile::FACTORY_DEFAULT);
    for rate_k_s in [1.0, -1.0] {
        let mut last = reference(29.0);
        for tick in 1..=8000 {
            let wanted = reference(29.0 + rate_k_s * 1e-3 * f64::from(tick));
            let next = limits.limit(Law::Pi, wanted, Some(last), Celsius::ZERO);
            assert_eq!(next, wanted, "{rate_k_s} K/s, tick {tick}");
            last = next;
        }
    }
}
