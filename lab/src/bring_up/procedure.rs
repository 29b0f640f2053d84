//! Runs the procedure.

use std::time::Duration;

use thermal_client::client::{
    Client, ClientError, QueryBoard, QueryRaw, QuerySelfTest, QueryState, SelfTestReport,
    StationRequest,
};
use thermal_client::commissioning::{CommissionError, SurroundingsError};
use thermal_client::link::{Link, LinkError};
use thermal_device::safety::SelfTestResult;

use super::bench::{Bench, BenchError, Measurement};
use super::check::{
    Check, Expected, Judgement, Kept, ManualStep, Reading, Stage, StageId, Step, Value,
};
use super::fault_words::explanation;
use super::report::{Record, Report, Resume, Verdict};
use super::stages::STAGES;

/// Time-out of a self-test, and interval of polling, ms.
const SELF_TEST_MS: u64 = 4000;
const POLL_MS: u64 = 50;

/// Why the procedure cannot go on at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Interruption {
    /// The person has ended it.
    #[error("ended by the person")]
    Aborted,
    /// The bench does not do what is needed.
    #[error("{0}")]
    Bench(String),
    /// The device does not answer.
    #[error("{0}")]
    Client(ClientError),
    /// The report keeps results of another device.
    #[error(transparent)]
    OtherDevice(OtherDevice),
}

/// Why a bring-up does not go on: what is connected is not what the earlier stages were done with.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the results of the earlier stages are those of {then}; connected is {now}. Allowed: that device; with other firmware on the \
     same microcontroller --from chip; with another microcontroller a bring-up of its own, without --from and with another --out"
)]
pub struct OtherDevice {
    /// What the earlier stages were done with.
    pub then: String,
    /// What is connected.
    pub now: String,
}

impl From<BenchError> for Interruption {
    fn from(error: BenchError) -> Self {
        match error {
            BenchError::Aborted => Self::Aborted,
            BenchError::Failed(why) => Self::Bench(why),
        }
    }
}

impl From<ClientError> for Interruption {
    fn from(error: ClientError) -> Self {
        match error {
            ClientError::Link(LinkError::Interrupted) => Self::Aborted,
            other => Self::Client(other),
        }
    }
}

impl From<LinkError> for Interruption {
    fn from(error: LinkError) -> Self {
        ClientError::from(error).into()
    }
}

impl From<CommissionError> for Interruption {
    fn from(error: CommissionError) -> Self {
        match error {
            CommissionError::Client(error) => error.into(),
            CommissionError::Surroundings(SurroundingsError::Interrupted) => Self::Aborted,
            other => Self::Bench(other.to_string()),
        }
    }
}

/// Leads through all stages from the one with the name `from` on, or from the first, and adds to a report. `saved` is called
/// with the report after each stage. When it ends, by whatever reason, the bridge is off if the device can be reached.
///
/// # Errors
/// The report has results of another device. `saved` has not been called then, if the bring-up went on with a stage that
/// needs the device.
pub fn bring_up<L: Link, B: Bench<L>>(
    client: &mut Client<L>,
    bench: &mut B,
    report: Report,
    from: Option<&Stage>,
    saved: &mut dyn FnMut(&Report),
) -> Result<Report, OtherDevice> {
    let mut procedure = Procedure {
        client,
        bench,
        report,
        kept: Kept::new(),
        self_test: None,
        self_test_failed: false,
        blocked: None,
    };
    procedure.report.resume = None;
    let first = from.map_or(StageId::BareBoard, |stage| stage.id);
    for stage in STAGES.iter().filter(|stage| stage.id >= first) {
        if procedure.is_blocked(stage) {
            break;
        }
        let resumed = from.is_some_and(|from| from.id == stage.id);
        if let Err(why) = procedure.stage(stage, resumed) {
            if let Interruption::OtherDevice(refusal) = why {
                // An answer is of no more use.
                let _ignored = procedure.client.ask(&StationRequest::Abort);
                return Err(refusal);
            }
            let reason = procedure.interrupted(stage, &why);
            procedure.report.resume = Some(Resume { stage: stage.name.into(), reason });
            break;
        }
        saved(&procedure.report);
    }
    procedure.resume_at_first_failure();
    let Procedure { client, report, .. } = procedure;
    // Why the procedure ended is in the report; a device that cannot be reached cannot be told either.
    let _ignored = client.ask(&StationRequest::Abort);
    saved(&report);
    Ok(report)
}

/// The procedure while it runs.
pub(super) struct Procedure<'a, L, B> {
    pub client: &'a mut Client<L>,
    pub bench: &'a mut B,
    pub report: Report,
    pub kept: Kept,
    /// The last self-test.
    self_test: Option<SelfTestReport>,
    /// Whether a check of it has failed, so that what it did not reach is no failure of its own.
    self_test_failed: bool,
    /// The first stage that must not be started, or not be continued.
    blocked: Option<StageId>,
}

impl<L: Link, B: Bench<L>> Procedure<'_, L, B> {
    fn stage(&mut self, stage: &'static Stage, resumed: bool) -> Result<(), Interruption> {
        self.bench.begin(stage);
        if resumed {
            self.bench.act(self.client, &stage.needs)?;
            if stage.id > StageId::Chip {
                self.same_device()?;
            }
        }
        for step in stage.steps {
            if self.is_blocked(stage) {
                break;
            }
            match step {
                Step::Manual(manual) => self.act(manual)?,
                Step::Check(check) => self.check(stage, check)?,
                Step::Routine(routine) => self.routine(stage, routine)?,
            }
        }
        // Before a person connects something for the next stage.
        if stage.id >= StageId::Latch {
            self.client.ask(&StationRequest::Abort)?;
        }
        Ok(())
    }

    /// Whether this stage must not be started, or not be continued.
    fn is_blocked(&self, stage: &Stage) -> bool {
        self.blocked.is_some_and(|blocked| blocked <= stage.id)
    }

    /// After a failure the procedure resumes at the stage of that failure.
    fn resume_at_first_failure(&mut self) {
        let mut records = self.report.records.iter();
        if let Some(failed) = records.find(|record| record.verdict == Verdict::Failed) {
            self.report.resume = Some(Resume {
                stage: failed.stage.clone(),
                reason: format!("'{}' has failed", failed.what),
            });
        }
    }

    pub(super) fn act(&mut self, manual: &ManualStep) -> Result<(), Interruption> {
        self.bench.act(self.client, manual)?;
        if manual.wait_ms > 0 {
            self.client.wait(Duration::from_millis(manual.wait_ms))?;
        }
        Ok(())
    }

    fn check(&mut self, stage: &Stage, check: &'static Check) -> Result<(), Interruption> {
        let value = match check.reading {
            Reading::Meter { point, how } => Some(Value::Number(self.meter(check, point, how)?)),
            Reading::Raw(field) => check.value_in(&self.client.ask(&QueryRaw)?, field),
            Reading::Board(field) => check.value_in(&self.client.ask(&QueryBoard)?, field),
            Reading::Kept => self.kept.get(check.name).copied().map(Value::Number),
            Reading::Derived(formula) => {
                formula.value(&self.kept).filter(|value| value.is_finite()).map(Value::Number)
            }
            Reading::SelfTest(field) => {
                self.self_test.as_ref().and_then(|report| check.value_in(report, field))
            }
        };
        let is_self_test = matches!(check.reading, Reading::SelfTest(_));
        let tells = match check.reading {
            Reading::SelfTest(_) => self.missing_value_tells(),
            Reading::Derived(_) => false,
            _ => true,
        };
        if value.is_none() && !tells {
            self.add(record(stage, check, "-".into(), Verdict::NotReached, None), None);
            return Ok(());
        }
        let Some(value) = value else {
            self.self_test_failed |= is_self_test;
            let finding = format!("{}: none; {}", check.what, check.low);
            self.fail(stage, check, "-".into(), finding);
            return Ok(());
        };
        if let Value::Number(number) = &value {
            self.kept.insert(check.name.into(), *number);
        }
        let found = check.expected.text_of(&value);
        let broken = match check.expected.judge(&value) {
            Judgement::Good => {
                self.add(record(stage, check, found, Verdict::Passed, None), None);
                return Ok(());
            }
            Judgement::Low => check.low,
            Judgement::High => check.high,
        };
        self.self_test_failed |= is_self_test;
        let why = match &value {
            Value::Word(word) => explanation(word),
            Value::Number(_) => None,
        };
        let why = [Some(broken), why.as_deref()].into_iter().flatten();
        let why: Vec<_> = why.filter(|why| !why.is_empty()).collect();
        let finding =
            format!("{}: {found} in place of {}; {}", check.what, check.expected, why.join(": "));
        self.fail(stage, check, found, finding);
        Ok(())
    }

    /// Whether a value that the self-test did not reach is the reason why it ended, and not a consequence.
    fn missing_value_tells(&self) -> bool {
        let ended_by_its_own = self.self_test.as_ref().is_some_and(|report| {
            let own = ["comparator", "supply-switch", "supply"];
            own.contains(&report.result.name())
        });
        ended_by_its_own && !self.self_test_failed
    }

    fn meter(
        &mut self,
        check: &Check,
        point: &'static str,
        how: &'static str,
    ) -> Result<f64, Interruption> {
        let Expected::Range(least, most, unit) = check.expected else {
            return Err(Interruption::Bench(format!(
                "{}: an instrument shows no words",
                check.name
            )));
        };
        let measurement = Measurement {
            what: check.what,
            point,
            how,
            unit,
            allowed: (least, most),
            basis: check.basis,
        };
        Ok(self.bench.read(self.client, &measurement)?)
    }

    fn fail(&mut self, stage: &Stage, check: &Check, found: String, finding: String) {
        let record = record(stage, check, found, Verdict::Failed, Some(finding));
        self.add(record, check.blocks);
    }

    /// Adds a result. A failure that makes a stage unsafe keeps it and all later ones from being started.
    pub(super) fn add(&mut self, record: Record, blocks: Option<StageId>) {
        if let Some(stage) = blocks.filter(|_| record.verdict == Verdict::Failed) {
            let known = self.blocked.unwrap_or(stage);
            self.blocked = Some(known.min(stage));
        }
        self.bench.record(&record);
        self.report.records.push(record);
    }

    /// Says why a stage was not finished.
    fn interrupted(&mut self, stage: &Stage, why: &Interruption) -> String {
        let finding = match why {
            Interruption::Aborted | Interruption::OtherDevice(_) => return why.to_string(),
            Interruption::Bench(why) => why.clone(),
            Interruption::Client(error @ ClientError::Refused { .. }) => {
                format!("{error}: not the firmware of this repository, or a step was left out")
            }
            Interruption::Client(error @ ClientError::NotUnderstood { .. }) => format!(
                "{error}: the serial line loses or damages bytes: try another USB port or isolator, and a shorter cable"
            ),
            Interruption::Client(error) => format!(
                "{error}: USB and isolator, the probe's serial port (PA2, PA3; SB13, SB14 closed, SB62, SB63 open), 5 V and 3.3 V, \
                 the flashed firmware; if it has answered before, the serial line loses bytes"
            ),
        };
        let record = Record {
            stage: stage.name.into(),
            check: "interruption".into(),
            what: "the stage is finished".into(),
            expected: "yes".into(),
            found: "no".into(),
            basis: String::new(),
            verdict: Verdict::Failed,
            finding: Some(finding.clone()),
        };
        self.add(record, None);
        finding
    }

    /// Clears the device, arms it, and keeps what its self-test reports. The bridge is off again afterwards.
    pub(super) fn self_test(&mut self, stage: &Stage) -> Result<(), Interruption> {
        (self.self_test, self.self_test_failed) = (None, false);
        let tripped = self.client.ask(&QueryState)?.state.fault();
        let started = match tripped {
            Some(_) => self.client.ask(&StationRequest::Clear),
            None => Ok(()),
        };
        let started = started.and_then(|()| self.client.ask(&StationRequest::Arm));
        if let Err(error) = started {
            let Some(why) = error.refusal() else {
                return Err(error.into());
            };
            let fault = tripped.map_or("", |fault| fault.name());
            let explained = explanation(fault);
            let explained = explained.as_deref().unwrap_or("mend that first");
            let finding =
                format!("the device refuses its self-test (fault `{fault}`; '{why}'): {explained}");
            self.add(refused(stage, why, finding), Some(StageId::Load));
            return Ok(());
        }
        for _ in 0..SELF_TEST_MS / POLL_MS {
            self.client.wait(Duration::from_millis(POLL_MS))?;
            let report = self.client.ask(&QuerySelfTest)?;
            if report.result != SelfTestResult::Running {
                self.self_test = Some(report);
                break;
            }
        }
        Ok(self.client.ask(&StationRequest::Abort)?)
    }
}

/// A result of a check.
fn record(
    stage: &Stage,
    check: &Check,
    found: String,
    verdict: Verdict,
    finding: Option<String>,
) -> Record {
    Record {
        stage: stage.name.into(),
        check: check.name.into(),
        what: check.what.into(),
        expected: check.expected.to_string(),
        found,
        basis: check.basis.into(),
        verdict,
        finding,
    }
}

fn refused(stage: &Stage, why: &str, finding: String) -> Record {
    Record {
        stage: stage.name.into(),
        check: "self-test".into(),
        what: "the device runs its self-test".into(),
        expected: "yes".into(),
        found: why.into(),
        basis: "no fault is present".into(),
        verdict: Verdict::Failed,
        finding: Some(finding),
    }
}
