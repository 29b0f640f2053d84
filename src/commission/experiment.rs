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

use contact_model::fixed_point::Celsius;

use crate::TICK_HZ;
use crate::control::{Period, Pi};
use crate::drive::Current;
use crate::guard::{Setpoint, Sound};
use crate::settings::Gains;

/// Unknowns, and what the reading's integral is made of.
pub const UNKNOWNS: usize = 7;
const COLUMNS: usize = UNKNOWNS + 1;
/// A row of the normal equations: sums of products with each unknown's part, and with what they make up.
pub type Row = [i64; COLUMNS];

/// Pulses: change of current in eighths of [`AMPLITUDE`], and how long, ms. Both signs last equally long at each
/// height, twice as high has four times the Joule's heat, and pauses tell that from drift.
const PULSES: [(i32, u32); 13] = [
    (8, 150),
    (-8, 300),
    (8, 150),
    (0, 200),
    (8, 500),
    (-8, 1000),
    (8, 500),
    (0, 500),
    (-16, 120),
    (16, 240),
    (-16, 120),
    (0, 500),
    (0, 200),
];
const AMPLITUDE: Current = Current::lit("2");
/// Ticks from one equation to the next.
const EVERY: u32 = 8;
/// Binary places of seconds in the sums, and of everything in an equation's parts.
const PART_BITS: u32 = 22;

/// A loop that is stable for any tile of its class, whatever its sensor's lag to half a second.
const CAUTIOUS: Gains = Gains {
    proportional_a_k: 0.3,
    integral_s: 5.0,
};
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
    /// Totals over [`BASE_TICKS`], then means: current and reading at rest.
    base_current: i64,
    base_reading: i64,
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
    y1: i64,
    y2: i64,
    rows: [Row; UNKNOWNS],
}

impl Experiment {
    /// Begins with a sink of some temperature.
    #[must_use]
    pub fn new(sink: Celsius, limit: Current) -> Self {
        Self {
            phase: Phase::Settling { ticks: 0, near: 0 },
            rest: Setpoint::limited(sink.clamp(COLDEST, HOTTEST)).0,
            pi: Pi::new(&CAUTIOUS, limit.to_num(), Period::EveryTick),
            base_current: 0,
            base_reading: 0,
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
    pub const fn outcome(&self) -> Option<Result<&[Row; UNKNOWNS], Aborted>> {
        match self.phase {
            Phase::Done => Some(Ok(&self.sums.rows)),
            Phase::Aborted(why) => Some(Err(why)),
            _ => None,
        }
    }

    /// Current of one tick; `None` when it was ended early.
    pub fn update(&mut self, sound: &Sound, touching: bool) -> Option<Current> {
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
                self.phase = Phase::Base { ticks: ticks + 1 };
                return Some(self.current(0));
            }
            Phase::Base { .. } => {
                self.base_reading /= i64::from(BASE_TICKS);
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
                let change = i64::from(AMPLITUDE.to_bits()) * i64::from(*eighths) / 8;
                self.sums.take(reading - self.base_reading, change);
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

impl Sums {
    /// Takes the change of the reading, 2^-22 K, and of the current that is asked for now, 2^-24 A.
    fn take(&mut self, y: i64, u: i64) {
        self.ticks += 1;
        // The reading is the mean of the tick before, so half of it belongs there.
        self.y1 += y;
        self.y2 += self.y1;
        if self.ticks.is_multiple_of(EVERY) {
            let t = i64::from(self.ticks);
            // Parts in 2^-PART_BITS, seconds of 1024 ticks: below 2^26, so that a few hundred products stay in 63 bits.
            let parts: [i64; COLUMNS] = [
                y,
                self.u2 >> 22,
                self.u1 >> 12,
                self.v2 >> 22,
                self.y2 >> 20,
                t << (PART_BITS - 10),
                (t * t) << 1,
                self.y1 >> 10,
            ];
            for (row, a) in self.rows.iter_mut().zip(&parts) {
                for (sum, b) in row.iter_mut().zip(&parts) {
                    *sum += a * b;
                }
            }
        }
        self.u1 += u;
        self.u2 += self.u1;
        self.v1 += (u * u) >> 24;
        self.v2 += self.v1;
    }
}
