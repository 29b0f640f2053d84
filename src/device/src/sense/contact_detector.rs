//! Detection of a finger's contact from the force.
//!
//! A landing is a step of the force. On a stiff load cell it is found in two ticks. A stack that rests on a soft cell rings, and its fan
//! shakes it: such a force swings below its zero, which no finger makes it do. While it has done so lately, a force counts only if it
//! lasts longer than half a period of the slowest oscillation, and so does its end. A drift of the zero that a long contact has
//! hidden is found after the finger has lifted, because a force that is left is then steady.

use contact_model::fixed_point::Force;

/// Smallest force, N, that counts as off zero: a finger may be landing. Noise is smaller: 0.7 to 1.2 counts RMS a
/// conversion make about 0.6 to 1 mN RMS in the force of a tick.
const NONZERO_FORCE_MIN: Force = Force::lit("0.003");
/// Smallest force, N, at which a contact begins.
const CONTACT_BEGIN_FORCE: Force = Force::lit("0.02");
/// Force, N, below which a contact ends. It is half of the force at which a contact begins (hysteresis), so that noise
/// does not end a light contact.
const CONTACT_END_FORCE: Force = Force::lit("0.01");
/// Ticks of 1 ms in a row, 2, in which the force must be off zero (3 mN or more) before a contact begins, so that one noisy tick begins
/// none.
pub const CONTACT_DEBOUNCE_TICKS: u32 = 2;
/// The same while the force oscillates: half a period of 30 Hz, the slowest fan, is 17 ticks, and of 41 Hz, the softest cell, 12.
const OSCILLATION_DEBOUNCE_TICKS: u32 = 18;
/// Ticks for which an oscillation counts since the force was below zero last: a period of 30 Hz and a few more. It counts at the start,
/// too, when the zero is not known yet.
const OSCILLATION_HOLD_TICKS: u32 = 40;
/// Ticks in a row in which the force must be within 8 mN below its zero and 10 mN above it before a contact ends. An oscillation that
/// follows from a finger that presses less all at once turns there for no more than 5 ms, if the finger still presses with
/// 0.1 N at least.
const LIFT_TICKS: u32 = 6;
/// Score of an oscillating force at which a contact ends: each tick below 10 mN adds two, each other one takes one away. A cell that
/// swings about zero gains 0.5 a tick; one that swings about the force of a finger gains only while it swings more than twice as far.
const OSCILLATION_RELEASE_SCORE: u32 = 60;
/// Ticks in a row without a finger in which the force must be below zero before its zero is taken anew; longer than half a period of
/// every oscillation.
const ZERO_TOO_HIGH_TICKS: u32 = 32;
/// Upper limit, ticks of 1 ms, of the counted delay from the tick in which the force left zero to the detection of a
/// contact. The estimate of the finger dates the landing back by the counted delay. A force that takes longer to rise
/// does not show when the finger landed.
const COUNTED_DETECTION_DELAY_MAX_TICKS: u32 = 32;

/// Detects from the force whether a finger touches the display, with debouncing and hysteresis, and counts for how many
/// ticks the force had been off zero when it detected the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactDetector {
    touching: bool,
    /// Whether no counter counts: the mean tick on granite then takes 11 of 3578 cycles less, the longest 105 of 4765 more.
    is_settled: bool,
    /// Number of ticks of 1 ms in a row in which the force has been off zero (3 mN or more), up to
    /// [`COUNTED_DETECTION_DELAY_MAX_TICKS`]. During a contact it keeps its value from the contact's detection.
    off_zero_ticks: u32,
    /// Ticks for which an oscillation still counts.
    oscillation_ticks: u32,
    /// Number of ticks in a row with a force below zero.
    below_zero_ticks: u32,
    /// Score towards [`OSCILLATION_RELEASE_SCORE`].
    release_score: u32,
    /// Number of ticks in a row, during a contact, in which the force has been below [`CONTACT_END_FORCE`] and not below zero.
    lifted_ticks: u32,
    residue: ResidualForce,
}

impl Default for ContactDetector {
    fn default() -> Self {
        Self {
            touching: false,
            is_settled: false,
            off_zero_ticks: 0,
            oscillation_ticks: OSCILLATION_HOLD_TICKS,
            below_zero_ticks: 0,
            release_score: 0,
            lifted_ticks: 0,
            residue: ResidualForce::default(),
        }
    }
}

impl ContactDetector {
    /// Decides from the number of this tick, its force, N, and whether the signal is below its zero, whether a finger touches the
    /// display. To be called in each tick with valid readings; other ticks do not count. Returns whether the force sensor's zero
    /// must be taken anew, because the force without a finger is not zero.
    ///
    /// A contact begins at 20 mN or more, at the earliest in the second tick in a row with 3 mN or more. It ends in the sixth tick in a
    /// row below 10 mN. While the force oscillates, it begins in the 18th tick, and ends when the force has swung about zero for 0.1 s.
    pub fn update_contact(&mut self, tick: u32, force: Force, is_below_zero: bool) -> bool {
        let presses = force >= if self.touching { CONTACT_END_FORCE } else { NONZERO_FORCE_MIN };
        if self.is_settled && presses == self.touching && !is_below_zero {
            return tick.is_multiple_of(LOOK_TICKS) && self.ends_with_residue(force);
        }
        let zero_has_moved = self.update_unsettled(force, is_below_zero);
        let counters =
            [self.oscillation_ticks, self.below_zero_ticks, self.release_score, self.lifted_ticks];
        self.is_settled = counters == [0; 4] && (self.touching || self.off_zero_ticks == 0);
        zero_has_moved
    }

    /// Ends a contact of which a drift of the zero has left this force, N, and returns whether it did.
    #[cold]
    #[inline(never)]
    fn ends_with_residue(&mut self, force: Force) -> bool {
        let is_residue = self.touching && self.residue.look(force);
        if is_residue {
            *self = Self::default();
        }
        is_residue
    }

    /// [`Self::update_contact`] in a tick in which a counter counts.
    #[cold]
    #[inline(never)]
    fn update_unsettled(&mut self, force: Force, is_below_zero: bool) -> bool {
        self.oscillation_ticks = if is_below_zero {
            OSCILLATION_HOLD_TICKS
        } else {
            self.oscillation_ticks.saturating_sub(1)
        };
        if self.touching {
            let low = force < CONTACT_END_FORCE;
            self.release_score =
                if low { self.release_score + 2 } else { self.release_score.saturating_sub(1) };
            self.lifted_ticks = if low && !is_below_zero { self.lifted_ticks + 1 } else { 0 };
            if self.lifted_ticks >= LIFT_TICKS || self.release_score >= OSCILLATION_RELEASE_SCORE {
                *self = Self { oscillation_ticks: self.oscillation_ticks, ..Self::default() };
            }
            return false;
        }
        self.off_zero_ticks = if force >= NONZERO_FORCE_MIN {
            (self.off_zero_ticks + 1).min(COUNTED_DETECTION_DELAY_MAX_TICKS)
        } else {
            0
        };
        self.touching = self.is_force_nonzero_debounced() && force >= CONTACT_BEGIN_FORCE;
        self.below_zero_ticks = if is_below_zero { self.below_zero_ticks + 1 } else { 0 };
        let zero_is_too_high = self.below_zero_ticks >= ZERO_TOO_HIGH_TICKS;
        if zero_is_too_high {
            self.below_zero_ticks = 0;
        }
        zero_is_too_high
    }

    /// Whether a finger touches the display, after debouncing, as of the last call of [`Self::update_contact`].
    pub const fn touching(&self) -> bool {
        self.touching
    }

    /// Whether `force`, N, that of the last call of [`Self::update_contact`], may be that of a finger: 20 mN or more, or off zero, 3 mN
    /// or more, for longer than half a period of an oscillation; and not oscillating. While it is without a contact, the zero of the
    /// force sensor is tracked with a time constant of 16 s instead of 0.26 s. If the zero followed the upper half of a small vibration
    /// slowly and the lower one quickly, it would settle near the lowest force, and the rest would look like a finger.
    pub fn may_be_finger(&self, force: Force) -> bool {
        self.off_zero_ticks > 0
            && self.oscillation_ticks == 0
            && (force >= CONTACT_BEGIN_FORCE || self.off_zero_ticks >= OSCILLATION_DEBOUNCE_TICKS)
    }

    /// Whether a finger touches, or the force has been off zero (3 mN or more) for longer than half a period of an oscillation: a
    /// finger may be landing. The self-test treats this like a contact, and measures its baseline again.
    pub const fn presses_steadily(&self) -> bool {
        self.touching || self.off_zero_ticks >= OSCILLATION_DEBOUNCE_TICKS
    }

    /// Whether the force has been off zero (3 mN or more) for at least two ticks in a row, or 18 if it oscillates, which noise seldom
    /// causes: a finger may be landing. Stays true during a contact.
    pub const fn is_force_nonzero_debounced(&self) -> bool {
        let debounce_ticks = if self.oscillation_ticks == 0 {
            CONTACT_DEBOUNCE_TICKS
        } else {
            OSCILLATION_DEBOUNCE_TICKS
        };
        self.touching || self.off_zero_ticks >= debounce_ticks
    }

    /// Delay of the contact's detection, ticks of 1 ms, 2 to 32: for how long the force had been off zero when the
    /// contact was detected. By this delay the estimate of the finger dates the landing back. Meaningful only while a
    /// finger touches.
    pub const fn detection_delay_ticks(&self) -> u32 {
        self.off_zero_ticks
    }
}

/// Ticks from one look at the force to the next; a power of two.
const LOOK_TICKS: u32 = 128;
/// Force, N, by which a finger that lifts lowers the force from one look to the next at least.
const DROP_MIN: Force = Force::lit("0.02");
/// Largest difference, N, between looks at a steady force; the noise is 1 mN RMS. A finger's tremor is larger.
const STEADY_WITHIN: Force = Force::lit("0.003");
/// Number of steady looks in a row, half a second, after which a force that is left is none of a finger.
const STEADY_LOOKS: u32 = 4;
/// Largest drift of the force sensor's zero: 2 mN/s, N per look, and 0.15 N in all. 10 mN more are no contact anyway.
const DRIFT_PER_LOOK: Force = Force::lit("0.000256");
const DRIFT_MAX: Force = Force::lit("0.16");

/// Finds the force that a drift of the zero leaves after a finger has lifted from a long contact: the force has dropped, stays
/// steady, and is no more than the zero can have drifted in the time of the contact. A light finger that never dropped keeps its
/// contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ResidualForce {
    /// The last three looks, N, the last one first.
    looks: [Force; 3],
    /// How far the zero can have drifted, N.
    drift: Force,
    has_dropped: bool,
    steady_looks: u32,
}

impl Default for ResidualForce {
    fn default() -> Self {
        Self {
            looks: [Force::ZERO; 3],
            drift: CONTACT_END_FORCE,
            has_dropped: false,
            steady_looks: 0,
        }
    }
}

impl ResidualForce {
    /// Looks at the force, N, of a contact, and returns whether it is a residue.
    fn look(&mut self, force: Force) -> bool {
        let [last, before, first] = self.looks;
        self.looks = [force, last, before];
        self.drift = self.drift.saturating_add(DRIFT_PER_LOOK).min(DRIFT_MAX);
        // Below all three, because the force of a soft cell still rings after a landing.
        self.has_dropped |= last.min(before).min(first).saturating_sub(force) >= DROP_MIN;
        let is_steady = force.abs_diff(last) <= STEADY_WITHIN;
        self.steady_looks = if is_steady { self.steady_looks + 1 } else { 0 };
        self.has_dropped && self.steady_looks >= STEADY_LOOKS && force <= self.drift
    }
}

#[cfg(test)]
mod tests;
