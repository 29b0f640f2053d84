#!/bin/sh
# Guess: psignifit's `slope_at_proportion_correct(p, estimate_type="mean")` is the slope of the mean estimate at its own threshold for p.
#
# Seen, with psignifit 4.3 on Python 3.11: the level comes from the estimate that is asked for, the slope there from the estimate of the
# configuration, by default the mode (`MAP`). With 20 trials a level, the slope at 75 % correct is given as 0.149 a unit where
# that of the mean estimate is 0.127. `slope(threshold(p, estimate_type="mean"), estimate_type="mean")` gives the latter.
#
# Fails if one of the two slopes changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check psignifit==4.3 numpy==2.4.6 scipy==1.17.1
"$folder/env/bin/python" -W ignore - <<'PYTHON'
import numpy as np
from psignifit import psignifit

# Level, correct answers, trials: two-alternative forced choice.
data = np.array([[1, 10, 20], [2, 11, 20], [3, 12, 20], [4, 15, 20], [5, 18, 20], [6, 19, 20], [7, 20, 20]], dtype=float)
fit = psignifit(data, experiment_type="2AFC")
given = float(fit.slope_at_proportion_correct(0.75, estimate_type="mean"))
level = fit.threshold(0.75, return_ci=False, estimate_type="mean")
mean, mode = (float(fit.slope(level, estimate_type=kind)) for kind in ("mean", "MAP"))
print(f"at 75 % correct, level {level:.3f} of the mean estimate: slope given {given:.4f}, of the mean {mean:.4f}, of the mode {mode:.4f}")
assert given == mode and (round(given, 3), round(mean, 3)) == (0.149, 0.127), "CHANGED"
PYTHON
