"""A performance in steps is the same as one in one go, and tells of itself on the way."""

import numpy as np

from studio.engine.perform import Perform
from studio.engine.scene import Scene
from tests.engine.lessons_at_hand import alone, lesson


def test_in_steps_it_comes_to_the_same_to_the_bit() -> None:
    stepped = Perform.of(lesson(), Scene())
    lengths = []
    while stepped.step():
        lengths.append(0 if stepped.performance is None else len(stepped.performance.ticks))
    stepped.world.close()
    found, whole = stepped.performance, alone()
    assert stepped.is_over
    assert lengths == sorted(lengths)
    assert lengths[-1] == len(whole.ticks)
    assert np.array_equal(found.start, whole.start)
    for mine, theirs in zip(found.ticks, whole.ticks, strict=True):
        assert mine.time == theirs.time
        assert np.array_equal(mine.world.joint_positions, theirs.world.joint_positions)
        assert np.array_equal(mine.world.block_poses, theirs.world.block_poses)


def test_on_the_way_to_where_the_motion_begins_there_is_no_performance_yet() -> None:
    away = np.array([0.6, 0.4, 0.0, 0.8])
    coming = Perform(lambda _: away, 0.1, "left", "exact")
    assert coming.performance is None
    coming.step()
    assert coming.performance is None
    while coming.performance is None:
        assert coming.step()
    coming.world.close()
    assert len(coming.performance.ticks) == 1
    assert coming.performance.ticks[0].time == 0.0


def test_what_the_guard_keeps_apart_is_told() -> None:
    away, into_the_desk = np.array([0.6, 0.4, 0.0, 0.8]), np.array([0.0, 1.0, 0.0, 0.0])
    playing = Perform(lambda time: into_the_desk if time > 0.0 else away, 1.0, "left", "exact")
    seen = {playing.guarded}
    while playing.step():
        seen.add(playing.guarded)
    playing.world.close()
    assert "" in seen
    assert any("desk: stopped" in words for words in seen)


def test_the_block_stands_where_the_scene_has_it() -> None:
    coming = Perform.of(lesson(), Scene().with_block_at(1.0, 0.0))
    found = coming.world.state.block_poses[0, :2]
    coming.world.close()
    np.testing.assert_allclose(found, (1.0, 0.0))
