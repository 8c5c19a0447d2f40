"""The demonstration over many seeds, both mappings: writes its table into docs/learning.md.

Run it by ``python tests/bench/bench_seeds.py``; it takes about three minutes.
"""

import argparse
import re
from pathlib import Path

import numpy as np

from studio.engine.experiment import Experiment, Setup, run_experiment
from studio.engine.retarget import MAPPINGS, Mapping
from studio.engine.sources.demonstrator import demonstrate

PAGE = Path(__file__).resolve().parents[2] / "docs" / "learning.md"
COLUMNS = (
    "mapping",
    "seeds with every block down",
    "demonstrations down",
    "reproductions down",
    "hand error, mean (worst seed)",
    "after time warping",
    "MSE / floor, all joints (worst)",
)
HEADER = f"| {' | '.join(COLUMNS)} |\n{'|---' * len(COLUMNS)}|\n"


def main() -> None:
    """Measure, print the table, and put it into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    seeds = parser.parse_args().seeds
    table = HEADER + "".join(f"{row(mapping, seeds)}\n" for mapping in MAPPINGS)
    print(table)
    text = PAGE.read_text()
    marked = re.compile(r"(<!-- seeds: begin -->\n).*?(<!-- seeds: end -->)", re.DOTALL)
    PAGE.write_text(marked.sub(lambda found: found[1] + table + found[2], text))


def row(mapping: Mapping, seeds: int) -> str:
    """Return the table's row of one mapping."""
    found = [run(mapping, seed) for seed in range(seeds)]
    replays = [[r.performance.block_down for r in each.replays] for each in found]
    alone = [each.reproduction.performance.block_down for each in found]
    whole = sum(a and all(r) and len(r) == 4 for a, r in zip(alone, replays, strict=True))
    hand = [1000 * each.reproduction.deviation.hand_mean for each in found]
    warped = [1000 * each.reproduction.deviation.hand_dtw for each in found]
    ratio = np.array([each.lesson.mse / each.lesson.floor for each in found])
    return (
        f"| {mapping} | {whole} of {seeds} | {sum(map(sum, replays))} of "
        f"{sum(map(len, replays))} | {sum(alone)} of {seeds} | {np.mean(hand):.1f} mm "
        f"({max(hand):.1f}) | {np.mean(warped):.1f} mm ({max(warped):.1f}) | "
        f"{ratio.mean():.4f} ({ratio.max():.4f}) |"
    )


def run(mapping: Mapping, seed: int) -> Experiment:
    """Return one seed's experiment with four takes."""
    takes = [demonstrate(seed, take) for take in range(1, 5)]
    return run_experiment(takes, Setup(mapping=mapping))


if __name__ == "__main__":
    main()
