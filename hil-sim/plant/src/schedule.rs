//! Sub-steps after a contact event.
//!
//! Temperatures then move with the square root of time; steps must grow with the time that has passed. All lengths
//! are the plant's step halved a few times, so that each needs its elimination only once.

/// Halvings of the plant's step down to the first sub-step.
const HALVINGS: u32 = 7;
/// Sub-steps for each doubling of time are two to this power, in the first step and for as long as the time passed.
const PARTS: u32 = 1;
/// Lengths that occur.
pub const LENGTHS: usize = (HALVINGS + PARTS) as usize + 1;

/// Length of the sub-steps with an index, s: the step itself has the first.
#[must_use]
pub fn length_s(step_s: f64, index: usize) -> f64 {
    step_s / f64::from(1u32 << index)
}

/// Indices of the sub-steps of a step that begins `age` such steps after the event. Their lengths sum to the step.
pub fn sub_steps(age: u32) -> impl Iterator<Item = usize> {
    let (first, spans, parts) = match age {
        0 => (Some(HALVINGS), HALVINGS, PARTS),
        // As many as keep the ratio of step and time passed.
        _ => (None, 1, (PARTS + 1).saturating_sub(age.ilog2())),
    };
    first
        .map(|k| k as usize)
        .into_iter()
        .chain((0..spans).flat_map(move |span| {
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
            for index in sub_steps(age) {
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
        assert_eq!(sub_steps(u32::MAX).count(), 1);
    }
}
