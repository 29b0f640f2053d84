//! Lines to answers: what the host task does, for every finger of the device.

use core::array;

use super::request::Request as Commissioning;
use super::service::Service;
use crate::protocol::{Addressed, Command, Error, Reply, Request, address};
use crate::settings::Settings;

/// The settings of as many fingers as the device has, ten at most, and what answers their lines.
#[derive(Clone, Debug)]
pub struct Desk<const FINGERS: usize> {
    pub(super) fingers: [Service; FINGERS],
}

impl<const FINGERS: usize> Desk<FINGERS> {
    /// For a device with these settings.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            fingers: array::from_fn(|_| Service::new(settings)),
        }
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
        mut execute: impl FnMut(Request) -> Result<Addressed<Reply>, Addressed<Error>>,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        let (finger, rest) = address(line, FINGERS)?;
        let of = |said: Error| Addressed { finger, said };
        let Some(request) = Commissioning::parse(rest) else {
            let [first, ..] = self.fingers.as_slice() else {
                return Err(of(Error::Missing("finger")));
            };
            let said = Command::parse(rest, first.settings()).map_err(of)?;
            return execute(Request { finger, said });
        };
        let request = request.map_err(of)?;
        if let Commissioning::Keep(order) = request {
            return self.accept(order, finger, execute);
        }
        let finger = match request {
            Commissioning::Settings(_) | Commissioning::Margins => finger.or(first_of(FINGERS)),
            // Milliseconds of `f64` each, which the watchdog waits for once.
            Commissioning::Point { .. } | Commissioning::Tuned
                if finger.is_none() && FINGERS > 1 =>
            {
                return Err(of(Error::Missing("finger (as @0)")));
            }
            _ => finger,
        };
        let mut told = Ok(Addressed::device(Reply::Done));
        for (index, service) in self.fingers.iter_mut().enumerate() {
            if finger.is_some_and(|one| usize::from(one) != index) {
                continue;
            }
            let station = Some(index as u8);
            let answered = service.answer(request.clone(), |said| {
                let request = Request {
                    finger: station,
                    said,
                };
                execute(request)
                    .map(|reply| reply.said)
                    .map_err(|error| error.said)
            });
            // A finger that nobody has asked for is named if it is not the only one.
            let finger = finger.or((FINGERS > 1).then_some(index as u8));
            told = match (told, answered) {
                (Err(first), _) => Err(first),
                (Ok(_), Err(said)) => Err(Addressed { finger, said }),
                (
                    Ok(Addressed {
                        said: Reply::Done, ..
                    }),
                    Ok(said),
                ) if said != Reply::Done => Ok(Addressed { finger, said }),
                (told, Ok(_)) => told,
            };
        }
        // Whoever is asked for by name answers by name.
        told.map(|reply| Addressed {
            finger: reply.finger.or(finger),
            said: reply.said,
        })
    }
}
/// Who answers a question to all; nobody is named if there is one finger only.
fn first_of(fingers: usize) -> Option<u8> {
    (fingers > 1).then_some(0)
}
