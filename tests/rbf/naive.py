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


def naive_newrb(inputs, targets, spread, neurons):
    """newrb straight from its formulas, samples (q,) and (q, k): deflate all, solve all anew."""
    design = np.exp(-np.log(2.0) * np.square((inputs[:, None] - inputs) / spread))
    columns, left, picks = design.copy(), np.ones(len(inputs), dtype=bool), []
    for _ in range(neurons):
        lengths = np.square(columns).sum(axis=0)
        possible = np.outer(lengths, np.square(targets).sum(axis=0))
        products = np.square(columns.T @ targets)
        share = np.divide(products, possible, out=np.zeros_like(possible), where=possible > 0.0)
        scores = np.square(share).sum(axis=1)
        picks.append(int(np.argmax(np.where(left, scores, -1.0))))
        left[picks[-1]] = False
        p = columns[:, picks[-1]].copy()
        columns -= np.outer(p, p @ columns) / (p @ p)
        chosen = np.column_stack([design[:, picks], np.ones(len(inputs))])
        weights = np.linalg.lstsq(chosen, targets, rcond=None)[0]
    return inputs[picks], weights
