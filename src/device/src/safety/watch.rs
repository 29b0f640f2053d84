//! Faults that show only over time.

use contact_model::fixed_point::Celsius;

use super::dose::Dose;
use super::electrical::Electrical;
use super::frozen::Frozen;
use super::jump::Jump;
use super::lasting::Lasting;
use super::limits::Sound;
use super::response::Response;
use super::{Fault, Setpoint};
use crate::drive::Current;
use crate::sense::{Readings, Samples};

/// Difference of the display's thermistors that counts, and for how many ticks. Ones whose lags differ by 0.1 s are 1.6 K
/// apart while the bridge at its limit moves a bare display.
const APART: Celsius = Celsius::lit("3");
const APART_TICKS: u8 = 40;
/// Room above skin that counts, and for how many ticks: who wears it is warmer than the room, cold hands of 17 °C in a warm
/// one aside, or there is nobody and both are the same.
const ROOM_ABOVE: Celsius = Celsius::lit("8");
const ROOM_TICKS: u8 = 40;
/// For how many ticks a display that is unlike its model counts.
const UNLIKE_TICKS: u8 = 30;
/// A host that streams is silent for no longer, ticks.
const SILENT_TICKS: u16 = 2000;

/// What the bridge did in the tick before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Before {
    /// Current asked for.
    pub asked: Current,
    /// Where the display was to be; none while the bridge was off, or the device tested itself.
    pub setpoint: Option<Setpoint>,
}

/// What the guard remembers from tick to tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Watch {
    frozen: Frozen,
    jump: Jump,
    apart: Lasting,
    room: Lasting,
    electrical: Electrical,
    response: Response,
    unlike: Lasting,
    dose: Dose,
    silent_ticks: u16,
}

impl Watch {
    /// Something has come from the host.
    pub const fn hear(&mut self) {
        self.silent_ticks = 0;
    }

    /// The dose so far.
    #[must_use]
    pub const fn dose(&self) -> &Dose {
        &self.dose
    }

    /// Goes on from a dose.
    pub const fn resume(&mut self, dose: Dose) {
        self.dose = dose;
    }

    /// Takes the samples of one tick.
    ///
    /// # Errors
    /// A signal that stands still.
    pub fn samples(&mut self, samples: &Samples) -> Result<(), Fault> {
        self.frozen.check(samples)
    }

    /// Takes what the display's thermistors read, if anything, whatever else is wrong: the dose goes on.
    ///
    /// # Errors
    /// The skin may have had too much heat.
    pub fn heat(&mut self, readings: &Readings) -> Result<(), Fault> {
        let both = [readings.display, readings.display_check];
        self.dose.check(|| both.into_iter().flatten().max())
    }

    /// Takes one tick in which no level was wrong; `measured` is the current, `unlike_model` whether the law's residual is
    /// beyond that of a sound tile, `streams` whether a host listens.
    ///
    /// # Errors
    /// A fault that has lasted. All are looked at, and the first of this order is named.
    pub fn check(
        &mut self,
        sound: &Sound,
        measured: Current,
        before: &Before,
        unlike_model: bool,
        streams: bool,
    ) -> Result<(), Fault> {
        let above = before.setpoint.map_or(Celsius::ZERO, |setpoint| {
            sound.display.saturating_sub(setpoint.celsius())
        });
        let apart = sound.display.saturating_sub(sound.check).saturating_abs() > APART;
        let room = sound.room.saturating_sub(sound.skin) > ROOM_ABOVE;
        let apart = named(self.apart.has(apart, APART_TICKS), Fault::DisplaysApart);
        let room = named(self.room.has(room, ROOM_TICKS), Fault::RoomAboveSkin);
        let unlike = self.unlike.has(unlike_model, UNLIKE_TICKS);
        let unlike = named(unlike, Fault::UnlikeModel);
        let listens = streams && before.setpoint.is_some();
        self.silent_ticks = if listens {
            self.silent_ticks.saturating_add(1)
        } else {
            0
        };
        self.jump
            .check(sound)
            .and(apart)
            .and(self.electrical.check(before.asked, measured))
            .and(self.response.check(before.asked, sound.display, above))
            .and(unlike)
            .and(room)
            .and(named(self.silent_ticks >= SILENT_TICKS, Fault::HostSilent))
    }

    /// What moved while something was wrong counts as no jump.
    pub fn forget_motion(&mut self) {
        self.jump = Jump::default();
        self.response = Response::default();
    }
}

/// A fault that is there or not.
const fn named(there: bool, fault: Fault) -> Result<(), Fault> {
    if there { Err(fault) } else { Ok(()) }
}
