#!/bin/sh
# Guess: spicelib reads a component's value in a netlist as the simulator does that the netlist is written for.
#
# Seen, with spicelib 1.6.4 and ngspice 39.3: not if the letter after the number is an upper-case M or an F, or stands for the decimal
# point. SPICE knows no case, M is milli (mega is MEG), and F is femto: ngspice simulates `10M` as 10 milliohms and `1F` as 1
# femtofarad. spicelib's `get_component_floatvalue` gives 10 megohms and 1 farad, nine and fifteen orders of magnitude more. `2k2` is
# 2.2 kilohms to spicelib and 2 to ngspice, which ignores what follows the letter. `10m`, `10Meg` and `1f` mean the same to both, and
# spicelib writes only such forms.
#
# Takes ngspice itself from Debian 12's package; its libraries are those of an installed ngspice.
#
# Fails if one of the values changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq ngspice=39.3+ds-1 2>/dev/null
dpkg-deb -x ngspice_*.deb .
python3 -m venv env
env/bin/pip install --quiet --no-compile --disable-pip-version-check spicelib==1.6.4
cat > values.cir <<'SPICE'
* one node, six values
I1 0 node 1
R1 node 0 10M
R2 node 0 10m
R3 node 0 10Meg
R4 node 0 2k2
C1 node 0 1F
C2 node 0 1f
.control
op
print @r1[resistance] @r2[resistance] @r3[resistance] @r4[resistance] @c1[capacitance] @c2[capacitance]
.endc
.end
SPICE
usr/bin/ngspice -b values.cir 2>/dev/null | grep '^@' > simulated
env/bin/python - <<'PYTHON'
from spicelib import SpiceEditor

editor = SpiceEditor("values.cir")
seen = {}
for line in open("simulated"):
    quantity, simulated = line.split("=")
    name = quantity[1:3].upper()
    written, read = editor.get_component_value(name), float(editor.get_component_floatvalue(name))
    seen[written] = (float(f"{float(simulated):.3g}"), read)
    print(f"{name} = {written}: ngspice simulates {seen[written][0]:g}, spicelib reads {read:g}")
expected = {"10M": (0.01, 1e7), "10m": (0.01, 0.01), "10Meg": (1e7, 1e7), "2k2": (2000.0, 2200.0), "1F": (1e-15, 1.0), "1f": (1e-15, 1e-15)}
assert seen == expected, "CHANGED"
PYTHON
