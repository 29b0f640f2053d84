#!/bin/sh
# Guess: simple-pid, called with the time step `dt` of a simulation, computes at every call or once per `sample_time`.
#
# Seen, with simple-pid 2.0.1 on Python 3.11: if `dt` is shorter than `sample_time`, which is 0.01 s unless something else is asked
# for, only the first call computes. Each later one compares its own `dt`, not the time since the last computation, with
# `sample_time`, and returns the first output for ever. In a plant stepped by 1 ms the output stays where the first step put it, also
# after the error has changed its sign. Measured time, without `dt`, does add up.
#
# A simulation needs `sample_time=None`.
#
# Fails if an output changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check simple-pid==2.0.1
"$folder/env/bin/python" - <<'PYTHON'
from simple_pid import PID


def outputs(dt, **options):
    """Outputs of ten calls, then of one after the error has changed its sign."""
    controller = PID(1.0, 0.0, 0.0, setpoint=1.0, **options)
    return [controller(measured, dt=dt) for measured in [0.1 * step for step in range(10)] + [1.5]]


seen = {}
for name, dt, options in (("1 ms", 0.001, {}), ("10 ms", 0.01, {}), ("1 ms, sample_time=None", 0.001, {"sample_time": None})):
    seen[name] = [round(output, 1) for output in outputs(dt, **options)]
    print(f"{name}: {seen[name]}")
computed = [round(1.0 - 0.1 * step, 1) for step in range(10)] + [-0.5]
assert seen == {"1 ms": [1.0] * 11, "10 ms": computed, "1 ms, sample_time=None": computed}, "CHANGED"
PYTHON
