#!/bin/sh
# Guess: a threshold that lies beyond the measured levels is extrapolated, or refused.
#
# Seen, with bayesfit 2.4.1, numpy 1.26.4 and scipy 1.11.4 on Python 3.11: `get_threshold` looks for the nearest proportion between
# the lowest and the highest level, and returns one of these if the function does not reach the proportion there. For detections that
# are at 80 % at the highest level, 7, the thresholds for 85, 90 and 95 % are all 7.0; that for 30 %, which a two-alternative
# experiment never has, is the lowest level, 1.0. Nothing warns.
#
# A threshold equal to an end of the measured range is to be refused.
#
# Fails if one of the thresholds changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check bayesfit==2.4.1 numpy==1.26.4 scipy==1.11.4
MPLBACKEND=Agg "$folder/env/bin/python" -W ignore - <<'PYTHON'
import bayesfit
import numpy as np

# Level, correct answers, trials: two-alternative forced choice.
data = np.array([[1, 10, 20], [2, 10, 20], [3, 11, 20], [4, 13, 20], [5, 14, 20], [6, 15, 20], [7, 16, 20]], dtype=float)
metrics, options = bayesfit.fitmodel(data, sigmoid_type="norm", nafc=2)
seen = {}
for proportion in (0.3, 0.75, 0.85, 0.9, 0.95):
    seen[proportion] = round(float(bayesfit.get_threshold(data, options, metrics, proportion)), 1)
    print(f"threshold of {proportion}: {seen[proportion]}")
assert seen == {0.3: 1.0, 0.75: 6.0, 0.85: 7.0, 0.9: 7.0, 0.95: 7.0}, "CHANGED"
PYTHON
