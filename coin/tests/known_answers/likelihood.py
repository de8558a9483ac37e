"""ln p(c|S) of the evidence model as an urn, in exact fractions.

    python3 coin/tests/known_answers/likelihood.py > coin/tests/known_answers/likelihood.json

No beta and no gamma function: the sessions are drawn one after the other, each with its predictive probability given
those before it. After m loans and o own sessions the next is a loan with probability (a + m)/(a + b + m + o), of any
non-owner alike; else it is of owner u with probability (α + c_u)/(kα + o). The order does not matter.
Standard library only.
"""

import json
import math
from fractions import Fraction
from itertools import combinations

A, B, ALPHA = Fraction(6, 5), Fraction(6), Fraction(8)


def log_likelihood(counts, owners):
    members, drawn = len(counts), [0] * len(counts)
    numerator = denominator = 1
    for user, count in enumerate(counts):
        for _ in range(count):
            own = sum(drawn[owner] for owner in owners)
            loans = sum(drawn) - own
            loan = (A + loans) / (A + B + loans + own) if len(owners) < members else Fraction(0)
            if user in owners:
                chance = (1 - loan) * (ALPHA + drawn[user]) / (len(owners) * ALPHA + own)
            else:
                chance = loan / (members - len(owners))
            numerator *= chance.numerator
            denominator *= chance.denominator
            drawn[user] += 1
    return math.log(numerator) - math.log(denominator)


CASES = [[0, 0], [1, 0], [3, 1, 0], [2, 2, 2, 1], [40, 7, 0], [100, 90, 3], [365, 12, 1], [1500, 200, 3], [5, 0, 1, 0, 2]]

if __name__ == "__main__":
    rows = []
    for counts in CASES:
        for size in range(1, len(counts) + 1):
            for owners in combinations(range(len(counts)), size):
                rows.append({"sessions": counts, "owners": list(owners), "log_likelihood": float(f"{log_likelihood(counts, owners):.13g}")})
    print("[")
    print(",\n".join(json.dumps(row) for row in rows))
    print("]")
