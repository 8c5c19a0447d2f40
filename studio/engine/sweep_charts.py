"""The figures of a sweep's page: errors by neurons, and the paper's Fig. 9 and Fig. 10."""

import numpy as np

from studio.engine.arms import short_names, sides_of
from studio.engine.demonstration import SAMPLES
from studio.engine.measures import body_as_meant, hand_path
from studio.engine.paper import PAPER_JOINTS, paper_table
from studio.engine.robot import BASE_HEIGHT
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.svg import Box, Chart, Line, legend
from studio.engine.sweep import Sweep
from studio.engine.sweep_report import label_of
from studio.engine.teaching import INDEX_TIME

# Okabe and Ito's palette, which color-blind people tell apart; each with dashes of its own.
STYLES = (("#d55e00", ""), ("#0072b2", "7 3"), ("#009e73", "2 2"), ("#cc79a7", "9 2 2 2"))
PAPER_STYLE = ("#000000", "1 3")
DEMONSTRATION_STYLES = (("#0072b2", ""), ("#e69f00", "8 2"), ("#009e73", "3 2"), ("#cc79a7", "1 2"))
FAINT, MEAN, MEAN_DASHES = "#b9b9b9", "#444444", "1 2"
FAINT_WIDTH, PAPER_WIDTH = 0.8, 2.2
SHOWN = 4  # demonstrations, as in the paper's Fig. 9


def error_charts(table: Sweep) -> str:
    """Return each joint's MSE over its floor, by neurons; the paper's over its own last column."""
    if table.floor is None or not (table.floor > 0.0).all() or len(table.of(table.learners[0])) < 2:
        return ""
    charts = []
    for place, joint in enumerate(short_names(table.taught.joints)):
        lines = [
            _styled(
                style,
                np.array([row.neurons for row in table.of(learner)], dtype=float),
                np.array([row.quality.mse[place] for row in table.of(learner)])
                / table.floor[place],
                marked=True,
            )
            for style, learner in enumerate(table.learners)
        ]
        if (short := joint.rpartition("_")[2]) in PAPER_JOINTS:
            lines.append(_paper_line(short))
        charts.append(Chart(joint, "neurons", "MSE / floor", tuple(lines), log=True).svg())
    keys = [(label_of(name), _key(style)) for style, name in enumerate(table.learners)]
    keys.append(("the paper, over its own last column", _paper_line(PAPER_JOINTS[0])))
    return legend(keys) + _figures(charts)


def demonstration_charts(table: Sweep) -> str:
    """Return four demonstrations' joint angles by sample, as in the paper's Fig. 9."""
    taught = table.taught
    lines = [
        [
            Line(INDEX_TIME, np.degrees(rows[:, place]), *style, width=1.4)
            for rows, style in zip(taught.rows[:SHOWN], DEMONSTRATION_STYLES, strict=False)
        ]
        for place in range(len(taught.joints))
    ]
    charts = [
        Chart(joint, "sample", "angle [deg]", tuple(each)).svg()
        for joint, each in zip(short_names(taught.joints), lines, strict=True)
    ]
    names = [each.name.rpartition("/")[2] for each in taught.demonstrations[:SHOWN]]
    return legend(list(zip(names, lines[0], strict=True))) + _figures(charts)


def output_charts(table: Sweep) -> str:
    """Return what the networks answer over all demonstrations: the paper's Fig. 10 (a) to (c)."""
    taught = table.taught
    charts = []
    for place, joint in enumerate(short_names(taught.joints)):
        lines = [
            Line(INDEX_TIME, np.degrees(rows[:, place]), FAINT, width=FAINT_WIDTH)
            for rows in taught.rows
        ]
        lines += [
            _styled(style, INDEX_TIME, np.degrees(table.shown_row(learner).quality.curve[:, place]))
            for style, learner in enumerate(table.learners)
        ]
        charts.append(Chart(joint, "sample", "angle [deg]", tuple(lines)).svg())
    keys = [("demonstrations", Line(INDEX_TIME, INDEX_TIME, FAINT, width=FAINT_WIDTH))]
    keys += [
        (f"{label_of(name)}, {table.shown_row(name).neurons} neurons", _key(style))
        for style, name in enumerate(table.learners)
    ]
    return legend(keys) + _figures(charts)


def path_charts(table: Sweep) -> str:
    """Return the hand's measured path from three sides: the paper's Fig. 10 (d)."""
    taught = table.taught
    sides = sides_of(taught.arms)
    meant = body_as_meant(taught.mean, taught.joints, taught.arms, taught.duration, taught.hands)
    intended = [hand_path(meant, side) for side in sides]
    stamps = np.linspace(0.0, taught.duration, SAMPLES)
    paths = [
        (style, hand_path(table.played[name].performance.measured_at(stamps), side))
        for style, name in enumerate(table.learners)
        for side in sides
    ]
    from_floor = np.array([0.0, 0.0, BASE_HEIGHT])
    charts = []
    for title, across, up, labels in (
        ("from the side", 0, 2, ("forward x [m]", "up z [m]")),
        ("from above", 0, 1, ("forward x [m]", "left y [m]")),
        ("from the front", 1, 2, ("left y [m]", "up z [m]")),
    ):
        axes = [across, up]
        placed = [(path + from_floor)[:, axes].T for path in intended]
        lines = [Line(x, y, MEAN, MEAN_DASHES) for x, y in placed]
        lines += [_styled(style, *(path + from_floor)[:, axes].T) for style, path in paths]
        boxes = _scene_boxes(taught.scene, across, up)
        charts.append(Chart(title, *labels, tuple(lines), boxes, size=(388, 300), equal=True).svg())
    keys = [("mean demonstration, as sent", Line(INDEX_TIME, INDEX_TIME, MEAN, MEAN_DASHES))]
    keys += [(f"{label_of(name)}, as measured", _key(i)) for i, name in enumerate(table.learners)]
    return legend(keys) + _figures(charts)


def _scene_boxes(scene: Scene, across: int, up: int) -> tuple[Box, ...]:
    """Return the desk and the blocks of the task, seen along the third axis."""
    desk, blocks = scene.placed_desk, [scene.placed_blocks[i] for i in scene.task_blocks]
    seen = [("desk", "#ece5da", desk.position, desk.size)]
    seen += [(block.name, "#f0dc9c", block.position, block.size) for block in blocks]
    boxes = []
    for name, color, position, size in seen:
        pairs = zip(position, size, strict=True)
        spans = [(at - side / 2.0, at + side / 2.0) for at, side in pairs]
        boxes.append(Box(spans[across], spans[up], name, color))
    return tuple(boxes)


def _styled(style: int, x: FloatArray, y: FloatArray, marked: bool = False) -> Line:
    color, dashes = STYLES[style % len(STYLES)]
    return Line(x, y, color, dashes, marked=marked)


def _key(style: int) -> Line:
    return _styled(style, INDEX_TIME, INDEX_TIME)


def _paper_line(joint: str) -> Line:
    rows = paper_table()
    counts = np.array([row.neurons for row in rows], dtype=float)
    mse = np.array([row.mse[joint] for row in rows])
    return Line(counts, mse / mse[-1], *PAPER_STYLE, width=PAPER_WIDTH)


def _figures(charts: list[str]) -> str:
    return f'<div class="charts">{"".join(charts)}</div>'
