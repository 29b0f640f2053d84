//! The line between a served device and its client, with one defect.
//!
//! ```text
//! client <-- TCP or pseudo-terminal --> HostileLine <-- served device
//!                                           ^
//!                                           +-- question of the test, past the defect
//! ```

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::time::Duration;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use thermal_protocol::{line_checksum, strip_checksum};
use thermal_sim::serve::ClientLine;

/// Lines that a defect concerns. Commands are named by their first word; `checksum on`, `checksum off`, `stream 0` by both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lines {
    Command(&'static str),
    Commands,
    AnswerTo(&'static str),
    Answers,
    Telemetry,
    FromDevice,
}

/// Which of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    First,
    Every,
    /// The first and then each of so many.
    OneIn(u32),
    /// All later than so many ms after the client's first line.
    After(u64),
}

/// What happens to a line.
#[derive(Clone, Copy, Debug)]
pub enum Change {
    Lost,
    /// It arrives so many ms later; other lines overtake it.
    Late(u64),
    Doubled,
    /// It comes after the next line.
    Swapped,
    /// One bit of it is another, which one is drawn.
    BitChanged,
    /// Its second half and its end are missing.
    Cut,
    /// It says something else, with a checksum that fits if it had one.
    Rewritten(fn(&str) -> String),
    /// The device never gets this command, and its client is answered so.
    AnsweredInPlaceOfTheDevice(&'static str),
}

/// What the line does.
#[derive(Clone, Copy, Debug)]
pub enum Defect {
    None,
    Changed(Lines, Which, Change),
    /// This line comes as if from the device each so many ms.
    Stray(&'static str, u64),
    /// Nothing passes, and nobody is told, from so many ms after the client's first line on.
    HalfOpen(u64),
    /// It is closed so many ms after the client's first line.
    Closed(u64),
    /// It is closed when the client sends this command.
    ClosedAt(&'static str),
}

/// Who has sent a line that the device has not answered yet.
#[derive(Clone, Debug)]
enum Asker {
    Client(String),
    Test,
}

/// A line with a defect. Its time is that of the device, ms.
pub struct HostileLine {
    line: Option<Box<dyn ClientLine>>,
    defect: Defect,
    /// A line whose bytes both ends count keeps their number: what is lost is blank.
    is_counted: bool,
    random: Xoshiro256PlusPlus,
    ms: u64,
    /// When the client's first line came.
    begun_ms: Option<u64>,
    /// Lines so far that the defect concerns.
    concerned: u32,
    /// Lines of the client so far, not blank.
    client_lines: Arc<AtomicU64>,
    questions: Receiver<String>,
    answers: Sender<String>,
    /// Bytes without a line end.
    from_client: Vec<u8>,
    from_device: Vec<u8>,
    to_device: VecDeque<u8>,
    unanswered: VecDeque<Asker>,
    /// Lines on their way, and when they arrive, ms.
    late_to_device: Vec<(u64, String)>,
    late_to_client: Vec<(u64, Vec<u8>)>,
    /// A line that waits for the next one.
    swapped: Option<Vec<u8>>,
}

/// The ends of a line that belong to the test.
pub struct TestEnds {
    pub questions: Receiver<String>,
    pub answers: Sender<String>,
    pub client_lines: Arc<AtomicU64>,
}

impl HostileLine {
    pub fn new(
        line: Box<dyn ClientLine>,
        defect: Defect,
        is_counted: bool,
        seed: u64,
        ends: TestEnds,
    ) -> Self {
        Self {
            line: Some(line),
            defect,
            is_counted,
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
            ms: 0,
            begun_ms: None,
            concerned: 0,
            client_lines: ends.client_lines,
            questions: ends.questions,
            answers: ends.answers,
            from_client: Vec::new(),
            from_device: Vec::new(),
            to_device: VecDeque::new(),
            unanswered: VecDeque::new(),
            late_to_device: Vec::new(),
            late_to_client: Vec::new(),
            swapped: None,
        }
    }

    /// Time since the client's first line, ms.
    fn since_ms(&self) -> Option<u64> {
        Some(self.ms - self.begun_ms?)
    }

    fn is_half_open(&self) -> bool {
        matches!(self.defect, Defect::HalfOpen(at) if self.since_ms().is_some_and(|ms| ms >= at))
    }

    /// The change of a line to which one of these names applies.
    fn change(&mut self, applies: impl Fn(Lines) -> bool) -> Option<Change> {
        let Defect::Changed(lines, which, change) = self.defect else {
            return None;
        };
        if !applies(lines) {
            return None;
        }
        self.concerned += 1;
        let number = self.concerned - 1;
        let is_meant = match which {
            Which::First => number == 0,
            Which::Every => true,
            Which::OneIn(count) => number.is_multiple_of(count),
            Which::After(ms) => self.since_ms().is_some_and(|since| since >= ms),
        };
        is_meant.then_some(change)
    }

    /// Takes a line of the client, without its end.
    fn client_sent(&mut self, line: &str) {
        if self.is_half_open() {
            return self.lose_on_the_way_to_the_device(line);
        }
        if line.is_empty() {
            return self.to_device.push_back(b'\n');
        }
        self.begun_ms.get_or_insert(self.ms);
        self.client_lines.fetch_add(1, Ordering::Relaxed);
        let name = name(line);
        if matches!(self.defect, Defect::ClosedAt(command) if command == name) {
            self.line = None;
            return;
        }
        let change = self.change(|lines| {
            lines == Lines::Commands || matches!(lines, Lines::Command(word) if word == name)
        });
        match change {
            None => self.pass_to_device(line),
            Some(Change::Lost) => self.lose_on_the_way_to_the_device(line),
            Some(Change::Late(ms)) => self.late_to_device.push((self.ms + ms, line.into())),
            Some(Change::Doubled) => {
                self.pass_to_device(line);
                self.pass_to_device(line);
            }
            Some(Change::BitChanged) => {
                let changed = self.with_a_bit_changed(line);
                self.pass_to_device(&changed);
            }
            Some(Change::AnsweredInPlaceOfTheDevice(answer)) => {
                let answer = with_checksum_as(line, answer);
                self.write_to_client(format!("{answer}\n").into_bytes());
            }
            Some(change) => unreachable!("{change:?} of a command"),
        }
    }

    fn lose_on_the_way_to_the_device(&mut self, line: &str) {
        if self.is_counted {
            self.to_device.extend(vec![b'\n'; line.len() + 1]);
        }
    }

    fn pass_to_device(&mut self, line: &str) {
        self.unanswered.push_back(Asker::Client(name(line)));
        self.to_device.extend(line.bytes().chain([b'\n']));
    }

    /// Takes a line of the device, without its end.
    fn device_sent(&mut self, line: &str) {
        let content = strip_checksum(line).unwrap_or(line);
        let is_answer = matches!(without_finger(content).split(' ').next(), Some("ok" | "err"));
        let mut asked = None;
        if is_answer {
            match self.unanswered.pop_front() {
                Some(Asker::Test) => {
                    // Nobody listens when the test has ended.
                    let _ignored = self.answers.send(content.into());
                    return;
                }
                Some(Asker::Client(name)) => asked = Some(name),
                None => {}
            }
        }
        let whole = format!("{line}\n").into_bytes();
        let blank = || [vec![b' '; line.len()], vec![b'\n']].concat();
        if self.is_half_open() {
            if self.is_counted {
                self.write_to_client(blank());
            }
            return;
        }
        let is_telemetry = without_finger(content).starts_with("T ");
        let change = self.change(|lines| match lines {
            Lines::AnswerTo(word) => asked.as_deref() == Some(word),
            Lines::Answers => is_answer,
            Lines::Telemetry => is_telemetry,
            Lines::FromDevice => true,
            Lines::Command(_) | Lines::Commands => false,
        });
        match change {
            None => self.write_to_client(whole),
            Some(Change::Lost) if self.is_counted => self.write_to_client(blank()),
            Some(Change::Lost) => {}
            Some(Change::Late(ms)) => self.late_to_client.push((self.ms + ms, whole)),
            Some(Change::Doubled) => self.write_to_client([whole.clone(), whole].concat()),
            Some(Change::Swapped) => self.swapped = Some(whole),
            Some(Change::BitChanged) => {
                let changed = self.with_a_bit_changed(line);
                self.write_to_client([changed.as_bytes(), b"\n"].concat());
            }
            Some(Change::Cut) => self.write_to_client(line.as_bytes()[..line.len() / 2].to_vec()),
            Some(Change::Rewritten(rewrite)) => {
                let rewritten = with_checksum_as(line, &rewrite(content));
                self.write_to_client(format!("{rewritten}\n").into_bytes());
            }
            Some(change) => unreachable!("{change:?} of a line of the device"),
        }
    }

    fn write_to_client(&mut self, mut bytes: Vec<u8>) {
        bytes.extend(self.swapped.take().unwrap_or_default());
        if let Some(line) = &mut self.line {
            line.write(&bytes, Duration::ZERO);
        }
    }

    /// A line in which one bit of one byte is another; it has the same number of line ends.
    fn with_a_bit_changed(&mut self, line: &str) -> String {
        loop {
            let mut bytes = line.as_bytes().to_vec();
            let index = self.random.random_range(0..bytes.len());
            bytes[index] ^= 1 << self.random.random_range(0..7);
            if !matches!(bytes[index], b'\n' | b'\r') {
                return String::from_utf8(bytes).expect("still ASCII");
            }
        }
    }
}

impl ClientLine for HostileLine {
    fn poll(&mut self) -> Option<u64> {
        self.ms += 1;
        let client = self.line.as_mut().and_then(|line| line.poll());
        if let Some(line) = &mut self.line {
            self.from_client.extend(line.read(usize::MAX));
        }
        for line in complete_lines(&mut self.from_client) {
            self.client_sent(&line);
        }
        let now = self.ms;
        for (_, line) in
            self.late_to_device.extract_if(.., |(due, _)| *due <= now).collect::<Vec<_>>()
        {
            self.pass_to_device(&line);
        }
        for (_, bytes) in
            self.late_to_client.extract_if(.., |(due, _)| *due <= now).collect::<Vec<_>>()
        {
            self.write_to_client(bytes);
        }
        match self.defect {
            Defect::Stray(text, interval_ms)
                if self.begun_ms.is_some() && now.is_multiple_of(interval_ms) =>
            {
                self.write_to_client(format!("{text}\n").into_bytes());
            }
            Defect::Closed(at) if self.since_ms().is_some_and(|ms| ms >= at) => self.line = None,
            _ => {}
        }
        while let Ok(question) = self.questions.try_recv() {
            self.unanswered.push_back(Asker::Test);
            let line = format!("{question}*{:02X}\n", line_checksum(question.as_bytes()));
            self.to_device.extend(line.bytes());
        }
        client
    }

    fn read(&mut self, limit: usize) -> Vec<u8> {
        self.to_device.drain(..limit.min(self.to_device.len())).collect()
    }

    fn write(&mut self, bytes: &[u8], _patience: Duration) -> usize {
        self.from_device.extend(bytes);
        for line in complete_lines(&mut self.from_device) {
            self.device_sent(&line);
        }
        0
    }
}

/// Removes and returns the complete lines without their ends, LF or CR LF.
fn complete_lines(bytes: &mut Vec<u8>) -> Vec<String> {
    let end = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let complete: Vec<u8> = bytes.drain(..end).collect();
    let lines = complete.split_inclusive(|byte| *byte == b'\n');
    lines.map(|line| String::from_utf8_lossy(line.trim_ascii_end()).into_owned()).collect()
}

fn without_finger(line: &str) -> &str {
    let address = line.strip_prefix('@').and_then(|line| line.split_once(' '));
    address.map_or(line, |(_, rest)| rest)
}

/// The name of a command, for [`Lines`].
fn name(line: &str) -> String {
    let content = without_finger(strip_checksum(line).unwrap_or(line));
    let word = content.split(' ').next().unwrap_or_default();
    match word {
        _ if word.starts_with("synchronize-") => "synchronize".into(),
        _ if word == "checksum" || content == "stream 0" => content.into(),
        _ => word.into(),
    }
}

/// A line that has a checksum if the other one has.
fn with_checksum_as(other: &str, line: &str) -> String {
    if other.contains('*') {
        format!("{line}*{:02X}", line_checksum(line.as_bytes()))
    } else {
        line.into()
    }
}
