"""The chosen demonstration's card: all that it is, and all that can be done with it."""

from collections.abc import Callable

import viser

from studio.engine import commands
from studio.engine.arms import in_words
from studio.engine.demonstration import SHORTEST
from studio.engine.entry import LONGEST_NAME, Entry
from studio.engine.export.material import Take
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.scene import USUAL, Scene
from studio.panels import markup
from studio.panels.flags import explained, verdict
from studio.panels.inputs import Post
from studio.panels.playhead import Playhead
from studio.panels.sparkline import PLAYHEAD, legend, playhead, sparkline
from studio.panels.synced import Synced

REPLAY, AGAIN, DELETE = "Replay", "Record again", "Delete"
_LABELS = 7.1  # [em] the width that viser gives labels: the picture lies above the trim's slider
_TYPING = 30  # drawings, 3 s: who thinks about a name must not lose what is typed
Ask = Callable[[int], commands.Command]


class Card:
    """See the module; `draw` shows another demonstration whenever another one is chosen."""

    def __init__(self, gui: viser.GuiApi, post: Post, order: float) -> None:
        self._post = post
        self._entry: Entry | None = None
        self.folder = gui.add_folder(None, order=order)
        with self.folder:
            self._picture = gui.add_html("")
            self._playhead = Playhead(gui, PLAYHEAD)
            self._slider = gui.add_multi_slider(
                "Trim",
                0.0,
                100.0,
                0.5,
                (0.0, 100.0),
                marks=((0.0, "start"), (100.0, "end")),
                hint="What lies between the two handles is learned and replayed",
            )
            self._trim = Synced(self._slider, self._send_trim)
            self._flags = gui.add_html("")
            self._include = Synced(
                gui.add_checkbox("Learn from it", True, hint="Left out, it stays on the list"),
                self._send_include,
            )
            self._name = Synced(
                gui.add_text("Name", "", hint=f"Up to {LONGEST_NAME} characters"),
                self._send_name,
                _TYPING,
            )
            self._actions = gui.add_button_group(
                "",
                (REPLAY, AGAIN, DELETE),
                hint="Replay shows it again; Record again (R) puts another take in its place; "
                "Delete can be undone",
            )
            self._actions.on_click(lambda _: self._act())

    def draw(self, entry: Entry | None, replayed: Take | None = None, time: float = 0.0) -> None:
        """Show a demonstration, or nothing, and where in it what is replayed is at ``time`` [s]."""
        self.folder.visible = entry is not None
        if entry is None:
            self._entry = None
            return
        if self._entry is None or self._entry.number != entry.number:
            for control in (self._trim, self._include, self._name):
                control.forget()
        if entry is not self._entry:  # a card is never changed, but replaced
            self._entry = entry
            self._picture.content = pictured(entry)
            self._flags.content = explained(entry)
        self._playhead.draw(playhead(entry, replayed, time))
        self._show_trim(entry)
        self._include.show(entry.included)
        self._name.show(entry.name)

    def _show_trim(self, entry: Entry) -> None:
        length = entry.whole.duration
        share = tuple(round(100.0 * moment / length, 1) for moment in entry.span)
        tick = 100.0 * CONTROL_PERIOD / length + 0.5  # what rounding to samples may change

        def is_same(shown: tuple[float, float]) -> bool:
            return all(abs(a - b) <= tick for a, b in zip(shown, share, strict=True))

        self._slider.min_range = min(100.0, 100.0 * SHORTEST / length)
        self._trim.show(share, is_same)

    def _send_trim(self) -> None:
        if self._entry is not None:
            length = self._entry.whole.duration
            begin, end = (length * share / 100.0 for share in self._slider.value)
            self._post(commands.Trim(self._entry.number, begin, end))

    def _send_include(self) -> None:
        self._ask(lambda number: commands.Include(number, self._include.control.value))

    def _send_name(self) -> None:
        name = self._name.control.value
        if name.strip():  # nobody can type one without deleting the other first
            self._ask(lambda number: commands.Rename(number, name))

    def _act(self) -> None:
        asked: dict[str, Ask] = {
            REPLAY: commands.PlayDemonstration,
            AGAIN: commands.RecordAgain,
            DELETE: commands.Remove,
        }
        self._ask(asked[self._actions.value])

    def _ask(self, command: Ask) -> None:
        if self._entry is not None:
            self._post(command(self._entry.number))


def pictured(entry: Entry) -> str:
    """Return what a demonstration is, as HTML: figures, and its joints over time."""
    shown = entry.demonstration
    kept = f" of {entry.whole.duration:.1f}" if entry.is_trimmed else ""
    block = f"{'✔' if entry.done else '✖'} {entry.task.state[not entry.done]}"
    figures = f"{shown.duration:.1f}{kept} s · {block} · {verdict(entry)}"
    how = f"{in_words(shown.arms)}, {shown.mapping} mapping{_where(shown.scene)}"
    style = f"flex:0 0 {_LABELS}em;font-size:.8em;line-height:1.35;align-self:center"
    return markup.block(
        f'<div style="font-weight:600">{markup.text(figures)}</div>'
        f'<div style="font-size:.85em;margin-bottom:.35em">{markup.text(how)}</div>'
        f'<div style="display:flex"><div style="{style}">{legend(shown.joints)}</div>'
        f'<div style="flex:1">{sparkline(entry)}</div></div>'
    )


def _where(scene: Scene) -> str:
    """Return in which scene it was taught, where that is not the paper's."""
    return "" if scene.is_same_as(USUAL) else f", scene {scene.name_beside(USUAL)}"
