"""What an evaluation found, as one JSON object and as text for people. Neither holds any time."""

from collections.abc import Sequence
from typing import Any

from studio.engine.evaluate.evaluation import Evaluation, Part, Tested, paired, pooled
from studio.engine.evaluate.grid import Cell, Grid
from studio.engine.evaluate.interval import Rate
from studio.engine.evaluate.runs import Conditions
from studio.engine.evaluate.variation import widths_of

WORST = 2  # variations that are told in words: those that differ most


def evaluation_as_json(found: Evaluation) -> dict[str, Any]:
    """Return the object that ``--json`` prints."""
    return {
        **_conditions(found.conditions),
        "model": _tested(found.tested),
        "demonstrations": [
            {**_tested(each), "paired": _paired(found.tested, each)} for each in found.replays
        ],
        "demonstrations_rate": _pooled(found.replays),
        "by_variation": {
            name: [{"from": part.low, "to": part.high, **_rate(part.rate)} for part in parts]
            for name, parts in found.parts.items()
        },
    }


def grid_as_json(grid: Grid) -> dict[str, Any]:
    """Return the object that ``--json`` prints of many networks."""
    return {
        **_conditions(grid.conditions),
        "cells": [_cell(cell) for cell in grid.cells],
        "demonstrations": [_tested(each) for each in grid.replays],
        "demonstrations_rate": _pooled(grid.replays),
        "needed": {name: _needed(grid, name) for name in grid.learners},
    }


def evaluation_as_text(found: Evaluation) -> str:
    """Return the same for people."""
    lines = [_title(found.conditions), ""]
    lines.append(f"  {_named(found.tested)}  {found.tested.rate.words}")
    lines += [f"    {count} x {why}" for why, count in found.tested.failures]
    for each in found.replays:
        lines.append(f"  {_named(each)}  {each.rate.words}")
        lines += [f"    {count} x {why}" for why, count in each.failures]
        lines.append(f"    {paired_in_words(found.tested, each)}")
    if found.replays:
        lines += ["", f"The demonstrations' own rate: {pooled_in_words(found.replays)}."]
    lines += ["", *hurting_in_words(found)]
    return "\n".join(lines).rstrip()


def grid_as_text(grid: Grid) -> str:
    """Return the same for people."""
    lines = [_title(grid.conditions), "", "  learner  neurons  MSE/floor  success"]
    for cell in grid.cells:
        network = cell.network
        ratio = "–" if network.floor_ratio is None else f"{network.floor_ratio:.4g}"
        lines.append(
            f"  {network.learner:8s} {network.neurons:6d}  {ratio:>9s}  {cell.tested.rate.words}"
        )
    lines.append(f"  demonstrations' own replays  {pooled_in_words(grid.replays)}")
    lines += ["", *(f"{name}: {grid.answer(name)}." for name in grid.learners)]
    return "\n".join(lines)


def hurting_in_words(found: Evaluation) -> list[str]:
    """Return which variations make the largest difference, beyond chance, and which one.

    That is, where the intervals of the parts with the lowest and the highest rate do not overlap.
    """
    shown = [(name, parts) for name, parts in found.parts.items() if _stands_out(parts)]
    if found.parts and not shown:
        return [f"No variation stands out in {len(found.tested.outcomes)} trials."]
    ranked = sorted(shown, key=lambda each: -_range(each[1]))[:WORST]
    return [
        f"By {name}: "
        + ", ".join(
            f"{100 * part.rate.value:.3g} % from {part.low:.3g} to {part.high:.3g}"
            for part in parts
        )
        + "."
        for name, parts in ranked
    ]


def paired_in_words(first: Tested, second: Tested) -> str:
    """Return how two motions compare in the same trials."""
    pairs = paired(first, second)
    differing = pairs.only_first + pairs.only_second
    shared = pairs.both + differing + pairs.neither
    if not differing:
        return f"the same outcome in all of the same {shared} trials"
    return (
        f"of the same {shared} trials {first.motion.name} alone does the task in "
        f"{pairs.only_first}, this one alone in {pairs.only_second} "
        f"(p = {pairs.chance:.2g}, McNemar)"
    )


def pooled_in_words(replays: Sequence[Tested]) -> str:
    """Return the demonstrations' own rate with its interval."""
    rate, low, high = pooled(replays)
    return f"{100 * rate:.3g} % ({100 * low:.3g} to {100 * high:.3g} %)"


def conditions_in_words(conditions: Conditions) -> str:
    """Return under what the trials were done."""
    return f"scene {conditions.scene.name}, seed {conditions.seed}; {conditions.widths.words}"


def _title(conditions: Conditions) -> str:
    words = conditions_in_words(conditions)
    return f"Success with its 95 % confidence interval: {words}."


def _named(tested: Tested) -> str:
    return f"{tested.motion.name:18s}"


def _range(parts: Sequence[Part]) -> float:
    rates = [part.rate.value for part in parts]
    return max(rates) - min(rates)


def _stands_out(parts: Sequence[Part]) -> bool:
    rates = sorted((part.rate for part in parts), key=lambda rate: rate.value)
    return rates[0].high < rates[-1].low


def _conditions(conditions: Conditions) -> dict[str, Any]:
    return {
        "scene": conditions.scene.name,
        "seed": conditions.seed,
        "widths": widths_of(conditions.widths),
    }


def _tested(tested: Tested) -> dict[str, Any]:
    return {
        "name": tested.motion.name,
        **_rate(tested.rate),
        "failures": dict(tested.failures),
        "guarded_ticks": tested.motion.guarded,
    }


def _rate(rate: Rate) -> dict[str, Any]:
    return {
        "successes": rate.successes,
        "trials": rate.trials,
        "rate": rate.value,
        "low": rate.low,
        "high": rate.high,
    }


def _paired(first: Tested, second: Tested) -> dict[str, Any]:
    pairs = paired(first, second)
    return {
        "both": pairs.both,
        "only_model": pairs.only_first,
        "only_this": pairs.only_second,
        "neither": pairs.neither,
        "chance": pairs.chance,
    }


def _pooled(replays: Sequence[Tested]) -> dict[str, float] | None:
    return dict(zip(("rate", "low", "high"), pooled(replays), strict=True)) if replays else None


def _cell(cell: Cell) -> dict[str, Any]:
    network = cell.network
    return {
        "learner": network.learner,
        "neurons": network.neurons,
        "floor_ratio": network.floor_ratio,
        **_tested(cell.tested),
    }


def _needed(grid: Grid, learner: str) -> dict[str, Any]:
    found = grid.needed(learner)
    neurons = None if found is None else found.network.neurons
    return {"neurons": neurons, "words": grid.answer(learner)}
