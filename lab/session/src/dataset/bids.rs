//! The files that BIDS describes, written from the records.

use std::collections::BTreeSet;

use serde_json::json;

use super::folder::{SharedFiles, remove_parts, write_whole};
use super::participants::ParticipantList;
use super::recorder::{TELEMETRY, pretty};
use super::{Folder, RecordingError, events, is_there, physio};
use crate::record::TrialRecord;
use crate::{Plan, Session};

const BIDS_VERSION: &str = "1.10.0";

/// What the data set says of itself.
const README: &str = "\
# Experiments on a thermal display

Behavioural data of experiments with a Peltier thermal display, recorded by thermal-lab. Participants have codes, no names.

- `sub-*/beh/*_events.tsv`: a row for each trial; the columns are described in the `.json` beside it. Rows with a reason in
  `void` do not count.
- `participants.tsv`: who took part. The analysis leaves out whoever has `yes` in its column `excluded`, if there is one.
- `sub-*/beh/*_physio.tsv.gz`: telemetry of the device: set-point, temperatures, force, current. Rows in breaks are n/a.
- `sourcedata/`: session file, plan, log and telemetry from which these files are written.

Temperatures are in degrees Celsius, forces in newtons. Times count in seconds from the begin of the session; what the clock
said is in `sourcedata/sub-*/task-*/clock.json`.
";

/// Writes the files that describe a data set, unless it has them.
pub(super) fn describe(folder: &Folder, _shared: &SharedFiles) -> Result<(), RecordingError> {
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
        remove_parts(folder.root(), name)?;
        let path = folder.root().join(name);
        if !is_there(&path)? {
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
            let telemetry = folder.source(TELEMETRY);
            let rows = physio::compressed(&telemetry, &session.title, finger, device.stream_ms)?;
            write_whole(&name("tsv.gz"), &rows.gzip)?;
            write_whole(&name("json"), &pretty(&rows.sidecar))?;
        }
    }
    add_participant(folder)
}

/// Adds the participant to the list.
fn add_participant(folder: &Folder) -> Result<(), RecordingError> {
    let _shared = SharedFiles::lock(folder.root())?;
    let mut list = ParticipantList::read(folder.root())?;
    if list.has(folder.participant()) {
        return Ok(());
    }
    list.add(folder.participant());
    list.write()
}
