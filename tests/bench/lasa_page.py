"""What `bench_lasa.py` measured, as a page and a picture."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import spearmanr

from studio.engine.svg import Chart, Line
from tests.bench.lasa import FloatArray, resampled

BARS = (0.75, 0.7)  # of swept area and warping distance, ours over SEDS'
NAMES = ("swept error area [mm²]", "warping distance [mm]")
AT_HOME = 0.1  # share of receding up to which a motion is one that SEDS can represent
STYLE = (
    "<style>.title{font-weight:bold}.grid{stroke:#eee}.axis{stroke:#888;fill:none}"
    ".middle{text-anchor:middle}.end{text-anchor:end}</style>"
)
LEARNERS = ("plain", "stable", "likelihood", "mse")
COLUMNS = 6
CELL = (190, 170)  # [px]
DRAWN_POINTS = 80  # of a path


@dataclass(frozen=True)
class Outcome:
    """How one learner did on one motion."""

    seen: tuple[float, float]  # mean swept error area [mm^2] and warping distance [mm]
    held_out: tuple[float, float]  # the same, of the demonstration that was left out
    arrived: tuple[int, int, int]  # of the starts of demonstrations, random ones, held-out ones
    seconds: float  # of processor time, to fit all demonstrations
    paths: tuple[FloatArray, ...]  # from some starts, to be drawn


@dataclass(frozen=True)
class Row:
    """All that was measured on one motion."""

    shape: str
    receding: float  # share of the time in which the hand moves away from the goal
    plain: Outcome
    stable: Outcome
    likelihood: Outcome  # SEDS
    mse: Outcome  # SEDS
    hindsight: tuple[float, float]  # least errors of any SEDS: each objective, each count
    components: tuple[int, int]  # that the two objectives took
    eigenvalue: float  # [1/s] the largest of SEDS' (A + A^T) / 2
    steepness: float  # of StableField's certificate, the worst of its fits
    slowest_rate: float  # [1/s] likewise
    holding: int  # how many of its certificates hold, of 8: on all, and without each
    fits: int


def page(text: str, rows: Sequence[Row]) -> str:
    """Return the page with everything between its marks written anew."""
    parts = {
        "summary": summary(rows),
        "misses": misses(rows),
        "home": at_home(rows),
        "area": table(rows, 0),
        "warping": table(rows, 1),
        "arrivals": arrivals(rows),
    }
    for name, part in parts.items():
        marked = re.compile(rf"(<!-- {name}: begin -->\n).*?(<!-- {name}: end -->)", re.DOTALL)
        text = marked.sub(lambda found, part=part: found[1] + part + found[2], text)
    return text


def means(rows: Sequence[Row], learner: str, which: str, k: int) -> FloatArray:
    """Return an error of a learner on each motion (n,)."""
    return np.array([getattr(getattr(row, learner), which)[k] for row in rows])


def ratio(rows: Sequence[Row], which: str, k: int) -> float:
    """Return our mean over the better mean of SEDS' two objectives."""
    ours, likelihood, mse = (
        means(rows, learner, which, k).mean() for learner in ("stable", "likelihood", "mse")
    )
    return float(ours / min(likelihood, mse))


def grid(head: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    """Return a table."""
    rule = "|" + "---|" * len(head)
    return "\n".join(["| " + " | ".join(head) + " |", rule, *map(_line, lines)]) + "\n"


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def number(value: float) -> str:
    """Return a number with three digits or more."""
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def summary(rows: Sequence[Row]) -> str:
    """Return the table of means, ratios and bars."""
    lines = []
    for which, words in (("seen", "in sample"), ("held_out", "held out")):
        for k, name in enumerate(NAMES):
            found = [means(rows, learner, which, k) for learner in LEARNERS]
            reached = ratio(rows, which, k)
            missed = "" if reached <= BARS[k] else " **missed**"
            end = [f"{reached:.2f}{missed}", f"≤ {BARS[k]:g}"]
            lines.append([f"{name}, {words}, mean", *(number(each.mean()) for each in found), *end])
            middle = [float(np.median(each)) for each in found]
            end = [f"{middle[1] / min(middle[2:]):.2f}", ""]
            lines.append([f"{name}, {words}, median", *map(number, middle), *end])
    groups = (("demonstrations' starts", 7), ("20 random starts a motion", 20), ("held out", 7))
    for place, (words, count) in enumerate(groups):
        total = count * len(rows)
        counts = [sum(getattr(row, name).arrived[place] for row in rows) for name in LEARNERS]
        missed = "" if counts[1] == total else " **missed**"
        cells = [f"{each} of {total}" for each in counts]
        lines.append([f"rollouts that arrive, {words}", *cells, f"{missed}", "all of ours"])
    holding, fits = sum(row.holding for row in rows), sum(row.fits for row in rows)
    missed = "" if holding == fits else " **missed**"
    held = ["none", f"{holding} of {fits}", "by construction", "by construction"]
    lines.append(["certificate holds, all fits", *held, missed, "all of ours"])
    fit = [f"{np.mean([getattr(row, name).seconds for row in rows]):.2f}" for name in LEARNERS]
    lines.append(["processor's time of a fit [s]", *fit, "", ""])
    head = ("", "plain field", "`StableField`", "SEDS, likelihood", "SEDS, MSE")
    return grid((*head, "ours / better SEDS", "wanted"), lines)


def misses(rows: Sequence[Row]) -> str:
    """Return every bar that is missed, by how much, and where SEDS is nearer."""
    over, nearer = [], []
    for which, words in (("seen", "in sample"), ("held_out", "held out")):
        for k, name in enumerate(NAMES):
            reached = ratio(rows, which, k)
            if reached > BARS[k]:
                over.append(f"{name}, {words}: {reached:.2f}, {reached - BARS[k]:.2f} over the bar")
            for other, learners in (
                ("SEDS", ("likelihood", "mse")),
                ("the plain field", ("plain",)),
            ):
                places = _nearer(rows, learners, which, k)
                nearer.append(f"- {name}, {words}: {other} is nearer on {places}.")
    late = [row.shape for row in rows if row.stable.arrived != (7, 20, 7)]
    ours = np.mean([row.stable.seen for row in rows], axis=0)
    unseen = np.mean([row.stable.held_out for row in rows], axis=0)
    best = np.mean([row.hindsight for row in rows], axis=0)
    first = [
        f"- Bars of the means that are missed: {'; '.join(over) or 'none'}.",
        f"- Motions where a rollout of `StableField` does not arrive: {', '.join(late) or 'none'}.",
        "- Had SEDS known, motion by motion and measure by measure, which objective and count of "
        f"Gaussians rolls out best, its means in sample would be {best[0]:.0f} mm² and "
        f"{best[1]:.0f} mm, the ratios {ours[0] / best[0]:.2f} and {ours[1] / best[1]:.2f}. Our "
        f"errors held out are {unseen[0] / best[0]:.2f} and {unseen[1] / best[1]:.2f} of them.",
    ]
    return "\n".join(first + nearer) + "\n"


def _nearer(rows: Sequence[Row], learners: Sequence[str], which: str, k: int) -> str:
    """Return the motions where the best of some learners is nearer than we are."""
    ours = means(rows, "stable", which, k)
    best = np.min([means(rows, name, which, k) for name in learners], axis=0)
    places = [
        f"{row.shape} ({number(our)} against {number(their)})"
        for row, our, their in zip(rows, ours, best, strict=True)
        if our > their
    ]
    if not places:
        return "no motion"
    return f"{len(places)} of {len(rows)}, ours first: {', '.join(places)}"


def at_home(rows: Sequence[Row]) -> str:
    """Return how SEDS does where its assumption holds, and where not."""
    ours = means(rows, "stable", "seen", 0)
    theirs = np.minimum(means(rows, "likelihood", "seen", 0), means(rows, "mse", "seen", 0))
    shares = np.array([row.receding for row in rows])
    home = shares <= AT_HOME
    words = "- It fails where it must."
    if len(rows) > 2:
        words += (
            " Rank correlation over the motions between the share of the time in which the hand "
            "moves away from the goal and SEDS' swept area over ours: "
            f"{spearmanr(shares, theirs / ours).statistic:.2f}."
        )
    if home.any() and not home.all():
        words += (
            f" On the {home.sum()} motions with a share of {AT_HOME:.0%} or less "
            f"{_areas(ours, theirs, home)}; on the others {_areas(ours, theirs, ~home)}."
        )
    return words + "\n"


def _areas(ours: FloatArray, theirs: FloatArray, chosen: NDArray[np.bool_]) -> str:
    mine, other = ours[chosen].mean(), theirs[chosen].mean()
    return f"SEDS' mean area is {other:.0f} mm² and ours {mine:.0f} (ratio {mine / other:.2f})"


def table(rows: Sequence[Row], k: int) -> str:
    """Return one error of all motions."""
    short = ("plain", "ours", "SEDS L", "SEDS M")
    head = [NAMES[k], "receding", *(f"{name}, in" for name in short), *(f"{n}, out" for n in short)]
    lines = []
    for row in rows:
        found = [getattr(row, name) for name in LEARNERS]
        seen, held_out = [each.seen[k] for each in found], [each.held_out[k] for each in found]
        lines.append([row.shape, f"{row.receding:.0%}", *map(number, seen + held_out)])
    return grid(head, lines)


def arrivals(rows: Sequence[Row]) -> str:
    """Return what arrived and what was certified, of all motions."""
    head = ["arrived of 7 + 20 + 7", "plain", "ours", "SEDS L", "SEDS M", "steepness (< 1)"]
    head += ["slowest rate [1/s] (> 0)", "SEDS' largest eigenvalue [1/s] (< 0)", "Gaussians L, M"]
    lines = []
    for row in rows:
        counts = [" + ".join(map(str, getattr(row, name).arrived)) for name in LEARNERS]
        bounds = [f"{row.steepness:.3f}", f"{row.slowest_rate:.3g}", f"{row.eigenvalue:.2g}"]
        lines.append([row.shape, *counts, *bounds, f"{row.components[0]}, {row.components[1]}"])
    return grid(head, lines)


def picture(rows: Sequence[Row]) -> str:
    """Return small drawings of all motions: what was learned, from the same starts."""
    width, height = CELL[0] * COLUMNS, CELL[1] * -(-len(rows) // COLUMNS)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}" font-family="sans-serif" font-size="9">',
        STYLE,
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
    ]
    for place, row in enumerate(rows):
        x, y = CELL[0] * (place % COLUMNS), CELL[1] * (place // COLUMNS)
        parts.append(f'<g transform="translate({x} {y})">{_drawn(row)}</g>')
    return "\n".join([*parts, "</svg>\n"])


def _drawn(row: Row) -> str:
    everything = np.concatenate(row.stable.paths)
    low, high = everything.min(axis=0), everything.max(axis=0)
    room = 0.15 * (high - low).max()
    styles = ((row.plain.paths, "#c2410c", "4 2"), (row.stable.paths, "#1d4ed8", ""))
    lines = [
        Line(*_inside(path, low - room, high + room).T, color, dashes, 1.3)
        for paths, color, dashes in styles
        for path in paths
    ]
    goal = Line(np.zeros(1), np.zeros(1), "#111", marked=True)
    return Chart(row.shape, "", "", (*lines, goal), size=CELL, equal=True).svg()


def _inside(path: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Return a path (n, 2) up to where it leaves a box, in fewer points."""
    outside = np.flatnonzero(((path < low) | (path > high)).any(axis=1))
    kept = path[: max(1, outside[0])] if len(outside) else path
    return resampled(kept, DRAWN_POINTS)
