"""Dark and light: for all browsers at once, by whoever controls."""

from types import SimpleNamespace

import pytest
import viser
from viser._messages import ThemeConfigurationMessage

from studio.panels.palette import BRAND, BRAND_IN_THE_DARK
from studio.panels.view import ViewPanel


@pytest.fixture
def server():
    made = viser.ViserServer("127.0.0.1", 0, verbose=False)
    yield made
    made.stop()


def is_dark(server: viser.ViserServer) -> bool:
    sent = server._websock_server.get_message_buffer().message_from_id.values()
    themes = [message for message in sent if isinstance(message, ThemeConfigurationMessage)]
    return themes[-1].dark_mode


def tick(panel: ViewPanel, value: bool) -> None:
    panel._dark._impl.value = value
    for act in panel._dark._impl.update_cb:
        act(SimpleNamespace(client=object(), client_id=1, target=panel._dark))


def test_it_is_toggled_by_key_and_by_box(server) -> None:
    panel = ViewPanel(server.gui)
    assert not is_dark(server)
    panel.toggle()
    assert is_dark(server)
    assert panel._dark.value
    tick(panel, False)
    assert not is_dark(server)


def contrast(one: tuple[int, int, int], other: tuple[int, int, int]) -> float:
    """Return the contrast ratio of WCAG 2.1."""

    def luminance(color: tuple[int, int, int]) -> float:
        linear = [
            c / 3294.6 if c <= 10.31475 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in color
        ]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize(
    ("brand", "page"), [(BRAND, (255, 255, 255)), (BRAND_IN_THE_DARK, (36, 36, 36))]
)
def test_the_brand_is_read_on_its_page_and_under_white(brand, page) -> None:
    assert contrast(brand, page) >= 3.0  # large letters, and what frames a button
    assert contrast(brand, (255, 255, 255)) >= 3.0
