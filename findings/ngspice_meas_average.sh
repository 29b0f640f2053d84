#!/bin/sh
# Guess: in ngspice, the AVG of a .meas statement is its INTEG over the same window divided by the window's length, and MAX is the
# largest value within.
#
# Seen, with ngspice 39.3: only INTEG and FIND interpolate at the ends of the window. AVG and MAX start and end at the computed points
# next to them: of a ramp of 1 V/ms from 0.105 to 0.205 ms, whose steps become 20 us, INTEG gives 15.5 uV s, hence 0.155 V, AVG gives
# 0.1456 V, 6 % less, and MAX 0.1856 V where FIND gives 0.205 V at the end. AVG prints another end of its window (0.2056 ms) than
# asked for.
#
# Mean power of a bridge or a heater over a few switching periods is such a window. INTEG divided by the length is right in any window
# that has a computed point; AVG is near it where the step is small against the window.
#
# Installs nothing but ngspice itself, from Debian 12's package; its libraries are those of an installed ngspice.
#
# Fails if one of the four values changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq ngspice=39.3+ds-1 2>/dev/null
dpkg-deb -x ngspice_*.deb .
cat > ramp.cir <<'SPICE'
* ramp of 1 V/ms
V1 ramp 0 PWL(0 0 1m 1)
R1 ramp 0 1k
.tran 0.1m 1m
.meas tran integral INTEG v(ramp) from=0.105m to=0.205m
.meas tran average AVG v(ramp) from=0.105m to=0.205m
.meas tran maximum MAX v(ramp) from=0.105m to=0.205m
.meas tran at_end FIND v(ramp) AT=0.205m
.end
SPICE
usr/bin/ngspice -b ramp.cir 2>/dev/null | grep -E '^(integral|average|maximum|at_end) ' | tee seen
awk '
    { value[$1] = $3 }
    function is(name, expected) { return value[name] > expected * 0.9999 && value[name] < expected * 1.0001 }
    END {
        as_stated = is("integral", 15.5e-6) && is("average", 0.1456) && is("maximum", 0.1856) && is("at_end", 0.205)
        if (!as_stated) { print "CHANGED"; exit 1 }
    }
' seen
