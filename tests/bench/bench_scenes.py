"""How often each shipped scene's task is done: writes its table into docs/scenes.md.

Run it by ``python tests/bench/bench_scenes.py [--seeds 50] [--scenes NAME...]``: per seed the
demonstrator shows four takes, the network learns them, and Baxter does it alone. Two processes, a
seed at a time; all scenes over 50 seeds take about a quarter of an hour on a calm machine.
"""

import argparse
import re
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from studio.engine.demonstration import DemonstrationSet, demonstrations_of
from studio.engine.errors import NothingTaughtError
from studio.engine.follow import follow
from studio.engine.hands import HandOptions
from studio.engine.pipeline import Pipeline
from studio.engine.robot import load_robot
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.teaching import LearnerSettings, learn, reproduce

PAGE = Path(__file__).resolve().parents[2] / "docs" / "scenes.md"
TAKES = (1, 2, 3, 4)
COLUMNS = ("scene", "demonstrations done", "by take", "Baxter alone", "what was missing, how often")


@dataclass(frozen=True)
class Found:
    """What came of one seed."""

    shown: tuple[bool, ...]  # of each take
    alone: bool
    missing: tuple[str, ...]  # in words, of takes and of the reproduction


def main() -> None:
    """Measure, print the table, and put it into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--scenes", nargs="*", default=list(scene_names()))
    asked = parser.parse_args()
    table = f"| {' | '.join(COLUMNS)} |\n{'|---' * len(COLUMNS)}|\n"
    for name in asked.scenes:
        table += row(name, asked.seeds)
        print(table.splitlines()[-1], flush=True)
    if asked.scenes == list(scene_names()):
        text = PAGE.read_text()
        marked = re.compile(r"(<!-- scenes: begin -->\n).*?(<!-- scenes: end -->)", re.DOTALL)
        PAGE.write_text(marked.sub(lambda found: found[1] + table + found[2], text))


def row(name: str, seeds: int) -> str:
    """Return the table's row of one scene."""
    with ProcessPoolExecutor(2) as pool:
        found = list(pool.map(run, [name] * seeds, range(seeds)))
    by_take = [sum(each.shown[i] for each in found) for i in range(len(TAKES))]
    missing = Counter(words for each in found for words in each.missing)
    return (
        f"| `{name}` | {share(sum(by_take), seeds * len(TAKES))} | "
        f"{', '.join(map(str, by_take))} of {seeds} | "
        f"{share(sum(each.alone for each in found), seeds)} | {counted(missing)} |\n"
    )


def run(name: str, seed: int) -> Found:
    """Teach and reproduce a scene with one seed."""
    scene = read_scene(name)
    hands = HandOptions(scene.gripper, scene.wrist)
    shown, missing, demonstrations = [], [], []
    for take in TAKES:
        pipeline = Pipeline.for_robot(load_robot(), scene.arms, hands=hands, scene=scene)
        recording = follow(demonstrate(seed, take, scene=scene), pipeline, scene)
        last = recording.samples[-1].world
        shown.append(last.done)
        missing.append(last.missing)
        demonstrations += demonstrations_of(recording, str(take))
    try:
        performance = reproduce(learn(DemonstrationSet.of(demonstrations), LearnerSettings()))
    except NothingTaughtError:
        return Found(tuple(shown), False, (*missing, "nothing was taught"))
    alone = performance.performance
    words = [*missing, alone.missing and f"alone: {alone.missing}"]
    return Found(tuple(shown), alone.done, tuple(plain(each) for each in words if each))


def plain(words: str) -> str:
    """Return a reason without its distance, so that like ones count together."""
    return re.sub(r"is \d+ cm outside", "is outside", words)


def share(count: int, of: int) -> str:
    """Return a count as people read it."""
    return f"{count} of {of} ({100 * count / of:.0f} %)"


def counted(missing: Counter[str]) -> str:
    """Return reasons, the most frequent first."""
    found: Sequence[tuple[str, int]] = missing.most_common()
    return "; ".join(f"{words} ({count})" for words, count in found) or "nothing"


if __name__ == "__main__":
    main()
