"""All that a panel may draw goes over the wire, at every stage of a session's life."""

import time
from pathlib import Path

import numpy as np
import pytest

from tests.engine.remote.receiving import Hall, open_hall
from tests.remote.house import PATIENCE

LEARNER = {"name": "rbf", "neurons": 12}
EVERY = 5  # ticks between two snapshots that are told


@pytest.fixture
def hall(tmp_path: Path):
    with open_hall(tmp_path) as opened:
        yield opened


class Visit:
    """A guest that is told everything, and keeps the snapshots."""

    def __init__(self, hall: Hall) -> None:
        self.hall, self.guest = hall, hall.enter()
        self.seen: list[dict] = []
        hall.ask(self.guest, {"type": "subscribe", "id": 1, "stream": "snapshot", "rate": 6.0})

    def do(self, kind: str, **fields: object) -> None:
        self.hall.ask(self.guest, {"type": "do", "command": {"type": kind, **fields}})
        self.tick()

    def tick(self, ticks: int = EVERY) -> None:
        for _ in range(ticks):
            self.hall.tick()
            told = self.hall.told(self.guest)
            assert [each for each in told if each["type"] == "error"] == []
            self.seen += [each for each in told if each["type"] == "snapshot"]

    def until(self, reached) -> None:
        end = time.monotonic() + PATIENCE
        while not reached(self.seen[-1]):
            assert time.monotonic() < end, "it never came to that"
            self.tick()
            time.sleep(0.001)

    def fetch(self, what: str) -> dict:
        (answer,) = self.hall.ask(self.guest, {"type": "fetch", "id": 2, "what": what})
        assert answer["type"] == what
        return answer

    def ever(self, *path: str) -> bool:
        """Whether there ever was something at a place of the snapshots."""
        for snapshot in self.seen:
            value = snapshot
            for name in path:
                value = value.get(name) if value else None
            if value:
                return True
        return False


def test_at_every_stage(hall: Hall) -> None:
    visit = Visit(hall)
    visit.do("use_file", file={"type": "sample", "name": "demonstration-1.mcap"})
    visit.until(lambda now: now["entries"] and now["entries"][0]["flags"] is not None)
    visit.do("train", learner=LEARNER)
    visit.until(lambda now: now["lesson"])
    visit.do("keep_to_compare")
    visit.do("train", learner={**LEARNER, "neurons": 9})
    visit.until(lambda now: now["lesson"]["settings"]["neurons"] == 9)
    visit.do("play_reproduction")
    visit.until(lambda now: now["reproduction"])
    done = visit.fetch("reproduction")
    assert np.shape(done["measured"]) == (len(done["times"]), 15)
    visit.fetch("equations")
    lesson = visit.fetch("lesson")
    assert np.shape(lesson["taught"]) == (1, 142, len(lesson["summary"]["joints"]))
    visit.do("train", learner={"name": "plain-field", "neurons": 4})
    visit.until(lambda now: now["lesson"]["settings"]["name"] == "plain-field")
    assert visit.fetch("lesson")["model"] is None
    visit.do("show_leg", leg=0)
    field = visit.fetch("field")
    assert len(field["places"]) == len(field["plain"])
    visit.do("use_puppet")
    visit.do("watch")
    visit.do("drag_hand", side="left", point=[0.1, 0.2, 1.7])
    visit.tick(10)
    visit.do("stop")
    visit.do("calibrate")
    visit.do("stop")
    visit.do("remove", number=1)
    visit.do("begin_driving")
    hall.ask(visit.guest, {"type": "set_joint_target", "targets": {"left_s0": 0.1}})
    visit.tick()
    for path in (
        ("source",),
        ("who", "reading"),
        ("who", "puppet"),
        ("who", "strip"),
        ("live", "counts"),
        ("skeleton",),
        ("gate",),
        ("calibrating",),
        ("ghost",),
        ("compare", "kept"),
        ("compare", "beside"),
        ("compare", "table"),
        ("compare", "timeline", "title"),
        ("collection", "removed"),
        ("driven", "joints"),
        ("scene", "blocks"),
    ):
        assert visit.ever(*path), path


def test_a_frame_is_what_the_session_has(hall: Hall) -> None:
    visit = Visit(hall)
    visit.do("use_demonstrator")
    visit.do("watch")
    visit.tick(60)
    now = hall.session.snapshot
    (states,) = hall.ask(visit.guest, {"type": "get", "id": 1, "what": "joint_states"})
    assert states["positions"] == now.world.joint_positions.tolist()  # exact: JSON keeps float64
    assert states["velocities"] == now.world.joint_velocities.tolist()
    (block,) = hall.ask(visit.guest, {"type": "get", "id": 1, "what": "block"})
    assert block["poses"] == now.world.block_poses.tolist()
    (gate,) = hall.ask(visit.guest, {"type": "get", "id": 1, "what": "gate"})
    assert now.gate is not None
    assert (gate["gate"]["lit"], gate["held"]) == (now.gate.lit, now.held)
    assert now.skeleton is not None
    assert visit.seen[-1]["skeleton"]["positions"] == now.skeleton.positions.tolist()
