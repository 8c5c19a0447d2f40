"""`studio link check`: a table or one object, nothing moved without a yes, 1 where it fails."""

import io
import json
from pathlib import Path

import pytest

from studio import cli, link_command, running
from studio.engine.errors import StudioError
from studio.engine.links import check
from studio.engine.links.check import Finding
from studio.engine.links.status import Phase
from studio.engine.live.access import Address
from tests.engine.links.rosbridge_server import RosbridgeServer
from tests.engine.live.streaming import eventually


@pytest.fixture(autouse=True)
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check, "LISTENS", 0.2)
    monkeypatch.setattr(check, "CONNECTS_WITHIN", 1.5)
    monkeypatch.setattr(check, "SLOWEST", 1.0)
    monkeypatch.setattr(check, "STALE", 2.0)


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        cli.main(["link", "check", *arguments])
    return ended.value.code


def test_a_table_of_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("simulated://") == 0
    out, err = capsys.readouterr()
    assert out.count("pass") == 5
    assert "look  order and sign" in out
    assert "nothing was moved" in err


def test_one_object(capsys: pytest.CaptureFixture[str]) -> None:
    with RosbridgeServer() as robot:
        robot.press()
        assert run(robot.url, "--json", "--move") == 1  # and what failed is not moved
        assert robot.arms.commands == []
    told = json.loads(capsys.readouterr().out)
    assert told["passed"] is False
    found = {each["name"]: each for each in told["findings"]}
    assert found["emergency stop"]["passed"] is False
    assert found["joints"]["passed"] is True


@pytest.mark.parametrize("answer", ["", "no\n", "y\n"])
def test_nothing_moves_without_a_whole_yes(answer: str, monkeypatch, capsys) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO(answer))
    monkeypatch.setattr(link_command, "MovingCheck", None)  # whoever calls it fails
    assert run("simulated://", "--move") == 1
    assert "nothing was moved" in capsys.readouterr().err


def test_with_a_yes_it_moves_and_asks_nobody_who_is_not_there(monkeypatch, capsys) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("yes\n"))
    asked = []

    class Moving:
        def __init__(self, looking, side, ask) -> None:
            asked.append((side, ask("?")))

        def findings(self):
            yield Finding("right_s0 +6°", True, "went +6°")

    monkeypatch.setattr(link_command, "MovingCheck", Moving)
    assert run("simulated://", "--move", "--arm", "right") == 0
    assert asked == [("right", None)]
    assert "right_s0 +6°" in capsys.readouterr().out


def test_the_studio_is_served_with_a_robot(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(running, "samples_folder", lambda: tmp_path)
    doors = running.Doors(Address("127.0.0.1", 0), robot="simulated://")
    with running.running(tmp_path, doors) as engine:
        eventually(lambda: engine.loop.session.snapshot.link.is_connected)
        assert engine.loop.session.snapshot.link.phase is Phase.OFF
    with pytest.raises(StudioError, match="rosbridge://HOST:9090"):
        running.running(tmp_path, running.Doors(robot="baxter")).__enter__()


def test_a_wrong_address(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("baxter.local") == 1
    assert "rosbridge://HOST:9090" in capsys.readouterr().err
