//! The stations of all fingers, and lines that are for one or all of them.

use core::array;

use crate::Station;
use crate::command::{Addressed, Command, Refused, Reply};
use crate::drive::Outputs;
use crate::safety::{Cause, Dose, Fault};
use crate::sense::Samples;
use crate::telemetry::Telemetry;
use thermal_settings::{Kept, Settings};

/// As many stations as the device has fingers, ten at most. They share nothing.
#[derive(Clone, Debug)]
pub struct Device<const FINGERS: usize> {
    stations: [Station; FINGERS],
}

impl<const FINGERS: usize> Device<FINGERS> {
    /// Stations that are off. `f64` in software, once for all fingers.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        Self::after(None, settings)
    }

    /// The same after a reset, tripped by what was the cause of it.
    #[must_use]
    #[inline(never)]
    pub fn after(cause: Option<Cause>, settings: &Settings) -> Self {
        let mut one = Station::new(settings);
        if let Some(cause) = cause {
            one.latch(cause);
        }
        Self {
            stations: array::from_fn(|_| one.clone()),
        }
    }

    /// Reads and controls by what was kept. `f64` in software, once for each finger.
    #[inline(never)]
    pub fn restore(&mut self, kept: &[Kept; FINGERS]) {
        for (station, kept) in self.stations.iter_mut().zip(kept) {
            station.restore(&kept.settings());
        }
    }

    /// The dose of a finger so far, counted modulo `FINGERS`.
    #[must_use]
    pub const fn dose(&self, finger: usize) -> &Dose {
        self.stations[finger % FINGERS].dose()
    }

    /// Goes on from the dose that a finger had before the start, counted modulo `FINGERS`.
    pub const fn resume(&mut self, finger: usize, dose: Dose) {
        self.stations[finger % FINGERS].resume(dose);
    }

    /// One control tick of a finger, `finger` counted modulo `FINGERS`.
    pub fn step(&mut self, finger: usize, samples: &Samples) -> Outputs {
        self.stations[finger % FINGERS].step(samples)
    }

    /// Trips all fingers for a reason that samples do not show.
    pub fn trip(&mut self, fault: Fault) {
        self.stations
            .iter_mut()
            .for_each(|station| station.trip(fault));
    }

    /// A fault is latched at a finger, counted modulo `FINGERS`.
    #[must_use]
    pub const fn is_tripped(&self, finger: usize) -> bool {
        self.stations[finger % FINGERS].is_tripped()
    }

    /// Why the finger that has been tripped for longest is.
    #[must_use]
    pub fn tripped(&self) -> Option<&Cause> {
        let tripped = self.stations.iter().filter(|station| station.is_tripped());
        tripped.min_by_key(|station| station.tripped_at())?.cause()
    }

    /// The host is there.
    pub fn hear(&mut self) {
        self.stations.iter_mut().for_each(Station::hear);
    }

    /// Telemetry of a finger's last tick, if it is due.
    #[must_use]
    pub fn telemetry(&self, finger: usize) -> Option<Addressed<Telemetry>> {
        let finger = finger % FINGERS;
        let said = self.stations[finger].telemetry()?;
        Some(Addressed {
            finger: Self::name(finger),
            said,
        })
    }

    /// How a finger is called when nobody has asked for it: not at all if it is the only one.
    fn name(finger: usize) -> Option<u8> {
        (FINGERS > 1).then_some(finger as u8)
    }

    /// Executes a line, in bounded and short time: for one finger, or for all. A question to all is answered by
    /// the first. Who has nothing to clear obeys `clear` with the others.
    ///
    /// # Errors
    /// The command does not fit the state of a finger; of those, the first. The others have obeyed.
    pub fn execute(
        &mut self,
        request: Addressed<Command>,
    ) -> Result<Addressed<Reply>, Addressed<Refused>> {
        let Addressed {
            finger,
            said: command,
        } = request;
        if let Some(one) = finger {
            return match self.stations[usize::from(one) % FINGERS].execute(command) {
                Ok(said) => Ok(Addressed { finger, said }),
                Err(said) => Err(Addressed { finger, said }),
            };
        }
        let (mut refused, mut healthy, mut obeyed) = (None, None, false);
        for (finger, station) in self.stations.iter_mut().enumerate() {
            let finger = Self::name(finger);
            match station.execute(command) {
                Ok(Reply::Done) => obeyed = true,
                Ok(said) => return Ok(Addressed { finger, said }),
                Err(said @ Refused::NothingToClear) => {
                    healthy = healthy.or(Some(Addressed { finger, said }))
                }
                Err(said) => refused = refused.or(Some(Addressed { finger, said })),
            }
        }
        let refused = refused.or(healthy.filter(|_| !obeyed));
        refused.map_or(Ok(Addressed::device(Reply::Done)), Err)
    }
}
