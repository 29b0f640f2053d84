#!/usr/bin/env python3
"""Writes the golden values of this folder: contacts, also of layers, Planck's law over the camera's band, and infrared
readings.

usage: generate.py           writes the files anew
       generate.py --check   compares them with what it would write; exit status 1 if they differ

Requires Python 3 and mpmath (`pip install mpmath`). Independent of the Rust code: contacts come from the equations in
`model/tests/data/generate.py`, those of layers from a numerical inversion of their Laplace transforms, radiances from a quadrature of Planck's law with 40 digits, temperatures from its root.
"""

import sys
from functools import cache
from itertools import product
from pathlib import Path

FOLDER = Path(__file__).parent
sys.path.insert(0, str(FOLDER.parents[3] / "model/tests/data"))

import generate as model  # noqa: E402
from mpmath import expm1, findroot, invertlaplace, mp, mpf, nstr, quad, sqrt, tanh  # noqa: E402

# Exact by definition of the SI (2019); the camera's band, m (section 5.2.2)
PLANCK, BOLTZMANN, LIGHT = mpf("6.62607015e-34"), mpf("1.380649e-23"), mpf(299792458)
BAND = [mpf("7.5e-6"), mpf("13e-6")]
EMISSIVITY = mpf("0.95")
# Table 5-3: transmissivity, reflectivity; the rest is emissivity
WINDOWS = {"none": None, "baf2": ("0.77", "0.04"), "zns": ("0.65", "0.22")}
BEAMSPLITTER = ("0.54", "0.42")
# Pressure, Pa, of each force, N (section 6.4.2)
PRESSURES = {"0.1": 730, "0.5": 3140, "2": 10980}


def contact_rows():
    """Eq. 6-5 to 6-7."""
    yield (
        "# Eq. 6-5 to 6-7 in 50-digit arithmetic: skin at 34 C lands on an object at 24 C at t = 0. "
        "Rounded to 12 digits.",
    )
    yield "material,force_n,resistance_m2k_w,t_s,t_skin_c,t_object_c,flux_w_m2".split(",")
    times = "1e-3 1e-2 0.1 0.2 0.5 1 2 5 10 60".split()
    for name, force, t in product(("copper", "granite", "abs", "foam"), PRESSURES, times):
        r = model.resistance(model.finish(name), mpf(PRESSURES[force]))
        e = model.erfcx(model.rate_root(name, r) * sqrt(mpf(t)))
        e_object = model.effusivity(name)
        whole = e_object + model.E_SKIN
        t_skin = 34 - 10 * e_object / whole * (1 - e)
        t_object = 24 + 10 * model.E_SKIN / whole * (1 - e)
        yield name, force, nstr(r, 12), t, *(nstr(value, 12) for value in (t_skin, t_object, 10 / r * e))


# Layers from the surface on: material and thickness, m; condition behind them, force, N
LAYERED = (
    ("skin", "copper 1e-3/foam inf", "insulated", "2"),
    ("skin", "copper 1e-4/foam inf", "insulated", "2"),
    ("skin", "abs 1e-3/copper inf", "insulated", "2"),
    ("skin", "foam 1e-3/copper 1e-3/foam 5e-3", "insulated", "2"),
    ("skin", "copper 3e-3", "insulated", "2"),
    ("skin", "granite 2e-3", "held", "2"),
    ("layered", "granite inf", "insulated", "0.25"),
)
# Thickness m, conductivity W/(m K), heat capacity J/(m3 K), perfusion W/(m3 K): the nominal fingers
BLOOD = mpf("4e6")
FINGERS = {
    "skin": ((mpf("inf"), model.K_SKIN, model.K_SKIN / model.ALPHA_SKIN, 0),),
    "layered": (
        (mpf("0.65e-3"), mpf("0.21"), mpf(1110 * 3600), 0),
        (mpf("1.2e-3"), mpf("0.37"), mpf(1116 * 3224), mpf("5e-3") * BLOOD),
        (mpf("4e-3"), mpf("0.16"), mpf(970 * 2303), mpf("1e-3") * BLOOD),
    ),
}
# Flux from the resting finger to the air, W/m2: a film of 10 W/(m2 K) where there is a core
TO_AIR = {"skin": 0, "layered": 100}


def layer(text):
    name, thickness = text.split()
    k, rho, c = map(mpf, model.MATERIALS[name][:3])
    return mpf(thickness), k, rho * c, 0


def impedance(layers, held, s):
    """Surface temperature over flux into the surface at the Laplace variable s, as a chain of transmission lines."""
    behind = 0 if held else mpf("inf")
    for thickness, k, capacity, perfusion in reversed(layers):
        rate = sqrt((capacity * s + perfusion) / k)
        own = 1 / (k * rate)
        if thickness == mpf("inf"):
            behind = own
        elif behind == mpf("inf"):
            behind = own / tanh(rate * thickness)
        else:
            part = tanh(rate * thickness)
            behind = own * (behind + own * part) / (own + behind * part)
    return behind


def landing(finger, layers, back, r, t):
    """Skin, object and flux after landing. Until then the finger was in equilibrium with the air, whose film the object
    takes away; the blood flows on."""
    layers, to_air = [layer(text) for text in layers.split("/")], TO_AIR[finger]
    z_finger = lambda s: impedance(FINGERS[finger], True, s)
    z_object = lambda s: impedance(layers, back == "held", s)
    flux = lambda s: (10 + z_finger(s) * to_air) / s / (r + z_finger(s) + z_object(s))
    courses = lambda s: 34 / s - z_finger(s) * (flux(s) - to_air / s), lambda s: 24 / s + z_object(s) * flux(s), flux
    with mp.workdps(30):
        return [invertlaplace(course, mpf(t), method="talbot") for course in courses]


def layered_rows():
    """Eq. 6-8 between a finger and layers."""
    yield (
        "# Skin at 34 C lands on layers at 24 C at t = 0: transmission lines joined by the resistance of Eq. 6-8 and inverted "
        "from the Laplace domain by Talbot's method. Rounded to 12 digits.",
    )
    yield "finger,layers,back,force_n,t_s,t_skin_c,t_object_c,flux_w_m2".split(",")
    pressures = {"0.25": mpf(1680), "2": mpf(10980)}
    # The method must give Eq. 6-5 for a half-space.
    r = model.resistance(model.finish("granite"), pressures["2"])
    skin, *_ = landing("skin", "granite inf", "insulated", r, "1")
    e = model.erfcx(model.rate_root("granite", r))
    share = model.effusivity("granite") / (model.effusivity("granite") + model.E_SKIN)
    assert abs(skin - (34 - 10 * share * (1 - e))) < mpf("1e-15")
    for (finger, layers, back, force), t in product(LAYERED, "2e-2 5e-2 0.1 0.2 0.5 1 2 5 10 60".split()):
        r = model.resistance(model.finish(layers.split()[0]), pressures[force])
        values = landing(finger, layers, back, r, t)
        yield finger, layers, back, force, t, *(nstr(value, 12) for value in values)


@cache
def radiance(celsius):
    """Radiance of a black body in the band, W/(m2 sr)."""
    with mp.workdps(40):
        kelvin = mpf(celsius) + mpf("273.15")
        spectral = lambda m: 2 * PLANCK * LIGHT**2 / m**5 / expm1(PLANCK * LIGHT / (m * BOLTZMANN * kelvin))
        return quad(spectral, BAND)


def planck_band_rows():
    yield "T_C", "U_7.5_13um_W_m2_sr"
    for celsius in (-20, 0, 10, 15, *range(18, 41), 45, 60, 100):
        yield celsius, radiance(celsius)


def infrared_rows():
    """Eq. 5-3, and 5-4 without optics."""
    yield (
        "optic,eps_obj,T_obj_C,T_amb_C,T_opt1_C,T_opt2_C,U_obj,U_amb,U_opt1,U_opt2,U_tot,T_apparent_C"
    ).split(",")
    few, more = "20 26 28 30 32 36".split(), "24 27 29 31 34".split()
    rooms = ("24 24 24", few), ("23.7 25.9 23.9", more), ("20 22 21", few), ("24 30 26", more)
    for optic, (room, targets) in product(WINDOWS, rooms):
        room = room.split()
        u_amb, u_window, u_splitter = map(radiance, room)
        for target in targets:
            u_obj = radiance(target)
            u_tot = EMISSIVITY * u_obj + (1 - EMISSIVITY) * u_amb
            if WINDOWS[optic]:
                tau, rho = map(mpf, WINDOWS[optic])
                tau_splitter, rho_splitter = map(mpf, BEAMSPLITTER)
                u_tot = tau * u_tot + rho * u_amb + (1 - tau - rho) * u_window
                u_tot = tau_splitter * u_tot + rho_splitter * u_amb + (1 - tau_splitter - rho_splitter) * u_splitter
            apparent = findroot(lambda c: radiance(c) - u_tot, mpf(target), tol=mpf(10) ** -70)
            yield (
                optic, nstr(EMISSIVITY, 2), target, room[0], *(room[1:] if WINDOWS[optic] else ("", "")),
                u_obj, u_amb, u_window, u_splitter, u_tot, apparent,
            )


FILES = {
    "contact.csv": contact_rows,
    "infrared.csv": infrared_rows,
    "layered.csv": layered_rows,
    "planck_band.csv": planck_band_rows,
}

if __name__ == "__main__":
    model.run(FOLDER, FILES, __doc__)
