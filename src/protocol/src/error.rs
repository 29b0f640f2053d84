//! Error messages: why a line was rejected.

use core::fmt;

use contact_model::contact_law::ContactLaw;
use contact_model::decimal::{Rounded, Shortest};
use contact_model::fixed_point::{BodyError, Celsius, ContactPairError, units_to_f64};
use thermal_commissioning::{
    IdentificationError, POINTS_PER_THERMISTOR_MAX, PointError, REFERENCE_DIFFERENCE_MAX_K,
    SessionError,
};
use thermal_device::command::Refused;
use thermal_device::safety::PredictedDose;
use thermal_device::safety::limits::{
    SETPOINT_MAX_C, SETPOINT_MIN_C, UNTUNED_RATE_MAX_K_S, UNTUNED_SETPOINT_MAX,
    UNTUNED_SETPOINT_MIN,
};
use thermal_device::stimulus::{
    COURSE_DURATION_MAX_MS, COURSE_POINTS_MAX, COURSE_RATE_MAX_K_S, CourseError,
};
use thermal_settings::{PersonCode, Persons, Range};
use thermal_wire::answer::{AnswerLine, DeviceAnswer as _};
use thermal_wire::{QuotedWordExcerpt, ReadError, TwoHexDigits};

use crate::command_handler::ENROL_CONTACTS;
use crate::upload::UploadError;
use crate::{ChecksumError, LINE_MAX_BYTES, LineError};

/// Why the settings could not be stored in flash, as text of at most 56 bytes for the answer to the host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StorageFailureText(heapless::String<56>);

impl StorageFailureText {
    /// The message of `error`, the reason why the settings were not stored. A message of more than 56 bytes ends before
    /// the first of its parts, as `Display` writes them, that does not fit.
    pub fn new(error: &impl fmt::Display) -> Self {
        let mut text = heapless::String::new();
        // Writing ends at the first part of the message that does not fit.
        let _ = fmt::Write::write_fmt(&mut text, format_args!("{error}"));
        Self(text)
    }
}

/// Why a line from the host was rejected; `Display` writes the answer to the host, `err` and a message, without a line
/// ending and in at most [`ANSWER_MAX_BYTES`](super::ANSWER_MAX_BYTES) bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The bytes that were received from the host form no valid line, for this reason.
    Line(LineError),
    /// The line is rejected for its checksum, for this reason.
    Checksum(ChecksumError),
    /// The line is no request, for this reason.
    Read(ReadError),
    /// The word after `@`, quoted here, is not the index of a finger, which counts from 0; the second value is the
    /// number of fingers of the device.
    UnknownFinger(QuotedWordExcerpt, usize),
    /// `object slab` was sent before a material was chosen; the slab would be of that material.
    SlabNeedsMaterial,
    /// A line of an upload is rejected, for this reason.
    Upload(UploadError),
    /// The device cannot follow the object, for this reason; the present object stays.
    Body(BodyError),
    /// A course is refused, for this reason.
    Course(CourseError),
    /// The point of a course in the row with this index is refused, for this reason; the upload goes on.
    CoursePoint(usize, CourseError),
    /// The line must address a single finger of this device with several, but has no address.
    NeedsFinger,
    /// The properties of a custom material are outside the domain in which the contact model can compute set-points,
    /// for this reason.
    ContactPair(ContactPairError),
    /// The command named here, `save` or `forget`, was sent while a bridge was on or a self-test ran. It needs all
    /// bridges off, because the device restarts.
    NeedsOff(&'static str),
    /// The command named here, `save`, `forget` or `checksum`, was sent with the address of one of several fingers, but is
    /// for all fingers at once.
    WholeDevice(&'static str),
    /// After `save` or `forget`, the settings could not be stored in flash, for this reason; sent after the restart.
    NotStored(StorageFailureText),
    /// The station, which controls one finger, refuses the command in its present state, for this reason.
    Refused(Refused),
    /// `tune result` found that the recorded response of the display is not that of a tile, for this reason; the tile's
    /// parameters are unchanged.
    Identification(IdentificationError),
    /// The calibration point of a `calibrate` line is rejected, for this reason; the calibration is unchanged.
    Point(PointError),
    /// No person with this code is stored.
    UnknownPerson(PersonCode),
    /// As many persons are stored as there is room for.
    NoRoomForPerson,
    /// `person enrol` was sent, and the finger is learnt from this number of long contacts, which is not enough.
    NotEnrolled(u8),
}

impl From<Refused> for Error {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused)
    }
}

impl From<ReadError> for Error {
    fn from(error: ReadError) -> Self {
        Self::Read(error)
    }
}

impl From<SessionError> for Error {
    fn from(error: SessionError) -> Self {
        match error {
            SessionError::Refused(refused) => Self::Refused(refused),
            SessionError::Identification(error) => Self::Identification(error),
            SessionError::Point(error) => Self::Point(error),
            SessionError::ContactPair(error) => Self::ContactPair(error),
        }
    }
}

impl From<LineError> for Error {
    fn from(error: LineError) -> Self {
        Self::Line(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("err ")?;
        match self {
            Self::Line(error) => write_line_error(f, *error),
            Self::Checksum(error) => write_checksum_error(f, error),
            Self::Read(error) => error.fmt(f),
            Self::UnknownFinger(word, fingers) => {
                let last = fingers.saturating_sub(1);
                write!(f, "unknown finger {word} after @; known: 0 to {last}")
            }
            Self::SlabNeedsMaterial => f.write_str("a slab needs a material first"),
            Self::Upload(error) => write_upload_error(f, *error),
            Self::Body(error) => error.fmt(f),
            Self::Course(error) => write_course_error(f, error),
            Self::CoursePoint(row, error) => {
                write!(f, "row {row}: ")?;
                write_course_error(f, error)
            }
            Self::NeedsFinger => f.write_str("finger (as @0) missing"),
            Self::ContactPair(error) => error.fmt(f),
            Self::NeedsOff(command) => write!(f, "{command} needs the bridge off: abort first"),
            Self::WholeDevice(command) => write!(f, "{command} is for all fingers at once"),
            Self::NotStored(StorageFailureText(failure)) => write!(f, "not stored: {failure}"),
            Self::Refused(refused) => write_station_refusal(f, refused),
            Self::Identification(error) => write_identification_error(f, error),
            Self::Point(error) => write_calibration_point_error(f, error),
            Self::UnknownPerson(code) => {
                write!(f, "no person {code} is stored; persons lists those who are")
            }
            Self::NoRoomForPerson => {
                write!(f, "{} persons are stored; forget person CODE", Persons::MAX)
            }
            Self::NotEnrolled(contacts) => write!(
                f,
                "enrol needs {ENROL_CONTACTS} contacts of 8 s, trusted, since the last choice of finger or person; there are {contacts}"
            ),
        }
    }
}

fn write_line_error(f: &mut fmt::Formatter<'_>, error: LineError) -> fmt::Result {
    match error {
        LineError::TooLong => write!(f, "line too long; at most {LINE_MAX_BYTES} bytes"),
        LineError::NotText(byte) => write!(f, "byte 0x{byte:02x} is not printable ASCII"),
        LineError::Reception => f.write_str("a byte was damaged or lost; send the line again"),
        LineError::QueueFull => f.write_str("busy; wait for the answer before the next line"),
    }
}

fn write_checksum_error(f: &mut fmt::Formatter<'_>, error: &ChecksumError) -> fmt::Result {
    match error {
        ChecksumError::Wrong(received, actual) => {
            let (received, actual) = (TwoHexDigits(*received), TwoHexDigits(*actual));
            write!(f, "checksum {received} is wrong, the line has {actual}; send the line again")
        }
        ChecksumError::Missing(actual) => {
            let actual = TwoHexDigits(*actual);
            write!(f, "checksum missing, the line has {actual}; send the line again with it")
        }
        ChecksumError::Malformed(word) => write!(f, "checksum {word} is not 2 hexadecimal digits"),
    }
}

fn write_upload_error(f: &mut fmt::Formatter<'_>, error: UploadError) -> fmt::Result {
    match error {
        UploadError::NotBegun => {
            f.write_str("no upload has begun; upload begin object COUNT DIRECT first")
        }
        UploadError::OfAnother(finger) => {
            f.write_str("the open upload is that of ")?;
            match finger {
                Some(finger) => write!(f, "@{finger}")?,
                None => f.write_str("all fingers")?,
            }
            f.write_str("; upload begin starts another")
        }
        UploadError::NotNextRow(next) => write!(f, "not the next row, which is {next}"),
        UploadError::Incomplete(there, count) => {
            write!(f, "{there} of {count} rows; nothing is changed, upload again")
        }
        UploadError::Checksum(actual) => {
            write!(f, "checksum is {actual:08x}; nothing is changed, upload again")
        }
        UploadError::MalformedChecksum => {
            f.write_str("checksum must have 8 hexadecimal digits; nothing is changed, upload again")
        }
    }
}

fn write_course_error(f: &mut fmt::Formatter<'_>, error: &CourseError) -> fmt::Result {
    match error {
        CourseError::TooManyPoints => {
            write!(f, "too many points; at most {COURSE_POINTS_MAX}")
        }
        CourseError::TooFewPoints => f.write_str("a course has at least 2 points"),
        CourseError::TimeGoesBack(ms, before_ms) => {
            write!(f, "time {ms} ms is not after {before_ms} ms, that of the row before")
        }
        CourseError::TooLong(ms) => {
            write!(f, "too long: {ms} ms; {COURSE_DURATION_MAX_MS} ms at most")
        }
        CourseError::OutOfRange => f.write_str("temperature out of range"),
        CourseError::TooFast(rate_k_s) => write!(
            f,
            "too fast: {rate_k_s} K/s from the point before; at most {COURSE_RATE_MAX_K_S} K/s"
        ),
        CourseError::TooHotForTooLong(dose_ms) => write_dose(f, *dose_ms),
    }
}

/// Writes that a course would give too large a dose, given in ms at 43 °C.
fn write_dose(f: &mut fmt::Formatter<'_>, dose_ms: u32) -> fmt::Result {
    let minutes = |ms: u32| Rounded(f64::from(ms) / 60e3, 2);
    write!(
        f,
        "too hot for too long: CEM43 would be {} min; below {} min is allowed",
        minutes(dose_ms),
        minutes(PredictedDose::LIMIT_MS)
    )
}

/// Not inlined, so that only this refusal takes the stack of an answer.
#[inline(never)]
fn write_needs_nominal_law(f: &mut fmt::Formatter<'_>, law: &ContactLaw) -> fmt::Result {
    let mut line = AnswerLine::new(f, "person needs contact nominal first; told is");
    law.write_values(&mut line);
    line.end()
}

fn write_station_refusal(f: &mut fmt::Formatter<'_>, refused: &Refused) -> fmt::Result {
    f.write_str(match refused {
        Refused::NotArmed => "start needs arm first",
        Refused::Testing => "the self-test goes on; ask again in a second",
        Refused::NoMaterial => "start needs a material first",
        Refused::NeedsLayeredFinger(command) => {
            return write!(
                f,
                "{command} needs another finger than the thesis's; finger mean first"
            );
        }
        Refused::OtherContactLaw(law) => {
            return write_needs_nominal_law(f, law);
        }
        Refused::AlreadyStarted => "already started; arm takes the object away",
        Refused::NeedsDrivenDisplay(command) => {
            return write!(f, "{command} needs a driven display: arm first");
        }
        Refused::TuneNeedsArmed => "tune needs the state armed",
        Refused::Presenting => "not while an object or a course is presented: abort or arm first",
        Refused::NoCourse => "no course is loaded; upload begin course first",
        Refused::Touched(command) => {
            return write!(f, "{command} needs a display without a finger on it");
        }
        Refused::NoFluxSensor(command) => {
            return write!(f, "{command} needs a heat-flux sensor; flux set first");
        }
        Refused::FluxSensorFault => {
            "the heat-flux sensor has no code, or one at a rail or that does not change; look at its wires"
        }
        Refused::DisplayNotAtRoom { display, room } => {
            f.write_str("flux zero needs the display within 0.3 C of the room; they have ")?;
            write_celsius_or_dash(f, *display)?;
            f.write_str(" and ")?;
            return write_celsius_or_dash(f, *room);
        }
        Refused::NotTuned => "nothing was tuned since arm; tune first",
        Refused::Tuning => "tuning goes on; ask again in a second",
        Refused::TuneAborted(why) => return write!(f, "tune was ended: {}", why.description()),
        Refused::TooEarly => "not watched for long enough; wait half a second",
        Refused::Tripped(fault) => {
            return write!(f, "tripped by {}; clear it first", fault.name());
        }
        Refused::CourseOutOfRange(celsius) => {
            let (min, max) = (Shortest(SETPOINT_MIN_C), Shortest(SETPOINT_MAX_C));
            let celsius = rounded_celsius(*celsius);
            return write!(
                f,
                "with the present skin the course reaches {celsius} C; {min} to {max} C are allowed"
            );
        }
        Refused::UntunedRange(celsius) => {
            let [min, max] = [UNTUNED_SETPOINT_MIN, UNTUNED_SETPOINT_MAX].map(rounded_celsius);
            let celsius = rounded_celsius(*celsius);
            return write!(f, "{celsius} C needs tune first; until then {min} to {max} C are allowed");
        }
        Refused::UntunedRate(rate_k_s) => {
            let [rate, max] = [*rate_k_s, UNTUNED_RATE_MAX_K_S].map(rounded_celsius);
            return write!(f, "{rate} K/s needs tune first; until then {max} K/s are allowed");
        }
        Refused::CourseDose(dose) => return write_dose(f, dose.milliseconds_at_43()),
        Refused::StillFaulty(fault) => {
            return write!(f, "fault {} is still present", fault.name());
        }
        Refused::NothingToClear => "no fault to clear",
    })
}

/// A temperature with two decimals.
fn rounded_celsius(celsius: Celsius) -> Rounded {
    Rounded(units_to_f64(celsius.to_bits().into(), Celsius::FRAC_NBITS), 2)
}

fn write_celsius_or_dash(f: &mut fmt::Formatter<'_>, value: Option<Celsius>) -> fmt::Result {
    match value {
        Some(celsius) => write!(f, "{} C", rounded_celsius(celsius)),
        None => f.write_str("-"),
    }
}

fn write_identification_error(
    f: &mut fmt::Formatter<'_>,
    error: &IdentificationError,
) -> fmt::Result {
    match error {
        IdentificationError::CurrentRatio(ratio) => write!(
            f,
            "tune measured {} of the current asked for; look at bridge, module and current mirror",
            Rounded(*ratio, 2)
        ),
        IdentificationError::NoResponse => {
            f.write_str("tune saw no answer of the display to the current; look at its thermistor")
        }
        IdentificationError::ModelMismatch(residual) => write!(
            f,
            "tune saw {} % of what the display did come from elsewhere; look for a loose sensor, a draught, a touch",
            Rounded(100.0 * residual, 2)
        ),
        IdentificationError::OutOfRange(Range { name, unit, min, max }, value) => {
            let (value, min, max) = (Rounded(*value, 3), Shortest(*min), Shortest(*max));
            write!(
                f,
                "tune found a {name} of {value} {unit}; {min} to {max} is a tile; look at sensor and polarity"
            )
        }
    }
}

fn write_calibration_point_error(f: &mut fmt::Formatter<'_>, error: &PointError) -> fmt::Result {
    match error {
        PointError::Unsteady => f.write_str(
            "the reading moves; wait until it is steady to 3 mK in a quarter of a second",
        ),
        PointError::AtBorder => {
            f.write_str("at a step of the converter; take a temperature 0.3 C from here")
        }
        PointError::TooFar(reading) => write!(
            f,
            "the device reads {} C; allowed is within {} C of that",
            rounded_celsius(*reading),
            Shortest(REFERENCE_DIFFERENCE_MAX_K)
        ),
        PointError::Contradicts => {
            f.write_str("no correction fits this and the points before; clear them and begin again")
        }
        PointError::Full => {
            write!(f, "no room for more than {POINTS_PER_THERMISTOR_MAX} points; clear them")
        }
    }
}
