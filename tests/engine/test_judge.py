"""When a task is done: judged from poses and touches alone."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.judge import NOBODY, Judge, JudgeMemory, Sight, lowest_of
from studio.engine.scene import Block, Scene, Zone
from studio.engine.success import Down, InZone, Lifted, Success
from studio.engine.world_state import REST_TICKS, BlockWatch, Verdict

TOP = Scene().desk.top
LEFT = frozenset({"left"})
A = Block((0.1, 0.1, 0.2), (0.7, 0.3, TOP + 0.1), 0.3, 0.5, "tower")
B = Block((0.1, 0.1, 0.1), (0.7, 0.0, TOP + 0.05), 0.3, 0.5, "cube")
ZONE = Zone("mat", (0.8, 0.4), (0.2, 0.1))


def scene(*conditions, in_order: bool = False, **changes) -> Scene:
    success = Success(conditions, in_order)
    return Scene(blocks=(A, B), zones=(ZONE,), success=success, **changes)


def sight(block: Block, at=None, lean: float = 0.0, touching=NOBODY, speed: float = 0.0) -> Sight:
    """Return a block somewhere, leaning to the left."""
    turn = [math.sin(lean / 2), 0.0, 0.0, math.cos(lean / 2)]
    return Sight(np.array([*(at or block.position), *turn]), speed, 0.0, touching)


def judged(judge: Judge, *ticks: list[Sight], memory: JudgeMemory | None = None) -> Verdict:
    """Return the verdict after ticks, each of which lasts until all that rests is at rest."""
    memory = memory or judge.start()
    for sights in ticks:
        for _ in range(REST_TICKS):
            memory, verdict = judge.step(memory, sights)
    return verdict


FALLEN = {"at": (0.7, 0.3, TOP + 0.05), "lean": math.pi / 2}
DOWN = sight(A, **FALLEN, touching=LEFT)


@given(
    st.lists(
        st.tuples(st.booleans(), st.floats(0, 3), st.floats(0, 0.04), st.floats(0, 0.4)),
        min_size=1,
        max_size=40,
    )
)
@settings(deadline=None, derandomize=True)
def test_in_the_papers_scene_done_is_the_block_being_down(ticks) -> None:
    judge, watch = Judge.of(Scene()), BlockWatch()
    memory = judge.start()
    for touched, lean, speed, spin in ticks:
        seen = sight(Scene().blocks[0], lean=lean, touching=LEFT if touched else NOBODY)
        memory, verdict = judge.step(memory, [replace(seen, speed=speed, spin=spin)])
        watch = watch.step(touched, seen.pose, speed, spin)
        assert (verdict.task, verdict.done) == (watch, watch.down)
        assert verdict.done == (verdict.missing == "")


@pytest.mark.parametrize(
    ("seen", "missing"),
    [
        (sight(A), "the tower has not been touched by a taught arm"),
        (sight(A, **FALLEN), "the tower fell without having been touched by a taught arm"),
        (sight(A, touching=LEFT), "the tower still stands"),
        (replace(DOWN, speed=0.1), "the tower still moves"),
        (DOWN, ""),
    ],
)
def test_a_block_is_down_when_it_was_touched_leans_and_rests(seen: Sight, missing: str) -> None:
    judge = Judge.of(scene(Down("tower")))
    assert judge.watched == (0,)
    assert judged(judge, [seen]).missing == missing


MAT = (*ZONE.center, TOP + 0.05)


@pytest.mark.parametrize(
    ("at", "touching", "missing"),
    [
        ((0.8, 0.55, TOP + 0.05), LEFT, "the cube is 10 cm outside the mat"),
        ((*ZONE.center, TOP + 0.15), LEFT, "the cube is not on the desk"),
        ((*ZONE.center, 0.05), LEFT, "the cube is not on the desk"),
        (MAT, LEFT, "the cube is still held"),
        (MAT, NOBODY, ""),
    ],
)
def test_a_block_is_set_into_a_zone_when_it_lies_there_and_nobody_holds_it(
    at, touching, missing: str
) -> None:
    judge = Judge.of(scene(InZone("cube", "mat", released=True)))
    assert judge.watched == (0, 1)  # the first is the one whose tilt people see
    ticks = [[sight(A), sight(B, touching=LEFT)], [sight(A), sight(B, at, touching=touching)]]
    assert judged(judge, *ticks).missing == missing
    held = Judge.of(scene(InZone("cube", "mat")))
    assert judged(held, *ticks).done == (missing in ("", "the cube is still held"))


def test_a_lift_is_remembered_and_counts_only_while_an_arm_holds_the_block() -> None:
    judge = Judge.of(scene(Lifted("cube", 0.08)))
    high = (0.7, 0.0, TOP + 0.05 + 0.09)
    touched = [sight(A), sight(B, touching=LEFT)]
    thrown = [sight(A), sight(B, high)]
    held = [sight(A), sight(B, high, touching=LEFT)]
    assert judged(judge, touched, thrown).missing == "the cube has not been lifted by 8 cm"
    assert judged(judge, touched, held, [sight(A), sight(B)]).done


def test_the_order_is_judged_by_what_came_first() -> None:
    first, second = Down("tower"), InZone("cube", "mat")
    any_order, in_order = (Judge.of(scene(first, second, in_order=o)) for o in (False, True))
    pushed = sight(B, MAT, touching=LEFT)
    right = [[DOWN, sight(B)], [DOWN, pushed]]
    wrong = [[sight(A), pushed], [DOWN, pushed]]
    assert judged(any_order, *right).done
    assert judged(any_order, *wrong).done
    assert judged(in_order, *right).done
    told = judged(in_order, *wrong).missing
    assert told.startswith("too early: bring the cube into the mat only after")
    assert judged(in_order, right[0]).missing == "the cube has not been touched by a taught arm"


FALLING = {"lean": math.radians(75), "touching": LEFT, "speed": 0.5}


def test_the_order_is_that_of_falling_whichever_comes_to_rest_first() -> None:
    """Two roads: the same two falls, and either block the one that rolls on for longer."""
    judge = Judge.of(scene(Down("tower"), Down("cube"), in_order=True))
    standing, down = (sight(A), sight(B)), (DOWN, sight(B, lean=math.pi / 2))
    falls = (sight(A, **FALLING), sight(B, **FALLING))
    for first, second in ((0, 1), (1, 0)):
        for longer in (0, 1):
            ticks = [list(standing) for _ in range(4)]
            for moment in range(1, 4):
                ticks[moment][first] = falls[first]
            for moment in range(2, 4):
                ticks[moment][second] = falls[second]
            ticks[3][1 - longer] = down[1 - longer]
            verdict = judged(judge, *ticks, list(down))
            in_time = (first, second) == (0, 1)
            assert verdict.done == in_time, (first, longer)
            assert verdict.missing.startswith("too early: push the cube down only") != in_time
            assert not judged(judge, *ticks).done  # one of them still moves


def test_nothing_is_too_early_for_what_falls_and_has_not_come_to_rest() -> None:
    judge = Judge.of(scene(Down("tower"), Down("cube"), in_order=True))
    rolls, lies = sight(A, **FALLING), sight(B, lean=math.pi / 2, touching=LEFT)
    assert judged(judge, [rolls, sight(B)], [rolls, lies]).missing == "the tower still moves"


def test_what_bounces_fell_when_it_first_did_and_what_stands_again_falls_anew() -> None:
    judge = Judge.of(scene(Down("tower"), Down("cube"), in_order=True))
    falls, back = sight(A, **FALLING), sight(A, lean=math.radians(50), speed=0.5)
    both = sight(B, lean=math.pi / 2, touching=LEFT)
    start = [sight(A), sight(B)]
    assert judged(judge, start, [falls, sight(B)], [back, both], [DOWN, both]).done
    stands = [sight(A), sight(B)]
    told = judged(judge, start, [falls, sight(B)], stands, [sight(A), both], [DOWN, both])
    assert told.missing.startswith("too early")


def test_what_passes_through_a_zone_has_not_come_there() -> None:
    judge = Judge.of(scene(Down("tower"), InZone("cube", "mat"), in_order=True))
    through = sight(B, MAT, touching=LEFT, speed=0.5)
    beyond = sight(B, (0.8, 0.6, TOP + 0.05))
    lies = sight(B, MAT)
    ticks = [[sight(A), through], [sight(A), beyond], [DOWN, beyond], [DOWN, lies]]
    assert judged(judge, *ticks[:1]).missing.startswith("too early")
    assert judged(judge, *ticks).done


@pytest.mark.parametrize(
    ("condition", "other"),
    [
        (Down("tower"), {"lean": math.pi / 2}),
        (InZone("cube", "mat"), {"at": MAT}),
        (InZone("cube", "mat", released=True), {"at": MAT}),
    ],
)
def test_a_touch_after_it_came_about_by_itself_is_nothing_that_was_taught(condition, other) -> None:
    block, number = (A, 0) if condition.block == "tower" else (B, 1)

    def seen(**changes) -> list[Sight]:
        return [sight(block, **changes) if i == number else sight((A, B)[i]) for i in (0, 1)]

    judge = Judge.of(scene(condition))
    there = [seen(**other), seen(**other, touching=LEFT), seen(**other)]
    told = judged(judge, *(each[: len(judge.watched)] for each in there))
    assert told.missing in (
        "the tower fell without having been touched by a taught arm",
        "the cube was in the mat without having been touched by a taught arm",
    )
    assert not told.task.down
    again = [*there, seen(), seen(**other)]  # taken away, and brought about once more
    assert judged(judge, *(each[: len(judge.watched)] for each in again)).done


def test_an_arm_that_comes_too_late_has_not_done_it_for_the_other() -> None:
    conditions = (Down("tower", "left"), Down("cube", "right"))
    judge = Judge.of(scene(*conditions, arms="both", both_arms=True))
    right = frozenset({"right"})
    wrong = sight(B, lean=math.pi / 2, touching=LEFT)
    late = replace(wrong, touching=right)
    assert not judged(judge, [DOWN, wrong], [DOWN, late]).done


def test_what_was_fulfilled_once_has_to_hold_in_the_end() -> None:
    judge = Judge.of(scene(Down("tower"), InZone("cube", "mat"), in_order=True))
    pushed = sight(B, MAT, touching=LEFT)
    assert judged(judge, [DOWN, sight(B)], [sight(A), pushed]).missing == "the tower still stands"


def test_each_arm_has_its_own_block() -> None:
    conditions = (Down("tower", "left"), Down("cube", "right"))
    judge = Judge.of(scene(*conditions, arms="both", both_arms=True))
    right = frozenset({"right"})
    fallen = sight(B, lean=math.pi / 2, touching=LEFT)
    missing = "the cube fell without having been touched by the right arm"
    assert judged(judge, [DOWN, fallen]).missing == missing
    assert judged(judge, [DOWN, replace(fallen, touching=right)]).done


def test_zones_of_the_right_arm_lie_on_the_other_side() -> None:
    judge = Judge.of(scene(InZone("cube", "mat"), arms="right"))
    x, y, z = MAT
    right = frozenset({"right"})
    assert judged(judge, [sight(A), sight(B, (x, -y, z), touching=right)]).done
    assert not judged(judge, [sight(A), sight(B, (x, y, z), touching=right)]).done


def test_touches_are_asked_for_as_long_as_they_matter() -> None:
    plain = Judge.of(scene(Down("tower"), InZone("cube", "mat", released=True)))
    memory = plain.start()
    assert [plain.asks(memory, i) for i in (0, 1)] == [True, True]
    memory, _ = plain.step(memory, [sight(A, touching=LEFT), sight(B, touching=LEFT)])
    assert [plain.asks(memory, i) for i in (0, 1)] == [False, True]


@given(
    st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1),
    st.lists(st.floats(0.01, 1), min_size=3, max_size=3),
)
@settings(deadline=None, derandomize=True)
def test_the_lowest_corner_is_the_lowest_of_all_eight(turn, size) -> None:
    x, y, z, w = np.array(turn) / np.linalg.norm(turn)
    # The rotation's third row, by the textbook's matrix.
    up = np.array([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)])
    corners = np.array(np.meshgrid(*[(-s / 2, s / 2) for s in size])).reshape(3, 8)
    found = lowest_of(np.array([0.3, 0.2, 0.9, x, y, z, w]), tuple(size))
    assert found == pytest.approx(0.9 + (up @ corners).min())
