//! The law with two degrees of freedom: a model of the plate says which current the target needs, and the loop only
//! sees where the plate differs from it.
//!
//! ```text
//!            +-------- plate, sensor (model) <--+
//!            | predicted                        |
//! measured - + -> PI -> feedback --+            | feed
//!                                  + -> limit --+--> current
//!  target -> missing at horizon ---+
//! ```
//!
//! The model gets what the limit leaves of its own wish, so it never promises more than the bridge gives: there is
//! nothing to wind up. The reading is compared with what the sensor, lag and all, should show. Where something else chooses
//! the current (a plain loop, a test, or nothing while the bridge is off) the model goes on beside it, so that no law
//! begins from a tile in motion that it takes for one at rest, and a tile that is not what the model says shows under each.
//!
//! A tile that is not what the model says shows in the residual: measured minus predicted, and what the loop adds to hold
//! that down. Without the second part a module that has lost its effect would hide at the limit of the current, where
//! feed and model are held back with the loop.

use contact_model::fixed_point::Celsius;
use fixed::traits::LossyFrom;

use super::lag::{Lag, Share};
use super::pi::Pi;
use super::plate::{Heat, Plate, Watt};
use super::tuned::Tuned;
use crate::drive::Current;

/// Time constant of the difference between plate and model that counts as the plate's, s.
const APART_LAG_S: f64 = 0.02;
/// What an ampere of feedback counts for in the residual, half a kelvin: enough to tell a weak module at the limit, and
/// little beside what the loop does about sound tiles.
const FEEDBACK_SHIFT: u32 = 1;
/// The model may have a quarter more than the limit: a tile that answers more than it does, for which the loop takes back, is
/// followed at the limit, too.
const MORE_SHIFT: u32 = 2;
/// Cooling is taken back from this sink temperature on, to none 2 K above it, before the guard trips: more current would warm the sink more
/// than cool the display.
const SINK_WARM: Celsius = Celsius::lit("39.5");
const SINK_SHIFT: u32 = 1;

/// The law's memory. It follows the tile whoever chooses the current.
#[derive(Clone, Debug)]
pub struct TwoDegrees {
    plate: Plate,
    sensor: Lag,
    /// Plate without model.
    apart: Lag,
    /// The loop that sees it, and what it makes of it.
    pi: Pi,
    feedback: Current,
    /// The most that a sound tile's residual is.
    most: Celsius,
    feed: Current,
    /// What it did to the plate.
    heat: Heat,
    /// Finger and sink of this tick.
    finger: Watt,
    sink: Celsius,
    limit: Current,
    running: bool,
    /// The next reading is of another scale, and the display where it was.
    rescaled: bool,
}

impl TwoDegrees {
    /// Within a limit; `f64`, once.
    #[must_use]
    pub fn new(tuned: Tuned, limit: Current) -> Self {
        Self {
            plate: tuned.plate,
            sensor: Lag::new(tuned.sensor),
            apart: Lag::new(Share::of(APART_LAG_S)),
            pi: Pi::new(tuned.pi, limit),
            feedback: Current::ZERO,
            most: tuned.residual,
            feed: Current::ZERO,
            heat: Heat::default(),
            finger: Watt::ZERO,
            sink: Celsius::ZERO,
            limit,
            running: false,
            rescaled: false,
        }
    }

    /// Goes on with another tile.
    pub fn retune(&mut self, tuned: &Tuned) {
        self.plate.become_like(&tuned.plate);
        self.sensor.retune(tuned.sensor);
        self.pi.retune(tuned.pi);
        self.most = tuned.residual;
    }

    /// Begins anew with the next reading, as the tile was not seen.
    pub const fn lose_sight(&mut self) {
        self.running = false;
    }

    /// The next reading is of another scale.
    pub const fn rescale(&mut self) {
        self.rescaled = true;
    }

    /// The plate, of the model.
    #[must_use]
    pub const fn plate(&self) -> &Plate {
        &self.plate
    }

    /// The display's surface as model and reading together have it; before the first reading, none.
    #[must_use]
    pub fn surface(&self) -> Option<Celsius> {
        self.running
            .then(|| self.plate.surface().saturating_add(self.apart.value()))
    }

    /// Whether the residual is more than a sound tile's; not before the first reading.
    #[must_use]
    pub fn strays(&self) -> bool {
        let added = Celsius::lossy_from(self.feedback >> FEEDBACK_SHIFT);
        self.running && self.apart.value().saturating_add(added).saturating_abs() > self.most
    }

    /// Takes a tick's reading, the sink, and heat from the finger.
    // Called from one place on most ticks: 35 cycles less.
    #[inline(always)]
    pub fn observe(&mut self, reading: Celsius, sink: Celsius, finger: Watt) {
        (self.sink, self.finger) = (sink, finger);
        if !self.running {
            self.heat = self.plate.start(reading, Current::ZERO, finger, sink);
            self.feed = Current::ZERO;
            self.sensor.set(reading);
            self.apart.set(Celsius::ZERO);
            self.pi.restart(Current::ZERO);
            (self.running, self.rescaled) = (true, false);
        }
        let mut apart = reading.saturating_sub(self.sensor.value());
        if self.rescaled {
            let by = apart.saturating_sub(self.apart.value());
            self.plate.shift(by);
            self.sensor.set(self.sensor.value().saturating_add(by));
            apart = self.apart.value();
            self.rescaled = false;
        }
        self.apart.follow(apart);
        self.feedback = self.pi.respond(apart);
    }

    /// Current for this tick; positive cools.
    #[must_use]
    pub fn wish(&self, target: Celsius) -> Current {
        let held = Heat {
            finger: self.finger,
            sink: self.sink,
            ..self.heat
        };
        let wish = self.feed.saturating_add(self.plate.missing(target, &held));
        wish.saturating_add(self.feedback)
            .min(self.cooling_limit(self.sink))
            .max(-self.limit)
    }

    /// Takes the current of this tick: the model gets what the loop has not added to it.
    // Called from one place on most ticks: 35 cycles less.
    #[inline(always)]
    pub fn go_on(&mut self, current: Current) {
        if !self.running {
            return;
        }
        let most = self.limit.saturating_add(self.limit >> MORE_SHIFT);
        self.feed = current.saturating_sub(self.feedback).min(most).max(-most);
        self.heat = self.plate.heat(self.feed, self.finger, self.sink);
        let before = self.plate.surface();
        self.plate.step(&self.heat);
        // The sensor sees the plate on its way.
        self.sensor
            .follow((before >> 1u32).saturating_add(self.plate.surface() >> 1u32));
    }

    fn cooling_limit(&self, sink: Celsius) -> Current {
        let over = sink.saturating_sub(SINK_WARM).max(Celsius::ZERO) >> SINK_SHIFT;
        let left = i64::from(
            Celsius::ONE
                .saturating_sub(over)
                .max(Celsius::ZERO)
                .to_bits(),
        );
        Current::from_bits(((i64::from(self.limit.to_bits()) * left) >> 22) as i32)
    }
}
