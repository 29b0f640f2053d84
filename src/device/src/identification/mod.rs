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

/// Demanded current, A, in magnitude, from which the module's current certainly flows in the demanded direction. Below
/// it, the demanded current is taken instead of the measured one, whose sign the current mirror does not show.
const CURRENT_DIRECTION_CERTAIN_FROM: Current = Current::lit("0.25");
/// Magnitude of the demanded current, A, above which demanded and measured current enter the sums from which their ratio is
/// fitted. Below it the voltage lost in the bridge's dead times may be only partial, which makes the relation nonlinear.
const CURRENTS_COMPARED_ABOVE: Current = Current::lit("1");

/// Excitation pulses: change of the current from the baseline, in eighths of [`PULSE_AMPLITUDE`], and length in ticks
/// of 1 ms. Both signs last equally long at each height, so that the display moves by 2.3 K at most; heights differ to
/// tell Joule's heat from drift. There are no pauses, because near zero the bridge does not give the demanded current
/// and the mirror does not show the one that flows; an error of the baseline current has the effect of a drift.
const EXCITATION_PULSES: [(i32, u32); 15] = [
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
/// Current, A, of which [`EXCITATION_PULSES`] are eighths; the largest pulse has twice this amplitude.
const PULSE_AMPLITUDE: Current = Current::lit("1.5");
/// Length of all excitation pulses together, ticks of 1 ms (8.1 s).
const EXCITATION_TICKS: u32 = {
    let (mut ticks, mut pulse) = (0, 0);
    while pulse < EXCITATION_PULSES.len() {
        ticks += EXCITATION_PULSES[pulse].1;
        pulse += 1;
    }
    ticks
};

/// Gains of the loop that brings the display to the operating point: stable for any tile of the class and a
/// thermistor's lag of up to half a second, because the tile's own gains are not known yet.
const SETTLING_GAINS: Gains = Gains {
    proportional_a_k: 0.3,
    integral_s: 5.0,
};
/// Largest current, A, while the display settles. It moves the display by 3 K/s, at which thermistors of different lags
/// agree closely enough for the fault detectors.
const SETTLING_CURRENT_LIMIT: Current = Current::ONE;
/// Largest difference from the operating point, K, of a display that settles.
const SETTLED_WITHIN: Celsius = Celsius::lit("0.06");
/// Ticks of 1 ms for which the display must stay within [`SETTLED_WITHIN`] before the baseline begins.
const SETTLED_TICKS: u32 = 1500;
/// Ticks of 1 ms (60 s) after which an identification ends early if the display has not settled.
const SETTLING_TIMEOUT_TICKS: u32 = 60 * TICK_HZ;
/// Ticks of 1 ms over which the loop's current is averaged into the baseline current, and then again over which reading
/// and measured current are averaged at this current.
const BASELINE_TICKS: u32 = 512;
/// Coldest operating point, °C. The operating point is the sink's temperature, which needs no current, unless that is
/// colder.
const OPERATING_POINT_MIN: Celsius = Celsius::lit("22");
/// Hottest operating point, °C; taken if the sink is hotter.
const OPERATING_POINT_MAX: Celsius = Celsius::lit("35");
/// Largest difference of the display from the operating point, K, during baseline and pulses; beyond it the
/// identification ends early.
const EXCURSION_MAX: Celsius = Celsius::lit("7");

/// Why an identification of the tile ended early; the host gets it in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AbortReason {
    /// A finger touches the display, whose heat would falsify the parameters.
    Touched,
    /// The display was not within 0.06 K of the operating point for 1.5 s in a row in the first 60 s.
    NotSettled,
    /// The display was more than 7 K from the operating point during baseline or pulses.
    TooFar,
    /// The sink is hotter than 41.5 °C, half a kelvin below the temperature at which the station trips.
    SinkHot,
    /// Another command of the host changed the station's state or calibration, or a fault tripped the station.
    Interrupted,
}

impl AbortReason {
    /// The reason in the words of the reply to the host.
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

/// Phases of an identification, in their order; the last two end it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum IdentificationPhase {
    /// The loop brings the display to the operating point, for `ticks` so far; it has been within 0.06 K of it for the
    /// last `near` ticks.
    Settling { ticks: u32, near: u32 },
    /// In the first 512 ticks the loop's current is averaged; in the next 512 ticks, at this current, the reading and
    /// the measured current are.
    Baseline { ticks: u32 },
    /// The pulse with the index `pulse` is applied, for `ticks` so far; each tick is added to the normal equations.
    Pulses { pulse: usize, ticks: u32 },
    /// The normal equations are complete; the loop holds the display at the operating point until a command of the host
    /// changes that.
    Done,
    /// Ended early, for this reason; the station then brings the display to skin temperature.
    Aborted(AbortReason),
}

/// Identification of the tile while the station is armed: settles the display, measures the baseline, and applies
/// current pulses. From their effect on the reading the tile's parameters are computed afterwards.
#[derive(Clone, Debug)]
pub struct Identification {
    phase: IdentificationPhase,
    /// Temperature about which the pulses move the display, °C.
    operating_point: Setpoint,
    /// Loop that holds the display at the operating point before and after the pulses.
    pi: Pi,
    /// Current demanded before the pulses, in 2^-24 A: total over [`BASELINE_TICKS`].
    baseline_demand: i64,
    /// Display's reading before the pulses, in 2^-22 °C: total over the second [`BASELINE_TICKS`], and their mean from
    /// the first pulse on.
    baseline_reading: i64,
    /// Measured current before the pulses, in 2^-24 A, with the sign of the demanded one: total over the second
    /// [`BASELINE_TICKS`], and their mean from the first pulse on.
    baseline_measured: i64,
    /// Current demanded in the tick before, A, to which this tick's measured current belongs.
    previous_demand: Current,
}

impl Identification {
    /// An identification that begins to settle in the next tick, at the temperature of the sink, °C, limited to 22 to
    /// 35 °C. Created by the host's command `tune`.
    #[must_use]
    pub fn new(sink: Celsius) -> Self {
        let operating_point = sink.clamp(OPERATING_POINT_MIN, OPERATING_POINT_MAX);
        let coefficients = PiCoefficients::new(&SETTLING_GAINS, UpdatePeriod::EveryTick);
        Self {
            phase: IdentificationPhase::Settling { ticks: 0, near: 0 },
            operating_point: Setpoint::saturating_celsius(operating_point).0,
            pi: Pi::new(coefficients, SETTLING_CURRENT_LIMIT),
            baseline_demand: 0,
            baseline_reading: 0,
            baseline_measured: 0,
            previous_demand: Current::ZERO,
        }
    }

    /// Temperature about which the pulses move the display, 22 to 35 °C.
    #[must_use]
    pub const fn operating_point(&self) -> Setpoint {
        self.operating_point
    }

    /// Ends the identification early, for the first reason that occurs; no effect after its end.
    fn abort(&mut self, reason: AbortReason) {
        if self.outcome().is_none() {
            self.phase = IdentificationPhase::Aborted(reason);
        }
    }

    /// `None` while the identification is running; `Ok` once the normal equations are complete.
    ///
    /// # Errors
    /// Why the identification ended early.
    #[must_use]
    pub const fn outcome(&self) -> Option<Result<(), AbortReason>> {
        match self.phase {
            IdentificationPhase::Done => Some(Ok(())),
            IdentificationPhase::Aborted(reason) => Some(Err(reason)),
            IdentificationPhase::Settling { .. }
            | IdentificationPhase::Baseline { .. }
            | IdentificationPhase::Pulses { .. } => None,
        }
    }

    /// Chooses the current to demand in this tick, A (positive cools), and adds the tick to `equations`, which must be
    /// empty when the identification starts. `None` once the identification has ended early.
    pub fn choose_current(
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
        if matches!(
            self.phase,
            IdentificationPhase::Baseline { .. } | IdentificationPhase::Pulses { .. }
        ) && excursion.abs() > EXCURSION_MAX
        {
            self.abort(AbortReason::TooFar);
        }
        let reading = i64::from(readings.display.to_bits());
        match self.phase {
            IdentificationPhase::Aborted(_) => return None,
            IdentificationPhase::Done => {}
            IdentificationPhase::Settling { ticks, near } => {
                let is_near = excursion.abs() < SETTLED_WITHIN;
                let near = if is_near { near + 1 } else { 0 };
                self.phase = if near == SETTLED_TICKS {
                    IdentificationPhase::Baseline { ticks: 0 }
                } else if ticks == SETTLING_TIMEOUT_TICKS {
                    IdentificationPhase::Aborted(AbortReason::NotSettled)
                } else {
                    IdentificationPhase::Settling {
                        ticks: ticks + 1,
                        near,
                    }
                };
            }
            IdentificationPhase::Baseline { ticks } if ticks < BASELINE_TICKS => {
                let current = self
                    .pi
                    .update_output(self.operating_point, readings.display);
                self.baseline_demand += i64::from(current.to_bits());
                self.phase = IdentificationPhase::Baseline { ticks: ticks + 1 };
                return Some(current);
            }
            IdentificationPhase::Baseline { ticks } if ticks < 2 * BASELINE_TICKS => {
                self.baseline_reading += reading;
                self.previous_demand = self.pulse_demand(0);
                let measured = signed_measurement(readings.current, self.previous_demand);
                self.baseline_measured += i64::from(measured.to_bits());
                self.phase = IdentificationPhase::Baseline { ticks: ticks + 1 };
                return Some(self.pulse_demand(0));
            }
            IdentificationPhase::Baseline { .. } => {
                self.baseline_reading /= i64::from(BASELINE_TICKS);
                self.baseline_measured /= i64::from(BASELINE_TICKS);
                self.phase = IdentificationPhase::Pulses { pulse: 0, ticks: 0 };
                return Some(self.pulse_demand(0));
            }
            IdentificationPhase::Pulses { pulse, ticks } => {
                let Some((eighths, length)) = EXCITATION_PULSES.get(pulse) else {
                    self.phase = IdentificationPhase::Done;
                    return Some(self.pulse_demand(0));
                };
                let demand = self.pulse_demand(*eighths);
                let measured = signed_measurement(readings.current, self.previous_demand);
                if self.previous_demand.abs() > CURRENTS_COMPARED_ABOVE {
                    equations.add_current_comparison(self.previous_demand, measured);
                }
                let change = reading - self.baseline_reading;
                let turned = certain_direction(self.previous_demand)
                    - certain_direction(self.pulse_demand(0));
                equations.add_tick(change, measured, self.baseline_measured, turned);
                self.previous_demand = demand;
                let (pulse, ticks) = if ticks + 1 < *length {
                    (pulse, ticks + 1)
                } else {
                    (pulse + 1, 0)
                };
                self.phase = IdentificationPhase::Pulses { pulse, ticks };
                return Some(demand);
            }
        }
        Some(
            self.pi
                .update_output(self.operating_point, readings.display),
        )
    }

    /// Current, A: the baseline current plus this number of eighths of the pulses' amplitude.
    fn pulse_demand(&self, eighths: i32) -> Current {
        let baseline = self.baseline_demand / i64::from(BASELINE_TICKS);
        Current::from_bits(baseline as i32).saturating_add(PULSE_AMPLITUDE * eighths / 8)
    }
}

/// Direction in which a demanded current certainly flows: 1 if it cools, -1 if it heats, 0 if it is below 0.25 A in
/// magnitude.
fn certain_direction(demanded: Current) -> i64 {
    if demanded.abs() < CURRENT_DIRECTION_CERTAIN_FROM {
        0
    } else {
        demanded.signum().to_num()
    }
}

/// Measured current, A, with the sign of the demanded one; the demanded current itself if that is below 0.25 A in
/// magnitude.
fn signed_measurement(measured: Current, demanded: Current) -> Current {
    match certain_direction(demanded) {
        0 => demanded,
        1.. => measured,
        _ => -measured,
    }
}
