//! Run times on this host, measured in turn.
use std::time::Instant;

/// Run time of one call.
#[derive(Clone, Copy, Debug)]
pub struct Time {
    /// Median over the rounds, ns.
    pub ns: f64,
    /// Minimum over the rounds, ns.
    pub least_ns: f64,
    /// Median over the rounds of the ratio to the time of the candidate `base` in the same round.
    pub ratio: f64,
}

/// Runs every candidate once a round, each making `calls` calls, and takes medians over `rounds`, so that a temporary
/// slowdown of the host affects all candidates alike.
pub fn side_by_side(
    candidates: &mut [Box<dyn FnMut() + '_>],
    base: usize,
    calls: usize,
    rounds: usize,
) -> Vec<Time> {
    let mut ns = vec![Vec::with_capacity(rounds); candidates.len()];
    for _ in 0..rounds {
        for (candidate, ns) in candidates.iter_mut().zip(&mut ns) {
            let start = Instant::now();
            candidate();
            ns.push(start.elapsed().as_secs_f64() * 1e9 / calls as f64);
        }
    }
    ns.iter()
        .map(|own| Time {
            ns: median(own.clone()),
            least_ns: own.iter().copied().fold(f64::NAN, f64::min),
            ratio: median(own.iter().zip(&ns[base]).map(|(own, base)| own / base).collect()),
        })
        .collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
