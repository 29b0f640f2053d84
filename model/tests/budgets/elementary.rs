//! Errors of the elementary functions.

use contact_model::fixed_point::kernel::OCTAVES;
use contact_model::fixed_point::{Log2, MantissaExponent, Ticks, erfcx, exp2, log2};
use contact_model::reference;

use super::sweep::{UNIT, log_between, points, relative, worst};
use crate::golden::{number, rows};

/// Error of the kernel in units of 2^-32; exact values above the largest fraction count as that.
fn kernel_units(elapsed: u32, rate_per_tick: MantissaExponent, truth: f64) -> f64 {
    let e = f64::from(erfcx(Ticks::new(elapsed).expect("in range"), rate_per_tick).to_bits());
    e - (truth / UNIT).min(f64::from(u32::MAX))
}

/// Every octave of the table with 4096 mantissas each; times and rates whose product lies in one.
pub fn kernel() -> f64 {
    let inner = OCTAVES.start + 1..OCTAVES.end - 1;
    let octaves = inner.clone().flat_map(mantissas);
    let range = f64::from(inner.start).exp2()..f64::from(inner.end).exp2();
    worst(
        octaves.chain(times_and_rates()).filter(|(u, _)| range.contains(u)).map(|(_, error)| error),
    )
}

/// The same, octaves beyond both ends, and golden values, whose squared argument is rounded.
pub fn kernel_anywhere() -> f64 {
    let outer = (OCTAVES.start - 8..OCTAVES.start + 1).chain(OCTAVES.end - 1..OCTAVES.end + 8);
    let golden = rows("erfcx").into_iter().filter_map(|row| {
        let z = number(&row, "x");
        MantissaExponent::from_f64(z * z)
            .map(|u| (z * z, kernel_units(1, u, number(&row, "erfcx"))))
    });
    let all = outer.flat_map(mantissas).chain(times_and_rates()).chain(golden);
    worst(all.map(|(_, error)| error))
}

/// `u` and error for the mantissas of one octave.
fn mantissas(octave: i32) -> impl Iterator<Item = (f64, f64)> {
    (0..4096u32).map(move |i| {
        let fraction = i << 20 | i.wrapping_mul(2_654_435_761) >> 12;
        let rate_per_tick = MantissaExponent::new(octave as i16, fraction);
        let u = rate_per_tick.to_f64();
        (u, kernel_units(1, rate_per_tick, reference::erfcx(u.sqrt())))
    })
}

/// `u` and error for `n` ticks at rates from 1e-25 to 1e20.
fn times_and_rates() -> impl Iterator<Item = (f64, f64)> {
    points::<2>(20_000).map(|[elapsed, rate]| {
        let elapsed = log_between(elapsed, 1.0, f64::from(Ticks::MAX.get())) as u32;
        let rate_per_tick =
            MantissaExponent::from_f64(log_between(rate, 1e-25, 1e20)).expect("normal");
        let u = f64::from(elapsed) * rate_per_tick.to_f64();
        (u, kernel_units(elapsed, rate_per_tick, reference::erfcx(u.sqrt())))
    })
}

/// Numbers of all magnitudes, and both ends of each octave.
pub fn log2_error() -> f64 {
    let integers =
        (0..1u32 << 18).map(|i| ((i.wrapping_mul(2_654_435_761) | 1) >> (i % 32)).max(1));
    let ends = (0..32).flat_map(|bit| [1 << bit, u32::MAX >> bit]);
    worst((integers.chain(ends)).map(|x| (log2(x).to_num::<f64>() - f64::from(x).log2()) / UNIT))
}

pub fn exp2_error() -> f64 {
    worst(spread().map(|f| f64::from(exp2(f)) - ((f64::from(f) * UNIT).exp2() - 1.0) / UNIT))
}

/// 32-bit numbers, evenly distributed, and both ends of each octave.
fn spread() -> impl Iterator<Item = u32> {
    let even = (0..1u32 << 18).map(|i| i << 14 | i >> 4);
    even.chain((0..32).flat_map(|bit| [1 << bit, u32::MAX >> bit]))
}

pub fn rate_from_log2() -> f64 {
    worst(points::<1>(100_000).map(|[part]| {
        let log2 = Log2::from_num(2000.0 * part - 1000.0);
        // Integer and fraction separately, because exp2 of a large number is less exact.
        let whole = log2.floor();
        let fraction = (log2 - whole).to_num::<f64>().exp2();
        let scale = f64::from(-whole.to_num::<i32>()).exp2();
        relative(MantissaExponent::from_log2(log2).to_f64() * scale, fraction) / UNIT
    }))
}

pub fn rate_times() -> f64 {
    worst(points::<2>(100_000).map(|[a, b]| {
        let [a, b] = [a, b].map(|part| {
            MantissaExponent::from_f64((1000.0 * part - 500.0).exp2()).expect("normal")
        });
        relative(a.times(b).to_f64(), a.to_f64() * b.to_f64()) / UNIT
    }))
}
