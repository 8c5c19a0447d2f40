"""Fields on the 26 LASA handwriting motions: writes its figures into docs/lasa.md and lasa.svg.

The paper's plain field, the stable one and SEDS learn the same demonstrations and are rolled out
and judged by the same rules. Run it by ``pip install 'teaching-studio[bench]'`` and
``PYTHONPATH=. python tests/bench/bench_lasa.py --jobs 2``; nearly all of its time, some 30 minutes
on one core, goes into SEDS.
"""

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

import numpy as np
from joblib import Parallel, delayed
from threadpoolctl import threadpool_limits

from studio.rbf import PlainField, StableField
from tests.bench import seds
from tests.bench.lasa import (
    Demonstration,
    Field,
    FloatArray,
    errors,
    load,
    random_starts,
    receding,
    roll_out,
    shapes,
    starts_of,
)
from tests.bench.lasa_page import Outcome, Row, misses, page, picture, summary

DOCS = Path(__file__).resolve().parents[2] / "docs"
COMPONENTS = range(3, 9)  # of SEDS, of which each objective takes one
GOAL = (0.0, 0.0)  # by definition of the data
DRAWN = (0, 3, 6)  # demonstrations whose starts are drawn
Any_ = TypeVar("Any_")


def main() -> None:
    """Measure all motions and write the page, or some and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--jobs", type=int, default=1, help="motions at a time")
    parser.add_argument("--shapes", nargs="*", help="only these, and write nothing")
    options = parser.parse_args()
    names = options.shapes or shapes()
    parallel = Parallel(options.jobs, return_as="generator_unordered")
    rows = []
    for row in parallel(delayed(measure)(name) for name in names):
        rows.append(row)
        print(f"{len(rows)} of {len(names)}: {row.shape}", file=sys.stderr, flush=True)
    rows.sort(key=lambda row: row.shape)
    if options.shapes:
        print(summary(rows), misses(rows), sep="\n")
        return
    (DOCS / "lasa.md").write_text(page((DOCS / "lasa.md").read_text(), rows))
    (DOCS / "lasa.svg").write_text(picture(rows))


def measure(shape: str) -> Row:
    """Fit and judge everything on one motion."""
    taught = load(shape)
    with threadpool_limits(1):
        plain = [timed(lambda t=t: PlainField(n_neurons=50).fit(t)) for t in folds(taught)]
        stable = [timed(lambda t=t: StableField(goal=GOAL).fit(t)) for t in folds(taught)]
        certificates = [field.certificate_ for field, _ in stable]
        likelihood, mse, components, every = seds_fields(taught)
        found = [judge(fields, taught) for fields in (plain, stable, likelihood, mse)]
        tried = [errors(roll_out(field, starts_of(taught), taught), taught) for field in every]
    least = np.min([each.mean(axis=0) for each in tried], axis=0)
    return Row(
        shape,
        receding(taught),
        *found,
        hindsight=(float(least[0]), float(least[1])),
        components=components,
        eigenvalue=max(field.worst_eigenvalue for field in every),
        steepness=max(each.steepness for each in certificates),
        slowest_rate=min(each.slowest_rate for each in certificates),
        holding=sum(each.holds for each in certificates),
        fits=len(certificates),
    )


def folds(taught: Sequence[Demonstration]) -> list[list[Demonstration]]:
    """Return all demonstrations, then all but the first, and so on."""
    rest = [[*taught[:k], *taught[k + 1 :]] for k in range(len(taught))]
    return [list(taught), *rest]


def timed(call: Callable[[], Any_]) -> tuple[Any_, float]:
    """Return what a call returns, and the processor's time it took [s]."""
    start = time.process_time()
    return call(), time.process_time() - start


def seds_fields(
    taught: Sequence[Demonstration],
) -> tuple[
    list[tuple[seds.Seds, float]],
    list[tuple[seds.Seds, float]],
    tuple[int, int],
    list[seds.Seds],
]:
    """Return both objectives' fits to all folds, their counts of Gaussians, and all that was tried.

    Each objective chooses its count by its Bayesian information criterion on all demonstrations,
    and keeps it for the folds, with the start that was best: a little more than it could know.
    """
    tried = {count: timed(lambda c=count: seds.learn(taught, c)) for count in COMPONENTS}
    likely = min(COMPONENTS, key=lambda count: tried[count][0].likelihood.criterion)
    exact = min(COMPONENTS, key=lambda count: tried[count][0].mse.criterion)
    likelihood = [(tried[likely][0].likelihood, tried[likely][1])]
    mse = [(tried[exact][0].mse, tried[exact][1])]
    first, second = (likely, likelihood[0][0].seed), (exact, mse[0][0].seed)
    for rest in folds(taught)[1:]:
        again = {(c, s): seds.learn(rest, c, seeds=[s]) for c, s in {first, second}}
        likelihood.append((again[first].likelihood, 0.0))
        mse.append((again[second].mse, 0.0))
    every = [field for pair, _ in tried.values() for field in (pair.likelihood, pair.mse)]
    return likelihood, mse, (likely, exact), every


def judge(fields: Sequence[tuple[Field, float]], taught: Sequence[Demonstration]) -> Outcome:
    """Roll out the fit to all demonstrations, then each fold's from the start that it lacked."""
    whole, seconds = fields[0]
    starts = starts_of(taught)
    seen = roll_out(whole, starts, taught)
    random = roll_out(whole, random_starts(taught), taught)
    unseen = [
        roll_out(field, starts[k : k + 1], taught)[0] for k, (field, _) in enumerate(fields[1:])
    ]
    arrived = [sum(each.arrived for each in group) for group in (seen, random, unseen)]
    return Outcome(
        mean_errors(errors(seen, taught)),
        mean_errors(errors(unseen, taught)),
        (arrived[0], arrived[1], arrived[2]),
        seconds,
        tuple(seen[k].path for k in DRAWN),
    )


def mean_errors(found: FloatArray) -> tuple[float, float]:
    """Return the means of errors (n, 2)."""
    area, distance = found.mean(axis=0)
    return float(area), float(distance)


if __name__ == "__main__":
    main()
