#!/bin/sh
# Guess: QUEST+ joins a prior that is given by the name of its parameter to that parameter.
#
# Seen, with questplus 2023.1 on Python 3.11 and xarray 2026.9.0: only if the prior leaves out a parameter. If it has all of them, they are
# taken in the order in which the dictionary lists them, not by name, and if two parameters have equally many values, nothing
# complains. A prior for a threshold near -2 and a slope near 5, with the slope listed first, becomes one for a threshold near 2 and a
# slope near 1, and the first stimulus that is proposed moves from -1 to 1.
#
# The prior must list the parameters in the order of `param_domain`.
#
# Fails if the order makes no difference any more, or one where a parameter is left out.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check questplus==2023.1 numpy==2.4.6 scipy==1.17.1 xarray==2026.9.0
"$folder/env/bin/python" - <<'PYTHON'
from questplus import QuestPlus

levels = [-2.0, -1.0, 0.0, 1.0, 2.0]
domain = {"threshold": levels, "slope": [1.0, 2.0, 3.0, 4.0, 5.0], "lower_asymptote": [0.5], "lapse_rate": [0.02]}
threshold = {"threshold": [0.96, 0.01, 0.01, 0.01, 0.01]}
slope = {"slope": [0.01, 0.01, 0.01, 0.01, 0.96]}
rest = {"lower_asymptote": [1.0], "lapse_rate": [1.0]}
seen = []
for prior in (threshold | slope | rest, slope | threshold | rest, threshold | slope, slope | threshold):
    staircase = QuestPlus(
        stim_domain={"intensity": levels},
        param_domain=domain,
        outcome_domain={"response": ["yes", "no"]},
        prior=prior,
        func="weibull",
        stim_scale="log10",
    )
    estimate = staircase.param_estimate
    seen.append((round(estimate["threshold"], 6), round(estimate["slope"], 6), staircase.next_stim["intensity"]))
    print(f"prior of {', '.join(prior)}: threshold {seen[-1][0]}, slope {seen[-1][1]}, next stimulus {seen[-1][2]}")
named, swapped = (-1.9, 4.9, -1.0), (1.9, 1.1, 1.0)
assert seen == [named, swapped, named, named], "CHANGED"
PYTHON
