"""Desk, blocks and zones: what is one inside, beside and on the other."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import StudioError
from studio.engine.scene_parts import Block, Zone, overlap, overlap_from_above

SIDES = st.tuples(*[st.floats(0.02, 0.5)] * 3)
PLACES = st.tuples(*[st.floats(-0.6, 0.6)] * 3)
BLOCKS = st.builds(Block, SIDES, PLACES, st.just(0.1), st.just(0.5))
ZONES = st.builds(
    Zone, st.just("zone"), st.tuples(*[st.floats(-1, 1)] * 2), st.tuples(*[st.floats(0.1, 1)] * 2)
)


@given(BLOCKS, BLOCKS)
@settings(deadline=None, derandomize=True)
def test_blocks_overlap_alike_from_either_side_and_in_the_mirror(one: Block, other: Block) -> None:
    for test in (overlap, overlap_from_above):
        assert test(one, other) == test(other, one) == test(one.mirrored, other.mirrored)
    assert overlap_from_above(one, other) or not overlap(one, other)
    assert overlap(one, one)
    assert one.mirrored.mirrored == one


@given(ZONES, st.floats(-2, 2), st.floats(-2, 2))
@settings(deadline=None, derandomize=True)
def test_how_far_outside_is_the_way_to_the_nearest_point_within(zone: Zone, x, y) -> None:
    (cx, cy), (length, width) = zone.center, zone.size
    near = (
        min(max(x, cx - length / 2), cx + length / 2),
        min(max(y, cy - width / 2), cy + width / 2),
    )
    assert zone.outside(x, y) == pytest.approx(math.dist((x, y), near), abs=1e-12)
    assert zone.outside(x, y) == pytest.approx(zone.mirrored.outside(x, -y))


def test_impossible_zones_are_refused() -> None:
    for center, size in (((0.0, math.nan), (0.1, 0.1)), ((0.0, 0.0), (0.1, 0.0))):
        with pytest.raises(StudioError, match="zone"):
            Zone("zone", center, size)
