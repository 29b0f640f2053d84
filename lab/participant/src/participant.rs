//! A participant: skin, hand and observer.

use serde::{Deserialize, Serialize};
use thermal_session::{Procedure, Session, Station};

use crate::random::Stream;
use crate::{HandParams, ObserverParams};

/// Skin temperatures of participants before contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SkinParams {
    /// Mean over participants, °C; `None` for the temperature of the session's rest.
    pub mean_c: Option<f64>,
    /// Standard deviation over participants, K.
    pub sd_k: f64,
    /// Largest distance of a participant from the mean, K.
    pub within_k: f64,
    /// Rise over a session, K.
    pub drift_k: f64,
}

impl SkinParams {
    /// Section 3.2: 30 to 35.5 °C with a mean of 33 °C, of which this is a normal distribution; section 4.4: a rise of 0.4 K
    /// over the session.
    pub const TYPICAL: Self = Self { mean_c: None, sd_k: 1.4, within_k: 3.0, drift_k: 0.4 };

    /// Everybody has the temperature of the session's rest.
    pub const EQUAL: Self = Self { mean_c: None, sd_k: 0.0, within_k: 0.0, drift_k: 0.0 };
}

/// Skin at rest in a session without a rule for it, °C (section 3.2).
const REST_C: f64 = 33.0;
/// Part of the gate's tolerance within which the skin is where a device measures it: the pad has brought it there.
const GATE_SHARE: f64 = 0.5;

/// A simulated participant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Participant {
    /// Skin before contact at the start of the session, minus `rest_c`, K.
    pub skin_off_k: f64,
    /// Skin temperature that the session's `[rest]` demands, °C; 33 °C without `[rest]`.
    pub rest_c: f64,
    /// Rise of the skin over the session, K.
    pub drift_k: f64,
    /// Limit on how far the skin may be from `rest_c`, K: half of the gate's tolerance; infinite without a measured gate.
    pub off_max_k: f64,
    /// The hand.
    pub hand: HandParams,
    /// The observer.
    pub observer: ObserverParams,
}

impl Participant {
    /// The participant with a code in a session: drawn from the seed.
    pub fn new(
        session: &Session,
        code: &str,
        seed: u64,
        skin: &SkinParams,
        hand: HandParams,
        observer: ObserverParams,
    ) -> Self {
        let mut random = Stream::new(seed, &format!("{} {code} skin", session.task));
        let rest_c = session.rest.map_or(REST_C, |rest| rest.skin_c);
        let mean_c = skin.mean_c.unwrap_or(rest_c);
        let limits_k = (-skin.within_k, skin.within_k);
        let natural_off_k = mean_c - rest_c + random.normal_within(0.0, skin.sd_k, limits_k);
        let off_max_k = match &session.rest {
            Some(rest) if session.measures_skin() => GATE_SHARE * rest.within_k,
            _ => f64::INFINITY,
        };
        Self { skin_off_k: natural_off_k, rest_c, drift_k: skin.drift_k, off_max_k, hand, observer }
    }

    /// Skin before contact, °C, after a fraction of the session.
    pub fn skin_c(&self, fraction: f64) -> f64 {
        let off_k = self.skin_off_k + self.drift_k * fraction;
        self.rest_c + off_k.clamp(-self.off_max_k, self.off_max_k)
    }
}

impl ObserverParams {
    /// The parameters for a session: those of a thermode where the skin rests on the display, otherwise those of touch.
    pub fn of_session(session: &Session) -> Self {
        let is_thenar = |station: &Station| station.finger.contains("thenar");
        match session.trial.procedure {
            Procedure::Intervals { .. } if session.stations.iter().any(is_thenar) => {
                Self::THERMODE_THENAR
            }
            Procedure::Intervals { .. } => Self::THERMODE_FINGERTIP,
            Procedure::Touch { .. } => Self::TOUCH,
        }
    }
}
