#!/bin/sh
# Guess: a library for thermistors maps a shorted and an open sensor to opposite ends of its range, or refuses both.
#
# Seen, with thermistor 1.1 on Python 3.11 and numpy 2.4.6: both read -273.15 C, which is plausible to a controller as "cold, heat
# on". No resistance (a short) and an infinite resistance (what some meters return for an open wire) both end in
# 1 / infinity in the B equation; only a warning of numpy's logarithm shows the short.
#
# A device must refuse both resistances by themselves before they are converted, as the firmware of this repository does
# (`display-open`, `display-short`).
#
# Fails if one of them reads otherwise.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --disable-pip-version-check thermistor==1.1 numpy==2.4.6
"$folder/env/bin/python" -W ignore - <<'PYTHON'
import math

from thermistor import Thermistor

kilohms = {"25 C": 10.0, "shorted": 0.0, "open": math.inf}
thermistor = Thermistor(lambda: 1.0)
seen = {name: float(thermistor.R_to_T(kilohm)) for name, kilohm in kilohms.items()}
for name, kilohm in kilohms.items():
    print(f"{name}: {kilohm} kilohm reads {seen[name]:.2f} C")
assert abs(seen["25 C"] - 25.0) < 1e-9
assert seen["shorted"] == seen["open"] == -273.15, "CHANGED"
PYTHON
