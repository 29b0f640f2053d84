//! Weighted tissues against their impedance in `f64`, and changes of weights against histories under the last ones.

extern crate std;

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::finger::MEAN;
use crate::fixed_point::{Celsius, MATCH_HORIZON_TICKS, TissueState, TissueStateFactors};
use crate::impedance::{Impedance, Relaxation};
use crate::material::SKIN;

const TICK_S: f64 = 1e-3;

/// Flux, W/m², of a scaled flux of 1 K.
fn flux_w_m2() -> f64 {
    SKIN.effusivity() / libm::sqrt(TICK_S)
}

/// The mean finger's relaxations and direct term with these weights, as impedances of one term each, the integrator first.
fn terms(weights: &[f64; WEIGHTS]) -> Vec<(Option<Relaxation>, f64)> {
    let relaxations = MEAN.impedance.relaxations.iter();
    let weight = |index: usize| index.checked_sub(1).map_or(1.0, |index| weights[index]);
    let relaxations = relaxations.enumerate().map(|(index, one)| {
        let gain_m2k_j = one.gain_m2k_j * weight(index);
        (Some(Relaxation { gain_m2k_j, ..*one }), 0.0)
    });
    let direct = (None, MEAN.impedance.direct_m2k_w * weight(WEIGHTS));
    relaxations.chain([direct]).collect()
}

#[test]
fn parts_are_those_of_the_mean_finger() {
    let computed: Vec<_> = (terms(&[1.0; WEIGHTS]).iter())
        .map(|(relaxation, direct_m2k_w)| {
            let impedance =
                Impedance { direct_m2k_w: *direct_m2k_w, relaxations: relaxation.as_slice() };
            let after = |t_s| flux_w_m2() * impedance.step_response(t_s);
            let slow = relaxation.filter(|one| one.rate_1_s * TICK_S < 0.0125);
            let slow = slow.map_or(0.0, |one| {
                let scale = f64::from(FingerBody::MEAN.tissue.state_scale * SCALE);
                after(TICK_S) * libm::exp(-one.rate_1_s * TICK_S) / scale
            });
            [
                libm::round(libm::ldexp(slow, 32)) as i32,
                libm::round(libm::ldexp(after(TICK_S), TICK_BITS as i32)) as i32,
                libm::round(libm::ldexp(
                    after(f64::from(MATCH_HORIZON_TICKS) * TICK_S),
                    HORIZON_BITS as i32,
                )) as i32,
            ]
        })
        .collect();
    let committed: Vec<_> = (core::iter::once(&INTEGRATOR).chain(&PARTS))
        .map(|one| [one.slow_input_gain, one.tick_gain, one.horizon_gain])
        .collect();
    assert_eq!(committed, computed);
}

fn fixed(weights: [f64; WEIGHTS]) -> TissueWeights {
    TissueWeights::at_least_min(weights.map(I2F30::saturating_from_num))
}

fn weights() -> impl Strategy<Value = [f64; WEIGHTS]> {
    prop::array::uniform(0.4..2.0f64)
}

/// Scaled fluxes, K, and for how many ticks each lasts.
fn history() -> impl Strategy<Value = Vec<(f64, usize)>> {
    prop::collection::vec((-8.0..8.0f64, 1..3000usize), 1..8)
}

fn step(state: &mut TissueState, fluxes: &[(f64, usize)], tissue: &Body) {
    for (flux, ticks) in fluxes {
        for _ in 0..*ticks {
            state.step(Celsius::from_num(*flux), &tissue.relaxations());
        }
    }
}

#[test]
fn weights_below_the_least_are_raised_to_it() {
    let weights = fixed([-2.0; WEIGHTS]);
    assert_eq!(*weights.get(), [TissueWeights::MIN; WEIGHTS]);
}

/// The largest flux takes slow states to their limit; a factor of 5 must not take them beyond it.
#[test]
fn states_at_their_limit_stay_within_it() {
    let [low, high] = [[0.4; WEIGHTS], [2.0; WEIGHTS]].map(|weights| fixed(weights).tissue());
    let factors = TissueStateFactors::new(&low.relaxations(), &high.relaxations());
    for flux in [Celsius::MIN, Celsius::MAX] {
        let mut state = TissueState::default();
        for _ in 0..60_000 {
            state.step(flux, &low.relaxations());
        }
        state.rescale(&factors, &high.relaxations());
        for _ in 0..100 {
            state.step(flux, &high.relaxations());
        }
        assert_eq!(state.free_response() > 0, flux > 0);
    }
}

proptest! {
    #[test]
    fn tissue_is_the_body_of_the_weighted_impedance(weights in weights()) {
        let terms = terms(&weights);
        let relaxations: Vec<_> = terms.iter().filter_map(|(one, _)| *one).collect();
        let impedance = Impedance {
            direct_m2k_w: terms.iter().map(|(_, direct)| direct).sum(),
            relaxations: &relaxations,
        };
        let exact = Body::new(&impedance, SKIN.effusivity(), TICK_S).expect("a valid body");
        let tissue = fixed(weights).tissue();
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 3e-6;
        prop_assert!(close(tissue.tick_gain.to_num(), exact.tick_gain.to_num()));
        let inverse = |body: &Body| body.inverse_horizon_gain.to_num();
        prop_assert!(close(inverse(&tissue), inverse(&exact)));
        let input = |body: &Body| body.slow_input_gain.to_num::<f64>() * f64::from(body.state_scale);
        prop_assert!(close(input(&tissue), input(&exact)));
        let surface = |body: &Body| {
            let mut state = TissueState::default();
            step(&mut state, &[(3.0, 500)], body);
            state.free_response().to_num()
        };
        prop_assert!(close(surface(&tissue), surface(&exact)));
    }

    #[test]
    fn rescaled_state_is_that_of_its_heat_history_under_the_new_weights(
        history in history(),
        weights in prop::collection::vec(weights(), 8),
        rest in 0..100usize,
    ) {
        let (mut tissue, mut rescaled) = (FingerBody::MEAN.tissue, TissueState::default());
        for (part, weights) in history.iter().zip(weights) {
            step(&mut rescaled, core::slice::from_ref(part), &tissue);
            let next = fixed(weights).tissue();
            let factors = TissueStateFactors::new(&tissue.relaxations(), &next.relaxations());
            rescaled.rescale(&factors, &next.relaxations());
            tissue = next;
        }
        let surface = |state: &TissueState| state.free_response().to_num::<f64>();
        let (mut expected, mut largest) = (TissueState::default(), 0.0f64);
        for part in &history {
            step(&mut expected, core::slice::from_ref(part), &tissue);
            largest = largest.max(surface(&expected).abs());
        }
        // Resolution of the states of a scale of 4 and of their sums.
        let resolution_k = 4.0 * 12.0 * Celsius::DELTA.to_num::<f64>();
        for ticks in [0, 1, 7, rest] {
            let idle = [(0.0, ticks)];
            step(&mut rescaled, &idle, &tissue);
            step(&mut expected, &idle, &tissue);
            let error = (surface(&rescaled) - surface(&expected)).abs();
            prop_assert!(error < 1e-6 * largest + resolution_k, "{error} of {largest}");
        }
    }

    /// The state between two windows, too, and of any bits.
    #[test]
    fn no_state_overflows(fluxes in prop::collection::vec(any::<i32>(), 1..40), weights in weights()) {
        let (mean, other) = (FingerBody::MEAN.tissue, fixed(weights).tissue());
        let mut state = TissueState::default();
        for pair in fluxes.chunks(2) {
            for (body, next, bits) in [(&mean, &other, pair[0]), (&other, &mean, pair[pair.len() - 1])] {
                for _ in 0..bits & 0x3ff {
                    state.step(Celsius::from_bits(bits), &body.relaxations());
                }
                let factors = TissueStateFactors::new(&body.relaxations(), &next.relaxations());
                state.rescale(&factors, &next.relaxations());
            }
        }
    }
}
