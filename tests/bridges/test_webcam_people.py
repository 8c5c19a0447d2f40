"""The webcam's tracker as users get it: set up, and run on pictures of a real person.

The picture is scikit-image's astronaut, an official portrait of NASA's: she faces the camera, seen
down to the waist. Her hands are not to be seen.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import skimage

from studio.console import log
from studio.engine.errors import StudioError
from studio.engine.human import ArmVectors, arm_vectors
from studio.engine.live.protocols import detect, read_objects
from studio.engine.skeleton import HandState, Joint, Side, Skeleton
from studio.engine.sources import SkeletonRecording, read_skeletons
from studio.webcam_environment import TRACKER, cache_folder, tracker_python
from tests.bridges.listening import listening

pytestmark = pytest.mark.webcam

ASTRONAUT = Path(skimage.__file__).parent / "data" / "astronaut.png"
PICTURES, RATE = 24, 20.0

# Run by the tracker's Python, whose OpenCV writes a video in which the camera sways. "Mirrored" is
# what a driver does that shows people as they see themselves.
WRITE_VIDEO = """
import math, sys
import cv2
source, target, count, rate, mirrored = sys.argv[1:]
person = cv2.imread(source)
writer = cv2.VideoWriter(target, cv2.VideoWriter_fourcc(*"MJPG"), float(rate), (640, 480))
for index in range(int(count)):
    phase = 2 * math.pi * index / int(count)
    move = cv2.getRotationMatrix2D((256, 256), 4 * math.sin(phase), 0.8 + 0.05 * math.cos(phase))
    move[:, 2] += (64 + 20 * math.sin(phase), 15)
    seen = cv2.warpAffine(person, move, (640, 480), borderMode=cv2.BORDER_REPLICATE)
    writer.write(cv2.flip(seen, 1) if mirrored == "True" else seen)
writer.release()
"""


@pytest.fixture(scope="module")
def tracker() -> str:
    """Return the tracker's Python. Only a missing network excuses, and never in CI."""
    try:
        return str(tracker_python(sys.executable, cache_folder(), log))
    except StudioError as error:
        if "online" in str(error) and not os.environ.get("CI"):
            pytest.skip(f"the tracker could not be downloaded: {error}")
        raise


@pytest.fixture(scope="module")
def folder(tracker: str, tmp_path_factory) -> Path:
    """Return a folder with the person as a video, unmirrored and mirrored."""
    made = tmp_path_factory.mktemp("videos")
    for mirrored in (False, True):
        target = made / f"mirrored-{mirrored}.avi"
        arguments = [ASTRONAUT, target, PICTURES, RATE, mirrored]
        told = [tracker, "-I", "-c", WRITE_VIDEO, *map(str, arguments)]
        subprocess.run(told, check=True, capture_output=True, timeout=60)
    return made


def track(tracker: str, *arguments: str | Path) -> str:
    """Run the tracker as ``studio webcam`` does and return what it says."""
    command = [tracker, "-I", str(TRACKER), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    return done.stderr


@pytest.fixture(scope="module")
def seen(tracker: str, folder: Path) -> SkeletonRecording:
    """Return what the tracker finds in the video, as the studio reads it."""
    said = track(tracker, "--video", folder / "mirrored-False.avi", "--out", folder / "seen.jsonl")
    assert "body in 100%" in said
    return read_skeletons(folder / "seen.jsonl")


def joints(recording: SkeletonRecording, part: str, side: Side) -> np.ndarray:
    """Return where a joint is in each frame, (n, 3) [m]."""
    return np.array([each.positions[Joint.of(part, side)] for each in recording])


def test_every_picture_shows_one_person_at_the_videos_times(seen: SkeletonRecording) -> None:
    assert seen.has_stamps
    assert seen.has_tracking
    assert len(seen) == seen.frames == PICTURES
    np.testing.assert_allclose(seen.frame_times, np.arange(PICTURES) / RATE, atol=1e-6)


def test_the_shoulders_are_a_persons_and_left_is_her_own_left(seen: SkeletonRecording) -> None:
    """Her left is on the right of the picture, and at negative x in a Kinect's camera space."""
    across = joints(seen, "shoulder", "left") - joints(seen, "shoulder", "right")
    apart = np.linalg.norm(across, axis=1)
    assert ((apart > 0.2) & (apart < 0.6)).all(), apart
    assert (across[:, 0] < -0.15).all()
    slope = np.degrees(np.arctan2(across[:, 1], np.abs(across[:, 0])))
    assert np.abs(slope - np.median(slope)).max() < 10, "the camera rolls by 4 degrees"
    assert abs(np.median(slope)) < 12


def test_the_body_stands_upright_before_the_camera(seen: SkeletonRecording) -> None:
    for person in seen:
        at = person.positions
        assert 0.4 < at[Joint.SPINE_SHOULDER, 2] < 4.0
        assert abs(at[Joint.SPINE_SHOULDER, 0]) < 0.5 * at[Joint.SPINE_SHOULDER, 2]
        assert at[Joint.HEAD, 1] > at[Joint.SPINE_SHOULDER, 1] > at[Joint.SPINE_BASE, 1]


def test_the_arms_can_be_followed(seen: SkeletonRecording) -> None:
    """Both hang: their upper arms point down."""
    for side in ("left", "right"):
        vectors = [arm_vectors(each, side) for each in seen]
        usable = [each for each in vectors if isinstance(each, ArmVectors)]
        assert len(usable) > 0.8 * len(seen), vectors
        down = [each.torso.from_camera(each.upper_arm)[2] for each in usable]
        assert np.median(down) < -0.6


def test_hands_that_are_not_to_be_seen_have_no_state(seen: SkeletonRecording) -> None:
    for person in seen:
        assert {person.left_hand.state, person.right_hand.state} <= {
            HandState.NOT_TRACKED,
            HandState.UNKNOWN,
        }


def test_mirror_undoes_a_drivers_mirroring(
    tracker: str, folder: Path, seen: SkeletonRecording
) -> None:
    """Two roads to one answer; without it, her right arm would be taken for the left one."""
    out = folder / "again.jsonl"
    track(tracker, "--video", folder / "mirrored-True.avi", "--out", out, "--mirror")
    again = read_skeletons(out)
    for part in ("shoulder", "elbow"):
        off = np.linalg.norm(joints(again, part, "left") - joints(seen, part, "left"), axis=1)
        assert np.median(off) < 0.05


def test_over_a_real_socket(tracker: str, folder: Path) -> None:
    """The studio's end understands every message; the video plays in its own time."""
    with listening(answer='{"status": "driving"}') as studio:
        said = track(tracker, "--video", folder / "mirrored-False.avi", "--to", studio.url)
        assert studio.wait_for(2)
    assert 'studio: {"status": "driving"}' in said
    times = [json.loads(text)["time"] for text in studio.messages]
    assert (np.diff(times) > 0).all()
    assert len(times) <= PICTURES
    bodies: list[Skeleton] = []
    for text in studio.messages:
        objects = read_objects(text)
        bodies += detect(objects[0]).read(objects, 0.0).bodies
    assert len(bodies) == len(times)


def test_it_reaches_no_network(tracker: str) -> None:
    """MediaPipe's compiled part imports nothing that could open a connection."""
    (compiled,) = Path(tracker).parents[1].rglob("mediapipe/python/_framework_bindings*")
    symbols = set(compiled.read_bytes().split(b"\0"))
    assert b"pthread_create" in symbols
    assert not symbols & {b"socket", b"connect", b"getaddrinfo", b"gethostbyname", b"sendto"}
