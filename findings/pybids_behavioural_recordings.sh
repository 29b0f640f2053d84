#!/bin/sh
# Guess: pybids gives the variables of a valid behavioural data set, its events and recordings, as it does for imaging.
#
# Seen, with pybids 0.22.0 on Python 3.11: `get_collections("run")` takes `events` and `physio` by its documentation, and raises "No
# functional images that match criteria found." for recordings in `beh/`, where BIDS 1.10 allows both without any image. It looks for
# the images first and for the variables of each.
#
# File by file it works, with one trap: `get_df()` numbers the samples of a recording from 0 s. `StartTime` of the side file, -2 s
# here, is added by `get_df(adjust_onset=True)` only; without it a recording that begins before the first event is late by as much.
#
# Fails if the collection is given, or one of the times changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --no-compile --disable-pip-version-check pybids==0.22.0 numpy==2.4.6
env/bin/python -W ignore - <<'PYTHON'
import gzip
import json
from pathlib import Path

from bids import BIDSLayout

base = Path("data/sub-01/beh")
base.mkdir(parents=True)
Path("data/dataset_description.json").write_text(json.dumps({"Name": "Touch", "BIDSVersion": "1.10.0", "DatasetType": "raw"}))
name = "sub-01_task-touch"
(base / f"{name}_events.tsv").write_text("onset\tduration\ttrial_type\n0.0\t2.0\twarm\n5.0\t2.0\tcold\n")
(base / f"{name}_events.json").write_text(json.dumps({"TaskName": "touch"}))
side = {"SamplingFrequency": 10, "StartTime": -2.0, "Columns": ["temperature"], "temperature": {"Units": "oC"}}
(base / f"{name}_physio.json").write_text(json.dumps(side))
with gzip.open(base / f"{name}_physio.tsv.gz", "wt") as recording:
    recording.writelines(f"{30 + sample / 100:.2f}\n" for sample in range(100))

layout = BIDSLayout("data")
for kind in ("events", "physio"):
    try:
        layout.get_collections("run", types=[kind])
        raise SystemExit("CHANGED")
    except ValueError as error:
        print(f"{kind}: {error}")
        assert "images" in str(error), "CHANGED"
recording = layout.get(suffix="physio", extension=".tsv.gz")[0]
first = [float(recording.get_df(adjust_onset=adjust)["onset"].iloc[0]) for adjust in (False, True)]
assert float(recording.get_df()["onset"].iloc[0]) == first[0]
print(f"first sample: {first[0]} s, with adjust_onset {first[1]} s")
assert first == [0.0, -2.0], "CHANGED"
PYTHON
