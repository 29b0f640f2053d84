//! Answers to executed requests.

use core::fmt;

use thermal_commissioning::{SessionReply, StorageOrder};
use thermal_device::command;
use thermal_wire::Argument as _;
use thermal_wire::answer::{
    BoardStatus, DeviceAnswer as _, DeviceIdentity, PersonCodes, PersonReply,
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
        match self {
            Self::Identity(identity) => identity.write_answer(f),
            Self::Board(status) => status.write_answer(f),
            Self::Station(reply) => write_station_reply(f, reply),
            Self::Commissioning(reply) => write_session_reply(f, reply),
            Self::Person(reply) => reply.write_answer(f),
            Self::Persons(codes) => codes.write_answer(f),
            Self::Restart(_) => f.write_str("ok"),
        }
    }
}

fn write_station_reply(f: &mut fmt::Formatter<'_>, reply: &command::Reply) -> fmt::Result {
    match reply {
        command::Reply::Status(status) => status.write_answer(f),
        command::Reply::Law(law) => law.write_answer(f),
        command::Reply::Cause(cause) => cause.write_answer(f),
        command::Reply::SelfTest(report) => report.write_answer(f),
        command::Reply::Raw(samples) => samples.write_answer(f),
        command::Reply::Finger(finger) => finger.write_answer(f),
        command::Reply::ContactLaw(law) => law.write_answer(f),
        // No line from the host requests a material's properties. Averages, normal equations and flux are evaluated by commissioning
        // sessions, persons by the handler.
        command::Reply::Done
        | command::Reply::Material(_)
        | command::Reply::Average(_)
        | command::Reply::Flux(_)
        | command::Reply::Person(_)
        | command::Reply::FluxZero(_)
        | command::Reply::NormalEquation(_) => f.write_str("ok"),
    }
}

fn write_session_reply(f: &mut fmt::Formatter<'_>, reply: &SessionReply) -> fmt::Result {
    match reply {
        SessionReply::Done => f.write_str("ok"),
        SessionReply::Tile(tile) => tile.write_answer(f),
        SessionReply::PointAdded(fit) => fit.write_answer(f),
        SessionReply::Flux(flux) => flux.write_answer(f),
        SessionReply::DisplaySurface(surface) => surface.write_answer(f),
        SessionReply::SettingsLines(count) => count.write_answer(f),
        // The host can restore this part later by sending the line that follows `ok`.
        SessionReply::Setting(setting) => {
            f.write_str("ok set")?;
            setting.write(f)
        }
    }
}
