"""Outcomes that are made up, so that rates and tables can be tested without a simulation."""

from studio.engine.evaluate.evaluation import Evaluation, Tested
from studio.engine.evaluate.grid import Cell, Grid, Network
from studio.engine.evaluate.trial import Outcome
from tests.engine.evaluate.swings import conditions, swing

STANDS = Outcome(False, "the block still stands")


def made_up(name: str, pattern: str) -> Tested:
    """Return outcomes: + where the task was done, - where it was not."""
    done = Outcome(True, "")
    return Tested(swing(name), tuple(done if each == "+" else STANDS for each in pattern))


def evaluation() -> Evaluation:
    replays = (made_up("demonstration 1", "++-+"), made_up("demonstration 2", "+---"))
    return Evaluation(conditions(), made_up("model", "+++-++-+-+++"), replays)


def grid(**patterns: str) -> Grid:
    """Return a grid of learners, whose networks of 1, 2, 4 ... neurons succeed that often of 20."""
    cells = []
    for learner, rates in patterns.items():
        for place, successes in enumerate(map(int, rates.split())):
            pattern = "+" * successes + "-" * (20 - successes)
            neurons = 2**place
            ratio = 1.0 + 8.0 / neurons
            shown = Network(learner, neurons, ratio, swing(f"{learner} {neurons}"))
            cells.append(Cell(shown, made_up(f"{learner} {neurons}", pattern)))
    replays = (made_up("demonstration 1", "+" * 20), made_up("demonstration 2", "+" * 18 + "--"))
    return Grid(conditions(), tuple(cells), replays)
