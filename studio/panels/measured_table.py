"""All that is compared as one table; what Baxter did alone opens its equations."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from studio.engine.arms import short_names
from studio.engine.export.equation import Equation
from studio.engine.measured import Measured
from studio.panels import markup
from studio.panels.equation_card import Cards, row, table_of


def measured(
    table: Sequence[Measured], joints: Sequence[str], equations: Mapping[str, Equation]
) -> str:
    """Return the measures of all that is compared as one table of HTML.

    ``equations`` are of what Baxter did alone with the newest network: numbers of A open them,
    those of a demonstration and of B have none.
    """
    cards = Cards(equations, "compare")
    lines = [row(("", *(column.letter or "shown" for column in table)), kind="th")]
    for words, key, form, values in _measures(table, joints):
        shown = [format(value, form) for value in values]
        cells = [
            cards.number(key, number, value) if column.letter == "A" else number
            for column, number, value in zip(table, shown, values, strict=True)
        ]
        lines.append(row((markup.text(words), *cells)))
    whats = (table[0].task.what, *(each.task.marked(each.done) for each in table))
    lines.append(row(map(markup.text, whats)))
    names = "; ".join(f"{column.letter or 'shown'}: {column.name}" for column in table)
    opened = cards.html()
    hint = "Press a number of A to see its equation with its values in it." if opened else ""
    return table_of("".join(lines)) + markup.note(names) + markup.note(hint) + opened


def _measures(
    table: Sequence[Measured], joints: Sequence[str]
) -> Iterator[tuple[str, str, str, list[float]]]:
    """Yield each measure: in words, its equation's key, how it is shown, and of each column."""
    errors = [column.deviation for column in table]
    for i, (shown, joint) in enumerate(zip(short_names(joints), joints, strict=True)):
        of_joint = [float(np.degrees(each.joint_rmse[i])) for each in errors]
        yield f"{shown} [deg]", f"rmse {joint}", ".2f", of_joint
    yield "hand, mean [mm]", "hand mean", ".1f", [1e3 * each.hand_mean for each in errors]
    yield "hand, largest [mm]", "hand largest", ".1f", [1e3 * each.hand_max for each in errors]
    yield "hand, warped [mm]", "hand dtw", ".1f", [1e3 * each.hand_dtw for each in errors]
    accelerations = [column.acceleration for column in table]
    yield "acceleration [m/s²]", "hand acceleration", ".2f", accelerations
