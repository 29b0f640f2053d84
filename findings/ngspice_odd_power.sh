#!/bin/sh
# Guess: in ngspice, an odd power of a negative quantity is negative.
#
# Seen, with ngspice 39.3: `x**3`, `x^3` and `pow(x,3)` of a behavioural source, and `(-2)**3` of a parameter, take the magnitude of
# the base: each is 8 for x = -2. `x*x*x` is -8. Nothing warns.
#
# The cubic term of a thermistor's Steinhart-Hart equation in ln(R/R25) has a negative base above 25 C and a positive one below, so
# that a source written with a power is right on one side and wrong by twice the term on the other.
#
# Fails if a power has its sign.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq ngspice=39.3+ds-1 2>/dev/null
dpkg-deb -x ngspice_*.deb .
cat > powers.cir <<'SPICE'
* powers of -2
Vx x 0 -2
Bstars stars 0 V=V(x)**3
Bhat hat 0 V=V(x)^3
Bpow pow 0 V=pow(V(x),3)
Bproduct product 0 V=V(x)*V(x)*V(x)
.tran 1m 10m
.meas tran stars FIND v(stars) AT=5m
.meas tran hat FIND v(hat) AT=5m
.meas tran pow FIND v(pow) AT=5m
.meas tran product FIND v(product) AT=5m
.meas tran parameter PARAM='(-2)**3'
.end
SPICE
usr/bin/ngspice -b powers.cir 2>/dev/null | grep -E '^[a-z]+ += ' | tee seen
awk '
    { value[$1] = $3 + 0 }
    END {
        as_stated = value["stars"] == 8 && value["hat"] == 8 && value["pow"] == 8 && value["parameter"] == 8
        if (!as_stated || value["product"] != -8) { print "CHANGED"; exit 1 }
    }
' seen
