#!/usr/bin/env python3
"""Prints the constants of the device's plate model (`src/device/src/estimate/plate_model.rs`) as lines of Rust.

Requires Python 3 and mpmath (`pip install mpmath`). The plate is a network of heat capacities C and conductances G:

    finger -> plate (4 cells) - tab - legs (5 cells) - tab and hot plate (1 node) - sink, held at 0

The patch under the finger and the rest of the plate are two such columns, side by side. The share `PATCH / PLATE` of all
capacities and conductances belongs to the patch. So the mean of both columns and their difference are independent of each
other: the mean is one column of the whole tile; the difference is one whose hot node stays at 0 and whose plate also
loses heat sideways. The eigenvectors of G against C are the relaxations of the patch's surface. Neighbouring ones are
merged:

* each row of `SHORTEST_S` becomes one relaxation; its gains are the sums over its modes, so the steady state stays. The
  modes above each limit of the row are summed and rounded to 5 decimals, then these sums are added;
* its time constant is that of the mode of the mean on which pumped heat acts most (of the only mode, if there is one);
* what the last row holds acts at once; of that, only the finger's gain counts.
"""

from mpmath import eigsy, fsum, log, matrix, mp, mpf, nint, nstr, pi, sqrt

mp.dps = 30

# Module of 71 couples, 6 A, 8.2 V, 67 K at a hot side of 27 C: conductance of the legs, W/K, of 3 digits
HOT_K, RANGE_K, PRODUCT_W = mpf("300.15"), mpf(67), 6 * mpf("8.2")
LEGS_W_K = mpf(nstr(PRODUCT_W * (HOT_K - RANGE_K) / (2 * HOT_K * RANGE_K), 3))
# Heat capacities, J/K, of the legs, the tabs of one side, and the hot plate; conductance of the paste, W/K
LEGS_J_K, TABS_J_K, HOT_PLATE_J_K, PASTE_W_K = mpf("0.51"), mpf("0.52"), mpf("2.2"), mpf(100)
# Alumina: areas of plate and patch, m2, thickness, m, conductivity, W/mK, volumetric heat capacity, J/m3K
PLATE, PATCH, THICK, K, RHO_C = mpf("9e-4"), mpf("182.1e-6"), mpf("0.8e-3"), mpf(24), mpf("3.05e6")
SHARE = PATCH / PLATE
PLATE_CELLS, LEG_CELLS = 4, 5

# Resistance from the hot node through half of the plate and the paste, K/W
HOT_K_W = THICK / 2 / (K * PLATE) + 1 / PASTE_W_K
# Each cell of the plate is twice as thick as the one above it, with its node at the geometric mean of its faces
WIDTHS = [THICK * 2**i / (2**PLATE_CELLS - 1) for i in range(PLATE_CELLS)]
NODES = [width / (1 + sqrt(2)) for width in WIDTHS]

# Limits of the time constants, s, that are merged: one row for each relaxation, and one for what acts at once
SHORTEST_S = ["5"], ["1"], ["0.1", "0.03"], ["0.01"], ["0.003"], ["0.001", "0.0001", "0"]


def sideways_m_w():
    """Resistance times sheet conductance between the means of the patch, a disc, and of the ring around it."""
    patch, plate = sqrt(PATCH / pi), sqrt(PLATE / pi)
    middle = sqrt((patch**2 + plate**2) / 2)
    return 1 / (8 * pi) + log(middle / patch) / (2 * pi)


def modes(difference):
    """Time constant, s, and gains, K/W, for heat pumped, Joule heat and the finger's, of every mode of one column."""
    size = PLATE_CELLS + LEG_CELLS + 3
    cold, hot = PLATE_CELLS, size - 2  # the node after the hot one is the sink
    capacity = [RHO_C * PLATE * width for width in WIDTHS]
    capacity += [TABS_J_K, *[LEGS_J_K / LEG_CELLS] * LEG_CELLS, TABS_J_K + HOT_PLATE_J_K]
    axial = [K * PLATE / (w - n + after) for w, n, after in zip(WIDTHS, NODES, [*NODES[1:], 0])]
    ends = [2 * LEG_CELLS * LEGS_W_K]
    axial += [*ends, *[LEG_CELLS * LEGS_W_K] * (LEG_CELLS - 1), *ends, 1 / HOT_K_W]
    conductance = matrix(size, size)
    for i, w_k in enumerate(axial):
        conductance[i, i] += w_k
        conductance[i + 1, i + 1] += w_k
        conductance[i, i + 1] = conductance[i + 1, i] = -w_k
    if difference:
        for i, width in enumerate(WIDTHS):
            conductance[i, i] += K * width / sideways_m_w() / (SHARE * (1 - SHARE))
    free = hot if difference else hot + 1
    scaled = matrix(free, free)
    for i in range(free):
        for j in range(free):
            scaled[i, j] = conductance[i, j] / sqrt(capacity[i] * capacity[j])
    rates, vectors = eigsy(scaled)
    for m in range(free):
        at = [vectors[i, m] / sqrt(capacity[i]) for i in range(free)]
        surface = at[0] / rates[m]
        legs = fsum(at[cold + 1 : cold + 1 + LEG_CELLS]) / LEG_CELLS
        if difference:
            yield 1 / rates[m], (0, 0, surface * at[0] * (1 - SHARE) / SHARE)
        else:
            yield 1 / rates[m], (surface * at[cold], surface * legs, surface * at[0])


def rust(value):
    """A literal of 5 decimals, in groups of three."""
    text = f"{float(value):.5f}"
    return f"{text[:-2]}_{text[-2:]}" if float(text) else "0.0"


def total(group, heat):
    """Sum of the gains for one heat, rounded to 5 decimals."""
    return nint(fsum(gains[heat] for _, gains in group) * 10**5) / 10**5


def main():
    left = sorted([*modes(difference=False), *modes(difference=True)], reverse=True)
    # The resistance from the face to the first node
    left.append((0, (0, 0, NODES[0] / (K * PATCH))))
    for row in SHORTEST_S:
        groups = []
        for shortest in row:
            groups.append([mode for mode in left if mode[0] >= mpf(shortest)])
            left = left[len(groups[-1]) :]
        lag, _ = max(groups[0], key=lambda mode: abs(mode[1][0]))
        gains = [fsum(total(group, heat) for group in groups) for heat in range(3)]
        if left:
            print(f"class_relaxation_row({', '.join(map(rust, (lag, *gains)))}),")
        else:
            print(f"const FINGER_FEEDTHROUGH_K_W: f64 = {rust(gains[2])};")
        if len(row) == 2 and left:
            print(f"const LEG_MEAN_TIME_CONSTANT_S: f64 = {nstr(lag, 3)};")
    print(f'const LEG_MEAN_RISE_PER_JOULE_HEAT_K_W: I4F28 = I4F28::lit("{nstr(1 / (12 * LEGS_W_K), 3)}");')
    print(f'const HOT_SIDE_THERMAL_RESISTANCE_K_W: I4F28 = I4F28::lit("{nstr(HOT_K_W, 3)}");')


if __name__ == "__main__":
    main()
