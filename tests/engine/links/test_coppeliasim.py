"""CoppeliaSim, through its genuine client; the laws that all links share are in test_links.py."""

import socket
import sys
import time
from collections.abc import Iterator

import pytest

from studio.engine.links import coppeliasim
from studio.engine.links.address import link_at
from studio.engine.links.coppeliasim import CoppeliaSim, paths_of
from studio.engine.links.link import LinkError
from studio.engine.links.status import Phase
from tests.engine.links.arms_model import JOINTS
from tests.engine.links.coppeliasim_server import CoppeliaSimServer, old_name
from tests.engine.links.rig import HASTE, LiveRig
from tests.engine.links.unhurried import CLOCK


@pytest.fixture
def scene() -> Iterator[CoppeliaSimServer]:
    with CoppeliaSimServer(CLOCK, HASTE) as server:
        server.arms.positions["left_e1"] = 0.6
        yield server
        assert server.complaints == []


@pytest.fixture
def link(scene: CoppeliaSimServer) -> Iterator[CoppeliaSim]:
    made = link_at(scene.url, time.monotonic)
    assert isinstance(made, CoppeliaSim)
    yield made
    made.close()


@pytest.mark.parametrize("place", range(4))
def test_joints_are_found_by_each_of_their_names(scene, link: CoppeliaSim, place: int) -> None:
    scene.paths = {paths_of(joint, "Baxter")[place]: joint for joint in JOINTS}
    scene.arms.positions |= {"left_s1": 0.2, "right_w2": -0.4}
    link.open()
    state = link.read()
    assert state.untold == ()
    assert state.positions[[1, 13]] == pytest.approx([0.2, -0.4])
    assert not state.enabled


def test_another_name_of_the_model(scene: CoppeliaSimServer) -> None:
    scene.paths = {f"/Robbie/{old_name(joint)}": joint for joint in JOINTS}
    link = link_at(f"{scene.url}/Robbie", time.monotonic)
    link.open()
    assert link.read() is not None
    link.close()


def test_a_joint_that_is_not_there(scene: CoppeliaSimServer, link: CoppeliaSim) -> None:
    del scene.paths["/Baxter/rightArm_joint7"]
    with pytest.raises(LinkError, match="right_w2 is not in the scene"):
        link.open()


def test_limits_are_its_own_where_they_are_narrower(scene, link: CoppeliaSim) -> None:
    scene.intervals["left_s0"] = [False, [-1.0, 1.8]]
    scene.intervals["left_w2"] = [True, [-3.14, 6.28]]  # cyclic: it has none
    link.open()
    assert link.limits["left_s0"] == pytest.approx((-1.0, 0.8))
    assert "left_w2" not in link.limits


@pytest.mark.parametrize(
    ("joint", "interval", "words"),
    [
        ("left_s1", [-1.047, 1.047 + 2.147], "turns the other way"),  # ours mirrored
        ("right_e1", [-2.618, 2.618 + 0.05], "turns the other way"),
        ("left_e1", [3.0, 1.0], "another zero, or another joint"),
        ("left_s0", [1.5, 3.0], "another zero, or another joint"),
    ],
)
def test_a_model_whose_joint_is_not_ours(scene, link, joint, interval, words) -> None:
    scene.intervals[joint] = [False, interval]
    with pytest.raises(LinkError, match=f"{joint} .*{words}"):
        link.open()


def test_it_runs_in_its_own_time(scene: CoppeliaSimServer) -> None:
    """Nothing is stepped: the simulation goes on whatever the studio does."""
    with LiveRig(link_at(scene.url, CLOCK)) as rig:
        rig.move("left_e1", 0.6)
        rig.moving()
        assert not scene.stepping
    assert scene.locked == 0


def test_a_paused_simulation_goes_on_when_enabled(scene: CoppeliaSimServer) -> None:
    with LiveRig(link_at(scene.url, CLOCK)) as rig:
        rig.heard()
        scene.press()
        rig.until(lambda: rig.seen.state is not None and rig.seen.state.resets)
        rig.enable()
        assert rig.phase is Phase.WAITING
        assert scene.arms.powered


def test_garbage_is_a_lost_simulator(scene: CoppeliaSimServer) -> None:
    with LiveRig(link_at(scene.url, CLOCK)) as rig:
        rig.move("left_e1", 0.6)
        rig.moving()
        scene.garbage = True
        rig.until(lambda: rig.phase is Phase.OFF)
        scene.garbage = False
        rig.until(lambda: rig.seen.state is not None)
        assert rig.phase is Phase.OFF


def test_nobody_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coppeliasim, "_ANSWERS_WITHIN", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as gone:
        port = gone.getsockname()[1]
    link = CoppeliaSim("coppeliasim://gone", "127.0.0.1", port, "Baxter", time.monotonic)
    with pytest.raises(LinkError, match="does not answer"):
        link.open()
    link.close()
    link.close()
    with pytest.raises(LinkError, match="not open"):
        link.send({"left_s0": 0.1})


def test_the_client_leaves_nothing_behind(scene: CoppeliaSimServer, link: CoppeliaSim) -> None:
    before = vars(sys.modules["__main__"]).get("require")
    link.open()
    assert vars(sys.modules["__main__"]).get("require") is before


def test_the_extra_is_named_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zmq", None)
    with pytest.raises(LinkError, match=r"teaching-studio\[coppeliasim\]"):
        coppeliasim.CoppeliaSim("coppeliasim://x", "x", 1, "Baxter", time.monotonic).open()
