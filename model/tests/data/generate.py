#!/usr/bin/env python3
"""Writes the golden values of this folder: the equations of the thesis, evaluated with 60 digits.

usage: generate.py           writes the files anew
       generate.py --check   compares them with what it would write; exit status 1 if they differ

Requires Python 3 and mpmath (`pip install mpmath`). Independent of the Rust code: every formula is written here from
the thesis (H.-N. Ho, MIT, 2006; equation numbers in the comments), in its own form rather than with `erfcx`.
"""

import csv
import io
import struct
import sys
from itertools import product
from pathlib import Path

from mpmath import atan, cos, erf, erfc, exp, mp, mpf, nstr, pi, quad, sqrt

mp.dps = 60
FOLDER = Path(__file__).parent

# k W/mK, rho kg/m3, c J/kgK, Rq um, slope rad; of the thesis: tabulated effusivity, stated R_display / R_object; slope assumed
MATERIALS = {
    "copper": ("398", "8954", "384", "0.31", "0.045", "36992", "0.93", 0),
    "bronze": ("54", "8780", "355", "0.32", "0.053", "12973", "", 1),
    "stainless-steel": ("13.5", "8000", "460", "0.19", "0.031", "7048", "0.90", 0),
    "granite": ("2.79", "2630", "775", "0.46", "0.048", "2384", "0.82", 0),
    "g10": ("0.29", "1800", "1600", "1.50", "0.168", "910", "", 1),
    "abs": ("0.18", "1010", "1386", "0.45", "0.046", "501", "0.30", 0),
    "foam": ("0.029", "24", "1210", "8.03", "0.157", "29", "0.07", 0),
    "baf2": ("11.7", "4890", "410", "0.008", "0.009", "4843", "", 0),
    "zns": ("27.2", "4090", "515", "0.006", "0.006", "7569", "", 0),
    "aluminium-6061": ("167", "2700", "896", "0.40", "0.050", "", "", 1),
}
# Infrared windows, whose temperature in the thesis is 26 C
WINDOWS = ("baf2", "zns")
K_SKIN, ALPHA_SKIN, HARDNESS = mpf("0.37"), mpf("1e-7"), mpf("122500")
E_SKIN = K_SKIN / sqrt(ALPHA_SKIN)
SKIN = (K_SKIN, mpf("21.69"), mpf("0.30"))
DISPLAY = (mpf(36), mpf(1), mpf("0.138"))
# Force N and pressure Pa: of the simulations (section 6.3: 2 N on 135 mm2) and of the validation (section 6.4.2)
CONDITIONS = {
    "sim_2N_135mm2": ("2", 2 / mpf("135e-6")),
    "val_0.1N": ("0.1", mpf(730)),
    "val_0.5N": ("0.5", mpf(3140)),
    "val_2N": ("2", mpf(10980)),
}


def text(value):
    """30 digits of a computed number; inputs stay as they are written."""
    return nstr(value, 30) if isinstance(value, mpf) else str(value)


def finish(name):
    """Conductivity, roughness and slope of a material."""
    k, _, _, rq, slope, *_ = MATERIALS[name]
    return mpf(k), mpf(rq), mpf(slope)


def effusivity(name):
    k, rho, c = map(mpf, MATERIALS[name][:3])
    return sqrt(k * rho * c)


def conductance_parts(surface):
    """Eq. 6-9 to 6-11 for the skin and another surface: mean conductivity, roughness (um), slope."""
    (ka, ra, sa), (kb, rb, sb) = SKIN, surface
    return 2 * ka * kb / (ka + kb), sqrt(ra**2 + rb**2), sqrt(sa**2 + sb**2)


def conductance(surface):
    k, roughness, slope = conductance_parts(surface)
    return k * slope / (roughness * mpf("1e-6"))


def resistance(surface, pressure):
    """Eq. 6-8."""
    return 1 / (mpf("1.25") * conductance(surface) * (pressure / HARDNESS) ** mpf("0.95"))


def rate_root(name, r):
    """b of Eq. 6-5 to 6-7."""
    return (1 / E_SKIN + 1 / effusivity(name)) / r


def erfcx(x):
    """exp(x^2) erfc(x): the asymptotic series where its first four terms have 60 digits."""
    if x > mpf("1e8"):
        s = 1 / (2 * x * x)
        return (1 - s * (1 - 3 * s * (1 - 5 * s))) / (x * sqrt(pi))
    with mp.extradps(20):
        return exp(x * x) * erfc(x)


def one_minus_erfcx(x):
    with mp.workdps(400 if x < 1 else mp.dps):
        return 1 - erfcx(x)


def erfcx_rows():
    """The arguments, mostly random, are the committed ones, as exact doubles."""
    yield "x,x_hex,f32_exact,erfcx,one_minus_erfcx".split(",")
    for row in csv.DictReader((FOLDER / "erfcx.csv").open()):
        x = float.fromhex(row["x_hex"])
        single = abs(x) < 3e38 and struct.unpack("f", struct.pack("f", x))[0] == x
        yield repr(x), x.hex(), int(single), erfcx(mpf(x)), one_minus_erfcx(mpf(x))


def resistance_rows():
    yield (
        "material,condition,force_N,P_Pa,k_object,Rq_um,da_rad,k_s_harmonic,Rq_eff_um,da_eff,S_ks_da_over_Rq_W_m2K,"
        "R_m2K_W,h_W_m2K,R_skin_display_m2K_W,ratio,ratio_stated,b_per_sqrt_s,tau_s,assumed_da"
    ).split(",")
    for name, condition in product(MATERIALS, CONDITIONS):
        force, pressure = CONDITIONS[condition]
        surface = finish(name)
        r, display = resistance(surface, pressure), resistance(DISPLAY, pressure)
        b = rate_root(name, r)
        stated, assumed = MATERIALS[name][6:]
        yield (
            name, condition, force, pressure, *surface, *conductance_parts(surface), conductance(surface),
            r, 1 / r, display, display / r, mpf(stated) if stated else "", b, 1 / b**2, assumed,
        )


def contact_rows():
    """Eq. 6-5 to 6-7 and 6-12."""
    yield (
        "material,condition,force_N,P_Pa,T_skin_i_C,T_object_i_C,R_skin_object_m2K_W,ratio_Rdisp_Robj,t_s,z,erfcx_z,"
        "T_skin_s_C,T_object_s_C,q_W_m2,T_display_C,T_display_stated_ratio_C,assumed_da"
    ).split(",")
    sim, firm = "sim_2N_135mm2", "val_2N"
    contacts = [(m, c, "34", "26" if m in WINDOWS else "24") for m, c in product(MATERIALS, CONDITIONS)]
    contacts += [(m, c, "34", "24") for m, c in product(WINDOWS, (sim, firm))]
    contacts += [("copper", sim, "34", "34"), ("stainless-steel", sim, "33", "24"), ("foam", sim, "34", "0")]
    times = "0 1e-6 1e-3 1e-2 0.1 0.2 0.5 1 2 5 10 60 3600".split()
    for (name, condition, skin, obj), t in product(contacts, times):
        force, pressure = CONDITIONS[condition]
        r = resistance(finish(name), pressure)
        ratio = resistance(DISPLAY, pressure) / r
        z = rate_root(name, r) * sqrt(mpf(t))
        e = erfcx(z)
        e_object = effusivity(name)
        step = mpf(skin) - mpf(obj)
        t_skin = mpf(skin) - step * e_object / (e_object + E_SKIN) * (1 - e)
        t_object = mpf(obj) + step * E_SKIN / (e_object + E_SKIN) * (1 - e)
        stated, assumed = MATERIALS[name][6:]
        yield (
            name, condition, force, pressure, skin, obj, r, ratio, t, z, e, t_skin, t_object, step / r * e,
            t_skin - ratio * step * e, t_skin - mpf(stated) * step * e if stated else "", assumed,
        )


def every_other(*axes):
    """Every other combination, which covers all values of each axis with half of the rows."""
    return list(product(*axes))[::2]


DEPTHS_M = "0 1e-5 5e-5 1e-4 1.6e-4 3e-4 6e-4 1.24e-3 2e-3 5e-3 1e-2".split()


def contact_interior_rows():
    """Eq. 6-5 below the surface (Carslaw and Jaeger's solution for a contact resistance)."""
    yield "material,condition,T_skin_i_C,T_object_i_C,R_m2K_W,x_m,t_s,T_skin_x_t_C".split(",")
    condition = "sim_2N_135mm2"
    for name, t, x in every_other(MATERIALS, "0.01 0.1 0.5 1 2 5 10".split(), DEPTHS_M):
        r = resistance(finish(name), CONDITIONS[condition][1])
        b, depth, time = rate_root(name, r), mpf(x), mpf(t)
        e_object = effusivity(name)
        with mp.extradps(40):
            a = depth / (2 * sqrt(ALPHA_SKIN * time))
            part = erfc(a) - exp(2 * a * b * sqrt(time) + b * b * time) * erfc(a + b * sqrt(time))
        obj = "26" if name in WINDOWS else "24"
        change = (34 - mpf(obj)) * e_object / (e_object + E_SKIN) * part
        yield name, condition, "34", obj, r, x, t, 34 - change


def interface(name, skin, obj):
    """Eq. 3-1."""
    e = effusivity(name)
    return (mpf(obj) * e + mpf(skin) * E_SKIN) / (e + E_SKIN)


def semi_infinite_rows():
    yield (
        "material,T_skin_i_C,T_material_i_C,e_from_k_rho_c,e_tabulated,e_skin,T_s_C,T_s_tabulated_e_1170_C"
    ).split(",")
    names = list(MATERIALS)
    first, second = names[::2], names[1::2]
    for names, skin, obj in (
        (first, "33", "24"), (second, "34", "24"), (first, "34", "23.5"), (second, "34", "26"),
        (first, "28.6", "21.16"), (second, "34", "44"),
    ):
        for name in names:
            e = rounded = ""
            if tabulated := MATERIALS[name][5]:
                e = mpf(tabulated)
                rounded = (mpf(obj) * e + mpf(skin) * 1170) / (e + 1170)
            yield name, skin, obj, effusivity(name), e, E_SKIN, interface(name, skin, obj), rounded


def semi_infinite_profile_rows():
    """Eq. 3-2 and 3-3."""
    yield (
        "material,T_skin_i_C,T_material_i_C,T_s_C,x_m,t_s,erf_arg_value,T_skin_x_t_C,q_eq3_3_signed_W_m2,"
        "q_out_of_skin_W_m2"
    ).split(",")
    skin, obj = "33", "24"
    for name, t, x in every_other(MATERIALS, "1e-3 0.01 0.1 0.5 1 2 5 10".split(), DEPTHS_M):
        surface = interface(name, skin, obj)
        value = erf(mpf(x) / (2 * sqrt(ALPHA_SKIN * mpf(t))))
        flux = K_SKIN * (surface - mpf(skin)) / sqrt(pi * ALPHA_SKIN * mpf(t))
        yield name, skin, obj, surface, x, t, value, surface + (mpf(skin) - surface) * value, flux, -flux


def roughness_sinusoid_rows():
    """Roughness and slopes of sinusoidal profiles; Eq. 6-13 is for Gaussian ones."""
    yield "amplitude_m,period_m,Rq_m,Rdq,da_atan_mean_rad,mean_abs_slope,Rdq_over_1.25,RSm_m".split(",")
    for a, l in (("10e-6", "0.65e-3"), ("28.6095e-6", "0.73e-3"), ("100e-6", "0.5e-3")):
        amplitude, period = mpf(a), mpf(l)
        steepest = 2 * pi * amplitude / period
        mean_angle = quad(lambda phase: atan(steepest * cos(phase)), [0, pi / 2]) * 2 / pi
        rdq = steepest / sqrt(mpf(2))
        yield (
            a, l, amplitude / sqrt(mpf(2)), rdq, mean_angle, 4 * amplitude / period, rdq / mpf("1.25"), period,
        )


FILES = {
    "contact.csv": contact_rows,
    "contact_interior.csv": contact_interior_rows,
    "erfcx.csv": erfcx_rows,
    "resistance.csv": resistance_rows,
    "roughness_sinusoid.csv": roughness_sinusoid_rows,
    "semi_infinite.csv": semi_infinite_rows,
    "semi_infinite_profile.csv": semi_infinite_profile_rows,
}


def contents(rows):
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([text(value) for value in row] for row in rows())
    return out.getvalue()


def run(folder, files, usage):
    """Writes the files into the folder, or compares them, as the command line says; other generators use it too."""
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(usage)
    differ = 0
    for name, rows in files.items():
        path, new = folder / name, contents(rows)
        if not check:
            path.write_text(new, newline="\n")
            print(f"wrote {name}")
            continue
        old = path.read_text().splitlines()
        new = new.splitlines()
        lines = [i for i, (a, b) in enumerate(zip(old, new), 1) if a != b]
        if lines or len(old) != len(new):
            differ += 1
            print(f"{name}: {len(lines)} lines differ, {len(old)} committed, {len(new)} generated")
            for i in lines[:3]:
                print(f"  line {i}\n  committed {old[i - 1]}\n  generated {new[i - 1]}")
    sys.exit(1 if differ else 0)


if __name__ == "__main__":
    run(FOLDER, FILES, __doc__)
