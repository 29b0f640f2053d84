//! What a host expects of the answers to lines that are checked as a whole: checksums, uploads, and the commands that prescribe
//! temperatures. Written from `docs/protocol.md`, with other algorithms than those of the device: numbers are read by the standard
//! library, in `f64`; the checksum of an upload is computed bit by bit, and the dose of a course in closed form.

/// Rounding of the numbers on a line: to 2^-22, and of rates computed from them.
const ROUNDING: f64 = 1e-6;
/// Relative error within which a rate or a dose near its limit may be accepted or refused.
const NEAR_LIMIT: f64 = 0.01;
/// Dose at which a course is refused, s of CEM43.
const DOSE_LIMIT_S: f64 = 30.0;

/// What a host knows of the device.
#[derive(Clone, Debug)]
pub struct ExpectedLines {
    fingers: usize,
    checksums: bool,
    upload: Option<Upload>,
    /// A line has ended the upload, or has not: the next `begin` decides.
    uncertain: bool,
}

/// An upload that has begun.
#[derive(Clone, Debug)]
struct Upload {
    address: Option<String>,
    kind: Kind,
    count: usize,
    rows: Vec<[f64; 2]>,
    /// The accepted lines, each with a line feed.
    text: Vec<u8>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Object,
    Absolute,
    Relative,
}

/// Whether a line must be accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Accepted,
    Refused,
    /// Near a limit, or not known here.
    Either,
}

impl Verdict {
    /// Accepted below a limit, refused above it.
    fn below(value: f64, limit: f64) -> Self {
        if value < limit * (1.0 - NEAR_LIMIT) {
            Self::Accepted
        } else if value > limit * (1.0 + NEAR_LIMIT) {
            Self::Refused
        } else {
            Self::Either
        }
    }

    fn within(value: f64, min: f64, max: f64) -> Self {
        if (min + ROUNDING..=max - ROUNDING).contains(&value) {
            Self::Accepted
        } else if (min - ROUNDING..=max + ROUNDING).contains(&value) {
            Self::Either
        } else {
            Self::Refused
        }
    }

    /// The same, where something else may refuse the line: the state, or what was before.
    fn or_refused(self) -> Self {
        Self::all([self, Self::Either])
    }

    /// The verdict of several conditions.
    fn all(verdicts: impl IntoIterator<Item = Self>) -> Self {
        let worse = |a, b| match (a, b) {
            (Self::Refused, _) | (_, Self::Refused) => Self::Refused,
            (Self::Either, _) | (_, Self::Either) => Self::Either,
            _ => Self::Accepted,
        };
        verdicts.into_iter().fold(Self::Accepted, worse)
    }
}

impl ExpectedLines {
    /// Of a device that has just been switched on.
    pub const fn new(fingers: usize) -> Self {
        Self { fingers, checksums: false, upload: None, uncertain: false }
    }

    /// Rows of the upload that were accepted.
    pub fn received(&self) -> usize {
        self.upload.as_ref().map_or(0, |upload| upload.rows.len())
    }

    /// The last of them.
    pub fn last_row(&self) -> Option<[f64; 2]> {
        self.upload.as_ref()?.rows.last().copied()
    }

    /// The checksum that commits the upload.
    pub fn upload_checksum(&self) -> u32 {
        crc_32(self.upload.as_ref().map_or(&[], |upload| &upload.text))
    }

    /// Checks the answer to a line. A station that has `tripped` may refuse what is loaded.
    pub fn check(&mut self, line: &str, answer: &Result<String, String>, tripped: bool) {
        let ok = answer.is_ok();
        let content = match line.split_once('*') {
            Some((content, digits)) => {
                if !is_checksum(digits, content.as_bytes()) {
                    assert!(is_checksum_error(answer), "{line:?}: {answer:?}");
                    return;
                }
                content
            }
            None if self.checksums && !is_abort(line) => {
                assert!(is_checksum_error(answer), "{line:?}: {answer:?}");
                return;
            }
            None => line,
        };
        let mut words: Vec<_> = content.split_ascii_whitespace().collect();
        let addressed = words.first().is_some_and(|word| word.starts_with('@'));
        let address = addressed.then(|| words.remove(0).to_string());
        if let Some(address) = &address
            && !(0..self.fingers).any(|finger| *address == format!("@{finger}"))
        {
            assert!(!ok, "{line:?}: {answer:?}");
            return;
        }
        // The only finger is all fingers.
        let owner = address.filter(|_| self.fingers > 1);
        let verdict = match words.as_slice() {
            ["checksum", switch] if ok => {
                self.checksums = *switch == "on";
                Verdict::Either
            }
            ["upload", "begin", rest @ ..] => {
                let (verdict, upload) = begin(rest, owner);
                self.upload = upload.filter(|_| ok);
                // Some of several stations may have permitted what others have refused.
                self.uncertain = !ok && tripped && self.fingers > 1;
                self.accept(content);
                verdict
            }
            ["upload", "row", rest @ ..] if !self.uncertain => self.row(rest, &owner, ok, content),
            ["upload", "commit", rest @ ..] if !self.uncertain => self.commit(rest, &owner),
            ["hold", rest @ ..] => hold(rest).or_refused(),
            ["play", _, repeats, ..] if ok => {
                number(repeats).map_or(Verdict::Either, |value| whole_within(value, 1.0, 1000.0))
            }
            ["pulse", rest @ ..] => {
                if (self.upload.as_ref()).is_some_and(|upload| upload.kind != Kind::Object) {
                    // One that is refused may have ended the upload, or not.
                    self.upload = None;
                    self.uncertain = !ok;
                }
                pulse(rest).or_refused()
            }
            ["skin", celsius] if *celsius != "sensor" => within_or_refused(celsius, 15.0, 42.0),
            _ => Verdict::Either,
        };
        let loads = words.first() == Some(&"upload") && words.get(1) != Some(&"row");
        let wrong = match verdict {
            Verdict::Accepted => !(ok || tripped && loads),
            Verdict::Refused => ok,
            Verdict::Either => false,
        };
        assert!(!wrong, "{line:?}, to be {verdict:?}: {answer:?}, {self:?}");
    }

    /// Adds an accepted line to the text of the upload, as it was sent, without an address.
    fn accept(&mut self, content: &str) {
        if let Some(upload) = &mut self.upload {
            let content = content.trim_ascii_start();
            let content = match content.strip_prefix('@') {
                Some(rest) => rest.split_once(' ').map_or("", |(_, rest)| rest),
                None => content,
            };
            upload.text.extend(content.bytes().chain([b'\n']));
        }
    }

    fn row(&mut self, words: &[&str], owner: &Option<String>, ok: bool, content: &str) -> Verdict {
        let Some(upload) = self.upload.as_mut().filter(|one| one.address == *owner) else {
            return Verdict::Refused;
        };
        let [index, first, second] = words else {
            return Verdict::Refused;
        };
        let (Some(index), Some(first), Some(second)) =
            (number(index), number(first), number(second))
        else {
            return Verdict::Refused;
        };
        let whole = whole_within(index, 0.0, 127.0);
        let (index, received) = (index.round(), upload.rows.len());
        if whole == Verdict::Refused {
            return whole;
        }
        if received > 0 && index == (received - 1) as f64 {
            let [last_first, last_second] = upload.rows[received - 1];
            // Times of a course are rounded to 1 ms.
            let same_first = (first - last_first).abs() <= 1.01e-3;
            let same = same_first && (second - last_second).abs() <= ROUNDING;
            let exact = first == last_first && second == last_second;
            return match (exact, same) {
                (true, _) => whole,
                (false, true) => Verdict::Either,
                (false, false) => Verdict::Refused,
            };
        }
        if index != received as f64 || received >= upload.count {
            return Verdict::Refused;
        }
        let verdict = Verdict::all([whole, upload.verdict_of_row(first, second)]);
        if ok {
            upload.rows.push([first, second]);
            self.accept(content);
        }
        verdict
    }

    fn commit(&mut self, words: &[&str], owner: &Option<String>) -> Verdict {
        let [checksum] = words else {
            return Verdict::Refused;
        };
        let Some(upload) = self.upload.take_if(|one| one.address == *owner) else {
            return Verdict::Refused;
        };
        let hexadecimal =
            checksum.len() == 8 && checksum.bytes().all(|digit| digit.is_ascii_hexdigit());
        let value = u32::from_str_radix(checksum, 16);
        if upload.rows.len() != upload.count || !hexadecimal || value != Ok(crc_32(&upload.text)) {
            return Verdict::Refused;
        }
        match upload.kind {
            Kind::Absolute => Verdict::below(dose_s(&upload.rows), DOSE_LIMIT_S),
            Kind::Relative => Verdict::Accepted,
            // Whether the device can follow an object is more than its rows say.
            Kind::Object => Verdict::Either,
        }
    }
}

impl Upload {
    fn verdict_of_row(&self, first: f64, second: f64) -> Verdict {
        let (min_c, max_c) = match self.kind {
            Kind::Absolute => (15.0, 42.0),
            Kind::Relative => (-27.0, 27.0),
            Kind::Object => {
                return Verdict::all([
                    Verdict::within(first, 0.0, 690.0),
                    Verdict::within(second, 1e-6, 1.3e7),
                ]);
            }
        };
        let ranges = [Verdict::within(first, 0.0, 3600.0), Verdict::within(second, min_c, max_c)];
        // Zero is a time that every course may have.
        let range = if first == 0.0 { ranges[1] } else { Verdict::all(ranges) };
        let follows = self.rows.last().map_or(Verdict::Accepted, |last| {
            let (milliseconds, halves) = (1e3 * (first - last[0]), [first, last[0]]);
            // A time in the middle of two milliseconds may be rounded either way.
            let near_half = |s: f64| ((1e3 * s).fract() - 0.5).abs() < 1e-3;
            let rounded_ms = (1e3 * first).round() - (1e3 * last[0]).round();
            if halves.into_iter().any(near_half) && milliseconds.abs() < 1e3 {
                return Verdict::Either;
            }
            if rounded_ms < 1.0 {
                return Verdict::Refused;
            }
            Verdict::below(1e3 * (second - last[1]).abs() / rounded_ms, 100.0)
        });
        Verdict::all([range, follows])
    }
}

fn begin(words: &[&str], address: Option<String>) -> (Verdict, Option<Upload>) {
    let upload = |kind, count: f64| Upload {
        address,
        kind,
        count: count.round() as usize,
        rows: Vec::new(),
        text: Vec::new(),
    };
    let (kind, count, other) = match words {
        ["course", count, "absolute"] => (Kind::Absolute, count, None),
        ["course", count, "relative"] => (Kind::Relative, count, None),
        ["object", count, direct] => (Kind::Object, count, Some(direct)),
        _ => return (Verdict::Refused, None),
    };
    let Some(count) = number(count) else {
        return (Verdict::Refused, None);
    };
    let (min, max) = if kind == Kind::Object { (0.0, 22.0) } else { (2.0, 128.0) };
    let direct = other.map_or(Verdict::Accepted, |direct| within_or_refused(direct, 0.0, 27e3));
    let verdict = Verdict::all([whole_within(count, min, max), direct]);
    (verdict, Some(upload(kind, count)))
}

fn hold(words: &[&str]) -> Verdict {
    let (celsius, rate) = match words {
        [celsius] => (celsius, "1"),
        [celsius, rate] => (celsius, *rate),
        _ => return Verdict::Refused,
    };
    match (number(celsius), number(rate)) {
        (Some(celsius), Some(rate)) => {
            Verdict::all([Verdict::within(celsius, 15.0, 42.0), Verdict::within(rate, 0.01, 100.0)])
        }
        _ => Verdict::Refused,
    }
}

fn pulse(words: &[&str]) -> Verdict {
    let [base, target, rise, hold, back, rest @ ..] = words else {
        return Verdict::Refused;
    };
    let values = [base, target, rise, hold, back].map(|word| number(word));
    let [Some(base), Some(target), Some(rise), Some(hold), Some(back)] = values else {
        return Verdict::Refused;
    };
    let repeats = rest.get(1).and_then(|word| number(word)).unwrap_or(1.0);
    let way = (target - base).abs();
    // Each flank lasts at least 1 ms.
    let (rise_s, back_s) = ((way / rise).max(1e-3), (way / back).max(1e-3));
    let points =
        [[0.0, base], [rise_s, target], [rise_s + hold, target], [rise_s + hold + back_s, base]];
    Verdict::all([
        Verdict::within(base, 15.0, 42.0),
        Verdict::within(target, 15.0, 42.0),
        Verdict::within(rise, 0.01, 100.0),
        Verdict::within(back, 0.01, 100.0),
        Verdict::within(hold, 0.0, 3600.0),
        Verdict::below(rise_s + hold + back_s, 3600.0),
        Verdict::below(repeats * dose_s(&points), DOSE_LIMIT_S),
    ])
}

/// A number as the standard library reads it; the protocol has neither names such as `inf` nor exponents of more than 32 bits.
fn number(word: &str) -> Option<f64> {
    let exponent = word.split_once(['e', 'E']).map_or("0", |(_, exponent)| exponent);
    exponent.parse::<i32>().ok()?;
    word.parse().ok().filter(|_| !word.ends_with(['f', 'F', 'n', 'N', 'y', 'Y']))
}

fn within_or_refused(word: &str, min: f64, max: f64) -> Verdict {
    number(word).map_or(Verdict::Refused, |value| Verdict::within(value, min, max))
}

fn whole_within(value: f64, min: f64, max: f64) -> Verdict {
    let is_whole = (value - value.round()).abs() <= ROUNDING;
    match (min..=max).contains(&value.round()) && is_whole {
        false => Verdict::Refused,
        true if value == value.round() => Verdict::Accepted,
        true => Verdict::Either,
    }
}

/// CEM43 of a course above 39 °C, s: on each line the integral of `4^(T - 43)`.
fn dose_s(points: &[[f64; 2]]) -> f64 {
    let weight = |celsius: f64| 4f64.powf(celsius - 43.0);
    let first =
        points.first().map_or(
            0.0,
            |[time_s, celsius]| {
                if *celsius < 39.0 { 0.0 } else { time_s * weight(*celsius) }
            },
        );
    let lines = points.windows(2).map(|pair| {
        let ([from_s, a], [to_s, b]) = (pair[0], pair[1]);
        let (low, high) = (a.min(b), a.max(b));
        let counted = low.max(39.0);
        if high < 39.0 {
            0.0
        } else if high - low < 1e-9 {
            (to_s - from_s) * weight(high)
        } else {
            (to_s - from_s) * (weight(high) - weight(counted)) / (4f64.ln() * (high - low))
        }
    });
    first + lines.sum::<f64>()
}

fn is_abort(line: &str) -> bool {
    let words: Vec<_> = line.split_ascii_whitespace().collect();
    matches!(words.as_slice(), ["abort"])
        || matches!(words.as_slice(), [at, "abort"] if at.starts_with('@'))
}

fn is_checksum_error(answer: &Result<String, String>) -> bool {
    answer.as_ref().is_err_and(|text| {
        let text = text
            .split_once(' ')
            .filter(|(first, _)| first.starts_with('@'))
            .map_or(text.as_str(), |(_, rest)| rest);
        text.starts_with("err checksum")
    })
}

fn is_checksum(digits: &str, content: &[u8]) -> bool {
    digits.eq_ignore_ascii_case(&format!("{:02X}", exclusive_or(content)))
}

/// Exclusive or of all bytes.
pub fn exclusive_or(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |checksum, byte| checksum ^ byte)
}

/// CRC-32 (ISO-HDLC), bit by bit.
fn crc_32(bytes: &[u8]) -> u32 {
    let bits = bytes.iter().flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1));
    !bits.fold(u32::MAX, |register, bit| {
        let feedback = (register ^ u32::from(bit)) & 1;
        (register >> 1) ^ (0xedb8_8320 * feedback)
    })
}
