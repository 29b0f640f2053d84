//! Lines to answers: what the host task does, for every finger of the device.

use core::array;

use thermal_commissioning::{Request, Service, StorageOrder, is_off, record};
use thermal_device::Finger;
use thermal_device::command::{self, Addressed, Command, Refused};
use thermal_settings::{Kept, Settings, StoredBytes};

use crate::address::address;
use crate::{Error, Parsed, Reply};

/// Executes a command on the station of one finger, or on all stations if there is no finger.
pub trait Execute<const FINGERS: usize>:
    FnMut(Option<Finger<FINGERS>>, Command) -> Executed
{
}

impl<const FINGERS: usize, F> Execute<FINGERS> for F where
    F: FnMut(Option<Finger<FINGERS>>, Command) -> Executed
{
}

/// What the stations answer.
pub type Executed = Result<Addressed<command::Reply>, Addressed<Refused>>;

/// The settings of as many fingers as the device has, ten at most, and what answers their lines.
#[derive(Clone, Debug)]
pub struct Desk<const FINGERS: usize> {
    fingers: [Service; FINGERS],
}

impl<const FINGERS: usize> Desk<FINGERS> {
    /// For a device with these settings.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            fingers: array::from_fn(|_| Service::new(settings)),
        }
    }

    /// For a device of this class that was commissioned so.
    #[must_use]
    pub fn restored(kept: &[Kept; FINGERS]) -> Self {
        Self {
            fingers: kept.each_ref().map(|kept| Service::new(kept.settings())),
        }
    }

    /// The bytes that an order stores.
    #[must_use]
    pub fn record(&self, order: StorageOrder) -> StoredBytes {
        record(order, &self.fingers)
    }

    /// Answers a line, for one finger or for all. `execute` is what the stations do with a [`Command`], in bounded and
    /// short time; all that takes longer is done here. A question to all is answered by the first; all obey an order,
    /// and what the first has found is told.
    ///
    /// # Errors
    /// Why the line is refused: nothing has changed for the finger that is named, the first of those that refuse.
    pub fn answer(
        &mut self,
        line: &str,
        mut execute: impl Execute<FINGERS>,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        let (addressed, rest) = address(line)?;
        let finger = addressed.map(Finger::number);
        let of = |said: Error| Addressed { finger, said };
        let [first, ..] = self.fingers.as_slice() else {
            return Err(of(Error::Missing("finger")));
        };
        match Parsed::parse(rest, first.settings()).map_err(of)? {
            Parsed::Identify => Ok(Addressed {
                finger,
                said: Reply::Identity {
                    fingers: FINGERS as u8,
                },
            }),
            Parsed::Station(said) => match execute(addressed, said) {
                Ok(reply) => Ok(reply.map(Reply::Station)),
                Err(refused) => Err(refused.map(Error::from)),
            },
            Parsed::Commissioning(request) => self.commission(request, addressed, execute),
            Parsed::Storage(order) => Self::accept(order, addressed, execute),
        }
    }

    /// Lets the sessions of one finger or of all do what a line of commissioning asks.
    fn commission(
        &mut self,
        request: Request,
        finger: Option<Finger<FINGERS>>,
        mut execute: impl Execute<FINGERS>,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        let finger = match request {
            // A query to all is answered by the first; nobody is named if there is one finger only.
            Request::Settings(_) | Request::Margins if FINGERS > 1 => {
                finger.or(Some(Finger::FIRST))
            }
            // Milliseconds of `f64` each, which the watchdog waits for once.
            Request::Point { .. } | Request::Tuned if finger.is_none() && FINGERS > 1 => {
                return Err(Addressed::device(Error::Missing("finger (as @0)")));
            }
            _ => finger,
        };
        let mut told = Ok(Addressed::device(thermal_commissioning::Reply::Done));
        for (one, service) in Finger::all().zip(&mut self.fingers) {
            if finger.is_some_and(|finger| finger != one) {
                continue;
            }
            let answered = service.answer(request.clone(), |command| {
                execute(Some(one), command)
                    .map(|reply| reply.said)
                    .map_err(|error| error.said)
            });
            // A finger that nobody has asked for is named if it is not the only one.
            let finger = finger.or((FINGERS > 1).then_some(one)).map(Finger::number);
            told = match (told, answered) {
                (Err(first), _) => Err(first),
                (Ok(_), Err(said)) => Err(Addressed {
                    finger,
                    said: Error::from(said),
                }),
                (
                    Ok(Addressed {
                        said: thermal_commissioning::Reply::Done,
                        ..
                    }),
                    Ok(said),
                ) if said != thermal_commissioning::Reply::Done => Ok(Addressed { finger, said }),
                (told, Ok(_)) => told,
            };
        }
        // Whoever is asked for by name answers by name.
        told.map(|reply| Addressed {
            finger: reply.finger.or(finger.map(Finger::number)),
            said: Reply::Commissioning(reply.said),
        })
    }

    /// Accepts an order if nobody can feel a device that starts anew: all bridges are off.
    fn accept(
        order: StorageOrder,
        finger: Option<Finger<FINGERS>>,
        mut execute: impl Execute<FINGERS>,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        if finger.is_some() && FINGERS > 1 {
            let said = Error::WholeDevice(order.name());
            return Err(Addressed {
                finger: finger.map(Finger::number),
                said,
            });
        }
        for one in Finger::all() {
            let status =
                execute(Some(one), Command::Status).map_err(|refused| refused.map(Error::from))?;
            let off =
                matches!(&status.said, command::Reply::Status(status) if is_off(status.state));
            if !off {
                let finger = (FINGERS > 1).then_some(one).or(finger);
                let said = Error::NeedsOff(order.name());
                return Err(Addressed {
                    finger: finger.map(Finger::number),
                    said,
                });
            }
        }
        Ok(Addressed {
            finger: finger.map(Finger::number),
            said: Reply::Restart(order),
        })
    }
}
