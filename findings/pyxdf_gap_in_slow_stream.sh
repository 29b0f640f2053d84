#!/bin/sh
# Guess: pyxdf's correction of jitter leaves an interruption of a stream where it was.
#
# Seen, with pyxdf 1.17.5 on Python 3.11: not if fewer than 500 sample periods are missing, however long that is. The times before and
# after the gap are then fitted by one line, as if nothing had been interrupted. A thermometer's stream of 10 Hz that pauses for 40 s
# halfway through 200 s gets times that are wrong by up to 20 s, and an effective rate of 7.7 Hz; at 1 Hz eight minutes may be
# missing. With a pause of 60 s, 600 periods, the gap is found. Both thresholds, 1 s and 500 samples, must be crossed, as the
# documentation says of each; the second suits EEG, and what follows for slow streams is not said.
#
# Events in another stream are then early or late against the temperature. `jitter_break_threshold_samples=1` finds both gaps.
#
# Fails if one of the shifts changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --no-compile --disable-pip-version-check pyxdf==1.17.5 numpy==2.4.6
env/bin/python -W ignore - <<'PYTHON'
import logging
from struct import pack

import numpy as np
import pyxdf

logging.disable(logging.WARNING)


def chunk(tag, content):
    return b"\x04" + pack("<I", 2 + len(content)) + pack("<H", tag) + content


def write(path, times_s):
    """Writes one stream of one double at 10 Hz; after the format's specification, version 1.0."""
    head = (
        "<info><name>plate</name><type>temperature</type><channel_count>1</channel_count>"
        "<nominal_srate>10</nominal_srate><channel_format>double64</channel_format></info>"
    )
    foot = f"<info><first_timestamp>{times_s[0]}</first_timestamp><last_timestamp>{times_s[-1]}</last_timestamp></info>"
    samples = b"".join(b"\x08" + pack("<dd", time, 32.0) for time in times_s)
    with open(path, "wb") as file:
        file.write(b"XDF:" + chunk(1, b"<info><version>1.0</version></info>"))
        file.write(chunk(2, pack("<I", 1) + head.encode()))
        file.write(chunk(3, pack("<I", 1) + b"\x04" + pack("<I", len(times_s)) + samples))
        file.write(chunk(6, pack("<I", 1) + foot.encode()))


seen = {}
for gap_s in (40, 60):
    written = np.arange(2000) / 10
    written[1000:] += gap_s
    write("plate.xdf", written)
    for name, options in (("as it is", {}), ("1 sample", {"jitter_break_threshold_samples": 1})):
        stream = pyxdf.load_xdf("plate.xdf", **options)[0][0]
        shift_s = float(np.abs(stream["time_stamps"] - written).max())
        seen[gap_s, name] = round(shift_s, 1)
        print(f"gap of {gap_s} s, {name}: times shifted by up to {shift_s:.1f} s, {stream['info']['effective_srate']:.1f} Hz")
assert seen == {(40, "as it is"): 20.0, (40, "1 sample"): 0.0, (60, "as it is"): 0.0, (60, "1 sample"): 0.0}, "CHANGED"
PYTHON
