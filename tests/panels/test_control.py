"""One page controls: the others are refused in words, and a closed one lets go of the robot."""

import asyncio
from types import SimpleNamespace

import pytest

from studio.engine import commands
from studio.engine.seat import PATIENCE, WATCHING, Seat
from studio.panels import control as module
from studio.panels.control import CLOSED, Control


class Part:
    """An element of a page; whatever is set stays."""

    def __init__(self, **kept: object) -> None:
        self.__dict__.update(kept)
        self.content = ""

    def on_click(self, act) -> None:
        self.click = act


class Gui:
    """What a browser has of its own, by its labels."""

    def __init__(self) -> None:
        self.parts: dict[str, Part] = {}

    def add_html(self, _: str, **kept: object) -> Part:
        return self.parts.setdefault("words", Part(**kept))

    def add_button(self, label: str, **kept: object) -> Part:
        return self.parts.setdefault(label, Part(disabled=False, **kept))


class Browser:
    """A browser, as viser hands it over."""

    def __init__(self, client_id: int) -> None:
        self.client_id, self.gui = client_id, Gui()
        self.told: list[str] = []

    def add_notification(self, _: str, body: str, **__: object) -> None:
        self.told.append(body)

    def press(self, label: str) -> None:
        self.gui.parts[label].click(SimpleNamespace(client_id=self.client_id))

    def sees(self, label: str) -> bool:
        return self.gui.parts[label].visible


class Hall:
    """A server with browsers, whose time and speaker the test sets."""

    def __init__(self, monkeypatch, seat: Seat | None = None) -> None:
        self.browsers: dict[int, Browser] = {}
        self.posted: list[commands.Command] = []
        self.time, self.speaking = 0.0, None
        monkeypatch.setattr(module, "hear", lambda _: None)
        monkeypatch.setattr(module, "keep_shared", lambda *_: None)
        monkeypatch.setattr(module, "speaker", lambda: self.speaking)
        server = SimpleNamespace(
            on_client_connect=lambda act: setattr(self, "joined", act),
            on_client_disconnect=lambda act: setattr(self, "left", act),
            get_clients=lambda: dict(self.browsers),
        )
        self.control = Control(server, self.posted.append, lambda: self.time, seat)

    def open(self, client_id: int) -> Browser:
        browser = self.browsers[client_id] = Browser(client_id)
        asyncio.run(self.joined(browser))
        self.control.draw()
        return browser

    def close(self, browser: Browser) -> None:
        del self.browsers[browser.client_id]
        self.left(browser)
        self.control.draw()

    def ask(self, browser: Browser, command: commands.Command) -> None:
        self.speaking = browser.client_id
        self.control.post(command)
        self.speaking = None
        self.control.draw()


@pytest.fixture
def hall(monkeypatch) -> Hall:
    return Hall(monkeypatch)


def test_one_page_alone_sees_nothing_of_it(hall: Hall) -> None:
    only = hall.open(1)
    hall.ask(only, commands.Watch())
    assert hall.posted == [commands.Watch()]
    assert not any(only.sees(label) for label in only.gui.parts)


def test_the_first_to_act_controls_and_others_are_refused_in_words(hall: Hall) -> None:
    first, second = hall.open(1), hall.open(2)
    hall.ask(second, commands.Watch())
    hall.ask(first, commands.Record())
    hall.ask(first, commands.Record())
    assert hall.posted == [commands.Watch()]
    assert first.told == [WATCHING]  # not at every move of a slider
    hall.time += 10.0
    hall.ask(first, commands.Watch())
    assert first.told == [WATCHING, WATCHING]
    assert hall.control.holder() is second
    assert "You control" in second.gui.parts["words"].content
    assert first.sees("Ask for control")
    assert not second.sees("Ask for control")


def test_control_is_asked_for_and_handed_over(hall: Hall) -> None:
    first, second = hall.open(1), hall.open(2)
    hall.ask(first, commands.Watch())
    second.press("Ask for control")
    hall.control.draw()
    assert first.sees("Hand over")
    assert second.gui.parts["Ask for control"].disabled
    first.press("Keep control")
    hall.control.draw()
    assert hall.control.holder() is first
    assert not first.sees("Hand over")
    second.press("Ask for control")
    first.press("Hand over")
    assert hall.control.holder() is second


def test_no_answer_is_a_yes(hall: Hall) -> None:
    first, second = hall.open(1), hall.open(2)
    hall.ask(first, commands.Watch())
    second.press("Ask for control")
    hall.time += PATIENCE
    hall.control.draw()
    assert hall.control.holder() is second


def test_closing_the_page_in_control_lets_go_and_says_so(hall: Hall) -> None:
    first, second = hall.open(1), hall.open(2)
    hall.ask(first, commands.Record())
    hall.close(second)
    assert hall.posted == [commands.Record()]
    hall.close(first)
    assert hall.posted == [commands.Record(), commands.LetGo(CLOSED)]
    assert hall.control.holder() is None


def test_what_the_studio_itself_asks_is_never_refused(hall: Hall) -> None:
    hall.ask(hall.open(1), commands.Watch())
    hall.control.post(commands.Stop())
    assert hall.posted[-1] == commands.Stop()


def test_a_program_is_asked_for_control_as_another_page_is(monkeypatch) -> None:
    seat = Seat()
    hall = Hall(monkeypatch, seat)
    page = hall.open(1)
    assert not hall.control.is_elsewhere
    seat.join("program 1", "a program at 127.0.0.1")
    seat.act("program 1")
    assert hall.control.is_elsewhere
    assert hall.control.holder() is None
    hall.ask(page, commands.Watch())
    assert hall.posted == []
    assert page.told[0].startswith(
        "A program at 127.0.0.1 controls Baxter: press “Ask for control”"
    )
    assert "a program at 127.0.0.1 controls" in page.gui.parts["words"].content
    page.press("Ask for control")
    assert seat.asking == 1
    seat.answer("program 1", yes=True)
    hall.ask(page, commands.Watch())
    assert hall.posted == [commands.Watch()]
    assert not hall.control.is_elsewhere


def test_who_watches_may_stop_the_robot_all_the_same(hall: Hall) -> None:
    first, second = hall.open(1), hall.open(2)
    hall.ask(first, commands.Watch())
    stops = [commands.Stop(), commands.StopLink(), commands.DisableLink()]
    for command in stops:
        hall.ask(second, command)
    assert hall.posted == [commands.Watch(), *stops]
    assert second.told == []
    assert hall.control.holder() is first
