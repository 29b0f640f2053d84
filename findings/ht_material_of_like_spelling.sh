#!/bin/sh
# Guess: ht finds the conductivity of a common material by its name, or refuses the name.
#
# Seen, with ht 1.2.0 on Python 3.11: `k_material` takes the key of its tables that is spelled most like the name, however unlike,
# without a warning. "copper", "granite" and "acrylic" are right. "ABS" is AZS 41, a refractory of 4.55 W/(m K) (ABS has about 0.2);
# "PVC" and "cork" are refractories and minerals of 4.2 and 2.67, although the tables have both materials under longer names; "glass"
# is cellular glass of 0.048, an insulator (float glass has about 1); "aluminium" is alumina of 4.78 (the metal has about 200).
#
# For a display that renders materials, these are errors of a factor of 4 and more in effusivity. Look up the key with
# `nearest_material`, and read it, before a value is used.
#
# Fails if one of the keys or values changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check ht==1.2.0 fluids==1.3.1 numpy==2.4.6 scipy==1.17.1
"$folder/env/bin/python" - <<'PYTHON'
import ht

seen = {}
for name in ("copper", "granite", "acrylic", "ABS", "PVC", "cork", "glass", "aluminium"):
    seen[name] = (ht.nearest_material(name), ht.k_material(name))
    print(f"{name}: {seen[name][0]}, {seen[name][1]} W/(m K)")
expected = {
    "copper": ("Metals, copper", 380.0),
    "granite": ("Stone, granite", 2.8),
    "acrylic": ("Plastics, acrylic", 0.2),
    "ABS": ("AZS 41", 4.55),
    "PVC": ("ACr 90", 4.2),
    "cork": ("Zircon", 2.67),
    "glass": ("Cellular glass", 0.048),
    "aluminium": ("a/b-Alumina", 4.78),
}
assert seen == expected, "CHANGED"
PYTHON
