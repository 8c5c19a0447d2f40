"""What a control tick costs, beside inverse kinematics by mink: writes docs/advance.md's tables.

Run it by ``python tests/bench/bench_advance.py``, with the extra "bench" installed; it takes two
minutes. The recordings of real people are used where they lie beside the repository.

mink (https://github.com/kevinzakka/mink) is a library that one would pick instead: a quadratic
program a step, on MuJoCo's kinematics. It gets the smallest problem that does the work: of our own
description only the driven joints turn, its targets are the elbow and the wrist at Baxter's link
lengths, seen from its own shoulder, and only its step is timed, not the making of the targets.
"""

import argparse
import re
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree import ElementTree

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray

from studio.engine.arms import Arms, driven_joints, resting_body, sides_of
from studio.engine.errors import FileError
from studio.engine.human import ArmVectors, arm_vectors
from studio.engine.limits import Command
from studio.engine.pipeline import Pipeline, ready_pose
from studio.engine.reach import Reach, ReachMemory
from studio.engine.retarget import solve_arm
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES, load_robot, urdf_without_visuals
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.sources import SkeletonRecording, read_skeletons
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.vectors import Vector, norm

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "advance.md"
REAL = ROOT.parent / "shared" / "data" / "kinect"
ITERATIONS = (1, 5, 20)
CHOICES: tuple[Arms, Arms] = ("left", "both")
# Of the joints' centers [m], from Rethink Robotics' description; see studio.engine.retarget.
UPPER_ARM, FOREARM = norm((0.36442, 0.0, -0.069)), norm((0.37429, 0.0, -0.010))
LARGEST_SHARE, LONGEST_ADVANCE = 1 / 20, 200e-6  # the bars: of mink's one step; [s]
DAMPING = 1e-3  # of mink's tasks; from 0 to 0.1 it makes no difference here
SHOULDER, ELBOW, WRIST = "lower_shoulder", "lower_elbow", "lower_forearm"  # links, by their origins
ADVANCE, UNGUARDED = "`advance()`, the whole tick", "`advance()` without the collision guard"
RETARGET, REACH = "its retarget stage: the mapping", "the same with limits and holds (reach)"
HEAD = (
    "| | µs a frame | of mink's step | upper arm | forearm | wrist | beyond: upper arm | forearm "
    "| wrist |\n|---|---|---|---|---|---|---|---|---|\n"
)

Arm = tuple[Vector, Vector]  # upper arm and forearm, unit vectors in the torso's frame
Angles = Sequence[float]  # [rad] of the driven joints
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Seen:
    """One frame: the skeleton, and the driven arms' directions in it."""

    skeleton: Skeleton
    arms: tuple[Arm, ...]


@dataclass(frozen=True)
class Unguarded:
    """Stands in the guard's place and lets everything through."""

    def keep(self, before: FloatArray, command: Command, elapsed: float) -> Command:
        """Return the command."""
        return command


def main() -> None:
    """Measure, print, and put the tables into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    repeats = parser.parse_args().repeats
    text = PAGE.read_text()
    for arms in CHOICES:
        table = measured(arms, people(arms), repeats)
        print(f"{arms}\n{table}", flush=True)
        marked = re.compile(rf"(<!-- {arms}: begin -->\n).*?(<!-- {arms}: end -->)", re.DOTALL)
        text = marked.sub(lambda found, table=table: found[1] + table + found[2], text)
    PAGE.write_text(text)


def people(arms: Arms) -> list[list[Seen]]:
    """Return every recording's frames in which the arms are seen, with their directions."""
    found = []
    for recording in recordings():
        frames = []
        for skeleton in recording:
            seen = [arm_vectors(skeleton, side) for side in sides_of(arms)]
            known = [directions(each) for each in seen if isinstance(each, ArmVectors)]
            if len(known) == len(seen):
                frames.append(Seen(skeleton, tuple(known)))
        found.append(frames)
    return found


def directions(seen: ArmVectors) -> Arm:
    """Return the arm in the torso's frame."""
    return seen.torso.from_camera(seen.upper_arm), seen.torso.from_camera(seen.forearm)


def recordings() -> Iterator[SkeletonRecording]:
    """Yield three takes of the demonstrator, and the real recordings where there are any."""
    yield from (demonstrate(0, take) for take in (1, 2, 3))
    for path in sorted(REAL.rglob("*")):
        if path.is_file() and path.suffix != ".md":
            try:
                yield read_skeletons(path)
            except FileError as error:
                print(f"left out: {error}")


def measured(arms: Arms, groups: list[list[Seen]], repeats: int) -> str:
    """Return the table and a sentence on each bar."""
    frames = [seen for group in groups for seen in group]
    small, whole = Mink(arms, driven_joints(arms)), Mink(arms, JOINT_NAMES)
    ways: dict[str, Callable[[], tuple[float, list[Angles]]]] = {
        ADVANCE: lambda: advance(arms, groups, guarded=True),
        UNGUARDED: lambda: advance(arms, groups, guarded=False),
        REACH: lambda: reach(arms, frames),
        RETARGET: lambda: mapping(arms, frames),
        **{mink_name(n): lambda n=n: small.follow(frames, n) for n in ITERATIONS},
        "mink, 1 iteration, all 15 joints": lambda: whole.follow(frames, 1),
    }
    cost = dict.fromkeys(ways, np.inf)
    answers: dict[str, list[Angles]] = {}
    for _ in range(repeats):  # in turn, so that all share what the machine does meanwhile
        for name, way in ways.items():
            seconds, answers[name] = way()
            cost[name] = min(cost[name], seconds / len(frames))
    one, limits = cost[mink_name(1)], load_robot().limits_of(driven_joints(arms))
    free = np.array(answers[RETARGET])
    inside = ((free >= limits.lower) & (free <= limits.upper)).all(axis=1)
    table = (
        f"{len(frames)} frames of {len(groups)} recordings, {100 * inside.mean():.0f} % of them "
        f"inside Baxter's limits.\n\n{HEAD}"
    )
    for name in ways:
        off = " | " * 5
        if answers[name]:
            off = " | ".join(
                errors(arms, frames, answers[name], where) for where in (inside, ~inside)
            )
        table += f"| {name} | {1e6 * cost[name]:.1f} | {cost[name] / one:.3f} | {off} |\n"
    return f"{table}\n{verdict(cost[RETARGET] / one, cost[ADVANCE])}"


def verdict(share: float, seconds: float) -> str:
    """Return whether the bars are met, in words."""
    stage = "" if share <= LARGEST_SHARE else " **missed**"
    whole = "" if seconds <= LONGEST_ADVANCE else " **missed**"
    return (
        f"Retarget stage: 1/{1 / share:.0f} of mink's step; bar: 1/20 or less{stage}. "
        f"`advance()`: {1e6 * seconds:.0f} µs; bar: 200 µs or less{whole}.\n"
    )


def mink_name(iterations: int) -> str:
    """Return the row's name."""
    return f"mink, {iterations} iteration{'s' * (iterations > 1)}"


def advance(arms: Arms, groups: list[list[Seen]], guarded: bool) -> tuple[float, list[Angles]]:
    """Return the time [s] of the whole tick; its answer is smoothed and limited, so none here."""
    pipeline = Pipeline.for_robot(load_robot(), arms, "exact", "open")
    if not guarded:
        pipeline = replace(pipeline, guard=Unguarded())
    start = time.process_time()
    for group in groups:
        memory = pipeline.start()
        for tick, seen in enumerate(group):
            memory, _ = pipeline.advance(memory, seen.skeleton, tick * CONTROL_PERIOD)
    return time.process_time() - start, []


def reach(arms: Arms, frames: list[Seen]) -> tuple[float, list[Angles]]:
    """Return time [s] and answers of mapping and position limits, the elbow solved anew."""
    stages = [Reach.for_robot(load_robot(), side, "exact") for side in sides_of(arms)]
    memories: list[ReachMemory | None] = [None] * len(stages)
    answers: list[Angles] = []
    start = time.process_time()
    for tick, seen in enumerate(frames):
        found: list[float] = []
        for index, stage in enumerate(stages):
            memories[index], angles = stage.step(
                memories[index], *seen.arms[index], tick * CONTROL_PERIOD
            )
            found += angles
        answers.append(found)
    return time.process_time() - start, answers


def mapping(arms: Arms, frames: list[Seen]) -> tuple[float, list[Angles]]:
    """Return time [s] and answers of the closed form alone."""
    sides = sides_of(arms)
    start = time.process_time()
    answers: list[Angles] = [
        [
            angle
            for side, arm in zip(sides, seen.arms, strict=True)
            for angle in solve_arm(*arm, side, "exact")
        ]
        for seen in frames
    ]
    return time.process_time() - start, answers


class Mink:
    """Follows elbow and wrist with mink: one position task each, and the joints' limits."""

    def __init__(self, arms: Arms, turning: Sequence[str]) -> None:
        self.sides = sides_of(arms)
        self.model = mujoco.MjModel.from_xml_string(description(turning))
        self.columns = [self.model.joint(name).qposadr[0] for name in driven_joints(arms)]
        self.start = np.zeros(self.model.nq)
        self.start[self.columns] = ready_pose(arms, "exact")
        self.limits = [mink.ConfigurationLimit(self.model)]
        self.tasks = {
            (side, link): mink.FrameTask(f"{side}_{link}", "body", 1.0, 0.0, lm_damping=DAMPING)
            for side in self.sides
            for link in (ELBOW, WRIST)
        }

    def follow(self, frames: list[Seen], iterations: int) -> tuple[float, list[Angles]]:
        """Return the time [s] of mink's steps, and its answers."""
        configuration = mink.Configuration(self.model, q=self.start)
        tasks, spent = list(self.tasks.values()), 0.0
        answers: list[Angles] = []
        for seen in frames:
            for _ in range(iterations):
                self._aim(configuration, seen)
                start = time.process_time()
                velocity = mink.solve_ik(
                    configuration, tasks, CONTROL_PERIOD, "daqp", limits=self.limits
                )
                configuration.integrate_inplace(velocity, CONTROL_PERIOD)
                spent += time.process_time() - start
            answers.append(configuration.q[self.columns].tolist())
        return spent, answers

    def _aim(self, configuration: mink.Configuration, seen: Seen) -> None:
        """Set the targets: the person's directions at Baxter's lengths, from its own shoulder."""
        for side, (upper_arm, forearm) in zip(self.sides, seen.arms, strict=True):
            shoulder = configuration.data.body(f"{side}_{SHOULDER}").xpos
            elbow = shoulder + UPPER_ARM * np.array(upper_arm)
            for link, place in ((ELBOW, elbow), (WRIST, elbow + FOREARM * np.array(forearm))):
                self.tasks[side, link].set_target(mink.SE3.from_translation(place))


def description(turning: Sequence[str]) -> str:
    """Return our description without meshes and shapes; only the named joints turn."""
    robot = ElementTree.fromstring(urdf_without_visuals())
    for link in robot.findall("link"):
        for shape in link.findall("collision"):
            link.remove(shape)
    for joint in robot.findall("joint"):
        if joint.get("name") not in turning:
            joint.set("type", "fixed")
    compiler = ElementTree.SubElement(ElementTree.SubElement(robot, "mujoco"), "compiler")
    compiler.set("fusestatic", "false")
    return ElementTree.tostring(robot, encoding="unicode")


def errors(arms: Arms, frames: list[Seen], answers: list[Angles], where: Mask) -> str:
    """Return how far the lines between the robot's joint centers are from the person's bones."""
    robot, angles = load_robot(), np.array(answers)[where]
    body = np.tile(resting_body(arms), (len(angles), 1))
    body[:, [robot.joint_index(name) for name in driven_joints(arms)]] = angles
    off: list[list[FloatArray]] = [[], [], []]
    for index, side in enumerate(sides_of(arms)):
        upper_arm, forearm = np.array([seen.arms[index] for seen in frames])[where].transpose(
            1, 0, 2
        )
        shoulder, elbow, wrist = (
            robot.forward_kinematics(f"{side}_{link}", body)[:, :3, 3]
            for link in (SHOULDER, ELBOW, WRIST)
        )
        off[0].append(between(elbow - shoulder, upper_arm))
        off[1].append(between(wrist - elbow, forearm))
        ideal = shoulder + UPPER_ARM * upper_arm + FOREARM * forearm
        off[2].append(1000.0 * np.linalg.norm(wrist - ideal, axis=1))
    return " | ".join(
        f"{np.median(each):.1f} / {np.percentile(each, 95):.1f}"
        for each in map(np.concatenate, off)
    )


def between(bones: FloatArray, directions: FloatArray) -> FloatArray:
    """Return the angles (n,) [deg] between bones (n, 3) and unit vectors (n, 3)."""
    cosine = (bones * directions).sum(axis=1) / np.linalg.norm(bones, axis=1)
    angles: FloatArray = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    return angles


if __name__ == "__main__":
    main()
