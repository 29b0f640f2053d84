//! Execution of the host's lines for all fingers of a device.

use core::array;

use thermal_commissioning::{CommissioningSession, SessionReply, SessionRequest, StorageOrder};
use thermal_device::command::{self, Addressed, Command, Refused};
use thermal_device::{Finger, StateName};
use thermal_settings::{Settings, SettingsRecord, StoredSettings, encode};

use crate::address::address;
use crate::{Error, Reply, Request};

/// Executes a command on the station of one finger, or on all stations if there is no finger, in bounded and short time.
pub trait Execute<const FINGERS: usize>:
    FnMut(Option<Finger<FINGERS>>, Command) -> ExecutionResult
{
}

impl<const FINGERS: usize, F> Execute<FINGERS> for F where
    F: FnMut(Option<Finger<FINGERS>>, Command) -> ExecutionResult
{
}

/// The reply of the stations.
pub type ExecutionResult = Result<Addressed<command::Reply>, Addressed<Refused>>;

/// Answers the host's lines, by the commissioning sessions of all fingers, one to ten, and by their stations.
#[derive(Clone, Debug)]
pub struct CommandHandler<const FINGERS: usize> {
    sessions: [CommissioningSession; FINGERS],
}

impl<const FINGERS: usize> CommandHandler<FINGERS> {
    /// A handler for a device whose fingers all have these settings.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            sessions: array::from_fn(|_| CommissioningSession::new(settings)),
        }
    }

    /// A handler for a device with stored settings.
    #[must_use]
    pub fn from_stored(stored: &[StoredSettings; FINGERS]) -> Self {
        let session = |stored: &StoredSettings| CommissioningSession::new(stored.settings());
        Self {
            sessions: stored.each_ref().map(session),
        }
    }

    /// The record that an order stores.
    #[must_use]
    pub fn settings_record(&self, order: StorageOrder) -> SettingsRecord {
        match order {
            StorageOrder::Save => {
                let sessions = self.sessions.each_ref();
                let stored = sessions.map(|one| StoredSettings::from_settings(one.settings()));
                encode(Some(&stored))
            }
            StorageOrder::Forget => encode::<FINGERS>(None),
        }
    }

    /// Answers a line for one finger or for all. Time-consuming computations are done here, outside of `execute`, which
    /// runs with the control tick locked out. If a line addresses all fingers, a query is answered by the first one, and
    /// a change is made by each.
    ///
    /// # Errors
    /// The line is rejected. The error names the first finger that rejects it, which is unchanged; the other fingers have
    /// executed the line.
    pub fn answer(
        &mut self,
        line: &str,
        mut execute: impl Execute<FINGERS>,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        const { assert!(FINGERS > 0 && FINGERS <= 10) };
        let (finger, line) = address(line)?;
        let number = finger.map(Finger::number);
        let addressed = |content| Addressed {
            finger: number,
            content,
        };
        let request =
            Request::parse(line, self.sessions[0].settings()).map_err(|content| Addressed {
                finger: number,
                content,
            })?;
        match request {
            Request::Identify => Ok(addressed(Reply::Identity {
                fingers: FINGERS as u8,
            })),
            Request::Station(command) => match execute(finger, command) {
                Ok(reply) => Ok(reply.map_content(Reply::Station)),
                Err(refused) => Err(refused.map_content(Error::from)),
            },
            Request::Commissioning(request) => self.commission(request, finger, execute),
            Request::Storage(order) => match Self::reject_storage(order, finger, execute) {
                None => Ok(addressed(Reply::Restart(order))),
                Some(error) => Err(error),
            },
        }
    }

    /// Executes a request in the session of one finger or of all.
    fn commission(
        &mut self,
        request: SessionRequest,
        finger: Option<Finger<FINGERS>>,
        mut execute: impl Execute<FINGERS>,
    ) -> Result<Addressed<Reply>, Addressed<Error>> {
        let finger = match request {
            SessionRequest::CountSettingsLines
            | SessionRequest::SettingsLine(_)
            | SessionRequest::Margins
                if FINGERS > 1 =>
            {
                finger.or(Some(Finger::FIRST))
            }
            // Each takes milliseconds of `f64`: for all fingers at once it would exceed the watchdog's period.
            SessionRequest::AddPoint { .. } | SessionRequest::TuneResult
                if finger.is_none() && FINGERS > 1 =>
            {
                return Err(Addressed::from_whole_device(Error::Missing(
                    "finger (as @0)",
                )));
            }
            _ => finger,
        };
        let (mut reply, mut first_error) = (SessionReply::Done, None);
        for (one, session) in Finger::all().zip(&mut self.sessions) {
            if finger.is_some_and(|finger| finger != one) {
                continue;
            }
            let answer = session.answer(request.clone(), |command| {
                match execute(Some(one), command) {
                    Ok(reply) => Ok(reply.content),
                    Err(refused) => Err(refused.content),
                }
            });
            match answer {
                // A request to several fingers has no other reply than `Done`.
                Ok(answer) => reply = answer,
                Err(error) => {
                    first_error.get_or_insert(Addressed {
                        finger: finger.map(Finger::number).or(one.reply_address()),
                        content: Error::from(error),
                    });
                }
            }
        }
        let content = Reply::Commissioning(reply);
        let finger = finger.map(Finger::number);
        first_error.map_or(Ok(Addressed { finger, content }), Err)
    }

    /// Rejects an order for a single finger, and while any bridge is driven: the device restarts to store the settings,
    /// which a user must not feel.
    fn reject_storage(
        order: StorageOrder,
        finger: Option<Finger<FINGERS>>,
        mut execute: impl Execute<FINGERS>,
    ) -> Option<Addressed<Error>> {
        if finger.is_some() && FINGERS > 1 {
            let content = Error::WholeDevice(order.name());
            let finger = finger.map(Finger::number);
            return Some(Addressed { finger, content });
        }
        for one in Finger::all() {
            match execute(Some(one), Command::Status) {
                Err(refused) => return Some(refused.map_content(Error::from)),
                Ok(Addressed {
                    content: command::Reply::Status(status),
                    ..
                }) if matches!(
                    status.state,
                    StateName::Off | StateName::Ready | StateName::Tripped(_)
                ) => {}
                Ok(_) => {
                    return Some(Addressed {
                        finger: one.reply_address().or(finger.map(Finger::number)),
                        content: Error::NeedsOff(order.name()),
                    });
                }
            }
        }
        None
    }
}
