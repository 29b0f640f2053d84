#!/bin/sh
# Guess: the level that a fitted psychometric function gives for a proportion is the level at which it predicts that proportion.
#
# Seen, with psignifit 4.3 on Python 3.11: not for decreasing functions (`neg_norm` and the other `neg_` sigmoids) whose
# asymptotes differ. The function is mirrored with both asymptotes, so that lambda is the lower one; its inverse takes gamma
# for the lower one. For detections that fall from 98 % to 20 %, `threshold(0.5)` is a level at which `proportion_correct` predicts
# 0.67, and `threshold(0.9)` is refused. Both take proportions of the fitted, scaled function by their documentation.
#
# Detection of a warm tile over the pause before it falls so. With the levels' signs changed, an increasing function fits the
# same data, and the two agree.
#
# Fails if one of these figures changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check psignifit==4.3 numpy==2.4.6 scipy==1.17.1
"$folder/env/bin/python" -W ignore - <<'PYTHON'
from math import erf, sqrt

import numpy as np
from psignifit import psignifit

levels = np.arange(1.0, 8.0)
detected = [0.98 - 0.78 * (1 + erf((level - 4.0) / sqrt(2.0))) / 2 for level in levels]
trials = 200
seen = {}
for sigmoid, sign in (("neg_norm", 1.0), ("norm", -1.0)):
    data = np.column_stack([sign * levels, np.round(trials * np.array(detected)), np.full(len(levels), trials)])
    fit = psignifit(data, sigmoid=sigmoid, experiment_type="yes/no")
    for proportion in (0.3, 0.5, 0.75, 0.9):
        try:
            level = fit.threshold(proportion, return_ci=False)
        except ValueError:
            seen[sigmoid, proportion] = None
            print(f"{sigmoid}: threshold({proportion}) is refused")
            continue
        seen[sigmoid, proportion] = round(float(fit.proportion_correct(level)), 2)
        print(f"{sigmoid}: threshold({proportion}) is {level:.3f}, where the function predicts {seen[sigmoid, proportion]}")
expected = {0.3: 0.47, 0.5: 0.67, 0.75: 0.92, 0.9: None}
assert all(seen["neg_norm", proportion] == value for proportion, value in expected.items()), "CHANGED"
assert all(seen["norm", proportion] == proportion for proportion in expected), "CHANGED"
PYTHON
