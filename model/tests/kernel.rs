//! The kernel against the exact function: a sample of what `--example verify` checks in full, and the proof.

mod verify;

use contact_model::fixed_point::kernel::OCTAVES;
use contact_model::fixed_point::{Fraction, Rate, Ticks, erfcx};
use contact_model::reference;
use proptest::prelude::*;
use verify::{INPUTS, LIVED_IN, TRUTH_ERROR, Tally, exact, exhaustive, kernel, proof};

/// Stated: where scenes live, elsewhere, and what the cut of the product adds.
const LIVED_IN_UNITS: f64 = 0.51;
const ELSEWHERE_UNITS: f64 = 0.54;
const CUT_UNITS: f64 = 0.07;
/// Least share of results that are the nearest of all.
const CORRECTLY_ROUNDED: f64 = 0.998;

const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// Stretches of 2^14 inputs: at both ends of every octave and at places spread over it.
#[test]
fn sampled_inputs_stay_within_the_stated_error_and_rise_by_one_unit_at_most() {
    let mut all = Tally::default();
    for octave in LIVED_IN {
        const STRETCH: u64 = 1 << 14;
        let last = INPUTS / STRETCH - 1;
        let inner =
            (1..6u64).map(|i| (i * 0x2_f1ab + octave.unsigned_abs() as u64 * 0x51d7) % last);
        for stretch in inner.chain([0, last]) {
            all.merge(&exhaustive(
                octave,
                stretch * STRETCH..(stretch + 1) * STRETCH,
            ));
        }
    }
    println!("{all:?}");
    assert!(all.worst + TRUTH_ERROR <= LIVED_IN_UNITS, "{all:?}");
    assert!(all.largest_rise <= 1, "{all:?}");
    let share = all.correctly_rounded as f64 / all.inputs as f64;
    assert!(share > CORRECTLY_ROUNDED, "{share}");
}

#[test]
fn every_octave_is_proven_within_its_stated_error() {
    let mut worst = [0.0f64; 2];
    for octave in OCTAVES.start + 1..OCTAVES.end - 1 {
        let lived_in = LIVED_IN.contains(&octave);
        let bound = proof::bound(octave);
        worst[usize::from(lived_in)] = worst[usize::from(lived_in)].max(bound);
        assert!(bound <= ELSEWHERE_UNITS, "2^{octave}: {bound}");
    }
    println!(
        "proven: {:.4} where scenes live, {:.4} elsewhere",
        worst[1], worst[0]
    );
}

/// The proof holds for the function as it is called, not only for the table that it reads.
#[test]
fn the_proven_bound_covers_what_the_kernel_returns() {
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
fn kernel_saturates_outside_of_its_octaves() {
    let (start, end) = (OCTAVES.start as i16, OCTAVES.end as i16);
    for fraction in [0, 1, u32::MAX / 3, u32::MAX] {
        for exponent in [i16::MIN, -1000, start - 1, start] {
            assert_eq!(
                erfcx(Ticks::ONE, Rate::new(exponent, fraction)),
                Fraction::MAX
            );
        }
        for exponent in [end - 1, end, 1000, i16::MAX] {
            for elapsed in [Ticks::ONE, Ticks::MAX] {
                assert_eq!(
                    erfcx(elapsed, Rate::new(exponent, fraction)),
                    Fraction::ZERO
                );
            }
        }
    }
}

proptest! {
    #[test]
    fn kernel_holds_for_any_elapsed_time_and_rate(
        elapsed in 1..=Ticks::MAX.get(),
        exponent in -63i16..32,
        fraction: u32,
    ) {
        let per_tick = Rate::new(exponent, fraction);
        let e = erfcx(Ticks::new(elapsed).expect("in range"), per_tick);
        let truth = reference::erfcx((f64::from(elapsed) * per_tick.to_f64()).sqrt()) / UNIT;
        let error = (f64::from(e.to_bits()) - truth).abs();
        prop_assert!(error <= ELSEWHERE_UNITS + CUT_UNITS, "{error} units");
    }
}
