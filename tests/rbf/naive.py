"""A second road to the same picks: slow, and straight from the formulas."""

import numpy as np


def naive_picks(design, targets, count):
    """Forward orthogonal least squares, every column deflated: design (q, n), targets (q, k)."""
    columns, picks = design.copy(), []
    for _ in range(count):
        best, pick = -1.0, -1
        for j in range(columns.shape[1]):
            p = columns[:, j]
            if j in picks:
                continue
            score = sum((p @ d) ** 4 / ((p @ p) * (d @ d)) ** 2 for d in targets.T)
            if score > best:
                best, pick = score, j
        picks.append(pick)
        p = columns[:, pick].copy()
        columns -= np.outer(p, p @ columns) / (p @ p)
    return picks
