//! Error of the kernel: a sample of the inputs that `--example verify` checks in full, and the proven bound.

use contact_model::fixed_point::kernel::{OCTAVES, PRACTICAL_OCTAVES};
use contact_model::fixed_point::{Fraction, MantissaExponent, Ticks, erfcx};
use contact_model::reference;
use documented_figures::{assert_figure, figure};
use proptest::prelude::*;
use std::f64::consts::PI;

use crate::verify::{INPUTS, REFERENCE_ERROR, Statistics, UNIT, exact, exhaustive, kernel, proof};

/// The sample is runs of 2^14 inputs: at both ends of every octave and spread over it.
#[test]
fn sampled_inputs_have_the_stated_error_and_increase_by_at_most_one_unit() {
    let mut all = Statistics::default();
    for octave in PRACTICAL_OCTAVES {
        const RUN: u64 = 1 << 14;
        let last = INPUTS / RUN - 1;
        let inner =
            (1..6u64).map(|i| (i * 0x2_f1ab + octave.unsigned_abs() as u64 * 0x51d7) % last);
        for run in inner.chain([0, last]) {
            all.merge(&exhaustive(octave, run * RUN..(run + 1) * RUN));
        }
    }
    println!("{all:?}");
    let fraction = all.correctly_rounded as f64 / all.inputs as f64;
    assert_figure("kernel.error_sampled", all.worst + REFERENCE_ERROR);
    assert_figure("kernel.correctly_rounded_sampled", 100.0 * fraction);
    assert_figure("kernel.largest_rise", all.largest_increase.into());
}

#[test]
fn proven_bound_of_every_octave_is_within_the_stated_error() {
    let mut worst = [0.0f64; 2];
    for octave in OCTAVES.start + 1..OCTAVES.end - 1 {
        let practical = PRACTICAL_OCTAVES.contains(&octave);
        let bound = proof::bound(octave);
        worst[usize::from(practical)] = worst[usize::from(practical)].max(bound);
    }
    assert_figure("kernel.error_proven_anywhere", worst[0]);
    assert_figure("kernel.error_proven", worst[1]);
}

/// The proof reads the table; this test calls the function.
#[test]
fn kernel_stays_within_the_proven_bound() {
    for octave in OCTAVES.start + 1..OCTAVES.end - 1 {
        let bound = proof::bound(octave);
        for i in 0..2000u32 {
            let bits = i.wrapping_mul(2_147_483) ^ i << 20;
            let error = (f64::from(kernel(octave, bits)) - exact(octave, f64::from(bits))).abs();
            assert!(error <= bound, "2^{octave}, {bits:#x}: {error}");
        }
    }
}

#[test]
fn kernel_saturates_outside_the_octaves_of_its_table() {
    let (start, end) = (OCTAVES.start as i16, OCTAVES.end as i16);
    for fraction in [0, 1, u32::MAX / 3, u32::MAX] {
        for exponent in [i16::MIN, -1000, start - 1, start] {
            assert_eq!(erfcx(Ticks::ONE, MantissaExponent::new(exponent, fraction)), Fraction::MAX);
        }
        for exponent in [end - 1, end, 1000, i16::MAX] {
            for elapsed in [Ticks::ONE, Ticks::MAX] {
                assert_eq!(
                    erfcx(elapsed, MantissaExponent::new(exponent, fraction)),
                    Fraction::ZERO
                );
            }
        }
    }
}

/// Cutting the product changes `u` by up to a fraction of 2^-33.
#[test]
fn bits_cut_off_the_product_add_half_of_the_largest_slope() {
    let slope = |z: f64| 0.5 * z * (2.0 / PI.sqrt() - 2.0 * z * reference::erfcx(z));
    let largest = (1..10_000).map(|i| slope(1e-3 * f64::from(i)));
    assert_figure("kernel.error_of_the_cut", 0.5 * largest.fold(0.0, f64::max));
}

proptest! {
    #[test]
    fn kernel_has_the_stated_error_for_any_time_and_rate(
        elapsed in 1..=Ticks::MAX.get(),
        exponent in -63i16..32,
        fraction: u32,
    ) {
        let rate_per_tick = MantissaExponent::new(exponent, fraction);
        let e = erfcx(Ticks::new(elapsed).expect("in range"), rate_per_tick);
        let expected = reference::erfcx((f64::from(elapsed) * rate_per_tick.to_f64()).sqrt()) / UNIT;
        let error = (f64::from(e.to_bits()) - expected).abs();
        let [proven, cut] = ["kernel.error_proven_anywhere", "kernel.error_of_the_cut"];
        let allowed = figure(proven).value() + figure(cut).value();
        prop_assert!(error <= allowed, "{error} units");
    }
}
