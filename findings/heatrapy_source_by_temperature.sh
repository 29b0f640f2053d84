#!/bin/sh
# Guess: the four solvers of heatrapy agree on a heat source, also on one that depends on the temperature as the perfusion of skin does.
#
# Seen, with heatrapy 2.1.1 on Python 3.11: the explicit ones are right, the implicit ones are not. Insulated water at 300 K, heated by
# 4 MW/m3 and cooled by 0.4 MW/m3 for each kelvin above 300 K, is at 308.51 K after 20 s.
# - `implicit_k(x)` multiplies the coefficient `Q` by the square of the time step where the square of the space step belongs. With 10 mm
#   and 0.01 s the two are the same number, and 308.51 K comes out. With 10 mm and 0.1 s the water settles at 3.1 K.
# - `implicit_general` takes twice the source at 0 K and does not let the temperature act on it: 1480 K. A source that does not depend
#   on the temperature (`Q0` alone) is doubled too: 338.1 K in place of 319.05 K. The other three agree on it.
# Nothing warns.
#
# Skin whose perfusion is modelled with `Q` needs an explicit solver.
#
# Fails if one of the temperatures changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check heatrapy==2.1.1
MPLBACKEND=Agg "$folder/env/bin/python" - <<'PYTHON'
import math

from heatrapy import SingleObject1D

START_K = 300.0
SOURCE = 4e6  # W/m3
SINK = 4e5  # W/(m3 K)
VOLUMETRIC_HEAT = 4.2e6  # J/(m3 K), of heatrapy's water
SECONDS = 20.0


def after(solver, time_step, sink):
    """Temperature, K, of water cut into cells of 10 mm."""
    water = SingleObject1D(START_K, materials=("water",), borders=(1, 11), dx=0.01, dt=time_step, boundaries=(0, 0), draw=[])
    water.change_power("Q0", SOURCE, 1, 11)
    water.change_power("Q", -sink, 1, 11)
    water.compute(SECONDS, 1000, solver=solver, verbose=False)
    return round(water.object.temperature[5][0], 1)


exact = START_K + SOURCE / SINK * (1 - math.exp(-SECONDS * SINK / VOLUMETRIC_HEAT))
print(f"exact: {exact:.2f} K; without a sink {START_K + SOURCE * SECONDS / VOLUMETRIC_HEAT:.2f} K")
expected = {
    "explicit_general": (308.5, 308.5, 319.0),
    "explicit_k(x)": (308.5, 308.5, 319.0),
    "implicit_general": (1479.8, 1469.8, 338.1),
    "implicit_k(x)": (308.5, 3.1, 319.0),
}
for solver, temperatures in expected.items():
    seen = (after(solver, 0.01, SINK), after(solver, 0.1, SINK), after(solver, 0.1, 0.0))
    print(f"{solver}: steps of 0.01 s {seen[0]} K, of 0.1 s {seen[1]} K; without a sink {seen[2]} K")
    assert seen == temperatures, "CHANGED"
PYTHON
