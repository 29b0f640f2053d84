#!/usr/bin/env python3
"""Writes the golden values of `dprime.csv`: the sensitivity d' of an observer from the proportion of correct answers.

usage: generate.py           writes the file anew
       generate.py --check   compares it with what it would write; exit status 1 if it differs

Requires Python 3 and mpmath (`pip install mpmath`). Independent of the Rust code: the inverse error function for two
alternatives, and for three the root of the probability that the signal is the largest.
"""

import sys
from pathlib import Path

FOLDER = Path(__file__).parent
sys.path.insert(0, str(FOLDER.parents[3] / "model/tests/data"))

import generate as model  # noqa: E402
from mpmath import erfc, erfinv, findroot, fsum, mpf, npdf, sqrt  # noqa: E402

PROPORTIONS = {
    2: "0.5 0.68 0.72 0.78 0.90 0.98",
    3: "0.37 0.39 0.44 0.49 0.51 0.54 0.57 0.60 0.62 0.66 0.69 0.72 0.79",
}


def below(x):
    """Normal distribution function."""
    return erfc(-x / sqrt(mpf(2))) / 2


# The trapezoidal rule converges exponentially for these integrands: with this step its error is below 1e-40
STEP = mpf(1) / 4
NODES = [(STEP * i, below(STEP * i) ** 2) for i in range(-60, 68)]


def correct_of_three(d_prime):
    """Probability that the signal exceeds two others; each is normal with deviation 1, and d' is the signal's mean."""
    return STEP * fsum(npdf(x - d_prime) * both_below for x, both_below in NODES)


def dprime(alternatives, p):
    if alternatives == 2:
        return 2 * erfinv(2 * p - 1)
    return findroot(lambda d: correct_of_three(d) - p, (0, 1))


def dprime_rows():
    yield "n_afc", "p_correct", "d_prime"
    for alternatives, proportions in PROPORTIONS.items():
        for p in proportions.split():
            yield alternatives, p, dprime(alternatives, mpf(p))


if __name__ == "__main__":
    model.run(FOLDER, {"dprime.csv": dprime_rows}, __doc__)
