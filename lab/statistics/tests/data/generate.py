#!/usr/bin/env python3
"""Writes the exact values of this folder: sensitivities, probabilities of z and test statistics, and those of the thesis.

usage: generate.py           writes the files anew
       generate.py --check   compares them with what it would write; exit status 1 if they differ

Requires Python 3 and mpmath (`pip install mpmath`). Independent of the Rust code: probabilities are incomplete beta and
gamma functions or sums with 60 digits, sensitivities the roots of integrals, the studentized range a double sum. The
values of established packages are in `packages.json`, which `packages.py` writes.
"""

import sys
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent
sys.path.insert(0, str(FOLDER.parents[3] / "model/tests/data"))

import generate as model  # noqa: E402
from mpmath import (  # noqa: E402
    betainc,
    binomial,
    erfc,
    erfinv,
    exp,
    findroot,
    fsum,
    gammainc,
    inf,
    mpf,
    nstr,
    pi,
    sqrt,
    workdps,
)

PROPORTIONS = {
    2: "0.5 0.68 0.72 0.78 0.90 0.98",
    3: "0.37 0.39 0.44 0.49 0.51 0.54 0.57 0.60 0.62 0.66 0.69 0.72 0.79",
}
ODDITY = "0.34 0.38 0.43 0.50 0.57 0.61 0.66 0.74 0.82 0.90 0.97 0.999"

# z, of which the nearest double is taken, as the program has it
NORMAL = """
-30 -29.3 -28.7 -25.1 -20.3 -17.9 -15 -12.7 -10.1 -8.7 -8.3 -7.1 -5.9 -4.7 -3.3 -2.1 -1.96 -1.3 -0.7 -0.3 -1e-9 0 0.1 0.9
1.96 3.7 6.1 8.3
"""

# Degrees of freedom of effect and error, and F
F_TAILS = """
1 1 0.001 1 9 0.5 1 9 5.117355 1 9 56.49 1 9 4000 1 48 1e-8 2 18 0.68 2 18 12.5 3 200 2.65 4 36 0.01 4 36 0.2
4 36 1.24 4 36 236.11 4 36 20000 5 45 1.02 9 90 3.94 9 90 1e-3 12 600 30 24 5000 1.7 40 40 1 0.73 6.6 4.1
2.43 21.9 3.3 2.43 21.9 80 19.7 373 0.9 500 500 1.5
"""
T_TAILS = "9 1e-9 9 2.08 9 40 1 1000 3.7 2.9 59 2.08 239 0.1 1000 6 30000 2"
CHI_SQUARE_TAILS = "1 1e-6 1 3.84 2 0.51 2 60 3 7.8 4 4 15 3 15 40 24 200 150 150 0.5 2"
# n, k, chance; the chance is the nearest double, as the program has it
BINOMIAL_TAILS = """
40 29 0.5 40 28 0.5 90 49 0.3333333333333333 90 42 0.3333333333333333 30 12 0.2 90 28 0.2 10 1 0.01 200 200 0.5
400 120 0.25 3000 1600 0.5 3000 1000 0.3333333333333333 1 1 0.5 7 1 1e-6
"""
# q, means, degrees of freedom
RANGES = """
3.67 2 36 3.67 5 36 3.88 5 36 9.45 5 36 0.5 3 10 4.2 7 90 12 3 5 3.3 10 20 6 20 400
"""

# What the thesis prints (section, statistic, degrees of freedom, value, p) and what is to be said of it: `right`; `rounded`
# if only rounding of the value explains the printed p; `wrong`. Degrees of freedom: of effect and error for F, number of
# means and those of the error for q, number of pairs for r, answers and chance for a binomial, whose value is the correct
# ones.
THESIS = """
3.2.2|t|9|2.08|0.04|wrong|ten subjects leave 9; the printed p needs 45 or more
3.2.2|t|59|2.08|0.04|right|with trials in place of subjects
3.2.2|t|239|2.08|0.04|right|with trials in place of subjects
3.2.2|F|5 48|1.927|0.11|right|
3.2.2|binomial|40 0.5|29|<0.01|right|the criterion of 72 %
3.2.2|binomial|40 0.5|28|>0.01|wrong|70 % counts as not told apart
3.3.2|binomial|90 0.3333333333333333|49|<0.0001|right|the criterion of 54 %
3.3.2|F|4 9|11.92|<0.001|wrong|the denominator has 36
3.3.2|F|4 36|11.92|<0.001|right|with the right denominator
3.3.2|F|1 9|1.90|0.20|right|
3.3.2|F|4 36|4.04|0.008|right|
3.3.2|F|1 9|3.90|0.08|right|
3.3.2|F|2 9|2.141|0.15|wrong|the denominator has 18
3.3.2|F|2 18|2.141|0.15|right|with the right denominator
4.2.2|binomial|30 0.2|12|<0.01|right|the criterion of 40 %
4.2.2|F|4 36|1.24|0.311|right|
4.2.2|F|4 36|7.54|<0.001|right|
4.2.2|F|1 9|56.49|<0.001|right|
4.2.2|F|1 9|17.32|<0.01|right|
4.2.2|F|1 9|5.89|0.038|right|
4.2.2|F|1 9|0.87|0.375|right|
4.2.2|F|4 36|21.04|<0.001|right|
4.2.2|F|4 36|2.98|0.032|right|
4.2.2|q|2 36|3.67|<0.05|right|the number of means that is printed
4.2.2|q|5 36|3.67|<0.05|wrong|five materials were compared
4.2.2|F|2 18|0.68|0.520|rounded|
4.3.2|F|1 9|2.49|0.149|right|
4.3.2|F|5 45|10.71|<0.001|right|
4.3.2|F|5 45|1.02|0.397|wrong|not the p of this F
4.3.2|F|1 9|6.13|0.035|right|
4.3.2|F|1 9|34.61|<0.001|right|
4.3.2|F|1 9|21.68|0.001|right|
4.3.2|chi2|2|0.51|0.775|right|
4.4.2|F|9 90|3.94|<0.001|right|
4.4.2|F|9 90|0.93|0.505|rounded|
4.4.2|F|1 9|16.48|0.003|right|
4.4.2|F|4 36|236.11|<0.001|right|
4.4.2|F|4 36|19.88|<0.001|right|
4.4.2|q|2 36|3.88|<0.05|right|the number of means that is printed
4.4.2|q|5 36|3.88|<0.05|wrong|five materials were compared
4.4.2|q|5 36|9.45|<0.05|right|
4.4.2|q|5 36|7.96|<0.05|right|
4.4.2|r|5|0.93|0.021|rounded|
4.4.2|r|5|0.99|<0.001|rounded|
6.2.2|F|1 8|7.409|0.026|right|
6.2.2|F|1 8|2.098|0.186|right|
6.2.2|F|1 8|4.280|0.072|right|
6.2.2|F|1 8|1.399|0.271|right|
6.2.2|F|1 8|0.001|0.978|rounded|
6.2.3|r|100|0.139|0.167|rounded|
6.4.2|F|1 9|2.726|0.133|right|
6.4.2|F|4 36|42.194|<0.001|right|
6.4.2|F|4 36|0.653|0.629|right|
6.4.2|F|1 9|0.860|0.378|right|
6.4.2|F|4 36|11.191|<0.001|right|
6.4.2|F|4 36|2.111|0.1|right|
"""


def below(x):
    """Normal distribution function."""
    return erfc(-x / sqrt(mpf(2))) / 2


# The density's factor, with all digits: `npdf` computes it anew for each of some hundred thousand nodes.
DENSITY = 1 / sqrt(2 * pi)


def density(x):
    """Normal density."""
    return DENSITY * exp(-x * x / 2)


# The trapezoidal rule converges exponentially for these integrands: with this step its error is below 1e-40
STEP = mpf(1) / 4
NODES = [(STEP * i, below(STEP * i) ** 2) for i in range(-60, 68)]


def correct_of_three(d_prime):
    """Probability that the signal exceeds two others; each is normal with deviation 1, and d' is the signal's mean."""
    return STEP * fsum(density(x - d_prime) * both_below for x, both_below in NODES)


def dprime(alternatives, p):
    if alternatives == 2:
        return 2 * erfinv(2 * p - 1)
    return findroot(lambda d: correct_of_three(d) - p, (0, 1))


def forced_choice_rows():
    yield "n_afc", "p_correct", "d_prime"
    for alternatives, proportions in PROPORTIONS.items():
        for p in proportions.split():
            yield alternatives, p, dprime(alternatives, mpf(p))


def correct_odd(d_prime):
    """Probability that the odd one is farther from both others than these from each other.

    With y the difference of the others over sqrt(2), and x that of the odd one from their mean over sqrt(3/2): x has the
    mean d' sqrt(2/3), y the mean 0, both the deviation 1, and the odd one is found if |x| > |y| sqrt(3).
    """
    mean = d_prime * sqrt(mpf(2) / 3)
    return fsum(weight * (density(x - mean) + density(x + mean)) for x, weight in half_line())


@cache
def half_line():
    """Nodes over |x| and their weights times the probability that |y| sqrt(3) is smaller: the double exponential rule."""
    step = mpf(1) / 20
    nodes = []
    for i in range(-90, 61):
        t = step * i
        x = exp(t - exp(-t))
        nodes.append((x, step * x * (1 + exp(-t)) * (1 - erfc(x / sqrt(mpf(6))))))
    return nodes


def oddity_rows():
    yield "p_correct", "d_prime"
    with workdps(30):
        for p in ODDITY.split():
            yield p, nstr(findroot(lambda d, p=p: correct_odd(d) - mpf(p), (1, 2)), 20)


def f_tail(f, effect, error):
    return betainc(error / 2, effect / 2, 0, error / (error + effect * f), regularized=True)


def t_tail(t, df):
    return f_tail(t * t, mpf(1), df)


def chi_square_tail(x, df):
    return gammainc(df / 2, x / 2, inf, regularized=True)


def binomial_tail(n, k, chance):
    n, k, chance = int(n), int(k), mpf(float(chance))
    terms = (binomial(n, i) * chance**i * (1 - chance) ** (n - i) for i in range(k, n + 1))
    return fsum(terms)


@cache
def range_tail(q, means, df):
    """Probability of a studentized range above q: over x = ln s of the estimated standard error s, and over the smallest of the
    normal variables. Both trapezoidal rules converge exponentially; the steps leave 1e-15."""
    means = int(means)
    with workdps(20):
        inner = [(z, density(z), below(z)) for z in (mpf(i) / 6 for i in range(-54, 55))]

        def within(width):
            terms = (weight * (below(z + width) - at) ** (means - 1) for z, weight, at in inner)
            return means * fsum(terms) / 6

        step = min(mpf(1) / 16, mpf("0.3") / sqrt(df))
        # s² is chi-squared over its degrees of freedom
        outer = [(exp(step * i), exp(df * (step * i - exp(2 * step * i) / 2 + mpf(1) / 2))) for i in range(-400, 200)]
        outer = [(s, weight) for s, weight in outer if weight > mpf(10) ** -20]
        total = fsum(weight for _, weight in outer)
        return 1 - fsum(weight * within(q * s) for s, weight in outer) / total


def groups(text, size):
    numbers = text.split()
    return [numbers[i : i + size] for i in range(0, len(numbers), size)]


def normal_rows():
    yield "z", "p"
    for z in NORMAL.split():
        yield z, below(mpf(float(z)))


def tails_rows():
    yield "statistic", "df", "value", "p"
    for effect, error, f in groups(F_TAILS, 3):
        yield "F", f"{effect} {error}", f, f_tail(mpf(f), mpf(effect), mpf(error))
    for df, t in groups(T_TAILS, 2):
        yield "t", df, t, t_tail(mpf(t), mpf(df))
    for df, x in groups(CHI_SQUARE_TAILS, 2):
        yield "chi2", df, x, chi_square_tail(mpf(x), mpf(df))
    for n, k, chance in groups(BINOMIAL_TAILS, 3):
        yield "binomial", f"{n} {chance}", k, binomial_tail(n, k, chance)
    for q, means, df in groups(RANGES, 3):
        # The sum has fewer digits
        yield "q", f"{means} {df}", q, nstr(range_tail(mpf(q), means, mpf(df)), 13)


def exact_p(statistic, df, value):
    df = [mpf(number) for number in df.split()]
    value = mpf(value)
    if statistic == "F":
        return f_tail(value, *df)
    if statistic == "t":
        return t_tail(value, *df)
    if statistic == "chi2":
        return chi_square_tail(value, *df)
    if statistic == "binomial":
        return binomial_tail(df[0], value, df[1])
    if statistic == "q":
        return nstr(range_tail(value, *df), 12)
    degrees = df[0] - 2
    return t_tail(value * sqrt(degrees / (1 - value**2)), degrees)


def thesis_rows():
    yield "section", "statistic", "df", "value", "printed_p", "exact_p", "verdict", "remark"
    for line in THESIS.strip().splitlines():
        section, statistic, df, value, printed, verdict, remark = line.split("|")
        exact = exact_p(statistic, df, value)
        exact = exact if isinstance(exact, str) else nstr(exact, 17)
        yield section, statistic, df, value, printed, exact, verdict, remark


if __name__ == "__main__":
    files = {
        "forced_choice.csv": forced_choice_rows,
        "normal.csv": normal_rows,
        "oddity.csv": oddity_rows,
        "tails.csv": tails_rows,
        "thesis.csv": thesis_rows,
    }
    model.run(FOLDER, files, __doc__)
