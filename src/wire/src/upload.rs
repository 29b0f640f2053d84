//! Lines of an upload, as a host writes them. The device reads them beside the upload so far, which says what a row is.

use core::fmt;

use thermal_device::stimulus::TemperatureKind;

use crate::argument::Argument as _;
use crate::number::{Number, Whole};
use crate::quantity::{
    Direct, PointCount, PointIndex, PointTemperature, PointTime, RelaxationCount, RelaxationGain,
    RelaxationIndex, RelaxationRate,
};

/// A line of an upload.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UploadLine {
    /// Begin the upload of an object: number of relaxations, and direct term of its impedance.
    BeginObject(Whole<RelaxationCount>, Number<Direct>),
    /// A relaxation of an object by its index: rate and gain.
    Relaxation(Whole<RelaxationIndex>, Number<RelaxationRate>, Number<RelaxationGain>),
    /// Begin the upload of a course: number of points, and what its temperatures are.
    BeginCourse(Whole<PointCount>, TemperatureKind),
    /// A point of a course by its index: time, and temperature, °C or K above the skin.
    Point(Whole<PointIndex>, Number<PointTime>, Number<PointTemperature>),
    /// End the upload with the CRC-32 of its lines.
    Commit(u32),
}

impl fmt::Display for UploadLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BeginObject(count, direct) => {
                f.write_str("upload begin object")?;
                count.write(f)?;
                direct.write(f)
            }
            Self::Relaxation(index, rate, gain) => {
                f.write_str("upload row")?;
                index.write(f)?;
                rate.write(f)?;
                gain.write(f)
            }
            Self::BeginCourse(count, temperatures) => {
                f.write_str("upload begin course")?;
                count.write(f)?;
                temperatures.write(f)
            }
            Self::Point(index, time, temperature) => {
                f.write_str("upload row")?;
                index.write(f)?;
                time.write(f)?;
                temperature.write(f)
            }
            Self::Commit(checksum) => write!(f, "upload commit {checksum:08x}"),
        }
    }
}
