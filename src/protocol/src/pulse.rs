//! The course of a pulse.

use contact_model::fixed_point::Celsius;
use thermal_device::stimulus::{Course, CourseError, CoursePoint, TemperatureKind};
use thermal_wire::Number;
use thermal_wire::quantity::{Rate, Seconds, Temperature};

/// A pulse: from base to target, there until the hold ends, and back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pulse {
    /// First and last temperature.
    pub base_c: Number<Temperature>,
    /// Temperature that is held.
    pub target_c: Number<Temperature>,
    /// Rate to it.
    pub rise_k_s: Number<Rate>,
    /// How long it is held.
    pub hold_s: Number<Seconds>,
    /// Rate back.
    pub return_k_s: Number<Rate>,
}

impl Pulse {
    /// Replaces a course by that of the pulse.
    ///
    /// # Errors
    /// The course is too long or too hot for too long.
    pub fn replace_course(&self, course: &mut Course) -> Result<(), CourseError> {
        course.clear(TemperatureKind::Absolute);
        let (base, target) = (self.base_c.celsius(), self.target_c.celsius());
        let mut time_ms = 0u32;
        for (temperature, duration_ms) in [
            (base, 0),
            (target, duration_ms(base, target, self.rise_k_s.celsius())),
            (target, self.hold_s.milliseconds()),
            (base, duration_ms(base, target, self.return_k_s.celsius())),
        ] {
            time_ms = time_ms.saturating_add(duration_ms);
            let point = CoursePoint { time_ms, temperature };
            // Without a hold the third point is the second one.
            if course.points().last() != Some(&point) {
                course.push(point)?;
            }
        }
        course.check_whole()
    }
}

/// Duration of a ramp, ms, rounded up, at least 1.
#[inline(never)]
fn duration_ms(from: Celsius, to: Celsius, rate_k_s: Celsius) -> u32 {
    let way = u64::from(from.abs_diff(to).to_bits()) * 1000;
    way.div_ceil(u64::from(rate_k_s.to_bits().unsigned_abs().max(1))).max(1) as u32
}
