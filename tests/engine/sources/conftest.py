"""Self-made recordings: a person who stands before the sensor, in every format that is read."""

import gzip
import io
import json
from types import SimpleNamespace

import numpy as np
import pytest

from studio.engine.skeleton import Hand, HandState, Joint, Skeleton
from studio.engine.sources import write_skeletons

STATES = tuple(HandState)


def standing(frame: int, x: float = 0.0, z: float = 2.0) -> np.ndarray:
    """Joints (25, 3) [m] of a made-up person; no two frames and no two joints are alike."""
    order = np.arange(25)
    points = np.stack([x + 0.02 * order, -0.5 + 0.04 * order, z + 0.01 * (order % 7)], axis=1)
    points[Joint.SPINE_MID, [0, 2]] = x, z
    return np.round(points + 0.001 * frame, 6)


def skeleton(frame: int, body_id: str = "0", x: float = 0.0, z: float = 2.0) -> Skeleton:
    return Skeleton(
        time=100.0 + frame / 30,
        positions=standing(frame, x, z),
        tracking=(np.arange(25) + frame) % 3,
        left_hand=Hand(STATES[frame % 5], 0.25),
        right_hand=Hand(STATES[(frame + 2) % 5]),
        body_id=body_id,
    )


def socket_body(frame: int, body_id: object = 7, states: tuple = (2, 3), **place: float) -> dict:
    points = standing(frame, **place).tolist()
    return {
        "id": body_id,
        "leftHandState": states[0],
        "rightHandState": states[1],
        "face": {"Happy": "no"},
        "joints": [dict(zip("xyz", point, strict=True)) for point in points],
    }


def socket_text(frames: list[list[dict]], version: str = "0.3") -> str:
    return json.dumps({"version": version, "frames": [{"bodies": each} for each in frames]})


def table_rows(columns: int, frames: int = 4, fourth: object = 2) -> list[list[object]]:
    """Cells of a table; the stamps are large and 33.3333 ms apart."""
    rows: list[list[object]] = []
    for frame in range(frames):
        tail = {75: [], 100: [fourth], 101: [fourth], 175: [0.0, 0.1, -0.7, 0.7]}[columns]
        cells = [cell for point in standing(frame).tolist() for cell in [*point, *tail]]
        stamp = [89_810_293_609 + 333_333 * frame] if columns == 101 else []
        rows.append([*stamp, *cells])
    return rows


def table_text(rows: list[list[object]], separator: str = ",", end: str = "\n") -> str:
    return "".join(separator.join(map(str, row)) + end for row in rows)


def sample_files() -> dict[str, bytes]:
    """One small file of each format, in three or four frames."""
    words = ("open", "nottracked")
    old, new = (
        [[socket_body(frame, states=states)] for frame in range(3)] for states in ((2, 3), words)
    )
    stream = io.StringIO()
    write_skeletons(stream, [skeleton(frame) for frame in range(3)])
    files = {
        "kinect2-socket 0.1": socket_text(old, "0.1").encode(),
        "kinect2-socket 0.3": socket_text(new).encode(),
        "studio jsonl 1": stream.getvalue().encode(),
        "table 75": table_text(table_rows(75), " ").encode(),
        "table 100": table_text(table_rows(100), ";").encode(),
        "table 101": table_text(table_rows(101), ",", ",\r\n").encode(),
        "table 175": table_text(table_rows(175), "\t").encode(),
    }
    packed = gzip.compress(files["kinect2-socket 0.3"], mtime=0)
    return files | {"kinect2-socket 0.3 in gzip": packed}


@pytest.fixture(scope="session")
def made() -> SimpleNamespace:
    """The makers above, since test modules do not import each other."""
    makers = (standing, skeleton, socket_body, socket_text, table_rows, table_text, sample_files)
    return SimpleNamespace(**{maker.__name__: maker for maker in makers})
