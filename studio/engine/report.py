"""What an experiment found, as one JSON object and as text for people."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from studio.engine.arms import in_words, learned_joints
from studio.engine.demonstration import SAMPLES
from studio.engine.experiment import Experiment, FileOutcome, Setup
from studio.engine.measures import Deviation
from studio.engine.performance import Performance, in_guards_words
from studio.engine.skeleton import FloatArray
from studio.engine.task_words import BLOCK, task_words
from studio.engine.teaching import Lesson, Replay, Reproduction


def as_json(experiment: Experiment) -> dict[str, Any]:
    """Return the object that ``--json`` prints; angles of errors in degrees, MSE in rad²."""
    files = [_file(file) for file in experiment.files]
    if experiment.lesson is None or experiment.reproduction is None:
        return {"files": files} | _nothing(experiment.setup) | {"error": experiment.error}
    return {"files": files} | as_results(
        experiment.lesson, experiment.reproduction, experiment.replays
    )


def _nothing(setup: Setup) -> dict[str, Any]:
    """Return the same keys as `as_results` where nothing was taught: null for what there is not."""
    return {
        "arm": setup.arms,
        "mapping": setup.mapping,
        "scene": setup.scene.name,
        "joints": list(learned_joints(setup.arms, setup.mapping)),
        "samples": SAMPLES,
        "learner": {"name": setup.learner.name, "neurons": setup.learner.neurons},
        "mse": None,
        "floor": None,
        "floor_note": "nothing was taught",
        "remark": "",
        "reproduction": None,
        "demonstrations": [],
    }


def as_results(
    lesson: Lesson, reproduction: Reproduction, replays: Sequence[Replay]
) -> dict[str, Any]:
    """Return the part of the object that does not speak of files."""
    joints = joint_names(lesson)
    floor = lesson.floor
    return {
        "arm": lesson.taught.arms,
        "mapping": lesson.taught.mapping,
        "scene": lesson.taught.scene.name,
        "joints": list(joints),
        "samples": SAMPLES,
        "learner": {"name": lesson.settings.name, "neurons": lesson.settings.neurons},
        "mse": _by_joint(joints, lesson.mse),
        "floor": None if floor is None else _by_joint(joints, floor),
        "floor_note": lesson.floor_note,
        "remark": lesson.remark,
        "reproduction": {
            **_deviation(joints, reproduction.deviation),
            **_performed(reproduction.performance),
        },
        "demonstrations": [
            {
                "name": demonstration.name,
                "seconds": demonstration.duration,
                **_performed(each.performance),
                "interpolation": _deviation(joints, each.interpolation),
            }
            for demonstration, each in zip(lesson.taught.demonstrations, replays, strict=True)
        ],
    }


def joint_names(lesson: Lesson) -> tuple[str, ...]:
    """Return Baxter's own names of the learned joints: ``left_s0``."""
    return lesson.taught.joints


def as_text(experiment: Experiment) -> str:
    """Return the same for people."""
    lines = [_file_line(file) for file in experiment.files]
    lesson, reproduction = experiment.lesson, experiment.reproduction
    if lesson is None or reproduction is None:
        return "\n".join(lines)
    lines += ["", _learner_line(lesson), *_joint_lines(lesson, reproduction), ""]
    error = reproduction.deviation
    lines += [
        f"The hand, against the mean demonstration as sent: mean {_mm(error.hand_mean)}, "
        f"largest {_mm(error.hand_max)}, after time warping {_mm(error.hand_dtw)}.",
        _done_line(lesson, reproduction, experiment.replays),
        _interpolation_line(experiment.replays),
    ]
    played = {"Alone": reproduction.performance}
    played |= {f"Replay {i}": each.performance for i, each in enumerate(experiment.replays, 1)}
    said = {name: in_guards_words(performance) for name, performance in played.items()}
    lines += [f"{name}: {words}" for name, words in said.items() if words]
    return "\n".join(lines)


def _file(file: FileOutcome) -> dict[str, Any]:
    shown: dict[str, Any] = {
        "path": file.path,
        "format": file.format,
        "frames": file.frames,
        "armed": [list(stretch) for stretch in file.armed],
        "armed_frames": file.armed_frames,
        "held": file.held,
        "limited_frames": file.limited_frames,
    }
    return shown | ({"warning": file.warning} if file.warning else {})


def _file_line(file: FileOutcome) -> str:
    armed = ", ".join(f"{first}-{last}" for first, last in file.armed) or "never"
    line = f"{file.path} ({file.format}): {file.frames} frames, armed {armed}"
    if file.armed_frames:
        line += f"; {file.limited_frames} frames met a limit"
    held = sorted(file.held.items(), key=lambda item: -item[1])
    return "\n".join([line, *(f"    held {frames:4d} frames: {why}" for why, frames in held)])


def _learner_line(lesson: Lesson) -> str:
    count, taught = lesson.settings.neurons, lesson.taught
    shown = len(taught.demonstrations)
    return (
        f"Learned by {lesson.settings.name} with {count} neurons from {shown} "
        f"demonstration{'s' * (shown != 1)} of {taught.duration:.1f} s, "
        f"{SAMPLES} x {len(taught.joints)} each, {in_words(taught.arms)}, {taught.mapping} mapping:"
    )


def _joint_lines(lesson: Lesson, reproduction: Reproduction) -> list[str]:
    lines = ["  joint      MSE [rad²]  its floor    ratio   alone: RMSE [deg]"]
    for i, joint in enumerate(joint_names(lesson)):
        floor, ratio = "none", ""
        if lesson.floor is not None:
            floor = f"{lesson.floor[i]:.3e}"
            ratio = f"{lesson.mse[i] / lesson.floor[i]:.4f}" if lesson.floor[i] > 0 else ""
        degrees = math.degrees(reproduction.deviation.joint_rmse[i])
        lines.append(
            f"  {joint:9s}  {lesson.mse[i]:.3e}  {floor:>9s}  {ratio:>7s}   {degrees:17.2f}"
        )
    if lesson.floor_note:
        lines.append(f"  (no floor: {lesson.floor_note})")
    if lesson.remark:
        lines.append(f"  ({lesson.remark})")
    return lines


def _done_line(lesson: Lesson, reproduction: Reproduction, replays: Sequence[Replay]) -> str:
    alone, task = reproduction.performance, task_words(lesson.taught.scene)
    missing = f" ({alone.missing})" if alone.missing and task is not BLOCK else ""
    return (
        f"{task.by_name}: alone {_yes(alone.done)}{missing}; the demonstrations' own "
        f"replays {', '.join(_yes(each.performance.done) for each in replays)}."
    )


def _interpolation_line(replays: Sequence[Replay]) -> str:
    worst = max(replay.interpolation.hand_max for replay in replays)
    mean = float(np.mean([replay.interpolation.hand_mean for replay in replays]))
    return (
        f"Resampling to {SAMPLES} moves the replayed hand by {_mm(mean)} in the mean, "
        f"{_mm(worst)} at most."
    )


def _deviation(joints: Sequence[str], error: Deviation) -> dict[str, Any]:
    return {
        "joint_rmse_deg": _by_joint(joints, np.degrees(error.joint_rmse)),
        "hand_error_mm": {
            "mean": 1000.0 * error.hand_mean,
            "max": 1000.0 * error.hand_max,
            "dtw": 1000.0 * error.hand_dtw,
        },
    }


def _performed(performance: Performance) -> dict[str, Any]:
    return {
        "block_down": performance.block_down,
        "task_done": performance.done,
        "missing": performance.missing,
        "guarded_ticks": performance.guarded_ticks,
        "refusal": performance.refusal,
    }


def _by_joint(joints: Sequence[str], values: FloatArray) -> dict[str, float]:
    return dict(zip(joints, values.tolist(), strict=True))


def _mm(meters: float) -> str:
    return f"{1000.0 * meters:.1f} mm"


def _yes(value: bool) -> str:
    return "yes" if value else "no"
