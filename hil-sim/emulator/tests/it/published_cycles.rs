//! The estimate of cycles against figures that others measured on a Cortex-M4.
use crate::probe;

/// Assembler for the Cortex-M4 by E. Emanuelsson, in the crate p256-cm4. Its author measured on an nRF52840 with the
/// instruction cache on (README of P256-Cortex-M4): 327 and 906 thousand cycles.
#[test]
fn elliptic_curve_takes_the_cycles_that_its_author_measured() {
    let (_, log) = probe::run(70, 3_000_000);
    let [first, second, ours, theirs, equal, 0xd0e] = log[..] else { panic!("{log:x?}") };
    assert_eq!(equal, 1, "both parties have the same secret");
    for (name, cycles, published) in [
        ("key generation", first, 327e3),
        ("key generation", second, 327e3),
        ("shared secret", ours, 906e3),
        ("shared secret", theirs, 906e3),
    ] {
        let bias = 100.0 * (f64::from(cycles) / published - 1.0);
        println!("{name}: {cycles} cycles, {bias:+.1} % from {published}");
        assert!(bias.abs() < 4.0, "{name}: {bias:+.1} %");
    }
}
