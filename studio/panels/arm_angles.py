"""The six angles of the person's arms beside Baxter's joints: a table, and arcs in the 3D view."""

import math

import viser

from studio.engine.arm_arcs import NAMES
from studio.engine.pose_reading import COUNTERPARTS, ArmReading, read_pose
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.arcs import NUMBERS, ArcsView, letters_of
from studio.panels.inputs import on_choice
from studio.panels.palette import ARCS, css


class ArmAnglesPanel:
    """A part of the first step."""

    def __init__(self, gui: viser.GuiApi, arcs: ArcsView) -> None:
        self._arcs = arcs
        self._wanted = gui.add_checkbox(
            "Draw the arcs", False, hint="The paper's six angles, drawn where the person's arms are"
        )
        on_choice(self._wanted, self._switch)
        self._table = gui.add_html("")

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._table.content = described(now)

    def _switch(self) -> None:
        self._arcs.wanted = self._wanted.value


def described(now: Snapshot) -> str:
    """Return the angles of each arm that is followed as HTML."""
    if now.skeleton is None:
        return markup.note("Choose a source: the angles are those of the person in it.")
    readings = read_pose(now.skeleton, now.choices, now.world.joint_positions)
    note = markup.note(
        "Yours are the paper's (Fig. 5): between bones, without a sign. Baxter's are turns of its "
        "joints, from zeros of its own; so they rise and fall together, and are not equal."
    )
    letters = letters_of(now.choices.persons_sides)
    return "".join(_table(each, letters[each.persons]) for each in readings) + note


def _table(reading: ArmReading, letter: str) -> str:
    named = f"{letter}: " if letter else ""
    head = (f"{named}your {reading.persons} arm", "", f"Baxter's {reading.robots}", "")
    rows = [
        (
            f"{letter}{NUMBERS[name]} {name.replace('_', ' ')}",
            _degrees(getattr(reading.angles, name)),
            COUNTERPARTS[name],
            _degrees(reading.joints[name]),
        )
        for name in NAMES
    ]
    table = markup.table(head, rows)
    for number, color in zip(NUMBERS.values(), ARCS, strict=True):  # each in its arc's color
        marked = f'<b style="border-bottom:4px solid {css(color)}">{letter}{number}</b>'
        table = table.replace(letter + number, marked)
    return table


def _degrees(angle: float) -> str:
    return "–" if math.isnan(angle) else f"{round(math.degrees(angle))}°"
