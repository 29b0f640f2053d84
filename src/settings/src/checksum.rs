//! The checksum of the records in flash and of the uploads on the serial line.

use crc::{CRC_32_ISO_HDLC, Crc, Digest, NoTable};

/// CRC-32 (ISO-HDLC), as in zip files and Python's `zlib.crc32`; without a table, which would take more flash than it is
/// worth for some hundred bytes.
pub static CRC_32: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// A [`CRC_32`] that is computed part by part.
pub type Crc32Digest = Digest<'static, u32, NoTable>;
