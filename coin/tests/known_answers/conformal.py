"""Conformal ranks, quantiles and risk-control thresholds, by exact fractions and by search.

    python3 coin/tests/known_answers/conformal.py > coin/tests/known_answers/conformal.json

Ranks are ceilings of fractions. λ̂ is found by trying every number that could matter: 0, each confidence, the next
floating-point number above each, in rising order; the first that keeps the inequality wins; 2 where none does.
Standard library only.
"""

import json
import math
import random
from fractions import Fraction

LEVELS = ["0.2", "0.1", "0.05", "0.01", "0.012", "0.3"]
SIZES = [1, 3, 4, 8, 9, 18, 19, 83, 98, 99, 150]


def upper(scores, alpha):
    rank = math.ceil((len(scores) + 1) * (1 - alpha))
    return sorted(scores)[rank - 1] if rank <= len(scores) else None


def lower(scores, alpha):
    rank = math.ceil((len(scores) + 1) * alpha)
    return sorted(scores)[min(max(rank, 1), len(scores)) - 1]


def risk_threshold(things, epsilon):
    candidates = {0.0}
    for confidence, _ in things:
        candidates |= {confidence, math.nextafter(confidence, math.inf)}
    for candidate in sorted(candidates):
        losses = sum(1 for confidence, right in things if confidence >= candidate and not right)
        if Fraction(losses + 1, len(things) + 1) <= epsilon:
            return candidate
    return 2.0


if __name__ == "__main__":
    generator = random.Random(20250119)
    rows = []
    for size in SIZES:
        # Two decimals make ties, as the scores of language models do.
        scores = [round(generator.betavariate(1, 3), 2 if size % 2 else 6) for _ in range(size)]
        things = [(score, generator.random() < 0.4 + 0.59 * score) for score in (round(generator.random() ** 0.3, 3) for _ in range(size))]
        rows.append(
            {
                "scores": scores,
                "confidences": [confidence for confidence, _ in things],
                "right": [right for _, right in things],
                "levels": [
                    {
                        "level": float(level),
                        "upper": upper(scores, Fraction(level)),
                        "lower": lower(scores, Fraction(level)),
                        "lambda": risk_threshold(things, Fraction(level)),
                    }
                    for level in LEVELS
                ],
            }
        )
    print("[")
    print(",\n".join(json.dumps(row) for row in rows))
    print("]")
