//! Sub-steps after an abrupt change of contact.
//!
//! Temperatures then change with the square root of time, so the steps grow with the elapsed time. Each length is the
//! plant's step halved a whole number of times: the matrix is eliminated only once for each of the few lengths.

/// Halvings of the plant's step down to the first sub-step.
const HALVINGS: u32 = 7;
/// Binary logarithm of the number of sub-steps in each doubling of the elapsed time.
const PARTS: u32 = 1;
/// Number of different lengths.
pub const LENGTHS: usize = (HALVINGS + PARTS) as usize + 1;

/// Length of the sub-steps with an index, s; index 0 is the whole step.
pub fn length_s(step_s: f64, index: usize) -> f64 {
    step_s / f64::from(1u32 << index)
}

/// Indices of the sub-steps of the step that begins `age` steps after the change. Their lengths add up to the step.
pub fn of_step(age: u32) -> impl Iterator<Item = usize> {
    let (first, spans, parts) = match age {
        0 => (Some(HALVINGS), HALVINGS, PARTS),
        // Keeps the ratio of sub-step to elapsed time until whole steps are short enough.
        _ => (None, 1, (PARTS + 1).saturating_sub(age.ilog2())),
    };
    first.map(|k| k as usize).into_iter().chain((0..spans).flat_map(move |span| {
        let halved = if age == 0 { HALVINGS - span } else { 0 };
        (0..1u32 << parts).map(move |_| (halved + parts) as usize)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sub_steps_fill_the_step_and_grow_with_time() {
        let mut passed = 0.0;
        for age in 0..20 {
            let mut sum = 0.0;
            for index in of_step(age) {
                assert!(index < LENGTHS);
                let h = length_s(1.0, index);
                assert!(
                    passed == 0.0 || h <= passed / 2.0 + 1e-12 || age > 3,
                    "{h} after {passed}"
                );
                passed += h;
                sum += h;
            }
            assert_eq!(sum, 1.0, "age {age}");
        }
        assert_eq!(of_step(u32::MAX).count(), 1);
    }
}
