#!/bin/sh
# Guess: a staircase that is held at a bound of its levels goes on from there with the step that it had.
#
# Seen, with psychopy-pest 2.1.0 on Python 3.11: its step doubles while the level stands still. From 4 down to the bound 0 by a step of
# 4, then 16 correct answers at 0: four steps that move nothing bring the step to 32, and the first wrong answers are followed by a
# level of 16, half of it, although the level never moved by more than 4 before. The history gives the steps that were not taken.
#
# With levels in kelvin the next stimulus is 16 K in place of 2. Set `max_step_size` to a step that may be presented, or let the
# levels go on below the bound and limit the stimulus instead.
#
# Installed without its declared dependencies (PsychoPy); the algorithm needs none.
#
# Fails if one of the levels or steps changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps psychopy-pest==2.1.0
"$folder/env/bin/python" - <<'PYTHON'
from psychopy_pest import PEST

staircase = PEST(initial_level=4, initial_step_size=4, min_step_size=1, max_step_size=32, min_level=0)
steps = []
answers = 0
while not steps or steps[-1][1] != 1:
    presented = staircase.level
    staircase.update(answers < 20)
    answers += 1
    direction, size = staircase.history["direction"][-1], staircase.history["step_size"][-1]
    if direction:
        steps.append((presented, direction, size, staircase.level))
        print(f"after {answers} answers: from {presented:g} to {staircase.level:g} by a step of {direction * size:g}")
expected = [(4, -1, 4, 0), (0, -1, 4, 0), (0, -1, 8, 0), (0, -1, 16, 0), (0, -1, 32, 0), (0, 1, 16, 16)]
assert steps == expected, "CHANGED"
PYTHON
