#!/bin/sh
# Guess: ngspice refuses a .meas statement whose window has no computed point or exceeds the run, as it does for RMS.
#
# Seen, with ngspice 39.3: RMS fails with "out of interval", but AVG, INTEG, MAX and MIN of a constant 5 V are 0 in a window between two
# points, from 0.501 to 0.504 ms here, where the steps are 20 us. FIND within the window is 5 V. A window that exceeds the run is cut
# there: INTEG from 0.5 to 2 ms of a run of 1 ms is 2.5 mV s in place of 7.5, and only the printed end says so.
#
# A bench that asks whether a current stays below a limit passes on such a window. Give .tran a longest step that is shorter than the
# window.
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
cat > supply.cir <<'SPICE'
* constant 5 V
V1 supply 0 5
R1 supply 0 1k
.tran 0.1m 1m
.meas tran maximum MAX v(supply) from=0.501m to=0.504m
.meas tran minimum MIN v(supply) from=0.501m to=0.504m
.meas tran integral INTEG v(supply) from=0.501m to=0.504m
.meas tran average AVG v(supply) from=0.501m to=0.504m
.meas tran rms RMS v(supply) from=0.501m to=0.504m
.meas tran within FIND v(supply) AT=0.502m
.meas tran beyond INTEG v(supply) from=0.5m to=2m
.end
SPICE
usr/bin/ngspice -b supply.cir > printed 2>&1
grep -E '^[a-z]+ += |out of interval' printed | tee seen
awk '
    /out of interval/ { refused = refused $3 }
    $2 == "=" { value[$1] = $3 + 0 }
    END {
        zero = value["maximum"] == 0 && value["minimum"] == 0 && value["integral"] == 0 && value["average"] == 0
        if (!zero || refused != "rms" || value["within"] != 5 || value["beyond"] != 2.5e-3) { print "CHANGED"; exit 1 }
    }
' seen
