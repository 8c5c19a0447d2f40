"""The guide's five minutes are run as they are printed, and its numbers are the code's."""

import re
from pathlib import Path

from studio.engine.live.doorway import House
from studio.engine.remote import guest, outbox, reading, server, shelf
from studio.engine.stepping import MOST_STEPS
from studio.remote import asked, client
from tests.remote.house import ROOT, open_house

PAGE = (ROOT / "docs" / "remote.md").read_text()


def test_the_five_minutes(tmp_path: Path, capsys) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    with open_house(tmp_path, speed=10.0) as house:
        assert client.URL in code
        exec(compile(code.replace(client.URL, house.url), "docs/remote.md", "exec"), {})
    assert capsys.readouterr().out == "the block is down\n"


def test_its_numbers_are_those_of_the_code() -> None:
    house: House = server._HOUSE
    for words in (
        f"more than {guest.FASTEST:,.0f} requests a second",
        f"more than {guest.MOST_WAITING} commands that wait",
        f"more than {guest.FLOOD:,.0f} messages a second",
        f"above {reading.LARGEST_MESSAGE // 1024} kB",
        f"more than {house.most} programs",
        f"after {server._SEND_WITHIN:.0f} s the connection is closed",
        f"asked every {house.alive_every:.0f} s, and gone after {house.alive_every:.0f} more",
        f"after {guest.MOST_UNREADABLE} at once",
        f"at up to {asked.FASTEST:.0f} Hz",
        f"from {asked.SLOWEST:g} to {asked.FASTEST:.0f} Hz",
        f"more than {outbox.MOST_ANSWERS} of them wait",
        f"more than {outbox.MOST_BYTES // 2**20} MB behind the next one",
        f"uploads of all programs above {shelf.MOST_KEPT // 2**20} MB",
    ):
        assert words in PAGE, words
    assert asked.MOST_TICKS == MOST_STEPS
    assert client.URL.endswith(str(server.REMOTE_PORT))
