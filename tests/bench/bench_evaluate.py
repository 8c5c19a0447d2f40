"""How fast trials are, and how many neurons tasks need: writes both into docs/evaluate.md.

Run it by ``PYTHONPATH=. python tests/bench/bench_evaluate.py FOLDER``; its 8,000 trials take some
ten minutes on two processors. What is broken off goes on in the same folder, but then the time that
it took is not told; ``--only speed`` leaves the long part out.
"""

import argparse
import json
import re
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from studio.engine.demonstration import DemonstrationSet
from studio.engine.evaluate.runs import Conditions, Trial
from studio.engine.evaluate.subject import subject_of_lesson
from studio.engine.evaluate.variation import Variations
from studio.engine.experiment import Setup, teach
from studio.engine.performance import perform, start_world
from studio.engine.planning import SETTLE
from studio.engine.resources import samples_folder
from studio.engine.teaching import LearnerSettings, learn

PAGE = Path(__file__).resolve().parents[2] / "docs" / "evaluate.md"
ROUNDS = 15
LEARNERS = ("rbf", "newrb", "gcv")
MANY = 1000


def main() -> None:
    """Measure, print, and put it into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", choices=("speed", "tables"))
    given = parser.parse_args()
    if given.only != "tables":
        put("speed", speed())
    if given.only != "speed":
        put("thousand", thousand(given.folder / "thousand"))
        put("neurons", neurons(given.folder / "neurons"))
        put("zone", zone(given.folder / "zone"))


def speed() -> str:
    """Return how long a trial takes beside what it could be done by otherwise.

    Processor seconds of one process, the two sides in turn, so that it matters little what else
    the machine does.
    """
    taught = DemonstrationSet.of(
        teach(sorted(samples_folder().glob("*.mcap")), Setup()).demonstrations
    )
    lesson = learn(taught, LearnerSettings("rbf", 50))
    subject, conditions = (
        subject_of_lesson(lesson, taught.scene),
        Conditions(taught.scene, Variations(), 0),
    )
    trials, performances, worlds = [], [], []
    for number in range(ROUNDS):
        one = Trial(subject.motion, number, conditions)
        trials.append(seconds(one.run))
        performances.append(
            seconds(lambda: perform(lesson.trajectory(), taught.duration, "left", "exact"))
        )
        worlds.append(seconds(lambda: start_world("left", "exact").close()))
    trial, whole, world = min(trials), min(performances), min(worlds)
    simulated = taught.duration + SETTLE
    return (
        "| of one trial | |\n|---|---|\n"
        f"| simulated, at most | {simulated:.1f} s |\n"
        f"| computed | {trial:.3f} s: {simulated / trial:.0f} times as fast as real time |\n"
        f"| of that the fresh world | {world:.3f} s |\n"
        f"| a performance as in *4 Compare* | {whole:.3f} s: {whole / trial:.1f} times as long |\n"
    )


def seconds(do: Callable[[], object]) -> float:
    """Return how much processor time something takes [s]."""
    begin = time.process_time()
    do()
    return time.process_time() - begin


def thousand(folder: Path) -> str:
    """Return what a thousand trials of one network come to, and how long they take."""
    fresh, before = not folder.exists(), resource.getrusage(resource.RUSAGE_CHILDREN)
    evaluate(folder, "--trials", str(MANY), "--replays", "200")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    busy = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    found = json.loads((folder / "evaluation.json").read_text())
    rows = [found["model"], *found["demonstrations"]]
    table = "| who | trials | success | 95 % interval |\n|---|---|---|---|\n" + "".join(
        f"| {row['name']} | {row['trials']} | {100 * row['rate']:.3g} % | "
        f"{100 * row['low']:.3g} to {100 * row['high']:.3g} % |\n"
        for row in rows
    )
    if not fresh:
        return table
    count = sum(row["trials"] for row in rows)
    return (
        f"{table}\nThese {count:,} trials took {busy:.0f} s of processors, all in all: "
        f"{busy / 120:.1f} minutes on two that have nothing else to do.\n"
    )


def neurons(folder: Path) -> str:
    """Return the table of networks that the samples teach; the picture goes beside the page."""
    evaluate(folder, "--learner", *LEARNERS)
    shutil.copy(folder / "evaluation.svg", PAGE.with_suffix(".svg"))
    return (folder / "evaluation.md").read_text()


def zone(folder: Path) -> str:
    """Return the same of a task that is harder, shown by the demonstrator."""
    recordings = folder / "recordings"
    if not recordings.exists():
        studio("demo", "--headless", "--scene", "push-into-zone", "--save", str(recordings))
    given = map(str, sorted(recordings.glob("*.mcap")))
    evaluate(folder / "evaluation", *given, "--learner", "rbf", "newrb", "--trials", "50")
    picture = PAGE.with_name("evaluate-zone.svg")
    shutil.copy(folder / "evaluation" / "evaluation.svg", picture)
    return (folder / "evaluation" / "evaluation.md").read_text()


def evaluate(folder: Path, *arguments: str) -> None:
    """Evaluate, and keep what comes of it in a folder."""
    studio("evaluate", *arguments, "--out", str(folder))


def studio(*arguments: str) -> None:
    """Run a command of the studio."""
    command = [sys.executable, "-m", "studio", *arguments]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def put(name: str, text: str) -> None:
    """Print a text, and put it between its marks on the page."""
    print(text)
    page = PAGE.read_text()
    marked = re.compile(rf"(<!-- {name}: begin -->\n).*?(<!-- {name}: end -->)", re.DOTALL)
    PAGE.write_text(marked.sub(lambda found: found[1] + text + found[2], page))


if __name__ == "__main__":
    main()
