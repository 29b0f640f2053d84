//! What a bring-up has found.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::check::{Stage, StageId};
use super::stages::STAGES;

/// What became of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// As expected.
    Passed,
    /// Not as expected.
    Failed,
    /// An earlier failure has kept it from being measured.
    NotReached,
}

/// A check with its result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    /// Name of the stage.
    pub stage: String,
    /// Name of the check.
    pub check: String,
    /// What was measured.
    pub what: String,
    /// What was expected.
    pub expected: String,
    /// What was found; `-` for nothing.
    pub found: String,
    /// Where the limits come from.
    pub basis: String,
    /// What became of it.
    pub verdict: Verdict,
    /// What is broken, if it failed.
    pub finding: Option<String>,
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, expected, found, .. } = self;
        match self.verdict {
            Verdict::Passed => write!(f, "  ok      {what}: {found} ({expected})"),
            Verdict::Failed => write!(
                f,
                "  FAILED  {what}: {found} ({expected})\n          {}",
                self.finding.as_deref().unwrap_or_default()
            ),
            Verdict::NotReached => write!(f, "  -       {what}: not reached"),
        }
    }
}

/// Where an unfinished bring-up resumes, and why it was not finished.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Resume {
    /// Name of the stage.
    pub stage: String,
    /// Why it was not finished.
    pub reason: String,
}

/// Why a bring-up does not go on: with another image earlier results may be others.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "--from {stage}: the results of the earlier stages are those of the image with CRC-32 {then}; that of --image now is {now}. \
     Allowed: --image with the earlier image, if that is flashed; or --from chip, or a stage before it, with any image"
)]
pub struct OtherImage {
    stage: &'static str,
    then: String,
    now: String,
}

/// A bring-up, finished or not.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Report {
    /// The device's answer to `id`.
    pub device: Option<String>,
    /// Unique identifier of the microcontroller.
    pub chip: Option<String>,
    /// CRC-32 of the image that was flashed, eight hexadecimal digits.
    pub image: Option<String>,
    /// Whether the board is emulated.
    pub emulated: bool,
    /// All checks in their order.
    pub records: Vec<Record>,
    /// Settings that commissioning has found, as lines.
    pub settings: Vec<String>,
    /// Where it resumes; `None` if all stages have been done.
    pub resume: Option<Resume>,
}

impl Report {
    /// Forgets the results of a stage and of all later ones, because it is done again with this image.
    ///
    /// # Errors
    /// Results that would be kept are those of another image.
    pub fn keep_before(&mut self, stage: &Stage, image: Option<String>) -> Result<(), OtherImage> {
        let earlier = STAGES.iter().take_while(|known| known.id < stage.id);
        let earlier: Vec<_> = earlier.map(|stage| stage.name).collect();
        self.records.retain(|record| earlier.contains(&record.stage.as_str()));
        if self.depends_on_firmware() && self.image != image {
            let known = |image: Option<String>| image.unwrap_or_else(|| "not known".into());
            return Err(OtherImage {
                stage: stage.name,
                then: known(self.image.take()),
                now: known(image),
            });
        }
        if self.records.is_empty() {
            (self.device, self.chip) = (None, None);
        }
        if stage.id <= StageId::Commissioning {
            self.settings.clear();
        }
        (self.image, self.resume) = (image, None);
        Ok(())
    }

    /// Whether there are results that the firmware had a part in.
    pub(super) fn depends_on_firmware(&self) -> bool {
        let mut stages = STAGES.iter().filter(|stage| stage.id >= StageId::Chip);
        stages.any(|stage| self.has_results_of(stage))
    }

    fn has_results_of(&self, stage: &Stage) -> bool {
        self.records.iter().any(|record| record.stage == stage.name)
    }

    /// Whether every stage was done and every check passed.
    pub fn passed(&self) -> bool {
        let mut records = self.records.iter();
        self.resume.is_none()
            && STAGES.iter().all(|stage| self.has_results_of(stage))
            && records.all(|record| record.verdict == Verdict::Passed)
    }

    /// What is broken, in the order in which it was found.
    pub fn findings(&self) -> Vec<&str> {
        let records = self.records.iter();
        records.filter_map(|record| record.finding.as_deref()).collect()
    }

    /// The result for another program.
    pub fn json(&self) -> serde_json::Value {
        serde_json::json!({ "passed": self.passed(), "findings": self.findings() })
    }
}
