//! Identification of the tile: current pulses about an operating point, and the least squares of what follows.
//!
//! The model of [`Tile`](thermal_settings::Tile), integrated twice from the steady state on, is linear in its unknowns:
//!
//! ```text
//! m Y1 = -lag y - gain (U2 - zero D2) + gain dead U1 + gain joule V2 - leak Y2 + a t + b t^2/2,   m = 1 + leak lag
//! ```
//!
//! with the change of the reading `y`, its first and second integral `Y1` and `Y2`, the integrals `U1` and `U2` of the
//! current's change, and `V2` of its square. Integration averages noise, and nothing is differentiated. `a` and `b`
//! absorb the error of the baseline reading and a drift. `zero`, with the second integral `D2` of the change of the
//! current's direction, is what the current mirror shows when no current flows: up to 0.05 A, which is much of a small
//! pulse. The tick adds up the [`NormalEquations`] in integers.
//!
//! Two effects would bias lag and leak if they were neglected. The legs take up heat with the plate, later than the
//! plate, so a part of the current acts late; and Joule's heat reaches the plate through the legs. Both are first-order
//! low-pass filters with the time constants of diffusion along the legs of a module of this class. The current is the
//! measured one, because bridge and module turn a demanded current into one that is unknown to their tolerances; the
//! relation of both is added up as well.

use contact_model::fixed_point::Celsius;

mod normal_equations;

use crate::TICK_HZ;
use crate::drive::Current;
use crate::pi::{Pi, PiCoefficients, UpdatePeriod};
use crate::safety::limits::SINK_MAX_IDENTIFICATION;
use crate::safety::{Setpoint, ValidReadings};
pub use normal_equations::{
    NormalEquationRow, NormalEquations, ROWS, Statistic, TIME_UNIT_SHIFT, UNKNOWNS,
};
use thermal_settings::Gains;

/// A demanded current below this may flow in either direction; it is taken instead of the measured magnitude.
const DIRECTION_CERTAIN_FROM: Current = Current::lit("0.25");
/// Demanded and measured current are compared above this: the smaller the current, the less the bridge's dead times take.
const COMPARED_ABOVE: Current = Current::lit("1");

/// Excitation pulses: change of the current in eighths of [`AMPLITUDE`], and length in ticks. Both signs last equally
/// long at each height, so that the display moves by 2.3 K at most; heights differ to tell Joule's heat from drift. There
/// are no pauses, because near zero the bridge does not give the demanded current and the mirror does not show the one
/// that flows; an error of the baseline current has the effect of a drift.
const PULSES: [(i32, u32); 15] = [
    (8, 150),
    (-8, 300),
    (8, 150),
    (-4, 250),
    (4, 500),
    (-4, 250),
    (8, 500),
    (-8, 1000),
    (8, 500),
    (-4, 1000),
    (4, 2000),
    (-4, 1000),
    (-16, 120),
    (16, 240),
    (-16, 120),
];
const AMPLITUDE: Current = Current::lit("1.5");
/// Ticks of all pulses.
const EXCITATION_TICKS: u32 = {
    let (mut ticks, mut pulse) = (0, 0);
    while pulse < PULSES.len() {
        ticks += PULSES[pulse].1;
        pulse += 1;
    }
    ticks
};

/// Gains that are stable for any tile of its class and a sensor's lag of up to half a second.
const SETTLING_GAINS: Gains = Gains {
    proportional_a_k: 0.3,
    integral_s: 5.0,
};
/// Largest current while settling: the display moves by 3 K/s, at which sensors of different lags agree closely enough.
const SETTLING_CURRENT_LIMIT: Current = Current::ONE;
/// The display has settled when it has been this near the operating point, K, for this many ticks.
const SETTLED_WITHIN: Celsius = Celsius::lit("0.06");
const SETTLED_TICKS: u32 = 1500;
/// Ticks after which a display that has not settled ends the identification.
const SETTLING_TIMEOUT_TICKS: u32 = 60 * TICK_HZ;
/// Ticks over which the baseline current is averaged, and then the baseline reading.
const BASELINE_TICKS: u32 = 512;
/// The operating point is the sink's temperature, which needs no current, limited to this range.
const OPERATING_POINT_MIN: Celsius = Celsius::lit("22");
const OPERATING_POINT_MAX: Celsius = Celsius::lit("35");
/// Largest difference of the display from the operating point, K, from the baseline on.
const MAX_EXCURSION: Celsius = Celsius::lit("7");

/// Why an identification ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AbortReason {
    /// A finger touches the display.
    Touched,
    /// The display did not settle in time.
    NotSettled,
    /// The display went too far from the operating point.
    TooFar,
    /// The sink is too hot.
    SinkHot,
    /// Another command or a fault ended it.
    Interrupted,
}

impl AbortReason {
    /// The words of the reply to the host.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::Touched => "a finger touches the display",
            Self::NotSettled => "the display did not come to rest within 60 s",
            Self::TooFar => "the display went more than 7 C from rest",
            Self::SinkHot => "the sink is above 41.5 C",
            Self::Interrupted => "another command or a fault ended it",
        }
    }
}

/// Stages of the identification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// The loop brings the display to the operating point; `near` is the number of ticks for which it has been near.
    Settling { ticks: u32, near: u32 },
    /// The baseline current is averaged, then the baseline reading at this current.
    Baseline { ticks: u32 },
    /// The pulse of this index is applied, for `ticks` so far.
    Pulses { pulse: usize, ticks: u32 },
    /// The normal equations are complete; the loop holds the display at the operating point.
    Done,
    /// Ended early.
    Aborted(AbortReason),
}

/// The course of an identification: settling, baseline, pulses.
#[derive(Clone, Debug)]
pub struct Identification {
    phase: Phase,
    operating_point: Setpoint,
    pi: Pi,
    /// Demanded current, reading and measured current before the pulses, in units of their resolution: totals over
    /// [`BASELINE_TICKS`]; the last two become means when the pulses begin.
    baseline_demand: i64,
    baseline_reading: i64,
    baseline_measured: i64,
    /// Current demanded in the tick before, which flows in this tick.
    previous_demand: Current,
}

impl Identification {
    /// Starts an identification at the temperature of the sink.
    #[must_use]
    pub fn new(sink: Celsius) -> Self {
        let operating_point = sink.clamp(OPERATING_POINT_MIN, OPERATING_POINT_MAX);
        let coefficients = PiCoefficients::new(&SETTLING_GAINS, UpdatePeriod::EveryTick);
        Self {
            phase: Phase::Settling { ticks: 0, near: 0 },
            operating_point: Setpoint::saturating_celsius(operating_point).0,
            pi: Pi::new(coefficients, SETTLING_CURRENT_LIMIT),
            baseline_demand: 0,
            baseline_reading: 0,
            baseline_measured: 0,
            previous_demand: Current::ZERO,
        }
    }

    /// The temperature about which the pulses move the display, 22 to 35 °C.
    #[must_use]
    pub const fn operating_point(&self) -> Setpoint {
        self.operating_point
    }

    /// Ends the identification early; no effect if it has already ended.
    fn abort(&mut self, reason: AbortReason) {
        if self.outcome().is_none() {
            self.phase = Phase::Aborted(reason);
        }
    }

    /// Whether the normal equations are complete; `None` while the identification is running.
    ///
    /// # Errors
    /// Why the identification ended early.
    #[must_use]
    pub const fn outcome(&self) -> Option<Result<(), AbortReason>> {
        match self.phase {
            Phase::Done => Some(Ok(())),
            Phase::Aborted(reason) => Some(Err(reason)),
            Phase::Settling { .. } | Phase::Baseline { .. } | Phase::Pulses { .. } => None,
        }
    }

    /// The current to demand in this tick; `None` if the identification has been aborted. The `equations` must be empty when the identification starts.
    pub fn update(
        &mut self,
        equations: &mut NormalEquations,
        readings: &ValidReadings,
        touching: bool,
    ) -> Option<Current> {
        let excursion = (readings.display).saturating_sub(self.operating_point.celsius());
        if touching {
            self.abort(AbortReason::Touched);
        }
        if readings.sink > SINK_MAX_IDENTIFICATION {
            self.abort(AbortReason::SinkHot);
        }
        // While it settles, the display may come from any temperature.
        if matches!(self.phase, Phase::Baseline { .. } | Phase::Pulses { .. })
            && excursion.abs() > MAX_EXCURSION
        {
            self.abort(AbortReason::TooFar);
        }
        let reading = i64::from(readings.display.to_bits());
        match self.phase {
            Phase::Aborted(_) => return None,
            Phase::Done => {}
            Phase::Settling { ticks, near } => {
                let is_near = excursion.abs() < SETTLED_WITHIN;
                let near = if is_near { near + 1 } else { 0 };
                self.phase = if near == SETTLED_TICKS {
                    Phase::Baseline { ticks: 0 }
                } else if ticks == SETTLING_TIMEOUT_TICKS {
                    Phase::Aborted(AbortReason::NotSettled)
                } else {
                    Phase::Settling {
                        ticks: ticks + 1,
                        near,
                    }
                };
            }
            Phase::Baseline { ticks } if ticks < BASELINE_TICKS => {
                let current = self.pi.update(self.operating_point, readings.display);
                self.baseline_demand += i64::from(current.to_bits());
                self.phase = Phase::Baseline { ticks: ticks + 1 };
                return Some(current);
            }
            Phase::Baseline { ticks } if ticks < 2 * BASELINE_TICKS => {
                self.baseline_reading += reading;
                self.previous_demand = self.demand(0);
                let measured = signed(readings.current, self.previous_demand);
                self.baseline_measured += i64::from(measured.to_bits());
                self.phase = Phase::Baseline { ticks: ticks + 1 };
                return Some(self.demand(0));
            }
            Phase::Baseline { .. } => {
                self.baseline_reading /= i64::from(BASELINE_TICKS);
                self.baseline_measured /= i64::from(BASELINE_TICKS);
                self.phase = Phase::Pulses { pulse: 0, ticks: 0 };
                return Some(self.demand(0));
            }
            Phase::Pulses { pulse, ticks } => {
                let Some((eighths, length)) = PULSES.get(pulse) else {
                    self.phase = Phase::Done;
                    return Some(self.demand(0));
                };
                let demand = self.demand(*eighths);
                let measured = signed(readings.current, self.previous_demand);
                if self.previous_demand.abs() > COMPARED_ABOVE {
                    equations.compare(self.previous_demand, measured);
                }
                let change = reading - self.baseline_reading;
                let turned = direction(self.previous_demand) - direction(self.demand(0));
                equations.add(change, measured, self.baseline_measured, turned);
                self.previous_demand = demand;
                let (pulse, ticks) = if ticks + 1 < *length {
                    (pulse, ticks + 1)
                } else {
                    (pulse + 1, 0)
                };
                self.phase = Phase::Pulses { pulse, ticks };
                return Some(demand);
            }
        }
        Some(self.pi.update(self.operating_point, readings.display))
    }

    /// The baseline current and some eighths of the pulses' amplitude.
    fn demand(&self, eighths: i32) -> Current {
        let baseline = self.baseline_demand / i64::from(BASELINE_TICKS);
        Current::from_bits(baseline as i32).saturating_add(AMPLITUDE * eighths / 8)
    }
}

/// Direction in which a demanded current flows: 1 if it cools, -1 if it heats, 0 if that is not certain.
fn direction(demanded: Current) -> i64 {
    if demanded.abs() < DIRECTION_CERTAIN_FROM {
        0
    } else {
        demanded.signum().to_num()
    }
}

/// The measured magnitude with the sign of the demanded current; the demanded current if its direction is not certain.
fn signed(measured: Current, demanded: Current) -> Current {
    match direction(demanded) {
        0 => demanded,
        1.. => measured,
        _ => -measured,
    }
}
