#!/usr/bin/env python3
"""Writes `packages.json`: random data, and what established packages compute from them.

usage: packages.py           writes the file anew
       packages.py --check   compares it with what it would write, to 1e-7; exit status 1 if it differs

Requires Python 3 with scipy, statsmodels and pingouin; the versions that wrote the file stand in it. It was run once, because
the suite does without these packages. Where two packages compute a number, both are asked, and must agree. Two numbers
are of no package, as their formulas are short: epsilon of a split plot, from the covariance pooled over the groups, and the
fit of a psychometric function with a guess rate, by a general optimiser.
"""

import json
import sys
import warnings
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pingouin
import scipy
import statsmodels
import statsmodels.api as sm
from scipy import integrate, optimize, stats
from sklearn.metrics import mutual_info_score
from statsmodels.formula.api import ols
from statsmodels.stats.anova import AnovaRM, anova_lm

FILE = Path(__file__).parent / "packages.json"
warnings.filterwarnings("ignore", category=FutureWarning)
RANDOM = np.random.default_rng(20061)


def close(one, other, within=1e-9):
    assert abs(one - other) <= within * max(1e-3, abs(other)), (one, other)
    return float(one)


def effect(f, p, eta, df, error_df, epsilon=None, corrected_p=None):
    values = {"f": f, "p": p, "eta": eta, "df": df, "error_df": error_df}
    if epsilon is not None:
        values |= {"epsilon": epsilon, "corrected_p": corrected_p}
    return {key: float(value) for key, value in values.items()}


def eta(f, df, error_df):
    return f * df / (f * df + error_df)


def one_way(sizes):
    groups = [np.round(RANDOM.normal(0.3 * i, 1 + 0.4 * i, n), 4) for i, n in enumerate(sizes)]
    f, p = stats.f_oneway(*groups)
    levene = stats.levene(*groups, center="mean")
    long = pd.DataFrame({"y": np.concatenate(groups), "g": np.repeat(range(len(sizes)), sizes)})
    table = pingouin.anova(long, dv="y", between="g", detailed=True)
    df, error_df = len(sizes) - 1, sum(sizes) - len(sizes)
    tukey = stats.tukey_hsd(*groups)
    limits = tukey.confidence_interval(0.95)
    pairs = [
        {"p": tukey.pvalue[i, j], "low": limits.low[i, j], "high": limits.high[i, j]}
        for i in range(len(sizes))
        for j in range(i + 1, len(sizes))
    ]
    weights = [1.0] * (len(sizes) - 1) + [1.0 - len(sizes)]
    contrast = ols("y ~ C(g) - 1", long).fit().t_test(weights)
    return {
        "groups": [group.tolist() for group in groups],
        "effect": effect(f, close(p, table["p_unc"][0]), table["np2"][0], df, error_df),
        "levene": [levene.statistic, levene.pvalue],
        "tukey": pairs,
        "weights": weights,
        "contrast": [contrast.effect[0], contrast.sd[0][0], contrast.pvalue.item()],
    }


def long_table(cells, names):
    rows = [[*index, value] for index, value in np.ndenumerate(cells)]
    return pd.DataFrame(rows, columns=[*names, "y"])


def contrasts(levels):
    """Orthonormal contrasts of the levels of a factor."""
    basis = np.linalg.qr(np.column_stack([np.ones(levels), np.eye(levels)[:, 1:]]))[0]
    return basis[:, 1:]


def epsilon_of(residuals, matrix):
    """Greenhouse and Geisser's epsilon from residuals and orthonormal contrasts."""
    covariance = matrix.T @ residuals.T @ residuals @ matrix
    return np.trace(covariance) ** 2 / (matrix.shape[1] * np.trace(covariance @ covariance))


def corrected(f, df, error_df, epsilon):
    return stats.f.sf(f, epsilon * df, epsilon * error_df)


def repeated_measures(subjects, levels, scale=1.0):
    sizes = scale * np.linspace(0.5, 2.0, levels)
    cells = RANDOM.normal(0, 1, (subjects, 1)) + RANDOM.normal(0, sizes, (subjects, levels))
    cells = np.round(cells + np.linspace(0, 1, levels) + 20, 4)
    long = long_table(cells, ["s", "a"])
    table = pingouin.rm_anova(
        long, dv="y", within="a", subject="s", correction=True, detailed=True, effsize="np2"
    )
    row, error = table.iloc[0], table.iloc[1]
    other = AnovaRM(long, "y", "s", within=["a"]).fit().anova_table.iloc[0]
    f = close(row["F"], other["F Value"])
    df, error_df = row["DF"], error["DF"]
    epsilon = epsilon_of(cells - cells.mean(axis=0), contrasts(levels))
    if levels > 2:
        close(row["eps"], epsilon, 1e-8)
        close(row["p_GG_corr"], corrected(f, df, error_df, epsilon), 1e-6)
    weights = [-1.0] + [0.0] * (levels - 2) + [1.0]
    contrast = stats.ttest_1samp(cells @ weights, 0)
    return {
        "subjects": cells.tolist(),
        "effect": effect(
            f, row["p_unc"], row["np2"], df, error_df, epsilon, corrected(f, df, error_df, epsilon)
        ),
        "sums_of_squares": [row["SS"], error["SS"]],
        "weights": weights,
        "contrast": [contrast.statistic**2, contrast.pvalue],
    }


def two_within(subjects, a, b):
    cells = RANDOM.normal(0, 1, (subjects, 1, 1)) + RANDOM.normal(0, 0.7, (subjects, a, 1))
    cells = cells + RANDOM.normal(0, 0.6, (subjects, 1, b)) + RANDOM.normal(0, 1, (subjects, a, b))
    cells = np.round(cells + np.linspace(0, 1, a)[:, None] * np.linspace(0, 2, b), 4)
    long = long_table(cells, ["s", "a", "b"])
    other = AnovaRM(long, "y", "s", within=["a", "b"]).fit().anova_table
    table = pingouin.rm_anova(long, dv="y", within=["a", "b"], subject="s", effsize="np2")
    mean_a, mean_b = np.full((a, 1), a**-0.5), np.full((b, 1), b**-0.5)
    matrices = [
        np.kron(contrasts(a), mean_b),
        np.kron(mean_a, contrasts(b)),
        np.kron(contrasts(a), contrasts(b)),
    ]
    flat = cells.reshape(subjects, a * b)
    effects = []
    for matrix, (_, row), (_, known) in zip(matrices, table.iterrows(), other.iterrows()):
        f = close(row["F"], known["F Value"])
        df, error_df = row["ddof1"], row["ddof2"]
        epsilon = epsilon_of(flat - flat.mean(axis=0), matrix)
        # pingouin's epsilon of an interaction is that of the package for some sizes only, as its manual says
        if matrix is not matrices[2] or min(a, b) == 2:
            close(row["eps"], epsilon, 1e-8)
        effects.append(
            effect(
                f,
                close(row["p_unc"], known["Pr > F"]),
                row["np2"],
                df,
                error_df,
                epsilon,
                corrected(f, df, error_df, epsilon),
            )
        )
    return {"subjects": cells.tolist(), "effects": effects}


def split_plot(groups, subjects, levels):
    cells = RANDOM.normal(0, 1, (groups, subjects, 1))
    cells = cells + RANDOM.normal(0, np.linspace(0.4, 1.6, levels), (groups, subjects, levels))
    slopes = np.linspace(0, 1, groups)[:, None, None] * np.linspace(0, 1.5, levels)
    cells = np.round(cells + slopes, 4)
    long = long_table(cells, ["g", "s", "b"])
    long["s"] += 100 * long["g"]
    table = pingouin.mixed_anova(long, dv="y", within="b", between="g", subject="s")
    residuals = (cells - cells.mean(axis=1, keepdims=True)).reshape(-1, levels)
    epsilon = epsilon_of(residuals, contrasts(levels))
    effects = []
    for i, (_, row) in enumerate(table.iterrows()):
        f, df, error_df = row["F"], row["DF1"], row["DF2"]
        correction = (epsilon, corrected(f, df, error_df, epsilon)) if i else ()
        effects.append(effect(f, row["p_unc"], row["np2"], df, error_df, *correction))
    return {"groups": cells.tolist(), "effects": effects}


def ranges():
    cases = product([0.3, 1.5, 3.4, 6.0], [2, 3, 5, 12], [2, 9, 36, 240])
    return [[q, k, df, stats.studentized_range.sf(q, k, df)] for q, k, df in cases]


def contingency(rows, columns):
    table = RANDOM.integers(3, 40, (rows, columns))
    chi2, p, df, _ = stats.chi2_contingency(table, correction=False)
    expected = np.round(RANDOM.uniform(0.5, 2, columns), 3)
    fit = stats.chisquare(table[0], table[0].sum() * expected / expected.sum())
    labels = [(i, j) for (i, j), n in np.ndenumerate(table) for _ in range(n)]
    information = mutual_info_score(*zip(*labels)) / np.log(2)
    return {
        "table": table.tolist(),
        "independence": [chi2, df, p],
        "proportions": expected.tolist(),
        "fit": [fit.statistic, fit.pvalue],
        "bits": information,
    }


def pairs(n, slope):
    x = np.round(RANDOM.normal(3, 1, n), 4)
    y = np.round(slope * x + RANDOM.normal(0, 1, n), 4)
    r = stats.pearsonr(x, y)
    interval = r.confidence_interval(0.95)
    paired, single = stats.ttest_rel(x, y), stats.ttest_1samp(x, 2.5)
    of_difference = paired.confidence_interval(0.99)
    origin = sm.OLS(y, x).fit()
    return {
        "x": x.tolist(),
        "y": y.tolist(),
        "pearson": [r.statistic, r.pvalue, interval.low, interval.high],
        "paired": [paired.statistic, paired.pvalue, of_difference.low, of_difference.high],
        "one_sample": [single.statistic, single.pvalue],
        "origin": [origin.params[0], origin.bse[0], origin.mse_resid**0.5],
    }


def ancova(sizes):
    groups = []
    for i, n in enumerate(sizes):
        x = np.round(RANDOM.normal(0.4 * i, 1, n), 4)
        y = np.round(0.6 * x + 0.5 * i + RANDOM.normal(0, 0.8, n), 4)
        groups.append((x, y))
    long = pd.DataFrame(
        {
            "x": np.concatenate([x for x, _ in groups]),
            "y": np.concatenate([y for _, y in groups]),
            "g": np.repeat(range(len(sizes)), sizes),
        }
    )
    fit = ols("y ~ C(g) + x", long).fit()
    table = anova_lm(fit, typ=2)
    other = pingouin.ancova(long, dv="y", between="g", covar="x")
    error_df = table["df"]["Residual"]

    def of(name, row):
        f, df = close(table["F"][name], other["F"][row], 1e-8), table["df"][name]
        return effect(f, table["PR(>F)"][name], eta(f, df, error_df), df, error_df)

    return {
        "groups": [{"x": x.tolist(), "y": y.tolist()} for x, y in groups],
        "slope": fit.params["x"],
        "factor": of("C(g)", 0),
        "covariate": of("x", 1),
    }


def exponential(tau, noise):
    t = np.round(np.linspace(0.1, 10, 60), 4)
    y = np.round(26 + 7 * np.exp(-t / tau) + RANDOM.normal(0, noise, t.size), 4)

    def model(t, c, a, tau):
        return c + a * np.exp(-t / tau)

    found, _ = optimize.curve_fit(model, t, y, (25, 5, 2), xtol=1e-15, ftol=1e-15, gtol=1e-15)
    r2 = 1 - ((y - model(t, *found)) ** 2).sum() / ((y - y.mean()) ** 2).sum()
    return {"t": t.tolist(), "y": y.tolist(), "offset": found[0], "amplitude": found[1], "tau": found[2], "r2": r2}


def glm(shape, levels, n, a, b):
    """Without guess and lapse a psychometric function is a generalised linear model."""
    links = sm.families.links
    link, scale = {"weibull": (links.CLogLog(), np.log), "normal": (links.Probit(), np.array)}[shape]
    levels = np.array(levels)
    u = scale(levels)
    k = RANDOM.binomial(n, link.inverse(a + b * u))
    design = sm.add_constant(u)
    fit = sm.GLM(np.column_stack([k, n - k]), design, sm.families.Binomial(link)).fit(tol=1e-14, maxiter=200)
    (intercept, slope), covariance = fit.params, fit.cov_params()
    # The level of 60 % and its standard error by propagation
    z = link(0.6)
    u60 = (z - intercept) / slope
    gradient = np.array([-1 / slope, -u60 / slope])
    error = float(np.sqrt(gradient @ covariance @ gradient))
    level = float(np.exp(u60)) if shape == "weibull" else float(u60)
    location = -intercept / slope
    return {
        "shape": shape,
        "guess": 0.0,
        "lapse": 0.0,
        "levels": levels.tolist(),
        "correct": k.tolist(),
        "total": n,
        "location": float(np.exp(location)) if shape == "weibull" else float(location),
        "slope": float(slope),
        "deviance": float(fit.deviance),
        "proportion": 0.6,
        "threshold": level,
        "standard_error": error * level if shape == "weibull" else error,
    }


def psychometric(shape, guess, lapse, levels, n, location, slope):
    levels = np.array(levels)

    def probability(location, slope):
        if shape == "weibull":
            return guess + (1 - guess - lapse) * -np.expm1(-((levels / location) ** slope))
        return guess + (1 - guess - lapse) * stats.norm.cdf(slope * (levels - location))

    k = RANDOM.binomial(n, probability(location, slope))

    def unlikely(x):
        p = np.clip(probability(x[0], np.exp(x[1])), 1e-300, 1 - 1e-16)
        return -stats.binom.logpmf(k, n, p).sum()

    found = optimize.minimize(
        unlikely,
        (location, np.log(slope)),
        method="Nelder-Mead",
        options={"xatol": 1e-12, "fatol": 1e-14, "maxiter": 10000, "maxfev": 10000},
    )
    # Fisher information by central differences
    p, step = probability(found.x[0], np.exp(found.x[1])), 1e-6
    columns = []
    for i in range(2):
        up, down = found.x.copy(), found.x.copy()
        up[i] += step
        down[i] -= step
        difference = probability(up[0], np.exp(up[1])) - probability(down[0], np.exp(down[1]))
        columns.append(difference / (2 * step))
    design = np.column_stack(columns)
    covariance = np.linalg.inv(design.T @ np.diag(n / (p * (1 - p))) @ design)
    proportion = guess + (1 - guess - lapse) * (1 - np.exp(-1) if shape == "weibull" else 0.5)
    return {
        "shape": shape,
        "guess": guess,
        "lapse": lapse,
        "levels": levels.tolist(),
        "correct": k.tolist(),
        "total": n,
        "location": found.x[0],
        "slope": float(np.exp(found.x[1])),
        "deviance": float(
            2 * (found.fun - -stats.binom.logpmf(k, n, k / n).sum())
        ),
        "proportion": proportion,
        "threshold": found.x[0],
        "standard_error": float(covariance[0, 0] ** 0.5),
    }


def sensitivities():
    """Proportion correct by quadrature: m alternatives, or 0 for the different one of three."""
    rows = []
    for m, d in product([2, 3, 4, 8], [-0.7, 0.0, 0.4, 1.3, 3.1]):
        p, _ = integrate.quad(
            lambda x: stats.norm.pdf(x - d) * stats.norm.cdf(x) ** (m - 1), -9, 13, epsabs=1e-13, limit=200
        )
        rows.append([m, d, p])
    for d in [0.0, 0.3, 1.0, 1.83, 3.0, 5.0]:
        share, root = d * (2 / 3) ** 0.5, 3**0.5
        p, _ = integrate.quad(
            lambda u: 2
            * stats.norm.pdf(u)
            * (stats.norm.cdf(share - root * u) + stats.norm.cdf(-share - root * u)),
            0,
            12,
            epsabs=1e-13,
        )
        rows.append([0, d, p])
    return rows


def proportions():
    rows = []
    for k, n, chance in [(29, 40, 0.5), (0, 12, 0.5), (12, 12, 0.5), (42, 90, 1 / 3), (7, 30, 0.2), (1, 3, 0.5)]:
        test = stats.binomtest(k, n, chance, alternative="greater")
        interval = stats.binomtest(k, n, chance).proportion_ci(0.95, "exact")
        criteria = [j for j in range(n + 1) if stats.binom.sf(j - 1, n, chance) < 0.01]
        rows.append([k, n, chance, test.pvalue, interval.low, interval.high, min(criteria, default=-1)])
    return rows


def build():
    versions = {m.__name__: m.__version__ for m in (scipy, statsmodels, pingouin, np)}
    weibull, normal = [0.2, 0.4, 0.8, 1.6, 3.2], [-2, -1, -0.3, 0.4, 1, 2.2]
    return {
        "versions": versions,
        "one_way": [one_way(sizes) for sizes in [(9,) * 6, (5, 8, 11), (20, 20), (4, 3, 6, 5, 7)]],
        "repeated_measures": [repeated_measures(*size) for size in [(10, 5), (10, 2), (6, 3), (12, 6, 3)]],
        "two_within": [two_within(*size) for size in [(10, 2, 5), (10, 5, 2), (7, 3, 4), (9, 2, 2)]],
        "split_plot": [split_plot(*size) for size in [(2, 10, 5), (3, 6, 4), (2, 8, 2)]],
        "studentized_range": ranges(),
        "counts": [contingency(*size) for size in [(2, 3), (3, 3), (5, 5)]],
        "pairs": [pairs(*args) for args in [(5, 1.5), (25, 0.8), (100, 0.1), (8, -1.0)]],
        "ancova": [ancova(sizes) for sizes in [(8, 8, 8), (5, 9, 7, 6), (15, 12)]],
        "exponential": [exponential(*args) for args in [(0.8, 0.02), (3.0, 0.05), (6.0, 0.01)]],
        "psychometric": [
            glm("weibull", weibull, 60, 0.2, 1.4),
            glm("normal", normal, 40, -0.2, 1.1),
            psychometric("weibull", 0.5, 0.02, weibull, 80, 0.9, 2.0),
            psychometric("weibull", 1 / 3, 0.0, weibull, 50, 1.2, 1.3),
            psychometric("normal", 0.5, 0.03, normal, 60, 0.1, 1.5),
        ],
        "sensitivity": sensitivities(),
        "proportion": proportions(),
    }


def plain(value):
    """numpy's numbers as Python's."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return value.item()
    return value


def differences(one, other, place=""):
    if isinstance(one, dict):
        for key in one:
            yield from differences(one[key], other.get(key), f"{place}.{key}")
    elif isinstance(one, list):
        for i, (a, b) in enumerate(zip(one, other, strict=True)):
            yield from differences(a, b, f"{place}[{i}]")
    elif isinstance(one, float) and isinstance(other, (int, float)):
        if abs(one - other) > 1e-7 * max(1e-3, abs(one)):
            yield f"{place}: committed {one}, generated {other}"
    elif one != other:
        yield f"{place}: committed {one}, generated {other}"


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    new = plain(build())
    if sys.argv[1:]:
        found = list(differences(json.loads(FILE.read_text()), new))
        print("\n".join(found))
        sys.exit(1 if found else 0)
    sections = []
    for name, value in new.items():
        if isinstance(value, list):
            items = ",\n".join("  " + json.dumps(item) for item in value)
            sections.append(f'"{name}": [\n{items}\n]')
        else:
            sections.append(f'"{name}": {json.dumps(value)}')
    FILE.write_text("{\n" + ",\n".join(sections) + "\n}\n", newline="\n")
    print(f"wrote {FILE.name}")
