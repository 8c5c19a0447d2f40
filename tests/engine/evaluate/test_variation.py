"""Draws depend on seed, trial and their own variation alone, and keep to what they promise."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import kstest

from studio.engine.errors import StudioError
from studio.engine.evaluate.variation import JITTER, Variations, draw, widths_of
from studio.engine.scene import Block, Scene, Zone
from studio.engine.scene_check import can_begin
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.success import InZone, Success

NAMES = ("block", "friction", "mass", "start", "noise", "latency")
WIDE = Variations(0.1, 0.5, 0.4, 10.0, 0.5, 6)
MANY = 400
# A block with more room around it than any of these widths.
ROOMY = replace(Scene(), blocks=(Block((0.06, 0.06, 0.06), (0.75, 0.15, 0.75), 0.1, 0.5),))


def numbers(drawn):
    return np.concatenate(
        [drawn.block, [drawn.friction, drawn.mass, drawn.latency], drawn.start, drawn.offset]
    )


@settings(deadline=None, derandomize=True, max_examples=50)
@given(st.integers(0, 2**40), st.integers(0, 10**6))
def test_the_same_trial_is_the_same_and_inside_its_bounds(seed: int, trial: int) -> None:
    one, again = draw(WIDE, seed, trial, 8, ROOMY), draw(WIDE, seed, trial, 8, ROOMY)
    assert (numbers(one) == numbers(again)).all()
    assert (one.arrived(50) == again.arrived(50)).all()
    assert (one.offsets(50) == again.offsets(50)).all()
    assert np.abs(one.block).max() <= 0.1
    assert 0.5 <= one.friction <= 1.5
    assert 0.6 <= one.mass <= 1.4
    assert np.abs(one.start).max() <= np.radians(10.0)
    assert one.latency in range(7)
    assert np.isfinite(one.offset).all()


def test_another_trial_and_another_seed_are_something_else() -> None:
    drawn = [numbers(draw(WIDE, seed, trial, 4, ROOMY)) for seed in (0, 1) for trial in range(20)]
    assert len({each.tobytes() for each in drawn}) == len(drawn)


@pytest.mark.parametrize("name", NAMES)
def test_a_variation_alone_draws_what_it_draws_among_others(name: str) -> None:
    alone, among = draw(WIDE.only((name,)), 3, 7, 4, ROOMY), draw(WIDE, 3, 7, 4, ROOMY)
    nothing = draw(WIDE.only(()), 3, 7, 4, ROOMY)
    part = {"noise": "offset"}.get(name, name)
    assert np.array_equal(getattr(alone, part), getattr(among, part))
    assert not np.array_equal(getattr(among, part), getattr(nothing, part))
    for other in {"block", "friction", "mass", "start", "offset", "latency"} - {part}:
        assert np.array_equal(getattr(alone, other), getattr(nothing, other))


def test_without_variations_a_trial_is_the_usual_one() -> None:
    nothing = draw(Variations().only(()), 0, 5, 4, Scene())
    assert nothing.scene(Scene()) == Scene()
    assert not nothing.start.any()
    assert not nothing.offsets(30).any()
    assert (nothing.arrived(30) == np.arange(30)).all()


def test_draws_are_distributed_as_is_said() -> None:
    drawn = [draw(WIDE, 11, trial, 4, ROOMY) for trial in range(MANY)]
    uniform = np.array([[each.block[0], each.block[1]] for each in drawn]).T / 0.1
    factors = np.array([[(d.friction - 1) / 0.5, (d.mass - 1) / 0.4] for d in drawn]).T
    starts = np.array([each.start[0] for each in drawn]) / np.radians(10.0)
    for values in (*uniform, *factors, starts):
        assert kstest(values, "uniform", (-1.0, 2.0)).pvalue > 0.001
    offsets = np.array([each.offset[1] for each in drawn]) / np.radians(0.5)
    assert kstest(offsets, "norm").pvalue > 0.001
    counts = np.bincount([each.latency for each in drawn], minlength=7)
    assert np.abs(counts - MANY / 7).max() < 4 * np.sqrt(MANY / 7)


def test_noise_is_an_offset_and_a_fifth_of_it_anew_in_each_tick() -> None:
    drawn = draw(replace(Variations(), noise=1.0), 2, 3, 4, ROOMY)
    found = drawn.offsets(4000)
    spread = JITTER * np.radians(1.0)
    assert found.mean(axis=0) == pytest.approx(drawn.offset, abs=0.1 * spread)
    assert found.std(axis=0) == pytest.approx(np.full(4, spread), rel=0.1)


@settings(deadline=None, derandomize=True, max_examples=50)
@given(st.integers(0, 10**6), st.integers(0, 30))
def test_commands_arrive_late_and_the_newest_holds(trial: int, most: int) -> None:
    drawn = draw(replace(Variations(), latency=most), 0, trial, 4, ROOMY)
    newest, ticks = drawn.arrived(80), np.arange(80)
    assert (np.diff(newest) >= 0).all()  # nothing overtaken comes back
    assert (newest <= ticks).all()
    late = ticks - newest
    assert late.max() <= drawn.latency
    assert (newest[drawn.latency :] >= 0).all()


def test_all_blocks_move_alike_and_their_sizes_stay() -> None:
    usual, drawn = ROOMY, draw(WIDE, 0, 1, 4, ROOMY)
    for before, after in zip(usual.blocks, drawn.scene(usual).blocks, strict=True):
        moved = np.subtract(after.position, before.position)
        assert moved == pytest.approx([*drawn.block, 0.0])
        assert after.mass == pytest.approx(before.mass * drawn.mass)
        assert after.friction == pytest.approx(before.friction * drawn.friction)
        assert (after.size, after.name) == (before.size, before.name)


@pytest.mark.parametrize("name", scene_names())
def test_usual_widths_leave_every_scene_that_ships_to_be_done(name: str) -> None:
    """So that no trial of them is ever drawn again: the corners of the square and its middle."""
    scene = read_scene(name)
    width = Variations().block
    for dx, dy in ((0, 0), (-1, -1), (-1, 1), (1, -1), (1, 1)):
        shifted = replace(draw(WIDE.only(()), 0, 0, 4, scene), block=width * np.array([dx, dy]))
        assert can_begin(shifted.scene(scene)), (dx, dy)


ZONE = Zone("mat", (0.85, 0.15), (0.18, 0.9))  # whose edge is a centimeter from the block
NEAR = replace(ROOMY, zones=(ZONE,), success=Success((InZone("block", "mat"),)))
EDGE = replace(ROOMY, blocks=(replace(ROOMY.blocks[0], position=(1.04, 0.15, 0.75)),))


@pytest.mark.parametrize("scene", [NEAR, EDGE], ids=["near its zone", "near the edge"])
@pytest.mark.parametrize("arms", ["left", "right"])
def test_no_trial_is_decided_before_it_begins(scene: Scene, arms) -> None:
    placed = scene.taught_by(arms)
    wide = Variations().only(("block",))
    first = [
        wide.block * np.random.default_rng([5, trial, 0, 0]).uniform(-1.0, 1.0, 2)
        for trial in range(60)
    ]
    drawn = [draw(wide, 5, trial, 4, placed) for trial in range(60)]
    fine = [
        can_begin(replace(each, block=at).scene(placed))
        for each, at in zip(drawn, first, strict=True)
    ]
    assert 10 < sum(fine) < 50
    for each, at, was_fine in zip(drawn, first, fine, strict=True):
        assert can_begin(each.scene(placed))
        assert np.abs(each.block).max() <= wide.block
        assert np.array_equal(each.block, at) == was_fine  # a fair draw is kept


def test_where_nothing_else_is_possible_blocks_stand_where_they_were_taught() -> None:
    everywhere = replace(NEAR, zones=(replace(ZONE, center=(0.75, 0.15), size=(0.6, 0.9)),))
    assert not draw(WIDE, 0, 3, 4, everywhere).block.any()


def test_impossible_widths_and_names_are_refused_in_words() -> None:
    with pytest.raises(StudioError, match="mass: a variation of 0 to 95 %"):
        Variations(mass=1.0)
    with pytest.raises(StudioError, match="noise: a variation"):
        Variations(noise=float("nan"))
    with pytest.raises(StudioError, match="no variation 'wind'; there are block"):
        Variations().only(("wind",))


def test_what_varies_is_said() -> None:
    assert Variations().only(("block",)).words == "blocks ±3 cm in x and y"
    assert Variations().only(()).words == "nothing varies"
    assert set(widths_of(Variations())) == set(NAMES)
