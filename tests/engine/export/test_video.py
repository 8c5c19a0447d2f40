from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from studio.engine.camera import Camera
from studio.engine.export import Job, StoppedError
from studio.engine.export.video import FRAME_RATE, Side, write_film
from tests.engine.export.materials import done

SMALL = Camera(size=(160, 120))


def sides(ticks: int, fewer: int = 0) -> tuple[Side, Side]:
    whole = done().reproduction.performance
    short = replace(whole, ticks=whole.ticks[20 : 20 + ticks])
    shorter = replace(whole, ticks=whole.ticks[20 : 20 + ticks - fewer])
    return Side.of("Demonstration: née", short), Side.of("Alone", shorter)


def frames_of(path: Path) -> list[np.ndarray]:
    film = cv2.VideoCapture(str(path))
    assert film.get(cv2.CAP_PROP_FPS) == FRAME_RATE
    found = []
    while (read := film.read())[0]:
        found.append(read[1])
    return found


def test_a_film_has_a_frame_for_every_second_tick(tmp_path: Path) -> None:
    path = tmp_path / "a.webm"
    shares: list[float] = []
    count = write_film(
        path, sides(21, 10), Job(tmp_path, lambda s: shares.append(s) or True), SMALL
    )
    frames = frames_of(path)
    assert len(frames) == count == 11
    assert {frame.shape for frame in frames} == {(120, 320, 3)}
    assert shares[-1] == 1.0
    assert path.read_bytes()[:4] == b"\x1a\x45\xdf\xa3"  # EBML, as WebM begins
    assert [each.name for each in tmp_path.iterdir()] == ["a.webm"]
    # The left half moves to the end; the right one, which is shorter, stands still by then.
    left, right = (
        np.array([f[20:100, half] for f in frames], dtype=float)
        for half in (slice(0, 160), slice(160, 320))
    )
    assert np.abs(left[-1] - left[0]).max() > 100.0
    assert np.abs(right[-1] - right[-3]).mean() < np.abs(left[-1] - left[-3]).mean()


def test_a_stopped_film_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(StoppedError):
        write_film(tmp_path / "a.webm", sides(9), Job(tmp_path, lambda share: share < 0.5), SMALL)
    assert not list(tmp_path.iterdir())
