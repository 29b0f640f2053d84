//! Identification of the tile: applies current pulses around an operating point, and adds up the normal equations of a
//! least-squares fit of the display's response.
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
//! current's direction, delayed by the dead time of a nominal plate, is what the current mirror shows when no current
//! flows: up to 0.05 A, which is a large part of a small pulse. Each tick adds to the [`NormalEquationAccumulator`] in integers; the task that serves the host solves them.
//!
//! Two effects would bias lag and leak if they were neglected. The module's legs take up heat later than the plate, so
//! a part of the current acts late; and Joule's heat reaches the plate late, through the legs. Each effect is modelled
//! by a first-order low-pass filter with the time constant of diffusion along the legs of a module of this class. The
//! current in the equations is the measured one, because tolerances of bridge and module make it differ from the
//! demanded one. The sums from which the ratio of measured to demanded current is fitted are added up, too.

use contact_model::fixed_point::Celsius;

mod normal_equations;

use crate::TICK_HZ;
use crate::drive::Current;
use crate::pi::{Pi, PiCoefficients, UpdatePeriod};
use crate::safety::limits::SINK_MAX_IDENTIFICATION;
use crate::safety::{Setpoint, ValidReadings};
pub use normal_equations::{
    NORMAL_EQUATION_AND_STATISTICS_ROWS, NormalEquationAccumulator, NormalEquationRow,
    StatisticIndex, TIME_UNIT_TICKS_LOG2, UNKNOWN_COUNT,
};
use thermal_settings::PiGains;

/// Magnitude of the demanded current, A, from which on the module's current certainly flows in the demanded direction.
/// Below it the demanded current is used instead of the measured one, because the current mirror does not show the
/// direction.
const CERTAIN_DIRECTION_CURRENT_MIN: Current = Current::lit("0.25");
/// Magnitude of the demanded current, A, above which demanded and measured current enter the sums from which their
/// ratio is fitted. At a smaller current the voltage that the bridge's dead times take may depend on the current, so
/// the measured current is not linear in the demanded one.
const CURRENT_COMPARISON_MIN: Current = Current::lit("1");

/// Excitation pulses in their order: change of the demanded current from the baseline, in eighths of
/// [`NOMINAL_PULSE_CURRENT`], and duration in ticks of 1 ms. At each of the three heights the positive and the negative
/// pulses last equally long, so that the display moves by 2.3 K at most. Three heights separate Joule's heat, which
/// grows with the square of the current, from a drift. No pulse is zero, because near zero the bridge does not give the
/// demanded current, and the current mirror does not show the current that flows. An error of the baseline current
/// looks like a drift, which the fit removes.
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
/// Current, A, that eight eighths in [`EXCITATION_PULSES`] stand for. The pulses have 4, 8 or 16 eighths: 0.75, 1.5 or
/// 3 A.
const NOMINAL_PULSE_CURRENT: Current = Current::lit("1.5");
/// Duration of all excitation pulses together, ticks of 1 ms: 8080 (8.1 s).
const EXCITATION_TICKS: u32 = {
    let (mut ticks, mut pulse) = (0, 0);
    while pulse < EXCITATION_PULSES.len() {
        ticks += EXCITATION_PULSES[pulse].1;
        pulse += 1;
    }
    ticks
};

/// Gains of the PI loop that brings the display to the operating point. They are stable for any tile of the class and
/// any thermistor lag up to 0.5 s, because the parameters of this tile are not known yet.
const SETTLING_GAINS: PiGains = PiGains { proportional_a_k: 0.3, integral_s: 5.0 };
/// Computed by the compiler, because `tune` locks out the tick.
const SETTLING_COEFFICIENTS: PiCoefficients =
    PiCoefficients::new(&SETTLING_GAINS, UpdatePeriod::EveryTick);
/// Largest magnitude of the current, A, by which the PI loop brings the display to the operating point. It moves the
/// display by 3 K/s; a faster display would let thermistors of different lags differ so much that the fault detectors
/// could trip.
const SETTLING_CURRENT_LIMIT: Current = Current::ONE;
/// Deviation of the display's reading from the operating point, K. If the deviation stays below this for
/// [`SETTLED_TICKS_MIN`], the display counts as settled and the baseline is measured. It is far below the 2.3 K by
/// which the pulses then move the display.
const SETTLED_DEVIATION_MAX: Celsius = Celsius::lit("0.06");
/// Ticks of 1 ms in a row (1.5 s) for which the display's reading must be within [`SETTLED_DEVIATION_MAX`] of the
/// operating point before the baseline is measured.
const SETTLED_TICKS_MIN: u32 = 1500;
/// Ticks of 1 ms (60 s) after which an identification ends early with [`AbortReason::NotSettled`] if the display has
/// not settled at the operating point.
const SETTLING_TIMEOUT_TICKS: u32 = 60 * TICK_HZ;
/// Length of each half of the baseline, ticks of 1 ms. In the first half the PI loop runs, and the mean of its current
/// becomes the baseline current. In the second half the baseline current is demanded, and the display's reading and the
/// measured current are averaged.
const TICKS_PER_BASELINE_HALF: u32 = 512;
/// Lowest operating point, °C, used if the sink is colder than this. Otherwise the operating point is the sink's
/// temperature, at which the display needs no current.
const OPERATING_POINT_CLAMP_MIN: Celsius = Celsius::lit("22");
/// Highest operating point, °C, used if the sink is hotter than this.
const OPERATING_POINT_CLAMP_MAX: Celsius = Celsius::lit("35");
/// Largest deviation of the display's reading from the operating point, K, during baseline and pulses. Beyond it the
/// identification ends early with [`AbortReason::TooFar`]; the pulses alone move the display by 2.3 K at most.
const OPERATING_POINT_DEVIATION_MAX: Celsius = Celsius::lit("7");

/// Why an identification of the tile ended early; the reply to the host contains the reason as text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AbortReason {
    /// A finger touches the display (a contact is detected from 0.02 N on). The finger's heat would falsify the tile's
    /// parameters.
    Touched,
    /// Within 60 s the display's reading did not stay within 0.06 K of the operating point for 1.5 s in a row.
    NotSettled,
    /// The display's reading was more than 7 K from the operating point while the baseline was measured or pulses were
    /// applied.
    TooFar,
    /// The heat sink is hotter than 41.5 °C, half a kelvin below the temperature at which the station trips.
    SinkHot,
    /// While the identification was running, the host sent `start` or `abort`, or changed the calibration, the gains or
    /// the tile's parameters, or a fault tripped the station.
    Interrupted,
}

impl AbortReason {
    /// The reason as text for the reply to the host.
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

/// Phase of an identification. `Settling`, `Baseline`, `Pulses` and `Done` follow each other in this order. An
/// identification that ends early changes from `Settling`, `Baseline` or `Pulses` to `Aborted`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
enum IdentificationPhase {
    /// The PI loop brings the display to the operating point, for `ticks` ticks of 1 ms so far. `near` counts
    /// the ticks in a row, up to the present one, in which the display's reading was within 0.06 K of it.
    Settling { ticks: u32, near: u32 },
    /// The baseline before the pulses is measured, for `ticks` ticks of 1 ms so far. In the first 512 ticks the current
    /// of the PI loop is averaged; in the next 512 ticks this mean current is demanded, and the display's reading and
    /// the measured current are averaged.
    Baseline { ticks: u32 },
    /// The pulse with the index `pulse` in [`EXCITATION_PULSES`] is applied, for `ticks` ticks of 1 ms so far. Each
    /// tick is added to the normal equations.
    Pulses { pulse: usize, ticks: u32 },
    /// The normal equations are complete. The PI loop holds the display at the operating point until a command of the
    /// host or a fault ends that.
    Done,
    /// The identification has ended early, for this reason. The station then brings the display to the skin's
    /// temperature.
    Aborted(AbortReason),
}

/// Identification of the tile, which runs while the station is armed: brings the display to the operating point,
/// measures the baseline, applies current pulses, and adds up the normal equations of the display's response. The
/// tile's parameters are computed from them afterwards, by the task that serves the host.
#[derive(Clone, Debug)]
pub struct Identification {
    phase: IdentificationPhase,
    /// Temperature around which the pulses move the display, 22 to 35 °C.
    operating_point: Setpoint,
    /// PI loop whose current holds the display at the operating point: while the display settles, in the first half of
    /// the baseline, and after the pulses.
    pi: Pi,
    /// Total of the currents demanded in the first half of the baseline, in 2^-24 A; positive cools. Divided by
    /// [`TICKS_PER_BASELINE_HALF`], it is the baseline current.
    baseline_demand: i64,
    /// Until the baseline ends: total of the display's readings in its second half, in 2^-22 °C. During the pulses: the
    /// mean of these readings.
    baseline_reading: i64,
    /// Until the baseline ends: total of the measured currents in its second half, in 2^-24 A, with the sign of the
    /// demanded current (positive cools). During the pulses: the mean of these currents.
    baseline_measured: i64,
    /// Current demanded in the previous tick, A (positive cools), to which the current measured in the present tick
    /// responds. Kept up to date only in the second half of the baseline and during the pulses; zero before.
    previous_demand: Current,
}

impl Identification {
    /// An identification that begins in the next tick. Its operating point is `sink`, the heat sink's temperature in
    /// °C, limited to 22 to 35 °C. Created by the host's command `tune`.
    pub fn begin_at_sink_temperature(sink: Celsius) -> Self {
        let operating_point = sink.clamp(OPERATING_POINT_CLAMP_MIN, OPERATING_POINT_CLAMP_MAX);
        Self {
            phase: IdentificationPhase::Settling { ticks: 0, near: 0 },
            operating_point: Setpoint::clamp_celsius_with_flag(operating_point).0,
            pi: Pi::new(SETTLING_COEFFICIENTS, SETTLING_CURRENT_LIMIT),
            baseline_demand: 0,
            baseline_reading: 0,
            baseline_measured: 0,
            previous_demand: Current::ZERO,
        }
    }

    /// Temperature around which the pulses move the display, 22 to 35 °C; the display's set-point while the
    /// identification runs.
    pub const fn operating_point(&self) -> Setpoint {
        self.operating_point
    }

    /// Ends a running identification early, for this reason. Has no effect on an identification that has already ended,
    /// so the first reason stays.
    fn abort_if_running(&mut self, reason: AbortReason) {
        if self.outcome().is_none() {
            self.phase = IdentificationPhase::Aborted(reason);
        }
    }

    /// `None` while the identification is running; `Ok` once the normal equations are complete.
    ///
    /// # Errors
    /// The identification has ended early, for this reason.
    pub const fn outcome(&self) -> Option<Result<(), AbortReason>> {
        match self.phase {
            IdentificationPhase::Done => Some(Ok(())),
            IdentificationPhase::Aborted(reason) => Some(Err(reason)),
            IdentificationPhase::Settling { .. }
            | IdentificationPhase::Baseline { .. }
            | IdentificationPhase::Pulses { .. } => None,
        }
    }

    /// Runs one tick of the identification, and returns the current to demand in this tick, A (positive cools). During
    /// the pulses the tick is added to `equations`, which are emptied when the pulses begin. `touching` is true while a
    /// finger touches the display, which ends the identification early.
    ///
    /// `None` in the tick that ends the identification early and in all later ticks; but in the tick that ends it with
    /// [`AbortReason::NotSettled`], still the current of the PI loop.
    pub fn step(
        &mut self,
        equations: &mut NormalEquationAccumulator,
        readings: &ValidReadings,
        touching: bool,
    ) -> Option<Current> {
        let excursion = (readings.display).saturating_sub(self.operating_point.celsius());
        if touching {
            self.abort_if_running(AbortReason::Touched);
        }
        if readings.sink > SINK_MAX_IDENTIFICATION {
            self.abort_if_running(AbortReason::SinkHot);
        }
        // While the display settles, it may come from any temperature.
        if matches!(
            self.phase,
            IdentificationPhase::Baseline { .. } | IdentificationPhase::Pulses { .. }
        ) && excursion.abs() > OPERATING_POINT_DEVIATION_MAX
        {
            self.abort_if_running(AbortReason::TooFar);
        }
        let reading = i64::from(readings.display.to_bits());
        match self.phase {
            IdentificationPhase::Aborted(_) => return None,
            IdentificationPhase::Done => {}
            IdentificationPhase::Settling { ticks, near } => {
                let is_near = excursion.abs() < SETTLED_DEVIATION_MAX;
                let near = if is_near { near + 1 } else { 0 };
                self.phase = if near == SETTLED_TICKS_MIN {
                    IdentificationPhase::Baseline { ticks: 0 }
                } else if ticks == SETTLING_TIMEOUT_TICKS {
                    IdentificationPhase::Aborted(AbortReason::NotSettled)
                } else {
                    IdentificationPhase::Settling { ticks: ticks + 1, near }
                };
            }
            IdentificationPhase::Baseline { ticks } if ticks < TICKS_PER_BASELINE_HALF => {
                let current =
                    self.pi.update_output_when_due(self.operating_point, readings.display);
                self.baseline_demand += i64::from(current.to_bits());
                self.phase = IdentificationPhase::Baseline { ticks: ticks + 1 };
                return Some(current);
            }
            IdentificationPhase::Baseline { ticks } if ticks < 2 * TICKS_PER_BASELINE_HALF => {
                self.baseline_reading += reading;
                self.previous_demand = self.baseline_current_plus_eighths(0);
                let measured =
                    measured_with_sign_or_demanded(readings.current, self.previous_demand);
                self.baseline_measured += i64::from(measured.to_bits());
                self.phase = IdentificationPhase::Baseline { ticks: ticks + 1 };
                return Some(self.baseline_current_plus_eighths(0));
            }
            IdentificationPhase::Baseline { .. } => {
                self.baseline_reading /= i64::from(TICKS_PER_BASELINE_HALF);
                self.baseline_measured /= i64::from(TICKS_PER_BASELINE_HALF);
                // Here, and not in the command, which locks out the tick of the next finger.
                *equations = NormalEquationAccumulator::default();
                self.phase = IdentificationPhase::Pulses { pulse: 0, ticks: 0 };
                return Some(self.baseline_current_plus_eighths(0));
            }
            IdentificationPhase::Pulses { pulse, ticks } => {
                let Some((eighths, length)) = EXCITATION_PULSES.get(pulse) else {
                    self.phase = IdentificationPhase::Done;
                    return Some(self.baseline_current_plus_eighths(0));
                };
                let demand = self.baseline_current_plus_eighths(*eighths);
                let measured =
                    measured_with_sign_or_demanded(readings.current, self.previous_demand);
                if self.previous_demand.abs() > CURRENT_COMPARISON_MIN {
                    equations.add_current_comparison(self.previous_demand, measured);
                }
                let change = reading - self.baseline_reading;
                let turned = certain_current_direction(self.previous_demand)
                    - certain_current_direction(self.baseline_current_plus_eighths(0));
                equations.add_tick(change, measured, self.baseline_measured, turned);
                self.previous_demand = demand;
                let (pulse, ticks) =
                    if ticks + 1 < *length { (pulse, ticks + 1) } else { (pulse + 1, 0) };
                self.phase = IdentificationPhase::Pulses { pulse, ticks };
                return Some(demand);
            }
        }
        Some(self.pi.update_output_when_due(self.operating_point, readings.display))
    }

    /// Current to demand, A (positive cools): the baseline current plus `eighths` eighths of [`NOMINAL_PULSE_CURRENT`].
    fn baseline_current_plus_eighths(&self, eighths: i32) -> Current {
        let baseline = self.baseline_demand / i64::from(TICKS_PER_BASELINE_HALF);
        Current::from_bits(baseline as i32).saturating_add(NOMINAL_PULSE_CURRENT * eighths / 8)
    }
}

/// Direction in which the module's current certainly flows if this current, A, is demanded: 1 if it cools, -1 if it
/// heats, 0 (uncertain) if its magnitude is below 0.25 A.
fn certain_current_direction(demanded: Current) -> i64 {
    if demanded.abs() < CERTAIN_DIRECTION_CURRENT_MIN { 0 } else { demanded.signum().to_num() }
}

/// The measured current, A, with the sign of the demanded one, because the current mirror shows only the magnitude. The
/// demanded current itself if its magnitude is below 0.25 A.
fn measured_with_sign_or_demanded(measured: Current, demanded: Current) -> Current {
    match certain_current_direction(demanded) {
        0 => demanded,
        1.. => measured,
        _ => -measured,
    }
}
