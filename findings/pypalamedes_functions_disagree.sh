#!/bin/sh
# Guess: each psychometric function of pypalamedes agrees with its own `Inverse` and `Derivative`.
#
# Seen, with pypalamedes 1.11.13 on Python 3.11: four of seven do (weibull, gumbel, logistic, cumulative_normal). With threshold 1,
# slope 1.5, guesses 0.5, lapses 0.02:
# - log_quick multiplies only the level by the slope, not its distance from the threshold: at the threshold it is 0.926 in place of
#   the half-way 0.74, and its inverse inverts the intended function. With slope 1 or threshold 0 nothing shows.
# - quick: the derivative is too large by 1 / ln 2, 44 %.
# - hyperbolic_secant: the derivative at the threshold is 0.24 in place of 0.36, and not symmetric about it.
#
# The first is a wrong likelihood for the psi method, if that function is chosen.
#
# Installed without its declared dependencies, which ask for more than Python 3.11 has; these functions need numpy and scipy only.
#
# Fails if one of the seven changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check numpy==2.4.6 scipy==1.17.1 matplotlib==3.11.2
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps pypalamedes==1.11.13
MPLBACKEND=Agg "$folder/env/bin/python" -W ignore - <<'PYTHON'
import numpy as np
import pypalamedes

PARAMETERS = [1.0, 1.5, 0.5, 0.02]
LEVELS = np.array([0.8, 1.0, 1.2])
STEP = 1e-6

agree = {}
for name in ("weibull", "gumbel", "logistic", "cumulative_normal", "quick", "log_quick", "hyperbolic_secant"):
    function = getattr(pypalamedes, name)
    inverse = function(PARAMETERS, function(PARAMETERS, LEVELS), "Inverse")
    derivative = function(PARAMETERS, LEVELS, "Derivative")
    difference = (function(PARAMETERS, LEVELS + STEP) - function(PARAMETERS, LEVELS - STEP)) / (2 * STEP)
    agree[name] = (bool(np.allclose(inverse, LEVELS)), bool(np.allclose(derivative, difference, rtol=1e-6)))
    print(f"{name}: {function(PARAMETERS, LEVELS)[1]:.3f} at the threshold; inverse of the function at 0.8, 1, 1.2:", end=" ")
    print(f"{np.round(inverse, 2)}; derivative {np.round(derivative, 2)}, difference {np.round(difference, 2)}")
expected = {name: (True, True) for name in agree}
expected |= {"quick": (True, False), "log_quick": (False, False), "hyperbolic_secant": (True, False)}
assert agree == expected, "CHANGED"
assert round(float(pypalamedes.log_quick(PARAMETERS, LEVELS)[1]), 3) == 0.926, "CHANGED"
PYTHON
