"""What a sweep found, as one JSON object and as text for people; sweep_page.py makes its page."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from studio.engine.arms import in_words, short_names
from studio.engine.comparison import Contestant
from studio.engine.demonstration import SAMPLES, DemonstrationSet
from studio.engine.learners import BUDGET, LEARNER_KINDS
from studio.engine.paper import paper_table
from studio.engine.performance import in_guards_words
from studio.engine.skeleton import FloatArray
from studio.engine.sweep import Played, Quality, Sweep


def sweep_as_json(table: Sweep, contestants: Sequence[Contestant] = ()) -> dict[str, Any]:
    """Return the object that ``--json`` prints: MSE in rad², other angles in degrees."""
    taught = table.taught
    joints = taught.joints
    shown: dict[str, Any] = {
        "arm": taught.arms,
        "mapping": taught.mapping,
        "joints": list(joints),
        "samples": SAMPLES,
        "demonstrations": [
            {"name": each.name, "seconds": each.duration} for each in taught.demonstrations
        ],
        "floor": None if table.floor is None else _by_joint(joints, table.floor),
        "floor_note": table.floor_note,
        "rows": [
            {"learner": row.learner, "neurons": row.neurons, **_quality(joints, row.quality)}
            for row in table.rows
        ],
        "suggestions": {
            name: {"neurons": each.neurons, "reached": each.reached, "words": each.words}
            for name, each in table.suggestions.items()
        },
        "alone": {
            name: {"neurons": table.shown_row(name).neurons, **_played(played)}
            for name, played in table.played.items()
        },
        "paper": [asdict(row) for row in paper_table()],
    }
    if contestants:
        shown["comparison"] = [
            {
                "learner": each.kind.name,
                "settings": dict(each.settings),
                "tried": BUDGET,
                "failed": each.failed,
                **_quality(joints, each.quality),
                **_played(each.played),
            }
            for each in contestants
        ]
    return shown


def sweep_as_text(table: Sweep, contestants: Sequence[Contestant] = ()) -> str:
    """Return the same for people."""
    lines = [_title(table.taught), ""]
    joints = short_names(table.taught.joints)
    width = max(10, 4 + max(map(len, joints)))
    lines.append(
        f"  {'learner':8s} neurons  {' '.join(f'MSE {joint}'.ljust(width) for joint in joints)} "
        f"{_QUALITY_HEADER}"
    )
    for row in table.rows:
        mse = " ".join(f"{value:.4e}".ljust(width) for value in row.quality.mse)
        lines.append(f"  {row.learner:8s} {row.neurons:7d}  {mse} {_quality_line(row.quality)}")
    if table.floor is None:
        lines.append(f"  (no floor: {table.floor_note})")
    else:
        lines.append(
            f"  {'floor':8s} {'':7s}  {' '.join(f'{v:.4e}'.ljust(width) for v in table.floor)}"
        )
    lines.append("")
    for name, suggestion in table.suggestions.items():
        lines.append(f"{name}: {suggestion.words}")
    for name, played in table.played.items():
        count = table.shown_row(name).neurons
        lines.append(f"{name}, {count} neurons, alone: {_played_line(played)}")
    if contestants:
        lines += ["", *_comparison_lines(contestants)]
    return "\n".join(lines)


_QUALITY_HEADER = "  /floor  held-out  ε* [deg]  acceleration  ripple [deg]  fit [ms]"


def _title(taught: DemonstrationSet) -> str:
    return (
        f"{len(taught.demonstrations)} demonstrations of {taught.duration:.1f} s in the mean, "
        f"{SAMPLES} x {len(taught.joints)} each, {in_words(taught.arms)}, "
        f"{taught.mapping} mapping. MSE in rad²."
    )


def _quality_line(quality: Quality) -> str:
    return (
        f"{as_number(quality.floor_ratio, '8.4f')}  {as_number(quality.held_out_ratio, '8.4f')}  "
        f"{math.degrees(quality.largest.max()):9.2f}  {quality.acceleration_ratio:12.2f}  "
        f"{math.degrees(quality.ripple):12.2f}  {1000.0 * quality.fit_seconds:8.1f}"
    )


def _played_line(played: Played) -> str:
    event = played.task.event[not played.performance.done]
    off = f"{event}, the hand is {1000.0 * played.deviation.hand_mean:.1f} mm off in the mean."
    guarded = in_guards_words(played.performance)
    off = f"{off}\n  ({guarded})" if guarded else off
    return f"{off}\n  ({played.remark})" if played.remark else off


def _comparison_lines(contestants: Sequence[Contestant]) -> list[str]:
    what = contestants[0].played.task.what
    lines = [
        f"Learners at the best of {BUDGET} settings each, by leaving out one demonstration:",
        f"  {'learner':13s} {_QUALITY_HEADER}  predict [ms]  {what:9s}  settings",
    ]
    for each in contestants:
        verb = each.played.task.verb[not each.played.performance.done]
        lines.append(
            f"  {each.kind.name:13s} {_quality_line(each.quality)}  "
            f"{1000.0 * each.quality.predict_seconds:12.2f}  {verb:9s}  {settings_in_words(each)}"
        )
    return lines


def settings_in_words(contestant: Contestant) -> str:
    """Return the chosen settings: ``neurons 15``."""
    return ", ".join(
        f"{name} {value:.3g}" if isinstance(value, float) else f"{name} {_plain(value)}"
        for name, value in contestant.settings.items()
    )


def label_of(learner: str) -> str:
    """Return a learner's name in words."""
    return LEARNER_KINDS[learner].label


def as_number(value: float | None, form: str) -> str:
    """Return a number in some form, or a dash as wide where there is none."""
    width = int(form.partition(".")[0] or 0)
    return "–".rjust(width) if value is None else format(value, form)


def _plain(value: Any) -> str:
    if isinstance(value, tuple):
        return "-".join(map(str, value))
    return "by GCV" if value is None else str(value)


def _quality(joints: Sequence[str], quality: Quality) -> dict[str, Any]:
    finite = math.isfinite(quality.acceleration_ratio)
    return {
        "mse": _by_joint(joints, quality.mse),
        "floor_ratio": quality.floor_ratio,
        "held_out_mse": quality.held_out,
        "held_out_ratio": quality.held_out_ratio,
        "largest_error_deg": _by_joint(joints, np.degrees(quality.largest)),
        "acceleration_ratio": quality.acceleration_ratio if finite else None,
        "ripple_deg": math.degrees(quality.ripple),
        "fit_seconds": quality.fit_seconds,
        "predict_seconds": quality.predict_seconds,
    }


def _played(played: Played) -> dict[str, Any]:
    return {
        "block_down": played.performance.block_down,
        "task_done": played.performance.done,
        "guarded_ticks": played.performance.guarded_ticks,
        "refusal": played.performance.refusal,
        "remark": played.remark,
        "hand_error_mm": {
            "mean": 1000.0 * played.deviation.hand_mean,
            "max": 1000.0 * played.deviation.hand_max,
            "dtw": 1000.0 * played.deviation.hand_dtw,
        },
    }


def _by_joint(joints: Sequence[str], values: FloatArray) -> dict[str, float]:
    return dict(zip(joints, values.tolist(), strict=True))
