"""Owner sets from independent scores by drawing every combination, with marginals and entropy from scipy.

    python3 coin/tests/known_answers/distributions.py > coin/tests/known_answers/distributions.json

Needs numpy and scipy.
"""

import itertools
import json

import numpy as np
from scipy import stats

SCORES = [[0.9, 0.1, 0.2], [0.5, 0.5], [0.95, 0.93, 0.02, 0.4], [0.01, 0.0, 0.03], [1.0, 0.0, 0.5], [0.7], [0.99] * 5]

if __name__ == "__main__":
    rows = []
    for scores in SCORES:
        outcomes = np.array(list(itertools.product([False, True], repeat=len(scores))))
        chances = np.prod(stats.bernoulli.pmf(outcomes, scores), axis=1)
        somebody = outcomes.any(axis=1)
        outcomes, chances = outcomes[somebody], chances[somebody] / chances[somebody].sum()
        best = int(np.argmax(chances))
        rows.append(
            {
                "scores": scores,
                "marginals": [float(chances[outcomes[:, place]].sum()) for place in range(len(scores))],
                "best": [int(place) for place in np.flatnonzero(outcomes[best])] if np.sum(np.isclose(chances, chances[best])) == 1 else None,
                "confidence": float(chances[best]),
                "entropy": float(stats.entropy(chances)),
            }
        )
    print("[")
    print(",\n".join(json.dumps(row) for row in rows))
    print("]")
