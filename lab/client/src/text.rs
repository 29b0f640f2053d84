//! Files and texts of people, their tools and devices: how much of a file is read and in which encoding, and which characters of
//! a text are shown.

mod characters;

use std::collections::BTreeSet;
use std::fs::{File, FileType, Metadata};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

pub use characters::{control_in_toml, escaped_line, escaped_text, is_control};

/// Byte order mark of UTF-8, which spreadsheets and some editors write.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Largest document that people or programs write as a whole, such as a scene or a description of a session, bytes: 16 MiB.
pub const DOCUMENT_BYTES_MAX: u64 = 1 << 24;
/// Largest table or log that is held in memory, bytes: 256 MiB, an hour of the trace of a simulated device.
pub const TABLE_BYTES_MAX: u64 = 1 << 28;
/// Largest recording that is read row by row, bytes: 8 GiB, a day of telemetry of five fingers every 10 ms.
pub const RECORDING_BYTES_MAX: u64 = 1 << 33;

/// Longest line of standard input, with its end, bytes: 64 KiB.
const LINE_BYTES_MAX: u64 = 1 << 16;

/// A file of which no more than an allowed number of bytes is read.
#[derive(Debug)]
pub struct Limited {
    file: File,
    bytes_max: u64,
    /// How many of them may still come.
    left: u64,
}

impl Limited {
    /// Opens a file for reading: a regular one, or a descriptor of this process that is open already, as `/dev/stdin` and what a
    /// shell puts in place of `<(command)`. Nothing else is opened: a FIFO in place of a file would block, and a device may have
    /// no end.
    ///
    /// # Errors
    /// There is no such file, or it is larger than `bytes_max` or of another kind (`InvalidData`).
    fn open(path: &Path, bytes_max: u64) -> io::Result<Self> {
        let metadata = path.metadata()?;
        check_kind(path, &metadata)?;
        if metadata.is_file() && metadata.len() > bytes_max {
            let bytes = metadata.len();
            return Err(invalid(format!("it has {bytes} bytes; allowed is 0 to {bytes_max}")));
        }
        Ok(Self { file: File::open(path)?, bytes_max, left: bytes_max })
    }
}

impl Read for Limited {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        // One byte more than is allowed tells that there are too many.
        let count = (&self.file).take(self.left.saturating_add(1)).read(buffer)?;
        let bytes_max = self.bytes_max;
        self.left = self.left.checked_sub(count as u64).ok_or_else(|| {
            invalid(format!("it has more than {bytes_max} bytes; allowed is 0 to {bytes_max}"))
        })?;
        Ok(count)
    }
}

/// Refuses what is neither a regular file nor an open descriptor.
fn check_kind(path: &Path, metadata: &Metadata) -> io::Result<()> {
    let is_descriptor = path == Path::new("/dev/stdin")
        || path.file_name().is_some()
            && path.parent().is_some_and(|folder| {
                folder == Path::new("/dev/fd") || folder == Path::new("/proc/self/fd")
            });
    if metadata.is_file() || (is_descriptor && !metadata.is_dir()) {
        return Ok(());
    }
    Err(invalid(format!("this is {}; allowed is a file", kind(metadata.file_type()))))
}

/// What is not a regular file, in words.
fn kind(file_type: FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if file_type.is_fifo() {
            return "a FIFO";
        }
        if file_type.is_socket() {
            return "a socket";
        }
    }
    if file_type.is_dir() { "a folder" } else { "a device" }
}

/// Opens a text file behind its byte order mark, to be read up to `bytes_max` bytes.
///
/// # Errors
/// The file cannot be read, or is no regular file or UTF-16 or UTF-32 (`InvalidData`). Reading fails with `InvalidData` behind
/// `bytes_max` bytes.
pub fn open(path: &Path, bytes_max: u64) -> io::Result<BufReader<Limited>> {
    let mut file = BufReader::new(Limited::open(path, bytes_max)?);
    let mark = mark_length(file.fill_buf()?)?;
    file.consume(mark);
    Ok(file)
}

/// The bytes of a file, at most `bytes_max`.
///
/// # Errors
/// The file cannot be read, or is larger or no regular file (`InvalidData`).
pub fn read_bytes(path: &Path, bytes_max: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    Limited::open(path, bytes_max)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The text of a file of at most `bytes_max` bytes without its byte order mark.
///
/// # Errors
/// The file cannot be read, or is larger, no regular file or not UTF-8 (`InvalidData`).
pub fn read(path: &Path, bytes_max: u64) -> io::Result<String> {
    decode(read_bytes(path, bytes_max)?)
}

/// The same; `None` if there is no such file.
///
/// # Errors
/// As [`read`]. A file that cannot be looked at, as in a folder that may not be entered, is an error, not an absent one.
pub fn read_if_there(path: &Path, bytes_max: u64) -> io::Result<Option<String>> {
    match read(path, bytes_max) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        read => read.map(Some),
    }
}

/// The lines of a reader, such as standard input, without their ends, LF or CR LF: UTF-8, with or without a byte order mark. A line
/// that cannot be read is an error; behind one of more than 64 KiB nothing is read.
pub fn lines(mut reader: impl BufRead) -> impl Iterator<Item = io::Result<String>> {
    let mut has_ended = false;
    std::iter::from_fn(move || {
        if has_ended {
            return None;
        }
        let mut line = Vec::new();
        let read = (&mut reader).take(LINE_BYTES_MAX + 1).read_until(b'\n', &mut line);
        has_ended = read.is_ok() && line.len() as u64 > LINE_BYTES_MAX;
        if has_ended {
            return Some(Err(invalid(format!(
                "a line of more than {LINE_BYTES_MAX} bytes; allowed is 0 to {LINE_BYTES_MAX}"
            ))));
        }
        match read {
            Ok(0) => None,
            Ok(_) => {
                line.truncate(line.strip_suffix(b"\n").unwrap_or(&line).len());
                line.truncate(line.strip_suffix(b"\r").unwrap_or(&line).len());
                Some(decode(line))
            }
            Err(error) => Some(Err(error)),
        }
    })
}

/// The text of a file's bytes without its byte order mark.
///
/// # Errors
/// The bytes are not UTF-8 (`InvalidData`).
pub fn decode(mut bytes: Vec<u8>) -> io::Result<String> {
    bytes.drain(..mark_length(&bytes)?);
    String::from_utf8(bytes).map_err(|error| {
        let (at, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
        let line = bytes[..at].iter().filter(|byte| **byte == b'\n').count() + 1;
        invalid(format!("line {line}: byte 0x{:02x} is not UTF-8; allowed is UTF-8", bytes[at]))
    })
}

/// Length of the byte order mark with which these first bytes begin.
///
/// # Errors
/// They are UTF-16 or UTF-32, with a mark, or without one as a tool writes them that says its byte order elsewhere: an ASCII
/// character beside a zero.
pub fn mark_length(first: &[u8]) -> io::Result<usize> {
    let encoding = match first {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => "UTF-32",
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [1..=0xff, 0, ..] | [0, 1..=0xff, ..] => "UTF-16",
        _ => return Ok(if first.starts_with(MARK) { MARK.len() } else { 0 }),
    };
    Err(invalid(format!("this is {encoding}; allowed is UTF-8")))
}

/// The name that a header has twice, if there is one: which of the columns is meant is not known.
pub fn repeated_column<'a>(header: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut known = BTreeSet::new();
    header.into_iter().find(|name| !name.is_empty() && !known.insert(*name))
}

fn invalid(problem: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, problem)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::{BufReader, ErrorKind, Read};
    use std::path::Path;

    use super::{Limited, decode, lines, read, repeated_column};

    /// What a text editor saves as each of its encodings.
    #[test]
    fn utf_8_is_read_with_and_without_a_mark_and_other_encodings_are_named() {
        for bytes in ["state\n°C\n".as_bytes(), "\u{feff}state\n°C\n".as_bytes()] {
            assert_eq!(decode(bytes.to_vec()).unwrap(), "state\n°C\n");
        }
        assert_eq!(decode(Vec::new()).unwrap(), "");
        let utf_16 = |to_bytes: fn(u16) -> [u8; 2], text: &str| {
            text.encode_utf16().flat_map(to_bytes).collect::<Vec<u8>>()
        };
        for text in ["\u{feff}state\n", "state\n"] {
            for to_bytes in [u16::to_le_bytes, u16::to_be_bytes] {
                let error = decode(utf_16(to_bytes, text)).unwrap_err();
                assert_eq!(error.to_string(), "this is UTF-16; allowed is UTF-8");
            }
        }
        for to_bytes in [u32::to_le_bytes, u32::to_be_bytes] {
            let bytes = "\u{feff}state".chars().flat_map(|c| to_bytes(u32::from(c)));
            let error = decode(bytes.collect()).unwrap_err();
            assert_eq!(error.to_string(), "this is UTF-32; allowed is UTF-8");
        }
        let latin_1 = decode(b"state\n23 \xb0C\n".to_vec()).unwrap_err();
        assert_eq!(latin_1.to_string(), "line 2: byte 0xb0 is not UTF-8; allowed is UTF-8");
    }

    #[test]
    fn a_column_that_a_header_has_twice_is_named() {
        assert_eq!(repeated_column(["t_s", "a", "b", "a", "t_s"]), Some("a"));
        assert_eq!(repeated_column(["t_s", "a", "", "", "A"]), None);
    }

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let path = std::env::temp_dir().join(format!("limit-{}.txt", std::process::id()));
        fs::write(&path, "12345678").unwrap();
        assert_eq!(read(&path, 8).unwrap(), "12345678");
        let error = read(&path, 7).unwrap_err();
        assert_eq!(error.to_string(), "it has 8 bytes; allowed is 0 to 7");
        // A file that grows after it was opened, and one whose size is not known.
        let mut growing = Limited::open(&path, 8).unwrap();
        fs::write(&path, "123456789").unwrap();
        let error = growing.read_to_end(&mut Vec::new()).unwrap_err();
        assert_eq!(error.to_string(), "it has more than 8 bytes; allowed is 0 to 8");
        fs::remove_file(&path).unwrap();
        assert_eq!(read(&path, 8).unwrap_err().kind(), ErrorKind::NotFound);
        let folder = read(&std::env::temp_dir(), 8).unwrap_err();
        assert_eq!(folder.to_string(), "this is a folder; allowed is a file");
    }

    #[test]
    fn lines_are_read_until_one_is_too_long() {
        let read = |text: &str| {
            let lines = lines(text.as_bytes()).map(|line| line.map_err(|error| error.to_string()));
            lines.collect::<Result<Vec<_>, _>>()
        };
        let owned = |lines: &[&str]| Ok(lines.iter().map(|line| (*line).to_owned()).collect());
        assert_eq!(read(""), owned(&[]));
        assert_eq!(read("\u{feff}law\r\n\nstate"), owned(&["law", "", "state"]));
        let longest = "x".repeat(65_535);
        assert_eq!(read(&format!("{longest}\nlaw\n")), owned(&[&longest, "law"]));
        // What has no end is not collected.
        let endless = BufReader::new(std::io::repeat(b'x'));
        let all: Vec<_> = lines(endless).collect();
        assert_eq!(all.len(), 1);
        let error = all[0].as_ref().unwrap_err().to_string();
        assert_eq!(error, "a line of more than 65536 bytes; allowed is 0 to 65536");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_refused_unless_they_are_an_open_descriptor() {
        let refused = |path: &str| read(Path::new(path), 1 << 20).unwrap_err().to_string();
        for path in ["/dev/zero", "/dev/null"] {
            assert_eq!(refused(path), "this is a device; allowed is a file", "{path}");
        }
        let endless = fs::File::open("/dev/zero").unwrap();
        let path = format!("/dev/fd/{}", std::os::fd::AsRawFd::as_raw_fd(&endless));
        assert_eq!(refused(&path), "it has more than 1048576 bytes; allowed is 0 to 1048576");
    }
}
