"""Numbers that open their equations: a button in the text, and a card that it lays over the page.

Both are plain HTML (``popovertarget``), so that no click has to go to the server and back, and Esc
or a click beside the card closes it. A browser that does not know popovers shows the cards as text.
"""

import math
import re
from collections.abc import Iterable, Mapping

from studio.engine.export.equation import Equation
from studio.panels.markup import block, text

_BUTTON = (
    "all:unset;cursor:pointer;text-decoration:underline dotted;text-underline-offset:.2em;"
    "font-variant-numeric:tabular-nums"
)
_CARD = (
    "max-width:min(52rem,92vw);max-height:84vh;overflow:auto;padding:1em 1.2em;line-height:1.45;"
    "border:2px solid var(--mantine-color-default-border);border-radius:.5em;font-size:1rem;"
    "background:var(--mantine-color-body);color:var(--mantine-color-text);overflow-wrap:anywhere"
)
_LINE = "margin:.5em 0;font-size:1.15em"
_PROGRAM = (
    "user-select:all;overflow:auto;padding:.6em;border-radius:.3em;white-space:pre;font-size:.85em;"
    "background:var(--mantine-color-default-hover)"
)

_SAME = 1e-9  # relative: the same number, by whatever road


class Cards:
    """The cards of one panel; ``place`` tells their names from another panel's."""

    def __init__(self, equations: Mapping[str, Equation], place: str) -> None:
        self._equations, self._place = equations, place
        self._opened: dict[str, None] = {}  # keys, as an ordered set

    def number(self, key: str, shown: str, value: float) -> str:
        """Return a number as HTML: a button if there is an equation behind it, else its text.

        ``value`` is the number before it was rounded, in the equation's unit. Where the equation
        has another one it is that of another network or run, and stays closed.
        """
        equation = self._equations.get(key)
        if equation is None or not math.isclose(equation.value, value, rel_tol=_SAME):
            return text(shown)
        self._opened[key] = None
        words = text(f"{equation.name}: open the equation")
        return (
            f'<button type="button" popovertarget="{self._name(key)}" style="{_BUTTON}" '
            f'title="{words}">{text(shown)}</button>'
        )

    def html(self) -> str:
        """Return the cards of all numbers that were shown."""
        cards = ((self._name(key), card(self._equations[key])) for key in self._opened)
        return "".join(
            f'<div popover id="{name}" style="{_CARD}">{content}</div>' for name, content in cards
        )

    def _name(self, key: str) -> str:
        return f"equation-{self._place}-{re.sub('[^a-z0-9]+', '-', key.lower())}"


def card(equation: Equation) -> str:
    """Return an equation in symbols and with its values, and the program that checks it."""
    lines = (equation.formula, equation.filled)
    return (
        f"<b>{text(equation.name)}</b>"
        + "".join(f'<div style="{_LINE}">{text(line)}</div>' for line in lines)
        + f"<div>Source: {text(equation.source)}.</div>"
        "<details><summary>Check it with NumPy</summary>"
        "Export the tables (CSV), and run this in their folder; it prints the number."
        f'<pre style="{_PROGRAM}">{text(equation.program())}</pre></details>'
    )


def table_of(rows: str) -> str:
    """Return rows of `row` as a table of a panel."""
    style = "width:100%;border-collapse:collapse;font-size:.9em;font-variant-numeric:tabular-nums"
    return block(f'<table style="{style}">{rows}</table>')


def row(cells: Iterable[str], left: int = 1, kind: str = "td") -> str:
    """Return a table's row of HTML: ``left`` cells of words, the others of numbers."""

    def cell(content: str, column: int) -> str:
        align = "left" if column < left else "right;white-space:nowrap"
        return f'<{kind} style="text-align:{align};padding:.15em .3em">{content}</{kind}>'

    return f"<tr>{''.join(cell(content, i) for i, content in enumerate(cells))}</tr>"
