"""The cards of 2 Teach in a real browser: two pages, one list."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import viser
from playwright.sync_api import Page, expect

from studio.engine import commands
from studio.engine.session import Session
from studio.panels.teach import TeachPanel
from tests.browser.conftest import PATIENCE
from tests.engine.cards_at_hand import DEFECTS, sample


class Cards:
    """A session and its second step alone on a page: no robot, which takes long to draw."""

    def __init__(self, folder: Path, page: Page) -> None:
        self.session, self.page = Session(folder), page
        self._server = viser.ViserServer("127.0.0.1", 0, verbose=False)
        panel = self._server.gui.add_panel()
        with panel.add_tab("2 Teach"):
            self._panel = TeachPanel(self._server.gui, self.session.post)
        self.url = f"http://127.0.0.1:{self._server.get_port()}"
        self._list()
        self.pass_time()
        page.goto(self.url)

    def _list(self) -> None:
        elsewhere = Path("elsewhere.mcap")
        for number in (1, 2, 3):
            self.session._collection.add(sample(number), f"push {number}", elsewhere)
        self.session._collection.add(DEFECTS["dropout"](4), "with a gap", elsewhere)

    def pass_time(self) -> None:
        """Tick a third of a second, and draw."""
        for _ in range(10):
            now = self.session.tick()
        with self._server.atomic():
            self._panel.draw(now)

    def until(self, reached: Callable[[], bool]) -> None:
        end = time.monotonic() + PATIENCE / 1000.0
        while not reached():
            assert time.monotonic() < end
            self.page.wait_for_timeout(50)
            self.pass_time()

    def press(self, name: str) -> None:
        self.page.get_by_role("button", name=name, exact=True).click()

    def entry(self, number: int):
        return self.session._listed.entry(number)

    def close(self) -> None:
        self._server.stop()
        self.session.close()


@pytest.fixture
def cards(page: Page, tmp_path: Path) -> Iterator[Cards]:
    opened = Cards(tmp_path, page)
    yield opened
    opened.close()


def test_choose_read_rename_leave_out_trim_delete_and_undo(cards: Cards) -> None:
    page = cards.page
    expect(page.get_by_text("4 of 4 included, 1 with flags")).to_be_visible(timeout=PATIENCE)
    page.get_by_role("button", name="4 with a gap").click()
    cards.until(lambda: cards.session._listed.chosen == 4)
    expect(page.get_by_text("over 0.3 s; at 1.3 to 2.3 s")).to_be_visible()
    assert page.locator("polyline").count() == 4

    page.locator("input[value='with a gap']").fill("../<b>gap</b>")
    cards.until(lambda: cards.entry(4).name == "../<b>gap</b>")
    expect(page.get_by_role("button", name="4 ../<b>gap</b>")).to_be_visible()

    page.get_by_role("checkbox", name="Learn from it").click()
    cards.until(lambda: not cards.entry(4).included)
    expect(page.get_by_text("3 of 4 included")).to_be_visible()

    handle = page.locator(".multi-slider-thumb").first
    box = handle.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + 60, box["y"] + box["height"] / 2, steps=5)
    page.mouse.up()
    cards.until(lambda: cards.entry(4).is_trimmed)
    begin, end = cards.entry(4).span
    assert begin > 0.5
    assert end == pytest.approx(cards.entry(4).whole.duration)

    cards.press("Delete")
    cards.until(lambda: len(cards.session.snapshot.entries) == 3)
    expect(page.get_by_text("Deleted: ../<b>gap</b>. Its file stays.")).to_be_visible()
    cards.press("Undo")
    cards.until(lambda: len(cards.session.snapshot.entries) == 4)
    assert cards.entry(4).is_trimmed
    cards.press("Replay")
    cards.until(lambda: cards.session.snapshot.mode.value == "playing")


def test_a_second_page_shows_the_same_and_speaks_of_the_same(cards: Cards) -> None:
    other = cards.page.context.new_page()
    other.goto(cards.url)
    first = cards.page.get_by_role("button", name="1 push 1")
    expect(first).to_be_visible(timeout=PATIENCE)
    cards.session.post(commands.Remove(1))
    cards.until(lambda: len(cards.session.snapshot.entries) == 3)
    for page in (cards.page, other):
        expect(page.get_by_role("button", name="1 push 1")).to_be_hidden()
    other.get_by_role("button", name="3 push 3").click()
    cards.until(lambda: cards.session._listed.chosen == 3)
    cards.page.reload()
    expect(cards.page.locator("input[value='push 3']")).to_be_visible(timeout=PATIENCE)
