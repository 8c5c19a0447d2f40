"""A puppet teaches: through the real pipeline it arms, Baxter follows, the block goes down."""

from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from studio.engine.activity import Follow
from studio.engine.demonstration import DemonstrationSet, demonstrations_of
from studio.engine.human import ArmVectors, arm_vectors
from studio.engine.mcap_file import read_recording
from studio.engine.pipeline import Pipeline
from studio.engine.puppet import PuppetTeacher
from studio.engine.retarget import arm_angles
from studio.engine.robot import load_robot
from studio.engine.skeleton import SIDES, HandState, Joint
from studio.engine.teachers import Teacher
from studio.engine.teaching import LearnerSettings, learn, reproduce
from tests.engine.puppet.dragging import SEQUENCE, from_shoulder, pushed, signed, taught


def test_a_dragged_puppet_teaches_baxter_to_push_the_block() -> None:
    """The whole way: drag and sign, demonstrations, a network, and Baxter alone."""
    recordings = [taught(height=height, seconds=s) for height, s in ((-0.2, 2.0), (-0.23, 2.3))]
    assert all(recording.samples[-1].world.block_down for recording in recordings)
    found = [demonstrations_of(recording, "puppet") for recording in recordings]
    assert [len(each) for each in found] == [1, 1]
    lesson = learn(DemonstrationSet.of([each for one in found for each in one]), LearnerSettings())
    assert reproduce(lesson).performance.block_down
    assert "puppet" in recordings[0].info.source


def test_the_right_arm_can_push_too() -> None:
    assert taught(side="right").samples[-1].world.block_down


def test_with_the_elbow_dragged_up_the_papers_mapping_pushes() -> None:
    recording = taught(mapping="paper", height=-0.14, elbow=(0.18, 0.18, 0.3))
    assert recording.samples[-1].world.block_down


def test_the_gate_obeys_the_buttons() -> None:
    recording = taught()
    lit = [sample.gate.lit for sample in recording.samples]
    assert [n for n, before in zip(lit, [-1, *lit], strict=False) if n != before] == [0, 1, 2, 3, 0]
    assert not recording.samples[-1].gate.armed  # Lasso ended it
    shown = {sample.skeleton.left_hand.state for sample in recording.samples}
    assert shown == {HandState.UNKNOWN, *SEQUENCE}


def test_baxter_ends_where_the_arm_points() -> None:
    """Two roads: what the pipeline sent while the hand stood still, and the mapping by itself."""
    recording = taught()
    armed = [sample for sample in recording.samples if sample.gate.armed]
    last = armed[-1]  # 0.9 s after the last drag
    seen = arm_vectors(last.skeleton, "left")
    assert isinstance(seen, ArmVectors)
    u, f = (seen.torso.from_camera(v) for v in (seen.upper_arm, seen.forearm))
    assert last.sent == pytest.approx(arm_angles(u, f, "left"), abs=0.01)


def test_the_same_drags_give_the_same_bytes() -> None:
    first, again = taught(seconds=0.5), taught(seconds=0.5)
    for a, b in zip(first.samples, again.samples, strict=True):
        assert a.sent.tobytes() == b.sent.tobytes()
        assert a.world.joint_positions.tobytes() == b.world.joint_positions.tobytes()


def test_what_it_teaches_is_kept_in_a_file(tmp_path: Path) -> None:
    """As a session has it: an activity that follows, and drags that come between its ticks."""
    puppet = PuppetTeacher()
    path = tmp_path / "puppet.mcap"
    following = Follow(puppet, Pipeline.for_robot(load_robot(), "left"), path)
    stepping = iter(lambda: following.step() and puppet.skeleton, None)
    for _ in (*signed(puppet, stepping), *pushed(puppet, stepping, "left", -0.2)):
        pass
    following.close()
    following.world.close()
    recording = read_recording(path)
    assert recording.warning == ""
    assert len(demonstrations_of(recording, "puppet")) == 1
    assert recording.samples[-1].world.block_down


def test_it_is_a_teacher_like_the_others() -> None:
    teacher: Teacher = PuppetTeacher()
    wanted = {name for name in vars(Teacher) if not name.startswith("_")}
    assert {name for name in wanted if not hasattr(teacher, name)} == set()
    assert (teacher.seconds, teacher.fresh) == (0.0, None)
    assert teacher.status().has_hand_states
    frames = list(islice(teacher.frames(), 4))
    assert [frame.time for frame in frames] == pytest.approx([0.0, 1 / 30, 2 / 30, 3 / 30])
    assert teacher.skeleton is frames[-1]


def test_it_obeys_while_nobody_follows() -> None:
    puppet, other = PuppetTeacher(), PuppetTeacher()
    target = from_shoulder("right", 0.3, 0.1, 0.1)
    for each in (puppet, other):
        each.drag_hand("right", target)
        each.sign("right", HandState.OPEN)
    for _ in range(60):
        puppet.idle()
    frames = list(islice(other.frames(), 60))
    assert np.array_equal(puppet.skeleton.positions, frames[-1].positions)
    assert puppet.skeleton.positions[Joint.HAND_RIGHT] == pytest.approx(target, abs=1e-3)
    assert puppet.memory.sign("right") is HandState.OPEN


def test_handles_stand_where_the_joints_are_going() -> None:
    puppet = PuppetTeacher()
    puppet.drag_hand("left", from_shoulder("left", 5.0, 0.0, 0.0))  # out of reach
    puppet.drag_elbow("left", from_shoulder("left", 0.0, 0.0, 5.0))
    for _ in range(150):
        puppet.idle()
    for side in SIDES:
        for part in ("hand", "elbow"):
            joint = Joint.of(part, side)
            assert puppet.goals[joint] == pytest.approx(puppet.skeleton.positions[joint], abs=1e-6)
    puppet.release_elbow("left")
    puppet.go_home()
    for _ in range(150):
        puppet.idle()
    start = PuppetTeacher().skeleton.positions
    assert puppet.skeleton.positions == pytest.approx(start, abs=1e-6)
