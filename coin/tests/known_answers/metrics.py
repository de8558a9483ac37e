"""The paper's metrics over matrices of 0 and 1, one row a thing and one column a person.

    python3 coin/tests/known_answers/metrics.py > coin/tests/known_answers/metrics.json

Needs numpy.
"""

import json

import numpy as np

MEMBERS = 3


def metrics(estimate, truth):
    true_positives = np.sum(estimate & truth)
    false_positives = np.sum(estimate & ~truth)
    false_negatives = np.sum(~estimate & truth)
    union = np.sum(estimate | truth, axis=1)
    jaccard = np.where(union == 0, 1.0, np.sum(estimate & truth, axis=1) / np.maximum(union, 1))
    precision = true_positives / (true_positives + false_positives) if true_positives + false_positives else 0.0
    recall = true_positives / (true_positives + false_negatives) if true_positives + false_negatives else 0.0
    f1 = 2 * precision * recall / (precision + recall) if precision + recall else 0.0
    return {
        "subset_accuracy": float(np.mean(np.all(estimate == truth, axis=1))),
        "mean_jaccard": float(np.mean(jaccard)),
        "micro_precision": float(precision),
        "micro_recall": float(recall),
        "micro_f1": float(f1),
    }


def sets(matrix):
    return [[int(place) for place in np.flatnonzero(row)] for row in matrix]


if __name__ == "__main__":
    generator = np.random.default_rng(20250119)
    rows = []
    for things, owned, kept in [(1, 0.5, 0.5), (2, 0.2, 0.9), (5, 0.5, 0.7), (34, 0.54, 0.8), (34, 0.3, 0.95), (34, 0.54, 0.1), (100, 0.9, 0.6)]:
        truth = generator.random((things, MEMBERS)) < owned
        estimate = np.where(generator.random((things, MEMBERS)) < kept, truth, ~truth)
        rows.append({"estimate": sets(estimate), "truth": sets(truth), "expected": metrics(estimate, truth)})
    print("[")
    print(",\n".join(json.dumps(row) for row in rows))
    print("]")
