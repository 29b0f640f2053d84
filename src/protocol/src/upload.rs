//! Upload of an object's relaxations in several lines: begin, rows, and commit with a checksum. The object changes only at
//! the commit.

use core::fmt;

use contact_model::fixed_point::{Body, FAST_MAX, SLOW_MAX};
use contact_model::impedance::{Impedance, Relaxation};
use contact_model::material::SKIN;
use heapless::Vec;
use thermal_device::TICK_S;
use thermal_settings::{CRC_32, Crc32Digest, Range};

use crate::Error;
use crate::arguments::{
    Words, expect_end, read_fixed_point_in_range, read_whole_number_in_range, read_word,
};

/// Largest number of rows of an upload.
const ROWS_MAX: usize = FAST_MAX + SLOW_MAX;
/// Square metres per square millimetre, in which the lines count areas.
const M2_PER_MM2: f64 = 1e-6;

static ROW_COUNT_RANGE: Range = Range {
    name: "number of rows",
    unit: "",
    min: 0.0,
    max: ROWS_MAX as f64,
};
static ROW_INDEX_RANGE: Range = Range {
    name: "row",
    unit: "",
    min: 0.0,
    max: (ROWS_MAX - 1) as f64,
};
static DIRECT_RANGE: Range = Range {
    name: "direct",
    unit: "mm2K/W",
    min: 0.0,
    max: 27e3,
};
static RATE_RANGE: Range = Range {
    name: "rate",
    unit: "1/s",
    min: 0.0,
    max: 690.0,
};
static GAIN_RANGE: Range = Range {
    name: "gain",
    unit: "mm2K/J",
    min: 1e-6,
    max: 1.3e7,
};

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

/// An upload that has begun and is not committed yet.
#[derive(Clone)]
pub struct Upload {
    count: usize,
    direct_m2k_w: f64,
    rows: Vec<Relaxation, ROWS_MAX>,
    /// Checksum of the lines so far, each followed by a line feed.
    digest: Crc32Digest,
}

impl fmt::Debug for Upload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Upload {{ {} of {} rows }}", self.rows.len(), self.count)
    }
}

impl Upload {
    /// Reads the line `upload begin object COUNT DIRECT`, after its second word: an object of `COUNT` relaxations and a direct
    /// term, mm² K/W.
    ///
    /// # Errors
    /// An argument is missing, no number, or out of range.
    pub fn begin(line: &str, words: &mut Words<'_>) -> Result<Self, Error> {
        let kind = read_word(words, "kind of upload")?;
        if kind != "object" {
            return Err(Error::UnknownUpload(kind.into()));
        }
        let count = read_whole_number_in_range(words, &ROW_COUNT_RANGE)?;
        let direct_m2k_w =
            M2_PER_MM2 * read_fixed_point_in_range(words, &DIRECT_RANGE)?.to_num::<f64>();
        expect_end(words)?;
        let mut upload = Self {
            count,
            direct_m2k_w,
            rows: Vec::new(),
            digest: CRC_32.digest(),
        };
        upload.add_to_checksum(line);
        Ok(upload)
    }

    #[inline(never)]
    fn add_to_checksum(&mut self, line: &str) {
        for part in [line, "\n"] {
            self.digest.update(part.as_bytes());
        }
    }

    /// Reads the line `upload row INDEX RATE GAIN`, after its second word: rate, 1/s, and gain, mm² K/J.
    ///
    /// # Errors
    /// An argument is missing, no number, or out of range, or it is not the next row; the upload is unchanged.
    pub fn add_row(&mut self, line: &str, words: &mut Words<'_>) -> Result<(), Error> {
        let index = read_whole_number_in_range(words, &ROW_INDEX_RANGE)?;
        if index != self.rows.len() || index >= self.count {
            return Err(Error::Upload(UploadError::NotNextRow(self.rows.len())));
        }
        let rate_1_s = read_fixed_point_in_range(words, &RATE_RANGE)?.to_num();
        let gain_m2k_j =
            M2_PER_MM2 * read_fixed_point_in_range(words, &GAIN_RANGE)?.to_num::<f64>();
        expect_end(words)?;
        let row = Relaxation {
            rate_1_s,
            gain_m2k_j,
        };
        (self.rows.push(row)).map_err(|_| Error::Upload(UploadError::NotNextRow(index)))?;
        self.add_to_checksum(line);
        Ok(())
    }

    /// Ends the upload, and returns its object if the lines have this checksum, given in eight hexadecimal digits.
    ///
    /// # Errors
    /// Rows are missing, the checksum is another one, or the device cannot follow such an object.
    pub fn commit(self, checksum: &str) -> Result<Body, Error> {
        let failed = |error| Err(Error::Upload(error));
        if self.rows.len() != self.count {
            return failed(UploadError::Incomplete(self.rows.len(), self.count));
        }
        let actual = self.digest.finalize();
        // `from_str_radix` accepts a leading `+`.
        let digits = checksum.len() == 8 && !checksum.starts_with('+');
        match u32::from_str_radix(checksum, 16) {
            Ok(expected) if digits && expected == actual => {}
            Ok(_) if digits => return failed(UploadError::Checksum(actual)),
            _ => return failed(UploadError::MalformedChecksum),
        }
        let impedance = Impedance {
            direct_m2k_w: self.direct_m2k_w,
            relaxations: &self.rows,
        };
        Body::new(&impedance, SKIN.effusivity(), TICK_S).map_err(Error::Body)
    }
}
