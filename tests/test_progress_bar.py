"""How far it has come: one line that grows on a terminal, a line now and then in a file."""

import io

from studio.progress_bar import SAID_EVERY, WIDTH, ProgressBar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


class Clock:
    def __init__(self) -> None:
        self.time = 100.0

    def __call__(self) -> float:
        return self.time


def test_on_a_terminal_one_line_grows_and_tells_how_long_it_takes() -> None:
    terminal, clock = Terminal(), Clock()
    with ProgressBar(terminal, clock) as bar:
        bar(20, 100)  # known from before: they say nothing about speed
        clock.time += 10.0
        bar(60, 100)
        clock.time += 10.0
        bar(100, 100)
    first, half, whole = terminal.getvalue().split("\r\x1b[K")[1:]
    assert first == "█" * (WIDTH * 20 // 100) + "░" * (WIDTH - WIDTH * 20 // 100) + " 20 of 100"
    assert half.endswith("60 of 100, 10 s left")
    assert whole == "█" * WIDTH + " 100 of 100\n"


def test_it_is_drawn_ten_times_a_second_at_most() -> None:
    terminal, clock = Terminal(), Clock()
    with ProgressBar(terminal, clock) as bar:
        for over in range(1000):
            bar(over, 1000)
            clock.time += 0.001
    assert terminal.getvalue().count("\r") == 10


def test_in_a_file_it_says_a_line_now_and_then(capsys) -> None:
    clock = Clock()
    with ProgressBar(io.StringIO(), clock) as bar:
        for over in range(101):
            bar(over, 100)
            clock.time += SAID_EVERY / 20
    told = capsys.readouterr().err.splitlines()
    assert told[0] == "studio: 0 of 100"
    assert told[1] == "studio: 20 of 100, 40 s left"
    assert told[-1] == "studio: 100 of 100"
    assert len(told) == 6
