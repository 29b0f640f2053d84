//! Upload of an object's relaxations or of a course in several lines: begin, rows, and commit with a checksum. What is
//! uploaded changes only at the commit.

use core::fmt;

use contact_model::fixed_point::Body;
use contact_model::impedance::{Impedance, Relaxation};
use contact_model::material::SKIN;
use heapless::Vec;
use thermal_device::TICK_S;
use thermal_device::stimulus::{Course, CoursePoint, TemperatureKind};
use thermal_settings::{CRC_32, Crc32Digest, WordList};
use thermal_wire::quantity::{
    Direct, PointAboveSkin, PointCount, PointIndex, PointTemperature, PointTime, RELAXATIONS_MAX,
    RelaxationCount, RelaxationGain, RelaxationIndex, RelaxationRate,
};
use thermal_wire::words::{Words, expect_end, read_word};
use thermal_wire::{Argument as _, Number, ReadError, Whole};

use crate::Error;

/// Square metres per square millimetre, in which the lines count areas.
const M2_PER_MM2: f64 = 1e-6;

/// Why a line of an upload is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UploadError {
    /// `upload row` or `upload commit` without `upload begin` before it.
    NotBegun,
    /// `upload row` or `upload commit` with another address than `upload begin` had: the finger of that one, or `None` for
    /// all fingers. The upload goes on.
    OfAnother(Option<u8>),
    /// A row with another index than this, which is that of the next row, or a row too many; the upload goes on.
    NotNextRow(usize),
    /// `upload commit` before all rows have been received: number of rows received, and number announced.
    Incomplete(usize, usize),
    /// The checksum of the received lines, given here, is not that of the commit.
    Checksum(u32),
    /// The checksum of the commit is not a hexadecimal number of eight digits.
    MalformedChecksum,
}

/// What is uploaded.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// The body of an object.
    Object,
    /// A course.
    Course,
}

/// What a line of an upload has completed.
#[expect(clippy::large_enum_variant, reason = "there is no allocator; a step lives for one line")]
#[derive(Debug)]
pub enum UploadStep {
    /// Nothing yet: the begin of an object, or a row.
    Row,
    /// The begin of a course, which the stations may refuse.
    BeginCourse,
    /// An object.
    Object(Body),
    /// A course, which is [`Upload::course`].
    Course,
}

/// An upload, which may have begun. Object and course are filled where they are: moving a course would take a kilobyte of stack
/// at each function.
#[derive(Clone)]
pub struct Upload {
    /// `None` while no upload has begun.
    kind: Option<Kind>,
    count: usize,
    direct_m2k_w: f64,
    rows: Vec<Relaxation, RELAXATIONS_MAX>,
    course: Course,
    /// Checksum of the lines so far, each followed by a line feed.
    digest: Crc32Digest,
}

impl fmt::Debug for Upload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Upload {{ {} of {} rows }}", self.received(), self.count)
    }
}

impl Upload {
    /// No upload.
    pub const fn new() -> Self {
        Self {
            kind: None,
            count: 0,
            direct_m2k_w: 0.0,
            rows: Vec::new(),
            course: Course::new(TemperatureKind::Absolute),
            digest: CRC_32.digest(),
        }
    }

    /// Reads the line `upload begin object COUNT DIRECT`, after its second word: an object of `COUNT` relaxations and a direct
    /// term, mm² K/W; or `upload begin course COUNT absolute|relative`. Ends an upload that had begun.
    ///
    /// # Errors
    /// An argument is missing, no number, or out of range; no upload has begun then.
    pub fn begin(&mut self, line: &str, words: &mut Words<'_>) -> Result<UploadStep, Error> {
        self.kind = None;
        let kind = match read_word(words, "kind of upload")? {
            "object" => {
                self.count = Whole::<RelaxationCount>::read(words)?.get();
                let direct_mm2k_w = Number::<Direct>::read(words)?.f64();
                self.direct_m2k_w = M2_PER_MM2 * direct_mm2k_w;
                self.rows.clear();
                Kind::Object
            }
            "course" => {
                self.count = Whole::<PointCount>::read(words)?.get();
                self.course.clear(TemperatureKind::read(words)?);
                Kind::Course
            }
            unknown => {
                const KINDS: &WordList =
                    &WordList { kind: "kind of upload", words: &["object", "course"] };
                return Err(ReadError::UnknownWord(KINDS, unknown.into()).into());
            }
        };
        expect_end(words)?;
        self.kind = Some(kind);
        self.digest = CRC_32.digest();
        self.add_to_checksum(line);
        Ok(match kind {
            Kind::Object => UploadStep::Row,
            Kind::Course => UploadStep::BeginCourse,
        })
    }

    /// Whether an upload has begun that is not ended.
    pub const fn has_begun(&self) -> bool {
        self.kind.is_some()
    }

    /// Ends the upload without a result.
    pub const fn end(&mut self) {
        self.kind = None;
    }

    /// The course that was uploaded last.
    pub const fn course(&self) -> &Course {
        &self.course
    }

    /// The course, to be replaced by that of a command. Ends an upload of a course that had begun.
    pub const fn course_to_replace(&mut self) -> &mut Course {
        if let Some(Kind::Course) = self.kind {
            self.kind = None;
        }
        &mut self.course
    }

    #[inline(never)]
    fn add_to_checksum(&mut self, line: &str) {
        for part in [line, "\n"] {
            self.digest.update(part.as_bytes());
        }
    }

    fn received(&self) -> usize {
        match self.kind {
            None => 0,
            Some(Kind::Object) => self.rows.len(),
            Some(Kind::Course) => self.course.points().len(),
        }
    }

    /// Reads the line `upload row INDEX RATE GAIN`, after its second word: rate, 1/s, and gain, mm² K/J; or
    /// `upload row INDEX T_S CELSIUS` of a course. A host that has lost the answer to a row may repeat the line: the row that
    /// was received last is accepted again if it says the same.
    ///
    /// # Errors
    /// An argument is missing, no number, or out of range, or it is not the next row; the upload is unchanged.
    pub fn add_row(&mut self, line: &str, words: &mut Words<'_>) -> Result<(), Error> {
        let kind = self.kind.ok_or(Error::Upload(UploadError::NotBegun))?;
        let index = match kind {
            Kind::Object => Whole::<RelaxationIndex>::read(words)?.get(),
            Kind::Course => Whole::<PointIndex>::read(words)?.get(),
        };
        let received = self.received();
        let is_next = index == received && index < self.count;
        let may_be_repeated = index + 1 == received;
        let not_next = || Error::Upload(UploadError::NotNextRow(received));
        if !is_next && !may_be_repeated {
            return Err(not_next());
        }
        let repeats = match kind {
            Kind::Object => {
                let row = read_relaxation(words)?;
                if is_next {
                    self.rows.push(row).map_err(|_| not_next())?;
                }
                self.rows.last() == Some(&row)
            }
            Kind::Course => {
                let point = read_course_point(words, self.course.temperature_kind())?;
                if is_next {
                    (self.course.push(point)).map_err(|error| Error::CoursePoint(index, error))?;
                }
                self.course.points().last() == Some(&point)
            }
        };
        if is_next {
            self.add_to_checksum(line);
        } else if !repeats {
            return Err(not_next());
        }
        Ok(())
    }

    /// Ends the upload, and returns what it has completed if the lines have this checksum, given in eight hexadecimal digits.
    ///
    /// # Errors
    /// Rows are missing, the checksum is another one, or the device cannot follow such an object or course.
    pub fn commit(&mut self, checksum: &str) -> Result<UploadStep, Error> {
        let failed = |error| Err(Error::Upload(error));
        let received = self.received();
        let Some(kind) = self.kind.take() else {
            return failed(UploadError::NotBegun);
        };
        if received != self.count {
            return failed(UploadError::Incomplete(received, self.count));
        }
        let actual = self.digest.clone().finalize();
        // `from_str_radix` accepts a leading `+`.
        let digits = checksum.len() == 8 && !checksum.starts_with('+');
        match u32::from_str_radix(checksum, 16) {
            Ok(expected) if digits && expected == actual => {}
            Ok(_) if digits => return failed(UploadError::Checksum(actual)),
            _ => return failed(UploadError::MalformedChecksum),
        }
        match kind {
            Kind::Object => {
                let impedance =
                    Impedance { direct_m2k_w: self.direct_m2k_w, relaxations: &self.rows };
                let body = Body::new(&impedance, SKIN.effusivity(), TICK_S);
                body.map(UploadStep::Object).map_err(Error::Body)
            }
            Kind::Course => {
                self.course.check_whole().map_err(Error::Course)?;
                Ok(UploadStep::Course)
            }
        }
    }
}

fn read_relaxation(words: &mut Words<'_>) -> Result<Relaxation, ReadError> {
    let rate_1_s = Number::<RelaxationRate>::read(words)?.f64();
    let gain_m2k_j = M2_PER_MM2 * Number::<RelaxationGain>::read(words)?.f64();
    expect_end(words)?;
    Ok(Relaxation { rate_1_s, gain_m2k_j })
}

fn read_course_point(
    words: &mut Words<'_>,
    temperatures: TemperatureKind,
) -> Result<CoursePoint, ReadError> {
    let time_ms = Number::<PointTime>::read(words)?.milliseconds();
    let temperature = match temperatures {
        TemperatureKind::Absolute => Number::<PointTemperature>::read(words)?.celsius(),
        TemperatureKind::AboveSkin => Number::<PointAboveSkin>::read(words)?.celsius(),
    };
    expect_end(words)?;
    Ok(CoursePoint { time_ms, temperature })
}
