//! Self-test of the heat-flux sensor.

use contact_model::fixed_point::{Celsius, saturating_product};
use fixed::types::U16F16;
use thermal_learner::Flux;
use thermal_settings::vocabulary;

use super::FingerLearning;
use super::code_faults::CodeFault;

/// Largest flux without a finger, W/m², beside that of the air: an error of the zero ten times that of the design.
const ZERO_ERROR_MAX: Flux = Flux::lit("50");
/// Largest film coefficient of the air on the display, W/(m² K): twice the typical one.
const AIR_FILM_MAX: U16F16 = U16F16::lit("20");

vocabulary! {
    /// What a self-test has shown of the heat-flux sensor.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum FluxSensorTest: "flux" {
        /// Its code changes, is at no rail and, without a finger, near its zero.
        Passed = "ok",
        /// Its converter has not converted.
        NoCode = "no-code",
        /// Its code is at a rail or does not change.
        Range = "sensor-range",
        /// Without a finger it reads more than air takes or gives.
        Zero = "zero",
        /// Its code changes and is at no rail; under a finger nothing shows its zero.
        NotAtRest = "touched",
    }
}

impl FingerLearning {
    /// Tests the codes of the last window, on a display that is so much warmer than the room, K.
    #[cold]
    #[inline(never)]
    pub fn test_sensor(&self, above_room: Celsius) -> FluxSensorTest {
        match self.faults.present() {
            Some(CodeFault::Missing) => FluxSensorTest::NoCode,
            Some(CodeFault::Range) => FluxSensorTest::Range,
            None if self.counting_windows > 0 => FluxSensorTest::NotAtRest,
            None => {
                let flux = self.parameters.mean_flux(self.faults.last_sum());
                let of_air: Flux = saturating_product(above_room.saturating_abs(), AIR_FILM_MAX);
                if flux.saturating_abs() > of_air.saturating_add(ZERO_ERROR_MAX) {
                    FluxSensorTest::Zero
                } else {
                    FluxSensorTest::Passed
                }
            }
        }
    }
}
