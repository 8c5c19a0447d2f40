from dataclasses import replace

import pytest

from studio.engine.errors import StudioError
from studio.engine.scene import Block, Desk, Scene, Zone
from studio.engine.success import Down, InZone, Success

BLOCK = Block((0.1, 0.06, 0.3), (0.8, 0.2, 0.87), 0.4, 0.6)


def test_blocks_stand_on_the_desk() -> None:
    scene = Scene()
    top = scene.desk.position[2] + scene.desk.size[2] / 2
    assert len(scene.blocks) == 3
    for block in scene.blocks:
        assert block.position[2] - block.size[2] / 2 == pytest.approx(top)
        for axis in (0, 1):
            reach = abs(block.position[axis] - scene.desk.position[axis]) + block.size[axis] / 2
            assert reach < scene.desk.size[axis] / 2


def test_the_tasks_block_is_the_one_that_stands() -> None:
    first, *others = Scene().blocks
    assert first == BLOCK
    assert all(block.size[2] <= min(block.size[:2]) for block in others)


def test_teaching_the_right_arm_mirrors_what_stands_around() -> None:
    left, right = Scene(), Scene(arms="right")
    assert left.placed_blocks == left.blocks
    assert left.placed_desk == left.desk
    for seen, mirrored in zip(
        (*left.placed_blocks, left.placed_desk),
        (*right.placed_blocks, right.placed_desk),
        strict=True,
    ):
        x, y, z = seen.position
        assert mirrored.position == (x, -y, z)
        assert mirrored.size == seen.size


@pytest.mark.parametrize(
    "change",
    [
        {"mass": 0.0},
        {"mass": float("nan")},
        {"mass": float("inf")},
        {"friction": -0.1},
        {"friction": float("nan")},
        {"size": (0.1, 0.0, 0.3)},
        {"position": (0.8, float("inf"), 0.87)},
    ],
)
def test_impossible_blocks_are_refused(change: dict[str, object]) -> None:
    with pytest.raises(StudioError, match="block"):
        replace(BLOCK, **change)  # type: ignore[arg-type]


def test_impossible_desks_and_scenes_are_refused() -> None:
    with pytest.raises(StudioError, match="desk"):
        Desk((0.6, -0.9, 0.04), (0.75, 0.15, 0.7), 0.8)
    with pytest.raises(StudioError, match="at least one block"):
        Scene(blocks=())
    with pytest.raises(StudioError, match="left arm, the right or both"):
        Scene(arms="neither")  # type: ignore[arg-type]


def test_a_block_stands_where_it_is_put_and_the_others_where_they_were() -> None:
    moved = Scene().with_block_at(0.9, -0.1)
    assert moved.placed_blocks[0].position == (0.9, -0.1, BLOCK.position[2])
    assert moved.blocks[1:] == Scene().blocks[1:]
    assert moved != Scene()
    assert moved.with_block_at(*BLOCK.position[:2]) == Scene()


@pytest.mark.parametrize("arms", ["left", "right", "both"])
def test_a_block_is_put_where_people_see_it_whichever_arm_is_taught(arms) -> None:
    y = 0.1 if arms == "right" else -0.1
    x_room, y_room = Scene(arms=arms).room_for_block
    assert x_room[0] < 0.9 < x_room[1]
    assert y_room[0] < y < y_room[1]
    assert Scene(arms=arms).with_block_at(0.9, y).placed_blocks[0].position[:2] == (0.9, y)


@pytest.mark.parametrize(("x", "y"), [(-9.0, -9.0), (9.0, -9.0), (0.8, -9.0), (9.0, 0.2)])
@pytest.mark.parametrize("arms", ["left", "right"])
def test_a_block_never_leaves_the_desk(arms, x: float, y: float) -> None:
    side = -1.0 if arms == "right" else 1.0
    moved = Scene(arms=arms).with_block_at(x, side * y)
    desk, block = moved.placed_desk, moved.placed_blocks[0]
    for axis in (0, 1):
        reach = abs(block.position[axis] - desk.position[axis]) + block.size[axis] / 2
        assert reach <= desk.size[axis] / 2 + 1e-9


def test_a_block_is_not_put_into_another_one_nor_nowhere() -> None:
    x, y, _ = Scene().blocks[2].position
    with pytest.raises(StudioError, match="Another block stands there"):
        Scene().with_block_at(x, y + 0.02)
    with pytest.raises(StudioError, match="finite"):
        Scene().with_block_at(float("nan"), 0.0)


def test_any_block_can_be_moved_and_none_onto_another() -> None:
    moved = Scene(arms="right").with_block_at(0.7, -0.1, 1)
    assert moved.placed_blocks[1].position[:2] == (0.7, -0.1)
    assert moved.blocks[1].position[:2] == (0.7, 0.1)
    x, y, _ = Scene().blocks[0].position
    with pytest.raises(StudioError, match="Another block"):
        Scene().with_block_at(x, y, 2)
    with pytest.raises(StudioError, match="no block 3"):
        Scene().with_block_at(x, y, 3)


def test_the_tasks_blocks_are_those_that_its_success_names_in_its_order() -> None:
    assert Scene().task_blocks == (0,)
    success = Success((Down("cube"), Down("block"), Down("cube")))
    assert Scene(success=success).task_blocks == (2, 0)


def test_zones_are_mirrored_with_all_else() -> None:
    scene = Scene(zones=(Zone("mat", (0.7, 0.1), (0.1, 0.2)),))
    (mirrored,) = scene.taught_by("right").placed_zones
    assert (mirrored.center, mirrored.size) == ((0.7, -0.1), (0.1, 0.2))
    assert scene.taught_by("right").taught_by("left") == scene


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"both_arms": True}, "takes both arms"),
        ({"success": Success((Down("tower"),))}, "no block 'tower'"),
        ({"success": Success((InZone("block", "mat"),))}, "no zone 'mat'"),
        ({"blocks": (BLOCK, BLOCK)}, "two things of one name"),
    ],
)
def test_scenes_that_cannot_be_are_refused(changes: dict[str, object], told: str) -> None:
    with pytest.raises(StudioError, match=told):
        Scene(**changes)  # type: ignore[arg-type]


def test_success_needs_a_condition() -> None:
    with pytest.raises(StudioError, match="at least one condition"):
        Success(())


def test_a_scene_is_the_same_by_all_that_is_in_it_for_whichever_arms() -> None:
    usual = Scene()
    rough = replace(usual, desk=replace(usual.desk, friction=0.5))
    for arms in ("left", "right", "both"):
        assert usual.is_same_as(usual.taught_by(arms))
        assert not rough.is_same_as(usual.taught_by(arms))
    assert not usual.is_same_as(replace(usual, name="other"))
    with_both = Scene(arms="both", both_arms=True)
    assert not with_both.is_same_as(usual)
    assert not usual.is_same_as(with_both)
    assert rough.name_beside(usual) == "push-down (another one)"
    assert usual.taught_by("right").name_beside(usual) == "push-down"
    assert replace(rough, name="mine").name_beside(usual) == "mine"
