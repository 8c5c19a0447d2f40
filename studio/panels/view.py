"""How the page looks: dark or light, and its keys."""

import viser

from studio.panels.inputs import on_choice, show_value
from studio.panels.palette import BRAND, BRAND_IN_THE_DARK


class ViewPanel:
    """Beside the evidence.

    Parameters
    ----------
    gui
        Of all browsers: a lecture hall sees one page.
    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._gui = gui
        self.is_dark = False
        self._dark = gui.add_checkbox("Dark page", False, hint="For a dark room; key N")
        on_choice(self._dark, lambda: self._set(self._dark.value))
        self._keys = gui.add_html("")
        self._configure()

    def explain(self, keys: str) -> None:
        """Show what the keys do, as HTML."""
        self._keys.content = keys

    def toggle(self) -> None:
        """Change between dark and light."""
        self._set(not self.is_dark)

    def _set(self, is_dark: bool) -> None:
        self.is_dark = is_dark
        show_value(self._dark, is_dark)
        self._configure()

    def _configure(self) -> None:
        self._gui.configure_theme(
            brand_color=BRAND_IN_THE_DARK if self.is_dark else BRAND,
            dark_mode=self.is_dark,
            show_logo=False,
            show_share_button=False,
        )
