//! Against exact solutions of small linear chains.

use super::*;
use std::f64::consts::PI;

const NODES: usize = 12;
const CAPACITY_J_K: f64 = 0.7;
const CONDUCTANCE_W_K: f64 = 3.0;

/// An insulated chain of equal nodes holding one of its modes, `cos(pi m (i + 1/2) / n)`, and the mode's rate, 1/s.
fn mode(m: f64) -> (Chain, f64) {
    let shape = |i: usize| (PI * m * (i as f64 + 0.5) / NODES as f64).cos();
    let links = [Link::symmetric(CONDUCTANCE_W_K); NODES - 1];
    let chain = Chain::new(vec![CAPACITY_J_K; NODES], &links, (0..NODES).map(shape).collect());
    let half_angle = PI * m / (2 * NODES) as f64;
    (
        chain,
        4.0 * CONDUCTANCE_W_K / CAPACITY_J_K * half_angle.sin().powi(2),
    )
}

#[test]
fn converges_at_second_order() {
    // Over one time constant: error of the mode's amplitude, seen at the first node.
    let error = |steps: u32| {
        let (mut chain, rate) = mode(3.0);
        let start = chain.temperature_c(0);
        for _ in 0..steps {
            chain.step(1.0 / rate / f64::from(steps));
        }
        (chain.temperature_c(0) / start - (-1.0f64).exp()).abs()
    };
    for steps in [10, 20, 40, 80] {
        let order = (error(steps) / error(2 * steps)).log2();
        assert!((order - 2.0).abs() < 0.1, "order {order} from {steps} steps");
    }
}

#[test]
fn endless_step_ends_in_equilibrium() {
    let (mut chain, _) = mode(1.0);
    chain.step(1e9);
    for i in 0..NODES {
        assert!(
            chain.temperature_c(i).abs() < 1e-6,
            "node {i} at {}",
            chain.temperature_c(i)
        );
    }
}

#[test]
fn node_with_source_and_feedback_follows_its_exponential() {
    // C dT/dt = S - F T, from 20 deg C.
    let (c, s, f) = (2.0, 5.0, 0.4);
    let mut chain = Chain::new(vec![c, 1.0], &[Link::OPEN], vec![20.0, -3.0]);
    chain.set_source(0, s, -f);
    for _ in 0..1000 {
        chain.step(5e-3);
    }
    let exact = s / f + (20.0 - s / f) * (-f / c * 5.0f64).exp();
    assert!((chain.temperature_c(0) - exact).abs() < 1e-6);
    assert_eq!(chain.temperature_c(1), -3.0, "an open link exchanges nothing");
}

#[test]
fn one_sided_units_share_one_heat() {
    // A body of 3 J/(m2 K) over 0.2 m2 against one of 2 J/K, 5 W/(m2 K) between: they meet at the weighted mean.
    let area = 0.2;
    let link = Link {
        ahead: 5.0,
        behind: 5.0 * area,
    };
    let mut chain = Chain::new(vec![3.0, 2.0], &[link], vec![40.0, 10.0]);
    for _ in 0..200 {
        chain.step(0.1);
    }
    let mean = (3.0 * area * 40.0 + 2.0 * 10.0) / (3.0 * area + 2.0);
    assert!((chain.temperature_c(0) - mean).abs() < 1e-9);
    assert!((chain.temperature_c(1) - mean).abs() < 1e-9);
}

/// Every balance must close with the step's mean temperatures, also right after a link, a source or the step's
/// length changed: rows that are wrongly taken as unchanged would open it.
#[test]
fn every_node_balances_over_every_step() {
    let (mut chain, _) = mode(2.0);
    let mut source = [(0.0, 0.0); NODES];
    let mut step_s = 0.02;
    for k in 0..400usize {
        let node = 7 * k % NODES;
        match k % 4 {
            0 => {
                source[node] = (k as f64 * 0.01 - 1.0, -0.05 * (k % 9) as f64);
                chain.set_source(node, source[node].0, source[node].1);
            }
            1 => chain.set_link(
                node % (NODES - 1),
                Link {
                    ahead: 0.1 * (k % 11) as f64,
                    behind: 2.0,
                },
            ),
            2 => step_s = 0.01 * (1 + k % 3) as f64,
            _ => {}
        }
        let before: Vec<f64> = (0..NODES).map(|i| chain.temperature_c(i)).collect();
        chain.step(step_s);
        for i in 0..NODES {
            let mean = |i: usize| chain.mean_c(i);
            let mut power_w = source[i].0 + source[i].1 * mean(i);
            if i + 1 < NODES {
                power_w += chain.link(i).ahead * (mean(i + 1) - mean(i));
            }
            if i > 0 {
                power_w += chain.link(i - 1).behind * (mean(i - 1) - mean(i));
            }
            let gain_j = CAPACITY_J_K * (chain.temperature_c(i) - before[i]);
            assert!((gain_j - step_s * power_w).abs() < 1e-13, "step {k}, node {i}");
        }
    }
}
