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
//! nothing to wind up. The reading is compared with what the sensor, lag and all, should show.
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
/// What an ampere of feedback counts for in the residual, a quarter of a kelvin: enough to tell a weak module at the limit, and
/// little beside what the loop does about sound tiles.
const FEEDBACK_SHIFT: u32 = 2;
/// Cooling is taken back from this sink temperature on, to none 2 K above it, before the guard trips: more current would warm the sink more
/// than cool the display.
const SINK_WARM: Celsius = Celsius::lit("39.5");
const SINK_SHIFT: u32 = 1;

/// The law's memory.
#[derive(Clone, Debug)]
pub struct TwoDegrees {
    plate: Plate,
    sensor: Lag,
    /// Plate without model.
    apart: Lag,
    /// What the loop makes of it.
    feedback: Current,
    /// The most that a sound tile's residual is.
    most: Celsius,
    feed: Current,
    /// What it did to the plate.
    heat: Heat,
    limit: Current,
    running: bool,
}

impl TwoDegrees {
    /// Within a limit; `f64`, once.
    #[must_use]
    pub fn new(tuned: Tuned, limit: Current) -> Self {
        Self {
            plate: tuned.plate,
            sensor: Lag::new(tuned.sensor),
            apart: Lag::new(Share::of(APART_LAG_S)),
            feedback: Current::ZERO,
            most: tuned.residual,
            feed: Current::ZERO,
            heat: Heat::default(),
            limit,
            running: false,
        }
    }

    /// Goes on with another tile.
    pub fn retune(&mut self, tuned: &Tuned) {
        self.plate.become_like(&tuned.plate);
        self.sensor.retune(tuned.sensor);
        self.most = tuned.residual;
    }

    /// Starts anew with the next [`Self::update`], from a tile through which this current flows.
    pub const fn restart(&mut self, current: Current) {
        self.running = false;
        self.feed = current;
    }

    /// The plate, of the model.
    #[must_use]
    pub const fn plate(&self) -> &Plate {
        &self.plate
    }

    /// The display's surface as model and reading together have it; before the first update, none.
    #[must_use]
    pub fn surface(&self) -> Option<Celsius> {
        self.running
            .then(|| self.plate.surface().saturating_add(self.apart.value()))
    }

    /// Whether the residual is more than a sound tile's; not before the first update.
    #[must_use]
    pub fn strays(&self) -> bool {
        let added = Celsius::lossy_from(self.feedback >> FEEDBACK_SHIFT);
        self.running && self.apart.value().saturating_add(added).saturating_abs() > self.most
    }

    /// Current for one tick; positive cools.
    pub fn update(
        &mut self,
        pi: &mut Pi,
        target: Celsius,
        reading: Celsius,
        sink: Celsius,
        finger: Watt,
    ) -> Current {
        if !self.running {
            self.heat = self.plate.start(reading, self.feed, finger, sink);
            self.sensor.set(reading);
            self.apart.set(Celsius::ZERO);
            pi.restart(Current::ZERO);
            self.running = true;
        }
        let apart = reading.saturating_sub(self.sensor.value());
        self.apart.follow(apart);
        let feedback = pi.respond(apart);
        self.feedback = feedback;
        let held = Heat {
            finger,
            sink,
            ..self.heat
        };
        let wish = self.feed.saturating_add(self.plate.missing(target, &held));
        let current = wish
            .saturating_add(feedback)
            .min(self.cooling_limit(sink))
            .max(-self.limit);
        self.feed = current.saturating_sub(feedback).min(self.limit).max(-self.limit);
        self.heat = self.plate.heat(self.feed, finger, sink);
        let before = self.plate.surface();
        self.plate.step(&self.heat);
        // The sensor sees the plate on its way.
        self.sensor
            .follow((before >> 1u32).saturating_add(self.plate.surface() >> 1u32));
        current
    }

    fn cooling_limit(&self, sink: Celsius) -> Current {
        let over = sink.saturating_sub(SINK_WARM).max(Celsius::ZERO) >> SINK_SHIFT;
        let left = i64::from(Celsius::ONE.saturating_sub(over).max(Celsius::ZERO).to_bits());
        Current::from_bits(((i64::from(self.limit.to_bits()) * left) >> 22) as i32)
    }
}
