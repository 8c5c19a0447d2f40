"""The learner's bars on 20 seeds, synthetic and recorded: writes its table into docs/learner.md.

Run it by ``PYTHONPATH=. python tests/bench/bench_learner.py``; it takes some five
minutes, most of them for what it is compared with.
"""

import argparse
import re
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, WhiteKernel
from sklearn.kernel_ridge import KernelRidge
from sklearn.model_selection import GridSearchCV
from threadpoolctl import threadpool_limits

from studio.engine.demonstration import DemonstrationSet, demonstrations_of
from studio.engine.follow import follow
from studio.engine.pipeline import Pipeline
from studio.engine.robot import load_robot
from studio.engine.sources.demonstrator import demonstrate
from studio.rbf import (
    LeaveOneDemonstrationOut,
    NewrbRegressor,
    RBFRegressor,
    leave_one_demonstration_out,
    pooled_variance_floor,
    smoothness,
)
from studio.rbf.basis import gaussian_design, spread_to_width
from studio.rbf.selection import independent_picks
from tests.rbf.conftest import make_demonstrations, pooled
from tests.rbf.naive import naive_newrb, naive_picks

PAGE = Path(__file__).resolve().parents[2] / "docs" / "learner.md"
INDEX = np.arange(1.0, 143.0)
TAKES = (1, 2, 3, 4)
DRAWS = 1000


@dataclass(frozen=True)
class Bar:
    """One bar: what is measured, what is wanted, and what was found on each kind of data."""

    what: str
    wanted: str
    found: tuple[str, ...]  # synthetic, recorded
    met: tuple[bool, ...]


def main() -> None:
    """Measure, print, and put the table into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    seeds = range(parser.parse_args().seeds)
    kinds = ([make_demonstrations(seed) for seed in seeds], [recorded(seed) for seed in seeds])
    with threadpool_limits(1):
        bars = [*both(accuracy, kinds), *both(greedy, kinds), *both(newrb, kinds)]
        bars += [*both(between, kinds), *both(robust, kinds), *both(speed, kinds)]
    table = "| | wanted | synthetic | recorded |\n|---|---|---|---|\n"
    for bar in bars:
        cells = [
            f"{found}{'' if met else ' **missed**'}"
            for found, met in zip(bar.found, bar.met, strict=True)
        ]
        table += f"| {bar.what} | {bar.wanted} | {' | '.join(cells)} |\n"
    print(table)
    text = PAGE.read_text()
    marked = re.compile(r"(<!-- bars: begin -->\n).*?(<!-- bars: end -->)", re.DOTALL)
    PAGE.write_text(marked.sub(lambda found: found[1] + table + found[2], text))


def recorded(seed: int) -> np.ndarray:
    """Return four takes of the demonstrator, followed through the whole pipeline: (4, 142, 4)."""
    pipeline = Pipeline.for_robot(load_robot(), "left")
    takes = [follow(demonstrate(seed, take), pipeline) for take in TAKES]
    found = [each for take in takes for each in demonstrations_of(take, "take")]
    return DemonstrationSet.of(found).rows


def both(
    measured: Callable[[list[np.ndarray]], Iterable[tuple[str, str, str, bool]]],
    kinds: tuple[list[np.ndarray], ...],
) -> list[Bar]:
    """Measure on both kinds of demonstrations, and join the rows."""
    columns = [list(measured(kind)) for kind in kinds]
    print(f"{measured.__name__} done", flush=True)
    return [
        Bar(*rows[0][:2], tuple(row[2] for row in rows), tuple(row[3] for row in rows))
        for rows in zip(*columns, strict=True)
    ]


def worst(values: list[float], form: str = ".4f") -> str:
    """Return the median and the largest value."""
    return f"{np.median(values):{form}} ({max(values):{form}})"


def ratio_to_floor(model: RBFRegressor | NewrbRegressor, taught: np.ndarray) -> float:
    """Return joint-mean MSE over joint-mean floor."""
    errors = np.square(taught - model.predict(INDEX)).mean(axis=(0, 1))
    return float(errors.mean() / pooled_variance_floor(taught).value.mean())


def accuracy(kind: list[np.ndarray]) -> Iterable[tuple[str, str, str, bool]]:
    """Bar 1: the default learner."""
    for neurons, bar in ((20, 1.01), (50, 1.005)):
        ratios = [ratio_to_floor(RBFRegressor(neurons).fit(*pooled(t)), t) for t in kind]
        met = max(ratios) <= bar
        yield f"MSE / floor, {neurons} neurons", f"≤ {bar:g}", worst(ratios), met
    for neurons in (20, 50):
        ratios = [leave_one_demonstration_out(RBFRegressor(neurons), t).ratio for t in kind]
        met = max(ratios) <= 1.0
        yield f"held out / mean curve, {neurons} neurons", "≤ 1.00", worst(ratios), met


def greedy(kind: list[np.ndarray]) -> Iterable[tuple[str, str, str, bool]]:
    """Bar 2: orthogonal least squares on distinct inputs."""
    excess = []
    for taught in kind:
        model = RBFRegressor(142, "ols", spread_to_width(1.0), "svd").fit(*pooled(taught))
        excess.append(ratio_to_floor(model, taught) - 1.0)
    met = max(excess) <= 1e-6
    yield "greedy centers, 142 neurons: MSE / floor - 1", "≤ 1e-6", worst(excess, ".1e"), met
    equal, stamps = 0, INDEX[:, np.newaxis]
    for taught in kind:
        design, mean = gaussian_design(stamps, stamps, spread_to_width(1.0)), taught.mean(axis=0)
        picks = independent_picks(design, mean, np.square(mean).sum(axis=0))
        equal += list(islice(picks, 60)) == naive_picks(design, mean, 60)
    found = f"{equal} of {len(kind)} seeds"
    yield "its first 60 picks are a naive port's", "all", found, equal == len(kind)


def newrb(kind: list[np.ndarray]) -> Iterable[tuple[str, str, str, bool]]:
    """Bar 3: newrb as MATLAB has it, spread 1."""
    ratios = []
    for taught in kind:
        model = NewrbRegressor(max_neurons=300, duplicates="matlab").fit(*pooled(taught))
        ratios.append([model.history_[n - 1].floor_ratio for n in (50, 142, 150, 200, 250, 300)])
    at_50, at_142, _, at_200, at_250, _ = np.array(ratios).T
    yield (
        "newrb, 50 neurons: MSE / floor",
        "far above 1",
        worst(list(at_50)),
        bool(min(at_50) > 1.5),
    )
    falls = int(np.sum((at_142 > at_200) & (at_200 > at_250)))
    found = f"{falls} of {len(kind)} seeds"
    yield "newrb still falls past 142 neurons", "all", found, falls == len(kind)
    median = float(np.median(at_250))
    yield "newrb, 250 neurons: MSE / floor", "median ≤ 1.03", worst(list(at_250)), median <= 1.03


def between(kind: list[np.ndarray]) -> Iterable[tuple[str, str, str, bool]]:
    """Bar 4: between the samples."""
    for neurons in (20, 50):
        found = [smoothness(RBFRegressor(neurons).fit(*pooled(t)).predict, t) for t in kind]
        ratios = [each.ratio for each in found]
        met = max(ratios) <= 1.1
        yield f"acceleration / spline's, {neurons} neurons", "≤ 1.1", worst(ratios, ".2f"), met
        off = [float(each.deviation.max()) for each in found]
        met = max(off) <= 0.01
        yield f"distance from the spline, {neurons} neurons", "≤ .01 rad", worst(off), met


def robust(kind: list[np.ndarray]) -> Iterable[tuple[str, str, str, bool]]:
    """Bar 6: random draws of centers with duplicates."""
    index, rows = pooled(kind[0])
    spread = np.square(rows - rows.mean(axis=0)).mean(axis=0)
    generator, failed = np.random.default_rng(0), 0
    for _ in range(DRAWS):
        centers = generator.choice(index, size=generator.integers(1, 201))
        model = RBFRegressor(centers=centers, width="dmax", solver="svd").fit(index, rows)
        errors = np.square(model.predict(index) - rows).mean(axis=0)
        failed += not (errors <= spread * (1.0 + 1e-9)).all()
    yield f"failures or garbage in {DRAWS} random draws", "0", str(failed), failed == 0


def speed(kind: list[np.ndarray]) -> Iterable[tuple[str, str, str, bool]]:
    """Bar 5: ratios to baselines that are run right before and after, on Q = 568 samples."""
    taught = kind[0]
    index, rows = pooled(taught)
    for neurons, bar in ((50, 30.0), (150, 50.0)):
        own = seconds(lambda n=neurons: NewrbRegressor(max_neurons=n).fit(index, rows), 15)
        port = seconds(lambda n=neurons: naive_newrb(index, rows, 1.0, n), 2)
        found = f"{port / own:.0f} ({1000 * own:.1f} ms against {1000 * port:.0f})"
        yield (
            f"newrb, {neurons} neurons, times faster than a naive port",
            f"≥ {bar:g}",
            found,
            (port / own >= bar),
        )
    own = seconds(lambda: RBFRegressor().fit(index, rows), 15)
    stamps = index[:, np.newaxis] / 142.0
    grid = {"alpha": np.geomspace(1e-3, 1.0, 5), "gamma": np.geomspace(1.0, 1000.0, 7)}
    search = GridSearchCV(KernelRidge(kernel="rbf"), grid, cv=LeaveOneDemonstrationOut([142] * 4))
    ridge = seconds(lambda: search.fit(stamps, rows), 1)
    kernel = 1.0 * RBF(0.1) + WhiteKernel(0.1)
    process = GaussianProcessRegressor(kernel, normalize_y=True)
    gaussian = seconds(lambda: process.fit(stamps, rows), 1)
    for name, other, bar in (
        ("KernelRidge with CV", ridge, 20),
        ("a GP on all points", gaussian, 100),
    ):
        found = f"{other / own:.0f} ({1000 * own:.1f} ms against {1000 * other:.0f})"
        yield f"default fit, times faster than {name}", f"≥ {bar}", found, other / own >= bar


def seconds(call: Callable[[], object], times: int) -> float:
    """Return the processor's time for the quickest of some calls: other programs matter less."""
    taken = []
    for _ in range(times):
        start = time.process_time()
        call()
        taken.append(time.process_time() - start)
    return min(taken)


if __name__ == "__main__":
    main()
