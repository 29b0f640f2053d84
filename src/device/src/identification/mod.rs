//! The experiment that shows what the tile is like: pulses of current around rest, and sums of what follows.
//!
//! The model of [`Tile`](thermal_settings::Tile), integrated twice from rest on, is linear in what is to be found:
//!
//! ```text
//! m Y1 = -lag y - gain (U2 - zero D2) + gain dead U1 + gain joule V2 - leak Y2 + a t + b t^2/2,   m = 1 + leak lag
//! ```
//!
//! with the reading's change `y`, its integrals `Y1` and `Y2`, those of the current's change `U1`, `U2`, and of its
//! square `V2`. Integrals of noise are small, and nothing is ever differentiated. `a` and `b` take up what the reading
//! at rest was not known to, and what drifts; `zero`, with the integral `D2` of the direction's change, what the mirror
//! shows when nothing flows, of which the 0.05 A of its class are much of a small pulse. The tick adds up the normal
//! equations of least squares in integers.
//!
//! Two things would be taken for lag or leak if they were left out. The legs take up heat with the plate, later than
//! it, so a part of the current acts late; and Joule's heat must come up the legs. Both are first-order filters with
//! the times of diffusion along the legs of a module of this class. The current is the measured one, since that asked
//! for goes through a bridge and a module whose tolerances are unknown; how both compare is added up as well.

use contact_model::fixed_point::Celsius;

mod sums;

use crate::TICK_HZ;
use crate::control::{Period, Pi, Response};
use crate::drive::Current;
use crate::safety::{Setpoint, Sound};
use sums::{COLUMNS, Sums};
pub use sums::{ROWS, Totals, UNIT_BITS, UNKNOWNS};
use thermal_settings::Gains;

/// Current below which its direction is not certain, and that asked for is taken.
const DIRECTED: Current = Current::lit("0.25");
/// Current above which what is measured is compared with what was asked for: below, the dead times of the bridge take less the
/// smaller it is.
const COMPARED_FROM: Current = Current::lit("1");
/// A row of the normal equations: sums of products with each unknown's part, and with what they make up.
pub type Row = [i64; COLUMNS];

/// Pulses: change of current in eighths of [`AMPLITUDE`], and how long, ms. Both signs last equally long at each
/// height, so the display moves by 2.3 K at most, and heights differ to tell Joule's heat from drift. There are no
/// pauses: near zero the bridge does not give what is asked for, and the mirror not what flows; what that makes of the
/// current at rest is like a drift.
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
pub const AFTER: u32 = {
    let (mut ticks, mut pulse) = (0, 0);
    while pulse < PULSES.len() {
        ticks += PULSES[pulse].1;
        pulse += 1;
    }
    ticks
};

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
const SINK_HOTTEST: Celsius = Celsius::lit("41.5");

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
            Self::Sink => "the sink is above 41.5 C",
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
    /// The host has them; the display is let go.
    Taken,
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

    /// The display follows it: it has neither ended early nor been let go.
    #[must_use]
    pub const fn drives(&self) -> bool {
        !matches!(self.phase, Phase::Taken | Phase::Aborted(_))
    }

    /// Ends it, unless it has ended already.
    pub fn abort(&mut self, why: Aborted) {
        if !matches!(self.phase, Phase::Done | Phase::Taken | Phase::Aborted(_)) {
            self.phase = Phase::Aborted(why);
        }
    }

    /// Lets the display go. What was found stays, so that who has lost the answer can ask again.
    pub fn release(&mut self) {
        match self.phase {
            Phase::Done | Phase::Taken => self.phase = Phase::Taken,
            _ => self.abort(Aborted::Ended),
        }
    }

    /// Whether the normal equations are complete; `None` while it goes on.
    ///
    /// # Errors
    /// Why it ended early.
    #[must_use]
    pub const fn outcome(&self) -> Option<Result<&[Row; ROWS], Aborted>> {
        match self.phase {
            Phase::Done | Phase::Taken => Some(Ok(&self.sums.rows)),
            Phase::Aborted(why) => Some(Err(why)),
            _ => None,
        }
    }

    /// Current of one tick in which one of a magnitude was measured; `None` when it does not drive.
    pub fn update(&mut self, sound: &Sound, measured: Current, touching: bool) -> Option<Current> {
        let from_rest = sound.display.saturating_sub(self.rest.celsius());
        if touching {
            self.abort(Aborted::Finger);
        }
        if sound.sink > SINK_HOTTEST {
            self.abort(Aborted::Sink);
        }
        // Before that it may come from anywhere.
        if matches!(self.phase, Phase::Base { .. } | Phase::Pulses { .. })
            && from_rest.abs() > FARTHEST
        {
            self.abort(Aborted::Display);
        }
        let reading = i64::from(sound.display.to_bits());
        match self.phase {
            Phase::Taken | Phase::Aborted(_) => return None,
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
                let measured = measured_along(self.asked, measured);
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
                let Some((eighths, length)) = PULSES.get(pulse) else {
                    self.phase = Phase::Done;
                    return Some(self.current(0));
                };
                let current = self.current(*eighths);
                let measured = measured_along(self.asked, measured);
                if self.asked.abs() > COMPARED_FROM {
                    self.sums.compare(self.asked, measured);
                }
                let turned = direction(self.asked) - direction(self.current(0));
                let y = reading - self.base_reading;
                self.sums.take(y, measured, self.base_measured, turned);
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

/// Which way a current that is asked for flows, 1 if it cools; 0 if that is not certain.
fn direction(asked: Current) -> i64 {
    if asked.abs() < DIRECTED {
        0
    } else {
        asked.signum().to_num()
    }
}

/// A measured magnitude in the direction of the current that was asked for.
fn measured_along(asked: Current, measured: Current) -> Current {
    match direction(asked) {
        0 => asked,
        1.. => measured,
        _ => -measured,
    }
}
