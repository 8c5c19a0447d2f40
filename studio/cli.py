"""The commands. Results go to standard output, everything else to standard error."""

import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

import studio
from studio.console import as_json_text, log, only_ours_on_stdout
from studio.convert_command import Convert
from studio.engine.errors import StudioError
from studio.engine.experiment import Setup, run_experiment
from studio.engine.hands import HandOptions
from studio.engine.mcap_file import write_recording
from studio.engine.recording import Recording
from studio.engine.report import as_json, as_text
from studio.engine.scene import DEFAULT_SCENE
from studio.engine.scene_file import read_scene
from studio.engine.sources import SkeletonRecording
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.tape import next_recording_path
from studio.engine.teaching import LearnerName, LearnerSettings
from studio.evaluate_command import Evaluate
from studio.export_command import Export
from studio.inspect_command import Inspect
from studio.link_command import Link
from studio.live_commands import Listen, Play
from studio.scene_option import SceneFlag, TaughtSceneFlag, taught_scene
from studio.serve_command import Serve
from studio.sweep_command import Sweep
from studio.webcam_command import Webcam

Files = Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="FILE...")]
Mapping = Literal["exact", "paper"]
Interpolation = Literal["even", "random"]
GripperFlag = Annotated[
    bool,
    tyro.conf.arg(
        help="Put fingers on the hands: the person's right hand, closed, closes those of the arm "
        "that is taught."
    ),
]
WristFlag = Annotated[
    Literal["zero", "level", "follow"],
    tyro.conf.arg(
        help="zero: straight, as in the paper. level: the hand stays level. follow: it points "
        "where the person's hand does."
    ),
]


@dataclass(frozen=True)
class Demo:
    """Do the whole paper: the demonstrator teaches, the network learns, Baxter repeats."""

    headless: bool = False
    """Without a browser, as fast as it goes."""
    demonstrations: int = 4
    """How many takes the demonstrator teaches."""
    neurons: int = 50
    """Neurons of the network."""
    learner: LearnerName = "rbf"
    """rbf: Eq. 13 and a truncated SVD for Eq. 14. newrb: MATLAB's greedy network, spread 1. field:
    Eq. 5 as two stable fields, there and back. plain-field: Eq. 5 as printed, one field, which
    fails."""
    mapping: Mapping = "exact"
    """exact: all four joints. paper: s0, s1, e1 with e0 = 0, so 142 x 3; the forearm is then off by
    48 degrees (median of real recordings)."""
    seed: int = 0
    """Seed of the demonstrator; the same seed gives the same numbers."""
    interpolation: Interpolation = "even"
    """How demonstrations are resampled to 142: at even stamps, or at random ones (the paper)."""
    scene: SceneFlag = DEFAULT_SCENE
    gripper: GripperFlag = False
    wrist: WristFlag = "zero"
    save: Path | None = None
    """Folder to keep the demonstrations in, as MCAP recordings."""
    port: int = 8080
    """Port of the browser's page."""
    json: bool = False
    """Print one JSON object."""

    def run(self) -> int:
        """Run the demonstration; with a browser, show it as it happens first."""
        if self.demonstrations < 1:
            raise StudioError(f"--demonstrations: one or more, not {self.demonstrations}")
        setup = Setup(
            "left",
            self.mapping,
            "sequence",
            self._learner(),
            self.interpolation,
            self.seed,
            hands=HandOptions(self.gripper, self.wrist),
        ).in_scene(read_scene(self.scene))
        if self.headless:
            return self._run_experiment(setup)
        from studio.live import shown_demo  # noqa: PLC0415 - headless needs no viser
        from studio.running import serve_until_interrupted  # noqa: PLC0415 - nor this

        with shown_demo(self.port, setup, self.demonstrations):
            status = self._run_experiment(setup)
            serve_until_interrupted()
        return status

    def _run_experiment(self, setup: Setup) -> int:
        count, scene = self.demonstrations, setup.scene
        takes = [demonstrate(self.seed, take, scene=scene) for take in range(1, count + 1)]
        return _experiment(takes, setup, self.json, self.save)

    def _learner(self) -> LearnerSettings:
        return LearnerSettings(self.learner, self.neurons)


@dataclass(frozen=True)
class Teach:
    """Teach Baxter from skeleton files or from recordings (MCAP), and let it repeat."""

    files: Files
    """Skeleton files in any supported format, or MCAP recordings of the studio."""
    arm: Literal["left", "right", "both"] = "left"
    """The robot's arm that follows the person's, or both. The gate is always the left hand's."""
    mirror: bool = False
    """As in a mirror: the robot's left arm follows the person's right one, and the other way."""
    calibrate_at: float | None = None
    """Seconds into each file at which the person stands still for 2 s, both arms hanging: corrects
    how the torso seems to lean."""
    mapping: Mapping = "exact"
    """exact: all four joints. paper: s0, s1, e1 with e0 = 0; the forearm is then off by 48 degrees
    (median of real recordings)."""
    gate: Literal["sequence", "open"] = "sequence"
    """sequence: the left hand signs Lasso, Open, Closed. open: follow whoever is in sight."""
    neurons: int = 50
    """Neurons of the network."""
    learner: LearnerName = "rbf"
    """rbf: Eq. 13 and a truncated SVD for Eq. 14. newrb: MATLAB's greedy network, spread 1. field:
    Eq. 5 as two stable fields, there and back. plain-field: Eq. 5 as printed, one field, which
    fails."""
    interpolation: Interpolation = "even"
    """How demonstrations are resampled to 142: at even stamps, or at random ones (the paper)."""
    scene: TaughtSceneFlag = None
    gripper: GripperFlag = False
    wrist: WristFlag = "zero"
    save: Path | None = None
    """Folder to keep what was followed in, as MCAP recordings."""
    json: bool = False
    """Print one JSON object."""

    def run(self) -> int:
        """Teach, learn, reproduce."""
        if not self.files:
            raise StudioError("teach from which files? Give one or more: studio teach FILE...")
        learner = LearnerSettings(self.learner, self.neurons)
        setup = Setup(
            self.arm,
            self.mapping,
            self.gate,
            learner,
            self.interpolation,
            mirrored=self.mirror,
            calibrate_at=self.calibrate_at,
            hands=HandOptions(self.gripper, self.wrist),
        ).in_scene(taught_scene(self.scene, self.files))
        return _experiment(self.files, setup, self.json, self.save)


Command = (
    Annotated[Serve, tyro.conf.subcommand("serve")]
    | Annotated[Demo, tyro.conf.subcommand("demo")]
    | Annotated[Teach, tyro.conf.subcommand("teach")]
    | Annotated[Sweep, tyro.conf.subcommand("sweep")]
    | Annotated[Evaluate, tyro.conf.subcommand("evaluate")]
    | Annotated[Inspect, tyro.conf.subcommand("inspect")]
    | Annotated[Convert, tyro.conf.subcommand("convert")]
    | Annotated[Export, tyro.conf.subcommand("export")]
    | Annotated[Webcam, tyro.conf.subcommand("webcam")]
    | Annotated[Listen, tyro.conf.subcommand("listen")]
    | Annotated[Play, tyro.conf.subcommand("play")]
    | Annotated[Link, tyro.conf.subcommand("link")]
)
COMMANDS = (
    "serve",
    "demo",
    "teach",
    "sweep",
    "evaluate",
    "inspect",
    "convert",
    "export",
    "webcam",
    "listen",
    "play",
    "link",
)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the ``studio`` command and exit with its status: 1 where nothing came of it."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if given == ["--version"]:
        print(f"studio {studio.__version__}")
        return
    if not given or (given[0] not in COMMANDS and given[0] not in ("-h", "--help")):
        given.insert(0, "serve")
    command: Command = tyro.cli(
        Command,
        prog="studio",
        description=studio.__doc__,
        args=given,
        config=(tyro.conf.FlagCreatePairsOff,),
    )
    try:
        status = command.run()
        sys.stdout.flush()
    except BrokenPipeError:  # whoever reads has seen enough, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what is left to flush goes nowhere
        status = 1
    except (StudioError, OSError) as error:  # of the system's: a full disk, a closed door
        print(f"studio: {error}", file=sys.stderr)
        if getattr(command, "json", False):
            teaches = isinstance(command, Demo | Teach | Sweep)
            files: dict[str, Any] = {"files": []} if teaches else {}
            print(as_json_text(files | {"error": str(error)}))
        status = 1
    except KeyboardInterrupt:
        status = 130
    sys.exit(status)


def _experiment(
    inputs: Sequence[Path | SkeletonRecording], setup: Setup, as_object: bool, save: Path | None
) -> int:
    with only_ours_on_stdout():
        experiment = run_experiment(inputs, setup, _keeper(save), log)
    if experiment.error:
        print(f"studio: {experiment.error}", file=sys.stderr)
    for file in experiment.files:
        if file.warning:
            print(f"studio: {file.warning}", file=sys.stderr)
    print(as_json_text(as_json(experiment)) if as_object else as_text(experiment))
    return 1 if experiment.error else 0


def _keeper(folder: Path | None) -> Callable[[Recording], None] | None:
    """Return what writes every recording into ``folder``, under the next free name."""
    if folder is None:
        return None

    def keep(recording: Recording) -> None:
        path = next_recording_path(folder)
        write_recording(path, recording)
        log(f"saved {path}")

    return keep
