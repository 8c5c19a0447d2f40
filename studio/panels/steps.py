"""The steps, left to right, one of them open at a time.

Which one that is stands here and not in a browser, as it would with viser's own tabs: so it is the
same in all of them, comes back after a reload, and a closed step is neither sent nor drawn.
"""

from collections.abc import Callable

import viser

# viser draws a group of buttons small and beside a label; this makes it a bar of tabs. Where a
# later viser lays its elements out in another way, the plain group is left, and works.
_STYLE = """<style>
div:has(> .studio-steps) + div > div > div:first-child {{ display: none; }}
div:has(> .studio-steps) + div .mantine-Button-root {{
  height: 2.3em; font-size: .92em; padding: 0 .35em; }}
div:has(> .studio-steps) + div .mantine-Button-root:nth-child({place}) {{
  background: var(--mantine-primary-color-filled); color: #fff; font-weight: 700;
  box-shadow: inset 0 -4px 0 rgba(255, 255, 255, .65); }}
</style><div class="studio-steps"></div>"""


class Steps:
    """See the module.

    Parameters
    ----------
    gui
        Where they go, in the container that is current.
    names
        As people read them.
    may_open
        Tells whether whoever clicks now may open another one.
    """

    def __init__(
        self, gui: viser.GuiApi, names: tuple[str, ...], may_open: Callable[[], bool]
    ) -> None:
        self._names = names
        self.open_step = names[0]
        self._style = gui.add_html(_STYLE.format(place=1))
        self._bar = gui.add_button_group("Step", names)
        self._folders = {name: gui.add_folder(None, visible=name == names[0]) for name in names}

        @self._bar.on_click
        def _clicked(event: viser.GuiEvent[viser.GuiButtonGroupHandle]) -> None:
            if event.client is not None and may_open():
                self.open(self._bar.value)

    def __getitem__(self, name: str) -> viser.GuiFolderHandle:
        """Return the container of a step."""
        return self._folders[name]

    def open(self, name: str) -> None:
        """Open a step, and close the one that was open."""
        if name == self.open_step:
            return
        before, self.open_step = self.open_step, name
        self._folders[name].visible = True
        self._folders[before].visible = False
        self._style.content = _STYLE.format(place=self._names.index(name) + 1)

    def is_open(self, name: str) -> bool:
        """Tell whether a step can be seen."""
        return name == self.open_step
