#!/bin/sh
# Guess: psignifit's option `thresh_PC` says at which value of the sigmoid the threshold lies, however the sigmoid is given.
#
# Seen, with psignifit 4.3 on Python 3.11: a sigmoid that is given by its name obeys, one that is given as an object (the documented way
# to use one of one's own) does not: its threshold stays at 0.5. The option sets the object's attribute `PC`, but the object computes
# with a copy made when it was created. With `thresh_PC=0.8` the same data have the threshold 4.77 with `"norm"` and 4.00
# with `Gaussian()`, and the result of either says 0.8 in its configuration. `Gaussian(PC=0.8)` gives 4.77.
#
# Fails if one of these thresholds changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check psignifit==4.3 numpy==2.4.6 scipy==1.17.1
"$folder/env/bin/python" -W ignore - <<'PYTHON'
from math import erf, sqrt

import numpy as np
from psignifit import psignifit
from psignifit.sigmoids import Gaussian

# Two-alternative forced choice, 2 % lapses; the detection itself is a normal distribution of mean 4 and standard deviation 0.91.
levels = np.arange(1.0, 8.0)
correct = [0.5 + 0.48 * (1 + erf((level - 4.0) / (0.912 * sqrt(2.0)))) / 2 for level in levels]
data = np.column_stack([levels, np.round(200 * np.array(correct)), np.full(len(levels), 200)])
seen = {}
for name, sigmoid in (('"norm"', "norm"), ("Gaussian()", Gaussian()), ("Gaussian(PC=0.8)", Gaussian(PC=0.8))):
    fit = psignifit(data, sigmoid=sigmoid, experiment_type="2AFC", thresh_PC=0.8)
    assert fit.configuration.thresh_PC == 0.8
    seen[name] = round(float(fit.parameter_estimate["threshold"]), 2)
    print(f"{name}: threshold {seen[name]}")
assert seen == {'"norm"': 4.77, "Gaussian()": 4.0, "Gaussian(PC=0.8)": 4.77}, "CHANGED"
PYTHON
