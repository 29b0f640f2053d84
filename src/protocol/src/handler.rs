//! Lines to answers: what the host task does, for every finger of the device.

use core::array;

use thermal_commissioning::{Request, Service, StorageOrder, is_off, record};
use thermal_device::command::{self, Addressed, Command, Refused};
use thermal_settings::{Kept, Settings, StoredBytes};

use crate::address::address;
use crate::{Error, Parsed, Reply};

/// Executes a command on the stations: for one finger, or for all.
pub trait Execute: FnMut(Addressed<Command>) -> Executed {}

impl<F: FnMut(Addressed<Command>) -> Executed> Execute for F {}

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
        mut execute: impl Execute,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        let (finger, rest) = address(line, FINGERS)?;
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
            Parsed::Station(said) => match execute(Addressed { finger, said }) {
                Ok(reply) => Ok(reply.map(Reply::Station)),
                Err(refused) => Err(refused.map(Error::from)),
            },
            Parsed::Commissioning(request) => self.commission(request, finger, execute),
            Parsed::Storage(order) => Self::accept(order, finger, execute),
        }
    }

    /// Lets the sessions of one finger or of all do what a line of commissioning asks.
    fn commission(
        &mut self,
        request: Request,
        finger: Option<u8>,
        mut execute: impl Execute,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        let finger = match request {
            Request::Settings(_) | Request::Margins => finger.or(first_of(FINGERS)),
            // Milliseconds of `f64` each, which the watchdog waits for once.
            Request::Point { .. } | Request::Tuned if finger.is_none() && FINGERS > 1 => {
                return Err(Addressed {
                    finger,
                    said: Error::Missing("finger (as @0)"),
                });
            }
            _ => finger,
        };
        let mut told = Ok(Addressed::device(thermal_commissioning::Reply::Done));
        for (index, service) in self.fingers.iter_mut().enumerate() {
            if finger.is_some_and(|one| usize::from(one) != index) {
                continue;
            }
            let station = Some(index as u8);
            let answered = service.answer(request.clone(), |said| {
                execute(Addressed {
                    finger: station,
                    said,
                })
                .map(|reply| reply.said)
                .map_err(|error| error.said)
            });
            // A finger that nobody has asked for is named if it is not the only one.
            let finger = finger.or((FINGERS > 1).then_some(index as u8));
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
            finger: reply.finger.or(finger),
            said: Reply::Commissioning(reply.said),
        })
    }

    /// Accepts an order if nobody can feel a device that starts anew: all bridges are off.
    fn accept(
        order: StorageOrder,
        finger: Option<u8>,
        mut execute: impl Execute,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        if finger.is_some() && FINGERS > 1 {
            let said = Error::WholeDevice(order.name());
            return Err(Addressed { finger, said });
        }
        for one in 0..FINGERS as u8 {
            let status = execute(Addressed {
                finger: Some(one),
                said: Command::Status,
            })
            .map_err(|refused| refused.map(Error::from))?;
            let off =
                matches!(&status.said, command::Reply::Status(status) if is_off(status.state));
            if !off {
                let finger = (FINGERS > 1).then_some(one).or(finger);
                let said = Error::NeedsOff(order.name());
                return Err(Addressed { finger, said });
            }
        }
        Ok(Addressed {
            finger,
            said: Reply::Restart(order),
        })
    }
}

/// Who answers a question to all; nobody is named if there is one finger only.
fn first_of(fingers: usize) -> Option<u8> {
    (fingers > 1).then_some(0)
}
