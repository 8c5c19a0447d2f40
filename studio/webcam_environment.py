"""The webcam tracker's environment: made once, in the user's cache, apart from the studio's own.

MediaPipe wants numpy below 2 and another build of OpenCV than the studio may have. An environment
is whole when the pins that it was made from lie in it; it gets its name only then, so that an
interrupted set-up is never taken for whole, and other pins make it anew.
"""

import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import platformdirs

from studio.engine.errors import StudioError

TRACKER = Path(__file__).resolve().parent / "bridges" / "webcam.py"
REQUIREMENTS = TRACKER.with_name("webcam-requirements.txt")
PYTHONS = ((3, 9), (3, 12))  # the first and the last that MediaPipe 0.10.21 has wheels for
FORSAKEN = 86_400.0  # s; an unfinished environment of this age is nobody's any more
_MARKER = "made-from.txt"

Say = Callable[[str], None]
Run = Callable[[list[str]], None]  # runs a command; raises StudioError that says what went wrong


def cache_folder() -> Path:
    """Return the folder that the environments lie in."""
    return platformdirs.user_cache_path("teaching-studio")


def run_quietly(command: list[str]) -> None:
    """Run a command; raise StudioError with its last words where it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        said = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        raise StudioError("\n".join(said[-3:]) or f"exit status {done.returncode}")


def tracker_python(python: str, folder: Path, say: Say, run: Run = run_quietly) -> Path:
    """Return the interpreter of the tracker's environment, which is made first where it is not.

    Parameters
    ----------
    python : str
        The interpreter to make it with.
    folder : Path
        Where environments lie; see `cache_folder`.
    say : callable
        Told in words what goes on.
    run : callable, optional
        Runs a command.

    Raises
    ------
    StudioError
        Where MediaPipe has no wheel for that Python, or the environment cannot be made.
    """
    version = _checked_version(python)
    environment = folder / f"webcam-python{version[0]}.{version[1]}"
    if not _is_whole(environment):
        say(
            "setting up the webcam's tracker, once: MediaPipe and OpenCV, a download of about "
            f"110 MB, 310 MB on disk, in {environment}. Delete that folder to be rid of it."
        )
        began = time.perf_counter()
        try:
            _make(python, environment, run)
        except OSError as error:
            raise StudioError(f"{environment}: cannot be made: {error.strerror or error}") from None
        say(f"set up in {time.perf_counter() - began:.0f} s")
    return _interpreter(environment)


def _checked_version(python: str) -> tuple[int, int]:
    ask = [python, "-c", "import sys; print(*sys.version_info[:2])"]
    try:
        told = subprocess.run(ask, capture_output=True, text=True, check=True).stdout.split()
        version = (int(told[0]), int(told[1]))
    except (OSError, subprocess.CalledProcessError, ValueError, IndexError):
        raise StudioError(f"--python {python}: there is no Python that runs by this name") from None
    if not PYTHONS[0] <= version <= PYTHONS[1]:
        first, last = (f"{major}.{minor}" for major, minor in PYTHONS)
        raise StudioError(
            f"MediaPipe 0.10.21 exists for Python {first} to {last}, and {python} is "
            f"{version[0]}.{version[1]}: name another one with --python, such as --python "
            f"python{last}; the studio itself may stay on its own"
        )
    return version


def _is_whole(environment: Path) -> bool:
    try:
        return (environment / _MARKER).read_bytes() == REQUIREMENTS.read_bytes()
    except OSError:
        return False


def _make(python: str, environment: Path, run: Run) -> None:
    """Make an environment beside its place, and put it there when it is whole."""
    environment.parent.mkdir(parents=True, exist_ok=True)
    _remove_forsaken(environment)
    unfinished = Path(tempfile.mkdtemp(prefix=_unfinished(environment), dir=environment.parent))
    try:
        _fill(python, unfinished, run)
        shutil.copyfile(REQUIREMENTS, unfinished / _MARKER)
        if _is_whole(environment):  # another one was quicker, and may be running in it
            shutil.rmtree(unfinished)
            return
        if environment.exists():  # of other pins, or damaged
            environment.rename(unfinished / "former")
        unfinished.rename(environment)
        shutil.rmtree(environment / "former", ignore_errors=True)
    except BaseException:  # an interruption too
        shutil.rmtree(unfinished, ignore_errors=True)
        raise


def _fill(python: str, folder: Path, run: Run) -> None:
    try:
        run([python, "-m", "venv", str(folder)])
    except StudioError as error:
        raise StudioError(
            f"an environment could not be made: {error}\nOn Debian: apt install python3-venv"
        ) from None
    isolated = [str(_interpreter(folder)), "-I"]
    try:
        wheels = ("--no-deps", "--only-binary", ":all:", "--requirement", str(REQUIREMENTS))
        run([*isolated, "-m", "pip", "install", "--disable-pip-version-check", *wheels])
    except StudioError as error:
        raise StudioError(
            f"the webcam's tracker could not be installed: {error}\nIs this computer online, with "
            "300 MB free? It is needed this once; then try again. There are ready packages for "
            "Linux and Windows on x86-64 and for macOS."
        ) from None
    try:
        load = f"import sys; sys.path.insert(0, {str(TRACKER.parent)!r}); import webcam"
        run([*isolated, "-c", f"{load}; webcam.make_tracker(mirror=False)"])
    except StudioError as error:
        raise StudioError(f"the webcam's tracker does not start here: {error}") from None


def _interpreter(environment: Path) -> Path:
    unix = environment / "bin" / "python"
    windows = environment / "Scripts" / "python.exe"
    return windows if windows.exists() else unix


def _unfinished(environment: Path) -> str:
    return f"{environment.name}-unfinished-"


def _remove_forsaken(environment: Path) -> None:
    for folder in environment.parent.glob(_unfinished(environment) + "*"):
        if time.time() - folder.stat().st_mtime > FORSAKEN:
            shutil.rmtree(folder, ignore_errors=True)
