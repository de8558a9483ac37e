"""Judgements of whole homes by plain enumeration: every thing, every owner set, every point of the grid of habits; then
every pair of things, every exponent of what looks and places hint at.

    python3 coin/tests/known_answers/home.py > coin/tests/known_answers/home.json

Written from the definitions and in another way than the crate: probabilities instead of logarithms, no tables, no sums
that are shared between points of the grid. Needs nothing but Python.
"""

import json
from functools import cache
from itertools import combinations, product
from math import exp, lgamma, log

SIZES = [(0.75, 0.15), (0.60, 0.25), (0.45, 0.30), (0.75, 0.05), (0.60, 0.08), (0.45, 0.11)]
GROUPS, OF_GROUP_SIZE = SIZES[3:], 0.25
LENDING = [(1.2, 10.8), (2.0, 8.0), (3.3, 6.7), (5.0, 7.5)]
EVENNESS = [(8.0, None), (25.0, None), (8.0, 1.0), (3.0, 1.0)]
LOOSEST = {None: (8.0, None), 1.0: (3.0, 1.0)}
OPINIONS = [0.10, 0.50]
MISTAKEN = [0.01, 0.06]
SINGLE_KEPT = [0.2, 0.5]
SHARED_KEPT = [0.1, 0.35, 0.65]
TURNS, CHANGE, EVERYBODYS_BEFORE, MOST_CUTS, TRUST, PLACE = [1.5, 0.3], 0.04, 0.2, 16, 0.95, 0.05
NEGLIGIBLE = 1e-4


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


def thought(owners, members, sizes, opinion, weight):
    """By the number of owners; where something is expected of the class, also by that and by who is suited."""
    if opinion is None:
        return prior(owners, members, *sizes)
    single, everyone, suitability = opinion

    def suited(some):
        product = 1.0
        for person in some:
            product *= suitability[person]
        return product

    alike = [other for other in owner_sets(members) if len(other) == len(owners)]
    of_class = prior(owners, members, single, everyone) * len(alike) * suited(owners) / sum(map(suited, alike))
    return (1 - weight) * prior(owners, members, *sizes) + weight * of_class


def beside(answered, owners, own):
    """With some probability a thing has the owners of an answered one beside it, else those of the prior."""
    alone = 1.0
    for _, weight in answered:
        alone *= 1 - PLACE * weight
    total = sum(weight for _, weight in answered)
    shared = sum(weight for other, weight in answered if other == owners)
    return alone * own + ((1 - alone) * shared / total if answered else 0.0)


@cache
def kept(users, owners, members, mistaken):
    """In turns among the owners, strictly or loosely; a mistaken sighting names anybody."""
    total = 0.0
    for turns in TURNS:
        probability, used = 1.0, dict.fromkeys(owners, 0)
        for user in users:
            turn = 0.0
            if user in owners:
                turn = exp(-turns * used[user]) / sum(exp(-turns * count) for count in used.values())
                used[user] += 1
            probability *= (1 - mistaken) * turn + mistaken / members
        total += probability / len(TURNS)
    return total


def log_beta(a, b):
    return lgamma(a) + lgamma(b) - lgamma(a + b)


def split(counts, concentration):
    """The logarithm of a Dirichlet-multinomial of who comes when."""
    logarithm = lgamma(len(counts) * concentration) - lgamma(len(counts) * concentration + sum(counts))
    return logarithm + sum(lgamma(concentration + count) - lgamma(concentration) for count in counts)


@cache
def lent(users, owners, members, lending, evenness):
    """A borrow rate integrated out, a split among the owners and, unless anybody is as likely, among the borrowers."""
    among_owners, among_borrowers = evenness
    own = sum(user in owners for user in users)
    borrowed, logarithm = len(users) - own, 0.0
    if len(owners) < members:
        a, b = lending
        logarithm += log_beta(a + borrowed, b + own) - log_beta(a, b)
        if among_borrowers is None:
            logarithm -= borrowed * log(members - len(owners))
        else:
            others = set(range(members)) - owners
            logarithm += split([users.count(user) for user in others], among_borrowers)
    if len(owners) > 1:
        logarithm += split([users.count(user) for user in owners], among_owners)
    return exp(logarithm)


@cache
def changed(users, owners, members, lending, evenness):
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
        earlier = sum(weight * lent(users[:cut], other, members, lending, evenness) for other, weight in before.items())
        total += earlier / sum(before.values()) * lent(users[cut:], owners, members, lending, evenness)
    return total / len(cuts)


EXPONENTS = [0, 1 / 8, 1 / 4, 1 / 2, 1]
SURE_ENOUGH, ROUNDS, SHRINKAGE, LEAST_SHARE = 0.6, 2, 4, 0.1


def ties(one, other):
    """How alike a mean of tastes, and how alike a common taste makes things of these owners."""
    both = len(one & other)
    return both / (len(one) * len(other)), both / len(one | other)


def line(pairs):
    """A line over both ties through (owners, owners, number), and the variance within a kinship; None if by chance."""
    def size(one, other):
        return min(len(one), len(other)), max(len(one), len(other)), len(one & other)

    def around(expected):
        return sum((number - expected(one, other)) ** 2 for one, other, number in pairs)

    kinds = {}
    for one, other, number in pairs:
        kinds.setdefault(size(one, other), []).append(number)
    if len(pairs) <= len(kinds):
        return None
    means = {kind: sum(numbers) / len(numbers) for kind, numbers in kinds.items()}
    variance = around(lambda one, other: means[size(one, other)]) / (len(pairs) - len(kinds))
    mean = sum(number for *_, number in pairs) / len(pairs)
    centre = [sum(ties(one, other)[tie] for one, other, _ in pairs) / len(pairs) for tie in (0, 1)]
    rows = [([tie - middle for tie, middle in zip(ties(one, other), centre)], number - mean) for one, other, number in pairs]
    xx, xy, yy = (sum(ties[i] * ties[j] for ties, _ in rows) for i, j in ((0, 0), (0, 1), (1, 1)))
    xc, yc = (sum(ties[i] * number for ties, number in rows) for i in (0, 1))
    slopes = [(0, 0)]
    if xx > 0:
        slopes += [(xc / xx, 0)]
    if xx * yy - xy * xy > 1e-9 * xx * yy:
        slopes += [(0, yc / yy), ((yy * xc - xy * yc) / (xx * yy - xy * xy), (xx * yc - xy * xc) / (xx * yy - xy * xy))]

    def along(slope):
        return lambda one, other: mean + sum(s * (t - m) for s, t, m in zip(slope, ties(one, other), centre))

    best = min((slope for slope in slopes if min(slope) >= 0), key=lambda slope: around(along(slope)))
    explained = around(lambda *_: mean) - around(along(best))
    if variance <= 0 or explained <= SHRINKAGE * variance:
        return None
    return along([(1 - SHRINKAGE * variance / explained) * slope for slope in best]), variance, mean


def hinted(fits, priors, beliefs, answers):
    """By how much hints count, as they foretell all things; for every set of every thing what they make of it."""
    sums = []
    for exponent in EXPONENTS:
        logarithm = 0.0
        for place, (fit, prior, belief) in enumerate(zip(fits, priors, beliefs)):
            power = {owners: exp(exponent * (value - max(fit.values()))) for owners, value in fit.items()}
            seen = sum(belief[owners] * power[owners] for owners in belief)
            if place in answers:
                seen = TRUST * power[answers[place]] + (1 - TRUST) * seen
            logarithm += log(seen) - log(sum(prior[owners] * power[owners] for owners in prior))
        sums.append(logarithm)
    weights = [exp(logarithm - max(sums)) for logarithm in sums]
    result = []
    for fit, belief in zip(fits, beliefs):
        of_thing = dict.fromkeys(belief, 0.0)
        for exponent, weight in zip(EXPONENTS, weights):
            power = {owners: exp(exponent * (value - max(fit.values()))) for owners, value in fit.items()}
            seen = sum(belief[owners] * power[owners] for owners in belief)
            for owners in belief:
                of_thing[owners] += weight / sum(weights) * power[owners] / seen
        result.append(of_thing)
    return result


def in_company(beliefs, priors, answers, alike, near):
    """The beliefs with what looks and places make of them."""
    told = beliefs
    for _ in range(ROUNDS):
        known = {}
        for place, belief in enumerate(told):
            best = max(belief, key=belief.get)
            if place in answers:
                known[place] = answers[place]
            elif belief[best] >= SURE_ENOUGH:
                known[place] = best
        pairs = [(one, other) for one, other in combinations(sorted(known), 2)]
        factors = []
        looks = line([(known[one], known[other], alike[one, other]) for one, other in pairs if (one, other) in alike])
        if looks:
            expected, variance, _ = looks
            factors.append(
                [
                    {
                        owners: -sum(
                            (cosine - expected(owners, known[other])) ** 2 / (2 * variance)
                            for pair, cosine in alike.items()
                            for other in set(pair) - {place}
                            if place in pair and other in known
                        )
                        for owners in belief
                    }
                    for place, belief in enumerate(beliefs)
                ]
            )
        places = line([(known[one], known[other], near.get((one, other), 0.0)) for one, other in pairs])
        if places and any(pair in near for pair in pairs):
            expected, _, mean = places
            rate = lambda one, other: max(expected(one, other), LEAST_SHARE * mean)
            factors.append(
                [
                    {
                        owners: sum(
                            weight
                            * log(rate(owners, known[other]) / sum(rate(owners, known[one]) for one in known))
                            for pair, weight in near.items()
                            for other in set(pair) - {place}
                            if place in pair and other in known
                        )
                        for owners in belief
                    }
                    for place, belief in enumerate(beliefs)
                ]
            )
        told = [dict(belief) for belief in beliefs]
        for fits in factors:
            for belief, hints in zip(told, hinted(fits, priors, beliefs, answers)):
                for owners in belief:
                    belief[owners] *= hints[owners]
        told = [{owners: value / sum(belief.values()) for owners, value in belief.items()} for belief in told]
    return told


def judged(things, members, answers, opinions, alike, near):
    """For every thing the probability of every owner set."""
    sets = owner_sets(members)
    sums = [dict.fromkeys(sets, 0.0) for _ in things]
    before = [dict.fromkeys(sets, 0.0) for _ in things]
    answered = [
        [(answers[other], weight) for pair, weight in near.items() if place in pair for other in set(pair) - {place} if other in answers]
        for place in range(len(things))
    ]
    points = []
    for sizes, opinion_weight, lending, evenness, mistaken, single, shared in product(
        SIZES, OPINIONS, LENDING, EVENNESS, MISTAKEN, SINGLE_KEPT, SHARED_KEPT
    ):
        weight, beliefs, thoughts = OF_GROUP_SIZE * max(members - 2, 0) if sizes in GROUPS else 1.0, [], [{} for _ in things]
        for place, users in enumerate(things):
            joint = {}
            for owners in sets:
                share = single if len(owners) == 1 else shared
                use = share * kept(users, owners, members, mistaken)
                use += (1 - share) * lent(users, owners, members, lending, evenness)
                moved = changed(users, owners, members, lending, LOOSEST[evenness[1]])
                if moved is not None:
                    use = (1 - CHANGE) * use + CHANGE * moved
                own = thought(owners, members, sizes, opinions.get(place), opinion_weight)
                thoughts[place][owners] = beside(answered[place], owners, own)
                joint[owners] = thoughts[place][owners] * use
            everything = sum(joint.values())
            beliefs.append({owners: value / everything for owners, value in joint.items()})
            named = answers.get(place)
            weight *= everything if named is None else TRUST * joint[named] + (1 - TRUST) * everything
        points.append((weight, beliefs, thoughts))
    everything = sum(weight for weight, *_ in points)
    points = [point for point in points if point[0] / everything > NEGLIGIBLE]
    total = sum(weight for weight, *_ in points)
    for weight, beliefs, thoughts in points:
        for of_thing, before_use in zip(before, thoughts):
            for owners, value in before_use.items():
                of_thing[owners] += weight * value
        for of_thing, belief in zip(sums, beliefs):
            for owners, value in belief.items():
                of_thing[owners] += weight * value
    beliefs = [{owners: value / total for owners, value in of_thing.items()} for of_thing in sums]
    before = [{owners: value / total for owners, value in of_thing.items()} for of_thing in before]
    return in_company(beliefs, before, answers, alike, near)


WEEK = ["aaaaaa", "aaaaa", "aaaba", "bbbbbb", "bbbbb", "bbabb", "cccccc", "ccccc", "abcabc", "bcabca", "ab", "", "c"]
OWNERS = [{0}, {0}, {0}, {1}, {1}, {1}, {2}, {2}, {0, 1, 2}, {0, 1, 2}, {0}, {1}, {2}]


def looking(common):
    """Cosines of every pair: of a mean of tastes or of common tastes, and what is neither."""
    pairs = combinations(range(len(WEEK)), 2)
    return {(i, j): 0.25 * ties(OWNERS[i], OWNERS[j])[common] + 0.03 * ((7 * i + 11 * j + i * j) % 5) for i, j in pairs}


def lying(pairs):
    return {pair: 0.3 + 0.1 * (sum(pair) % 5) for pair in pairs}


TIDY = lying([(0, 1), (0, 2), (1, 2), (3, 4), (4, 5), (3, 5), (6, 7), (8, 9), (10, 0), (10, 1), (3, 11), (4, 11), (6, 12), (2, 8)])
TIDY = {tuple(sorted(pair)): weight for pair, weight in TIDY.items()}
MESSY = lying([(0, 3), (1, 6), (2, 9), (4, 7), (5, 8), (10, 11), (11, 12)])

SHARED, HERS = (0.22, 0.66, [1.0, 1.0, 1.0]), (0.88, 0.04, [1.0, 3.0, 1.0])

CASES = [
    (3, ["aabacaa", "abab", "ccacc"], {}, {}, {}, {}),
    (3, ["aabacaa", "abab", "ccacc"], {2: [2]}, {}, {}, {}),
    (3, ["aaaaaabbbbb", "", "b"], {0: [1]}, {}, {}, {}),
    (2, ["abababab", "aaaab", "bbbbbbbb"], {1: [0, 1]}, {}, {}, {}),
    (4, ["abcdabcd", "aaadaaa", "bbcbcb", "dddd"], {1: [0]}, {}, {}, {}),
    (1, ["aaa"], {}, {}, {}, {}),
    (3, ["aabacaa", "abab", "cb", "bb"], {}, {0: HERS, 1: SHARED, 2: HERS}, {}, {}),
    (3, ["aabacaa", "abab", "cb", "bb"], {3: [1]}, {2: HERS, 3: HERS}, {}, {}),
    (3, WEEK, {}, {}, looking(0), {}),
    (3, WEEK, {11: [1]}, {}, looking(1), {}),
    (3, WEEK, {}, {}, {}, TIDY),
    (3, WEEK, {12: [0]}, {}, {}, MESSY),
    (3, WEEK, {5: [1], 10: [0, 1]}, {8: SHARED, 9: SHARED}, looking(0), TIDY),
]

rows = []
for members, things, answers, opinions, alike, near in CASES:
    users = [tuple(ord(letter) - ord("a") for letter in sessions) for sessions in things]
    named = {place: frozenset(owners) for place, owners in answers.items()}
    posteriors = [
        [{"owners": sorted(owners), "probability": round(value, 12)} for owners, value in of_thing.items()]
        for of_thing in judged(users, members, named, opinions, alike, near)
    ]
    rows.append(
        {
            "members": members,
            "things": users,
            "answers": [{"thing": place, "owners": owners} for place, owners in answers.items()],
            "opinions": [
                {"thing": place, "single": single, "everyone": everyone, "suitability": suitability}
                for place, (single, everyone, suitability) in opinions.items()
            ],
            "alike": [[*pair, round(cosine, 12)] for pair, cosine in alike.items()],
            "near": [[*pair, round(weight, 12)] for pair, weight in near.items()],
            "posteriors": posteriors,
        }
    )
print("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]")
