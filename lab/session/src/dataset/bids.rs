//! The files that BIDS describes, written from the records.

use std::collections::BTreeSet;
use std::fs;

use serde_json::json;

use super::folder::write_whole;
use super::recorder::{TELEMETRY, pretty};
use super::{Folder, RecordingError, error_at, events, physio};
use crate::record::TrialRecord;
use crate::{Plan, Session};

const BIDS_VERSION: &str = "1.10.0";

/// What the data set says of itself.
const README: &str = "\
# Experiments on a thermal display

Behavioural data of experiments with a Peltier thermal display, recorded by thermal-lab. Participants have codes, no names.

- `sub-*/beh/*_events.tsv`: a row for each trial; the columns are described in the `.json` beside it. Rows with a reason in
  `void` do not count.
- `sub-*/beh/*_physio.tsv.gz`: telemetry of the device: set-point, temperatures, force, current. Rows in breaks are n/a.
- `sourcedata/`: session file, plan, log and telemetry from which these files are written.

Temperatures are in degrees Celsius, forces in newtons. Times count in seconds from the begin of the session; what the clock
said is in `sourcedata/sub-*/task-*/clock.json`.
";

/// Writes the files that describe a data set, unless it has them.
pub(super) fn describe(folder: &Folder) -> Result<(), RecordingError> {
    let _alone = folder.lock_shared_files()?;
    let description = json!({
        "Name": "Experiments on a thermal display",
        "BIDSVersion": BIDS_VERSION,
        "DatasetType": "raw",
        "License": "n/a",
        "GeneratedBy": [{ "Name": "thermal-lab", "Version": env!("CARGO_PKG_VERSION") }],
    });
    let participants = json!({ "participant_id": { "Description": "Code of the participant" } });
    for (name, contents) in [
        ("dataset_description.json", pretty(&description)),
        ("README.md", README.into()),
        ("participants.json", pretty(&participants)),
        ("participants.tsv", b"participant_id\n".to_vec()),
    ] {
        let path = folder.root().join(name);
        if !path.exists() {
            write_whole(&path, &contents)?;
        }
    }
    Ok(())
}

/// Writes the files of a participant and task.
pub(super) fn write(
    folder: &Folder,
    session: &Session,
    plan: &Plan,
    records: &[TrialRecord],
) -> Result<(), RecordingError> {
    if records.is_empty() {
        return Ok(());
    }
    let table = events::table(session, plan, records);
    write_whole(&folder.behaviour("events.tsv"), table.as_bytes())?;
    let sidecar = pretty(&events::sidecar(session, plan));
    write_whole(&folder.behaviour("events.json"), &sidecar)?;
    if let Some(device) = &session.device {
        let trials = plan.trials.iter();
        let fingers: BTreeSet<u8> =
            trials.flat_map(|trial| session.reporting_fingers(trial)).collect();
        for finger in fingers {
            let name =
                |end: &str| folder.behaviour(&format!("recording-finger{finger}_physio.{end}"));
            let rows = physio::compressed(&folder.source(TELEMETRY), finger, device.stream_ms)?;
            write_whole(&name("tsv.gz"), &rows.gzip)?;
            write_whole(&name("json"), &pretty(&rows.sidecar))?;
        }
    }
    add_participant(folder)
}

/// Adds the participant to the list.
fn add_participant(folder: &Folder) -> Result<(), RecordingError> {
    let _alone = folder.lock_shared_files()?;
    let path = folder.root().join("participants.tsv");
    let mut list = fs::read_to_string(&path).map_err(error_at(&path))?;
    let code = format!("sub-{}", folder.participant());
    if list.lines().any(|line| line.split('\t').next() == Some(&code)) {
        return Ok(());
    }
    // A list with more columns, which a person has added, has no values of this participant in them.
    let others = list.lines().next().map_or(0, |header| header.split('\t').count() - 1);
    if !list.ends_with('\n') {
        list.push('\n');
    }
    list += &format!("{code}{}\n", "\tn/a".repeat(others));
    write_whole(&path, list.as_bytes())
}
