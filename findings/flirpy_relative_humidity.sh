#!/bin/sh
# Guess: flirpy converts a thermal image with the relative humidity that the camera wrote into it, in percent.
#
# Seen, with flirpy 0.6.2 on Python 3.11: `raw2temp` takes 50 % as 50, a hundred times the water vapour of 0.5. It means to convert
# percent to a fraction, but divides only numbers above 100. Half-saturated air at 20 C then holds 856 mmHg of vapour (saturated air:
# 17.5 mmHg), and a metre of it transmits 0.958 in place of 0.996. A plate of 3.97 C, seen from 1 m, reads 2.56 C; from 0.3 m the
# error is 0.7 K. It vanishes only where the plate has the temperature of the air.
#
# Give the humidity as a fraction.
#
# Fails if one of the temperatures changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check flirpy==0.6.2
"$folder/env/bin/python" -W ignore - <<'PYTHON'
import numpy as np
from flirpy.util.raw import raw2temp

# The tags of a radiometric image as ExifTool names and prints them.
TAGS = {
    "Atmospheric Trans Alpha 1": "0.006569",
    "Atmospheric Trans Alpha 2": "0.012620",
    "Atmospheric Trans Beta 1": "-0.002276",
    "Atmospheric Trans Beta 2": "-0.006670",
    "Atmospheric Trans X": "1.900000",
    "Planck R1": "21106.77",
    "Planck R2": "0.012545258",
    "Planck O": "-7340",
    "Planck B": "1501",
    "Planck F": "1",
    "Emissivity": "0.95",
    "IR Window Transmission": "1.00",
    "IR Window Temperature": "20.0 C",
    "Atmospheric Temperature": "20.0 C",
    "Reflected Apparent Temperature": "20.0 C",
}

seen = {}
for distance in ("0.30 m", "1.00 m"):
    for humidity in ("0.5", "50.0 %", "100.0 %", "101.0 %", "1.01"):
        tags = TAGS | {"Object Distance": distance, "Relative Humidity": humidity}
        seen[distance, humidity] = round(float(raw2temp(np.array([15000.0]), tags)[0]), 2)
        print(f"{distance}, humidity {humidity}: {seen[distance, humidity]} C")
assert (seen["0.30 m", "0.5"], seen["0.30 m", "50.0 %"]) == (4.04, 3.35), "CHANGED"
assert (seen["1.00 m", "0.5"], seen["1.00 m", "50.0 %"]) == (3.97, 2.56), "CHANGED"
assert seen["1.00 m", "101.0 %"] == seen["1.00 m", "1.01"] != seen["1.00 m", "100.0 %"], "CHANGED"
PYTHON
