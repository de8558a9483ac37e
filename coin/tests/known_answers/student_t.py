"""Posterior predictive densities of positions, by SciPy's multivariate t: python3 student_t.py > student_t.json"""

import json

import numpy as np
from scipy.stats import multivariate_t

rng = np.random.default_rng(20250114)
rows = []
for seen_count in (0, 1, 2, 7):
    mean, scatter = rng.normal(0, 2, 3), rng.uniform(0.1, 2.0, 3)
    mean_weight, freedom = rng.uniform(0.05, 2.0), rng.uniform(4.0, 9.0)
    seen, position = rng.normal(1, 2, (seen_count, 3)), rng.normal(1, 2, 3)
    weight, posterior_freedom = mean_weight + seen_count, freedom + seen_count
    posterior_mean = (mean_weight * mean + seen.sum(axis=0)) / weight
    posterior_scatter = (
        np.diag(scatter) + seen.T @ seen + mean_weight * np.outer(mean, mean)
        - weight * np.outer(posterior_mean, posterior_mean)
    )
    t_freedom = posterior_freedom - 2
    shape = posterior_scatter * (weight + 1) / (weight * t_freedom)
    rows.append({
        "mean": mean.tolist(),
        "mean_weight": mean_weight,
        "degrees_of_freedom": freedom,
        "scatter": scatter.tolist(),
        "seen": seen.tolist(),
        "position": position.tolist(),
        "log_density": float(multivariate_t.logpdf(position, posterior_mean, shape, df=t_freedom)),
    })
print(json.dumps(rows, indent=1))
