"""Judgements of whole homes by plain enumeration: every thing, every owner set, every point of the grid of habits.

    python3 coin/tests/known_answers/home.py > coin/tests/known_answers/home.json

Written from the definitions and in another way than the crate: probabilities instead of logarithms, no tables, no sums
that are shared between points of the grid. Needs nothing but Python.
"""

import json
from itertools import combinations, product
from math import exp, lgamma, log

SIZES = [(0.75, 0.15), (0.60, 0.25), (0.45, 0.30)]
LENDING = [(1.2, 10.8), (2.0, 8.0), (3.3, 6.7), (5.0, 7.5)]
EVENNESS = [8.0, 25.0]
MISTAKEN = [0.01, 0.06]
SINGLE_KEPT = [0.2, 0.5]
SHARED_KEPT = [0.1, 0.35, 0.65]
TURNS, CHANGE, EVERYBODYS_BEFORE, MOST_CUTS, TRUST = 1.5, 0.04, 0.2, 16, 0.95


def owner_sets(members):
    return [frozenset(some) for size in range(1, members + 1) for some in combinations(range(members), size)]


def prior(owners, members, single, everyone):
    """By the number of owners, evenly within a number."""
    if members == 1:
        return 1.0
    of_size = {1: single, members: everyone}
    between = range(2, members)
    for size in between:
        of_size[size] = (1 - single - everyone) / len(between)
    alike = sum(len(other) == len(owners) for other in owner_sets(members))
    return of_size[len(owners)] / alike / (1.0 if between else single + everyone)


def kept(users, owners, members, mistaken):
    """In turns among the owners; a mistaken sighting names anybody."""
    probability, used = 1.0, dict.fromkeys(owners, 0)
    for user in users:
        turn = 0.0
        if user in owners:
            turn = exp(-TURNS * used[user]) / sum(exp(-TURNS * count) for count in used.values())
            used[user] += 1
        probability *= (1 - mistaken) * turn + mistaken / members
    return probability


def log_beta(a, b):
    return lgamma(a) + lgamma(b) - lgamma(a + b)


def lent(users, owners, members, lending, evenness):
    """A borrow rate integrated out, an even split among the owners."""
    own = sum(user in owners for user in users)
    borrowed, logarithm = len(users) - own, 0.0
    if len(owners) < members:
        a, b = lending
        logarithm += log_beta(a + borrowed, b + own) - log_beta(a, b) - borrowed * log(members - len(owners))
    if len(owners) > 1:
        logarithm += lgamma(len(owners) * evenness) - lgamma(len(owners) * evenness + own)
        logarithm += sum(lgamma(evenness + users.count(user)) - lgamma(evenness) for user in owners)
    return exp(logarithm)


def changed(users, owners, members, lending):
    """Somebody else's, or everybody's, before one of some sessions; None where there is nothing to cut."""
    if len(users) < 2 or members < 2:
        return None
    everybody = frozenset(range(members))
    before = {frozenset([user]): (1 - EVERYBODYS_BEFORE) / members for user in range(members)}
    before[everybody] = EVERYBODYS_BEFORE
    before.pop(owners, None)
    places = min(len(users) - 1, MOST_CUTS)
    cuts = [min(-(-place * len(users) // (places + 1)), len(users) - 1) for place in range(1, places + 1)]
    total = 0.0
    for cut in cuts:
        earlier = sum(weight * lent(users[:cut], other, members, lending, EVENNESS[0]) for other, weight in before.items())
        total += earlier / sum(before.values()) * lent(users[cut:], owners, members, lending, EVENNESS[0])
    return total / len(cuts)


def judged(things, members, answers):
    """For every thing the probability of every owner set."""
    sets = owner_sets(members)
    sums, total = [dict.fromkeys(sets, 0.0) for _ in things], 0.0
    for sizes, lending, evenness, mistaken, single, shared in product(
        SIZES, LENDING, EVENNESS, MISTAKEN, SINGLE_KEPT, SHARED_KEPT
    ):
        weight, beliefs = 1.0, []
        for place, users in enumerate(things):
            joint = {}
            for owners in sets:
                share = single if len(owners) == 1 else shared
                use = share * kept(users, owners, members, mistaken)
                use += (1 - share) * lent(users, owners, members, lending, evenness)
                moved = changed(users, owners, members, lending)
                if moved is not None:
                    use = (1 - CHANGE) * use + CHANGE * moved
                joint[owners] = prior(owners, members, *sizes) * use
            everything = sum(joint.values())
            beliefs.append({owners: value / everything for owners, value in joint.items()})
            named = answers.get(place)
            weight *= everything if named is None else TRUST * joint[named] + (1 - TRUST) * everything
        total += weight
        for of_thing, belief in zip(sums, beliefs):
            for owners, value in belief.items():
                of_thing[owners] += weight * value
    return [{owners: value / total for owners, value in of_thing.items()} for of_thing in sums]


CASES = [
    (3, ["aabacaa", "abab", "ccacc"], {}),
    (3, ["aabacaa", "abab", "ccacc"], {2: [2]}),
    (3, ["aaaaaabbbbb", "", "b"], {0: [1]}),
    (2, ["abababab", "aaaab", "bbbbbbbb"], {1: [0, 1]}),
    (4, ["abcdabcd", "aaadaaa", "bbcbcb", "dddd"], {1: [0]}),
    (1, ["aaa"], {}),
]

rows = []
for members, things, answers in CASES:
    users = [[ord(letter) - ord("a") for letter in sessions] for sessions in things]
    named = {place: frozenset(owners) for place, owners in answers.items()}
    posteriors = [
        [{"owners": sorted(owners), "probability": round(value, 12)} for owners, value in of_thing.items()]
        for of_thing in judged(users, members, named)
    ]
    answered = [{"thing": place, "owners": owners} for place, owners in answers.items()]
    rows.append({"members": members, "things": users, "answers": answered, "posteriors": posteriors})
print("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]")
