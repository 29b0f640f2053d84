//! Bodies against their impedance in `f64`.

extern crate std;

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::fixed_point::Celsius;
use crate::material::SKIN;

const TICK_S: f64 = 1e-3;

/// Surface after each of these scaled fluxes, K, by the exact response to their steps.
fn exact(impedance: &Impedance<'_>, fluxes: &[f64]) -> Vec<f64> {
    let flux_w_m2 = SKIN.effusivity() / libm::sqrt(TICK_S);
    let mut states: Vec<f64> = impedance.relaxations.iter().map(|_| 0.0).collect();
    let step = |flux: &f64| {
        for (state, one) in states.iter_mut().zip(impedance.relaxations) {
            let one_only = Impedance { direct_m2k_w: 0.0, relaxations: core::slice::from_ref(one) };
            *state = *state * libm::exp(-one.rate_1_s * TICK_S)
                + flux * flux_w_m2 * one_only.step_response(TICK_S);
        }
        impedance.direct_m2k_w * flux_w_m2 * flux + states.iter().sum::<f64>()
    };
    fluxes.iter().map(step).collect()
}

fn relaxation() -> impl Strategy<Value = Relaxation> {
    (1e-3..690.0f64, -9.0..-4.5f64)
        .prop_map(|(rate_1_s, gain)| Relaxation { rate_1_s, gain_m2k_j: libm::pow(10.0, gain) })
}

proptest! {
    #[test]
    fn surface_follows_the_impedance(
        relaxations in prop::collection::vec(relaxation(), 1..6),
        integrator in 1e-9..1e-5f64,
        direct_m2k_w in 0.0..1e-4f64,
    ) {
        let mut relaxations = relaxations;
        relaxations.push(Relaxation { rate_1_s: 0.0, gain_m2k_j: integrator });
        let impedance = Impedance { direct_m2k_w, relaxations: &relaxations };
        let body = Body::new(&impedance, SKIN.effusivity(), TICK_S).expect("a valid body");
        let fluxes: Vec<f64> = (0..3000u32).map(|i| if i < 1500 { 0.5 / f64::from(i + 1) } else { -0.1e-3 }).collect();
        let mut state = BodyState::default();
        let mut largest = 0.0f64;
        let mut worst = 0.0f64;
        for (flux, exact) in fluxes.iter().zip(exact(&impedance, &fluxes)) {
            let flux = Celsius::from_num(*flux);
            let now = state.response_to(flux, &body.relaxations()).to_num::<f64>();
            state.step(flux, &body.relaxations());
            largest = largest.max(exact.abs());
            worst = worst.max((now - exact).abs());
        }
        prop_assert!(worst < 2e-3 * largest + 1e-4, "{worst} of {largest}");
    }

    #[test]
    fn no_flux_overflows(
        relaxations in prop::collection::vec(relaxation(), 1..6),
        fluxes in prop::collection::vec(any::<i32>(), 1..50),
    ) {
        let impedance = Impedance { direct_m2k_w: 0.0, relaxations: &relaxations };
        let Ok(body) = Body::new(&impedance, SKIN.effusivity(), TICK_S) else { return Ok(()) };
        let mut state = BodyState::default();
        for bits in fluxes {
            for _ in 0..200 {
                state.step(Celsius::from_bits(bits), &body.relaxations());
            }
        }
    }
}

/// The body of these rates whose gains, all equal, are the largest that are allowed, m² K/J.
fn largest(rates_1_s: &[f64], direct_m2k_w: f64) -> Body {
    let with = |gain_m2k_j| {
        let relaxations: Vec<_> =
            (rates_1_s.iter()).map(|&rate_1_s| Relaxation { rate_1_s, gain_m2k_j }).collect();
        let impedance = Impedance { direct_m2k_w, relaxations: &relaxations };
        Body::new(&impedance, SKIN.effusivity(), TICK_S)
    };
    let (mut allowed, mut refused) = (1e-12, 1e3);
    while refused > 1.000_001 * allowed {
        let gain_m2k_j = libm::sqrt(allowed * refused);
        match with(gain_m2k_j) {
            Ok(_) => allowed = gain_m2k_j,
            Err(_) => refused = gain_m2k_j,
        }
    }
    with(allowed).expect("an allowed body")
}

#[test]
fn largest_bodies_under_the_largest_flux_neither_overflow_nor_change_sign() {
    // Ends of the range of rates: the slowest fast one is 12.5 1/s.
    for (fast_1_s, slow_1_s) in
        [(690.0, 12.499), (690.0, 0.0), (12.5, 12.499), (12.5, 1e-6), (100.0, 1.0)]
    {
        let rates_1_s = [[fast_1_s].repeat(FAST_MAX), [slow_1_s].repeat(SLOW_MAX)].concat();
        for (rates_1_s, direct_m2k_w) in [
            (&rates_1_s[..], 0.0),
            (&rates_1_s[..], 0.027),
            (&rates_1_s[..1], 0.0),
            (&rates_1_s[FAST_MAX..], 0.0),
            (&rates_1_s[rates_1_s.len() - 1..], 0.0),
        ] {
            let body = largest(rates_1_s, direct_m2k_w);
            let relaxations = body.relaxations();
            let mut state = BodyState::default();
            let mut warmest = Celsius::ZERO;
            for _ in 0..5000 {
                warmest = warmest.max(state.response_to(Celsius::MAX, &relaxations));
                state.step(Celsius::MAX, &relaxations);
                assert!(state.free_response() >= 0, "{rates_1_s:?}: {state:?}");
            }
            assert!(warmest > 511, "{rates_1_s:?}: {warmest}");
            // The largest step back, which an integrator needs as long for, and a flux that turns in every window.
            for _ in 0..12_000 {
                state.step(Celsius::MIN, &relaxations);
            }
            assert!(state.free_response() <= 0, "{rates_1_s:?}: {state:?}");
            for tick in 0..5000 {
                let flux = [Celsius::MIN, Celsius::MAX][tick / 8 % 2];
                state.step(flux, &relaxations);
                let _ = state.response_to(flux, &relaxations);
            }
        }
    }
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let with = |relaxations: &[Relaxation], direct_m2k_w| {
        Body::new(&Impedance { direct_m2k_w, relaxations }, SKIN.effusivity(), TICK_S).err()
    };
    let one = |rate_1_s, gain_m2k_j| Relaxation { rate_1_s, gain_m2k_j };
    assert_eq!(with(&[one(700.0, 1e-6)], 0.0), Some(BodyError::Rate(700.0)));
    assert_eq!(with(&[one(690.0, 1e-6)], 0.0), None);
    assert_eq!(with(&[one(-1.0, 1e-6)], 0.0), Some(BodyError::Rate(-1.0)));
    assert!(matches!(with(&[one(f64::NAN, 1e-6)], 0.0), Some(BodyError::Rate(_))));
    let message = |relaxations: &[Relaxation], direct_m2k_w| {
        with(relaxations, direct_m2k_w).map(|error| std::format!("{error}"))
    };
    for (gain_m2k_j, index, text) in [
        (-1e-6, 0, "gain -1 mm2K/J of relaxation 0; above 0 to "),
        (0.0, 2, "gain 0 mm2K/J of relaxation 2; above 0 to "),
        (14.0, 1, "gain 14000000 mm2K/J of relaxation 1; above 0 to "),
        (f64::NAN, 1, "gain NaN mm2K/J of relaxation 1; above 0 to "),
    ] {
        let mut relaxations = [one(1.0, 1e-6); 3];
        relaxations[index].gain_m2k_j = gain_m2k_j;
        let message = message(&relaxations, 0.0).expect("an error");
        assert!(message.starts_with(text), "{message}");
    }
    for direct_m2k_w in [-1.0, 1.0, f64::NAN] {
        let message = message(&[], direct_m2k_w).expect("an error");
        let text = std::format!("direct {} mm2K/W; it must be 0 to 27", direct_m2k_w * 1e6);
        assert!(message.starts_with(&text), "{message}");
    }
    assert_eq!(
        with(&[one(100.0, 1e-6); FAST_MAX + 1], 0.0),
        Some(BodyError::TooManyFast(FAST_MAX + 1))
    );
    assert_eq!(
        with(&[one(0.1, 1e-6); SLOW_MAX + 1], 0.0),
        Some(BodyError::TooManySlow(SLOW_MAX + 1))
    );
    assert_eq!(with(&[one(0.1, 1e-6); SLOW_MAX], 0.0), None);
}

/// The largest gain that an error names is allowed, and hardly more is.
#[test]
fn the_gain_that_a_refusal_allows_is_the_limit() {
    for (before, rate_1_s) in [(1.0, 0.0), (3.5, 5.0), (2.0, 13.0), (0.5, 40.0), (9.0, 690.0)] {
        let with = |gain_m2k_j| {
            let before = Relaxation { rate_1_s: 0.0, gain_m2k_j: before };
            let last = Relaxation { rate_1_s, gain_m2k_j };
            let impedance = Impedance { direct_m2k_w: 0.0, relaxations: &[before, last] };
            Body::new(&impedance, SKIN.effusivity(), TICK_S).err()
        };
        let Some(BodyError::Gain { gain_m2k_j, max_m2k_j, index: 1 }) = with(20.0) else {
            panic!("20 m2K/J at {rate_1_s} 1/s: {:?}", with(20.0));
        };
        assert_eq!(gain_m2k_j, 20.0);
        assert_eq!(with(max_m2k_j * (1.0 - 1e-12)), None, "{rate_1_s} 1/s");
        assert!(with(max_m2k_j * (1.0 + 1e-12)).is_some(), "{rate_1_s} 1/s");
    }
}

/// The constants of a finger as they stand in the source.
fn source(finger: &FingerBody) -> std::string::String {
    let tissue = &finger.tissue;
    let fast: Vec<_> = (tissue.fast[..tissue.fast_count].iter())
        .map(|one| [one.input_gain.to_bits(), -one.change.to_bits(), one.horizon_factor.to_bits()])
        .collect();
    let slow: Vec<_> = (tissue.slow[..tissue.slow_count].iter())
        .map(|one| [one.input_gain.to_bits(), one.decay.to_bits()])
        .collect();
    let sums = [
        tissue.slow_input_gain.to_bits(),
        tissue.tick_gain.to_bits(),
        tissue.inverse_horizon_gain.to_bits(),
    ];
    let (scale, air) = (tissue.state_scale, finger.air.to_bits());
    std::format!("Body::from_bits({fast:?}, {slow:?}, {sums:?}, {scale}), air {air}")
}

#[test]
fn committed_fingers_are_those_of_their_impedances() {
    for (committed, finger) in [
        (FingerBody::THESIS, crate::finger::THESIS),
        (FingerBody::MEAN, crate::finger::MEAN),
        (FingerBody::MEAN_ON_PAD, crate::finger::MEAN_ON_PAD),
    ] {
        let computed = FingerBody::new(&finger, TICK_S).expect("a valid finger");
        assert_eq!(source(&committed), source(&computed));
    }
}

/// Against `libm::expm1`, for arguments down to those of a relaxation of 1e-9 per tick.
#[test]
fn expm1_has_no_cancellation() {
    for k in -120..=13 {
        for x in [10f64.powf(f64::from(k) / 10.0), -(10f64.powf(f64::from(k) / 10.0))] {
            let exact = libm::expm1(x);
            assert!((expm1(x) / exact - 1.0).abs() < 1e-15, "{x}: {} for {exact}", expm1(x));
        }
    }
}
