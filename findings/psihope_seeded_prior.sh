#!/bin/sh
# Guess: a seed makes psihope's draws from a prior repeatable, and leaves the parameters independent, as their separate priors say.
#
# Seen, with psihope 0.1.1 on Python 3.11: each parameter is drawn with the seed anew, hence from the same random numbers. Intercept and
# slope, each with a normal prior of its own, have a correlation of 1 in the sample: of 1000 draws none has a low intercept and a high
# slope, where a quarter should. Without a seed the correlation is near 0. With these particles its sampler starts, and chooses the
# first stimuli.
#
# Give the seed to the sampler, not to the model.
#
# Installed without its declared dependency PyTorch, gigabytes that the prior does not use; its place is taken by a stand-in.
#
# Fails if a correlation changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check numpy==2.4.6 scipy==1.17.1
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps psihope==0.1.1
"$folder/env/bin/python" - <<'PYTHON'
import sys
from unittest.mock import MagicMock

for module in ("torch", "torch.distributed.flight_recorder.components.types", "torch.distributions.multivariate_normal"):
    sys.modules[module] = MagicMock(Tensor=type("Tensor", (), {}))

import numpy as np
from hope.psychometric_functions import logistic_regression
from hope.psychometric_model import BinaryPsychometricModel
from scipy.stats import norm

priors = {"intercept": norm(2.0, 1.0), "slope": norm(5.0, 2.0)}
seen = {}
for seed in (1, 2, None):
    np.random.seed(3)  # what an unseeded model draws from
    sample = BinaryPsychometricModel(logistic_regression, priors, seed=seed).sample_prior(1000)
    low, high = sample[:, 0] < 2.0, sample[:, 1] > 5.0
    seen[seed] = (round(float(np.corrcoef(sample.T)[0, 1]), 1), int((low & high).sum()))
    print(f"seed {seed}: correlation {np.corrcoef(sample.T)[0, 1]:.3f}; low intercept and high slope in {seen[seed][1]} of 1000")
assert seen[1] == seen[2] == (1.0, 0), "CHANGED"
assert abs(seen[None][0]) <= 0.1 and 200 < seen[None][1] < 300, "CHANGED"
PYTHON
