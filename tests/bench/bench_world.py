"""What a step of the simulated world costs, and whether it grows; writes docs/world.md's tables.

    PYTHONPATH=. python tests/bench/bench_world.py [speed] [parts] [memory] [--ticks 1000000]

Both arms sweep, the left one pushes the block down, and all is left to settle: our robot against
the one of Rethink Robotics' description as it comes (wheel example-robot-data), its meshes as
collision shapes, under the same motors, one after the other in one process. Of all runs the
quickest counts, in the processor's own time. Speed takes a minute, a million ticks a quarter of an
hour.
"""

import argparse
import re
import tempfile
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from unittest.mock import patch
from xml.etree import ElementTree

import pybullet

from studio.engine import commands, world_robot
from studio.engine.drawn import Parts
from studio.engine.pipeline import Pipeline
from studio.engine.robot import BASE_HEIGHT, CONTROL_RATE, description_folder, urdf_without_visuals
from studio.engine.scene import Scene
from studio.engine.session import Session
from studio.engine.silence import STDOUT, silenced
from studio.engine.tape import Tape
from studio.engine.world import SOLVER_ITERATIONS, SUBSTEPS, World
from tests.engine.motions import SETTLE, command, rows

PAGE = Path(__file__).resolve().parents[2] / "docs" / "world.md"
SCENE = Scene(arms="both")
USUAL_ITERATIONS = 50  # pybullet's
LEAST_EQUAL, LEAST_OWN = 2.0, 3.0  # the bars: times the real-time factor
LOOKS = (0.1, 0.5, 1.0)  # shares of the steps at which memory is read
COLUMNS = ("", "µs a tick", "real-time factor", "ours is faster by", "block down")
MB = 1e-6

Loader = Callable[[int, bool, bool], list[int]]
Targets = dict[str, float]


@dataclass(frozen=True)
class Contestant:
    """A robot, and how the engine is set for it."""

    name: str
    load: Loader
    iterations: int = SOLVER_ITERATIONS
    groups: bool = True  # whether what cannot meet is left out of the search for contacts


@dataclass
class Timed:
    """The processor's time spent in a function, while it is watched."""

    seconds: float = 0.0
    calls: int = 0

    @property
    def each(self) -> float:
        """[µs] a call."""
        return 1e6 * self.seconds / max(self.calls, 1)


def main() -> None:
    """Measure what is asked for, print it, and put it into the page."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("what", nargs="*", default=["speed", "parts", "memory"])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--ticks", type=int, default=1_000_000, help="control ticks, for memory")
    options = parser.parse_args()
    tables = {
        "speed": lambda: speed(options.repeats),
        "parts": parts,
        "memory": lambda: memory(options.ticks),
    }
    for name in options.what:
        table = tables[name]()
        print(f"{name}\n{table}", flush=True)
        marked = re.compile(rf"(<!-- {name}: begin -->\n).*?(<!-- {name}: end -->)", re.DOTALL)
        found = marked.sub(lambda at, table=table: at[1] + table + at[2], PAGE.read_text())
        PAGE.write_text(found)


def targets() -> list[Targets]:
    """Return what both arms are told, tick by tick, the time to settle included."""
    sides = zip(rows("sweep exact"), rows("sweep exact", "right"), strict=True)
    told = [command(left) | command(right, "right") for left, right in sides]
    return told + [told[-1]] * SETTLE


def speed(repeats: int) -> str:
    """Return the table of the contestants, and a line on each bar."""
    ours = Contestant("ours", world_robot.load_bodies)
    whole = Contestant("ours in one piece", in_one_piece)
    equal = Contestant("Rethink Robotics', the same settings", upstream)
    usual = Contestant(
        "Rethink Robotics', pybullet's own settings", upstream, USUAL_ITERATIONS, groups=False
    )
    contestants = (ours, whole, equal, usual)
    told = targets()
    best = dict.fromkeys(contestants, float("inf"))
    down: dict[Contestant, bool] = {}
    for _ in range(repeats):  # in turn, so that all share what the machine does meanwhile
        for each in contestants:
            seconds, down[each] = run(each, told)
            best[each] = min(best[each], seconds)
    table = f"| {' | '.join(COLUMNS)} |\n{'|---' * len(COLUMNS)}|\n"
    for each in contestants:
        tick = best[each] / len(told)
        table += (
            f"| {each.name} | {1e6 * tick:.0f} | {1 / (CONTROL_RATE * tick):.0f} | "
            f"{best[each] / best[ours]:.2f} | {'yes' if down[each] else 'no'} |\n"
        )
    return table + "\n" + verdict(best[equal] / best[ours], best[usual] / best[ours])


def verdict(equal: float, own: float) -> str:
    """Return whether the bars are met, in words."""
    return "".join(
        f"{what}: {ratio:.2f} x; bar: {bar:.0f} x or more{'' if ratio >= bar else ' **missed**'}.\n"
        for what, ratio, bar in (
            ("Equal settings", equal, LEAST_EQUAL),
            ("Each with its own", own, LEAST_OWN),
        )
    )


def run(contestant: Contestant, told: list[Targets]) -> tuple[float, bool]:
    """Return the time [s] of all commands and steps in a fresh world, and how it ended."""
    with world_of(contestant, told[0]) as world:
        start = process_time()
        for each in told:
            world.apply(each)
            world.step()
        return process_time() - start, world.state.block_down


@contextmanager
def world_of(contestant: Contestant, start: Targets) -> Iterator[World]:
    """Give a fresh world with a contestant's robot in it."""
    free = patch.object(pybullet, "setCollisionFilterGroupMask", lambda *_, **__: None)
    with patch.object(world_robot, "load_bodies", contestant.load):
        if contestant.groups:
            world = World(SCENE, start)
        else:
            with free:
                world = World(SCENE, start)
    with world:
        pybullet.setPhysicsEngineParameter(
            numSolverIterations=contestant.iterations, physicsClientId=world._client
        )
        yield world


def in_one_piece(client: int, _fingers: bool, _looks: bool) -> list[int]:
    """Load our own robot as one body."""
    return [loaded(client, urdf_without_visuals())]


def upstream(client: int, _fingers: bool, _looks: bool) -> list[int]:
    """Load Rethink Robotics' description without its looks, meshes as collision shapes."""
    folder = description_folder()
    if folder is None:
        raise SystemExit("the wheel example-robot-data is not installed")
    tree = ElementTree.parse(folder / "urdf" / "baxter.urdf").getroot()
    for link in tree.iterfind("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    for mesh in tree.iterfind("link/collision/geometry/mesh"):
        file = mesh.get("filename", "").removeprefix("package://")
        mesh.set("filename", str(folder.parents[2] / file))
    return [loaded(client, ElementTree.tostring(tree))]


def loaded(client: int, description: bytes) -> int:
    """Load a description as one body; it is not to chatter."""
    with tempfile.NamedTemporaryFile(suffix=".urdf") as file, silenced(STDOUT):
        file.write(description)
        file.flush()
        body: int = pybullet.loadURDF(
            file.name,
            basePosition=(0.0, 0.0, BASE_HEIGHT),
            useFixedBase=True,
            flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
            physicsClientId=client,
        )
    return body


def parts() -> str:
    """Return what commands, physics, read-out and snapshot cost, each for itself."""
    told = targets()
    with (
        watched(World, "apply") as told_apply,
        watched(world_robot.WorldRobot, "drive") as motors,
        watched(world_robot.WorldRobot, "press") as springs,
        watched(pybullet, "stepSimulation") as physics,
        watched(World, "_arms_that_touch") as touches,
        watched(World, "_observe") as read_out,
        world_of(Contestant("ours", world_robot.load_bodies), told[0]) as world,
    ):
        for each in told:
            world.apply(each)
            world.step()
    with (
        watched(Pipeline, "advance") as advance,
        watched(World, "step") as step,
        watched(Parts, "drawn") as snapshot,
        watched(Tape, "write") as file,
    ):
        whole = session_tick()
    listed = (
        ("command: `World.apply`, eight joints", told_apply.each, 1),
        ("motors: only those whose setpoint changed are told", motors.each, 1),
        ("springs, before each physics step", springs.each, SUBSTEPS),
        ("physics", physics.each, SUBSTEPS),
        ("who touches the block, until it was touched", touches.each, SUBSTEPS),
        ("read-out: joints, blocks, and what the task makes of them", read_out.each, 1),
    )
    table = "| of a tick of the world, both arms | µs a call | calls |\n|---|---|---|\n"
    table += "".join(f"| {name} | {each:.1f} | {calls} |\n" for name, each, calls in listed)
    table += "\n| of a tick of a session that follows a person, one arm | µs |\n|---|---|\n"
    in_session = (
        ("world", step.each),
        ("gate, arm, limits and guard", advance.each),
        ("snapshot", snapshot.each),
        ("the recording's file", file.each),
        ("the whole", whole),
    )
    return table + "".join(f"| {name} | {each:.0f} |\n" for name, each in in_session)


@contextmanager
def watched(owner: object, name: str) -> Iterator[Timed]:
    """Count and time what calls a function; the watching itself takes a third of a microsecond."""
    timed, inner = Timed(), getattr(owner, name)

    def call(*given: object, **named: object) -> object:
        start = process_time()
        found = inner(*given, **named)
        timed.seconds += process_time() - start
        timed.calls += 1
        return found

    with patch.object(owner, name, call):
        yield timed


def session_tick() -> float:
    """Return the mean time [µs] of a tick in which a session follows the demonstrator."""
    with tempfile.TemporaryDirectory() as folder, closing(Session(Path(folder))) as session:
        session.post(commands.UseDemonstrator())
        session.post(commands.Record())
        timed = Timed()
        session.tick()  # makes world and file
        for _ in range(300):
            start = process_time()
            session.tick()
            timed.seconds += process_time() - start
            timed.calls += 1
    return timed.each


def memory(ticks: int) -> str:
    """Return the memory of a process that lets many control ticks pass in one world."""
    told = targets()
    looks = {round(share * ticks) for share in LOOKS}
    table = (
        "| control ticks | physics steps | resident [MB] | by Python [MB] |\n|---|---|---|---|\n"
    )
    with world_of(Contestant("ours", world_robot.load_bodies), told[0]) as world:
        tracemalloc.start()
        for tick in range(1, ticks + 1):
            world.apply(told[tick % len(told)])
            world.step()
            if tick in looks:
                traced, _ = tracemalloc.get_traced_memory()
                steps = f"{tick:,} | {SUBSTEPS * tick:,}"
                table += f"| {steps} | {resident():.1f} | {MB * traced:.3f} |\n"
                print(table.splitlines()[-1], flush=True)
        tracemalloc.stop()
    return table


def resident() -> float:
    """Return the resident memory [MB] of this process."""
    status = Path("/proc/self/status").read_text()
    return int(status.partition("VmRSS:")[2].split()[0]) * 1024 * MB


if __name__ == "__main__":
    main()
