#!/bin/sh
# Guess: the parameter `var` of fitpsyche measures the width of the fitted function for both of its models, lower being steeper, as the
# documentation of its class says.
#
# Seen, with fitpsyche 0.1.0 on Python 3.11: for "wh" it is the standard deviation, not the variance. For "logit", which is the default
# and by the documentation a cumulative normal function too, it is the slope of a logistic function: higher is steeper. Answers from
# normal functions of standard deviation 1, 2 and 4 give 1, 2, 4 with "wh" and 1.71, 0.85, 0.42 with "logit".
#
# Discrimination thresholds from the default model are in the reverse order, and in the inverse of the stimulus's unit.
#
# Fails if one of the fitted parameters changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check fitpsyche==0.1.0 scikit-learn==1.9.1 \
    numpy==2.4.6 scipy==1.17.1 matplotlib==3.11.2
MPLBACKEND=Agg "$folder/env/bin/python" - <<'PYTHON'
import numpy as np
from fit_psyche.psychometric_curve import PsychometricCurve
from scipy.stats import norm

levels = np.arange(0.0, 21.0)
seen = {"wh": [], "logit": []}
for deviation in (1, 2, 4):
    for model, fitted in seen.items():
        curve = PsychometricCurve(model=model, guess_rate_lims=(0, 1e-6), lapse_rate_lims=(0, 1e-6))
        fitted.append(round(float(curve.fit(levels, norm.cdf(levels, 10, deviation)).coefs_["var"]), 2))
        print(f"standard deviation {deviation}, {model}: var {fitted[-1]}")
assert seen == {"wh": [1.0, 2.0, 4.0], "logit": [1.71, 0.85, 0.42]}, "CHANGED"
PYTHON
