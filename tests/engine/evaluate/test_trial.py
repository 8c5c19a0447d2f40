"""A trial does what a performance does; early ends, saved plans and words change nothing of it."""

from dataclasses import replace

import numpy as np
import pytest

from studio.engine.evaluate import trial as trials
from studio.engine.evaluate.motion import motion_of, planner_of, replay_of
from studio.engine.evaluate.runs import Trial
from studio.engine.evaluate.trial import REFUSED, run_trial, why_not
from studio.engine.evaluate.variation import Variations, draw
from studio.engine.performance import perform, rows_as_trajectory, start_world
from studio.engine.pipeline import ready_pose
from studio.engine.scene import Scene
from tests.engine.evaluate.swings import SECONDS, WIDTHS, conditions, scene, swing
from tests.engine.sweeps import samples

NOTHING = draw(Variations().only(()), 0, 0, 4, Scene())


def test_undisturbed_a_good_demonstration_does_the_task_and_ends_as_its_performance() -> None:
    taught = samples(1)
    shown, rows = taught.demonstrations[0], taught.rows[0]
    motion = replay_of("shown", shown, rows, Scene())
    alone = perform(rows_as_trajectory(rows, shown.duration), shown.duration, "left", "exact")
    assert alone.done
    assert run_trial(motion, Scene(), NOTHING).done
    sent = np.array([tick.command.sent for tick in alone.ticks])
    # Both begin within a tick's way of each other: the plan at the beginning itself.
    assert np.abs(sent - motion.sent).max() < 1e-9
    assert motion.guarded == alone.guarded_ticks


def test_a_sabotaged_motion_fails_nearly_always() -> None:
    wrong = swing("wrong way", 0.6)
    found = [Trial(wrong, number, conditions()).run() for number in range(2)]
    assert not any(outcome.done for outcome in found)
    assert {outcome.why for outcome in found} == {"the block has not been touched by a taught arm"}


def test_an_early_end_changes_no_outcome(monkeypatch) -> None:
    chosen = range(1, 4)
    early = [Trial(swing(), number, conditions()).run() for number in chosen]
    assert len({outcome.done for outcome in early}) == 2  # it ends early in some of them
    monkeypatch.setattr(trials, "_ticks_of", lambda _: 10**9)  # the motion is never over
    assert [Trial(swing(), number, conditions()).run() for number in chosen] == early


def test_a_plan_that_was_saved_is_the_plan_that_would_be_made() -> None:
    motion, moved = swing(), draw(WIDTHS, 0, 3, 4, scene())
    planner = planner_of(motion, scene())
    start = planner.ready + moved.start
    way, sent = trials._planned(motion, planner, start)
    planned = list(planner.steps(motion.trajectory, motion.duration, start))
    assert way > 0
    assert np.array_equal(sent, [planner.all_sent(step) for step in planned])
    unplanned = replace(motion, sent=np.empty((0, 0)))
    begin = planner.begin(motion.trajectory, start)
    assert np.array_equal(sent[way - 1], begin)  # so the saved plan was used
    assert np.array_equal(
        motion.sent,
        [planner.all_sent(s) for s in planner.motion(unplanned.trajectory, SECONDS, begin)],
    )


def test_what_the_guard_refuses_is_a_failure_with_that_reason() -> None:
    into_the_desk = ready_pose("left", "exact") + np.array([0.0, 1.5, 0.0, 0.0])
    rows = np.array([into_the_desk, into_the_desk])
    motion = motion_of(
        "low", rows_as_trajectory(rows, SECONDS), SECONDS, "left", "exact", None, Scene()
    )
    assert run_trial(motion, Scene(), NOTHING) == trials.Outcome(False, REFUSED)


def test_start_noise_and_latency_reach_the_world(monkeypatch) -> None:
    told = []

    def watched(world, arms, sent, options, hands):
        told.append(sent)
        return plain(world, arms, sent, options, hands)

    plain = trials.send
    monkeypatch.setattr(trials, "send", watched)
    drawn = draw(replace(Variations().only(("noise", "latency")), latency=5), 1, 2, 4, scene())
    assert drawn.latency > 0
    run_trial(swing(), scene(), drawn)
    newest = drawn.arrived(len(swing().sent))
    late = newest[newest >= 0]
    expected = swing().sent[late] + drawn.offsets(len(newest))[newest >= 0]
    assert np.allclose(told, expected[: len(told)])
    worlds = []
    monkeypatch.setattr(
        trials, "start_world", lambda *given: worlds.append(given) or start_world(*given)
    )
    moved = draw(Variations().only(("start", "block")), 1, 2, 4, scene())
    run_trial(swing(), scene(), moved)
    assert worlds[0][4] == pytest.approx(ready_pose("left", "exact") + moved.start)
    assert worlds[0][3] == moved.scene(scene())


def test_numbers_that_differ_each_time_are_left_out_of_the_reason() -> None:
    with start_world("left", "exact") as world:
        state = world.state
    outside = replace(state, missing="the block is 12 cm outside the zone")
    assert why_not(outside) == "the block is outside the zone"
    assert why_not(replace(outside, missing="the block is 0.1 cm outside the zone")) == why_not(
        outside
    )
    lifted = "the block has not been lifted by 5 cm"
    assert why_not(replace(state, missing=lifted)) == lifted
