#!/bin/sh
# Guess: SurfaceTopography, which has masks for undefined points, masks the non-measured points of the profilometer formats that it reads.
#
# Seen, with SurfaceTopography 1.25.0 and files written by surfalize 0.19.2 on Python 3.11: in X3P it does, in two formats not.
# - SUR (Digital Surf): the header's flag for special points is read and not used. A non-measured point, stored below all others,
#   becomes the deepest pit, so that the RMS roughness of the example is 0.704 um in place of 0.689 um.
# - SDF (ISO 25178-71) of doubles: only NaN counts. The lowest double, which marks the point, becomes a height of -1.8e307.
# `has_undefined_data` is False for both. surfalize reads the point of all three as NaN.
#
# Compare a measurement's lowest points with the instrument's own count of non-measured ones before its roughness is used.
#
# Fails if one of them is read otherwise.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --no-compile --disable-pip-version-check SurfaceTopography==1.25.0 surfalize==0.19.2 numpy==2.4.6 scipy==1.17.1
env/bin/python -W ignore - <<'PYTHON'
import numpy as np
from SurfaceTopography.IO import open_topography
from surfalize import Surface

heights_um = np.sin(np.arange(20.0)).reshape(4, 5)
heights_um[1, 2] = np.nan
surface = Surface(heights_um, 1.0, 2.5)
seen = {}
for name in ("x3p", "sur", "sdf"):
    surface.save(f"surface.{name}")
    assert np.array_equal(np.isnan(Surface.load(f"surface.{name}").data), np.isnan(heights_um))
    topography = open_topography(f"surface.{name}").topography()
    heights = np.ma.asarray(topography.heights()).T
    seen[name] = bool(topography.has_undefined_data)
    print(f"{name}: undefined points {seen[name]}, the non-measured one is {heights[1, 2]}")
    if name == "sur":
        others = np.delete(np.asarray(heights).ravel(), 7)
        rms, without = np.std(np.asarray(heights)), np.std(others)
        print(f"sur: RMS {float(topography.rms_height_from_area()):.3f} um, without the point {without:.3f} um")
        assert np.argmin(heights) == 7 and round(float(rms), 3) == 0.704, "CHANGED"
    if name == "sdf":
        assert heights[1, 2] < -1e307, "CHANGED"
assert seen == {"x3p": True, "sur": False, "sdf": False}, "CHANGED"
PYTHON
