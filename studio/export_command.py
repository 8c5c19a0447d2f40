"""The command ``studio export``."""

import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Literal

import tyro

from studio.console import as_json_text, log, only_ours_on_stdout
from studio.engine.errors import FileError, StudioError
from studio.engine.experiment import Setup
from studio.engine.export import KINDS, Job, Kind, Material, export
from studio.engine.export.files import ready_folder
from studio.engine.export.material import material_of
from studio.engine.export.session_reader import is_session, open_session
from studio.engine.resources import samples_folder
from studio.engine.teaching import LearnerSettings, learn, reproduce
from studio.scene_option import TaughtSceneFlag, taught_scene

Inputs = Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="RECORDING...")]
KindName = Literal["csv", "npz", "mcap", "model", "html", "video", "replay", "zip"]
EVERYTHING: tuple[KindName, ...] = ("csv", "npz", "mcap", "model", "html", "video", "replay", "zip")
# What a file's ending stands for; .html would be two kinds, of which the report has the name.
_BY_SUFFIX: dict[str, KindName] = {
    ".npz": "npz",
    ".json": "model",
    ".html": "html",
    ".webm": "video",
    ".zip": "zip",
}
_NEEDS_LESSON = {"csv", "npz", "model", "video", "replay", "zip"}  # what it says more of, or needs
_NEEDS_REPRODUCTION = {"csv", "npz", "video", "replay"}
_SAID_EVERY = 2.0  # [s]


@dataclass(frozen=True)
class Export:
    """Write what was taught, learned and done: tables, arrays, model, report, film, session."""

    recordings: Inputs = ()
    """Recordings (MCAP), skeleton files, or one session.zip; the shipped samples by default."""
    to: Annotated[Path | None, tyro.conf.arg(metavar="FOLDER|FILE")] = None
    """Folder to write into, or one file whose ending says what: .npz, .json, .html, .webm, .zip."""
    kinds: tuple[KindName, ...] = ()
    """What to write; all by default. video takes 4 s of work for each second, html some 10 s."""
    anonymous: bool = False
    """Leave out the names of files, sources, demonstrations and bodies."""
    neurons: int | None = None
    """Neurons of the network; 50 by default, of a session what was learned."""
    learner: Literal["rbf", "newrb"] | None = None
    """rbf by default, of a session what was learned."""
    arm: Literal["left", "right", "both"] = "left"
    """The arm that was taught, or both."""
    mapping: Literal["exact", "paper"] = "exact"
    """The mapping that it was taught with."""
    gate: Literal["sequence", "open"] = "sequence"
    """Of skeleton files: sequence, or open to follow whoever is in sight."""
    mirror: bool = False
    """It was taught as in a mirror."""
    scene: TaughtSceneFlag = None
    json: bool = False
    """Print one JSON object."""

    def run(self) -> int:
        """Learn and reproduce as far as that is needed, then write."""
        if self.to is None:
            raise StudioError("--to: a folder to write into, or a file: studio export --to FOLDER")
        names = self._names(self.to)
        with only_ours_on_stdout():
            material = self._learned(self._material(), names)
            if self.to.suffix in _BY_SUFFIX:
                written = _one_file(material, names[0], self.to, self.anonymous)
            else:
                written = _export(material, names, self.to, self.anonymous)
        files = [{"path": str(path), "bytes": path.stat().st_size} for path in written]
        lines = [f"{file['path']}: {file['bytes']:,} bytes" for file in files]
        print(as_json_text({"files": files}) if self.json else "\n".join(lines))
        return 0

    def _names(self, to: Path) -> tuple[KindName, ...]:
        """Return the kinds to write."""
        if to.suffix not in _BY_SUFFIX or to.is_dir():
            return self.kinds or EVERYTHING
        names = self.kinds or (_BY_SUFFIX[to.suffix],)
        if len(names) > 1 or not _kinds()[names[0]].files[0].endswith(to.suffix):
            raise StudioError(
                f"--to {to}: one {to.suffix} file is not {', '.join(names)}; give a folder"
            )
        return names

    def _material(self) -> Material:
        given = self.recordings or tuple(sorted(samples_folder().glob("*.mcap")))
        if any(is_session(path) for path in given):
            if len(given) > 1:
                raise StudioError("one session at a time, and no recordings beside it")
            log(f"opening {given[0]}")
            return open_session(given[0])
        log(f"reading {', '.join(str(path) for path in given)}")
        setup = Setup(self.arm, self.mapping, self.gate, mirrored=self.mirror)
        return material_of(given, setup.in_scene(taught_scene(self.scene, given)))

    def _learned(self, material: Material, names: Sequence[KindName]) -> Material:
        """Return the material with a lesson, and what Baxter does alone, where that is needed."""
        before = material.setup.learner if material.lesson is None else material.lesson.settings
        neurons = before.neurons if self.neurons is None else self.neurons
        settings = LearnerSettings(self.learner or before.name, neurons)
        material = replace(material, setup=replace(material.setup, learner=settings))
        if _NEEDS_LESSON & set(names) and (material.lesson is None or settings != before):
            log(f"learning with {settings.neurons} neurons")
            material = replace(material, lesson=learn(material.taught, settings), reproduction=None)
        if _NEEDS_REPRODUCTION & set(names) and material.lesson and not material.reproduction:
            log("letting Baxter do it alone")
            material = replace(material, reproduction=reproduce(material.lesson))
        return material


def _one_file(
    material: Material, name: KindName, target: Path, anonymous: bool
) -> tuple[Path, ...]:
    ready_folder(target.parent)
    with tempfile.TemporaryDirectory(dir=target.parent) as scratch:
        (path,) = _export(material, (name,), Path(scratch), anonymous)
        try:
            path.replace(target)
        except OSError as error:
            raise FileError(f"{target}: cannot be written: {error.strerror}") from error
    return (target,)


def _export(
    material: Material, names: Sequence[KindName], folder: Path, anonymous: bool
) -> tuple[Path, ...]:
    written: list[Path] = []
    for name in dict.fromkeys(names):
        log(f"writing {name}")
        job = Job(folder, _Percent(name), time.perf_counter)
        written += export(material, (name,), job, anonymous, _kinds())
    return tuple(written)


def _kinds() -> dict[str, Kind]:
    """Return all kinds, with that of the panels."""
    from studio.panels.replay_page import REPLAY  # noqa: PLC0415 - the others need no viser

    return KINDS | {REPLAY.name: REPLAY}


class _Percent:
    """Tells on standard error how far a long export is."""

    def __init__(self, name: str) -> None:
        self._name, self._said = name, time.monotonic()

    def __call__(self, share: float) -> bool:
        if time.monotonic() > self._said + _SAID_EVERY:
            self._said = time.monotonic()
            log(f"{self._name}: {share:.0%}")
        return True
