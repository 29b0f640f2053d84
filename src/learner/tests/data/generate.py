#!/usr/bin/env python3
"""Golden values of the learner: contacts of layered fingers, and what recursive least squares in f64 learns from them.

Independent of the crate: the contacts are simulated with finite volumes and the Crank-Nicolson method, relaxations and lags are
exponentials of the standard library, and the covariance is updated in Joseph's form. Only the constants of the mean finger are
read from contact_model.

Writes contacts.csv beside this script; with --check compares instead. Measurements are in the learner's fixed point, as bits.
"""

import math
import pathlib
import random
import re
import sys

HERE = pathlib.Path(__file__).parent
MODEL = HERE.parents[3] / "model/src/finger.rs"
SKIN_C, ROOM_C, TICK_S, LAG_S, SENSOR = 34.0, 24.0, 1e-3, 5e-3, 3e-5


def constants():
    """Rates, weights and direct term of the mean finger, components and their means."""
    text = MODEL.read_text()
    mean = text[text.index("pub const MEAN:") : text.index("pub const MEAN_ON_PAD")]
    direct = float(re.search(r"direct_m2k_w: ([\d.e-]+)", mean)[1])
    pairs = [(float(r), float(g)) for r, g in re.findall(r"relaxation\(([\d.e-]+), ([\d.e-]+)\)", mean)]
    pairs = [(r, g) for r, g in pairs if r > 0]
    numbers = re.findall(r"-?\d\.\d+", text[text.index("pub const COMPONENTS") : text.index("/// Mean of each of the")])
    components = [[float(n) for n in numbers[:9]], [float(n) for n in numbers[9:18]]]
    means = [float(n) for n in re.findall(r"-?\d\.\d+", text[text.index("pub const COMPONENT_MEANS") :])]
    return [r for r, _ in pairs], [g for _, g in pairs] + [direct], components, means


RATES, WEIGHTS, COMPONENTS, MEANS = constants()


class Finger:
    """Epidermis, dermis and fat over a core that keeps its temperature: 90 cells, which grow with the depth."""

    def __init__(self, epidermis_m, conductivity, factor, film):
        layers = [(epidermis_m, conductivity, 1110 * 3600.0), (1.2e-3, 0.37, 1116 * 3224.0), (4e-3, 0.16, 970 * 2303.0)]
        width = 10e-6
        k, c = [], []
        for thickness, k_w_mk, c_j_m3k in layers:
            for _ in range(round(thickness / width)):
                k.append(k_w_mk * factor)
                c.append(c_j_m3k * factor)
        self.width = [width] * len(k)
        self.k, self.c, self.film = k, c, film
        while len(self.width) > 90:
            self.coarsen()
        n = len(self.k)
        half = [w / 2 / kk for w, kk in zip(self.width, self.k)]
        self.between = [1 / (half[i] + half[i + 1]) for i in range(n - 1)] + [1 / half[-1]]
        self.half = half[0]
        self.heat = [w * cc for w, cc in zip(self.width, self.c)]
        # At rest: one flux through all layers into the air.
        total = self.half + 1 / film + sum(1 / g for g in self.between)
        flux = film * (SKIN_C - ROOM_C)
        self.core = ROOM_C + flux * total
        self.t = []
        t = SKIN_C + flux * self.half
        for g in self.between:
            self.t.append(t)
            t += flux / g

    def coarsen(self):
        """Joins the pair of neighbouring cells of one layer that is smallest for its depth."""
        depth, best = 0.0, None
        for i in range(len(self.width) - 1):
            pair = self.width[i] + self.width[i + 1]
            if self.k[i] == self.k[i + 1]:
                cost = pair / (depth + 30e-6)
                if best is None or cost < best[0]:
                    best = (cost, i)
            depth += self.width[i]
        i = best[1]
        self.width[i] += self.width.pop(i + 1)
        self.k.pop(i + 1)
        self.c.pop(i + 1)

    def step(self, conductance, outside_c, dt, theta=0.5):
        """Advances by the theta method, with a conductance from the surface to the outside. Returns the flux out, W/m2."""
        g_out = 1 / (self.half + 1 / conductance)
        t, g, n = self.t, self.between, len(self.t)
        low, diagonal, high, right = [0.0] * n, [0.0] * n, [0.0] * n, [0.0] * n
        for i in range(n):
            above, t_above = (g[i - 1], t[i - 1]) if i else (g_out, outside_c)
            below, t_below = g[i], (t[i + 1] if i + 1 < n else self.core)
            storage = self.heat[i] / dt
            now = above * (t_above - t[i]) + below * (t_below - t[i])
            diagonal[i] = storage + theta * (above + below)
            right[i] = storage * t[i] + (1 - theta) * now
            low[i], high[i] = -theta * above, -theta * below
            if i == 0:
                right[i] += theta * above * outside_c
            if i + 1 == n:
                right[i] += theta * below * self.core
        for i in range(1, n):
            f = low[i] / diagonal[i - 1]
            diagonal[i] -= f * high[i - 1]
            right[i] -= f * right[i - 1]
        t[-1] = right[-1] / diagonal[-1]
        for i in range(n - 2, -1, -1):
            t[i] = (right[i] - high[i] * t[i + 1]) / diagonal[i]
        return g_out * (t[0] - outside_c)


def simulate(finger, air_w_m2, contacts, noise):
    """Windows of contacts: (ticks lifted before, ticks, nominal resistance and factor, display's temperature; over time in s)."""
    q, above, landed, resistances = [], [], [], []
    lagged, last = 0.0, -math.inf
    keep = 1 - math.exp(-TICK_S / LAG_S)
    for lifted, ticks, resistance, factor, display in contacts:
        for _ in range(lifted):
            finger.step(finger.film, ROOM_C, TICK_S, 1.0)
            lagged -= lagged * keep
            q.append(lagged if len(q) - last < 5000 * LAG_S else 0.0)
            above.append(0.0)
            landed.append(0)
            resistances.append(0.0)
        for tick in range(ticks):
            nominal = resistance(tick * TICK_S)
            conductance = 1 / (nominal * factor + SENSOR)
            surface = display(tick * TICK_S)
            if tick < 3:
                for _ in range(20):
                    flux = finger.step(conductance, surface, TICK_S / 20, 1.0)
            else:
                flux = finger.step(conductance, surface, TICK_S)
            lagged += (flux - lagged) * keep
            q.append(lagged + noise.gauss(0, 7))
            above.append(SKIN_C - surface + noise.gauss(0, 0.8e-3))
            landed.append(tick + 1)
            resistances.append(nominal)
        last = len(q)
    windows = []
    for start in range(0, len(q) - 9, 10):
        part = slice(start, start + 10)
        touching = sum(1 for n in landed[part] if n)
        windows.append({
            "flux": round(sum(q[part]) / 10 * 2**12),
            "touching": touching,
            "above": round(sum(above[part]) / 10 * 2**22),
            "air": round(air_w_m2 * 2**12),
            "resistance": round(resistances[part][-1] * 1e6 * 2**16),
            "since": landed[part][-1],
        })
    return windows


class Reference:
    """The estimator in f64."""

    def __init__(self, air_deviation):
        self.sigma = [1, 1, air_deviation, 0.05, 0.45, 0.1 + 1e-3 / LAG_S]
        limits = [(-3.5, 3.5), (-7, 7), (-2.5, 2.5), (-0.3, 0.3), (-0.6, 1.5), (-0.3, 0.3)]
        self.limits = [(a / s, b / s) for (a, b), s in zip(limits, self.sigma)]
        self.theta = MEANS + [0.0] * 4
        self.p = [[float(i == j) for j in range(6)] for i in range(6)]
        self.lags = [0.0] * 4
        self.u, self.o = [0.0] * 8, [0.0] * 8
        self.windows = 0
        self.followed, self.change = [0.0, 0.0], [0.0, 0.0]
        self.learnt_r = None

    def follow(self, index, x, share):
        """Low-pass and the largest distance from it, which is forgotten as fast."""
        self.followed[index] += share * (x - self.followed[index])
        self.change[index] = max((1 - share) * self.change[index], abs(x - self.followed[index]))

    def lag(self, index, x):
        keep = math.exp(-0.01 / LAG_S)
        mean = x + (self.lags[index] - x) * (1 - keep) * LAG_S / 0.01
        self.lags[index] = x + (self.lags[index] - x) * keep
        return mean

    @staticmethod
    def bank(states, x):
        """Means over the window; each state tends to x / rate."""
        means = []
        for k, rate in enumerate(RATES):
            keep = math.exp(-rate * 0.01)
            end = x / rate
            means.append(end + (states[k] - end) * -math.expm1(-rate * 0.01) / (rate * 0.01))
            states[k] = end + (states[k] - end) * keep
        return means + [x]

    def advance(self, w):
        touching = w["touching"] / 10
        flux, air = w["flux"] / 2**12, w["air"] / 2**12 * touching
        d1 = self.lag(0, w["above"] / 2**22)
        d2 = self.lag(1, d1)
        a1, l1 = self.lag(2, air), self.lag(3, touching)
        u, o = self.bank(self.u, flux - a1), self.bank(self.o, a1)
        if not touching:
            if self.windows:
                change = [0.05, 0.05, 0.1, 0.02, 0.07, 0.01]
                for i in range(6):
                    self.p[i][i] = min(self.p[i][i] + (change[i] / self.sigma[i]) ** 2, 1.25)
            self.windows = 0
            return
        self.windows += 1
        since = w["since"]
        r = w["resistance"] / 2**16 * 1e-6
        for index, x, share in ((0, w["above"] / 2**22 / touching, 0.01), (1, r, 0.5)):
            self.follow(index, x, 1 if self.windows == 1 else share)
        every = 1 if since < 300 else 2 if since < 1000 else 4
        if since < 10 or self.windows % every:
            return
        if self.learnt_r:
            moved = 0.2 * (r - self.learnt_r) / max(r, self.learnt_r) / self.sigma[4]
            self.p[4][4] = min(self.p[4][4] + moved**2, 1.25)
        self.learnt_r = r
        y = d1 - sum(a * b for a, b in zip(u, WEIGHTS)) - (r + SENSOR) * flux
        relative = [1 + self.theta[0] * a + self.theta[1] * b for a, b in zip(*COMPONENTS)]
        h = [sum(v * g * x for v, g, x in zip(c, WEIGHTS, u)) for c in COMPONENTS]
        h += [-sum(v * g * x for v, g, x in zip(relative, WEIGHTS, o)), -l1, r * flux, d1 - d2]
        h = [a * s for a, s in zip(h, self.sigma)]
        rho = 1 + self.theta[4] * self.sigma[4]
        unsettled = 0.3**2 if since < 20 else 0
        changes = (0.05 * self.change[0]) ** 2 + (self.change[1] * flux) ** 2
        variance = 20e-3**2 * (1 + since / 50) + unsettled + (rho * r * 7) ** 2 + 1.5e-3**2 + changes
        variance /= every if since < 1000 else 1
        ph = [sum(p * x for p, x in zip(row, h)) for row in self.p]
        s = variance + sum(a * b for a, b in zip(ph, h))
        gain = [a / s for a in ph]
        error = y - sum(a * b for a, b in zip(h, self.theta))
        self.theta = [min(max(t + g * error, a), b) for t, g, (a, b) in zip(self.theta, gain, self.limits)]
        # Joseph's form: (1 - g h) P (1 - g h)' + g r g'.
        left = [[(i == j) - gain[i] * h[j] for j in range(6)] for i in range(6)]
        half = [[sum(left[i][k] * self.p[k][j] for k in range(6)) for j in range(6)] for i in range(6)]
        self.p = [[sum(half[i][k] * left[j][k] for k in range(6)) + gain[i] * variance * gain[j] for j in range(6)]
                  for i in range(6)]
        for i in range(6):
            self.p[i][i] = min(self.p[i][i] + 1e-5, 1.25)


def towards(start, end, tau):
    return lambda t: end + (start - end) * math.exp(-t / tau)


def steady(value):
    return lambda t: value


CASES = [
    ("box", "air", Finger(0.65e-3, 0.21, 1.1, 8.0), [
        (20, 600, steady(7.1e-4), 1.3, towards(26.0, 24.2, 0.05)),
        (310, 600, towards(1.2e-3, 7.1e-4, 0.04), 1.25, towards(31.0, 30.5, 0.3))]),
    ("callus", "air", Finger(1.1e-3, 0.17, 0.95, 12.0), [
        (27, 1203, steady(7.1e-4), 0.7, towards(28.0, 26.0, 0.2)), (500, 400, steady(2.3e-3), 0.7, towards(30.0, 26.0, 0.2))]),
    ("thin", "pad", Finger(0.4e-3, 0.2, 0.85, 2.0), [(33, 907, steady(4.2e-3), 1.6, towards(24.5, 27.0, 0.5))]),
]


def table():
    measured = ("flux", "touching", "above", "air", "resistance", "since")
    learnt = tuple(f"{name}{i}" for name in ("theta", "variance") for i in range(6))
    lines = [",".join(("finger", "place") + measured + learnt)]
    noise = random.Random(25)
    for name, place, finger, contacts in CASES:
        air = (10 if place == "air" else 1.75) * (SKIN_C - ROOM_C)
        reference = Reference(0.33 if place == "air" else 0.48)
        for w in simulate(finger, air, contacts, noise):
            reference.advance(w)
            numbers = reference.theta + [reference.p[i][i] for i in range(6)]
            lines.append(",".join([name, place] + [str(w[c]) for c in measured] + [f"{x:.6f}" for x in numbers]))
    return "\n".join(lines) + "\n"


def close(a, b):
    """Equal but for the last digit of a measurement or estimate, which the host's mathematical library may round otherwise."""
    def same(x, y):
        return x == y or ("." in x and abs(float(x) - float(y)) < 5e-6) or (x.lstrip("-").isdigit() and abs(int(x) - int(y)) < 2)

    rows = [[line.split(",") for line in text.splitlines()] for text in (a, b)]
    return len(rows[0]) == len(rows[1]) and all(len(x) == len(y) and all(map(same, x, y)) for x, y in zip(*rows))


if __name__ == "__main__":
    path, text = HERE / "contacts.csv", table()
    if "--check" in sys.argv[1:]:
        assert close(text, path.read_text()), f"{path} is not what this script writes"
    else:
        path.write_text(text)
