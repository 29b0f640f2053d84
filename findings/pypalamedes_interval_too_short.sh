#!/bin/sh
# Guess: a high-density interval holds at least the mass that is asked for, or the mass of a grid point more.
#
# Seen, with pypalamedes 1.11.13 on Python 3.11: `hdi` holds less. It takes the points in the order of their density as long as their sum is
# below the mass, without the one that reaches it. On a grid of nine thresholds, a usual one for an adaptive procedure, an interval of
# 95 % holds 89 %, one of 90 % the same points, and one of 50 % a single point with 33 %.
#
# Of a posterior on a coarse grid, add the next point, or give the interval's mass beside it.
#
# Installed without its declared dependencies, which ask for more than Python 3.11 has; these functions need numpy and scipy only.
#
# Fails if one of the masses changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check numpy==2.4.6 scipy==1.17.1 matplotlib==3.11.2
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps pypalamedes==1.11.13
MPLBACKEND=Agg "$folder/env/bin/python" -W ignore - <<'PYTHON'
import numpy as np
from pypalamedes import hdi

thresholds = np.linspace(-1, 1, 9)
posterior = np.exp(-(((thresholds - 0.01) / 0.3) ** 2) / 2)
posterior /= posterior.sum()
seen = {}
for mass in (0.95, 0.9, 0.5):
    ((low, high),) = hdi(thresholds, posterior, mass)
    held = float(posterior[(thresholds >= low) & (thresholds <= high)].sum())
    seen[mass] = round(held, 3)
    print(f"asked for {mass}: from {low} to {high}, which holds {held:.3f}")
assert seen == {0.95: 0.89, 0.9: 0.89, 0.5: 0.332}, "CHANGED"
PYTHON
