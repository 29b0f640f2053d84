//! What is recorded while a finger follows the ramps.

use contact_model::material::Surface;

/// Time between two samples, s.
pub const STEP_S: f64 = 0.01;
/// Largest deviation of a time between two samples from [`STEP_S`], s.
const STEP_TOLERANCE_S: f64 = 1e-6;
/// Least time of a recording, s: two ramps.
const SHORTEST_S: f64 = 9.0;

/// One sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time since landing, s.
    pub since_s: f64,
    /// Heat flux out of the skin, W/m².
    pub flux_w_m2: f64,
    /// The tile's face below the heat-flux sensor, °C, as the device estimates it.
    pub surface_c: f64,
    /// Force, N.
    pub force_n: f64,
}

/// A recording of one contact in which the force followed the ramps.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Skin before contact, °C.
    pub skin_c: f64,
    /// Room, °C.
    pub room_c: f64,
    /// The display's surface.
    pub display: Surface,
    /// Thermal resistance of the heat-flux sensor between the display's face and the skin, m² K/W.
    pub layer_m2k_w: f64,
    /// Samples from landing on, one each 10 ms.
    pub samples: Vec<Sample>,
}

/// Why a recording cannot be fitted.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RecordingError {
    /// It is too short.
    #[error("the recording has {0:.2} s of contact; at least {SHORTEST_S} s are needed")]
    Short(f64),
    /// Samples are missing.
    #[error(
        "the sample {after_s:.3} s after landing follows the one before by {step_s:.3} s; allowed is {STEP_S} s"
    )]
    Gap {
        /// Time of the second sample since landing, s.
        after_s: f64,
        /// Time between the two, s.
        step_s: f64,
    },
    /// A value is not allowed.
    #[error("{what} is {value} at {since_s:.3} s after landing; allowed is {allowed}")]
    Value {
        /// Name and unit.
        what: &'static str,
        /// The value.
        value: f64,
        /// Time since landing, s.
        since_s: f64,
        /// Range in words.
        allowed: &'static str,
    },
}

impl Recording {
    /// Checks that the recording can be fitted.
    ///
    /// # Errors
    /// It is too short, samples are missing, or a value is not finite or out of its range.
    pub fn check(&self) -> Result<(), RecordingError> {
        let is_plausible_c = |value: f64| (-40.0..=125.0).contains(&value);
        let mut before_s: Option<f64> = None;
        for sample in &self.samples {
            let &Sample { since_s, flux_w_m2, surface_c, force_n } = sample;
            let value =
                |what, value, allowed| Err(RecordingError::Value { what, value, since_s, allowed });
            if let Some(step_s) = before_s.map(|before_s| since_s - before_s)
                && !(STEP_S - STEP_TOLERANCE_S..=STEP_S + STEP_TOLERANCE_S).contains(&step_s)
            {
                return Err(RecordingError::Gap { after_s: since_s, step_s });
            }
            before_s = Some(since_s);
            if !(-1e5..=1e5).contains(&flux_w_m2) {
                return value("the flux, W/m2,", flux_w_m2, "-1e5 to 1e5");
            }
            if !is_plausible_c(surface_c) {
                return value("the display's surface, C,", surface_c, "-40 to 125");
            }
            if !(0.003..=20.0).contains(&force_n) {
                return value("the force, N,", force_n, "0.003 to 20, which is a contact");
            }
        }
        for (what, value) in [("the skin, C,", self.skin_c), ("the room, C,", self.room_c)] {
            if !is_plausible_c(value) {
                return Err(RecordingError::Value {
                    what,
                    value,
                    since_s: 0.0,
                    allowed: "-40 to 125",
                });
            }
        }
        let length_s = before_s.unwrap_or(0.0);
        if length_s < SHORTEST_S {
            return Err(RecordingError::Short(length_s));
        }
        Ok(())
    }
}
