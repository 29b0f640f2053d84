//! Records a session while it runs.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use thermal_client::client::{AvailableFields, Identity, Telemetry};
use thermal_client::text;

use super::append::{Append, AppendFile, Writing};
use super::change::Renaming;
use super::folder::{SharedFiles, write_whole};
use super::log::{Entry, LogLine};
use super::read::{read_info, read_log, records_of};
use super::{Folder, RecordingError, bids, is_there, telemetry, unreadable};
use crate::record::TrialRecord;
use crate::{Plan, Session, Update};

/// What a session was, for whoever reads its data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SessionInfo {
    /// Title of the session.
    pub title: String,
    /// Name of the task.
    pub task: String,
    /// Where the experiment comes from.
    pub cite: String,
    /// Code of the participant.
    pub participant: String,
    /// Seed of the plan.
    pub seed: u64,
    /// Whether participant and device were simulated.
    pub is_simulated: bool,
    /// The program with which it began.
    #[serde(flatten)]
    pub program: ProgramVersion,
    /// Others with which it was resumed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub resumed_by: Vec<ProgramVersion>,
    /// SHA-256 of `session.toml`.
    pub session_sha256: String,
    /// SHA-256 of `plan.csv`.
    pub plan_sha256: String,
    /// The device, and others with which the session was resumed; none if the session has no displays.
    pub devices: Vec<Value>,
    /// How the participant was renamed since the session was begun, in order. The plan was drawn with the first code.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub renamed: Vec<Renaming>,
}

/// A version of this program.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ProgramVersion {
    /// Version of the package.
    #[serde(rename = "program_version")]
    pub version: String,
    /// Commit of git from which it was built, which ends with `-dirty` if files were changed since; `None` if it is not known.
    #[serde(rename = "program_commit", default)]
    pub commit: Option<String>,
}

impl ProgramVersion {
    /// This version, built from this commit.
    fn of_commit(commit: Option<&str>) -> Self {
        Self { version: env!("CARGO_PKG_VERSION").into(), commit: commit.map(Into::into) }
    }
}

impl fmt::Display for ProgramVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.version)?;
        match &self.commit {
            Some(commit) => write!(f, " of commit {commit}"),
            None => Ok(()),
        }
    }
}

impl SessionInfo {
    /// The code with which the plan was drawn: that which the participant had when the session was begun.
    pub fn plan_code(&self) -> &str {
        self.renamed.first().map_or(&self.participant, |first| &first.from)
    }

    /// Whether the last change of the code was this one.
    pub(super) fn was_renamed(&self, old: &str, new: &str) -> bool {
        self.renamed.last().is_some_and(|last| last.from == old && last.to == new)
    }

    /// The programs with which it was recorded.
    pub fn programs(&self) -> impl Iterator<Item = String> {
        [&self.program].into_iter().chain(&self.resumed_by).map(ToString::to_string)
    }

    /// Names and versions of the firmware of its devices, with the digest of the program where a device has told it.
    pub fn firmware(&self) -> impl Iterator<Item = String> {
        let word = |device: &Value, key: &str| device["identity"][key].as_str().map(str::to_owned);
        self.devices.iter().filter_map(move |device| {
            let version = format!("{} {}", word(device, "name")?, word(device, "version")?);
            Some(match device["program"].as_str() {
                Some(digest) => format!("{version} (program {digest})"),
                None => version,
            })
        })
    }

    /// Whether participant and device were simulated, or the device was simulated by another program.
    pub fn has_simulated_part(&self) -> bool {
        let says_so = |device: &Value| device["is_simulated"] == true;
        self.is_simulated || self.devices.iter().any(says_so)
    }
}

/// What a device says of itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DeviceReport {
    /// Name, version, fingers, capabilities.
    pub identity: Identity,
    /// Whether it is simulated, also one that is served by another program; `None` if it does not say.
    pub is_simulated: Option<bool>,
    /// Digest of the program in its flash, in hexadecimal digits; `None` if it does not say.
    pub program: Option<String>,
    /// Lines of the settings of each finger.
    pub settings: Vec<Vec<String>>,
    /// Whether each finger has a heat-flux sensor.
    pub has_flux_sensor: Vec<bool>,
}

/// What only clock and computer say: the one file that differs between two runs of the same simulated session.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct ClockReport {
    /// When the session was begun, and each time when it was resumed, UTC.
    began: Vec<String>,
    /// When it last ended, UTC.
    ended: Option<String>,
    /// Operating system and processor.
    computer: String,
}

/// Records a session.
#[derive(Debug)]
pub struct Recorder {
    folder: Folder,
    session: Session,
    plan: Plan,
    info: SessionInfo,
    clock: ClockReport,
    log: AppendFile,
    telemetry: AppendFile,
    writing: Writing,
    /// The fields whose columns the telemetry has: those of the device of the first trial.
    fields: AvailableFields,
    /// Lines since the last trial ended.
    pending: Vec<LogLine>,
    records: Vec<TrialRecord>,
}

/// Names of the files.
pub(super) const SESSION: &str = "session.toml";
const PLAN: &str = "plan.csv";
pub(super) const INFO: &str = "session.json";
pub(super) const LOG: &str = "log.jsonl";
pub(super) const TELEMETRY: &str = "telemetry.csv";
const CLOCK: &str = "clock.json";

impl Recorder {
    /// Begins to record a participant's session in a data set, which is created if it is not there.
    ///
    /// # Errors
    /// The files cannot be written, or there are data of this participant and task.
    pub fn create(
        root: &Path,
        session: &Session,
        plan: &Plan,
        (participant, seed): (&str, u64),
        is_simulated: bool,
    ) -> Result<Self, RecordingError> {
        let shared = SharedFiles::lock(root)?;
        let folder = Folder::new(root, participant, &session.task);
        folder.check_code(None)?;
        Self::begin(folder, session, plan, (seed, is_simulated), Vec::new(), &shared)
    }

    /// Begins to record in a folder, whose participant may have been renamed.
    fn begin(
        folder: Folder,
        session: &Session,
        plan: &Plan,
        (seed, is_simulated): (u64, bool),
        renamed: Vec<Renaming>,
        shared: &SharedFiles,
    ) -> Result<Self, RecordingError> {
        let log_path = folder.source(LOG);
        // A session that has ended before its first trial leaves nothing that could be lost.
        if is_there(&log_path)? && !records_of(&read_log(&log_path)?.lines).0.is_empty() {
            return Err(RecordingError::Exists(log_path));
        }
        let plan_csv = plan.csv();
        let info = SessionInfo {
            title: session.title.clone(),
            task: session.task.clone(),
            cite: session.cite.clone(),
            participant: folder.participant().into(),
            seed,
            is_simulated,
            program: ProgramVersion::of_commit(None),
            resumed_by: Vec::new(),
            session_sha256: sha256(session.text.as_bytes()),
            plan_sha256: sha256(plan_csv.as_bytes()),
            devices: Vec::new(),
            renamed,
        };
        write_whole(&folder.source(SESSION), session.text.as_bytes())?;
        let log = AppendFile::open(&log_path, 0, true)?;
        folder.remove_parts()?;
        write_whole(&folder.source(PLAN), plan_csv.as_bytes())?;
        write_whole(&folder.source(INFO), &pretty(&info))?;
        bids::describe(&folder, shared)?;
        let rows = AppendFile::open(&folder.source(TELEMETRY), 0, false)?;
        Self {
            folder,
            session: session.clone(),
            plan: plan.clone(),
            info,
            clock: ClockReport::default(),
            log,
            telemetry: rows,
            writing: Writing::default(),
            fields: AvailableFields::OF_EVERY_LINE,
            pending: Vec::new(),
            records: Vec::new(),
        }
        .begun()
    }

    /// Goes on with a session that was interrupted: what a program that was killed has written of its last trial is removed.
    ///
    /// # Errors
    /// There is no such session, or its files cannot be read or written.
    pub fn resume(
        root: &Path,
        session: &Session,
        plan: &Plan,
        (participant, seed): (&str, u64),
        is_simulated: bool,
    ) -> Result<Self, RecordingError> {
        let folder = Folder::new(root, participant, &session.task);
        let log_path = folder.source(LOG);
        if !is_there(&log_path)? {
            return Err(RecordingError::Missing(log_path));
        }
        let shared = SharedFiles::lock(root)?;
        let recorded = read_log(&log_path)?;
        let (records, telemetry_bytes) = records_of(&recorded.lines);
        let Some(telemetry_bytes) = telemetry_bytes else {
            // It was interrupted before its first trial had ended.
            let renamed = folder.renamings()?;
            return Self::begin(folder, session, plan, (seed, is_simulated), renamed, &shared);
        };
        let info = read_info(&folder)?;
        let session = recorded_session(&folder, &info, session)?;
        let given = [seed.to_string(), sha256(plan.csv().as_bytes()), kind(is_simulated).into()];
        for ((what, recorded), given) in [
            ("the seed", &info.seed.to_string()),
            ("the plan of SHA-256", &info.plan_sha256),
            ("a participant who is", &kind(info.is_simulated).into()),
        ]
        .into_iter()
        .zip(&given)
        {
            if recorded != given {
                return Err(RecordingError::OtherSession {
                    path: folder.source(INFO),
                    what,
                    recorded: recorded.clone(),
                    given: given.clone(),
                });
            }
        }
        check_line_ends(&folder.source(TELEMETRY), telemetry_bytes)?;
        let fields = telemetry::fields(&folder.source(TELEMETRY))?;
        let log = AppendFile::open(&log_path, recorded.bytes, true)?;
        folder.remove_parts()?;
        let rows = AppendFile::open(&folder.source(TELEMETRY), telemetry_bytes, false)?;
        // A clock that cannot be read has nothing that the data need.
        let clock = text::read(&folder.source(CLOCK), text::DOCUMENT_BYTES_MAX).unwrap_or_default();
        Self {
            folder,
            session,
            plan: plan.clone(),
            info,
            clock: serde_json::from_str(&clock).unwrap_or_default(),
            log,
            telemetry: rows,
            writing: Writing::default(),
            fields,
            pending: Vec::new(),
            records,
        }
        .begun()
    }

    /// Notes that it has begun or goes on.
    fn begun(mut self) -> Result<Self, RecordingError> {
        self.clock.began.push(utc_now());
        self.clock.computer = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        self.write_clock()?;
        Ok(self)
    }

    fn write_clock(&self) -> Result<(), RecordingError> {
        write_whole(&self.folder.source(CLOCK), &pretty(&self.clock))
    }

    /// The records so far, also those of the runs before.
    pub fn records(&self) -> &[TrialRecord] {
        &self.records
    }

    /// End of the last recorded trial by the session's clock, ns.
    pub(crate) fn end_ns(&self) -> i64 {
        let end_s = self.records.last().map_or(0.0, |record| record.end_s);
        // Times are recorded in steps of 0.1 ms.
        (end_s * 1e4).round() as i64 * 100_000
    }

    /// Takes note of the commit from which the program was built that begins or resumes the session.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn program_of(&mut self, commit: Option<&str>) -> Result<(), RecordingError> {
        let program = ProgramVersion::of_commit(commit);
        if self.records.is_empty() {
            self.info.program = program;
        } else if *self.info.resumed_by.last().unwrap_or(&self.info.program) != program {
            self.info.resumed_by.push(program);
        }
        self.write_info()
    }

    fn write_info(&self) -> Result<(), RecordingError> {
        self.of_trials(write_whole(&self.folder.source(INFO), &pretty(&self.info)))
    }

    /// An error of writing says what is safe, if anything is recorded.
    fn of_trials<T>(&self, written: Result<T, RecordingError>) -> Result<T, RecordingError> {
        written.map_err(|error| match error {
            RecordingError::File { path, error } if !self.records.is_empty() => {
                RecordingError::FileOfTrials { path, error }
            }
            other => other,
        })
    }

    /// Takes note of what the device says of itself.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn device(&mut self, report: &DeviceReport) -> Result<(), RecordingError> {
        if self.telemetry.bytes() == 0 {
            let has_flux_sensor = report.has_flux_sensor.contains(&true);
            self.fields = AvailableFields::of(&report.identity, has_flux_sensor);
        }
        let report = serde_json::to_value(report).unwrap_or_default();
        if self.info.devices.last() != Some(&report) {
            self.info.devices.push(report);
        }
        self.write_info()
    }

    /// Takes note of what participant and operator are told at a time of the session, s.
    pub fn update(&mut self, t_s: f64, update: &Update) {
        if let Some(entry) = Entry::of(update) {
            self.pending.push(LogLine { t_s, entry });
        }
    }

    /// Records a trial that has ended, with its telemetry: times, s, fingers and lines. It is written while the session goes on: a disk may
    /// take seconds, in which a session that waited for it would see neither a stop nor telemetry.
    ///
    /// # Errors
    /// The trial before cannot be written, and is no longer recorded. The trials before that one are whole.
    pub fn trial_ended<'t>(
        &mut self,
        record: &TrialRecord,
        lines: impl Iterator<Item = (f64, u8, &'t Telemetry)>,
    ) -> Result<(), RecordingError> {
        self.wait_for_disk()?;
        let pieces = self.pieces_of_trial(record, lines);
        self.writing.begin(self.of_trials(pieces)?)?;
        self.records.push(record.clone());
        Ok(())
    }

    fn pieces_of_trial<'t>(
        &mut self,
        record: &TrialRecord,
        lines: impl Iterator<Item = (f64, u8, &'t Telemetry)>,
    ) -> Result<Vec<Append>, RecordingError> {
        let fields = self.fields;
        let header = (self.telemetry.bytes() == 0).then(|| telemetry::header(fields));
        let rows = lines.map(|line| telemetry::row(line, fields));
        let rows: String = header.into_iter().chain(rows).collect();
        let rows = self.telemetry.append(rows.into_bytes())?;
        self.pending.push(LogLine {
            t_s: record.end_s,
            entry: Entry::Record {
                record: Box::new(record.clone()),
                telemetry_bytes: self.telemetry.bytes(),
            },
        });
        Ok(vec![rows, self.append_pending()?])
    }

    /// Reports that the last trial cannot be written, if that is known by now.
    ///
    /// # Errors
    /// As [`trial_ended`](Self::trial_ended).
    pub(crate) fn check_disk(&mut self) -> Result<(), RecordingError> {
        if self.writing.is_done() { self.wait_for_disk() } else { Ok(()) }
    }

    /// Waits until the last trial is on the disk.
    fn wait_for_disk(&mut self) -> Result<(), RecordingError> {
        let written = self.writing.wait().inspect_err(|_| drop(self.records.pop()));
        self.of_trials(written)
    }

    fn append_pending(&mut self) -> Result<Append, RecordingError> {
        let mut log = Vec::new();
        for line in self.pending.drain(..) {
            // Maps have text keys and numbers are finite, so nothing fails.
            log.extend(serde_json::to_vec(&line).unwrap_or_default());
            log.push(b'\n');
        }
        self.log.append(log)
    }

    /// Writes the files of the data set from what is recorded.
    ///
    /// # Errors
    /// They cannot be written. What is recorded stays.
    pub fn finish(&mut self) -> Result<(), RecordingError> {
        self.wait_for_disk()?;
        let written = self.write_data_set();
        self.of_trials(written)
    }

    fn write_data_set(&mut self) -> Result<(), RecordingError> {
        let log = self.append_pending()?;
        self.writing.begin(vec![log])?;
        self.writing.wait()?;
        self.clock.ended = Some(utc_now());
        self.write_clock()?;
        bids::write(&self.folder, &self.session, &self.plan, &self.records)
    }

    /// The recorded session file, if its text is not that of the session that is given: comments were changed since.
    pub fn differs_from(&self, given: &Session) -> Option<PathBuf> {
        (self.session.text != given.text).then(|| self.folder.source(SESSION))
    }

    /// The folder of the session.
    pub const fn folder(&self) -> &Folder {
        &self.folder
    }
}

/// JSON for people, with a line end.
pub(super) fn pretty<T: Serialize>(value: &T) -> Vec<u8> {
    let mut text = serde_json::to_vec_pretty(value).unwrap_or_default();
    text.push(b'\n');
    text
}

/// Whether participant and device are simulated, in words.
const fn kind(is_simulated: bool) -> &'static str {
    if is_simulated { "simulated" } else { "real" }
}

/// The session that was recorded, if the one that is given says the same; comments and line ends may have been corrected since.
fn recorded_session(
    folder: &Folder,
    info: &SessionInfo,
    given: &Session,
) -> Result<Session, RecordingError> {
    if sha256(given.text.as_bytes()) == info.session_sha256 {
        return Ok(given.clone());
    }
    let path = folder.source(SESSION);
    let text = text::read(&path, crate::file::BYTES_MAX).map_err(unreadable(&path))?;
    let is_as_recorded = sha256(text.as_bytes()) == info.session_sha256;
    let recorded = Session::parse(&text, &path).ok().filter(|_| is_as_recorded);
    recorded
        .filter(|recorded| recorded.says_the_same_as(given))
        .ok_or(RecordingError::OtherFile { path, is_as_recorded })
}

/// Refuses a file whose first `recorded` bytes are not those that were recorded, because a text tool has changed its line ends:
/// cut there, it would lose rows.
fn check_line_ends(path: &Path, recorded: u64) -> Result<(), RecordingError> {
    let bytes = text::read_bytes(path, text::RECORDING_BYTES_MAX).map_err(unreadable(path))?;
    let wrong = |line: usize, problem: &str| {
        let problem = format!(
            "{problem}; a file as it was recorded is allowed, with LF alone at each end of a line"
        );
        Err(RecordingError::Content { path: path.into(), line, problem })
    };
    if let Some(at) = bytes.iter().position(|byte| *byte == b'\r') {
        let line = bytes[..at].iter().filter(|byte| **byte == b'\n').count() + 1;
        return wrong(line, "this line ends with CR LF");
    }
    match bytes.get(..recorded as usize) {
        Some(whole) if !whole.ends_with(b"\n") => {
            let line = whole.iter().filter(|byte| **byte == b'\n').count() + 1;
            wrong(line, "what was recorded ends within this line")
        }
        _ => Ok(()),
    }
}

/// SHA-256 in hexadecimal digits.
pub(super) fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Now, in UTC, as RFC 3339 writes it.
pub(super) fn utc_now() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()
}
