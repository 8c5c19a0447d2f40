"""How many neurons the task needs: the answer, and the networks that it is about."""

from dataclasses import replace

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.evaluate.evaluation import pooled
from studio.engine.evaluate.grid import (
    COUNTS,
    LEARNERS,
    Grid,
    evaluate_grid,
    networks,
    replays_of,
)
from studio.engine.scene import Scene
from studio.engine.teaching import LearnerSettings, learn, model_as_trajectory
from tests.engine.evaluate.made_up import grid, made_up
from tests.engine.evaluate.swings import conditions, swing
from tests.engine.sweeps import samples


def test_the_smallest_count_whose_interval_reaches_the_demonstrations_is_the_answer() -> None:
    found = grid(rbf="0 8 17 20")
    rate, _, _ = pooled(found.replays)
    assert rate == 0.95
    cells = found.of("rbf")
    assert [cell.tested.rate.high >= rate for cell in cells] == [False, False, False, True]
    assert found.needed("rbf") is cells[3]
    assert found.answer("rbf") == (
        "8 neurons do the task: 100 % (83.9 to 100 %), 20 of 20, beside the demonstrations' own "
        "95 %; the error is then 2 times its floor"
    )


def test_a_larger_network_that_is_worse_again_is_said() -> None:
    assert grid(rbf="20 0 20").answer("rbf").startswith("1 neuron does the task")
    assert grid(rbf="20 0 20").answer("rbf").endswith("; 2 do worse again")


def test_none_may_be_enough() -> None:
    found = grid(newrb="0 1 2")
    assert found.needed("newrb") is None
    assert found.answer("newrb") == (
        "up to 4 neurons are not enough: none reaches the demonstrations' own 95 %"
    )


def test_a_network_that_never_does_the_task_is_not_said_to_do_it() -> None:
    replays = (made_up("demonstration 1", "++---"),)
    cells = grid(rbf="0 20").cells
    few = [made_up("rbf 1", "-----"), made_up("rbf 2", "+++++")]
    assert few[0].rate.high > replays[0].rate.value  # of 5 trials an interval is that wide
    pairs = zip(cells, few, strict=True)
    found = Grid(conditions(), tuple(replace(cell, tested=one) for cell, one in pairs), replays)
    assert found.needed("rbf").network.neurons == 2


def test_where_no_replay_does_the_task_there_is_nothing_to_reach() -> None:
    found = replace(grid(rbf="0 20"), replays=(made_up("demonstration 1", "----"),))
    assert found.needed("rbf") is None
    assert found.answer("rbf") == (
        "no demonstration's own replay does the task, so there is nothing to reach"
    )


def test_a_network_whose_interval_alone_reaches_the_rate_is_not_said_to_do_as_well() -> None:
    words = grid(rbf="0 18").answer("rbf")
    assert words.startswith("2 neurons are not shown to do worse with 20 trials: 90 % (")
    assert grid(rbf="18").answer("rbf").startswith("1 neuron is not shown to do worse with 20")


def test_networks_are_those_that_are_learned_elsewhere() -> None:
    taught = samples(2)
    shown = networks(taught, Scene(), ("rbf", "gcv"), (10, 3), jobs=1)
    assert [(each.learner, each.neurons) for each in shown] == [
        ("rbf", 3),
        ("rbf", 10),
        ("gcv", 3),
        ("gcv", 10),
    ]
    lesson = learn(taught, LearnerSettings("rbf", 10))
    assert shown[1].floor_ratio == pytest.approx(lesson.mse.sum() / lesson.floor.sum())
    at = model_as_trajectory(lesson.model, taught.duration)
    assert shown[1].motion.trajectory(1.0) == pytest.approx(at(1.0))
    assert len({each.motion.name for each in shown}) == 4
    assert [each.name for each in replays_of(taught, Scene())] == [
        "demonstration 1",
        "demonstration 2",
    ]


def test_learners_without_neurons_and_impossible_numbers_are_refused() -> None:
    with pytest.raises(StudioError, match="spline has no neurons to count; choose of newrb, rbf"):
        networks(samples(2), Scene(), ("spline",), (3,))
    with pytest.raises(StudioError, match="neurons: 1 to"):
        networks(samples(2), Scene(), ("rbf",), (0,))


def test_a_grid_is_done_beside_the_demonstrations() -> None:
    shown = grid(rbf="1 1").cells
    found = evaluate_grid([cell.network for cell in shown], [swing()], conditions(), 2, jobs=1)
    assert [len(cell.tested.outcomes) for cell in found.cells] == [2, 2]
    # All these motions are the same swing under other names.
    assert {cell.tested.outcomes for cell in found.cells} == {found.replays[0].outcomes}
    with pytest.raises(StudioError, match="beside demonstrations: give recordings"):
        evaluate_grid([cell.network for cell in shown], [], conditions(), 2)


def test_the_usual_numbers_are_about_even_on_a_logarithmic_scale() -> None:
    assert (COUNTS[0], COUNTS[-1]) == (1, 150)
    assert max(np.diff(np.log(COUNTS[1:]))) < np.log(2.0)
    assert LEARNERS[:2] == ("rbf", "newrb")
