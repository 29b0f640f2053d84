#!/usr/bin/env python3
"""Prints what established packages compute for the test `ancova_is_that_of_packages`.

Requires Python 3 with statsmodels and pingouin. It was run once, with statsmodels 0.15.0 and pingouin 0.7.0, because the
suite does without these packages. Both give F and p of the covariate; with participants as the factor it is pingouin's
repeated-measures correlation.
"""

from math import log2

import pandas as pd
import pingouin
import statsmodels
from statsmodels.formula.api import ols
from statsmodels.stats.anova import anova_lm

# Table 4-1 and, of bronze, Table 3-2 of the thesis: roughness Rq in um, Young's modulus in GPa.
PROPERTIES = {
    "copper": (0.31, 110.0),
    "bronze": (0.32, 93.0),
    "stainless-steel": (0.19, 193.0),
    "abs": (0.45, 2.3),
    "foam": (8.03, 1.5e-3),
}
# Correct answers of four, for each participant.
PAIRS = {
    ("copper", "bronze"): (3, 2, 1),
    ("copper", "stainless-steel"): (2, 3, 3),
    ("copper", "abs"): (4, 3, 4),
    ("bronze", "abs"): (4, 4, 3),
    ("stainless-steel", "foam"): (4, 4, 4),
}

print("statsmodels", statsmodels.__version__, "pingouin", pingouin.__version__)
for number, name in enumerate(["roughness", "Young's modulus"]):
    rows = [
        (participant, abs(log2(PROPERTIES[one][number] / PROPERTIES[other][number])), 25.0 * correct)
        for (one, other), counts in PAIRS.items()
        for participant, correct in enumerate(counts)
    ]
    table = pd.DataFrame(rows, columns=["participant", "x", "y"])
    fit = ols("y ~ C(participant) + x", table).fit()
    effects = anova_lm(fit, typ=2)
    other = pingouin.rm_corr(table, x="x", y="y", subject="participant")
    print(name, "slope", fit.params["x"])
    print(effects.to_string())
    print(other.to_string())
    p = other.filter(regex="p").iloc[0, 0]
    assert abs(p - effects["PR(>F)"]["x"]) < 1e-9, p
