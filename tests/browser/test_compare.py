"""What is dragged in the 3D view under a real pointer: the block, and a field's start points."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from studio.engine import commands
from studio.engine.skeleton import FloatArray
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import Lesson
from studio.panels.field_board import placed
from studio.panels.viewpoint import WITH_ONE
from tests.browser.opened import Studio, studio_on
from tests.browser.pixels import drag, pixel
from tests.engine.cards_at_hand import takes
from tests.engine.lessons_at_hand import lesson

ASIDE = np.array([1.0, 0.05, 0.87])  # [m] where no network looks for the block
LONGER = 1500.0  # [ms] between two moves of a hesitating hand
FAST = 4.0  # times real time


@pytest.fixture
def studio(page: Page, tmp_path: Path) -> Iterator[Studio]:
    page.set_viewport_size({"width": 1366, "height": 768})
    with studio_on(page, tmp_path / "recordings", FAST, drawn="furniture") as opened:
        opened.loop.session._listed.add(takes(2))
        opened.open_step("4 Compare")
        yield opened


def learned(studio: Studio, known: Lesson) -> None:
    studio.loop.session._learning.lesson = known
    studio.waits(lambda now: now.lesson is known)


def played(studio: Studio) -> Snapshot:
    studio.waits(lambda now: now.mode is Mode.PLAYING and now.reproduction is None)
    return studio.waits(lambda now: now.reproduction is not None)


def seen(studio: Studio, point: FloatArray) -> FloatArray:
    return pixel(studio.app._server, studio.page, point)


def test_a_dragged_block_is_missed_and_hit_again_where_it_was_taught(studio: Studio) -> None:
    learned(studio, lesson())
    studio.page.wait_for_timeout(2000)  # until a slow machine has drawn the block
    taught = studio.now.world.block_poses[0, :3].copy()
    drag(studio.page, seen(studio, taught), seen(studio, ASIDE), steps=4, pause=LONGER)
    moved = studio.waits(lambda now: now.compare.moved)
    np.testing.assert_allclose(moved.world.block_poses[0, :2], ASIDE[:2], atol=0.02)
    studio.shows("The block was moved.")

    studio.press("Let Baxter do it alone")
    assert not played(studio).world.block_down
    studio.shows("✖ The block still stands.")

    studio.press("Put the block back")
    back = studio.waits(lambda now: not now.compare.moved).world.block_poses[0, :3]
    np.testing.assert_allclose(back, taught, atol=0.01)
    studio.press("Let Baxter do it alone")
    assert played(studio).world.block_down
    studio.shows("✔ The block is down.")


def test_a_dragged_start_point_leads_elsewhere(studio: Studio) -> None:
    studio.loop.session.post(commands.Stop())
    learned(studio, lesson(5, "field"))
    studio.shows("Drag the blue balls")
    server = studio.app._server
    (client,) = server.get_clients().values()
    studio.waits(lambda _: np.allclose(client.camera.position, WITH_ONE.position, atol=1e-3))
    studio.page.wait_for_timeout(2000)  # until a slow machine has drawn it from there
    picture = studio.now.compare.field
    before = [each.start for each in picture.rollouts]
    target = before[1] + 0.2 * (picture.plane.high - before[1])
    drag(
        studio.page,
        seen(studio, placed(picture.plane, before[1])),
        seen(studio, placed(picture.plane, target)),
    )
    now = studio.waits(lambda now: now.compare.field is not picture)
    room = 0.02 * (picture.plane.high - picture.plane.low)
    assert (np.abs(now.compare.field.rollouts[1].start - target) < room).all()
    np.testing.assert_array_equal(now.compare.field.rollouts[0].start, before[0])
