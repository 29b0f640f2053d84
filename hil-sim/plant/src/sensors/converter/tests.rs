//! Converter against the bound of its non-linearity and the specified noise statistics.

use rand::SeedableRng;

use super::*;

const QUIET: ConverterParams =
    ConverterParams { inl_counts: 0.0, noise_counts: 0.0, ..ConverterParams::NOMINAL };

fn converter(params: ConverterParams, seed: u64) -> Converter {
    Converter::new(params, Xoshiro256PlusPlus::seed_from_u64(seed))
}

#[test]
fn largest_non_linearity_is_between_half_the_bound_and_the_bound() {
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    let mut positive = 0;
    for seed in 0..1000 {
        let profile = converter(ConverterParams::NOMINAL, seed).profile;
        let errors = (0..4096).map(|code| profile.at(f64::from(code)));
        let peak = errors.fold(0.0f64, |peak, e| if e.abs() > peak.abs() { e } else { peak });
        let (first, last) = (profile.at(0.0), profile.at(4095.0));
        assert!(
            first.abs() < 1e-12 && last.abs() < 2e-2,
            "seed {seed}: {first} and {last} at the ends"
        );
        positive += u32::from(peak > 0.0);
        least = least.min(peak.abs());
        most = most.max(peak.abs());
    }
    assert!(
        (0.75..0.76).contains(&least) && (1.49..=1.5 + 1e-12).contains(&most),
        "{least} to {most}"
    );
    assert!((400..600).contains(&positive), "{positive} of 1000 bend upwards");
}

#[test]
fn non_linearity_steps_only_at_the_transitions_of_the_upper_bits() {
    let mut largest = [0.0f64; 4096];
    for seed in 0..200 {
        let profile = converter(ConverterParams::NOMINAL, seed).profile;
        for code in 1..4096u32 {
            let step = profile.at(f64::from(code)) - profile.at(f64::from(code - 1));
            largest[code as usize] = largest[code as usize].max(step.abs());
        }
    }
    for (code, step) in largest.iter().enumerate().skip(1) {
        assert_eq!(code % 128 == 0, *step > 0.02, "a step of {step} at code {code}");
    }
    // The step of the largest capacitor is the largest.
    let others = (1..32).filter(|k| *k != 16).map(|k| largest[128 * k]);
    assert!(largest[2048] > others.fold(0.0, f64::max));
}

#[test]
fn code_is_the_level_plus_its_non_linearity() {
    let mut converter =
        converter(ConverterParams { noise_counts: 0.0, ..ConverterParams::NOMINAL }, 3);
    for level in 0..4096 {
        let level = f64::from(level) + 0.3;
        let expected = level.min(4095.0) + converter.profile.at(level.min(4095.0));
        let code = f64::from(converter.convert(level));
        assert!((code - expected.clamp(0.0, 4095.0)).abs() <= 0.5, "{code} for {expected}");
    }
}

#[test]
fn offset_and_gain_apply_before_quantisation() {
    let params = ConverterParams { offset_counts: 2.0, gain_error: 1e-3, ..QUIET };
    let mut converter = converter(params, 1);
    for (ideal, code) in [(0.0, 2), (1000.0, 1003), (3000.0, 3005), (4095.0, 4095), (-9.0, 0)] {
        assert_eq!(converter.convert(converter.with_offset_and_gain(ideal)), code);
    }
}

#[test]
fn noise_is_white_and_unbiased_with_the_specified_deviation() {
    let mut converter = converter(ConverterParams { noise_counts: 0.7, ..QUIET }, 7);
    let n = 400_000;
    let level = 2101.37;
    let draws: Vec<f64> = (0..n).map(|_| f64::from(converter.convert(level)) - level).collect();
    let mean_of = |f: &dyn Fn(usize) -> f64| (0..n - 1).map(f).sum::<f64>() / (n - 1) as f64;
    let mean = mean_of(&|k| draws[k]);
    let variance = mean_of(&|k| (draws[k] - mean).powi(2));
    let beside = mean_of(&|k| (draws[k] - mean) * (draws[k + 1] - mean)) / variance;
    let beyond = mean_of(&|k| f64::from(draws[k].abs() > 0.7 * 3.0 + 0.5));
    // Quantisation adds 1/12; five standard errors.
    let expected = 0.7f64.powi(2) + 1.0 / 12.0;
    let root_n = f64::from(n as u32).sqrt();
    assert!(mean.abs() < 5.0 * expected.sqrt() / root_n, "bias {mean}");
    assert!((variance / expected - 1.0).abs() < 5.0 * 2f64.sqrt() / root_n, "variance {variance}");
    assert!(beside.abs() < 5.0 / root_n, "neighbours correlate by {beside}");
    // Gaussian tails: 1e-4 to 2.7e-3 of the draws are beyond three standard deviations plus half a code.
    assert!((1e-4..2.7e-3).contains(&beyond), "{beyond} beyond three deviations");
}
