"""Opening a session's archive, which may come from anybody.

Its table of contents is sized before it is read, and every file in it before it is unpacked; only
the names that a session has are taken, to names of our own; nothing is ever unpickled.
"""

import re
import struct
import tempfile
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo
from zlib import error as ZlibError  # noqa: N812 - it is an error, whatever it is called there

import numpy as np

from studio.engine.demonstration import DemonstrationSet
from studio.engine.errors import FileError, StudioError
from studio.engine.export.manifest import (
    MANIFEST,
    MODEL,
    MOST_RECORDINGS,
    Manifest,
    read_manifest,
    recording_name,
)
from studio.engine.export.material import Material, Take, cut
from studio.engine.mcap_file import LARGEST_FILE, read_recording
from studio.engine.recording import Recording
from studio.engine.sources.strict_json import parse_json
from studio.engine.teaching import INDEX_TIME, LEARNERS, Lesson
from studio.rbf import load_model, pooled_variance_floor

MOST_FILES = MOST_RECORDINGS + 2
LARGEST_CONTENTS = 128 * MOST_FILES  # [bytes] of the table of contents; ours take 70 a file
LARGEST_MANIFEST, LARGEST_MODEL = 4 << 20, 64 << 20  # [bytes] unpacked
LARGEST_SESSION = 2 << 30  # [bytes] of all files, unpacked
_RECORDING = re.compile(r"recordings/\d{3}\.mcap")
_END = struct.Struct("<4s4H2LH")  # of an archive: where its table of contents is, and how large
_LONGEST_COMMENT = 1 << 16  # [bytes], after that end
_ENCRYPTED = 0x1  # a flag of a file


def is_session(path: Path) -> bool:
    """Tell whether a file begins as an archive does; a missing file does not, nor a pipe."""
    try:
        if not path.is_file():  # to open a pipe would wait for whoever writes into it
            return False
        with path.open("rb") as file:
            return file.read(4) == b"PK\x03\x04"
    except (OSError, ValueError):
        return False


def open_session(path: Path) -> Material:
    """Return what an archive holds: demonstrations and model are the same to the bit.

    What the robot did alone is not in it: the same model does the same again.

    Raises
    ------
    FileError
        Where it cannot be read, is no session's archive, is too large or was tampered with; the
        message names the archive, and the file in it.
    """
    try:
        _check_contents(path)
        with ZipFile(path) as archive, tempfile.TemporaryDirectory() as scratch:
            entries = _checked_entries(path, archive)
            unpacker = _Unpacker(path, archive, entries, Path(scratch))
            manifest = _manifest(unpacker)
            recordings = [unpacker.recording(index) for index in range(manifest.recordings)]
            material = _material(path, manifest, recordings)
            return _with_lesson(unpacker, manifest, material)
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror or error}") from error
    except (BadZipFile, ZlibError, EOFError, NotImplementedError, struct.error) as error:
        raise FileError(
            f"{path}: not a whole archive of a session ({error}); export the session anew"
        ) from error


def _check_contents(path: Path) -> None:
    """Raise FileError before a table of contents is read that is larger than a session's."""
    size = path.stat().st_size
    if size > LARGEST_SESSION:
        raise FileError(f"{path}: {size:,} bytes; sessions up to {LARGEST_SESSION:,} are read")
    with path.open("rb") as file:
        file.seek(max(0, size - _END.size - _LONGEST_COMMENT))
        tail = file.read()
    place = tail.rfind(b"PK\x05\x06")
    if place < 0 or len(tail) - place < _END.size:
        raise FileError(f"{path}: not an archive of a session: it has no table of contents")
    _, _, _, _, files, contents, _, _ = _END.unpack_from(tail, place)
    is_64_bit = tail[max(0, place - 20) : place].startswith(b"PK\x06\x07")
    if is_64_bit or files > MOST_FILES or contents > LARGEST_CONTENTS:
        raise FileError(
            f"{path}: a table of {files:,} files in {contents:,} bytes; a session has up to "
            f"{MOST_FILES} files"
        )


def _checked_entries(path: Path, archive: ZipFile) -> dict[str, ZipInfo]:
    """Return the files by name, all of them such as a session has."""
    found: dict[str, ZipInfo] = {}
    for entry in archive.infolist():
        name, most = entry.filename, _largest(entry.filename)
        if most is None or name in found:
            raise FileError(
                f"{path}: {name!r:.80} does not belong into a session, or is there twice"
            )
        if entry.file_size > most:
            raise FileError(
                f"{path}: {name} unpacks to {entry.file_size:,} bytes; up to {most:,} are read"
            )
        if entry.compress_type not in (ZIP_STORED, ZIP_DEFLATED) or entry.flag_bits & _ENCRYPTED:
            raise FileError(f"{path}: {name} is packed in a way that sessions are not; export anew")
        found[name] = entry
    total = sum(entry.file_size for entry in found.values())
    if total > LARGEST_SESSION:
        raise FileError(
            f"{path}: unpacks to {total:,} bytes; sessions up to {LARGEST_SESSION:,} are read"
        )
    return found


def _largest(name: str) -> int | None:
    """Return how large a file of that name may be [bytes]; None where a session has none such."""
    if _RECORDING.fullmatch(name):
        return LARGEST_FILE
    return {MANIFEST: LARGEST_MANIFEST, MODEL: LARGEST_MODEL}.get(name)


class _Unpacker:
    """Takes single files out of an archive, to names of its own."""

    def __init__(
        self, path: Path, archive: ZipFile, entries: dict[str, ZipInfo], scratch: Path
    ) -> None:
        self.path = path
        self._archive, self._entries, self._scratch = archive, entries, scratch

    def content(self, name: str) -> bytes:
        """Return a file's content; no more than its size, which was checked, is unpacked."""
        if name not in self._entries:
            raise FileError(f"{self.path}: {name} is missing; export the session anew")
        return self._archive.read(self._entries[name])

    def file(self, name: str) -> Path:
        """Return where a file's content is for the moment."""
        path = self._scratch / name.replace("/", "-")
        path.write_bytes(self.content(name))
        return path

    def recording(self, index: int) -> Recording:
        """Return a recording; raise FileError, which names it as the archive does."""
        name = recording_name(index)
        file = self.file(name)
        try:
            recording = read_recording(file)
        except FileError as error:
            raise FileError(str(error).replace(str(file), f"{self.path}: {name}")) from error
        finally:
            file.unlink()
        if recording.warning:
            raise FileError(f"{self.path}: {name} is not whole; export the session anew")
        return recording


def _manifest(unpacker: _Unpacker) -> Manifest:
    try:
        text = unpacker.content(MANIFEST).decode("utf-8")
        return read_manifest(parse_json(text))
    except FileError:
        raise
    except (UnicodeDecodeError, StudioError) as error:
        raise FileError(f"{unpacker.path}: {MANIFEST}: {error}") from error


def _material(path: Path, manifest: Manifest, recordings: list[Recording]) -> Material:
    takes = []
    for stretch in manifest.stretches:
        recording = recordings[stretch.recording]
        try:
            demonstration = cut(recording, stretch.name, stretch.first, stretch.last)
        except FileError as error:
            raise FileError(f"{path}: {MANIFEST}: {error}") from error
        takes.append(Take(demonstration, recording, stretch.included))
    return Material(manifest.setup, tuple(takes))


def _with_lesson(unpacker: _Unpacker, manifest: Manifest, material: Material) -> Material:
    """Return the material with what was learned from it, if anything was."""
    if manifest.learner is None:
        return material
    setup = material.setup
    chosen = [material.takes[index].demonstration for index in manifest.learned_from]
    file = unpacker.file(MODEL)
    try:
        taught = DemonstrationSet.of(chosen, setup.interpolation, setup.seed)
        model = load_model(file).estimator
        expected = type(LEARNERS[manifest.learner.name](manifest.learner.neurons))
        if type(model) is not expected:
            raise StudioError(f"expected the network of {manifest.learner.name}")  # noqa: TRY301
        curve = model.predict(INDEX_TIME)
        if curve.shape != taught.mean.shape or not np.isfinite(curve).all():
            raise StudioError(f"expected a network of {taught.mean.shape[1]} joints")  # noqa: TRY301
    except (StudioError, ValueError) as error:
        words = str(error).replace(str(file), MODEL)
        raise FileError(f"{unpacker.path}: {MODEL}: {words}; export the session anew") from error
    mse = np.mean((taught.rows - curve) ** 2, axis=(0, 1))
    floor = pooled_variance_floor(taught.rows)
    lesson = Lesson(manifest.learner, taught, model, curve, mse, floor.value, floor.reason)
    return Material(setup, material.takes, lesson)
