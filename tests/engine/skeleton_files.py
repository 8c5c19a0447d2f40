"""Self-made recordings: a person who stands before the sensor, in every format that is read.

The writers know the formats' published layouts and nothing of the readers.
"""

import gzip
import io
import json
from collections.abc import Sequence

import numpy as np

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


def ntu_text(frames: Sequence[Sequence[Skeleton]]) -> str:
    """Text as the corpus has it, with columns of no interest filled in, and 1 for confidence."""
    lines: list[object] = [len(frames)]
    for bodies in frames:
        lines.append(len(bodies))
        for body in bodies:
            left, right = (STATES.index(body.hand(side).state) for side in ("left", "right"))
            lines += [f"{body.body_id} 0 1 {left} 1 {right} 0 0.0203 -0.1147 2", 25]
            for point, state in zip(body.positions.tolist(), body.tracking, strict=True):
                place = " ".join(map(repr, point))
                lines.append(f"{place} 278.4 214.1 1032.2 530.7 -0.21 0.04 0.97 -0.08 {state}")
    return "\n".join(map(str, lines)) + "\n"


def node_body(body: Skeleton, index: int = 0, tracking: bool = True) -> dict:
    """A body as node-kinect2 hands it over; Kinectron leaves out jointType and trackingState."""
    joints = []
    for joint, (point, state) in enumerate(
        zip(body.positions.tolist(), body.tracking.tolist(), strict=True)
    ):
        place = {"depthX": 0.4, "depthY": 0.5, "colorX": 0.6, "colorY": 0.7}
        place |= dict(zip(("cameraX", "cameraY", "cameraZ"), point, strict=True))
        joints.append(place | ({"jointType": joint, "trackingState": state} if tracking else {}))
    return {
        "bodyIndex": index,
        "tracked": True,
        "trackingId": body.body_id,
        "leftHandState": STATES.index(body.left_hand.state),
        "rightHandState": STATES.index(body.right_hand.state),
        "joints": joints,
    }


def node_message(bodies: Sequence[Skeleton], seats: int = 6) -> dict:
    """A whole body frame: six seats, of which some are empty."""
    taken = [node_body(body, index) for index, body in enumerate(bodies)]
    empty = [{"bodyIndex": index, "tracked": False} for index in range(len(bodies), seats)]
    return {"bodies": [*taken, *empty], "floorClipPlane": {"x": 0, "y": 1, "z": 0, "w": 0.7}}


def kinectron_list(bodies: Sequence[Skeleton], start: int = 1_518_026_639_637) -> list[dict]:
    """Kinectron's recording: bodies one by one, with stamps in ms since the first body's time."""
    first = bodies[0].time
    return [
        node_body(body, tracking=False)
        | {"record_startime": start, "record_timestamp": round(1000 * (body.time - first))}
        for body in bodies
    ]


def landmark_line(time: float, lean: float = 0.0) -> dict:
    """A message of a person who stands 2 m off, made of numbers alone."""
    rng = np.random.default_rng(3)
    world = rng.normal(size=(33, 3)) * [0.2, 0.4, 0.1] + [lean, 0.0, 0.0]
    picture = 0.5 + 0.5 * (world[:, :2] / (world[:, 2:] + 2.0)) * [0.75, 1.0]
    hand = rng.uniform(0.4, 0.5, size=(21, 3)).round(6).tolist()
    return {
        "format": "mediapipe-landmarks 1",
        "time": time,
        "image": [640, 480],
        "pose_world": np.column_stack([world, np.ones(33)]).round(6).tolist(),
        "pose_image": picture.round(6).tolist(),
        "left_hand": hand,
        "right_hand": None,
    }


def in_javascript(message: dict) -> dict:
    """The same as MediaPipe's JavaScript has it."""

    def points(rows: list[list[float]] | None) -> list[dict]:
        names = ("x", "y", "z", "visibility")
        return [dict(zip(names, row, strict=False)) for row in rows or []]

    return {
        "poseWorldLandmarks": points(message["pose_world"]),
        "poseLandmarks": points(message["pose_image"]),
        "leftHandLandmarks": points(message["left_hand"]),
        "rightHandLandmarks": points(message["right_hand"]),
    }


def as_lines(values: Sequence[object]) -> str:
    return "".join(json.dumps(value) + "\n" for value in values)


def skeleton_files() -> dict[str, bytes]:
    """One small file of each format that tells positions exactly, in three or four frames."""
    people = [skeleton(frame) for frame in range(3)]
    words = ("open", "nottracked")
    old, new = (
        [[socket_body(frame, states=states)] for frame in range(3)] for states in ((2, 3), words)
    )
    stream = io.StringIO()
    write_skeletons(stream, people)
    texts = {
        "kinect2-socket 0.1": socket_text(old, "0.1"),
        "kinect2-socket 0.3": socket_text(new),
        "studio jsonl 1": stream.getvalue(),
        "table 75": table_text(table_rows(75), " "),
        "table 100": table_text(table_rows(100), ";"),
        "table 101": table_text(table_rows(101), ",", ",\r\n"),
        "table 175": table_text(table_rows(175), "\t"),
        "ntu rgb+d": ntu_text([[body] for body in people]),
        "node-kinect2": as_lines([node_message([body]) for body in people]),
        "kinectron": json.dumps(kinectron_list(people)),
    }
    return {name: text.encode() for name, text in texts.items()}


def sample_files() -> dict[str, bytes]:
    """Those files, and one of them packed."""
    files = skeleton_files()
    packed = gzip.compress(files["kinect2-socket 0.3"], mtime=0)
    return files | {"kinect2-socket 0.3 in gzip": packed}


def landmark_files() -> dict[str, bytes]:
    """The layouts of MediaPipe's landmarks, by what tells them apart."""
    messages = [landmark_line(frame / 30, 0.01 * frame) for frame in range(3)]
    javascript = [in_javascript(message) for message in messages]
    return {
        "lines": as_lines(messages).encode(),
        "JavaScript's lines": as_lines(javascript).encode(),
        "JavaScript's list": json.dumps(javascript).encode(),
    }
