//! The experiment that shows what the tile is like: pulses of current around rest, and sums of what follows.
//!
//! The model of [`Tile`](crate::settings::Tile), integrated twice from rest on, is linear in what is to be found:
//!
//! ```text
//! m Y1 = -lag y - gain U2 + gain dead U1 + gain joule V2 - leak Y2 + a t + b t^2/2,   m = 1 + leak lag
//! ```
//!
//! with the reading's change `y`, its integrals `Y1` and `Y2`, those of the current's change `U1`, `U2`, and of its
//! square `V2`. Integrals of noise are small, and nothing is ever differentiated. `a` and `b` take up what the reading
//! at rest was not known to, and what drifts. The tick adds up the normal equations of least squares in integers.
//!
//! Two things would be taken for lag or leak if they were left out. The legs take up heat with the plate, later than
//! it, so a part of the current acts late; and Joule's heat must come up the legs. Both are first-order filters with
//! the times of diffusion along the legs of a module of this class. The current is the measured one, since that asked
//! for goes through a bridge and a module whose tolerances are unknown; how both compare is added up as well.

use contact_model::fixed_point::Celsius;

use crate::TICK_HZ;
use crate::control::{Period, Pi, Response};
use crate::drive::Current;
use crate::guard::{Setpoint, Sound};
use crate::settings::Gains;

/// Current below which its direction is not certain, and that asked for is taken.
const DIRECTED: Current = Current::lit("0.25");
/// Rates of the filters, of 2^15 a tick: 0.11 s for what the legs take up, 0.149 s for Joule's heat (a fifteenth and a
/// twelfth of the legs' capacity over their conductance, 1.8 s).
const LEGS_RATE: i64 = 298;
const JOULE_RATE: i64 = 220;
/// Part of the current that acts late, of 2^15: a third of the legs' capacity beside that of the plate.
const LEGS_PART: i64 = 1933;
const RATE_BITS: u32 = 15;

/// Unknowns, and what the reading's integral is made of.
pub const UNKNOWNS: usize = 7;
const COLUMNS: usize = UNKNOWNS + 1;
/// A row of the normal equations: sums of products with each unknown's part, and with what they make up.
pub type Row = [i64; COLUMNS];
/// One for each unknown; then products of the current that was asked for with itself and with the measured one.
pub const ROWS: usize = UNKNOWNS + 1;

/// Pulses: change of current in eighths of [`AMPLITUDE`], and how long, ms. Both signs last equally long at each
/// height, so the display moves by 2.3 K at most, and heights differ to tell Joule's heat from drift. There are no pauses: near zero the bridge does not give
/// what is asked for, and the mirror not what flows; what that makes of the current at rest is like a drift.
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
/// Ticks from one equation to the next.
const EVERY: u32 = 8;
/// Ticks of an equation's unit of time, as a power of two.
pub const UNIT_BITS: u32 = 11;
/// Binary places of an equation's parts, which are the reading's, and of currents.
const PART_BITS: u32 = 22;
const CURRENT_BITS: u32 = 24;

/// A loop that is stable for any tile of its class, whatever its sensor's lag to half a second.
const CAUTIOUS: Gains = Gains {
    proportional_a_k: 0.3,
    integral_s: 5.0,
};
/// Its largest current, A: the display moves by 3 K/s, at which sensors of different lags stay together.
const CAUTIOUS_A: Current = Current::ONE;
/// The display is at rest when it stays this near for this long.
const NEAR: Celsius = Celsius::lit("0.06");
const REST_TICKS: u32 = 1500;
/// Longest wait for that, ticks.
const PATIENCE_TICKS: u32 = 60 * TICK_HZ;
/// Ticks over which current and reading at rest are found.
const BASE_TICKS: u32 = 512;
/// The display rests at the sink's temperature, where no current is needed, within these.
const COLDEST: Celsius = Celsius::lit("22");
const HOTTEST: Celsius = Celsius::lit("35");
/// What ends the experiment: a display this far from rest, or a sink this hot.
const FARTHEST: Celsius = Celsius::lit("7");
const SINK_HOTTEST: Celsius = Celsius::lit("42.5");

/// Why an experiment ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aborted {
    /// A finger touches the display.
    Finger,
    /// The display does not come to rest.
    Restless,
    /// The display went too far.
    Display,
    /// The sink is too hot.
    Sink,
    /// The host wanted something else, or a fault tripped.
    Ended,
}

impl Aborted {
    /// What the host is told.
    #[must_use]
    pub const fn reason(self) -> &'static str {
        match self {
            Self::Finger => "a finger touches the display",
            Self::Restless => "the display did not come to rest within 60 s",
            Self::Display => "the display went more than 7 C from rest",
            Self::Sink => "the sink is above 42.5 C",
            Self::Ended => "another command or a fault ended it",
        }
    }
}

/// How far it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Coming to rest; near for so many ticks.
    Settling { ticks: u32, near: u32 },
    /// Finding current and reading at rest.
    Base { ticks: u32 },
    /// Pulses, with the ticks of the one that lasts.
    Pulses { pulse: usize, ticks: u32 },
    /// All sums are there; the display is held at rest.
    Done,
    /// Ended early.
    Aborted(Aborted),
}

/// The experiment, from tick to tick.
#[derive(Clone, Debug)]
pub struct Experiment {
    phase: Phase,
    rest: Setpoint,
    pi: Pi,
    /// Totals over [`BASE_TICKS`], then means: current asked for, reading and measured current at rest.
    base_current: i64,
    base_reading: i64,
    base_measured: i64,
    /// Current asked for in the tick before, which flows now.
    asked: Current,
    sums: Sums,
}

/// The integrals, in ticks, and the normal equations.
#[derive(Clone, Debug, Default)]
struct Sums {
    ticks: u32,
    u1: i64,
    u2: i64,
    v1: i64,
    v2: i64,
    /// What the filters have reached: current, and its square.
    late: i64,
    heat: i64,

    y1: i64,
    y2: i64,
    rows: [Row; ROWS],
}

impl Experiment {
    /// Begins with a sink of some temperature.
    #[must_use]
    pub fn new(sink: Celsius) -> Self {
        Self {
            phase: Phase::Settling { ticks: 0, near: 0 },
            rest: Setpoint::limited(sink.clamp(COLDEST, HOTTEST)).0,
            pi: Pi::new(Response::new(&CAUTIOUS, Period::EveryTick), CAUTIOUS_A),
            base_current: 0,
            base_reading: 0,
            base_measured: 0,
            asked: Current::ZERO,
            sums: Sums::default(),
        }
    }

    /// The temperature around which the display moves.
    #[must_use]
    pub const fn rest(&self) -> Setpoint {
        self.rest
    }

    /// It has not ended early, so the display follows it.
    #[must_use]
    pub const fn drives(&self) -> bool {
        !matches!(self.phase, Phase::Aborted(_))
    }

    /// Ends it, unless it has ended already.
    pub fn abort(&mut self, why: Aborted) {
        if !matches!(self.phase, Phase::Done | Phase::Aborted(_)) {
            self.phase = Phase::Aborted(why);
        }
    }

    /// Whether the normal equations are complete; `None` while it goes on.
    ///
    /// # Errors
    /// Why it ended early.
    #[must_use]
    pub const fn outcome(&self) -> Option<Result<&[Row; ROWS], Aborted>> {
        match self.phase {
            Phase::Done => Some(Ok(&self.sums.rows)),
            Phase::Aborted(why) => Some(Err(why)),
            _ => None,
        }
    }

    /// Current of one tick in which one of a magnitude was measured; `None` when it was ended early.
    pub fn update(&mut self, sound: &Sound, measured: Current, touching: bool) -> Option<Current> {
        let from_rest = sound.display.saturating_sub(self.rest.celsius());
        if touching {
            self.abort(Aborted::Finger);
        }
        if sound.sink > SINK_HOTTEST {
            self.abort(Aborted::Sink);
        }
        let reading = i64::from(sound.display.to_bits());
        match self.phase {
            Phase::Aborted(_) => return None,
            Phase::Done => {}
            Phase::Settling { ticks, near } => {
                let near = if from_rest.abs() < NEAR { near + 1 } else { 0 };
                self.phase = if near == REST_TICKS {
                    Phase::Base { ticks: 0 }
                } else if ticks == PATIENCE_TICKS {
                    Phase::Aborted(Aborted::Restless)
                } else {
                    Phase::Settling {
                        ticks: ticks + 1,
                        near,
                    }
                };
            }
            Phase::Base { ticks } if ticks < BASE_TICKS => {
                let current = self.pi.update(self.rest, sound.display);
                self.base_current += i64::from(current.to_bits());
                self.phase = Phase::Base { ticks: ticks + 1 };
                return Some(current);
            }
            Phase::Base { ticks } if ticks < 2 * BASE_TICKS => {
                self.base_reading += reading;
                self.asked = self.current(0);
                let measured = directed(self.asked, measured);
                self.base_measured += i64::from(measured.to_bits());
                self.phase = Phase::Base { ticks: ticks + 1 };
                return Some(self.current(0));
            }
            Phase::Base { .. } => {
                self.base_reading /= i64::from(BASE_TICKS);
                self.base_measured /= i64::from(BASE_TICKS);
                self.phase = Phase::Pulses { pulse: 0, ticks: 0 };
                return Some(self.current(0));
            }
            Phase::Pulses { pulse, ticks } => {
                if from_rest.abs() > FARTHEST {
                    self.abort(Aborted::Display);
                }
                let Some((eighths, length)) = PULSES.get(pulse) else {
                    self.phase = Phase::Done;
                    return Some(self.current(0));
                };
                let current = self.current(*eighths);
                let measured = directed(self.asked, measured);
                self.sums.compare(self.asked, measured);
                self.sums
                    .take(reading - self.base_reading, measured, self.base_measured);
                self.asked = current;
                self.phase = if ticks + 1 < *length {
                    Phase::Pulses {
                        pulse,
                        ticks: ticks + 1,
                    }
                } else {
                    Phase::Pulses {
                        pulse: pulse + 1,
                        ticks: 0,
                    }
                };
                return Some(current);
            }
        }
        Some(self.pi.update(self.rest, sound.display))
    }

    /// That at rest, and eighths of the amplitude.
    fn current(&self, eighths: i32) -> Current {
        let rest = Current::from_bits((self.base_current / i64::from(BASE_TICKS)) as i32);
        rest.saturating_add(AMPLITUDE * eighths / 8)
    }
}

/// A measured magnitude in the direction of the current that was asked for.
fn directed(asked: Current, measured: Current) -> Current {
    if asked.abs() < DIRECTED {
        asked
    } else if asked < 0 {
        -measured
    } else {
        measured
    }
}

impl Sums {
    /// Takes the current that was asked for, and what it came to.
    fn compare(&mut self, asked: Current, measured: Current) {
        let asked = i64::from(asked.to_bits() >> 8);
        self.rows[UNKNOWNS][0] += asked * asked;
        self.rows[UNKNOWNS][1] += asked * i64::from(measured.to_bits() >> 8);
    }

    /// Takes the change of the reading, 2^-22 K, and the current that has flown meanwhile beside that at rest.
    fn take(&mut self, y: i64, current: Current, rest: i64) {
        let current = i64::from(current.to_bits());
        let (u, v) = (current - rest, (current * current - rest * rest) >> 24);
        self.late += ((u - self.late) * LEGS_RATE) >> RATE_BITS;
        self.heat += ((v - self.heat) * JOULE_RATE) >> RATE_BITS;
        self.ticks += 1;
        self.u1 += u - ((self.late * LEGS_PART) >> RATE_BITS);
        self.u2 += self.u1;
        self.v1 += self.heat;
        self.v2 += self.v1;
        self.y1 += y;
        self.y2 += self.y1;
        if self.ticks.is_multiple_of(EVERY) {
            let t = i64::from(self.ticks);
            // In seconds of 2^UNIT_BITS ticks and 2^-PART_BITS: all below 2^26, so that their products stay in 63 bits.
            let parts: [i64; COLUMNS] = [
                y,
                self.u2 >> (CURRENT_BITS - PART_BITS + 2 * UNIT_BITS),
                self.u1 >> (CURRENT_BITS - PART_BITS + UNIT_BITS),
                self.v2 >> (CURRENT_BITS - PART_BITS + 2 * UNIT_BITS),
                self.y2 >> (2 * UNIT_BITS),
                t << (PART_BITS - UNIT_BITS),
                (t * t) >> (2 * UNIT_BITS - PART_BITS + 1),
                self.y1 >> UNIT_BITS,
            ];
            for (row, a) in self.rows.iter_mut().zip(&parts).take(UNKNOWNS) {
                for (sum, b) in row.iter_mut().zip(&parts) {
                    *sum += a * b;
                }
            }
        }
    }
}
