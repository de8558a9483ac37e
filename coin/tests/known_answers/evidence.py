"""Posteriors of the evidence model without its formula: by numerical integration.

    python3 coin/tests/known_answers/evidence.py > coin/tests/known_answers/evidence.json

The crate integrates the borrow rate and the split among owners out by hand and adds log-gamma functions. Here the
borrow rate b ~ Beta(1.2, 6) is integrated by quadrature and the split θ ~ Dirichlet(8, …, 8) by nested quadrature
over its stick-breaking pieces, from the story of the model alone: every session is a loan with probability b and
then falls on each non-owner alike, else it falls on owner u with probability θ_u.
Needs numpy and scipy.
"""

import itertools
import json
import math

from scipy import integrate, stats

A, B, ALPHA = 1.2, 6.0, 8.0
SINGLE, EVERYONE = 0.60, 0.25
PLACE, LOOKS = 0.05, 0.50


def over_unit_interval(density, integrand):
    """∫ density(x)·integrand(x) dx on 0…1, cut where sessions pile the mass up."""
    cuts = [0.0, 1e-3, 1e-2, 0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95, 0.99, 0.999, 1.0]
    return sum(
        integrate.quad(lambda x: density(x) * integrand(x), low, high, epsabs=0.0, epsrel=1e-12, limit=200)[0]
        for low, high in zip(cuts, cuts[1:])
    )


def loans(borrowed, own, others):
    """The probability of the sessions of non-owners, and that the rest were no loans."""
    if others == 0:
        return 1.0
    rate = stats.beta(A, B).pdf
    return over_unit_interval(rate, lambda b: (b / others) ** borrowed * (1.0 - b) ** own)


def split(counts):
    """The probability of which owner had each own session, θ integrated piece by piece of the stick: the first
    owner's piece is Beta(α, (k−1)α), the next one's is Beta(α, (k−2)α) of the remainder, and so on."""
    result = 1.0
    for place in range(len(counts) - 1):
        rest = counts[place + 1 :]
        piece = stats.beta(ALPHA, ALPHA * len(rest)).pdf
        result *= over_unit_interval(piece, lambda x: x ** counts[place] * (1.0 - x) ** sum(rest))
    return result


def owner_sets(members):
    for size in range(1, members + 1):
        yield from itertools.combinations(range(members), size)


def prior(owners, members):
    if members == 1:
        return 1.0
    if len(owners) == 1:
        mass = SINGLE
    elif len(owners) == members:
        mass = EVERYONE
    else:
        mass = (1.0 - SINGLE - EVERYONE) / (members - 2)
    if members == 2:
        mass /= SINGLE + EVERYONE
    return mass / math.comb(members, len(owners))


def posterior(counts, relatives):
    members, total = len(counts), sum(counts)
    couplings = [((PLACE if kind == "near" else LOOKS) * strength, tuple(owners)) for kind, strength, owners in relatives]
    unrelated = math.prod(1.0 - coupling for coupling, _ in couplings)
    weights = {}
    for owners in owner_sets(members):
        own = [counts[user] for user in owners]
        likelihood = loans(total - sum(own), sum(own), members - len(owners)) * split(own)
        belief = unrelated * prior(owners, members)
        if couplings:
            mine = sum(coupling for coupling, theirs in couplings if theirs == owners)
            belief += (1.0 - unrelated) * mine / sum(coupling for coupling, _ in couplings)
        weights[owners] = belief * likelihood
    evidence = sum(weights.values())
    return {owners: weight / evidence for owners, weight in weights.items()}


CASES = [
    ([0], []),
    ([7], []),
    ([0, 0], []),
    ([5, 0], []),
    ([3, 2], []),
    ([9, 8], []),
    ([0, 0, 0], []),
    ([1, 0, 0], []),
    ([5, 1, 0], []),
    ([4, 4, 0], []),
    ([3, 4, 3], []),
    ([12, 2, 1], []),
    ([30, 5, 4], []),
    ([0, 0, 25], []),
    ([2, 0, 1, 0], []),
    ([6, 5, 0, 1], []),
    ([3, 3, 2, 3], []),
    ([1, 0, 4, 0, 0], []),
    ([2, 3, 2, 2, 3], []),
    ([2, 1, 0], [("near", 0.9, [1])]),
    ([2, 1, 0], [("near", 0.9, [1]), ("looks_alike", 0.8, [1])]),
    ([2, 1, 0], [("near", 0.5, [0]), ("near", 0.25, [0, 1]), ("looks_alike", 0.7, [2])]),
    ([0, 0, 0], [("looks_alike", 1.0, [0, 1, 2])]),
    ([1, 0, 1, 0], [("near", 1.0, [0, 2]), ("near", 0.2, [3])]),
]

if __name__ == "__main__":
    table = [
        {
            "sessions": counts,
            "relatives": [{"relation": kind, "strength": strength, "owners": owners} for kind, strength, owners in relatives],
            "posterior": [
                {"owners": list(owners), "probability": float(f"{probability:.12g}")}
                for owners, probability in posterior(counts, relatives).items()
            ],
        }
        for counts, relatives in CASES
    ]
    print("[")
    print(",\n".join(json.dumps(row) for row in table))
    print("]")
