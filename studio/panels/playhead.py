"""An upright line in a drawn chart, at the playhead.

The chart has it from the beginning, hidden at its left edge. A style of its own shows and moves it,
so that a moving playhead sends a hundred characters and not the chart, and whatever is open or
marked in it stays so.
"""

import viser

EVERY = 2  # drawings of a panel, ten a second, from one move to the next: five a second at most


def upright(name: str, top: float, bottom: float) -> str:
    """Return the line as a part of an SVG element, from ``top`` to ``bottom`` [px] of it."""
    return (
        f'<line class="{_class(name)}" x1="0" x2="0" y1="{top}" y2="{bottom}" '
        'stroke="currentColor" stroke-width="1.6" visibility="hidden"/>'
    )


class Playhead:
    """What moves the line; ``name`` is that of one chart on the page."""

    def __init__(self, gui: viser.GuiApi, name: str) -> None:
        self._name = name
        self._style = gui.add_html("")
        self._at: float | None = None
        self._drawings = EVERY  # since it was moved

    def draw(self, at: float | None) -> None:
        """Show it at ``at`` [px] from the chart's left edge, or nowhere."""
        self._drawings += 1
        at = None if at is None else round(at, 1)
        if at == self._at or self._drawings < EVERY:
            return
        self._at, self._drawings = at, 0
        self._style.content = "" if at is None else _moved(self._name, at)


def _moved(name: str, at: float) -> str:
    # A style goes before an element's own attributes, so that the line is seen; a pixel is one of
    # the SVG's, however large that is shown.
    return f"<style>.{_class(name)}{{visibility:visible;transform:translateX({at}px)}}</style>"


def _class(name: str) -> str:
    return f"studio-playhead-{name}"
