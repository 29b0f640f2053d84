//! The force ramps by which a contact law is measured.

/// Least and largest force, N.
const ENDS_N: (f64, f64) = (0.1, 2.0);
/// Time at the least force before the first ramp, s, so that the landing is over.
const LANDED_S: f64 = 1.0;
/// Durations of the ramps, s: up, down, up, down.
const DURATIONS_S: [f64; RAMPS] = [4.0, 4.0, 6.0, 6.0];

/// Number of ramps.
pub const RAMPS: usize = 4;
/// Forces at which the resistance is reported, N.
pub const FORCES_N: [f64; 3] = [0.1, 0.5, 2.0];
/// Time from landing to the end of the last ramp, s.
pub const TOTAL_S: f64 = {
    let [a, b, c, d] = DURATIONS_S;
    LANDED_S + a + b + c + d
};

/// Force to press with, N, `since_s` seconds after landing: linear over time in its logarithm; `None` after the last ramp.
pub fn force_n(since_s: f64) -> Option<f64> {
    let ramp = ramp_at(since_s)?;
    let begun_s = LANDED_S + DURATIONS_S[..ramp].iter().sum::<f64>();
    let part = ((since_s - begun_s) / DURATIONS_S[ramp]).max(0.0);
    let up = if ramp % 2 == 0 { part } else { 1.0 - part };
    let (least, largest) = ENDS_N;
    Some(least * (largest / least).powf(up))
}

/// The ramp at this time after landing, s, from 0; the first one includes the time before it. `None` after the last one.
pub fn ramp_at(since_s: f64) -> Option<usize> {
    let mut end_s = LANDED_S;
    DURATIONS_S.iter().position(|ramp_s| {
        end_s += ramp_s;
        since_s <= end_s
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_go_up_and_down_twice_between_a_tenth_and_two_newtons() {
        let at = |since_s| force_n(since_s).expect("a ramp");
        for (since_s, force) in [
            (0.0, 0.1),
            (1.0, 0.1),
            (3.0, 0.2_f64.sqrt()),
            (5.0, 2.0),
            (9.0, 0.1),
            (15.0, 2.0),
            (18.0, 0.2_f64.sqrt()),
            (21.0, 0.1),
        ] {
            assert!((at(since_s) / force - 1.0).abs() < 1e-12, "{since_s} s");
        }
        assert_eq!((force_n(21.01), TOTAL_S), (None, 21.0));
        assert_eq!([0.0, 4.9, 5.1, 9.1, 20.9].map(ramp_at), [0, 0, 1, 2, 3].map(Some));
    }
}
