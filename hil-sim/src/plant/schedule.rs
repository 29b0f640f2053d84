//! Sub-steps after a contact event.
//!
//! Temperatures then move with the square root of time; steps must grow with the time that has passed.

/// Halvings of the plant's step down to the first sub-step.
const HALVINGS: i32 = 6;
/// Sub-steps for each doubling of time in the first step, and for as long as the time passed.
const PARTS: u32 = 2;

/// The sub-steps of a plant step of `step_s` that begins `age` such steps after the event, s. They sum to the step.
pub fn sub_steps_s(step_s: f64, age: u32) -> impl Iterator<Item = f64> {
    let (first, doublings, parts) = match age {
        0 => (Some(step_s * 0.5f64.powi(HALVINGS)), HALVINGS, PARTS),
        _ => (None, 1, (2 * PARTS).div_ceil(age)),
    };
    first.into_iter().chain((0..doublings).flat_map(move |k| {
        let span_s = step_s * if age == 0 { 0.5f64.powi(HALVINGS - k) } else { 1.0 };
        (0..parts).map(move |_| span_s / f64::from(parts))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sub_steps_fill_the_step_and_grow_with_time() {
        let mut passed = 0.0;
        for age in 0..10 {
            let mut sum = 0.0;
            for h in sub_steps_s(1.0, age) {
                assert!(
                    passed == 0.0 || h <= passed / 2.0 + 1e-12 || age > 3,
                    "{h} after {passed}"
                );
                passed += h;
                sum += h;
            }
            assert_eq!(sum, 1.0, "age {age}");
        }
        assert_eq!(sub_steps_s(1.0, u32::MAX).count(), 1);
    }
}
