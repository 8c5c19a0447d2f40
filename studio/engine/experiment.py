"""The whole paper in one go: streams or recordings in, a robot that does it alone, and numbers."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from studio.engine.arms import Arms
from studio.engine.calibration import calibrate_file
from studio.engine.demonstration import (
    SHORTEST,
    Demonstration,
    DemonstrationSet,
    Interpolation,
    demonstrations_of,
)
from studio.engine.errors import NothingTaughtError
from studio.engine.follow import follow, ticks_of
from studio.engine.gate import NOBODY, GateMode
from studio.engine.hands import PLAIN, HandOptions
from studio.engine.mcap_file import MCAP_FORMAT, is_recording, read_recording
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording, RecordingInfo
from studio.engine.retarget import Mapping
from studio.engine.robot import load_robot
from studio.engine.scene import USUAL, Scene
from studio.engine.sources import SkeletonRecording, read_skeletons
from studio.engine.teaching import (
    LearnerSettings,
    Lesson,
    Replay,
    Reproduction,
    learn,
    replay,
    reproduce,
)


@dataclass(frozen=True)
class Setup:
    """What the user chose."""

    arms: Arms = "left"
    mapping: Mapping = "exact"
    gate: GateMode = "sequence"
    learner: LearnerSettings = LearnerSettings()
    interpolation: Interpolation = "even"
    seed: int = 0  # of the random interpolation
    mirrored: bool = False
    calibrate_at: float | None = None  # [s] into each file, where the neutral pose begins
    hands: HandOptions = PLAIN
    scene: Scene = USUAL

    def in_scene(self, scene: Scene) -> "Setup":
        """Return the same in another scene, with the arms and the hands that it takes."""
        arms = "both" if scene.both_arms else self.arms
        hands = HandOptions(gripper=True, wrist=scene.wrist) if scene.gripper else self.hands
        return replace(self, arms=arms, hands=hands, scene=scene)


@dataclass(frozen=True)
class FileOutcome:
    """What became of one file, in frames of the file (of a recording: in its ticks)."""

    path: str
    format: str
    frames: int
    armed: tuple[tuple[int, int], ...]  # first and last frame of every armed stretch
    armed_frames: int
    held: dict[str, int]  # why the robot did not follow -> frames
    limited_frames: int  # in which a position or velocity limit bit
    has_hand_states: bool = True
    warning: str = ""


@dataclass(frozen=True, eq=False)
class Experiment:
    """All that came out. Without demonstrations only ``files`` and ``error`` are filled."""

    setup: Setup
    files: tuple[FileOutcome, ...]
    error: str = ""
    lesson: Lesson | None = None
    reproduction: Reproduction | None = None
    replays: tuple[Replay, ...] = ()


@dataclass(eq=False)
class Teachers:
    """What has been taught so far."""

    files: list[FileOutcome] = field(default_factory=list)
    demonstrations: list[Demonstration] = field(default_factory=list)


def run_experiment(
    inputs: Sequence[Path | SkeletonRecording],
    setup: Setup,
    keep: Callable[[Recording], None] | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Experiment:
    """Teach from every input, learn, and reproduce.

    Parameters
    ----------
    inputs : sequence
        Paths of skeleton files or of MCAP recordings, or skeletons already at hand.
    setup : Setup
    keep : callable, optional
        Is given the recording of every skeleton stream that was followed.
    progress : callable, optional
        Is told in words what goes on.

    Raises
    ------
    FileError
        Where a file cannot be used.
    """
    teachers = teach(inputs, setup, keep, progress)
    try:
        taught = DemonstrationSet.of(teachers.demonstrations, setup.interpolation, setup.seed)
    except NothingTaughtError:
        return Experiment(setup, tuple(teachers.files), error=why_nothing(teachers.files))
    progress(f"learning with {setup.learner.neurons} neurons, then reproducing")
    lesson = learn(taught, setup.learner)
    reproduction = reproduce(lesson)
    progress("replaying the demonstrations")
    replays = tuple(
        replay(each, rows) for each, rows in zip(taught.demonstrations, taught.rows, strict=True)
    )
    return Experiment(setup, tuple(teachers.files), "", lesson, reproduction, replays)


def scene_of_recordings(paths: Sequence[Path]) -> Scene:
    """Return the scene in which files were taught, by the first recording among them.

    The usual one where there is no recording.

    Raises
    ------
    FileError
        Where a recording cannot be read.
    """
    first = next((path for path in paths if is_recording(path)), None)
    return USUAL if first is None else read_recording(first).info.scene


def teach(
    inputs: Sequence[Path | SkeletonRecording],
    setup: Setup,
    keep: Callable[[Recording], None] | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Teachers:
    """Follow every input and collect its demonstrations; see `run_experiment`."""
    teachers = Teachers()
    for given in inputs:
        progress(f"teaching from {given if isinstance(given, Path) else given.path}")
        recording, outcome = _taught(given, setup)
        teachers.files.append(outcome)
        teachers.demonstrations += demonstrations_of(recording, outcome.path)
        if keep is not None and recording.samples:
            keep(recording)
    return teachers


def _taught(given: Path | SkeletonRecording, setup: Setup) -> tuple[Recording, FileOutcome]:
    """Return what was sent: as it was recorded, or by following the skeletons now.

    A recording that was made in another way (arms, mirroring, mapping, gate, calibration, scene) is
    followed anew, from its raw skeletons; its own calibration then holds unless one is asked for.
    """
    warning, calibration = "", None
    if isinstance(given, SkeletonRecording):
        stream = given
    elif not is_recording(given):
        stream = read_skeletons(given)
    else:
        recording = read_recording(given)
        info = recording.info
        if _made_so(info, setup):
            ticks = list(range(len(recording.samples)))
            return recording, _outcome(str(given), MCAP_FORMAT, ticks, recording)
        warning, calibration = recording.warning, info.calibration
        stream = recording.skeletons(str(given), f"{MCAP_FORMAT}, its skeletons followed anew")
    if setup.calibrate_at is not None:
        calibration = calibrate_file(stream, setup.calibrate_at)
    pipeline = Pipeline.for_robot(
        load_robot(),
        setup.arms,
        setup.mapping,
        setup.gate,
        setup.mirrored,
        calibration,
        setup.hands,
        setup.scene,
    )
    followed = replace(follow(stream, pipeline, setup.scene), warning=warning)
    outcome = _outcome(stream.path, stream.format, ticks_of(stream.frame_times).tolist(), followed)
    return followed, replace(outcome, has_hand_states=stream.has_hand_states)


def _made_so(info: RecordingInfo, setup: Setup) -> bool:
    """Tell whether a recording was made the way that is asked for now."""
    made = (info.arms, info.mapping, info.gate, info.mirrored, info.hands, info.scene.as_told)
    asked = (
        setup.arms,
        setup.mapping,
        setup.gate,
        setup.mirrored,
        setup.hands,
        setup.scene.as_told,
    )
    return made == asked and setup.calibrate_at is None


def _outcome(path: str, name: str, ticks: Sequence[int], recording: Recording) -> FileOutcome:
    """Count a file's frames by what the tick that first saw each of them decided."""
    seen = [recording.samples[tick] for tick in ticks]
    armed = []
    for is_armed, group in groupby(enumerate(s.gate.armed for s in seen), key=itemgetter(1)):
        indices = [i for i, _ in group]
        if is_armed:
            armed.append((indices[0], indices[-1]))
    held: dict[str, int] = {}
    for sample in seen:
        if sample.held:
            held[sample.held] = held.get(sample.held, 0) + 1
    return FileOutcome(
        path=path,
        format=name,
        frames=len(seen),
        armed=tuple(armed),
        armed_frames=sum(sample.gate.armed for sample in seen),
        held=held,
        limited_frames=sum(sample.limited for sample in seen),
        warning=recording.warning,
    )


def why_nothing(files: Sequence[FileOutcome]) -> str:
    """Return in words why no file taught anything."""
    reasons = []
    for file in files:
        why, _ = max(file.held.items(), key=itemgetter(1), default=("no frames", 0))
        if file.armed:
            refused = f"; {why}" if file.held else ""
            why = (
                f"no armed stretch of {SHORTEST:g} s or more in which the arm was seen, "
                f"{file.armed_frames} frames in all{refused}"
            )
        elif not file.has_hand_states and set(file.held) != {NOBODY}:
            why = "tells no hand states, so the gate cannot open; open it yourself by --gate open"
        reasons.append(f"{file.path}: {why}")
    return "nothing was taught: " + "; ".join(reasons)
