"""The light surfaces, kept in the user's cache folder: made once, then there at every start.

A file's name holds a digest of all that its surface is made of: the maker's meshes, their places
and colors, the detail, and the code that makes them light. So whatever is found is right, and
nothing needs to be cleared by hand.
"""

import hashlib
import logging
import os
import shutil
import tempfile
import zipfile
import zlib
from functools import cache
from pathlib import Path

import numpy as np
import platformdirs

from studio.engine.resources import notice_path
from studio.engine.urdf import Mesh
from studio.panels import meshes, quadrics, shading, simplify, triangles
from studio.panels.glb import Surface
from studio.panels.meshes import Look

_BROKEN = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error)
_logger = logging.getLogger(__name__)


def cache_folder() -> Path:
    """Return the folder of the surfaces; it may not exist yet."""
    return platformdirs.user_cache_path("teaching-studio") / "meshes"


def light_surface(look: Look, detail: float) -> Surface:
    """Return `Look.surface`, to the bit, from the cache where it is there.

    A damaged file is made anew; a folder that cannot be written to is done without.
    """
    path = cache_folder() / f"{look.links[0]}-{_digest(look, detail)}.npz"
    if path.is_file():
        try:
            return _read(path)
        except _BROKEN as error:
            _logger.warning("%s is damaged and made anew: %s", path, error)
    surface = look.surface(detail)
    try:
        _write(path, surface)
    except OSError as error:
        _logger.warning("the next start will be as slow, as %s: %s", path, error)
    return surface


def _read(path: Path) -> Surface:
    with path.open("rb") as file, np.load(file, allow_pickle=False) as held:
        surface = Surface(held["vertices"], held["faces"], held["colors"])
    count = len(surface.vertices)
    if len(surface.colors) != count or surface.faces.max(initial=0) >= max(count, 1):
        raise ValueError("its arrays do not fit together")
    return surface


def _write(path: Path, surface: Surface) -> None:
    """Write a file so that whoever reads finds it whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(notice_path(), path.parent / "NOTICE")
    with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as part:
        try:
            np.savez_compressed(
                part, vertices=surface.vertices, faces=surface.faces, colors=surface.colors
            )
            part.close()
            os.replace(part.name, path)
        except BaseException:
            os.unlink(part.name)
            raise


def _digest(look: Look, detail: float) -> str:
    """Return 16 hexadecimal digits that any change in what a surface is made of changes."""
    made_of = hashlib.sha256(_code())
    made_of.update(repr(detail).encode())
    for visual in look.visuals:
        shape = visual.shape
        told = _content(shape.file) if isinstance(shape, Mesh) else repr(shape).encode()
        for part in (told, repr(visual.color).encode(), visual.T_link_visual.tobytes()):
            made_of.update(hashlib.sha256(part).digest())
    return made_of.hexdigest()[:16]


@cache
def _content(file: str) -> bytes:
    """Return the digest of a file."""
    return hashlib.sha256(Path(file).read_bytes()).digest()


@cache
def _code() -> bytes:
    """Return the source of what makes surfaces light."""
    modules = (meshes, triangles, quadrics, simplify, shading)
    return b"".join(Path(str(module.__file__)).read_bytes() for module in modules)
