//! Answers to executed requests.

use core::fmt;

use thermal_commissioning::{SessionReply, StorageOrder};
use thermal_device::command;
use thermal_wire::answer::{
    AnswerLine, BoardStatus, DeviceAnswer as _, DeviceIdentity, PersonCodes, PersonReply,
};

/// Answer to a line that was executed; `Display` writes the answer to the host, `ok` and what is reported, without a
/// line ending and in at most [`ANSWER_MAX_BYTES`](super::ANSWER_MAX_BYTES) bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// Answer to the command `id`: name and version of the firmware, number of fingers, control ticks per second, scans of
    /// all sensors per second, version and capabilities of the protocol.
    Identity(DeviceIdentity),
    /// Answer to the command `board`.
    Board(BoardStatus),
    /// Answer to a command that was executed by the station (the control) of one finger, or by the stations of all
    /// fingers.
    Station(command::Reply),
    /// Answer to a request that was executed by the commissioning session of one finger, or by the sessions of all
    /// fingers. The session of a finger is its settings and calibration points.
    Commissioning(SessionReply),
    /// Answer to the commands `person` and `person enrol`.
    Person(PersonReply),
    /// Answer to the command `persons`.
    Persons(PersonCodes),
    /// The line was `save` or `forget`, and may be executed. The caller must now restart the device, which stores the
    /// settings and only then sends the answer, `ok` or an error.
    Restart(StorageOrder),
}

impl Reply {
    /// The line was executed, and there is nothing to report: the answer is `ok`.
    pub const DONE: Self = Self::Station(command::Reply::Done);
}

impl fmt::Display for Reply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = AnswerLine::new(f, "ok");
        self.write_values(&mut line);
        line.end()
    }
}

impl Reply {
    fn write_values(&self, line: &mut AnswerLine<'_, '_>) {
        match self {
            Self::Identity(identity) => identity.write_values(line),
            Self::Board(status) => status.write_values(line),
            Self::Station(reply) => reply.write_values(line),
            Self::Commissioning(reply) => reply.write_values(line),
            Self::Person(reply) => reply.write_values(line),
            Self::Persons(codes) => write_persons(codes, line),
            Self::Restart(_) => {}
        }
    }
}

/// Not inlined, so that only this answer takes stack for the codes.
#[inline(never)]
fn write_persons(codes: &PersonCodes, line: &mut AnswerLine<'_, '_>) {
    codes.write_values(line);
}
