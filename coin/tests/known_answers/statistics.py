"""Known answers of the tests and intervals, by SciPy, statsmodels and lifelines: python3 statistics.py > statistics.json"""

import json

import numpy as np
from lifelines import KaplanMeierFitter
from scipy import stats
from statsmodels.stats.multitest import multipletests

rng = np.random.default_rng(20250113)

SAMPLES = [
    [[0.58, 0.61, 0.60, 0.57], [0.98, 0.97, 1.0, 0.99, 0.95]],
    [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]],
    [[0.988] * 9 + [0.97], [0.588] * 10, [0.647] * 10],
    [[1.0, 1.0, 2.0], [1.0, 2.0, 2.0, 3.0]],
    [rng.normal(0.0, 1.0, 12).round(3).tolist(), rng.normal(0.7, 1.0, 15).round(3).tolist()],
    [rng.integers(0, 6, 10).astype(float).tolist() for _ in range(9)],
]
HOLM = [[0.01, 0.04, 0.03, 0.005], [0.5, 0.5], [0.2], [0.001, 0.001, 0.9, 0.02], []]
SURVIVAL = [
    [[6, 1], [6, 1], [6, 1], [6, 0], [7, 1], [9, 0], [10, 1], [10, 0], [11, 0], [13, 1], [16, 1]],
    [[0, 1], [3, 1], [3, 0], [5, 1]],
    [[4, 0], [9, 0]],
]
BINOMIAL = [[0, 20], [20, 20], [3, 50], [81, 6789], [5400, 6789], [1, 1]]


def holm(p_values):
    return [float(p) for p in multipletests(p_values, method="holm")[1]] if p_values else []


def survival(observations):
    fitter = KaplanMeierFitter().fit([step for step, _ in observations], [event for _, event in observations])
    table = fitter.event_table
    rows = []
    for step in sorted({step for step, _ in observations}):
        row = table.loc[float(step)]
        rows.append({
            "step": step,
            "survival": float(fitter.survival_function_at_times(step).iloc[0]),
            "at_risk": int(row["at_risk"]),
            "reached": int(row["observed"]),
            "censored": int(row["censored"]),
        })
    return rows


answers = {
    "kruskal_wallis": [],
    "mann_whitney": [],
    "holm": [{"p": p, "corrected": holm(p)} for p in HOLM],
    "kaplan_meier": [{"observations": runs, "steps": survival(runs)} for runs in SURVIVAL],
    "clopper_pearson": [],
}
for groups in SAMPLES:
    test = stats.kruskal(*groups)
    answers["kruskal_wallis"].append({"groups": groups, "h": float(test.statistic), "p": float(test.pvalue)})
    test = stats.mannwhitneyu(groups[0], groups[1], alternative="two-sided")
    answers["mann_whitney"].append(
        {"one": groups[0], "other": groups[1], "u": float(test.statistic), "p": float(test.pvalue)}
    )
for count, trials in BINOMIAL:
    interval = stats.binomtest(count, trials).proportion_ci(0.95, method="exact")
    answers["clopper_pearson"].append(
        {"count": count, "trials": trials, "low": float(interval.low), "high": float(interval.high)}
    )
print(json.dumps(answers, indent=1))
