"""What people take away from a session, and bring into it again, while it goes on.

A thread packs the session and lets another process write the files (`studio.engine.export.apart`);
the session only asks how far it is. What was written lies in a folder of our own until the next
export, for the page to send on. Archives are opened by `studio.engine.opening`.
"""

import queue
import shutil
import tempfile
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from studio.engine.choices import Choices
from studio.engine.commands import ChooseScene, Command, Configure
from studio.engine.commands.export import CancelExport, Export, ExportCommand, OpenSession
from studio.engine.errors import StudioError
from studio.engine.experiment import Setup
from studio.engine.export import session_file
from studio.engine.export.anonymous import anonymous as without_names
from studio.engine.export.apart import APART, export_apart
from studio.engine.export.kind import WITHOUT_LESSON, Job, StoppedError, lacks_lesson
from studio.engine.export.material import Material
from studio.engine.export_status import ExportStatus
from studio.engine.learning import Learning
from studio.engine.listed import Listed
from studio.engine.opening import Opened, Opening
from studio.engine.teaching import LearnerSettings

SESSION = "zip"
_PACKED = 0.05  # share of the work that the session's own archive is, where others follow
_LONGEST_END = 5.0  # [s] to wait for a thread that was told to stop


class Exporting:
    """See the module. One thread uses it; `tick` belongs into every tick.

    Parameters
    ----------
    listed, learning
        What there is to export, and where that of an archive goes.
    seed
        Is kept with a session.
    post
        Puts a command into the session's inbox: an archive brings its choices with it.
    """

    def __init__(
        self, listed: Listed, learning: Learning, seed: int, post: Callable[[Command], None]
    ) -> None:
        self._listed, self._learning, self._seed, self._post = listed, learning, seed, post
        self._opened: Opened | None = None  # an archive that waits for its choices to be made
        self._folder = tempfile.TemporaryDirectory(prefix="teaching-studio-export-")
        self._stop = threading.Event()
        self._share = 0.0
        self._results: queue.SimpleQueue[tuple[Path, ...] | Exception] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._running: tuple[str, ...] = ()
        self._number = 0
        self._files: tuple[Path, ...] = ()
        self._opening = Opening()

    @property
    def status(self) -> ExportStatus:
        """How it stands."""
        return ExportStatus(
            self._running,
            self._share,
            self._number,
            self._files,
            self._opening.name,
            self._opening.path,
        )

    def take(self, command: ExportCommand, choices: Choices) -> str:
        """Do what is asked, and return in words what came of it.

        Raises
        ------
        StudioError
            Where something is missing, or another export is not done.
        """
        match command:
            case Export(kinds, anonymous):
                return self._begin(kinds, self._material(choices), anonymous)
            case CancelExport():
                self._stop.set()
                return "Giving up the export." if self._running else self._opening.cancel()
            case OpenSession():
                return self._opening.open(command)

    def tick(self, choices: Choices) -> str:
        """Let a tick pass; return in words what has come of an export or an archive, or nothing.

        Raises
        ------
        StudioError
            Where one of them failed; the message says why.
        """
        if self._opened is not None:
            waiting, self._opened = self._opened, None
            return self._adopt(waiting, choices)
        self._opened = self._opening.poll()
        if self._opened is not None:
            setup = self._opened.material.setup
            self._post(ChooseScene(setup.scene))
            self._post(Configure(choices_of(setup, choices)))
            return ""
        return self._ended() if self._running and not self._results.empty() else ""

    def _material(self, choices: Choices) -> Material:
        learned = self._learning
        settings = LearnerSettings() if learned.lesson is None else learned.lesson.settings
        setup = setup_of(choices, settings, self._seed)
        return Material(setup, self._listed.takes(), learned.lesson, learned.reproduction)

    def _adopt(self, opened: Opened, choices: Choices) -> str:
        """List what an archive held; take its lesson, unless somebody teaches otherwise by now."""
        material = opened.material
        self._listed.add(material.takes)
        words = f"Opened {opened.name}: {len(material.takes)} demonstrations"
        if material.lesson is None or choices_of(material.setup, choices) != choices:
            return f"{words}."
        self._learning.lesson, self._learning.reproduction = material.lesson, None
        return f"{words}, and what was learned from them."

    def _ended(self) -> str:
        """Return in words what came of an export."""
        result, self._running = self._results.get(), ()
        if isinstance(result, StoppedError):
            return "The export was given up; nothing of it was kept."
        if isinstance(result, StudioError | OSError):
            raise result
        if isinstance(result, Exception):
            raise StudioError(f"the export failed, a fault of the studio's own: {result}")
        self._number, self._files = self._number + 1, result
        size = sum(path.stat().st_size for path in result)
        files = "1 file" if len(result) == 1 else f"{len(result)} files"
        return f"Exported: {files}, {_in_words(size)}; your browser keeps them."

    def close(self) -> None:
        """Give up whatever is being written, and delete what was."""
        self._opening.close()
        self._stop.set()
        if self._thread is not None:
            self._thread.join(_LONGEST_END)
        self._folder.cleanup()

    def _begin(self, kinds: tuple[str, ...], material: Material, anonymous: bool) -> str:
        if self._running:
            raise StudioError("An export is being written: wait for it, or cancel it")
        for kind in kinds:
            refusal = why_not(kind, material)
            if refusal:
                raise StudioError(f"{kind}: {refusal}")
        if not kinds:
            raise StudioError("Choose at least one kind of file")
        self._stop.clear()
        self._running, self._share = kinds, 0.0
        for path in Path(self._folder.name).iterdir():  # of the export before
            shutil.rmtree(path, ignore_errors=True)
        folder = Path(tempfile.mkdtemp(dir=self._folder.name))
        self._thread = threading.Thread(
            target=self._write, args=(kinds, material, folder, anonymous), name="export"
        )
        self._thread.daemon = True  # whoever ends the studio does not wait for a film
        self._thread.start()
        return f"Exporting {', '.join(kinds)}."

    def _write(
        self, kinds: tuple[str, ...], material: Material, folder: Path, anonymous: bool
    ) -> None:
        """Write on a thread, and put what came of it into the queue."""
        try:
            self._results.put(written(kinds, material, Job(folder, self._heard), anonymous))
        except Exception as error:
            self._results.put(error)

    def _heard(self, share: float) -> bool:
        self._share = share
        return not self._stop.is_set()


def setup_of(choices: Choices, learner: LearnerSettings, seed: int) -> Setup:
    """Return what was chosen as a session's archive keeps it."""
    return Setup(
        choices.arms,
        choices.mapping,
        choices.gate,
        learner,
        seed=seed,
        mirrored=choices.mirrored,
        hands=choices.hands,
        scene=choices.scene,
    )


def choices_of(setup: Setup, before: Choices) -> Choices:
    """Return the choices that an archive was made with; what it does not keep stays as it is."""
    return replace(
        before,
        arms=setup.arms,
        mapping=setup.mapping,
        gate=setup.gate,
        mirrored=setup.mirrored,
        hands=setup.hands,
        scene=setup.scene,
    )


def why_not(kind: str, material: Material) -> str:
    """Return why a kind of file cannot be written, or nothing."""
    if kind not in APART:
        return f"there is no such export; there are {', '.join(APART)}"
    if not material.takes:
        return "there is nothing to export yet: record a demonstration first"
    return "" if kind in WITHOUT_LESSON else lacks_lesson(material)


def written(
    kinds: tuple[str, ...], material: Material, job: Job, anonymous: bool
) -> tuple[Path, ...]:
    """Write kinds of files, the session's archive as the session is, all others apart.

    Raises
    ------
    StudioError
        As `export_apart` does.
    """
    others = [kind for kind in kinds if kind != SESSION]
    files: tuple[Path, ...] = ()
    share = _PACKED if others else 1.0
    if SESSION in kinds:
        shown = without_names(material) if anonymous else material
        files += session_file.write(shown, job.part(0.0, share))
    if others:
        files += export_apart(material, others, job.part(share, 1.0), anonymous)
    return files


def _in_words(size: int) -> str:
    return f"{size / 1e6:.1f} MB" if size > 1e5 else f"{size / 1e3:.1f} kB"
